//! Gives up waiting for work that cannot be interrupted, such as reading a file over a network.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// How often the waiting caller checks whether it is canceled.
const INTERVAL: Duration = Duration::from_millis(10);

/// Work on a thread of its own.
pub(crate) struct Running<T> {
    thread: JoinHandle<()>,
    result: Receiver<T>,
}

impl<T: Send + 'static> Running<T> {
    /// Starts `work`. If the caller abandons it, the thread runs on by itself until the process ends, so `work` must not use the
    /// device.
    pub(crate) fn start(work: impl FnOnce() -> T + Send + 'static) -> Self {
        let (sender, result) = channel();
        // Sending fails if the caller has abandoned the work.
        let thread = std::thread::spawn(move || drop(sender.send(work())));
        Self { thread, result }
    }

    /// Returns the result of the work, or `None` once `canceled` returns true. A panic of the work is resumed in the caller.
    pub(crate) fn wait_unless(self, canceled: &dyn Fn() -> bool) -> Option<T> {
        loop {
            match self.result.recv_timeout(INTERVAL) {
                Ok(result) => return Some(result),
                Err(RecvTimeoutError::Timeout) if canceled() => return None,
                Err(RecvTimeoutError::Timeout) => {}
                // The thread has ended without a result.
                Err(RecvTimeoutError::Disconnected) => {
                    return self.thread.join().map_or_else(|panic| resume_unwind(panic), |()| None);
                }
            }
        }
    }
}
