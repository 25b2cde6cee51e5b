//! A picture as a value: its uniforms, and the keys of the pipelines and resources that draw it.
//!
//! [`FrameState::new`] is a pure function. Each frame draws exactly one state, so no picture mixes two versions of settings,
//! shaders or resources.

mod baked;
mod date;
mod display;
mod formats;
mod inputs;
mod keys;
mod material_variant;
mod mode_sets;
mod pass_blocks;
mod pipeline_key;
mod pipelines;
mod scene;
mod shared_mode;
pub mod stages;

use std::sync::Arc;

pub(crate) use baked::BakeStage;
pub use baked::{BakeValues, EnvironmentKey, TablesKey};
pub use date::Date;
pub use display::{Display, Limits, legend_limits, short};
pub use formats::TargetFormat;
pub(crate) use formats::pass_format;
pub(crate) use inputs::BEYOND;
pub use inputs::{Clock, FrameInputs, MeasuredKey, Revisions};
pub use keys::{Keys, key_names};
pub use material_variant::MaterialVariant;
pub(crate) use material_variant::QUADS;
pub use mode_sets::mode_sets;
pub(crate) use pass_blocks::PassBlocks;
use pass_blocks::pass_blocks;
pub(crate) use pipeline_key::PipelineKey;
pub use pipelines::PipelineRequest;
pub(crate) use pipelines::draws_by_index;
pub(crate) use scene::Appearance;
pub use scene::Scene;
pub use shared_mode::SharedMode;

use glam::Mat4;

use crate::gpu::Rect;
use crate::interface::{Frame, Light, MAX_LIGHT_VIEWS, MAX_LIGHTS};
use crate::scene::environment::MODEL;
use crate::scene::{
    Bounds, CameraView, LightGrid, Model, Sun, lights, moved_environment, separates_suns, view_of, view_of_light,
};
use crate::settings::Settings;
use crate::shader::graph::RenderPhase;
use crate::shader::{Mode, ShaderSet, values};

/// Largest half float.
pub(crate) const LARGEST_HALF: f32 = 65504.0;

/// Factor on the environment's radiance, and its angle around +Y, radians. A model's own environment has both in the pose too.
fn environment_now(settings: &Settings, model: &Model) -> (f32, f32) {
    let environment = &settings.environment;
    let of_model = model.environment.as_ref().filter(|_| environment.name == MODEL);
    let (intensity, angle) = of_model.map_or((1.0, 0.0), |of_model| moved_environment(of_model, &model.pose.values));
    (environment.intensity * intensity, environment.rotation.to_radians() + angle)
}

/// The part of a frame that depends on neither camera, time nor size. Frames that differ only by these share it.
struct Needs {
    pipelines: Arc<PipelineRequest>,
    params: Arc<[u8]>,
    tables: Arc<TablesKey>,
    environment: Option<Arc<EnvironmentKey>>,
    measured: Option<MeasuredKey>,
}

impl Needs {
    /// `pipelines`: those of a picture without suns.
    fn new(inputs: &FrameInputs<'_>, pipelines: PipelineRequest) -> Self {
        let FrameInputs { settings, shaders, scene, revisions, .. } = *inputs;
        let pipelines = pipelines.for_suns(revisions.suns_of(settings));
        let params: Arc<[u8]> = values::params(&settings.shader, &shaders.parameters).into();
        let values = BakeValues { constants: &pipelines.constants, params: &params };
        let environment = || {
            let (name, revision) = (&settings.environment.name, revisions.environment);
            let suns = separates_suns(&settings.environment);
            let of_model = scene.and_then(|scene| scene.model().environment.as_ref());
            Arc::new(EnvironmentKey::new((name, revision, suns), of_model, shaders, values))
        };
        // Before there is a model, its environment is unknown.
        let is_known = settings.environment.name != MODEL || scene.is_some();
        Self {
            tables: Arc::new(TablesKey::new(shaders, values)),
            environment: (settings.environment.is_lit() && is_known).then(environment),
            measured: (!settings.measured.is_empty())
                .then(|| MeasuredKey { path: settings.measured.as_str().into(), revision: revisions.measured }),
            pipelines: Arc::new(pipelines),
            params,
        }
    }
}

