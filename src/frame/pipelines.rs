//! Selects the pipelines of a picture by debug mode, the author's constants, and the kinds of material in the scene.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Scene;
use super::formats::{MEAN_FORMAT, TargetFormat, pass_format};
use crate::gpu::{PrimitiveClass, Raster, Specialization, Swapchain, vk};
use crate::interface::{
    self, SPEC_ALPHA_MODE, SPEC_ENCODE, SPEC_FEATURES, SPEC_LIGHT_COUNT, SPEC_MODE, SPEC_TONEMAP, TONEMAP_OFF,
    UNROLLED_LIGHTS,
};
use crate::scene::{has_exact_sun, light_count};
use crate::settings::{LightSource, Settings, Tonemap};
use crate::shader::graph::{FULL_SCREEN, Input, MODEL, Part};
use crate::shader::{DrawAs, Encode, GraphPass, Mode, ModeStage, ShaderSet, values};

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
    /// Format of the HDR target.
    pub target: TargetFormat,
    /// Kinds of material in the scene.
    pub materials: BTreeSet<MaterialVariant>,
    /// Features that all materials share: `FEATURE_ENVIRONMENT`, `FEATURE_SUN`, `FEATURE_RECT_LIGHTS`.
    pub shared_features: u32,
    /// Number of lights, if there are few enough to unroll the loop over them; otherwise 0.
    pub light_count: u32,
    /// Whether the environment is visible behind the model.
    pub sky: bool,
    /// Whether the picture is the mean of all frames since it last changed.
    pub accumulates: bool,
    /// The stage that computes the mode.
    pub stage: ModeStage,
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
}

/// One pipeline of a [`PipelineRequest`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PipelineKey {
    pub(crate) pass: Pass,
    pub(crate) format: vk::Format,
    pub(crate) samples: u32,
    pub(crate) specialization: Specialization,
}

/// The pass that a pipeline belongs to. It determines the stages.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Pass {
    /// The model: `pbr.vert`, and the fragment stage of the mode.
    Model { raster: Raster, class: PrimitiveClass, fragment: ModeStage },
    /// The environment behind it: `sky.vert`, `sky.frag`.
    Sky,
    /// Adds a frame to the mean: `fullscreen.vert`, `average.frag`.
    Average,
    /// HDR to picture: `fullscreen.vert`, `tonemap.frag`.
    Tonemap,
    /// A declared pass over a whole image: `fullscreen.vert` or its own vertex stage, and its own stage.
    FullScreen(Arc<GraphPass>),
    /// A declared pass that draws the model: `pbr.vert` or its own vertex stage, and its own stage.
    DeclaredModel(Arc<GraphPass>, PrimitiveClass),
}

/// The stages of a picture that every debug mode has, too.
const SHARED_STAGES: [&str; 3] = [FULL_SCREEN, "tonemap.frag", "average.frag"];

impl Pass {
    /// Paths of the vertex and fragment stages.
    pub(crate) fn stages(&self) -> [&str; 2] {
        match self {
            Self::FullScreen(pass) | Self::DeclaredModel(pass, _) => [pass.vertex_stage(), &pass.note.stage],
            Self::Model { fragment, .. } => [MODEL, fragment.path()],
            Self::Sky => ["sky.vert", "sky.frag"],
            Self::Average => [FULL_SCREEN, "average.frag"],
            Self::Tonemap => [FULL_SCREEN, "tonemap.frag"],
        }
    }
}

