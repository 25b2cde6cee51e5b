//! Several models that are shown together, and where the settings put each.

use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, Mat4};

use super::motion::Transform;
use crate::settings::ModelSettings;

/// One of several models that are shown together.
#[derive(Clone, Debug, Default)]
pub struct Member {
    /// Its name; if a member before it has the same, with a number.
    pub name: Arc<str>,
    /// Its file as the settings name it; empty for the first model.
    pub file: String,
    /// The node in `Model::nodes` that all of its nodes are below.
    pub node: usize,
    /// The node of the rig that all of it follows.
    pub root: usize,
    /// Where the origin of its file is without the settings, meters.
    pub origin: DVec3,
    /// Taken from all positions of its file: see `Rig::shift`.
    pub shift: DVec3,
    /// Its clips.
    pub clips: Range<usize>,
}

impl Member {
    /// The transform of its root.
    pub fn transform(&self, place: &ModelSettings) -> Transform {
        let [x, y, z] = place.rotation.map(|degrees| f64::from(degrees).to_radians());
        let rotation = DQuat::from_euler(glam::EulerRot::YXZ, y, x, z);
        let scale = DVec3::splat(place.scale.into());
        let moved = DMat3::from_quat(rotation) * (scale * self.shift);
        let translation = self.origin + glam::Vec3::from(place.translation).as_dvec3() - moved;
        Transform { translation, rotation, scale }
    }

    /// The transform of its root without the settings.
    pub fn rest(&self) -> Transform {
        self.transform(&ModelSettings::default())
    }
}

/// Where the settings put a model, or each of several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// World from the file's world. `None`: both are the same.
    pub whole: Option<Mat4>,
    /// The roots of members that are not in their place in the row, with their transforms.
    pub roots: Vec<(usize, Transform)>,
}

impl From<Option<Mat4>> for Places {
    fn from(whole: Option<Mat4>) -> Self {
        Self { whole, roots: Vec::new() }
    }
}
