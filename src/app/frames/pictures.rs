//! Pictures of the screen that keys and commands have asked for: of the picture alone, and of the whole window.

use super::picture::shown_session_state;
use super::results::take_ended;
use crate::app::control;
use crate::app::engine::Engine;
use crate::app::screen::Screen;
use crate::app::state::State;
use crate::app::state::captures::Job;
use crate::events::{Event, emit};
use crate::gpu::GpuError;
use crate::picture;
use crate::render::{BoundFrame, Capture, Readback, Redraw};

/// Writes the screenshot that a key has asked for. It waits for the first picture, for the model's textures, and for the range of a mode's
/// values.
pub(super) fn take_screenshot(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    frame: &BoundFrame,
) -> Result<(), GpuError> {
    let is_empty = frame.state.scene.is_none() && (state.model.loading || state.session.model().is_some());
    let lacks_textures = frame.state.scene.as_ref().is_some_and(|scene| scene.model().awaits_textures);
    let awaits_textures = lacks_textures && state.model.loading;
    let is_preview = state.previews.is_preview();
    if !state.screenshot || is_empty || awaits_textures || is_preview || screen.lacks_limits(frame) {
        return Ok(());
    }
    state.screenshot = false;
    match read_picture(state, engine, screen, frame) {
        Ok(Some(readback)) => write_screenshot(state, &readback.finish_picture()),
        Ok(None) => {}
        Err(error) if error.is_shortage() => state.say(format!("no screenshot: {error}")),
        Err(error) => return Err(error),
    }
    Ok(())
}

/// Writes the picture, without panels, to `specula-N.png` in the working directory.
fn write_screenshot(state: &mut State, capture: &Capture) {
    match picture::write_numbered(capture, &shown_session_state(state)) {
        Ok(path) => {
            let whole = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
            state.say(format!("wrote {}", whole.display()));
            emit(&state.events, &Event::Screenshot { file: &path.display().to_string() });
        }
        Err(message) => state.say(message),
    }
}

/// Whether the picture on screen is the one that a command renders, bit by bit: in full floats, alone, without earlier frames, and for a
/// file of linear light with plain averages of the samples.
fn is_rendered(state: &State, screen: &Screen, frame: &BoundFrame, is_linear: bool) -> bool {
    let request = &frame.state.pipelines;
    let is_alone = !state.has_window && !state.compare.is_on() && !screen.has_reference();
    let is_single = frame.stands_alone() && !request.accumulates && !frame.state.display.is_measured();
    is_alone && is_single && (!is_linear || request.target.samples == 1)
}

fn read_picture(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    frame: &BoundFrame,
) -> Result<Option<Readback>, GpuError> {
    // A picture of many frames is taken as it is if its next frame is drawn in parts.
    let redraw = if state.previews.is_planned() { Redraw::ToneMap } else { Redraw::IfChanged };
    let read = screen.read_picture(frame, redraw);
    take_ended(state, engine, screen);
    read
}

/// Takes the requested captures of what is on screen. A lack of memory fails only them. A picture that a command would render otherwise is
/// drawn on the thread of captures.
pub(super) fn take_shots(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    frame: &BoundFrame,
) -> Result<(), GpuError> {
    if screen.lacks_limits(frame) {
        return Ok(());
    }
    for shot in control::take_shots(state, engine) {
        if let Some((size, mode)) = &shot.rendered {
            let is_same = size.is_none_or(|size| size == frame.state.size)
                && mode.as_ref().is_none_or(|mode| *mode == state.session.settings.mode);
            if !is_same || !is_rendered(state, screen, frame, shot.to.holds_light()) {
                let job = Job::Picture { to: shot.to, size: *size, mode: mode.clone(), frames: 1 };
                control::begin_capture(state, engine, shot.reply, job);
                continue;
            }
        }
        match read_picture(state, engine, screen, frame) {
            Ok(Some(readback)) => control::write_shot(state, engine, shot, readback),
            Ok(None) => shot.reply.error("there is no picture"),
            Err(error) if error.is_shortage() => shot.reply.error(error.to_string()),
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
