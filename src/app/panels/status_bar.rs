//! The bar below the picture: the state of the shaders, the last reload, and the time of a frame.

use std::time::Duration;

use egui::{Align, Layout, RichText, Ui};

use super::{baking, shaders};
use crate::app::command::capture::CANCEL_ONE;
use crate::app::command::checks::SHOW_FAILURE;
use crate::app::command::scene::INSPECT_PIXEL;
use crate::app::command::spec::Command;
use crate::app::state::captures::Captures;
use crate::app::state::shaders::log::lines;
use crate::app::state::shaders::stages::StageRow;
use crate::app::state::shaders::status::ShaderStatus;
use crate::app::state::waits::Waits;
use crate::app::widgets::plural;
use crate::app::widgets::rows::elided;
use crate::app::widgets::theme::{BAR, ERROR, GOOD, QUIET, TEXT, Tone, WARNING};
use crate::headless::CheckedPicture;
use crate::render::NotFinitePixels;
use crate::shader::checks::{Broken, Rule};
use crate::shader::{Diagnostic, Severity};

/// Height in points.
pub(super) const HEIGHT: f32 = 24.0;

/// Width of the bar below which it does not show the stage, in points.
const ROOM_FOR_STAGE: f32 = 700.0;

/// Contents of the bar.
pub(super) struct Status<'a> {
    pub(super) shader: &'a ShaderStatus,
    /// A few words if the model on screen lacks its textures.
    pub(super) missing_textures: Option<&'static str>,
    /// The work that has delayed the picture for long, and since when.
    pub(super) waits: Option<(Waits, Duration)>,
    /// The fraction of the bake that is done.
    pub(super) progress: Option<f32>,
    /// The pixels of the picture with NaN or infinity.
    pub(super) not_finite: Option<NotFinitePixels>,
    /// The findings of the checks of the picture.
    pub(super) checked: Option<&'a CheckedPicture>,
    /// The captures under way.
    pub(super) captures: &'a Captures,
    /// Generation of the shaders on screen; 0 before the first.
    pub(super) generation: u64,
    pub(super) diagnostics: &'a [Diagnostic],
    /// Device time of the last frame that drew the picture, milliseconds.
    pub(super) frame_ms: Option<f64>,
    /// The stage that draws the picture.
    pub(super) stage: Option<&'a StageRow>,
    pub(super) device: &'a str,
}

pub(super) fn show(ui: &mut Ui, status: &Status<'_>, commands: &mut Vec<Command>) {
    let frame = egui::Frame::new().fill(BAR.color()).inner_margin(egui::Margin::symmetric(8, 2));
    let bar = egui::Panel::bottom("status").frame(frame).exact_size(HEIGHT).resizable(false).show_separator_line(false);
    bar.show(ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            // The right end first, so that a long device name takes no room from the reload.
            if let Some(ms) = status.frame_ms {
                let text = RichText::new(format!("{ms:6.2} ms GPU")).monospace().small().color(QUIET);
                ui.label(text).on_hover_text(format!(
                    "Device time of the last frame in which the picture was drawn\n{}",
                    status.device
                ));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| state(ui, status, commands));
        });
    });
}

fn state(ui: &mut Ui, status: &Status<'_>, commands: &mut Vec<Command>) {
    let count = |severity: Severity| status.diagnostics.iter().filter(|d| d.severity == severity).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    let missing = status.missing_textures.map(str::to_owned);
    let (color, text) = match (status.shader.compiling, errors, warnings, status.waits) {
        (true, ..) => (WARNING, "compiling".to_owned()),
        (_, 0, _, Some((Waits::Pipelines, _))) => (WARNING, "building pipelines".to_owned()),
        (_, 0, _, Some((Waits::Light { of_edit }, time))) => (WARNING, baking::text(of_edit, time, status.progress)),
        (_, 0, ..) if status.generation == 0 => (QUIET, "no shaders yet".to_owned()),
        (_, 0, ..) if let Some(missing) = missing => (WARNING, missing),
        (_, 0, 0, _) => (GOOD, "watching".to_owned()),
        (_, 0, warnings, _) => (WARNING, plural(warnings, "warning")),
        (_, errors, ..) => (ERROR, plural(errors, "error")),
    };
    dot(ui, color);
    let color = if errors > 0 { ERROR } else { TEXT };
    ui.label(RichText::new(text).small().color(color)).on_hover_text(&status.shader.tree);
    if let Some(NotFinitePixels { count, at: (x, y), .. }) = status.not_finite {
        let text = RichText::new(format!("NaN in {}", plural(count, "pixel"))).small().color(ERROR);
        let hint = format!("NaN or infinity, as at {x}, {y}. Click to find the line that makes it");
        if ui.add(egui::Button::new(text).small()).on_hover_text(hint).clicked() {
            commands.push(INSPECT_PIXEL.with([x, y]));
        }
    }
    failed_checks(ui, status.checked, commands);
    captures(ui, status.captures, commands);
    if let Some(row) = status.stage.filter(|_| ui.available_width() > ROOM_FOR_STAGE) {
        ui.scope(|ui| stage(ui, row));
        ui.add_space(8.0);
    }
    if let Some(last) = &status.shader.last {
        let (edit, times, hover) = lines(last);
        let text = RichText::new(format!("{edit}  {times}")).monospace().small();
        ui.add(elided(text)).on_hover_text(hover);
    }
}

