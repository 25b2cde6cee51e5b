//! Brings models into poses: which clips play, where everything is then, and what that does to vertices and bounds.

mod extents;
mod playing;
mod pose;
mod values;
mod vertices;

pub use values::moved_materials;
