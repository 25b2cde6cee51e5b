//! Selects the pipelines of a picture by debug mode, the author's constants, and the kinds of material in the scene.

mod hooks;
mod keys;
mod modes;
mod peeling;

use std::collections::BTreeSet;
use std::sync::Arc;

use super::display::Display;
use super::formats::{MEAN_FORMAT, TargetFormat};
use super::material_variant::{MaterialVariant, shared_features};
use super::stages::DEFORM;
use super::{Scene, SharedMode};
use crate::gpu::{Specialization, fault, vk};
use crate::interface::{self, ALPHA_BLEND, FEW_LIGHTS, TONEMAP_OFF, UNROLLED_LIGHTS};
use crate::scene::{Model, light_count};
use crate::settings::Settings;
use crate::shader::annotation::pass::MODEL;
use crate::shader::graph::{Input, RenderPhase};
use crate::shader::{DrawAs, Encode, GraphPass, Mode, PATHS_STAGE, ShaderSet, values};
pub use peeling::Peeling;

/// Everything that selects the pipelines of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipelineRequest {
    /// Id of the debug mode.
    pub mode: u32,
    /// Options of the mode for drawing the model.
    pub draw: DrawAs,
    /// Values of the author's specialization constants.
    pub constants: Specialization,
    /// `TONEMAP_*` in common/tonemap.glsl; [`TONEMAP_OFF`] for a mode that shows data.
    pub tonemap: u32,
    /// `interface::ENCODE_*`.
    pub encode: u32,
    /// Whether the display maps values by range, channels or colormap.
    pub maps_values: bool,
    /// Format of the HDR target.
    pub target: TargetFormat,
    /// Kinds of material in the scene.
    pub materials: BTreeSet<MaterialVariant>,
    /// Features that all materials share: `FEATURE_ENVIRONMENT`, `FEATURE_RECT_LIGHTS`.
    pub shared_features: u32,
    /// Features that the author's `user_surface` enables for all lit materials.
    pub hook_features: u32,
    /// Number of lights, if there are few enough to unroll the loop over them; otherwise 0.
    pub light_count: u32,
    /// Whether there are more than [`FEW_LIGHTS`] lights, which pipelines look up in the grid.
    pub many_lights: bool,
    /// Number of suns of the environment that the pipelines light with: see [`Self::for_suns`].
    pub sun_count: u32,
    /// Whether frames are accumulated until something changes.
    pub accumulates: bool,
    /// Path of the fragment stage that computes the mode.
    pub stage: String,
    /// Whether the mode traces rays through the model.
    pub traces: bool,
    /// Whether `user_vertex` or a later pre-rasterization stage moves the model's vertices, which traced rays ignore.
    pub moves_vertices: bool,
    /// Whether the stages leave all vertices where the model has them, so that what is beyond the frame need not be drawn.
    pub keeps_vertices: bool,
    /// Whether the model has so many draws that its stages find them in a buffer.
    pub draws_by_index: bool,
    /// Whether transmissive surfaces look up the opaque scene of the final picture instead of this mode's.
    pub through: bool,
    /// The declared passes to draw, in order.
    pub passes: Vec<Arc<GraphPass>>,
    /// Whether joints or morph targets move vertices of the model.
    pub deforms: bool,
    /// Whether the model and the environment are drawn: no pass covers them.
    pub draws_model: bool,
    /// The pass whose image is shown instead of the picture.
    pub shown_pass: Option<String>,
    /// `TONEMAP_*` of the settings, if that pass shows a watched expression: the picture that a pass after the tone map reads, and the
    /// tone map whose variables are shown, are those of the final picture.
    pub watched_tonemap: Option<u32>,
    /// The pass that draws the wireframe over the picture; `None` if it is not shown.
    pub wireframe: Option<Arc<GraphPass>>,
    /// The stage of that pass, which may not be compiled yet; empty if no wireframe is shown.
    pub wireframe_stage: String,
    /// How blended surfaces are sorted in each pixel.
    pub peeling: Peeling,
    /// The modes that are drawn at once, each to a target of its own: see `frame::mode_sets`. Empty for a picture of `mode` alone.
    pub modes: Vec<SharedMode>,
}

