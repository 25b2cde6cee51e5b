//! Previews: while the picture changes from frame to frame and a whole one takes long, the window draws fewer pixels. Once it rests, the
//! whole picture is drawn in parts between frames, which any change interrupts.
//!
//! A change that needs other pipelines or another light, as of a mode or an edit, draws the whole picture at once: it is one frame, not a
//! movement. Only a picture of many frames (path tracing) begins with a preview even then. While a command waits for the picture, there are
//! no previews.

pub(in crate::app) mod plan;
mod size;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::frame::PipelineRequest;
use crate::settings::Adaptive;
use plan::Plan;
pub(in crate::app) use size::Drawn;
use size::PreviewSize;

/// A whole picture that takes longer than this is slow, milliseconds.
const SLOW_MS: f64 = 50.0;
/// A picture whose preview promises a whole one in this time, milliseconds, needs none.
const FAST_MS: f64 = 35.0;
/// How long a picture must have been the same before the whole one is begun.
const REST: Duration = Duration::from_millis(80);
/// How long before a preview is drawn that nobody sees, for which the device may compile.
const REST_TO_WARM: Duration = Duration::from_millis(500);
/// Most frames whose times are awaited.
const MOST_AWAITED: usize = 8;

/// The difference from the frame before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Change {
    Nothing,
    /// Camera, lights, values or time; while a value is dragged, also light that is baked from it.
    Moved,
    /// Pipelines, light or the size of the window.
    New,
}

/// The next frame.
#[derive(Clone, Copy, Debug)]
pub(in crate::app) struct NextFrame {
    pub(in crate::app) change: Change,
    /// Whether the picture is the mean of many frames.
    pub(in crate::app) accumulates: bool,
    /// Whether the targets hold the whole picture.
    pub(in crate::app) is_held: bool,
    /// Whether more frames would improve that.
    pub(in crate::app) improves: bool,
    /// Whether all parts of a whole picture are drawn.
    pub(in crate::app) has_parts: bool,
    /// Whether a command or a key waits for the whole picture.
    pub(in crate::app) is_awaited: bool,
    pub(in crate::app) now: Instant,
}

/// Previews between two whole pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) struct Movement {
    /// How many different previews were shown.
    pub(in crate::app) previews: u32,
    /// [`Previews::side`] of the last one.
    pub(in crate::app) side: f32,
    begun: Instant,
    /// When the last of them was.
    last: Instant,
}

impl Movement {
    /// From the first preview to the last.
    pub(in crate::app) fn time(&self) -> Duration {
        self.last - self.begun
    }

    /// From the last preview on.
    pub(in crate::app) fn time_since(&self, now: Instant) -> Duration {
        now.saturating_duration_since(self.last)
    }
}

/// The part of the picture that a submitted frame has drawn, for its time.
struct Awaited {
    serial: u64,
    drawn: Drawn,
}

/// When previews are drawn, and how large they are.
#[derive(Default)]
pub(in crate::app) struct Previews {
    /// Whether the device compiles in the first frame of a picture, so that its time says nothing.
    compiles_in_frame: bool,
    /// How the last frame showed the picture.
    plan: Plan,
    /// Whether a preview could have been its plan.
    is_planned: bool,
    /// Device time of a whole picture, milliseconds, once it is known.
    whole_ms: Option<f64>,
    /// Whether the next whole picture is the first since a new one.
    is_first: bool,
    /// When the last frame with a change of the picture was submitted; before that, when it began. A frame can wait for the device so long
    /// that it says nothing about the events meanwhile.
    changed: Option<Instant>,
    /// Whether the last frame had such a change.
    has_changed: bool,
    /// Whether it has moved since the last whole picture.
    has_moved: bool,
    /// Whether the last preview is drawn. The one before may show the same picture, and its frame then draws the panels alone.
    is_drawn: bool,
    /// Whether a part of this picture has failed, so that it is drawn as a whole.
    has_given_up: bool,
    movement: Option<Movement>,
    /// The picture whose preview the device has drawn once.
    warm: Option<Arc<PipelineRequest>>,
    size: PreviewSize,
    awaited: VecDeque<Awaited>,
}

impl Previews {
    /// Those of a device that compiles in the first frame of a picture, as a software device does, or of another one.
    pub(in crate::app) fn new(compiles_in_frame: bool) -> Self {
        Self { compiles_in_frame, ..Self::default() }
    }