impl PipelineRequest {
    /// The pipelines that `settings` select. A mode that the tree lacks falls back to the tree's first mode.
    pub fn new(settings: &Settings, shaders: &ShaderSet, scene: Option<&Scene>, target: TargetFormat) -> Self {
        let mode = find_mode(shaders, &settings.mode);
        let shown_pass = mode.and_then(|mode| mode.pass.clone());
        let shows_light = mode.is_some_and(|m| m.tonemap) || shown_pass.is_some();
        let stage = mode.map(|m| m.stage).unwrap_or_default();
        let constants = values::constants(&settings.shader, &shaders.constants);
        // An image that is looked at needs what it reads, although the model needs none of it.
        let looked_at = shown_pass.as_deref().map(|name| shaders.graph.needed_by(name)).unwrap_or_default();
        let is_on = |index: usize| {
            let pass = &shaders.graph.passes[index];
            let is_used = looked_at.contains(&index) || is_switched_on(pass, shaders, &constants);
            is_used && pass.is_wanted(&settings.passes)
        };
        let mut readers = vec![MODEL, stage.path()];
        readers.extend(SHARED_STAGES);
        // Transmissive surfaces may show the picture behind them in a debug mode.
        readers.extend(["sky.vert", "sky.frag"].into_iter().filter(|_| shows_light));
        readers.extend(mode.is_some_and(|m| m.through).then_some(ModeStage::Picture.path()));
        let passes = shaders.graph.active(&readers, shows_light, is_on, shown_pass.as_deref());
        let reads = |input: &Input| passes.iter().any(|pass| pass.inputs.values().any(|other| other == input));
        let draws_model = !passes.iter().any(|pass| pass.covers()) || reads(&Input::Picture) || reads(&Input::Depth);
        let lights = light_count(&settings.lights, scene.map_or(0, |scene| scene.model().lights.len()));
        Self {
            mode: mode.map_or(0, |m| m.id),
            draw: mode.map(|m| m.draw).unwrap_or_default(),
            constants,
            tonemap: if mode.is_some_and(|m| m.tonemap) { settings.view.tonemap as u32 } else { TONEMAP_OFF },
            encode: mode.map_or(Encode::Color, |m| m.encode).id(),
            target,
            materials: scene.map(|scene| scene.materials().clone()).unwrap_or_default(),
            shared_features: shared_features(settings),
            light_count: if lights <= UNROLLED_LIGHTS { lights as u32 } else { 0 },
            sky: settings.environment.is_shown(&settings.view) && shows_light && draws_model,
            accumulates: mode.is_some_and(|m| m.accumulate),
            stage,
            traces: mode.is_some_and(|m| m.traces),
            through: mode.is_some_and(|m| m.through),
            passes,
            draws_model,
            shown_pass,
        }
    }

    /// The same request for another mode, with `tonemap` if that mode shows light.
    pub fn with_mode(&self, mode: &Mode, tonemap: Tonemap) -> Self {
        Self {
            mode: mode.id,
            tonemap: if mode.tonemap { tonemap as u32 } else { TONEMAP_OFF },
            encode: mode.encode.id(),
            draw: mode.draw,
            sky: self.sky && mode.tonemap,
            accumulates: mode.accumulate,
            stage: mode.stage,
            traces: mode.traces,
            through: mode.through,
            passes: if mode.tonemap { self.passes.clone() } else { Vec::new() },
            draws_model: self.draws_model || !mode.tonemap,
            shown_pass: None,
            ..self.clone()
        }
    }

    /// The mode that the model is drawn in.
    fn model_mode(&self) -> u32 {
        if self.shown_pass.is_some() { interface::MODE_FINAL } else { self.mode }
    }

    pub(crate) fn model_key(&self, material: MaterialVariant) -> PipelineKey {
        let mut specialization = vec![
            (SPEC_MODE, self.model_mode()),
            (SPEC_ALPHA_MODE, material.alpha),
            (SPEC_FEATURES, material.features | self.shared_features),
            (SPEC_LIGHT_COUNT, self.light_count),
        ];
        specialization.extend_from_slice(&self.constants);
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
        PipelineKey {
            pass: Pass::Model { raster, class: material.class, fragment: self.stage },
            format: self.target.color,
            samples: self.target.samples,
            specialization,
        }
    }

    /// Random paths per pixel in each frame of an accumulating mode. Tracing the model takes so long on a software device that a
    /// frame has one path.
    pub fn paths_per_frame(&self) -> u32 {
        if self.traces { 1 } else { 8 }
    }

    /// Whether the mode shows all light: the final picture, or the same by random paths.
    fn shows_picture(&self) -> bool {
        self.stage == ModeStage::Picture || (self.traces && self.tonemap != TONEMAP_OFF)
    }

    /// Whether opaque surfaces are drawn twice: as in the final picture for transmissive surfaces to look up, and as this mode
    /// shows them.
    pub(crate) fn draws_opaque_twice(&self) -> bool {
        let transmissive = self.materials.iter().any(|material| is_transmissive(*material));
        transmissive && self.through && self.stage != ModeStage::Picture
    }

    /// The pipeline that draws a material in the pass `behind`.
    pub(crate) fn behind_key(&self, material: MaterialVariant) -> PipelineKey {
        let is_opaque = material.alpha != interface::ALPHA_BLEND && !is_transmissive(material);
        if !is_opaque || !self.draws_opaque_twice() {
            return self.model_key(material);
        }
        let picture =
            Self { mode: interface::MODE_FINAL, draw: DrawAs::Surfaces, stage: ModeStage::Picture, ..self.clone() };
        picture.model_key(material)
    }

    pub(crate) fn tonemap_key(&self) -> PipelineKey {
        let mut specialization = vec![(SPEC_TONEMAP, self.tonemap), (SPEC_ENCODE, self.encode)];
        specialization.extend_from_slice(&self.constants);
        PipelineKey { pass: Pass::Tonemap, format: Swapchain::FORMAT, samples: 1, specialization }
    }

