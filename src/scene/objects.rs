//! Lights and cameras of a model, placed in the world.

use std::fmt;
use std::sync::Arc;

use glam::Vec3;

/// Kind of a light, which determines the unit of its intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light; intensity in lux.
    Directional,
    /// Intensity in candela.
    Point,
    /// Intensity in candela; cone half-angles in radians.
    Spot {
        /// Angle where the falloff starts.
        inner: f32,
        /// Angle where the falloff ends.
        outer: f32,
    },
}

/// A punctual light in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name, or empty.
    pub name: Arc<str>,
    /// Kind and cone.
    pub kind: LightKind,
    /// World position, meters.
    pub position: Vec3,
    /// Unit vector along which the light shines.
    pub direction: Vec3,
    /// Linear RGB times candela or lux.
    pub intensity: Vec3,
    /// Distance in meters beyond which the light has no effect; `None` is unlimited.
    pub range: Option<f32>,
}

/// A camera of the model in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name, or empty.
    pub name: Arc<str>,
    /// Position.
    pub eye: Vec3,
    /// View direction, unit.
    pub forward: Vec3,
    /// Up direction, unit.
    pub up: Vec3,
    /// Its projection.
    pub lens: Lens,
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// A vertical field of view in radians, above 0 and below pi.
    Perspective {
        /// The angle.
        fovy: f32,
    },
    /// Parallel rays.
    Orthographic {
        /// Height of the visible area, meters, above 0.
        height: f32,
    },
}

impl fmt::Display for Lens {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Perspective { fovy } => write!(f, "{:.0}\u{b0}", fovy.to_degrees()),
            Self::Orthographic { height } => write!(f, "{height} m"),
        }
    }
}
