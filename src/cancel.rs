//! Gives up waiting for work that cannot be interrupted, such as reading a file over a network.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How often the waiting caller asks whether it is canceled.
const INTERVAL: Duration = Duration::from_millis(10);

/// Runs `work` on a thread of its own and returns its result, or `None` as soon as `canceled` says so. The thread is then left to
/// itself until the process ends, so `work` must not use the device. A panic of `work` goes on in the caller.
pub(crate) fn wait_unless<T: Send + 'static>(
    canceled: &dyn Fn() -> bool,
    work: impl FnOnce() -> T + Send + 'static,
) -> Option<T> {
    let (sender, result) = channel();
    // Sending fails if the caller has given up.
    let thread = std::thread::spawn(move || drop(sender.send(work())));
    loop {
        match result.recv_timeout(INTERVAL) {
            Ok(result) => return Some(result),
            Err(RecvTimeoutError::Timeout) if canceled() => return None,
            Err(RecvTimeoutError::Timeout) => {}
            // The thread has ended without a result.
            Err(RecvTimeoutError::Disconnected) => {
                return thread.join().map_or_else(|panic| resume_unwind(panic), |()| None);
            }
        }
    }
}