    /// The pipeline of the environment behind the model, if it is visible.
    pub(crate) fn sky_key(&self) -> Option<PipelineKey> {
        self.sky.then(|| PipelineKey {
            pass: Pass::Sky,
            format: self.target.color,
            samples: self.target.samples,
            specialization: [&[(SPEC_FEATURES, self.shared_features)], &*self.constants].concat(),
        })
    }

    /// The pipeline that adds a frame to the mean, in an accumulating mode.
    pub(crate) fn average_key(&self) -> Option<PipelineKey> {
        self.accumulates.then(|| PipelineKey {
            pass: Pass::Average,
            format: MEAN_FORMAT,
            samples: 1,
            specialization: Vec::new(),
        })
    }

    /// The pipelines of a declared pass: one for each material if it draws the model, none for a compute pass.
    pub(crate) fn pass_keys(&self, pass: &Arc<GraphPass>) -> Vec<PipelineKey> {
        if pass.note.model.is_some() {
            return self.materials.iter().map(|material| self.model_pass_key(pass, *material)).collect();
        }
        let key = (!pass.is_compute).then(|| PipelineKey {
            pass: Pass::FullScreen(pass.clone()),
            format: match pass.note.to_picture {
                true if pass.part == Part::Display => Swapchain::FORMAT,
                true => self.picture_format(),
                false => pass_format(pass.note.format),
            },
            samples: 1,
            specialization: self.pass_constants(),
        });
        key.into_iter().collect()
    }

    /// The specialization of declared passes that cover an image or compute.
    pub(crate) fn pass_constants(&self) -> Specialization {
        let shared = [(SPEC_FEATURES, self.shared_features), (SPEC_LIGHT_COUNT, self.light_count)];
        shared.iter().chain(&self.constants).copied().collect()
    }

    /// The pipeline with which a declared pass draws a material of the model.
    pub(crate) fn model_pass_key(&self, pass: &Arc<GraphPass>, material: MaterialVariant) -> PipelineKey {
        let mut specialization = vec![
            (SPEC_MODE, self.model_mode()),
            (SPEC_ALPHA_MODE, material.alpha),
            (SPEC_FEATURES, material.features | self.shared_features),
            (SPEC_LIGHT_COUNT, self.light_count),
        ];
        specialization.extend_from_slice(&self.constants);
        PipelineKey {
            pass: Pass::DeclaredModel(pass.clone(), material.class),
            format: pass_format(pass.note.format),
            samples: 1,
            specialization,
        }
    }

    /// Format of the HDR picture before the tone map.
    pub(crate) fn picture_format(&self) -> vk::Format {
        if self.accumulates { MEAN_FORMAT } else { self.target.color }
    }

    /// The stages of the pipelines.
    pub(crate) fn stages(&self) -> BTreeSet<String> {
        // Without a model the stages of the mode count too: the model is still loading.
        let model = [MODEL, self.stage.path()].map(str::to_owned).into_iter().filter(|_| self.draws_model);
        let computes = self.passes.iter().filter(|pass| pass.is_compute).map(|pass| pass.note.stage.clone());
        self.keys().flat_map(|key| key.pass.stages().map(str::to_owned)).chain(model).chain(computes).collect()
    }

    /// Whether a picture needs stages that are still to be compiled.
    pub fn needs_pending(&self, shaders: &ShaderSet) -> bool {
        !shaders.pending.is_empty() && self.stages().iter().any(|path| shaders.pending.contains(path))
    }

    /// The pipelines of the model, the sky and the mean.
    pub(crate) fn model_keys(&self) -> impl Iterator<Item = PipelineKey> {
        let materials = self.materials.iter().filter(|_| self.draws_model);
        let model = materials.flat_map(|m| [self.model_key(*m), self.behind_key(*m)]);
        model.chain(self.sky_key()).chain(self.average_key())
    }

    pub(crate) fn keys(&self) -> impl Iterator<Item = PipelineKey> {
        let passes = self.passes.iter().flat_map(|pass| self.pass_keys(pass));
        self.model_keys().chain([self.tonemap_key()]).chain(passes)
    }
}

fn is_transmissive(material: MaterialVariant) -> bool {
    material.features & interface::FEATURE_TRANSMISSION != 0
}

/// The feature bits that all materials of a frame share.
fn shared_features(settings: &Settings) -> u32 {
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

/// Whether the constant is set that the annotation of the pass names.
fn is_switched_on(pass: &GraphPass, shaders: &ShaderSet, constants: &Specialization) -> bool {
    let switch = shaders.constants.iter().find(|constant| Some(&constant.name) == pass.note.when.as_ref());
    switch.is_none_or(|switch| constants.iter().any(|(id, value)| *id == switch.id && *value != 0))
}

/// The mode with this slug, or the tree's first mode.
fn find_mode<'a>(shaders: &'a ShaderSet, slug: &str) -> Option<&'a Mode> {
    shaders.modes.iter().find(|m| m.slug == slug).or_else(|| shaders.modes.first())
}
