//! Visible parts of the model, and its placement.

use glam::{EulerRot, Mat4, Quat, Vec3};
use serde::{Deserialize, Serialize};

use super::declare::settings;
use super::list::names;

settings! {
    /// The nodes and primitives that are drawn. A name is that of a node (with all below it) or of a primitive, as `Shell #0`; `#3` is the
    /// node with this index in the file.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct SceneSettings {
        /// Nodes and primitives that are not drawn: names, or #3 for the node with this index.
        #[serde(deserialize_with = "names")]
        hidden: Vec<String>;
        /// Nodes and primitives that alone are drawn; none: all.
        #[serde(deserialize_with = "names")]
        isolated: Vec<String>;
    }
}

settings! {
    /// Where the model stands: scaled, then rotated, then moved, all about the origin of its file. Its lights and cameras go with it.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ModelSettings {
        /// Rotation of the model about its X, Y and Z axis: about Z first, then about X, then about Y.
        rotation: [f32; 3], limits(-1e6, 1e6) unit(DEGREES) row("Rotation") slider(-180.0, 180.0, 0);
        /// Factor on all lengths of the model. The camera frames the model again unless it was moved; lights follow its size.
        scale: f32 = 1.0, limits(1e-3, 1e3) unit(FACTOR) row("Scale") logarithmic(0.01, 100.0, 2);
        /// Where the origin of the model's file is. The camera follows unless it was moved.
        translation: [f32; 3], limits(-1e6, 1e6) unit(METERS) row("Move") slider(-10.0, 10.0, 2);
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