/// How many checks of the picture have failed. A click leads to the first of them.
fn failed_checks(ui: &mut Ui, checked: Option<&CheckedPicture>, commands: &mut Vec<Command>) {
    let mut faults: Vec<&Broken> = checked.iter().flat_map(|of| of.faults()).collect();
    // A file may be in several stages.
    faults.dedup_by_key(|fault| (&fault.file, fault.line, fault.rule));
    let Some(first) = faults.first() else { return };
    let asserts = faults.iter().filter(|fault| fault.rule == Rule::Assert).count();
    let text = match (asserts, faults.len() - asserts) {
        (asserts, 0) => format!("{} failed", plural(asserts, "assertion")),
        (0, others) => plural(others, "undefined operation"),
        (asserts, others) => format!("{}, {} undefined", plural(asserts, "assertion"), others),
    };
    let hint = format!("{}:{}: {}\nClick to see the line and its values", first.file, first.line, first.message());
    let button = egui::Button::new(RichText::new(text).small().color(ERROR)).small();
    if ui.add(button).on_hover_text(hint).clicked() {
        commands.push(SHOW_FAILURE.with(()));
    }
}

/// How far captures of many pictures are. A click cancels one.
fn captures(ui: &mut Ui, captures: &Captures, commands: &mut Vec<Command>) {
    for running in captures.iter().filter(|running| running.of > 1 && !running.is_canceled()) {
        let text = format!("{} {} of {}", running.title, running.done, running.of);
        let button = egui::Button::new(RichText::new(text).small().color(WARNING)).small();
        if ui.add(button).on_hover_text("Pictures written so far. Click to cancel").clicked() {
            commands.push(CANCEL_ONE.with(running.number));
        }
    }
}

/// The statistics of a stage with their changes: `pbr.frag 4,469 words -212 · 96 registers -8`.
fn stage(ui: &mut Ui, row: &StageRow) {
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.label(RichText::new(&row.name).small().color(QUIET)).on_hover_text("The stage that draws the picture");
    shaders::short_figures(ui, &row.figures);
}

/// A round mark.
fn dot(ui: &mut Ui, color: Tone) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(10.0, 10.0), egui::Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, color);
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use std::sync::LazyLock;

    use serde_json::Value;

    use super::*;

    static NONE: LazyLock<Captures> = LazyLock::new(Captures::default);

    fn status(shader: &ShaderStatus) -> Status<'_> {
        Status {
            shader,
            captures: &NONE,
            missing_textures: None,
            waits: None,
            progress: None,
            not_finite: None,
            checked: None,
            generation: 1,
            diagnostics: &[],
            frame_ms: None,
            stage: None,
            device: "",
        }
    }

    #[test]
    fn missing_textures_are_told() {
        let show_bar = |ui: &mut Ui, commands: &mut Vec<Command>| {
            let shader = ShaderStatus::default();
            show(ui, &Status { missing_textures: Some("textures are missing"), ..status(&shader) }, commands);
        };
        Harness::new_ui_state(show_bar, Vec::new()).get_by_label("textures are missing");
    }

    #[test]
    fn old_light_is_told_with_its_time_and_progress() {
        let waits = Some((Waits::Light { of_edit: true }, Duration::from_millis(1240)));
        let show_bar = move |ui: &mut Ui, commands: &mut Vec<Command>| {
            let shader = ShaderStatus::default();
            show(ui, &Status { waits, progress: Some(0.43), ..status(&shader) }, commands);
        };
        let harness = Harness::new_ui_state(show_bar, Vec::new());
        harness.get_by_label("light of the edit is being baked, 1.2 s, 43 %");
    }

    #[test]
    fn pixels_with_nan_lead_to_the_inspector() {
        let not_finite = Some(NotFinitePixels { picture: 7, count: 12, at: (30, 40) });
        let show_bar = move |ui: &mut Ui, commands: &mut Vec<Command>| {
            let shader = ShaderStatus::default();
            show(ui, &Status { not_finite, ..status(&shader) }, commands);
        };
        let mut harness = Harness::new_ui_state(show_bar, Vec::new());
        harness.get_by_label("NaN in 12 pixels").click();
        harness.run();
        assert_eq!(harness.state().last(), Some(&INSPECT_PIXEL.with([30, 40])));
    }

    #[test]
    fn a_capture_of_many_pictures_is_told_and_canceled() {
        let mut running = Captures::default();
        let numbers = ["Picture", "Turntable"].map(|title| running.begin(title, (0, Value::Null)).unwrap().0);
        running.progress(numbers[0], 0, 1);
        running.progress(numbers[1], 12, 75);
        let show_bar = move |ui: &mut Ui, commands: &mut Vec<Command>| {
            let shader = ShaderStatus::default();
            show(ui, &Status { captures: &running, ..status(&shader) }, commands);
        };
        let mut harness = Harness::new_ui_state(show_bar, Vec::new());
        assert!(harness.query_by_label_contains("Picture").is_none());
        harness.get_by_label("Turntable 12 of 75").click();
        harness.run();
        assert_eq!(harness.state().last(), Some(&CANCEL_ONE.with(numbers[1])));
    }
}