/// The settings that select the passes of a frame.
struct Selection<'a> {
    shaders: &'a ShaderSet,
    constants: &'a Specialization,
    settings: &'a Settings,
    /// Path of the stage that draws the model.
    stage: &'a str,
    shows_light: bool,
    shows_environment: bool,
    /// Whether transmissive surfaces look up the final picture in this mode.
    through: bool,
    accumulates: bool,
    /// Whether the samples of a pixel are weighted by their brightness.
    weighs_samples: bool,
}

impl Selection<'_> {
    /// Whether a pass is one of the built-in steps of this frame. Without `draws_model`, the model and the background are not.
    fn is_base(&self, pass: &GraphPass, draws_model: bool) -> bool {
        let graph = &self.shaders.graph;
        let wanted = |name: &str| graph.pass(name).is_none_or(|pass| pass.is_wanted(&self.settings.passes));
        match pass.phase {
            RenderPhase::Tonemap => true,
            RenderPhase::Resolve => draws_model && self.weighs_samples,
            RenderPhase::Mean => self.accumulates,
            RenderPhase::Model if pass.desc.background => {
                let is_on = is_switched_on(pass, self.shaders, self.constants) && pass.is_wanted(&self.settings.passes);
                // Blended passes are drawn over any background, including a plain color.
                let is_seen = self.shows_light && (self.shows_environment || pass.desc.blend);
                draws_model && is_seen && is_on
            }
            RenderPhase::Model if pass.desc.is_built_in() => {
                let draws = pass.desc.stage == self.stage || (self.through && pass.name() == MODEL);
                draws_model && draws && wanted(MODEL)
            }
            _ => false,
        }
    }
}

impl PipelineRequest {
    /// The pipelines that `settings` select. A mode that the tree lacks falls back to the tree's first mode.
    pub fn new(settings: &Settings, shaders: &ShaderSet, scene: Option<&Scene>, target: TargetFormat) -> Self {
        let mode = find_mode(shaders, &settings.mode);
        let shown_pass = mode.and_then(|mode| mode.pass.clone());
        let shows_light = mode.is_some_and(|m| m.tonemap) || shown_pass.is_some();
        let graph = &shaders.graph;
        let stage = mode.map(|m| m.stage.clone()).unwrap_or_default();
        let constants = values::constants(&settings.shader, &shaders.constants);
        // The shown image of a pass needs its inputs, even if the model needs none of them.
        let looked_at = shown_pass.as_deref().map(|name| graph.needed_by(name)).unwrap_or_default();
        let is_on = |index: usize| {
            let pass = &graph.passes[index];
            let is_used = looked_at.contains(&index) || is_switched_on(pass, shaders, &constants);
            is_used && pass.is_wanted(&settings.passes)
        };
        let selection = Selection {
            shaders,
            constants: &constants,
            settings,
            stage: &stage,
            shows_light,
            shows_environment: settings.environment.is_shown(&settings.view),
            through: mode.is_some_and(|m| m.through),
            accumulates: mode.is_some_and(|m| m.accumulate),
            weighs_samples: target.samples > 1 && target.weighs && shows_light && mode.is_none_or(|m| !m.accumulate),
        };
        let active = |draws_model: bool| {
            let is_base = |pass: &GraphPass| selection.is_base(pass, draws_model);
            graph.active(is_base, selection.shows_light, is_on, shown_pass.as_deref())
        };
        let mut passes = active(true);
        let own = || passes.iter().filter(|pass| !pass.desc.is_built_in());
        let reads = |input: &Input| own().any(|pass| pass.inputs.values().any(|other| other == input));
        // The picture is not drawn for the image of a pass alone, if it shows no model either.
        let is_covered = own().any(|pass| pass.covers()) || (shown_pass.is_some() && graph.is_covered(is_on));
        let draws_model = !is_covered || reads(&Input::Picture) || reads(&Input::Depth);
        if !draws_model {
            passes = active(false);
        }
        let deforms = scene.is_some_and(|scene| scene.pose().deforms());
        let lights = light_count(&settings.lights, scene.map_or(0, |scene| scene.model().lights.len()));
        let request = Self {
            mode: mode.map_or(0, |m| m.id),
            draw: mode.map(|m| m.draw).unwrap_or_default(),
            constants: constants.clone(),
            tonemap: if mode.is_some_and(|m| m.tonemap) { settings.view.tonemap as u32 } else { TONEMAP_OFF },
            encode: mode.map_or(Encode::Color, |m| m.encode).id(),
            maps_values: Display::new(&settings.view, mode).maps_values(),
            target,
            materials: scene.map(|scene| scene.materials().clone()).unwrap_or_default(),
            shared_features: shared_features(settings),
            hook_features: shaders.hook_features(),
            light_count: if lights <= UNROLLED_LIGHTS { lights as u32 } else { 0 },
            many_lights: lights > FEW_LIGHTS,
            sun_count: 0,
            accumulates: selection.accumulates,
            traces: mode.is_some_and(|m| m.traces),
            moves_vertices: shaders.moves_vertices(&stage),
            keeps_vertices: shaders.keeps_vertices(&stage)
                && (!selection.through || shaders.keeps_vertices(&model_stage(shaders)))
                && (!deforms || shaders.is_as_shipped(DEFORM)),
            draws_by_index: scene.is_some_and(|scene| draws_by_index(scene.loaded())),
            through: selection.through,
            stage,
            passes,
            deforms,
            draws_model,
            wireframe: wireframe(settings, shaders),
            wireframe_stage: wireframe_stage(settings, shaders).unwrap_or_default(),
            watched_tonemap: shown_pass
                .as_deref()
                .and_then(|name| graph.pass(name)?.desc.watches.as_ref())
                .map(|_| settings.view.tonemap as u32),
            shown_pass,
            peeling: Peeling::default(),
            modes: Vec::new(),
        };
        let peels = request.draw == DrawAs::Surfaces && request.materials.iter().any(|m| m.alpha == ALPHA_BLEND);
        let layers = if peels { settings.view.blend_layers } else { 0 };
        Self { peeling: Peeling::new(layers, shaders, request.model_pass()), ..request }
    }

