//! The panel Camera: field of view, position, views from the sides, framing, and the cameras in the model.

use egui::{Button, Label, Response, RichText, Ui};

use crate::app::command::camera::{FRAME, KEEP_CAMERA, LOOK_THROUGH, RECALL_CAMERA, VIEW_FROM, ViewSide};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::numbers::Scale;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::widgets::elide::middle;
use crate::app::widgets::rows::{Row, drag, group, heading, option_text, option_value, set_option};
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{ACCENT, QUIET, body_font};
use crate::scene::{CameraView, Model};
use crate::settings::{CameraSettings, Curve, Settings, Value, setting};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Camera", Group::Settings, "field of view bookmarks", || Box::new(ui));

/// Farthest position that the panel sets, meters.
const FARTHEST: f64 = 1e6;
/// Gap between the numbers of a position, points.
const GAP: f32 = 3.0;

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let view = context.state.shown().map(|shown| shown.camera);
    let Commands { settings, list, .. } = commands;
    show(ui, settings, view.as_ref(), &context.model(), list);
}

/// Shows the panel. `view`: the camera of the picture.
pub(super) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    view: Option<&CameraView>,
    model: &Model,
    commands: &mut Vec<Command>,
) {
    group(ui, settings, "camera", |ui, settings, path| match path {
        "camera.eye" => {
            view.into_iter().for_each(|view| place(ui, &mut settings.camera, view));
            true
        }
        "camera.target" => true,
        _ => false,
    });
    sides(ui, commands);
    bookmarks(ui, settings, commands);
    let settings = &mut settings.camera;
    if ui.button("Frame the model").on_hover_text("Show the whole model (R or Home)").clicked() {
        commands.push(FRAME.with(()));
    }
    for (index, camera) in model.cameras.iter().enumerate() {
        let name = if camera.name.is_empty() { "Unnamed camera" } else { &camera.name };
        let shown = middle(ui.painter(), name, &body_font(), ui.available_width() - 12.0);
        let button = ui.add(Button::new(shown).truncate());
        if button.on_hover_text(format!("{name}\nLook through this camera")).clicked() {
            commands.push(LOOK_THROUGH.with(index));
        }
    }
    if let (Some(eye), Some(target)) = (settings.eye, settings.target) {
        let list = |v: [f32; 3]| v.map(|c| format!("{c:.3}")).join(",");
        let text = format!("--eye {} --target {}", list(eye), list(target));
        let label = ui.add(Label::new(option_text(&text).color(QUIET)).sense(egui::Sense::click()));
        if label.on_hover_text("Position and target in meters. Click to copy the options").clicked() {
            ui.ctx().copy_text(text);
        }
    }
    let help = "Drag to orbit, Ctrl+drag to pan, wheel to zoom, Shift+drag to turn the environment.\n\
                Hold the right button and W A S D Q E to fly.";
    ui.label(RichText::new(help).small().color(QUIET));
}

/// The rows of position and target. A change of one keeps the other where it is in the picture.
fn place(ui: &mut Ui, settings: &mut CameraSettings, view: &CameraView) {
    let [before, target] =
        [settings.eye.unwrap_or(view.eye.to_array()), settings.target.unwrap_or(view.target.to_array())];
    // A drag over 200 points is as long as the distance to the target.
    let distance = f64::from(view.eye.distance(view.target));
    let scale = Scale {
        slider: Some((0.0, distance)),
        limits: (-FARTHEST, FARTHEST),
        suffix: String::new(),
        decimals: 3,
        curve: Curve::Linear,
        is_signed: false,
    };
    let is_set = [settings.eye.is_some(), settings.target.is_some()];
    let mut points = [before, target];
    let mut is_changed = false;
    for (at, path) in ["camera.eye", "camera.target"].into_iter().enumerate() {
        let Some(entry) = setting(path).map(|setting| setting.entry) else { continue };
        let point = &mut points[at];
        let option = set_option(path, &option_value(&Value::Numbers(*point)));
        let row = Row { name: entry.label, doc: entry.doc(), option, is_changed: is_set[at], is_indented: false };
        if row.show(ui, |ui| edit_point(ui, entry.label, point, &scale, &mut is_changed)) {
            (settings.eye, settings.target) = (None, None);
            return;
        }
    }
    if is_changed {
        (settings.eye, settings.target) = (Some(points[0]), Some(points[1]));
    }
}

/// Three numbers side by side. Notes a change in `is_changed`.
fn edit_point(ui: &mut Ui, name: &str, point: &mut [f32; 3], scale: &Scale, is_changed: &mut bool) -> Response {
    ui.spacing_mut().item_spacing.x = GAP;
    let width = (ui.available_width() - 2.0 * GAP) / 3.0;
    let [x, y, z] = point.each_mut();
    let mut edit = |axis: &str, number: &mut f32| {
        let mut edited = f64::from(*number);
        let response = named(drag(ui, &mut edited, scale, width), &format!("{name} {axis}"));
        if response.changed() {
            *number = edited as f32;
            *is_changed = true;
        }
        response
    };
    edit("x", x).union(edit("y", y)).union(edit("z", z))
}

/// The views from the six sides.
fn sides(ui: &mut Ui, commands: &mut Vec<Command>) {
    heading(ui, "View from");
    ui.horizontal_wrapped(|ui| {
        for side in ViewSide::ALL {
            let (name, key) = (side.name(), side.key());
            let hint = format!("View from the {name} ({key})");
            if named(ui.button(capitalized(name)), &hint).on_hover_text(&hint).clicked() {
                commands.push(VIEW_FROM.with(side));
            }
        }
    });
}

/// A word with a capital.
fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// The cameras that the user has kept.
fn bookmarks(ui: &mut Ui, settings: &mut Settings, commands: &mut Vec<Command>) {
    heading(ui, "Saved cameras");
    ui.horizontal_wrapped(|ui| {
        for number in 1..=9_u32 {
            let is_kept = settings.bookmarks.contains_key(&number.to_string());
            let text = RichText::new(number.to_string()).monospace();
            let button = ui.add(Button::new(if is_kept { text.color(ACCENT) } else { text.color(QUIET) }));
            let hint = match is_kept {
                true => {
                    format!("Return to this camera (Ctrl+{number}). Shift+click to replace it with the current camera")
                }
                false => format!("Store the current camera as {number} (Ctrl+Shift+{number})"),
            };
            if button.on_hover_text(hint).clicked() {
                let keeps = !is_kept || ui.input(|input| input.modifiers.shift);
                commands.push(if keeps { KEEP_CAMERA.with(number) } else { RECALL_CAMERA.with(number) });
            }
        }
    });
}
