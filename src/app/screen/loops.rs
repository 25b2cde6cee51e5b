//! Learns from finished frames whether their loops have ended.

use super::{FRAMES_IN_FLIGHT, Screen};
use crate::app::actions::compare::{cut_short, end_comparison};
use crate::app::engine::Engine;
use crate::app::frames::recording::drawn;
use crate::app::messages::reloads::on_endless_loop;
use crate::app::state::State;

impl Screen {
    /// Reports to the viewer whether the loops of the finished frames have ended, the older frame first.
    pub(super) fn check_loops(&mut self, state: &mut State, engine: &mut Engine) {
        // `begin` has waited for the current slot, whose frame is the oldest.
        for newer in 0..FRAMES_IN_FLIGHT {
            let slot = (self.frames.current() + newer) % FRAMES_IN_FLIGHT;
            if !self.frames.is_finished(slot) {
                continue;
            }
            let Some(frame_state) = self.unchecked[slot].take() else { continue };
            let has_others = std::mem::take(&mut self.has_others[slot]);
            if self.frames.endless_loop(slot).is_some() && has_others {
                // The loop may belong to another picture, so the picture is drawn again, alone.
                self.end_others(state, engine);
                continue;
            }
            if let Some(words) = self.frames.endless_loop(slot) {
                cut_short(state, engine, frame_state.shaders.generation);
                self.endless = Some(frame_state);
                on_endless_loop(state, engine, words);
                continue;
            }
            drawn(state, engine, &frame_state, self.attempts[slot]);
            if self.endless.take_if(|endless| !endless.is_same(&frame_state)).is_some() {
                state.versions.loops_end(frame_state.shaders.generation);
                state.all_loops_end();
            }
        }
    }

    /// Draws nothing beside the picture until something changes.
    fn end_others(&mut self, state: &mut State, engine: &mut Engine) {
        self.end_background(state, engine);
        self.cells.clear();
        state.grid.end();
        end_comparison(state, engine);
        self.view.forget();
        self.checks = FRAMES_IN_FLIGHT;
        self.redraws = true;
    }

    /// Whether to draw one more frame, in which [`Self::check_loops`] checks the previous ones. Without other events, at most as
    /// many frames follow as there are slots, so the window becomes idle.
    pub(super) fn awaits_loops(&mut self) -> bool {
        let awaits = (0..FRAMES_IN_FLIGHT).any(|slot| self.unchecked[slot].is_some() && self.frames.has_loops(slot));
        self.checks = match (awaits, self.checks) {
            (false, _) => 0,
            (true, 0) => FRAMES_IN_FLIGHT,
            (true, left) => left - 1,
        };
        self.checks > 0
    }
}
