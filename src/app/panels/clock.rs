//! Controls of the clock that animated shaders and models follow.

use egui::{DragValue, Label, RichText, Slider, Ui};

use crate::app::command::playback::PlaybackFields;
use crate::app::state::playback::Playback;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, icon};

/// Buttons that run, stop and restart the clock. Returns what the user changes.
pub(super) fn buttons(ui: &mut Ui, playback: &Playback) -> Option<PlaybackFields> {
    let mut asked = None;
    ui.horizontal_wrapped(|ui| {
        let label = if playback.paused { "Play" } else { "Pause" };
        if ui.button(label).on_hover_text("Run or stop the clock (frame.time_s)").clicked() {
            asked = Some(PlaybackFields { paused: Some(!playback.paused), ..PlaybackFields::default() });
        }
        if ui.button("Step").on_hover_text("Advance by 1/60 s").clicked() {
            asked = Some(PlaybackFields { step: true, ..PlaybackFields::default() });
        }
        let restart = named(ui.button(icon::SKIP_BACK), "From the start");
        if restart.on_hover_text("From the start, at 0 s").clicked() {
            asked = Some(PlaybackFields { restart: true, ..PlaybackFields::default() });
        }
        let mut speed = playback.speed;
        let drag = DragValue::new(&mut speed).range(0.0..=10.0).speed(0.01).suffix("×");
        if ui.add(drag).on_hover_text("Playback speed").changed() {
            asked = Some(PlaybackFields { speed: Some(speed), ..PlaybackFields::default() });
        }
        let time = RichText::new(format!("{:.1} s", playback.time_s())).monospace().color(QUIET);
        ui.add(Label::new(time).extend());
    });
    asked
}

/// A slider over `length_s` seconds, which begin again and again. Returns what the user changes: the time, at which the clock then stops.
pub(super) fn scrub(ui: &mut Ui, playback: &Playback, length_s: f32) -> Option<PlaybackFields> {
    let mut time = playback.time_s().rem_euclid(length_s);
    ui.spacing_mut().slider_width = ui.available_width();
    let slider = Slider::new(&mut time, 0.0..=length_s).show_value(false);
    let response = named(ui.add(slider), "Time in the animation");
    let response = response.on_hover_text("Stop the clock at this time");
    response.changed().then(|| PlaybackFields { time: Some(time), paused: Some(true), ..PlaybackFields::default() })
}
