//! Gives up waiting for work that cannot be interrupted, such as reading a file over a network.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

/// How often the waiting caller checks whether it is canceled.
const INTERVAL: Duration = Duration::from_millis(10);

/// Work on a thread of its own. Dropping this gives the work up: its thread is left to itself until the process ends, so the work must not
/// use the device.
pub(crate) struct Running<T> {
    thread: Option<JoinHandle<()>>,
    result: Receiver<T>,
    /// Alive until the work has ended, and who counts it once it is given up.
    given_up: Option<(Weak<()>, &'static GivenUp)>,
}

impl<T: Send + 'static> Running<T> {
    /// Starts `work`. If the system grants no thread, the caller does it.
    pub(crate) fn start(work: impl FnOnce() -> T + Send + 'static) -> Self {
        let (sender, result) = channel();
        let work = Arc::new(Mutex::new(Some(work)));
        let run = move || {
            let work = work.lock().unwrap_or_else(PoisonError::into_inner).take();
            // Sending fails if the caller has abandoned the work.
            work.into_iter().for_each(|work| drop(sender.send(work())));
        };
        let thread = Builder::new().spawn(run.clone()).inspect_err(|_| run()).ok();
        Self { thread, result, given_up: None }
    }

    /// Returns the result of the work, or `None` once `canceled` returns true. A panic of the work is resumed in the caller.
    pub(crate) fn wait_unless(mut self, canceled: &dyn Fn() -> bool) -> Option<T> {
        match receive_unless(&self.result, canceled) {
            Ok(result) => Some(result),
            Err(RecvTimeoutError::Timeout) => None,
            // The thread has ended without a result.
            Err(RecvTimeoutError::Disconnected) => {
                self.thread.take()?.join().map_or_else(|panic| resume_unwind(panic), |()| None)
            }
        }
    }
}

/// Waits for what another thread sends.
///
/// # Errors
/// `Timeout` once `canceled` returns true, `Disconnected` if nothing more is sent.
pub(crate) fn receive_unless<T>(from: &Receiver<T>, canceled: &dyn Fn() -> bool) -> Result<T, RecvTimeoutError> {
    loop {
        match from.recv_timeout(INTERVAL) {
            Err(RecvTimeoutError::Timeout) if !canceled() => {}
            received => return received,
        }
    }
}

impl<T> Drop for Running<T> {
    fn drop(&mut self) {
        if let Some((work, given_up)) = self.given_up.take() {
            given_up.lock().push(work);
        }
    }
}

/// Work of one kind that was given up and has not ended. It takes memory, so no more of the kind starts until then.
pub(crate) struct GivenUp(Mutex<Vec<Weak<()>>>);

impl GivenUp {
    /// No such work.
    pub(crate) const fn none() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// Starts `work` once all work that was given up has ended; `None` as soon as `canceled` says so. The work must end by itself.
    pub(crate) fn start<T: Send + 'static>(
        &'static self,
        canceled: &dyn Fn() -> bool,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Option<Running<T>> {
        while self.is_any() {
            if canceled() {
                return None;
            }
            std::thread::sleep(INTERVAL);
        }
        let alive = Arc::new(());
        let ends = Arc::downgrade(&alive);
        let mut running = Running::start(move || {
            let _alive = alive;
            work()
        });
        running.given_up = Some((ends, self));
        Some(running)
    }

    fn is_any(&self) -> bool {
        let mut works = self.lock();
        works.retain(|work| work.strong_count() > 0);
        !works.is_empty()
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Weak<()>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn work_that_was_given_up_ends_before_more_of_its_kind_starts() {
        static KIND: GivenUp = GivenUp::none();
        let (release, blocked) = channel::<()>();
        let first = KIND.start(&|| false, move || blocked.recv()).unwrap();
        assert!(first.wait_unless(&|| true).is_none(), "nothing interrupts it");
        let asked = Cell::new(0);
        let cancels_later = || {
            asked.set(asked.get() + 1);
            asked.get() > 3
        };
        assert!(KIND.start(&cancels_later, || ()).is_none(), "two would run at once");
        drop(release);
        assert_eq!(KIND.start(&|| false, || 7).unwrap().wait_unless(&|| false), Some(7));
        assert_eq!(KIND.start(&|| false, || 8).unwrap().wait_unless(&|| false), Some(8), "it was not given up");
    }
}
