//! Decides whether a frame runs the panels. If nothing has happened since they ran, a frame shows them as they are: an animated picture, or
//! one that path tracing improves, costs no work of panels.

use std::time::{Duration, Instant};

/// Panels run at least this often while the picture goes on: they show numbers that change with each frame, such as the time, for reading.
const OLDEST: Duration = Duration::from_millis(250);

/// When the panels ran, and over what. `T`: what changes without an event and must show at once.
pub(super) struct Freshness<T> {
    /// Whether something has happened since: an event, a message, a result.
    is_outdated: bool,
    last: Option<Run<T>>,
}

struct Run<T> {
    of: T,
    at: Instant,
    /// When egui wants to run them again.
    next: Option<Instant>,
}

impl<T: PartialEq> Freshness<T> {
    pub(super) fn new() -> Self {
        Self { is_outdated: true, last: None }
    }

    /// Something has happened that panels may show.
    pub(super) fn outdate(&mut self) {
        self.is_outdated = true;
    }

    /// Whether panels need not run at `now`.
    pub(super) fn is_fresh(&self, of: &T, now: Instant) -> bool {
        let is_fresh = |run: &Run<T>| {
            run.of == *of && now.duration_since(run.at) < OLDEST && run.next.is_none_or(|next| now < next)
        };
        !self.is_outdated && self.last.as_ref().is_some_and(is_fresh)
    }

    /// The panels have run at `at`, and egui wants to run them again after `delay`.
    pub(super) fn ran(&mut self, of: T, at: Instant, delay: Option<Duration>) {
        let next = delay.and_then(|delay| at.checked_add(delay));
        *self = Self { is_outdated: false, last: Some(Run { of, at, next }) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_run_when_something_has_happened_and_rest_in_between() {
        let (begin, ms) = (Instant::now(), Duration::from_millis);
        let mut panels = Freshness::new();
        assert!(!panels.is_fresh(&1, begin), "they have never run");
        panels.ran(1, begin, Some(ms(40)));
        assert!(panels.is_fresh(&1, begin + ms(39)));
        assert!(!panels.is_fresh(&2, begin), "they show other settings");
        assert!(!panels.is_fresh(&1, begin + ms(40)), "egui wants a repaint");
        panels.outdate();
        assert!(!panels.is_fresh(&1, begin), "an event has come");
        panels.ran(1, begin, None);
        assert!(panels.is_fresh(&1, begin + ms(249)) && !panels.is_fresh(&1, begin + ms(250)));
    }
}
