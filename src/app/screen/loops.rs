//! Learns from finished frames whether their loops have ended.

use std::sync::Arc;

use super::request::FRAMES_IN_FLIGHT;
use crate::frame::FrameState;
use crate::gpu::Frames;

/// Whether the loops ended in something that the device has drawn.
pub(in crate::app) enum Ended {
    /// All loops of a frame have ended.
    Frame {
        state: Arc<FrameState>,
        /// The attempt number of the frame, see `app::frames::recording`.
        attempt: Option<u64>,
        /// Whether a loop of the previous picture did not end.
        is_repaired: bool,
    },
    /// A loop of the picture did not end, and what the device tells about it.
    Endless(Arc<FrameState>, [u32; 2]),
    /// A loop did not end in a frame that drew other pictures, too. They are no longer drawn.
    EndlessBeside,
    /// A loop of the thumbnail of this version did not end.
    EndlessThumbnail(u64),
}

/// The frames whose loops have to be checked.
#[derive(Default)]
pub(super) struct LoopChecks {
    /// The picture of each frame slot's last frame, until its loops are known to have ended.
    unchecked: [Option<Arc<FrameState>>; FRAMES_IN_FLIGHT],
    /// The attempt number of each of these frames.
    attempts: [Option<u64>; FRAMES_IN_FLIGHT],
    /// Whether each of these frames has also drawn another picture, in which a loop may not have ended.
    has_others: [bool; FRAMES_IN_FLIGHT],
    /// The last frame in which a loop did not end.
    endless: Option<Arc<FrameState>>,
    /// How many more frames are drawn only to learn whether the loops have ended.
    checks: usize,
    /// The results that nobody has taken yet.
    ended: Vec<Ended>,
}

impl LoopChecks {
    /// Checks the frame of this slot once it has finished.
    pub(super) fn add(&mut self, slot: usize, frame: Option<Arc<FrameState>>, attempt: Option<u64>, has_others: bool) {
        (self.unchecked[slot], self.attempts[slot]) = (frame, attempt);
        self.has_others[slot] |= has_others;
    }

    pub(super) fn thumbnail_is_endless(&mut self, version: u64) {
        self.ended.push(Ended::EndlessThumbnail(version));
    }

    /// A loop did not end in a part of a picture.
    pub(super) fn part_is_endless(&mut self, state: Arc<FrameState>, words: [u32; 2]) {
        self.endless = Some(state.clone());
        self.ended.push(Ended::Endless(state, words));
    }

    /// The results of loops since the last call, in the order of the frames.
    pub(super) fn take(&mut self) -> Vec<Ended> {
        std::mem::take(&mut self.ended)
    }

    /// Checks the loops of the finished frames, the older frame first. Returns whether a loop did not end in one that drew other pictures
    /// beside the newest, so that the picture must be drawn alone.
    pub(super) fn check(&mut self, frames: &Frames) -> bool {
        let mut ends_others = false;
        // The caller has waited for the current slot, whose frame is the oldest.
        for newer in 0..FRAMES_IN_FLIGHT {
            let slot = (frames.current() + newer) % FRAMES_IN_FLIGHT;
            if !frames.is_finished(slot) {
                continue;
            }
            let Some(state) = self.unchecked[slot].take() else { continue };
            let has_others = std::mem::take(&mut self.has_others[slot]);
            let ended = match frames.endless_loop(slot) {
                // The loop may belong to another picture.
                Some(_) if has_others => {
                    ends_others = true;
                    self.checks = FRAMES_IN_FLIGHT;
                    Ended::EndlessBeside
                }
                Some(words) => {
                    self.endless = Some(state.clone());
                    Ended::Endless(state, words)
                }
                None => {
                    let is_repaired = self.endless.take_if(|endless| !endless.is_same(&state)).is_some();
                    Ended::Frame { state, attempt: self.attempts[slot], is_repaired }
                }
            };
            self.ended.push(ended);
        }
        ends_others
    }

    /// Whether to draw one more frame, in which [`Self::check`] checks the previous ones. Without other events, at most as many frames
    /// follow as there are slots, so the window becomes idle.
    pub(super) fn awaits(&mut self, frames: &Frames) -> bool {
        let awaits = |slot: usize| self.unchecked[slot].is_some() && frames.has_loops(slot);
        self.checks = match ((0..FRAMES_IN_FLIGHT).any(awaits), self.checks) {
            (false, _) => 0,
            (true, 0) => FRAMES_IN_FLIGHT,
            (true, left) => left - 1,
        };
        self.checks > 0
    }
}
