//! Visible parts of the model, and its placement.

use glam::{EulerRot, Mat4, Quat, Vec3};
use serde::{Deserialize, Serialize};

use super::Range;
use super::list::names;

/// The nodes and primitives that are drawn. A name is that of a node (with all below it) or of a primitive, as `Shell #0`; `#3` is the
/// node with this index in the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SceneSettings {
    /// Names of the parts that are not drawn.
    #[serde(deserialize_with = "names")]
    pub hidden: Vec<String>,
    /// If it names anything, nothing else is drawn.
    #[serde(deserialize_with = "names")]
    pub isolated: Vec<String>,
}

/// Where the model stands: scaled, then rotated, then moved, all about the origin of its file. Its lights and cameras go with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelSettings {
    /// Degrees about the axes X, Y and Z of the model: about Z first, then X, then Y.
    pub rotation: [f32; 3],
    /// Factor on all lengths.
    pub scale: f32,
    /// Meters.
    pub translation: [f32; 3],
}

impl Default for ModelSettings {
    fn default() -> Self {
        Self { rotation: [0.0; 3], scale: 1.0, translation: [0.0; 3] }
    }
}

impl ModelSettings {
    /// From the file's world to the world; `None` if both are the same.
    pub fn transform(&self) -> Option<Mat4> {
        let [x, y, z] = self.rotation.map(f32::to_radians);
        let rotation = Quat::from_euler(EulerRot::YXZ, y, x, z);
        let place =
            || Mat4::from_scale_rotation_translation(Vec3::splat(self.scale), rotation, Vec3::from(self.translation));
        (*self != Self::default()).then(place)
    }

    /// All numbers with their paths and limits.
    pub(super) fn ranges(&self) -> Vec<Range> {
        let mut ranges = Range::all("model.rotation", &self.rotation, -1e6..=1e6);
        ranges.push(Range::new("model.scale", self.scale, 1e-3..=1e3));
        ranges.extend(Range::all("model.translation", &self.translation, -1e6..=1e6));
        ranges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rotation_turns_about_z_then_x_then_y() {
        assert_eq!(ModelSettings::default().transform(), None);
        let settings = ModelSettings { rotation: [90.0, 90.0, 0.0], scale: 2.0, translation: [0.0, 0.0, 1.0] };
        let place = settings.transform().unwrap();
        // +Y goes to +Z about X, and on to +X about Y.
        let there = place.transform_point3(Vec3::Y);
        assert!(there.distance(Vec3::new(2.0, 0.0, 1.0)) < 1e-5, "{there}");
    }
}
