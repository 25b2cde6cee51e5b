//! Between which limits a view's display shows values: from samples of its own picture, or as another view does.

use std::sync::Arc;

use super::{RangeSample, View};
use crate::frame::Limits;
use crate::render::BoundFrame;

impl View {
    /// The display limits of `frame`. Until samples of this mode arrive, the limits of its last frame are used.
    pub(super) fn limits_of(&mut self, frame: &BoundFrame) -> Option<Limits> {
        let state = &frame.state;
        if let Some(limits) = self.followed {
            return limits;
        }
        let mode = state.pipelines.mode;
        if self.mode_since.is_none_or(|(last, _)| last != mode) {
            self.mode_since = Some((mode, self.picture));
        }
        let since = self.mode_since.map_or(0, |(_, since)| since);
        let range_sample = self.range_sample.as_ref().filter(|range_sample| range_sample.picture >= since);
        let values = match (range_sample, self.measured) {
            (Some(range_sample), Some((picture, values))) if range_sample.picture == picture => values,
            (Some(range_sample), _) if state.display.is_measured() => {
                let values = range_sample.limits(state.mode().map_or(3, |mode| mode.components));
                self.measured = Some((range_sample.picture, values));
                values
            }
            _ => None,
        };
        let before = self.known_limits.get(&mode).copied();
        if values.is_none() && state.display.is_measured() {
            return before;
        }
        let limits = state.display.limits(values, before);
        match limits {
            Some(limits) => self.known_limits.insert(mode, limits),
            None => self.known_limits.remove(&mode),
        };
        limits
    }

    /// Whether `frame` has an automatic range, and no samples of its mode have arrived yet.
    pub fn lacks_limits(&self, frame: &BoundFrame) -> bool {
        let mode = frame.state.pipelines.mode;
        let since = self.mode_since.filter(|(last, _)| *last == mode).map(|(_, since)| since);
        let knows = |since| self.range_sample.as_ref().is_some_and(|range_sample| range_sample.picture >= since);
        frame.state.display.is_measured() && self.followed.is_none() && !since.is_some_and(knows)
    }

    /// The limits of the values that the last frame showed; `None` if it stored them as the mode says.
    pub fn limits(&self) -> Option<Limits> {
        self.displayed.and_then(|(_, limits)| limits)
    }

    /// The limits that another view of `frame` takes over: those of this view's last frame, if they follow its values in the same mode.
    pub fn limits_to_follow(&self, frame: &BoundFrame) -> Option<Option<Limits>> {
        let is_same_mode = self.mode_since.is_some_and(|(mode, _)| mode == frame.state.pipelines.mode);
        (is_same_mode && frame.state.display.is_measured()).then(|| self.limits())
    }

    /// The limits of the values in the last frame, if its range follows them. `None` too if the frame has no values.
    pub fn measured_limits(&self) -> Option<Limits> {
        let (display, limits) = self.displayed?;
        let unit = display.unit_limits()?;
        let has_values = self.measured.is_some_and(|(_, values)| values.is_some());
        has_values.then(|| limits.unwrap_or(unit))
    }

    /// Forgets the limits of earlier frames, so that the next one depends on its own values alone.
    pub fn forget_limits(&mut self) {
        self.known_limits.clear();
    }

    /// Takes the samples of slot `slot`. SYNC: after the fence of its last frame.
    pub fn take_range_sample(&mut self, slot: usize) {
        let taken = self.in_flight.get_mut(slot).and_then(|in_flight| in_flight.range_sample.take());
        if let Some(range_sample) =
            taken.filter(|taken| self.range_sample.as_ref().is_none_or(|old| old.picture < taken.picture))
        {
            self.range_sample = Some(Arc::new(range_sample));
        }
    }

    /// The newest samples of the frame's values.
    pub fn range_sample(&self) -> Option<&Arc<RangeSample>> {
        self.range_sample.as_ref()
    }

    /// Uses these display limits, those of the frame that this view is compared with. `None`: the limits of its own values.
    pub fn follow_limits(&mut self, limits: Option<Option<Limits>>) {
        self.followed = limits;
    }

    /// Whether samples of the frame are in flight, or the last frame showed new limits that the legend does not know yet.
    pub fn awaits_range_sample(&self) -> bool {
        self.limits_changed
            || self.range_sampled != 0
                && self.range_sample.as_ref().map(|range_sample| range_sample.picture) != Some(self.range_sampled)
    }
}
