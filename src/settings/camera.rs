//! Settings of the camera.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::declare::settings;

settings! {
    /// The camera. Without `eye`, `azimuth` and `elevation` frame the model.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct CameraSettings {
        /// Vertical field of view.
        fovy: f32 = 35.0, limits(1.0, 170.0) unit(DEGREES) row("Field of view") slider(5.0, 120.0, 0);
        /// Position of the camera in meters: x, y, z. Without it, the camera frames the model.
        #[serde(skip_serializing_if = "Option::is_none")]
        eye: Option<[f32; 3]>, unit(METERS) row("Position");
        /// The point that the camera looks at and orbits around, in meters: x, y, z. Without it, the center of the model.
        #[serde(skip_serializing_if = "Option::is_none")]
        target: Option<[f32; 3]>, unit(METERS) row("Target");
        /// Up in the picture: x, y, z. Without it, +Y, or as the camera `name` has it.
        #[serde(skip_serializing_if = "Option::is_none")]
        up: Option<[f32; 3]>;
        /// Camera of the model's file, by its name or as #0 for the first: its place, unless `eye` or `target` is set, and its field of view.
        name: String;
        /// Parallel projection: height of the picture in meters. 0 is a perspective, or the projection of the camera `name`.
        height: f32 = 0.0, limits(0.0, 1e9) unit(METERS);
        /// Framing: angle around the model, from +Z towards +X.
        azimuth: f32 = 30.0, limits(-1e6, 1e6) unit(DEGREES);
        /// Framing: angle above the horizon.
        elevation: f32 = 15.0, limits(-90.0, 90.0) unit(DEGREES);
    }
}

impl CameraSettings {
    /// Frames the whole model again, from the same angles as before.
    pub fn frame_model(&mut self) {
        (self.eye, self.target, self.up, self.height) = (None, None, None, 0.0);
        self.name.clear();
    }

    /// Frames the whole model from the side from which `eye` looks at `target`.
    pub fn frame_from_here(&mut self) {
        if let (Some(eye), Some(target)) = (self.eye.map(Vec3::from), self.target.map(Vec3::from))
            && let Some(back) = (eye - target).try_normalize()
        {
            self.azimuth = back.x.atan2(back.z).to_degrees();
            self.elevation = back.y.clamp(-1.0, 1.0).asin().to_degrees();
        }
        self.frame_model();
    }
}
