//! Selects the pipelines of a picture by debug mode, the author's constants, and the kinds of material in the scene.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::display::Display;
use super::formats::{MEAN_FORMAT, TargetFormat, pass_format};
use super::pipeline_key::{KeyPass, PipelineKey};
use super::{Scene, SharedMode};
use crate::gpu::{PrimitiveClass, Raster, Specialization, Swapchain, vk};
use crate::interface::{
    self, EDGES_MODE, SPEC_ALPHA_MODE, SPEC_ENCODE, SPEC_FEATURES, SPEC_LIGHT_COUNT, SPEC_MAPS_VALUES, SPEC_MODE,
    SPEC_TONEMAP, TONEMAP_OFF, UNROLLED_LIGHTS,
};
use crate::scene::{has_exact_sun, light_count};
use crate::settings::{LightSource, Settings};
use crate::shader::annotation::pass::{MODEL, Target};
use crate::shader::graph::{Input, Part};
use crate::shader::{DrawAs, Encode, GraphPass, Mode, PATHS_STAGE, ShaderSet, values};

/// The properties of a material and its primitive that select a pipeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialVariant {
    /// `interface::ALPHA_*`.
    pub alpha: u32,
    /// `interface::FEATURE_*` bits.
    pub features: u32,
    /// Kind of primitive.
    pub class: PrimitiveClass,
}

/// Everything that selects the pipelines of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipelineRequest {
    /// Id of the debug mode.
    pub mode: u32,
    /// How the mode draws the model.
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
    /// Features that all materials share: `FEATURE_ENVIRONMENT`, `FEATURE_SUN`, `FEATURE_RECT_LIGHTS`.
    pub shared_features: u32,
    /// Number of lights, if there are few enough to unroll the loop over them; otherwise 0.
    pub light_count: u32,
    /// Whether the picture is the mean of all frames since it last changed.
    pub accumulates: bool,
    /// Path of the fragment stage that computes the mode.
    pub stage: String,
    /// Whether the mode traces rays through the model.
    pub traces: bool,
    /// Whether transmissive surfaces look up the final picture behind them instead of this mode's.
    pub through: bool,
    /// The declared passes to draw, in order.
    pub passes: Vec<Arc<GraphPass>>,
    /// Whether the model and the environment are in the picture: no pass covers them.
    pub draws_model: bool,
    /// The pass whose image is shown instead of the picture.
    pub shown_pass: Option<String>,
    /// The pass that draws the edges of triangles over the picture; `None` if they are not shown.
    pub edges: Option<Arc<GraphPass>>,
    /// The stage of that pass, which may be still to be compiled; empty if edges are not shown.
    pub edges_stage: String,
    /// The modes that are drawn at once, each to a target of its own: see `frame::mode_sets`. Empty for a picture of `mode` alone.
    pub modes: Vec<SharedMode>,
}

/// The properties of the settings that select the passes of a picture.
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
}

