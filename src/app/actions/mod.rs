//! Functions that carry out commands and messages on the state and the engine, by topic.

pub(super) mod checks;
pub(super) mod compare;
pub(super) mod costs;
pub(super) mod edits;
pub(super) mod exercises;
pub(super) mod files;
pub(super) mod guests;
pub(super) mod inspect;
pub(super) mod restored;
pub(super) mod select;
pub(super) mod sessions;
pub(super) mod texts;
pub(super) mod trace;
pub(super) mod trees;
pub(super) mod watch;
pub(super) mod work;
