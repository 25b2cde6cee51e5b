//! Begins and ends a comparison: what it shows and what draws that change together.

use crate::app::engine::Engine;
use crate::app::engine::compared::Compared;
use crate::app::state::State;
use crate::app::state::compare::With;

/// The answer to a request for a comparison that a newer one has replaced.
pub(super) const REPLACED: &str = "the comparison was ended or replaced before it was shown";

/// Compares with another picture, or with none.
pub(super) fn compare(state: &mut State, engine: &mut Engine, with: Option<(With, Compared)>) {
    let (with, compared) = with.unzip();
    state.compare.set(with);
    engine.compared = compared.unwrap_or_default();
}

/// Ends the comparison.
pub(super) fn end(state: &mut State, engine: &mut Engine) {
    state.compare.end();
    (engine.compared, engine.opening_tree) = (Compared::Nothing, None);
}
