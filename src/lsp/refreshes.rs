//! How often the client is asked to ask for hints again.

use std::time::{Duration, Instant};

/// The shortest time between two requests, which is five in a second.
const INTERVAL: Duration = Duration::from_millis(200);

/// Requests to ask for hints again. A request that comes too early waits, and those that wait are sent as one.
#[derive(Debug, Default)]
pub struct Refreshes {
    sent: Option<Instant>,
    waits: bool,
}

impl Refreshes {
    /// Takes note that the hints have changed.
    pub fn ask(&mut self) {
        self.waits = true;
    }

    /// When the request that waits may be sent; `None` if none waits.
    pub fn due(&self, now: Instant) -> Option<Instant> {
        self.waits.then(|| self.sent.map_or(now, |sent| sent + INTERVAL))
    }

    /// Takes the request that waits, if it may be sent now.
    pub fn take(&mut self, now: Instant) -> bool {
        let is_due = self.due(now).is_some_and(|due| due <= now);
        if is_due {
            *self = Self { sent: Some(now), waits: false };
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_requests_a_second_are_sent_and_the_last_one_always() {
        let mut refreshes = Refreshes::default();
        let start = Instant::now();
        let at = |ms: u64| start + Duration::from_millis(ms);
        assert!(refreshes.due(start).is_none() && !refreshes.take(start), "nothing has changed");
        let mut sent = Vec::new();
        // A change each 10 ms, for a second.
        for ms in (0..1000).step_by(10) {
            refreshes.ask();
            if refreshes.take(at(ms)) {
                sent.push(ms);
            }
        }
        assert_eq!(sent, [0, 200, 400, 600, 800]);
        assert_eq!(refreshes.due(at(990)), Some(at(1000)));
        assert!(refreshes.take(at(1000)) && refreshes.due(at(1000)).is_none());
        refreshes.ask();
        assert!(refreshes.take(at(5000)), "after a pause at once");
    }
}
