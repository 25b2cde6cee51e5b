//! Waits until something stays the same: settings may be dragged.

use std::time::{Duration, Instant};

/// The next question, and since when it is the same.
pub(in crate::app) struct Resting<T>(Option<(T, Instant)>);

impl<T> Default for Resting<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T: PartialEq + Clone> Resting<T> {
    /// How long `now` must still stay as it is, of a total of `rest`; `None` if it has.
    pub(in crate::app) fn left(&mut self, now: &T, rest: Duration) -> Option<Duration> {
        match &self.0 {
            Some((of, since)) if of == now => rest.checked_sub(since.elapsed()).filter(|left| !left.is_zero()),
            _ => {
                self.0 = Some((now.clone(), Instant::now()));
                Some(rest)
            }
        }
    }
}
