//! The frame that the state describes: what it is, what it lacks, and whether it is final.

pub(super) mod picture;
pub(super) mod progress;
pub(super) mod recording;
pub(super) mod reference;
pub(super) mod stages;
pub(super) mod title;
