//! The end of a session, with or without a window: the threads end, and the device.

use std::sync::Arc;
use std::time::Duration;

use super::engine::Engine;
use super::error::AppError;
use super::frames::draw::Drawing;
use super::state::State;
use crate::events::{Event, emit};
use crate::gpu::{Gpu, fault};
use crate::process_end::end_process;

/// How long closing may take. A capture ends the picture that it is drawing, which can take long on a software device.
const CLOSING: Duration = Duration::from_secs(20);

/// The parts of a session that ends.
pub(super) struct Ending {
    pub(super) state: State,
    pub(super) engine: Engine,
    pub(super) drawing: Drawing,
    pub(super) gpu: Arc<Gpu>,
}

impl Ending {
    /// The device is lost.
    pub(super) fn lost(mut self) {
        self.state.waiting.end_all();
        self.engine.recorder.finish();
        // Destroying a lost device could wait forever for it to become idle.
        std::mem::forget(self);
    }

    /// Ends the threads, answers the commands that wait for that, and drops the window by `close`. Returns `result`, or that the validation
    /// layers have reported messages.
    pub(super) fn end(self, result: Result<(), AppError>, close: impl FnOnce()) -> Result<(), AppError> {
        let Self { mut state, engine, drawing, gpu } = self;
        engine.recorder.close();
        end_within(fault::value("closing-limit-ms").map_or(CLOSING, Duration::from_millis));
        assert!(!fault::strikes("closing-panic"), "the injected fault closing-panic");
        let (frames, [ui_ms, cpu_ms]) = state.timing.summary();
        emit(&state.events, &Event::Closed { frames, ui_ms, cpu_ms });
        drop(drawing);
        drop(engine);
        state.waiting.closed();
        close();
        match (result, gpu.validation_messages().len()) {
            (Ok(()), messages) if messages > 0 => Err(AppError::Validation(messages)),
            (result, _) => result,
        }
    }
}

/// Ends the process, unless it ends before. Closing waits for threads that use the device, and these for files, which may be on a file system
/// that does not answer.
fn end_within(time: Duration) {
    let end = move || {
        std::thread::sleep(time);
        crate::message::warn("a thread did not end with the session, so the program ends without it");
        let _unfinished = crate::picture::remove_unfinished();
        end_process(0);
    };
    // Without this thread, closing waits as long as it takes.
    let _ = std::thread::Builder::new().name("specula-closing".to_owned()).spawn(end);
}