    /// The same for an environment that has this many suns.
    #[must_use]
    pub fn for_suns(self, sun_count: u32) -> Self {
        Self { sun_count, ..self }
    }

    /// The mode that the model is drawn in.
    fn model_mode(&self) -> u32 {
        if self.shown_pass.is_some() { interface::MODE_FINAL } else { self.mode }
    }

    /// The pass that draws the model in this mode. `None` if the model is not drawn, or its stage is not compiled yet.
    pub(crate) fn model_pass(&self) -> Option<&Arc<GraphPass>> {
        let draws = |pass: &&Arc<GraphPass>| pass.phase == RenderPhase::Model && pass.desc.is_built_in();
        self.passes.iter().filter(draws).find(|pass| pass.desc.stage == self.stage)
    }

    /// Whether a pixel depends only on what is drawn at that pixel. Passes other than the built-in ones may read any pixel.
    pub(crate) fn is_local(&self) -> bool {
        self.passes.iter().all(|pass| pass.desc.is_built_in() || pass.desc.background)
    }

    /// Whether the pixels are LDR output: a pass after the tone map is shown, or covers the picture.
    pub(crate) fn shows_display(&self) -> bool {
        match self.shown() {
            Some(pass) => pass.phase == RenderPhase::Display && pass.desc.watches.is_none(),
            None => !self.draws_model && self.passes.iter().any(|pass| pass.phase == RenderPhase::Display),
        }
    }

    /// Whether an expression of a pass after the tone map is shown: values that follow the displayed picture.
    pub(crate) fn watches_display(&self) -> bool {
        self.shown().is_some_and(|pass| pass.phase == RenderPhase::Display && pass.desc.watches.is_some())
    }

    /// The pass whose image is shown.
    pub(crate) fn shown(&self) -> Option<&Arc<GraphPass>> {
        let name = self.shown_pass.as_deref()?;
        self.passes.iter().find(|pass| pass.is_called(name))
    }

    /// Paths of the compute stages.
    pub(crate) fn compute_stages(&self) -> impl Iterator<Item = &str> {
        let passes = self.passes.iter().filter(|pass| pass.is_compute).map(|pass| pass.desc.stage.as_str());
        passes.chain(self.deforms.then_some(DEFORM))
    }

    fn pass_of(&self, is_wanted: impl Fn(&GraphPass) -> bool) -> Option<&Arc<GraphPass>> {
        self.passes.iter().find(|pass| is_wanted(pass))
    }

    /// Paths per pixel in each frame of an accumulating mode. Tracing the model takes so long on a software device that a frame
    /// has one path.
    pub fn paths_per_frame(&self) -> u32 {
        if self.traces { 1 } else { 8 }
    }

