//! Models that move: clips and their curves, the hierarchy that they move, what joints and morph targets do to vertices, and where everything
//! is at one moment.

mod clip;
mod curve;
mod deformation;
mod extent;
mod hidden;
mod pose;
mod property;
mod reach;
mod rig;
mod transform;

pub use clip::{Channel, Clip, Target};
pub use curve::{Curve, Interpolation};
pub use deformation::{Deformation, Displacement, Influence};
pub use extent::Extent;
pub use hidden::Hidden;
pub use pose::{Motion, Playing, Pose};
pub use property::{Property, Values};
pub use reach::Reach;
pub use rig::{Placement, Rig, RigNode, Skin};
pub use transform::{Transform, slerp};
