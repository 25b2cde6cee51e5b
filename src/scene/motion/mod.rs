//! Models that move: what joints and morph targets do to vertices, and where everything is at one moment.

mod deformation;
mod pose;

pub use deformation::{Deformation, Displacement, Influence};
pub use pose::Pose;