    /// Whether the model is drawn as in the final picture.
    fn is_picture_stage(&self) -> bool {
        self.model_pass().is_some_and(|pass| pass.name() == MODEL)
    }

    /// Whether the mode uses path tracing, and so needs its resources.
    pub(crate) fn follows_paths(&self) -> bool {
        self.stage == PATHS_STAGE
    }

    /// Whether the mode shows all light: the final picture, or its path-traced reference.
    fn shows_picture(&self) -> bool {
        self.is_picture_stage() || (self.traces && self.tonemap != TONEMAP_OFF)
    }

    /// Whether opaque surfaces are drawn twice: as in the final picture for transmissive surfaces to look up, and as this mode
    /// shows them.
    pub(crate) fn draws_opaque_twice(&self) -> bool {
        self.has_transmission() && self.through && !self.is_picture_stage()
    }

    /// The passes that draw the model to the picture besides the model's own.
    pub(crate) fn added_passes(&self) -> impl Iterator<Item = &Arc<GraphPass>> {
        self.passes.iter().filter(|pass| pass.adds_to_model())
    }

    /// Format of the HDR target before the tone map.
    pub(crate) fn picture_format(&self) -> vk::Format {
        if self.accumulates { MEAN_FORMAT } else { self.target.color }
    }

    /// The stages of the pipelines.
    pub fn stages(&self) -> BTreeSet<String> {
        // Without a model the stages of the mode count too, since the model is still loading. Its stage may not be compiled yet.
        let model = self.draws_model.then(|| self.stage.clone());
        let all = self.passes.iter().chain(&self.wireframe).chain(self.peel_pass());
        let passes = all.flat_map(|pass| pass.stages()).map(str::to_owned);
        let later =
            [&self.wireframe_stage, &self.peeling.pending].into_iter().filter(|stage| !stage.is_empty()).cloned();
        let deform = self.deforms.then(|| DEFORM.to_owned());
        passes.chain(model).chain(later).chain(deform).collect()
    }

    /// Whether a frame needs stages that are not compiled yet.
    pub fn needs_pending(&self, shaders: &ShaderSet) -> bool {
        let is_pending = |path: &String| shaders.pending.contains(path);
        // A stage that has never compiled is not in the graph yet.
        !shaders.pending.is_empty() && (self.tonemap_key().is_none() || self.stages().iter().any(is_pending))
    }
}

/// Whether the stages find the draws of a model in a buffer, instead of getting each with its commands. That saves the CPU time for
/// each draw, and takes a little time on the device, so it is for models with many draws.
pub(crate) fn draws_by_index(model: &Model) -> bool {
    const MANY: u64 = 256;
    model.instances.len() as u64 >= fault::value("draws-by-index").unwrap_or(MANY)
}

/// The fragment stage of the final picture.
fn model_stage(shaders: &ShaderSet) -> String {
    shaders.graph.pass(MODEL).map(|pass| pass.desc.stage.clone()).unwrap_or_default()
}

/// The pass whose stage draws the wireframe: that of the mode which draws lines.
fn wireframe(settings: &Settings, shaders: &ShaderSet) -> Option<Arc<GraphPass>> {
    let stage = wireframe_stage(settings, shaders)?;
    let draws = |pass: &&Arc<GraphPass>| pass.phase == RenderPhase::Model && pass.desc.stage == stage;
    shaders.graph.passes.iter().find(draws).cloned()
}

fn wireframe_stage(settings: &Settings, shaders: &ShaderSet) -> Option<String> {
    let lines = shaders.modes.iter().find(|mode| mode.draw == DrawAs::Lines)?;
    settings.view.wireframe.then(|| lines.stage.clone())
}

/// Whether the constant that the pass names in `when=` is on.
fn is_switched_on(pass: &GraphPass, shaders: &ShaderSet, constants: &Specialization) -> bool {
    let switch = shaders.constants.iter().find(|constant| Some(&constant.name) == pass.desc.when.as_ref());
    switch.is_none_or(|switch| constants.iter().any(|(id, value)| *id == switch.id && *value != 0))
}

/// The mode with this slug, or the tree's first mode.
fn find_mode<'a>(shaders: &'a ShaderSet, slug: &str) -> Option<&'a Mode> {
    shaders.modes.iter().find(|m| m.slug == slug).or_else(|| shaders.modes.first())
}
