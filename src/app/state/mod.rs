//! What the window knows, in stores without objects of the user interface, of the window system or of the device. Each store keeps one
//! invariant and has its own tests. Stores know neither the viewer nor panels.

pub(super) mod arrangement;
pub(super) mod exercise;
pub(super) mod grid;
pub(super) mod hint;
pub(super) mod history;
pub(super) mod inspection;
pub(super) mod last_session;
pub(super) mod model;
pub(super) mod notices;
pub(super) mod playback;
pub(super) mod recent;
pub(super) mod selection;
pub(super) mod shaders;
pub(super) mod timing;
pub(super) mod watched_files;
pub(super) mod workspace;
