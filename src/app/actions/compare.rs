//! Compares the picture with another one: that of an older version of the shaders, one that the user has kept, that of a second
//! shader tree, or a picture from a file.
//!
//! The other side of a comparison is rendered by a second `View`, so neither side disturbs the accumulation buffer or
//! the history of the other; its left columns are copied over the newest frame. Until the other side is ready, the
//! present comparison stays. After a lost device, the next window does not restore the comparison.

pub(in crate::app) mod file;
mod switch;
pub(in crate::app) mod tree;
pub(in crate::app) mod write;

use std::sync::Arc;

use crate::app::actions::compare::file::open_picture;
use crate::app::actions::compare::tree::open_second_tree;
use crate::app::engine::Engine;
use crate::app::engine::compared::Compared;
use crate::app::options::OtherPicture;
use crate::app::state::State;
use crate::app::state::compare::{Difference, With};
use crate::events::{Event, emit};
use crate::picture_difference::Comparison;
use crate::shader::Source;
use switch::{REPLACED, compare, end};
pub(super) use write::write_files;

/// Takes the measured difference.
pub(in crate::app) fn on_compared(state: &mut State, number: u64, compared: Result<Box<Comparison>, String>) {
    // The result of pictures that have changed since counts for nothing.
    if state.compare.measuring.take_if(|measuring| *measuring == number).is_none() {
        return;
    }
    match compared {
        Ok(compared) if state.compare.is_on() => {
            let (flip, largest) = (compared.error, compared.largest);
            emit(&state.events, &Event::Compared { flip, largest });
            let map = Arc::new(compared.map().to_rgb8());
            let part = state.compare.measured_part();
            state.compare.difference = Some(Difference { flip, largest, map, part });
        }
        Ok(_) => {}
        Err(message) => state.say(message),
    }
}

/// Begins the comparison that the command line asks for.
pub(in crate::app) fn compare_at_start(state: &mut State, engine: &mut Engine, with: Option<OtherPicture>) {
    match with {
        Some(OtherPicture::File(path)) => open_picture(state, engine, &path),
        Some(OtherPicture::Tree(path)) => open_second_tree(state, engine, &path),
        None => {}
    }
}

/// The picture on screen as the other side of a comparison, if it is complete.
pub(in crate::app) fn this_picture(state: &State, engine: &Engine) -> Option<(With, Compared)> {
    let (shown, drawn) = state.picture.shown.clone().zip(engine.shown.clone())?;
    if state.is_cut_short() || drawn.scene().is_none() {
        return None;
    }
    let restored = state.edits.restored.as_ref().map(|restored| restored.number);
    let number = restored.unwrap_or_else(|| state.shown_version());
    Some((With::Kept(Box::new(shown), number), Compared::Kept(Box::new(drawn))))
}

/// Compares with a picture that is there; `None` ends the comparison.
pub(in crate::app) fn compare_with(state: &mut State, engine: &mut Engine, with: Option<(With, Compared)>) {
    (state.compare.opening, engine.opening_tree) = (None, None);
    compare(state, engine, with);
    state.waiting.comparison_failed(REPLACED);
    if matches!(state.compare.with, Some(With::Kept(..))) {
        state.say("Kept this picture. Change a file or a setting and compare; Ctrl+K ends it");
    }
}

/// Shows only the earlier picture while `on`: that of the comparison, or the one before the last edit. Returns whether that
/// changes what is on screen.
pub(in crate::app) fn hold_reference(state: &mut State, on: bool) -> bool {
    let has_one = state.compare.is_on() || state.version_before().is_some();
    if on && !has_one {
        state.say("There is no earlier picture: no edit has been shown yet");
    }
    let is_held = on && has_one;
    std::mem::replace(&mut state.compare.is_held, is_held) != is_held
}

/// Ends the comparison and drops old versions, while memory is short.
pub(in crate::app) fn forget_references(state: &mut State, engine: &mut Engine) {
    end(state, engine);
    state.versions.drop_old();
    engine.generations.keep(&state.versions);
}

/// Ends the comparison, and takes the versions of another tree in place of those of this one, which are kept. Returns its number.
pub(in crate::app) fn change_tree(state: &mut State, engine: &mut Engine, to: &Source) -> usize {
    end(state, engine);
    let tree = state.versions.change_tree(state.source.location(), to.location());
    engine.generations.keep(&state.versions);
    engine.generations.drop_pictures();
    tree
}

/// Marks a version in which a loop did not end, and releases its picture.
pub(in crate::app) fn cut_short(state: &mut State, engine: &mut Engine, number: u64) {
    state.versions.cut_short(number);
    engine.generations.drop_picture(number);
}

/// Ends the comparison, since a loop did not end in one of both pictures.
pub(in crate::app) fn end_comparison(state: &mut State, engine: &mut Engine) {
    if state.compare.is_on() || state.compare.is_held {
        end(state, engine);
        state.say("A loop did not end, so the comparison has ended");
    }
}
