//! The lights of a frame, for a trace.

use crate::frame::FrameState;
use crate::interface::{LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT};
use crate::scene::light_names;
use crate::settings::Settings;
use crate::shader::trace::TracedLight;

/// The lights of a frame with these settings, in the order in which shaders number them.
pub(super) fn traced_lights(state: &FrameState, settings: &Settings) -> Vec<TracedLight> {
    let Some(scene) = &state.scene else { return Vec::new() };
    let names = light_names(&settings.lights, scene.model());
    let lights = state.lights.iter().zip(names).map(|(light, name)| {
        let (kind, unit) = match light.kind {
            LIGHT_DIRECTIONAL => ("directional", "lx"),
            LIGHT_POINT => ("point", "cd"),
            LIGHT_SPOT => ("spot", "cd"),
            _ => ("rectangle", "cd/m²"),
        };
        TracedLight { name, kind, intensity: light.intensity, unit }
    });
    lights.collect()
}