    /// Whether the last frame showed a preview.
    pub(in crate::app) fn is_preview(&self) -> bool {
        self.plan == Plan::Preview
    }

    /// Whether the last frame showed the whole picture, with the pixels that a capture of it has.
    pub(in crate::app) fn is_whole(&self) -> bool {
        self.plan != Plan::Preview
    }

    /// Whether the last frame could have been a preview, so that its picture is drawn in parts if it is the mean of many frames.
    pub(in crate::app) fn is_planned(&self) -> bool {
        self.is_planned
    }

    /// The part of each side of the picture that a preview has, 0..1.
    pub(in crate::app) fn side(&self) -> f32 {
        self.size.side()
    }

    /// Whether a whole picture would take long, so that [`Self::plan`] has to be asked. No frame is compared before.
    pub(in crate::app) fn may_preview(&self, choice: Adaptive) -> bool {
        match choice {
            _ if self.has_given_up => false,
            Adaptive::Off => false,
            Adaptive::On => true,
            Adaptive::Auto => self.whole_ms.map_or(self.compiles_in_frame, |ms| ms > SLOW_MS),
        }
    }

    /// Shows the whole picture: previews are off, or none can be drawn of this frame.
    pub(in crate::app) fn show_whole(&mut self, change: Change, accumulates: bool) {
        self.note((change, accumulates), None);
        (self.plan, self.is_planned, self.has_moved) = (Plan::Whole, false, false);
    }

    /// How to show the next frame, if previews may be drawn.
    pub(in crate::app) fn plan(&mut self, next: &NextFrame) -> Plan {
        self.note((next.change, next.accumulates), Some(next.now));
        self.plan = match next {
            NextFrame { has_parts: true, .. } => Plan::Whole,
            NextFrame { is_held: true, accumulates: true, improves: true, .. } => Plan::Kept,
            NextFrame { is_held: true, .. } => Plan::Whole,
            NextFrame { accumulates: true, .. } => Plan::Preview,
            NextFrame { is_awaited: true, .. } => Plan::Whole,
            _ if self.has_moved => Plan::Preview,
            _ => Plan::Whole,
        };
        self.has_moved &= self.plan == Plan::Preview;
        self.is_planned = true;
        let is_other = next.change != Change::Nothing || self.movement.is_none();
        self.is_drawn = self.plan == Plan::Preview && (is_other || next.accumulates);
        if self.plan == Plan::Preview && is_other {
            let (previews, begun) = self.movement.map_or((0, next.now), |movement| (movement.previews, movement.begun));
            self.movement = Some(Movement { previews: previews + 1, side: self.side(), begun, last: next.now });
        }
        self.plan
    }

    /// The previews that the whole picture of the last frame has replaced.
    pub(in crate::app) fn take_movement(&mut self) -> Option<Movement> {
        self.movement.take_if(|_| self.plan == Plan::Whole)
    }

    /// Draws no parts and no previews until there is a new picture.
    pub(in crate::app) fn give_up(&mut self) {
        self.has_given_up = true;
    }

    fn note(&mut self, (change, accumulates): (Change, bool), now: Option<Instant>) {
        self.has_changed = change != Change::Nothing;
        match change {
            Change::Nothing => return,
            Change::Moved => self.has_moved = true,
            Change::New => {
                (self.whole_ms, self.is_first) = (None, true);
                (self.has_moved, self.has_given_up, self.warm) = (false, false, None);
                self.size.begin(accumulates);
            }
        }
        self.changed = now;
    }

    /// The time until the whole picture may be drawn in parts; `None` if the last frame needs none.
    pub(in crate::app) fn time_to_parts(&self, is_awaited: bool, now: Instant) -> Option<Duration> {
        let rested = self.changed.map_or(REST, |changed| now.saturating_duration_since(changed));
        match self.plan {
            Plan::Whole => None,
            Plan::Kept => Some(Duration::ZERO),
            Plan::Preview if is_awaited => Some(Duration::ZERO),
            Plan::Preview => Some(REST.saturating_sub(rested)),
        }
    }

    /// The time until the device may draw a preview that nobody sees; `None` if it may now.
    pub(in crate::app) fn time_to_warm(&self, now: Instant) -> Option<Duration> {
        let rested = now.saturating_duration_since(self.changed?);
        REST_TO_WARM.checked_sub(rested).filter(|left| !left.is_zero())
    }

