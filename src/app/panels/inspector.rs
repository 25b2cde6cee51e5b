//! The panel Inspector: the values of a pixel in every mode, and the lobe and albedo of its material.

mod lobe;
mod not_finite;
mod plot;
mod solid;
mod texels;
mod values;

use egui::{Checkbox, Color32, Id, LayerId, Order, Rect, RichText, Stroke, Ui, pos2, vec2};

use crate::app::command::layout::OPEN_INSPECTOR;
use crate::app::command::scene::{FOLLOW_MOUSE, UNPIN};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::State;
use crate::app::state::inspection::{Inspection, Page, text};
use crate::app::widgets::check_box;
use crate::app::widgets::elide::middle;
use crate::app::widgets::rows::{choose, elided};
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ACCENT, QUIET, small_font};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Inspector", Group::Parameters, "pixel values texels BRDF lobe albedo furnace plot", || {
        Box::<InspectorState>::default()
    })
    .scrolls_itself();

/// Radius of the marker of the pinned pixel, points.
const MARKER: f32 = 5.0;

/// State of the panel between frames.
#[derive(Default)]
pub(super) struct InspectorState {
    search: String,
    /// How far the user has turned the lobe in space, degrees.
    turn_deg: f32,
}

impl PanelUi for InspectorState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        commands.sight.inspector = true;
        show(ui, context, self, commands);
    }
}

/// Shows the panel.
fn show(ui: &mut Ui, context: &Context<'_>, panel: &mut InspectorState, commands: &mut Commands) {
    let State { session, shader, inspection: own, .. } = context.state;
    let Commands { settings, list: commands, .. } = commands;
    let shaders = &context.shaders;
    let is_toy = shader.is_single_file;
    header(ui, own, (&shaders.modes, is_toy), commands);
    let Some(reading) = &own.reading else {
        let hint = match own.is_pinned() {
            true => "Reading the pixel…",
            false => {
                "Click a pixel of the picture to read its value in every mode. Esc, or a click on the marker, unpins it."
            }
        };
        ui.label(RichText::new(hint).small().color(QUIET));
        return;
    };
    if !is_toy {
        ui.horizontal(|ui| {
            for page in Page::ALL {
                let (name, doc) = page.words();
                if ui.selectable_label(own.page == page, name).on_hover_text(doc).clicked() {
                    commands.push(OPEN_INSPECTOR.with(page));
                }
            }
            light(ui, &mut settings.lights.chosen, reading.lights.len());
        });
    }
    // A toy has no material.
    match if is_toy { Page::Values } else { own.page } {
        Page::Values => {
            search::field(ui, &mut panel.search, "values", 0.0);
            let words = Words::new(&panel.search);
            let features = session.features();
            if let Some(search) = &own.search_not_finite {
                not_finite::show(ui, search, shader.location.is_some(), commands);
            }
            let with = |ui: &mut Ui| texels::show(ui, &reading.texels, &words, commands);
            let mode = &mut settings.mode;
            values::show(ui, reading, &words, &shaders.modes, features, mode, with);
        }
        Page::Lobe => {
            let chosen = settings.lights.chosen;
            // Its place is not that of the list of values.
            egui::ScrollArea::vertical().id_salt("BRDF").auto_shrink(false).show(ui, |ui| {
                lobe::show(ui, reading, own.curves.as_ref(), own.asked.as_ref(), chosen, &mut panel.turn_deg);
            });
        }
    }
}

