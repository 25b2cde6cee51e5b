//! The shader tree on screen: its state, its last edits, its stages, and how texts differ.

pub(in crate::app) mod difference;
pub(in crate::app) mod edits;
pub(in crate::app) mod effects;
pub(in crate::app) mod log;
pub(in crate::app) mod stages;
pub(in crate::app) mod status;
pub(in crate::app) mod versions;