impl Selection<'_> {
    /// Whether a pass is one of the built-in steps of this picture. Without `draws_model`, the model and the background are not.
    fn is_base(&self, pass: &GraphPass, draws_model: bool) -> bool {
        let graph = &self.shaders.graph;
        let wanted = |name: &str| graph.pass(name).is_none_or(|pass| pass.is_wanted(&self.settings.passes));
        match pass.part {
            Part::Tonemap => true,
            Part::Mean => self.accumulates,
            Part::Model if pass.note.background => {
                let is_on = is_switched_on(pass, self.shaders, self.constants) && pass.is_wanted(&self.settings.passes);
                // Blended passes are drawn over any background, including a plain color.
                let is_seen = self.shows_light && (self.shows_environment || pass.note.blend);
                draws_model && is_seen && is_on
            }
            Part::Model if pass.note.is_built_in() => {
                let draws = pass.note.stage == self.stage || (self.through && pass.name() == MODEL);
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
        // An image that is looked at needs what it reads, although the model needs none of it.
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
        };
        let active = |draws_model: bool| {
            let is_base = |pass: &GraphPass| selection.is_base(pass, draws_model);
            graph.active(is_base, selection.shows_light, is_on, shown_pass.as_deref())
        };
        let mut passes = active(true);
        let own = || passes.iter().filter(|pass| !pass.note.is_built_in());
        let reads = |input: &Input| own().any(|pass| pass.inputs.values().any(|other| other == input));
        let draws_model = !own().any(|pass| pass.covers()) || reads(&Input::Picture) || reads(&Input::Depth);
        if !draws_model {
            passes = active(false);
        }
        let lights = light_count(&settings.lights, scene.map_or(0, |scene| scene.model().lights.len()));
        Self {
            mode: mode.map_or(0, |m| m.id),
            draw: mode.map(|m| m.draw).unwrap_or_default(),
            constants: constants.clone(),
            tonemap: if mode.is_some_and(|m| m.tonemap) { settings.view.tonemap as u32 } else { TONEMAP_OFF },
            encode: mode.map_or(Encode::Color, |m| m.encode).id(),
            maps_values: Display::new(&settings.view, mode).maps_values(),
            target,
            materials: scene.map(|scene| scene.materials().clone()).unwrap_or_default(),
            shared_features: shared_features(settings),
            light_count: if lights <= UNROLLED_LIGHTS { lights as u32 } else { 0 },
            accumulates: selection.accumulates,
            traces: mode.is_some_and(|m| m.traces),
            through: selection.through,
            stage,
            passes,
            draws_model,
            edges: edges(settings, shaders),
            edges_stage: edges_stage(settings, shaders).unwrap_or_default(),
            shown_pass,
            modes: Vec::new(),
        }
    }

    /// The mode that the model is drawn in.
    fn model_mode(&self) -> u32 {
        if self.shown_pass.is_some() { interface::MODE_FINAL } else { self.mode }
    }

    /// The pass that draws the model in this mode. `None` if the model is not drawn, or its stage is still to be compiled.
    pub(crate) fn model_pass(&self) -> Option<&Arc<GraphPass>> {
        let draws = |pass: &&Arc<GraphPass>| pass.part == Part::Model && pass.note.is_built_in();
        self.passes.iter().filter(draws).find(|pass| pass.note.stage == self.stage)
    }

    /// Whether a pixel depends on what is drawn at that pixel alone. Other passes than the built-in ones may read any pixel.
    pub(crate) fn is_local(&self) -> bool {
        self.passes.iter().all(|pass| pass.note.is_built_in() || pass.note.background)
    }

    fn pass_of(&self, is_wanted: impl Fn(&GraphPass) -> bool) -> Option<&Arc<GraphPass>> {
        self.passes.iter().find(|pass| is_wanted(pass))
    }

    /// The pipeline that draws a material of the model.
    pub(crate) fn model_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let raster = match self.draw {
            DrawAs::Lines => Raster::Lines,
            DrawAs::Layers => Raster::Added,
            DrawAs::Surfaces if material.alpha == interface::ALPHA_BLEND => match self.shows_picture() {
                true => Raster::Blended,
                // A debug mode stores flags in alpha, which must not be blended.
                false => Raster::Replaced,
            },
            DrawAs::Surfaces => Raster::Solid,
        };
        let pass = self.model_pass().filter(|pass| material.is_taken_by(pass))?;
        Some(self.key_with_model(pass, material, raster))
    }

    /// A pipeline that draws a material to the multisampled picture.
    fn key_with_model(&self, pass: &Arc<GraphPass>, material: MaterialVariant, raster: Raster) -> PipelineKey {
        PipelineKey {
            pass: KeyPass(pass.clone()),
            raster,
            class: material.class,
            format: self.target.color,
            samples: self.target.samples,
            specialization: self.material_constants(material),
            modes: self.modes.iter().map(|mode| mode.id).collect(),
        }
    }

    /// The specialization of stages that draw a material.
    fn material_constants(&self, material: MaterialVariant) -> Specialization {
        let own = [
            (SPEC_MODE, self.model_mode()),
            (SPEC_ALPHA_MODE, material.alpha),
            (SPEC_FEATURES, material.features | self.shared_features),
            (SPEC_LIGHT_COUNT, self.light_count),
        ];
        own.iter().chain(&self.constants).copied().collect()
    }

    /// The pipeline that draws the edges of a material's triangles over the picture.
    pub(crate) fn edges_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let pass = self.edges.as_ref().filter(|pass| material.is_taken_by(pass))?;
        if material.class != PrimitiveClass::Triangles {
            return None;
        }
        let key = self.key_with_model(pass, material, Raster::Edges);
        let own = [(SPEC_TONEMAP, self.tonemap)];
        let rest =
            key.specialization.iter().map(|(id, value)| (*id, if *id == SPEC_MODE { EDGES_MODE } else { *value }));
        Some(PipelineKey { specialization: own.into_iter().chain(rest).collect(), modes: Vec::new(), ..key })
    }

    /// Random paths per pixel in each frame of an accumulating mode. Tracing the model takes so long on a software device that a
    /// frame has one path.
    pub fn paths_per_frame(&self) -> u32 {
        if self.traces { 1 } else { 8 }
    }

    /// Whether the model is drawn as in the final picture.
    fn is_picture_stage(&self) -> bool {
        self.model_pass().is_some_and(|pass| pass.name() == MODEL)
    }

    /// Whether the mode follows random paths, and so needs what they trace.
    pub(crate) fn follows_paths(&self) -> bool {
        self.stage == PATHS_STAGE
    }

    /// Whether the mode shows all light: the final picture, or the same by random paths.
    fn shows_picture(&self) -> bool {
        self.is_picture_stage() || (self.traces && self.tonemap != TONEMAP_OFF)
    }

    /// Whether opaque surfaces are drawn twice: as in the final picture for transmissive surfaces to look up, and as this mode
    /// shows them.
    pub(crate) fn draws_opaque_twice(&self) -> bool {
        let transmissive = self.materials.iter().any(|material| is_transmissive(*material));
        transmissive && self.through && !self.is_picture_stage()
    }

    /// The pipeline that draws a material in the pass `behind`.
    pub(crate) fn behind_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let is_opaque = material.alpha != interface::ALPHA_BLEND && !is_transmissive(material);
        if !is_opaque || !self.draws_opaque_twice() {
            return self.model_key(material);
        }
        let pass = self.pass_of(|pass| pass.name() == MODEL).filter(|pass| material.is_taken_by(pass))?;
        let picture = Self { mode: interface::MODE_FINAL, ..self.clone() };
        Some(picture.key_with_model(pass, material, Raster::Solid))
    }

    /// The pipeline of a pass that draws a full-screen triangle.
    fn triangle_key(
        &self,
        pass: &Arc<GraphPass>,
        raster: Raster,
        format: vk::Format,
        specialization: Specialization,
    ) -> PipelineKey {
        let class = PrimitiveClass::Triangles;
        PipelineKey {
            pass: KeyPass(pass.clone()),
            raster,
            class,
            format,
            samples: 1,
            specialization,
            modes: Vec::new(),
        }
    }

    /// The pipeline of the tone map.
    pub(crate) fn tonemap_key(&self) -> Option<PipelineKey> {
        self.tonemap_key_of(self.encode)
    }

    /// The pipelines of the tone map of each mode that is drawn.
    pub(crate) fn tonemap_keys(&self) -> impl Iterator<Item = PipelineKey> {
        let modes = self.modes.iter().map(|mode| mode.encode);
        let only = self.modes.is_empty().then_some(self.encode);
        modes.chain(only).filter_map(|encode| self.tonemap_key_of(encode))
    }

    fn tonemap_key_of(&self, encode: u32) -> Option<PipelineKey> {
        let pass = self.pass_of(|pass| pass.part == Part::Tonemap)?;
        // Modes that are drawn at once have displays of their own.
        let maps_values = u32::from(self.maps_values || !self.modes.is_empty());
        let own = [(SPEC_TONEMAP, self.tonemap), (SPEC_ENCODE, encode), (SPEC_MAPS_VALUES, maps_values)];
        let specialization = own.iter().chain(&self.constants).copied().collect();
        Some(self.triangle_key(pass, Raster::Solid, Swapchain::FORMAT, specialization))
    }

    /// The pipelines of what lies behind the model, in the order in which it is drawn: what blends lies over the rest.
    pub(crate) fn background_keys(&self) -> impl Iterator<Item = PipelineKey> {
        let passes = |blend| {
            let is_drawn = move |pass: &&Arc<GraphPass>| pass.part == Part::Model && pass.note.background;
            self.passes.iter().filter(is_drawn).filter(move |pass| pass.note.blend == blend)
        };
        passes(false).chain(passes(true)).map(|pass| {
            let specialization = [&[(SPEC_FEATURES, self.shared_features)], &*self.constants].concat();
            let raster = if pass.note.blend { Raster::Blended } else { Raster::Solid };
            let key = self.triangle_key(pass, raster, self.target.color, specialization);
            PipelineKey { samples: self.target.samples, ..key }
        })
    }

    /// The passes that draw the model to the picture besides the model's own.
    pub(crate) fn added_passes(&self) -> impl Iterator<Item = &Arc<GraphPass>> {
        self.passes.iter().filter(|pass| pass.adds_to_model())
    }

    /// The pipeline that adds a frame to the mean, in an accumulating mode.
    pub(crate) fn average_key(&self) -> Option<PipelineKey> {
        let pass = self.pass_of(|pass| pass.part == Part::Mean)?;
        Some(self.triangle_key(pass, Raster::Averaged, MEAN_FORMAT, Vec::new()))
    }

    /// The pipelines of a pass that is none of the built-in steps: one for each material if it draws the model, none for a
    /// compute pass.
    pub(crate) fn pass_keys(&self, pass: &Arc<GraphPass>) -> Vec<PipelineKey> {
        if pass.is_compute || pass.note.is_built_in() || pass.note.background {
            return Vec::new();
        }
        if pass.note.model.is_some() {
            let materials = self.materials.iter().filter(|material| material.is_taken_by(pass));
            return materials.map(|material| self.model_pass_key(pass, *material)).collect();
        }
        let format = match pass.note.to {
            Target::Image => pass_format(pass.note.format),
            _ if pass.part == Part::Display => Swapchain::FORMAT,
            _ => self.picture_format(),
        };
        vec![self.triangle_key(pass, Raster::Solid, format, self.pass_constants())]
    }

    /// The specialization of declared passes that cover an image or compute.
    pub(crate) fn pass_constants(&self) -> Specialization {
        let shared = [(SPEC_FEATURES, self.shared_features), (SPEC_LIGHT_COUNT, self.light_count)];
        shared.iter().chain(&self.constants).copied().collect()
    }

    /// The pipeline with which a pass that is not the model's own draws a material of the model.
    pub(crate) fn model_pass_key(&self, pass: &Arc<GraphPass>, material: MaterialVariant) -> PipelineKey {
        let raster = if pass.note.blend { Raster::Blended } else { Raster::Solid };
        let key = PipelineKey { modes: Vec::new(), ..self.key_with_model(pass, material, raster) };
        match pass.note.to {
            Target::Image => PipelineKey { format: pass_format(pass.note.format), samples: 1, ..key },
            _ => key,
        }
    }

    /// Format of the HDR picture before the tone map.
    pub(crate) fn picture_format(&self) -> vk::Format {
        if self.accumulates { MEAN_FORMAT } else { self.target.color }
    }

    /// The stages of the pipelines.
    pub fn stages(&self) -> BTreeSet<String> {
        // Without a model the stages of the mode count too: the model is still loading. Its stage may be still to be compiled.
        let model = self.draws_model.then(|| self.stage.clone());
        let all = self.passes.iter().chain(&self.edges);
        let passes = all.flat_map(|pass| pass.stages()).map(str::to_owned);
        let edges = Some(self.edges_stage.clone()).filter(|stage| !stage.is_empty());
        passes.chain(model).chain(edges).collect()
    }

    /// Whether a picture needs stages that are still to be compiled.
    pub fn needs_pending(&self, shaders: &ShaderSet) -> bool {
        let is_pending = |path: &String| shaders.pending.contains(path);
        // A step that has never compiled is not in the graph yet.
        !shaders.pending.is_empty() && (self.tonemap_key().is_none() || self.stages().iter().any(is_pending))
    }

    /// The pipelines of the model, of what is drawn with it, and of the mean.
    pub(crate) fn model_keys(&self) -> impl Iterator<Item = PipelineKey> {
        let of = |m: &MaterialVariant| [self.model_key(*m), self.behind_key(*m), self.edges_key(*m)];
        let model = self.materials.iter().flat_map(of).flatten();
        let added = self.added_passes().flat_map(|pass| self.pass_keys(pass));
        model.chain(added).chain(self.background_keys()).chain(self.average_key())
    }

    pub(crate) fn keys(&self) -> impl Iterator<Item = PipelineKey> {
        let others = self.passes.iter().filter(|pass| pass.part != Part::Model);
        self.model_keys().chain(self.tonemap_keys()).chain(others.flat_map(|pass| self.pass_keys(pass)))
    }
}

