//! The panel Capture: pictures, contact sheets and animations as files in the working directory, and how far those under way are.

use std::path::PathBuf;

use egui::{Align, Button, Checkbox, ComboBox, DragValue, Layout, ProgressBar, Response, RichText, Ui, vec2};

use crate::app::command::capture::{
    CANCEL, CANCEL_ONE, CAPTURE, Capture, SHEET, Sheet, TIMELINE, TURNTABLE, Timeline, TurntableFields,
};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::captures::Captures;
use crate::app::widgets::check_box;
use crate::app::widgets::rows::{Row, elided, heading, skips};
use crate::app::widgets::theme::QUIET;
use crate::capture::Turn;
use crate::picture::numbered_as;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Capture", Group::Settings, "contact sheet turntable video timeline GIF WebP MP4 EXR size", || {
        Box::<CaptureState>::default()
    });

/// Largest width and height that the panel offers, pixels. The device may allow less, and says so then.
const LARGEST: u32 = 16_384;
/// Sizes that are offered by name.
const SIZES: [(&str, [u32; 2]); 5] = [
    ("1280 × 720", [1280, 720]),
    ("1920 × 1080", [1920, 1080]),
    ("2560 × 1440", [2560, 1440]),
    ("3840 × 2160", [3840, 2160]),
    ("1080 × 1080", [1080, 1080]),
];

/// Settings of the capture panel. They last as long as the window.
pub(super) struct CaptureState {
    /// `None` for the size on screen.
    size: Option<[u32; 2]>,
    /// The size of animations. Theirs is that of a video, even where a picture is large.
    animation_size: Option<[u32; 2]>,
    is_exr: bool,
    with_panels: bool,
    all_modes: bool,
    frames: u32,
    fps: f32,
    turn: Turn,
    animation: &'static str,
    /// The working directory, where the files go.
    folder: String,
}

impl Default for CaptureState {
    fn default() -> Self {
        Self {
            size: None,
            animation_size: None,
            is_exr: false,
            with_panels: false,
            all_modes: false,
            frames: 75,
            fps: 25.0,
            turn: Turn::Camera,
            animation: "webp",
            folder: std::env::current_dir().unwrap_or_default().display().to_string(),
        }
    }
}

impl PanelUi for CaptureState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        let size = context.state.shown().map_or((0, 0), |shown| shown.size);
        let versions = context.state.versions.iter().count();
        show(ui, self, &context.state.captures, (size, versions), &mut commands.list);
    }
}

/// Shows the panel. `shown` is the size of the picture on screen, and `versions` the number of versions that can be drawn.
pub(super) fn show(
    ui: &mut Ui,
    state: &mut CaptureState,
    captures: &Captures,
    (shown, versions): ((u32, u32), usize),
    commands: &mut Vec<Command>,
) {
    progress(ui, captures, &state.folder, commands);
    heading(ui, "Picture");
    commands.extend(picture(ui, state, shown).map(|fields| CAPTURE.with(fields)));
    heading(ui, "Sheet of modes");
    commands.extend(sheet(ui, state).map(|fields| SHEET.with(fields)));
    heading(ui, "Animation");
    animation(ui, state, shown);
    commands.extend(turntable(ui, state).map(|fields| TURNTABLE.with(fields)));
    commands.extend(timeline(ui, state, versions).map(|fields| TIMELINE.with(fields)));
}

