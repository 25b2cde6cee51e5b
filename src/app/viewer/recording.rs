//! Records the session for the process that replaces this one after a loss of the device.

use std::sync::Arc;

use winit::window::Window;

use super::Viewer;
use crate::events::{Event, emit};
use crate::frame::FrameState;
use crate::recovery::Geometry;

impl Viewer {
    /// Records what the next frame shows, for the process that replaces this one if the frame loses the device. Returns the
    /// attempt's number, unless the frame is the fallback.
    pub(in crate::app) fn record(&self, window: &Window) -> Option<u64> {
        let work = self.session_state();
        let geometry =
            || Geometry { size: window.inner_size().into(), at: window.outer_position().ok().map(Into::into) };
        let attempt = self.recorder.begin(&work, geometry);
        let shown = self.shown.as_ref().filter(|_| !self.model.loading)?;
        (Arc::ptr_eq(&shown.settings, &work.settings) || shown.settings == work.settings).then_some(attempt)
    }

    /// Records that the device has drawn the frame of `attempt`, and if the frame was complete, its shaders.
    pub(in crate::app) fn drawn(&self, state: &FrameState, attempt: Option<u64>) {
        attempt.into_iter().for_each(|attempt| self.recorder.drawn(attempt));
        if self.settled == Some(state.shaders.generation) && state.shaders.is_complete() {
            self.recorder.drawn_all(state.shaders.generation, &state.shaders.texts);
        }
    }

    /// Reports the loss that ended the previous process.
    pub(super) fn report_loss(&mut self) {
        let state = self.recorder.state();
        let Some(loss) = &state.loss else { return };
        let refused = state.quarantined.keys().map(String::as_str).collect();
        let event = Event::Restarted { cause: &loss.cause, losses: state.losses, refused, reset: &loss.reset };
        emit(&self.events, &event);
        match loss.reset.as_slice() {
            [] => self.notices.say(format!("{}. The session goes on.", capitalized(&loss.cause))),
            reset => {
                let values = reset.join(", ");
                let cause = capitalized(&loss.cause);
                self.keep_saying(format!("{cause}. The session goes on with the last good value of {values}."));
            }
        }
    }
}

/// The text with a capital at its start.
fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().into_iter().flat_map(char::to_uppercase).chain(characters).collect()
}
