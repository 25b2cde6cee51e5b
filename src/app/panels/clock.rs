//! Controls of the clock that animated shaders and models follow.

use egui::{DragValue, Label, RichText, Slider, Ui};

use crate::app::command::playback::PlaybackFields;
use crate::app::state::playback::Playback;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, icon};

/// The time of the clock, as wide at 100 s as at 1 s, so that the row does not break while it runs.
pub(super) fn time_text(playback: &Playback) -> String {
    format!("{:>6.1} s", playback.time_s())
}

/// Buttons that run, stop and restart the clock, and a text with the time. Returns what the user changes.
pub(super) fn buttons(ui: &mut Ui, playback: &Playback, time: &str) -> Option<PlaybackFields> {
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
        ui.add(Label::new(RichText::new(time).monospace().color(QUIET)).extend());
    });
    asked
}

/// A slider with the time in a clip of `length_s` seconds. Returns the time at which the user wants to stop.
pub(super) fn scrub(ui: &mut Ui, time_s: f32, length_s: f32) -> Option<f32> {
    let mut time = time_s;
    ui.spacing_mut().slider_width = ui.available_width();
    let slider = Slider::new(&mut time, 0.0..=length_s).show_value(false);
    let response = named(ui.add(slider), "Time in the animation");
    response.on_hover_text("Stop the clock at this time").changed().then_some(time)
}
