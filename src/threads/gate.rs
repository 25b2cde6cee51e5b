//! Access to the device until the window closes.

use std::sync::{Mutex, PoisonError};

/// Lets threads use the device until the window closes. The process must not end while a thread is inside the driver.
#[derive(Default)]
pub(crate) struct DeviceGate(Mutex<bool>);

impl DeviceGate {
    /// Runs `work` unless the window is closing. Closing waits until `work` is done.
    pub(super) fn pass<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        let closed = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        (!*closed).then(work)
    }

    pub(super) fn close(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = true;
    }
}