    /// Whether the device has drawn a preview of the picture with these pipelines, or cannot.
    pub(in crate::app) fn is_warm(&self, of: &Arc<PipelineRequest>) -> bool {
        self.warm.as_ref() == Some(of)
    }

    /// Notes that the device draws such a preview.
    pub(in crate::app) fn warmed(&mut self, of: &Arc<PipelineRequest>) {
        self.warm = Some(of.clone());
        self.size.warmed();
    }

    /// Notes what a submitted frame has drawn, if its time counts.
    pub(in crate::app) fn submitted(&mut self, serial: u64, drawn: Drawn, now: Instant) {
        if self.has_changed && self.changed.is_some() {
            self.changed = Some(now);
        }
        let counts = match drawn {
            Drawn::Whole { .. } => !(std::mem::take(&mut self.is_first) && self.compiles_in_frame),
            Drawn::Preview { .. } => self.is_drawn,
        };
        if !counts {
            return;
        }
        self.awaited.push_back(Awaited { serial, drawn });
        if self.awaited.len() > MOST_AWAITED {
            self.awaited.pop_front();
        }
    }

    /// Takes the time of a finished frame, milliseconds: of all of it, and of what no size of the picture changes. Returns whether it was
    /// awaited.
    pub(in crate::app) fn finished(&mut self, serial: u64, ms: f64, fixed_ms: f64) -> bool {
        let Some(at) = self.awaited.iter().position(|awaited| awaited.serial == serial) else { return false };
        let Some(Awaited { drawn, .. }) = self.awaited.drain(..=at).next_back() else { return false };
        match drawn {
            Drawn::Whole { parts_ms } => self.whole_ms = Some(ms + parts_ms),
            Drawn::Preview { side, pixels_of_whole, accumulates } => {
                self.size.took((side, accumulates), ms, fixed_ms);
                let whole_ms = fixed_ms + (ms - fixed_ms).max(0.0) * pixels_of_whole;
                if self.whole_ms.is_none() && whole_ms < FAST_MS {
                    self.whole_ms = Some(whole_ms);
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame on a software device whose whole picture takes 500 ms, some time after `start`.
    fn slow() -> Previews {
        let mut previews = Previews::new(true);
        previews.submitted(1, Drawn::Whole { parts_ms: 0.0 }, Instant::now());
        previews.finished(1, 500.0, 10.0);
        previews
    }

    fn next(change: Change) -> NextFrame {
        NextFrame {
            change,
            accumulates: false,
            is_held: false,
            improves: false,
            has_parts: false,
            is_awaited: false,
            now: Instant::now(),
        }
    }

    #[test]
    fn previews_follow_a_movement_and_the_whole_picture_its_end() {
        let mut previews = slow();
        assert!(previews.may_preview(Adaptive::Auto) && !previews.may_preview(Adaptive::Off));
        assert_eq!(previews.plan(&NextFrame { is_held: true, ..next(Change::Nothing) }), Plan::Whole);
        assert_eq!(previews.time_to_parts(false, Instant::now()), None);
        let moved = next(Change::Moved);
        assert_eq!(previews.plan(&moved), Plan::Preview);
        assert_eq!((previews.take_movement(), previews.time_to_parts(false, moved.now)), (None, Some(REST)));
        let rests = NextFrame { now: moved.now + REST, ..next(Change::Nothing) };
        assert_eq!(previews.plan(&rests), Plan::Preview, "the mouse hovers over a panel");
        assert_eq!(previews.time_to_parts(false, rests.now), Some(Duration::ZERO));
        assert_eq!(previews.plan(&NextFrame { has_parts: true, ..rests }), Plan::Whole);
        let movement = previews.take_movement().unwrap();
        assert_eq!((movement.previews, movement.time(), movement.time_since(rests.now)), (1, Duration::ZERO, REST));
        assert_eq!(previews.plan(&NextFrame { is_held: true, ..rests }), Plan::Whole);
        assert!(previews.is_whole() && previews.take_movement().is_none());
    }

    /// Otherwise a part of the whole picture would be drawn between two previews, and the next frame would wait for it again.
    #[test]
    fn a_frame_that_waits_for_the_device_is_no_rest() {
        let mut previews = slow();
        let moved = next(Change::Moved);
        previews.plan(&moved);
        let submitted = moved.now + 2 * REST;
        previews.submitted(2, Drawn::Preview { side: 0.5, pixels_of_whole: 4.0, accumulates: false }, submitted);
        assert_eq!(previews.time_to_parts(false, submitted), Some(REST));
        // The panels alone change.
        previews.plan(&NextFrame { now: submitted, ..next(Change::Nothing) });
        previews.submitted(3, Drawn::Preview { side: 0.5, pixels_of_whole: 4.0, accumulates: false }, submitted + REST);
        assert_eq!(previews.time_to_parts(false, submitted + REST), Some(Duration::ZERO));
    }

    #[test]
    fn a_new_picture_and_an_awaited_one_are_whole() {
        let mut previews = slow();
        assert_eq!(previews.plan(&next(Change::New)), Plan::Whole);
        assert_eq!(previews.plan(&next(Change::Moved)), Plan::Preview);
        assert_eq!(previews.plan(&next(Change::New)), Plan::Whole, "an edit during a drag");
        assert_eq!(previews.plan(&NextFrame { is_awaited: true, ..next(Change::Moved) }), Plan::Whole);
        assert_eq!(previews.plan(&next(Change::Nothing)), Plan::Whole, "the same frame again, after a lack of memory");
    }

    #[test]
    fn path_tracing_is_drawn_in_parts_from_the_first_frame_on() {
        let mut previews = slow();
        let first = NextFrame { accumulates: true, improves: true, ..next(Change::New) };
        assert_eq!(previews.plan(&first), Plan::Preview);
        assert_eq!(previews.plan(&NextFrame { change: Change::Nothing, is_awaited: true, ..first }), Plan::Preview);
        assert_eq!(previews.time_to_parts(true, first.now), Some(Duration::ZERO));
        let rests = NextFrame { change: Change::Nothing, ..first };
        assert_eq!(previews.plan(&NextFrame { has_parts: true, ..rests }), Plan::Whole);
        assert_eq!(previews.plan(&NextFrame { is_held: true, ..rests }), Plan::Kept);
        assert!(previews.is_whole(), "a command need not wait for the next frame of the mean");
        assert_eq!(previews.plan(&NextFrame { is_held: true, improves: false, ..rests }), Plan::Whole);
    }

    #[test]
    fn the_time_of_a_preview_that_was_not_drawn_again_says_nothing() {
        let mut previews = Previews::new(true);
        assert_eq!(previews.plan(&next(Change::Moved)), Plan::Preview);
        let preview = Drawn::Preview { side: previews.side(), pixels_of_whole: 8.0, accumulates: false };
        previews.submitted(1, preview, Instant::now());
        assert!(previews.finished(1, 60.0, 10.0) && previews.whole_ms.is_none());
        assert_eq!(previews.plan(&next(Change::Nothing)), Plan::Preview, "the mouse stands still");
        previews.submitted(2, preview, Instant::now());
        assert!(!previews.finished(2, 11.0, 10.0));
        assert_eq!((previews.whole_ms, previews.may_preview(Adaptive::Auto)), (None, true));
        let mean = NextFrame { accumulates: true, ..next(Change::Nothing) };
        assert_eq!(previews.plan(&mean), Plan::Preview, "another frame of the mean");
        previews.submitted(3, preview, Instant::now());
        assert!(previews.finished(3, 60.0, 10.0));
    }

    #[test]
    fn a_fast_picture_has_no_previews() {
        let mut previews = Previews::new(true);
        assert!(previews.may_preview(Adaptive::Auto), "a software device is slow until its time is known");
        assert!(!Previews::default().may_preview(Adaptive::Auto), "a GPU is not");
        previews.show_whole(Change::New, false);
        previews.submitted(1, Drawn::Whole { parts_ms: 0.0 }, Instant::now());
        previews.finished(1, 900.0, 0.0);
        assert_eq!(previews.whole_ms, None, "the first frame has compiled");
        assert_eq!(previews.plan(&next(Change::Moved)), Plan::Preview);
        previews.submitted(2, Drawn::Preview { side: 0.5, pixels_of_whole: 8.0, accumulates: false }, Instant::now());
        previews.finished(2, 12.0, 10.0);
        assert_eq!(previews.whole_ms, Some(26.0));
        assert!(!previews.may_preview(Adaptive::Auto) && previews.may_preview(Adaptive::On));
        previews.submitted(3, Drawn::Whole { parts_ms: 40.0 }, Instant::now());
        previews.finished(3, 20.0, 10.0);
        assert!(previews.may_preview(Adaptive::Auto), "measured");
    }
}