fn is_transmissive(material: MaterialVariant) -> bool {
    material.features & interface::FEATURE_TRANSMISSION != 0
}

/// The feature bits that all materials of a frame share.
pub(crate) fn shared_features(settings: &Settings) -> u32 {
    let mut features = 0;
    if settings.environment.is_lit() {
        features |= interface::FEATURE_ENVIRONMENT;
    }
    if has_exact_sun(&settings.environment.name) {
        features |= interface::FEATURE_SUN;
    }
    if settings.lights.rect.enabled && settings.lights.source != LightSource::None {
        features |= interface::FEATURE_RECT_LIGHTS;
    }
    features
}

/// The pass whose stage draws the edges of triangles: that of the mode which draws lines.
fn edges(settings: &Settings, shaders: &ShaderSet) -> Option<Arc<GraphPass>> {
    let stage = edges_stage(settings, shaders)?;
    let draws = |pass: &&Arc<GraphPass>| pass.part == Part::Model && pass.note.stage == stage;
    shaders.graph.passes.iter().find(draws).cloned()
}

fn edges_stage(settings: &Settings, shaders: &ShaderSet) -> Option<String> {
    let lines = shaders.modes.iter().find(|mode| mode.draw == DrawAs::Lines)?;
    settings.view.wireframe.then(|| lines.stage.clone())
}

/// Whether the constant is set that the annotation of the pass names.
fn is_switched_on(pass: &GraphPass, shaders: &ShaderSet, constants: &Specialization) -> bool {
    let switch = shaders.constants.iter().find(|constant| Some(&constant.name) == pass.note.when.as_ref());
    switch.is_none_or(|switch| constants.iter().any(|(id, value)| *id == switch.id && *value != 0))
}

/// The mode with this slug, or the tree's first mode.
fn find_mode<'a>(shaders: &'a ShaderSet, slug: &str) -> Option<&'a Mode> {
    shaders.modes.iter().find(|m| m.slug == slug).or_else(|| shaders.modes.first())
}
