//! Ends the process when the device does not answer. A hung device blocks every wait, and with it every destructor, so an error
//! value would never reach its end.

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// How often the watchdog thread looks at the clock.
const TICK: Duration = Duration::from_millis(50);

struct Watch {
    limit: Duration,
    /// Tasks of the device, by number, with their deadlines.
    tasks: Mutex<Vec<(u64, Instant, String)>>,
}

static WATCH: OnceLock<Watch> = OnceLock::new();

impl Watch {
    fn tasks(&self) -> MutexGuard<'_, Vec<(u64, Instant, String)>> {
        self.tasks.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// From now on, calls `end` once a wait for a submission, or a pipeline, takes longer than `limit`. `end` receives what the
/// device was doing, as "drawing a frame", and must end the process without waiting for the device. Only the first call counts.
pub fn end_after(limit: Duration, end: fn(&str, Duration) -> !) {
    if WATCH.set(Watch { limit, tasks: Mutex::default() }).is_err() {
        return;
    }
    let look = move || {
        loop {
            std::thread::sleep(TICK);
            let Some(watch) = WATCH.get() else { continue };
            let now = Instant::now();
            let late = watch.tasks().iter().find(|(_, until, _)| *until < now).map(|(.., what)| what.clone());
            if let Some(what) = late {
                end(&what, watch.limit);
            }
        }
    };
    // If the thread cannot start, waits still end after their own limit.
    let _ = std::thread::Builder::new().name("specula-watchdog".to_owned()).spawn(look);
}

/// The limit of [`end_after`], if it was called.
pub(in crate::gpu) fn limit() -> Option<Duration> {
    WATCH.get().map(|watch| watch.limit)
}

/// A task of the device that is being watched. Dropping this ends the watch.
pub(in crate::gpu) struct Watched(u64);

impl Watched {
    /// Begins to watch a task, if the process wants that. `what` continues "while".
    pub(in crate::gpu) fn begin(what: impl FnOnce() -> String) -> Option<Self> {
        let watch = WATCH.get()?;
        let until = Instant::now().checked_add(watch.limit)?;
        let mut tasks = watch.tasks();
        let number = tasks.iter().map(|(number, ..)| number + 1).max().unwrap_or(0);
        tasks.push((number, until, what()));
        Some(Self(number))
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        if let Some(watch) = WATCH.get() {
            watch.tasks().retain(|(number, ..)| *number != self.0);
        }
    }
}
