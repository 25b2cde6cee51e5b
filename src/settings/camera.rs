//! Settings of the camera.

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
        /// Framing: angle around the model, from +Z towards +X.
        azimuth: f32 = 30.0, limits(-1e6, 1e6) unit(DEGREES);
        /// Framing: angle above the horizon.
        elevation: f32 = 15.0, limits(-90.0, 90.0) unit(DEGREES);
    }
}
