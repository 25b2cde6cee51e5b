//! Looks for NaN in a picture that has come to rest. The status bar tells of it.

use std::time::{Duration, Instant};

use super::progress::{is_settled, moves};
use crate::app::engine::Engine;
use crate::app::screen::Screen;
use crate::app::state::State;
use crate::app::state::picture::Scan;
use crate::interface::MODE_FINAL;
use crate::render::View;

/// A picture rests once it has been the same for this long.
const REST: Duration = Duration::from_millis(400);
/// Time between two looks for the result.
const POLL: Duration = Duration::from_millis(50);

/// Takes the result of a scan that has finished. Returns whether there is one.
pub(super) fn take_scan(state: &mut State, screen: &mut Screen) -> bool {
    let Some(pixels) = screen.take_scan() else { return false };
    state.picture.not_finite = Some((state.shown_generation(), pixels));
    state.picture.scan = Scan::Done(pixels.picture);
    true
}

/// Has `view` scan the next frame if its picture rests and was not scanned. Returns the time until the next step.
pub(super) fn plan_scan(state: &mut State, engine: &Engine, view: &mut View) -> Option<Duration> {
    let is_final = state.session.mode().is_some_and(|mode| mode.id == MODE_FINAL);
    let has_light = state.shown().is_some_and(|shown| shown.pipelines.draws_model);
    if !(is_final && has_light && is_settled(state, engine)) || moves(state) {
        state.picture.scan = Scan::Moves;
        return None;
    }
    let picture = view.picture();
    match state.picture.scan {
        Scan::Done(of) if of == picture => None,
        Scan::Asked(of) if of == picture => Some(POLL),
        Scan::Rests(of, since) if of == picture => {
            let left = REST.checked_sub(since.elapsed());
            if left.is_none() {
                view.scans = true;
                state.picture.scan = Scan::Asked(picture);
            }
            Some(left.unwrap_or(POLL))
        }
        _ => {
            state.picture.scan = Scan::Rests(picture, Instant::now());
            Some(REST)
        }
    }
}
