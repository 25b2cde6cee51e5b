//! Brings models into poses: which clips play, where everything is then, and what that does to vertices and bounds.

mod extents;
mod held;
mod places;
mod playing;
mod pose;
mod settled;
mod values;
mod vertices;

pub use held::held_entry;
pub use values::{moved_environment, moved_materials};