/// One frame as an immutable value.
#[derive(Clone, Debug)]
pub struct FrameState {
    /// The shaders that draw it.
    pub shaders: Arc<ShaderSet>,
    /// The pipelines that draw it.
    pub pipelines: Arc<PipelineRequest>,
    /// The model and its materials.
    pub scene: Option<Scene>,
    /// BRDF lookup tables, for the selected models.
    pub tables: Arc<TablesKey>,
    /// Image-based light. Without it, ambient light of the settings is used.
    pub environment: Option<Arc<EnvironmentKey>>,
    /// Measured BRDF, for the modes that show one.
    pub measured: Option<MeasuredKey>,
    /// Camera.
    pub camera: CameraView,
    /// Lights in world space, at most [`MAX_LIGHTS`].
    pub lights: Vec<Light>,
    /// The lights by the places that they reach.
    pub light_grid: Arc<LightGrid>,
    /// Width and height, pixels, at least 1.
    pub size: (u32, u32),
    /// How the display maps values to colors.
    pub display: Display,
    /// The same for each mode of a set of thumbnails: value of `MODE`, components of a value, display.
    pub displays: Vec<(u32, u8, Display)>,
    /// Bytes that images and buffers of passes may take.
    pub pass_memory: u64,
    params: Arc<[u8]>,
    pass_blocks: PassBlocks,
    constants: Frame,
}

impl FrameState {
    /// Describes a frame. Pure: equal inputs give equal states.
    pub fn new(inputs: &FrameInputs<'_>) -> Self {
        let FrameInputs { settings, shaders, scene, target, .. } = *inputs;
        Self::with_needs(inputs, Needs::new(inputs, PipelineRequest::new(settings, shaders, scene, target)), None)
    }

    /// The same picture from another camera, with orbiting lights in other directions, at another time or size, so that the model is in
    /// another pose: `settings` are alike ([`Settings::is_alike`]).
    #[must_use]
    pub fn moved(&self, settings: &Settings, clock: Clock, size: (u32, u32)) -> Self {
        let needs = Needs {
            pipelines: self.pipelines.clone(),
            params: self.params.clone(),
            tables: self.tables.clone(),
            environment: self.environment.clone(),
            measured: self.measured.clone(),
        };
        let posed = self.scene.as_ref().map(|scene| scene.at(&settings.animation, clock.time_s));
        // A material that needs other pipelines than this picture has waits for the next one.
        let fits = |posed: &Scene| self.scene.as_ref().is_some_and(|scene| scene.materials() == posed.materials());
        let posed = posed.filter(fits).or_else(|| self.scene.clone());
        let (shaders, scene, target) = (&self.shaders, posed.as_ref(), self.pipelines.target);
        let revisions = Revisions::default();
        Self::with_needs(&FrameInputs { settings, shaders, scene, revisions, clock, size, target }, needs, Some(self))
    }

    /// The state of thumbnails of these modes, which are one of [`mode_sets`]. Passes after the model except the tone map are
    /// left out.
    pub fn of_modes(inputs: &FrameInputs<'_>, modes: &[&Mode]) -> Self {
        let FrameInputs { settings, shaders, scene, target, .. } = *inputs;
        let displays = modes.iter().map(|mode| (mode.id, mode.components, Display::new(&settings.view, Some(mode))));
        let pipelines = PipelineRequest::of_modes(settings, shaders, scene, target, modes);
        Self { displays: displays.collect(), ..Self::with_needs(inputs, Needs::new(inputs, pipelines), None) }
    }