/// Shows the rows of a picture. Returns the picture that the user asks for.
fn picture(ui: &mut Ui, state: &mut CaptureState, shown: (u32, u32)) -> Option<Capture> {
    let doc = "Size of the file in pixels. Any size is possible: the picture in the window does not change";
    row(ui, "Size", doc, |ui| size(ui, "picture size", &mut state.size, shown));
    let doc = "PNG: as displayed, with all settings in its metadata. EXR: the raw floats before exposure and tone map";
    row(ui, "Format", doc, |ui| {
        let png = ui.selectable_value(&mut state.is_exr, false, "PNG");
        png.union(ui.selectable_value(&mut state.is_exr, true, "EXR"))
    });
    let is_plain = !state.is_exr && state.size.is_none();
    row(ui, "With panels", "The whole window, as it is on screen: a PNG of the window's size", |ui| {
        let show = |ui: &mut Ui| check_box::show(ui, Checkbox::without_text(&mut state.with_panels));
        ui.add_enabled_ui(is_plain, show).inner
    });
    let about = "Write the picture as specula-N (F12 writes it as it is on screen)";
    button(ui, "Capture picture", about).then(|| Capture {
        file: Some(numbered_as("specula", if state.is_exr { "exr" } else { "png" })),
        size: state.size,
        ui: state.with_panels && is_plain,
        ..Capture::default()
    })
}

/// Shows the rows of a contact sheet. Returns the sheet that the user asks for.
fn sheet(ui: &mut Ui, state: &mut CaptureState) -> Option<Sheet> {
    row(ui, "Modes", "A small picture of each mode with its name: only modes with data in this model, or all", |ui| {
        let some = ui.selectable_value(&mut state.all_modes, false, "With data");
        some.union(ui.selectable_value(&mut state.all_modes, true, "All"))
    });
    button(ui, "Write sheet", "Write specula-sheet-N.png").then(|| {
        let modes = if state.all_modes { "all" } else { "modes" };
        Sheet::of(numbered_as("specula-sheet", "png"), modes)
    })
}

/// Shows the rows of an animation.
fn animation(ui: &mut Ui, state: &mut CaptureState, shown: (u32, u32)) {
    let doc = "Size of turntables and timelines in pixels";
    row(ui, "Size", doc, |ui| size(ui, "animation size", &mut state.animation_size, shown));
    let doc = "MP4: a small video for any player. WebP: in full color, also with a transparent background. GIF: 256 colors a frame. PNGs: numbered frames, for other programs";
    row(ui, "Format", doc, |ui| {
        let formats = [("mp4", "MP4"), ("webp", "WebP"), ("gif", "GIF"), ("png", "PNGs")];
        let choices = formats.map(|(ending, name)| ui.selectable_value(&mut state.animation, ending, name));
        choices.into_iter().reduce(|all, choice| all.union(choice)).unwrap_or_else(|| ui.label(""))
    });
    row(ui, "Frames", "Frames of a full turn", |ui| {
        ui.add(DragValue::new(&mut state.frames).range(2..=1000).speed(1.0))
    });
    row(ui, "Speed", "Frames per second", |ui| {
        ui.add(DragValue::new(&mut state.fps).range(1.0..=60.0).speed(0.2).max_decimals(1).suffix(" fps"))
    });
    row(ui, "Turns", "What turns: the camera, the light around the model, or the model in its light", |ui| {
        let name = |turn: Turn| match turn {
            Turn::Camera => "Camera",
            Turn::Light => "Light",
            Turn::Model => "Model",
        };
        let list = ComboBox::from_id_salt("turn").selected_text(name(state.turn));
        let choices = [Turn::Camera, Turn::Light, Turn::Model];
        list.show_ui(ui, |ui| {
            for choice in choices {
                ui.selectable_value(&mut state.turn, choice, name(choice));
            }
        })
        .response
    });
}

/// Shows the button of a turntable. Returns the turntable that the user asks for.
fn turntable(ui: &mut Ui, state: &CaptureState) -> Option<TurntableFields> {
    let about = "Write a full turn as specula-turntable-N";
    button(ui, "Write turntable", about).then(|| TurntableFields {
        file: animation_file("specula-turntable", state.animation),
        frames: Some(state.frames),
        fps: Some(state.fps),
        size: state.animation_size,
        turn: Some(format!("{:?}", state.turn).to_lowercase()),
    })
}

