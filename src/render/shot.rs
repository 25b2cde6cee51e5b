//! What a frame shows: camera, lights and values, worked out from the settings, the model and the shaders.

use crate::gpu::Rect;
use crate::interface::{Frame, Light, MAX_LIGHTS};
use crate::scene::{self, Model, View};
use crate::settings::Settings;
use crate::shader::ShaderSet;

use crate::render::values;
use crate::render::wanted;

/// Paths a pixel in each frame of a mode that accumulates.
const PATHS: u32 = 8;

/// One picture's inputs, ready for the device.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Camera.
    pub view: View,
    /// Lights in world space.
    pub lights: Vec<Light>,
    /// The author's parameter block.
    pub params: Vec<u8>,
    frame: Frame,
}

impl Shot {
    /// Works out a shot of `model` (or of nothing) `time_s` seconds after the start.
    ///
    /// A value of the author's that does not fit its parameter leaves the parameter's default; see [`super::misfits`].
    pub fn new(settings: &Settings, shaders: Option<&ShaderSet>, model: &Model, view: View, time_s: f32) -> Self {
        let mut lights = scene::lights(&settings.lights, model, 0.0);
        lights.truncate(MAX_LIGHTS);
        let mode = shaders.and_then(|s| wanted::mode(s, &settings.mode));
        let params = shaders.map(|s| values::params(&settings.shader, &s.parameters)).unwrap_or_default();
        let ambient = settings.lights.ambient_color.map(|c| c * settings.lights.ambient_strength);
        let exposure = 1.0 / (1.2 * settings.view.ev.exp2());
        let view_from_world = view.view_from_world();
        let clip_from_world = view.clip_from_world();
        let turn = settings.environment.rotation.to_radians();
        let frame = Frame {
            clip_from_world: clip_from_world.to_cols_array_2d(),
            world_from_clip: clip_from_world.inverse().to_cols_array_2d(),
            view_from_world: view_from_world.to_cols_array_2d(),
            eye_ws: view.eye.to_array(),
            exposure,
            ambient,
            time_s,
            background: settings.view.background_linear().unwrap_or_default(),
            scene_center_ws: model.bounds.center().to_array(),
            scene_radius: model.bounds.radius(),
            near: view.near,
            far: view.far,
            light_count: lights.len() as u32,
            chosen_light: settings.lights.chosen,
            mode: mode.map_or(0, |m| m.id),
            environment_rotation: [turn.cos(), turn.sin()],
            environment_intensity: if settings.environment.is_lit() { settings.environment.intensity } else { 0.0 },
            environment_blur: settings.environment.blur,
            sample_count: PATHS,
            ..Default::default()
        };
        Self { view, lights, params, frame }
    }

    /// The frame's uniforms for a picture in this part of the output, whose HDR target holds values up to `largest`, under an
    /// environment whose images hold radiance times `scale`. `sample_index` counts the frames of one picture.
    pub(super) fn uniforms(&self, rect: Rect, largest: f32, scale: f32, sample_index: u32) -> Frame {
        Frame {
            largest_value: largest,
            environment_intensity: self.frame.environment_intensity / scale,
            sample_index,
            viewport_px: [rect.width as f32, rect.height as f32],
            viewport_origin_px: [rect.x as f32, rect.y as f32],
            ..self.frame
        }
    }
}