    /// `needs` are those of the inputs. `before`: a frame of the same pipelines.
    fn with_needs(inputs: &FrameInputs<'_>, needs: Needs, before: Option<&Self>) -> Self {
        let FrameInputs { settings, shaders, scene, clock, size, target, .. } = *inputs;
        let Needs { pipelines, params, tables, environment, measured } = needs;
        let size = (size.0.max(1), size.1.max(1));
        let nothing = Model::default();
        let model = scene.map_or(&nothing, |scene| scene.model());
        let bounds = &model.bounds;
        let camera = view_of(model, &settings.camera, size.0 as f32 / size.1 as f32);
        let mut lights = lights(&settings.lights, model, 0.0);
        lights.truncate(MAX_LIGHTS);
        let has_grid = pipelines.many_lights && !shaders.moves_lights();
        let light_grid = before.filter(|before| before.is_lit_by(&lights, bounds)).map_or_else(
            || Arc::new(if has_grid { LightGrid::new(&lights, bounds) } else { LightGrid::everywhere(lights.len()) }),
            |before| before.light_grid.clone(),
        );
        let lit = settings.environment.is_lit();
        let clip_from_world = camera.clip_from_world();
        let (environment_intensity, turn) = environment_now(settings, model);
        let constants = Frame {
            clip_from_world: clip_from_world.to_cols_array_2d(),
            world_from_clip: clip_from_world.inverse().to_cols_array_2d(),
            view_from_world: camera.view_from_world().to_cols_array_2d(),
            eye_ws: camera.eye.to_array(),
            exposure: 1.0 / (1.2 * settings.view.ev.exp2()),
            ambient: settings.lights.ambient_color.map(|c| c * settings.lights.ambient_strength),
            time_s: clock.time_s,
            delta_s: clock.delta_s,
            frame_index: clock.frame_index,
            mouse_px: clock.mouse_px,
            cursor_px: clock.cursor_px,
            mouse_buttons: clock.mouse_buttons,
            date: clock.date.parts(),
            keys: clock.keys.words(),
            background: settings.view.background_linear().unwrap_or_default(),
            scene_center_ws: bounds.center().to_array(),
            scene_radius: bounds.radius(),
            scene_min_ws: bounds.min.to_array(),
            scene_max_ws: bounds.max.to_array(),
            viewport_px: [size.0 as f32, size.1 as f32],
            near: camera.near,
            far: camera.far,
            light_count: lights.len() as u32,
            chosen_light: settings.lights.chosen,
            mode: pipelines.mode,
            largest_value: if target.is_half() { LARGEST_HALF } else { f32::MAX },
            environment_rotation: [turn.cos(), turn.sin()],
            environment_intensity: if lit { environment_intensity } else { 0.0 },
            environment_blur: settings.environment.blur,
            sample_count: pipelines.paths_per_frame(),
            path_bounces: settings.view.bounces,
            light_clip_from_world: std::array::from_fn(|index| {
                lights.get(index).map_or(Mat4::ZERO, |light| view_of_light(light, bounds)).to_cols_array_2d()
            }),
            ..Default::default()
        };
        Self {
            pass_blocks: pass_blocks(settings, shaders, &pipelines, size, clock),
            tables,
            environment,
            measured,
            displays: Vec::new(),
            display: Display::new(&settings.view, shaders.modes.iter().find(|mode| mode.id == pipelines.mode)),
            shaders: shaders.clone(),
            scene: scene.cloned(),
            params,
            pipelines,
            camera,
            lights,
            light_grid,
            size,
            pass_memory: u64::from(settings.view.pass_memory) << 20,
            constants,
        }
    }

    /// The same frame for reading single pixels: modes that show a color for each number output the number.
    pub fn with_numbers(mut self) -> Self {
        self.constants.gives_numbers = 1;
        self
    }

    /// The debug mode that it shows; `None` only for a tree without modes.
    pub fn mode(&self) -> Option<&Mode> {
        self.shaders.modes.iter().find(|mode| mode.id == self.pipelines.mode)
    }

    /// Factor from luminance to the display's 0..1.
    pub fn exposure(&self) -> f32 {
        self.constants.exposure
    }

    /// Whether both states draw the same frame, bit for bit.
    pub fn is_same(&self, other: &Self) -> bool {
        self.is_same_with(other, &self.constants, &other.constants) && self.pass_blocks == other.pass_blocks
    }