/// Shows the button of an animation of all versions. Returns the animation that the user asks for.
fn timeline(ui: &mut Ui, state: &CaptureState, versions: usize) -> Option<Timeline> {
    let about = "Write all shader versions of this session as specula-timeline-N, drawn with the current settings";
    let button = ui.add_enabled(versions > 1, Button::new("Write timeline")).on_hover_text(about);
    let is_clicked = button.on_disabled_hover_text("No edit has been shown yet").clicked();
    let file = || animation_file("specula-timeline", state.animation);
    is_clicked.then(|| Timeline { file: file(), fps: None, size: state.animation_size })
}

/// Shows what is under way, in a line that is always there, so that nothing below it moves when a capture begins or ends.
fn progress(ui: &mut Ui, captures: &Captures, folder: &str, commands: &mut Vec<Command>) {
    let size = vec2(ui.available_width(), ui.spacing().interact_size.y);
    let center = Layout::left_to_right(Align::Center);
    if captures.iter().next().is_none() {
        let about = format!("Files are written to {folder}");
        ui.allocate_ui_with_layout(size, center, |ui| {
            ui.set_min_height(size.y);
            ui.add(elided(RichText::new(&about).small().color(QUIET))).on_hover_text(about);
        });
    }
    for running in captures.iter() {
        let part = if running.of > 0 { running.done as f32 / running.of as f32 } else { 0.0 };
        let text = match (running.is_canceled(), running.of) {
            (true, _) => format!("{}: ending", running.title),
            (false, 0) => format!("{}: waiting", running.title),
            (false, of) => format!("{}: {} of {of}", running.title, running.done),
        };
        ui.allocate_ui_with_layout(size, center, |ui| {
            let bar = ProgressBar::new(part).desired_width((size.x - 66.0).max(40.0)).text(RichText::new(text).small());
            ui.add(bar).on_hover_text("Pictures drawn so far");
            let about = "Stop after the picture in progress. Numbered frames that were already written stay";
            if ui.button("Cancel").on_hover_text(about).clicked() {
                commands.push(CANCEL_ONE.with(running.number));
            }
        });
    }
    if captures.iter().count() > 1 && button(ui, "Cancel all", "Stop all captures in progress") {
        commands.push(CANCEL.with(None));
    }
}

fn row(ui: &mut Ui, name: &str, doc: &str, control: impl FnOnce(&mut Ui) -> Response) {
    if !skips(ui) {
        Row { name, doc, option: String::new(), is_changed: false, is_indented: false }.show(ui, control);
    }
}

fn button(ui: &mut Ui, title: &str, about: &str) -> bool {
    ui.button(title).on_hover_text(about).clicked()
}

/// The choice of a size: as on screen, by name, or in numbers.
fn size(ui: &mut Ui, id: &str, size: &mut Option<[u32; 2]>, shown: (u32, u32)) -> Response {
    let as_shown = format!("{} × {}, as on screen", shown.0, shown.1);
    let named = |size: &[u32; 2]| SIZES.iter().find(|(_, known)| known == size).map(|(name, _)| (*name).to_owned());
    let text = size
        .as_ref()
        .map_or_else(|| "as on screen".to_owned(), |size| named(size).unwrap_or_else(|| "custom".to_owned()));
    ui.vertical(|ui| {
        let list = ComboBox::from_id_salt(id).selected_text(text);
        list.show_ui(ui, |ui| {
            ui.selectable_value(size, None, as_shown);
            for (name, known) in SIZES {
                ui.selectable_value(size, Some(known), name);
            }
        });
        if let Some([width, height]) = size {
            ui.horizontal(|ui| {
                let number = |value| DragValue::new(value).range(1..=LARGEST).speed(8.0).suffix(" px");
                ui.add(number(width)).on_hover_text("Width in pixels");
                ui.add(number(height)).on_hover_text("Height in pixels");
            });
        }
    })
    .response
}

/// The next free name of an animation. That of numbered frames is free if its first frame is.
fn animation_file(stem: &str, ending: &str) -> PathBuf {
    if ending != "png" {
        return numbered_as(stem, ending);
    }
    let first = numbered_as(stem, "0001.png");
    PathBuf::from(first.to_string_lossy().replace(".0001.png", ".png"))
}
