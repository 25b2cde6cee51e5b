//! The shader tree on screen: its state, its last edits, its stages, and how texts differ.

pub(in crate::app) mod difference;
pub(in crate::app) mod log;
pub(in crate::app) mod stages;
pub(in crate::app) mod status;