    /// Whether they differ only in the time and in the parameters of passes that follow the model.
    pub fn is_same_model(&self, other: &Self) -> bool {
        let timeless = |frame: &Frame| Frame {
            time_s: 0.0,
            delta_s: 0.0,
            frame_index: 0,
            mouse_px: [0.0; 4],
            cursor_px: [0.0; 2],
            mouse_buttons: 0,
            date: [0.0; 4],
            ..*frame
        };
        let blocks = |state: &Self| -> PassBlocks {
            let passes = &state.pipelines.passes;
            let is_read = |index: usize| passes.get(index).is_some_and(|pass| pass.phase <= RenderPhase::Mean);
            state.pass_blocks.clone().into_iter().filter(|((index, _), _)| is_read(*index)).collect()
        };
        self.is_same_with(other, &timeless(&self.constants), &timeless(&other.constants))
            && blocks(self) == blocks(other)
    }

    /// Whether these are its lights, shining on a model with these bounds.
    fn is_lit_by(&self, lights: &[Light], bounds: &Bounds) -> bool {
        self.scene.as_ref().is_some_and(|scene| scene.model().bounds == *bounds)
            && bytemuck::cast_slice::<Light, u8>(&self.lights) == bytemuck::cast_slice::<Light, u8>(lights)
    }

    fn is_same_with(&self, other: &Self, own: &Frame, others: &Frame) -> bool {
        self.shaders.generation == other.shaders.generation
            && bytemuck::bytes_of(own) == bytemuck::bytes_of(others)
            && bytemuck::cast_slice::<Light, u8>(&self.lights) == bytemuck::cast_slice::<Light, u8>(&other.lights)
            && self.light_grid == other.light_grid
            && self.params == other.params
            && self.pipelines == other.pipelines
            && self.scene == other.scene
            && self.tables == other.tables
            && self.environment == other.environment
            && self.measured == other.measured
    }

    /// The content of the author's parameter block, `PARAMS_SIZE` bytes.
    pub(crate) fn params(&self) -> &[u8] {
        &self.params
    }

    /// The content of the uniform blocks of declared passes.
    pub(crate) fn pass_blocks(&self) -> &PassBlocks {
        &self.pass_blocks
    }

    /// The same frame with an environment that has this many suns.
    pub(crate) fn for_suns(&self, suns: u32) -> Self {
        Self { pipelines: Arc::new((*self.pipelines).clone().for_suns(suns)), ..self.clone() }
    }

    /// As many suns as the pipelines expect, each with its light in this frame. Suns that the environment lacks are dark. The
    /// environment's images hold radiance times `scale`.
    fn suns<'a>(&'a self, (scale, suns): (f32, &'a [Sun])) -> impl Iterator<Item = (Sun, Light)> + 'a {
        let factor = self.constants.environment_intensity / scale;
        let dark = Sun { direction: [0.0, 1.0, 0.0], ..Sun::default() };
        let all = suns.iter().copied().chain(std::iter::repeat(dark)).take(self.pipelines.sun_count as usize);
        all.map(move |sun| (sun, sun.light(self.constants.environment_rotation, factor)))
    }

    /// The content of the buffer of lights: those of the frame, then the suns. `environment`: the scale of its images, and its suns.
    pub(crate) fn lights_and_suns(&self, environment: (f32, &[Sun])) -> Vec<Light> {
        self.lights.iter().copied().chain(self.suns(environment).map(|(_, light)| light)).collect()
    }

    /// The frame constants for a frame at `rect` of the output. `environment`: as for [`FrameState::lights_and_suns`].
    /// `sample_index` counts accumulated frames from 0. `before`: `clip_from_world` of the previous frame.
    pub(crate) fn constants(&self, rect: Rect, environment: (f32, &[Sun]), sample_index: u32, before: Mat4) -> Frame {
        let (scale, _) = environment;
        let mut frame = Frame {
            clip_from_world_before: before.to_cols_array_2d(),
            environment_intensity: self.constants.environment_intensity / scale,
            sample_index,
            viewport_origin_px: [rect.x as f32, rect.y as f32],
            ..self.constants
        };
        let bounds = self.scene.as_ref().map_or_else(Bounds::default, |scene| scene.model().bounds);
        for (index, (sun, light)) in self.suns(environment).enumerate() {
            frame.sun_variance[index] = sun.variance;
            if let Some(view) = frame.light_clip_from_world[..MAX_LIGHT_VIEWS].get_mut(self.lights.len() + index) {
                *view = view_of_light(&light, &bounds).to_cols_array_2d();
            }
        }
        frame
    }
}
