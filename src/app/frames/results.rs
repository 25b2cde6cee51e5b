//! Applies finished and submitted frames to state and engine.

use std::time::Instant;

use super::progress::frame_done;
use super::recording::drawn;
use crate::app::actions::compare::{cut_short, end_comparison};
use crate::app::actions::inspect::{take_texels, take_values};
use crate::app::control::write_window_shot;
use crate::app::engine::Engine;
use crate::app::messages::reloads::on_endless_loop;
use crate::app::screen::{Ended, Measurement, Screen};
use crate::app::state::State;
use crate::app::state::shaders::versions::Thumbnail;
use crate::app::state::timing::{CpuTimes, DeviceTimes, Shown};
use crate::events::{Event, emit};
use crate::frame::FrameState;
use crate::gpu::GpuError;
use crate::render::BoundFrame;

/// Takes whether the loops of finished frames have ended.
pub(super) fn take_ended(state: &mut State, engine: &mut Engine, screen: &mut Screen) {
    for ended in screen.take_ended() {
        match ended {
            Ended::EndlessThumbnail(version) => cut_short(state, engine, version),
            Ended::EndlessBeside => {
                state.grid.end();
                end_comparison(state, engine);
            }
            Ended::Endless(frame_state, words) => {
                cut_short(state, engine, frame_state.shaders.generation);
                on_endless_loop(state, engine, words);
            }
            Ended::Frame { state: frame_state, attempt, is_repaired } => {
                drawn(state, engine, &frame_state, attempt);
                if is_repaired {
                    state.versions.loops_end(frame_state.shaders.generation);
                    state.all_loops_end();
                }
            }
        }
    }
}

/// Takes the results of the last submission between frames. Returns whether there are any.
pub(super) fn take_background(state: &mut State, engine: &mut Engine, screen: &mut Screen) -> bool {
    let collected = screen.collect_between();
    if let Some((number, capture)) = collected.version {
        let size = [capture.width as usize, capture.height as usize];
        state.versions.set_thumbnail(number, Thumbnail { size, rgba8: capture.rgba8 });
    }
    if let Some((picture, texels)) = collected.texels {
        take_texels(state, picture, texels);
    }
    for (picture, values) in collected.values {
        take_values(state, picture, values.into_iter());
    }
    take_ended(state, engine, screen);
    collected.is_new
}

/// Takes the copies of pictures that have reached the CPU: for the measured difference, and for a capture of the window.
pub(super) fn take_results(state: &mut State, engine: &mut Engine, screen: &mut Screen) {
    if let Some((number, pictures, part)) = screen.take_copies() {
        engine.threads.compare(number, pictures, part);
    }
    if let Some((pixels, size)) = screen.take_window_copy()
        && let Some(shot) = state.waiting.take_copied()
    {
        write_window_shot(engine, shot, pixels, size);
    }
}

/// Takes what a frame means for the measured difference. Returns whether another frame is needed.
pub(super) fn take_measurement(state: &mut State, measurement: Measurement) -> bool {
    if measurement.is_outdated {
        state.compare.difference = None;
    }
    if let Some(number) = measurement.under_way {
        state.compare.measuring = number;
    }
    measurement.has_more
}

/// Takes the times of the newest frame that the device has finished.
pub(super) fn take_times(state: &mut State, screen: &Screen, gpu_is_fast: bool) {
    let frames = screen.frames();
    let Some(ms) = frames.last_device_ms() else { return };
    let (serial, passes, counts) = (frames.timed(), frames.pass_times(), frames.draw_counts());
    state.timing.finished(&DeviceTimes { serial, ms, passes, counts, compiles_in_frame: !gpu_is_fast });
}

/// Notes the frame that has just been submitted, and its CPU times.
pub(super) fn timed(state: &mut State, screen: &Screen, frame: Option<&BoundFrame>, cpu: CpuTimes) {
    if let Some(frame) = frame {
        state.timing.submitted(screen.frames().submitted(), shown(&frame.state), cpu);
    }
}

/// The inputs that decide whether times of frames can be compared.
pub(super) fn shown(frame_state: &FrameState) -> Shown {
    Shown {
        tree: frame_state.shaders.tree,
        generation: frame_state.shaders.generation,
        mode: frame_state.mode().map(|mode| mode.slug.clone()).unwrap_or_default(),
        size: frame_state.size,
        model: frame_state.scene.as_ref().map(|scene| scene.model().name.to_string()).unwrap_or_default(),
    }
}

/// Measures and reports the first frame of the window, of a reload and of the model. `is_first`: whether this is the window's first.
/// Returns whether panels must be redrawn.
pub(super) fn finished(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    frame: Option<&BoundFrame>,
    is_first: &mut bool,
    begin: Instant,
) -> Result<bool, GpuError> {
    if std::mem::take(is_first) && state.has_window {
        // SYNC: once, so that the time includes the device's work.
        screen.finish()?;
        emit(&state.events, &Event::Window { ms: state.start.elapsed().as_secs_f64() * 1e3 });
    }
    if !state.times_next_frame() {
        return Ok(false);
    }
    // SYNC: once per reload, so that the time includes the device's work.
    let device_ms = screen.finish()?;
    frame_done(state, engine, frame, begin.elapsed().as_secs_f64() * 1e3, device_ms);
    Ok(!state.times_next_frame())
}