/// The pixel, what it shows, and what can be done with it.
fn header(ui: &mut Ui, own: &Inspection, (modes, is_toy): (&[crate::shader::Mode], bool), commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let at = own.pin.or(own.reading.as_ref().filter(|_| own.follows).map(|reading| reading.at));
        match at {
            Some([x, y]) => {
                let label = ui.label(RichText::new(format!("{x}, {y}")).monospace().strong());
                label.on_hover_text("Pixels from the upper left corner of the picture");
            }
            None => drop(ui.label(RichText::new("no pixel").color(QUIET))),
        }
        if own.pin.is_some() && ui.small_button("Unpin").on_hover_text("Esc, or a click on the marker").clicked() {
            commands.push(UNPIN.with(()));
        }
        // A control that does not fit goes to the next row as a whole.
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
        let mut follows = own.follows;
        let follow = check_box::show(ui, Checkbox::new(&mut follows, "Follow mouse"));
        let hint = "While no pixel is pinned, read the pixel under the mouse when the mouse stops";
        if follow.on_hover_text(hint).changed() {
            commands.push(FOLLOW_MOUSE.with(follows));
        }
        copy(ui, own, modes);
    });
    let Some(reading) = &own.reading else { return };
    let about = match &reading.names {
        Some([node, material]) if node == material => node.clone(),
        Some([node, material]) => format!("{node} · {material}"),
        None if is_toy => "Colors as displayed, and the images of the passes".to_owned(),
        None if reading.is_complete => "The model does not cover this pixel".to_owned(),
        None => String::new(),
    };
    let hover = "Node and material of the nearest surface under the pixel. This includes surfaces that a mask or alpha makes invisible";
    let shown = middle(ui.painter(), &about, &small_font(), ui.available_width());
    ui.add(elided(RichText::new(shown).small().color(QUIET))).on_hover_text(format!("{about}\n{hover}").trim_start());
}

/// The menu that copies all values.
fn copy(ui: &mut Ui, own: &Inspection, modes: &[crate::shader::Mode]) {
    ui.add_enabled_ui(own.reading.is_some(), |ui| {
        let menu = ui.menu_button("Copy", |ui| {
            let Some(reading) = &own.reading else { return };
            let found = own.search_not_finite.as_ref().and_then(|search| search.found.as_ref());
            if ui.button("All values as text").clicked() {
                ui.ctx().copy_text(text::table(reading, modes, found));
                ui.close();
            }
            if ui.button("All values as JSON").on_hover_text("In the form of `specula probe --json`").clicked() {
                let json = text::json(reading, modes, found);
                ui.ctx().copy_text(serde_json::to_string_pretty(&json).unwrap_or_default());
                ui.close();
            }
        });
        menu.response.on_hover_text("Copy all values of this pixel");
    });
}

/// The light whose terms are shown.
fn light(ui: &mut Ui, chosen: &mut u32, lights: usize) {
    let name = |light: u32| if light == 0 { "All lights".to_owned() } else { format!("Light {light}") };
    let list = choose(ui, "inspected light", name(*chosen), |ui| {
        (0..=lights as u32).for_each(|light| drop(ui.selectable_value(chosen, light, name(light))));
    });
    list.on_hover_text(
        "Light whose BRDF terms, directions and lobe are shown. All lights: the terms and the lobe of light 1, and the sum of the \
         lobes over all lights",
    );
}

/// Marks the pinned pixel in the picture.
pub(super) fn marker(egui: &egui::Context, own: &Inspection, picture: Rect) {
    let Some([x, y]) = own.pin else { return };
    let scale = egui.pixels_per_point();
    let at = picture.min + vec2(x as f32 + 0.5, y as f32 + 0.5) / scale;
    if !picture.contains(at) {
        return;
    }
    let painter =
        egui.layer_painter(LayerId::new(Order::Background, Id::new("inspected pixel"))).with_clip_rect(picture);
    // Visible on light and dark.
    painter.circle_stroke(at, MARKER, Stroke::new(3.0, Color32::from_black_alpha(170)));
    painter.circle_stroke(at, MARKER, Stroke::new(1.5, ACCENT));
    for (dx, dy) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let along = |length: f32| pos2(at.x + dx * length, at.y + dy * length);
        painter.line_segment([along(MARKER), along(MARKER + 4.0)], Stroke::new(3.0, Color32::from_black_alpha(170)));
        painter.line_segment([along(MARKER), along(MARKER + 4.0)], Stroke::new(1.5, ACCENT));
    }
}
