//! Which pipelines a picture needs: the debug mode, the author's constants, and the kinds of material in the scene.

use std::collections::BTreeSet;

use crate::gpu::{PrimitiveClass, Raster, Specialization, vk};
use crate::interface::{
    self, SPEC_ALPHA_MODE, SPEC_ENCODE, SPEC_FEATURES, SPEC_LIGHT_COUNT, SPEC_MODE, SPEC_TONEMAP, TONEMAP_OFF,
    UNROLLED_LIGHTS,
};
use crate::scene::light_count;
use crate::settings::{LightSource, Settings, Tonemap};
use crate::shader::{DrawAs, Encode, Mode, ShaderSet};

use crate::render::values;

/// What a material asks of its pipeline.
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
pub struct Wanted {
    /// Id of the debug mode.
    pub mode: u32,
    /// How the mode draws the model.
    pub draw: DrawAs,
    /// Values of the author's specialization constants.
    pub constants: Specialization,
    /// `TONEMAP_*` in common/tonemap.glsl; off for a mode that shows no light.
    pub tonemap: u32,
    /// `interface::ENCODE_*`.
    pub encode: u32,
    /// Samples a pixel.
    pub samples: u32,
    /// Format of the HDR target.
    pub scene_format: vk::Format,
    /// Format of the picture.
    pub output_format: vk::Format,
    /// Kinds of material in the scene.
    pub materials: BTreeSet<MaterialVariant>,
    /// Features that all materials share: `FEATURE_ENVIRONMENT`, `FEATURE_RECT_LIGHTS`.
    pub shared_features: u32,
    /// How many lights shine, if they are few enough to unroll the loop over them; else 0.
    pub light_count: u32,
    /// Whether the environment is seen behind the model.
    pub sky: bool,
    /// Whether frames add up to a mean while nothing changes.
    pub accumulates: bool,
    /// Whether what is seen through glass is the picture, not this mode of it.
    pub through: bool,
}

/// One pipeline of a [`Wanted`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    pub(super) pass: Pass,
    pub(super) format: vk::Format,
    pub(super) samples: u32,
    pub(super) specialization: Specialization,
}

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Pass {
    /// The model: `pbr.vert`, `pbr.frag`.
    Model { raster: Raster, class: PrimitiveClass },
    /// The environment behind it: `sky.vert`, `sky.frag`.
    Sky,
    /// A frame added to the mean: `tonemap.vert`, `average.frag`.
    Average,
    /// HDR to picture: `tonemap.vert`, `tonemap.frag`.
    Tonemap,
}

impl Wanted {
    /// What `settings` ask of `shaders` for a scene with these materials and so many lights of its own. A mode that the tree lost
    /// falls back to its first.
    pub fn new(
        settings: &Settings,
        shaders: &ShaderSet,
        materials: &BTreeSet<MaterialVariant>,
        own_lights: usize,
        samples: u32,
        scene_format: vk::Format,
        output_format: vk::Format,
    ) -> Self {
        let mode = mode(shaders, &settings.mode);
        let lights = light_count(&settings.lights, own_lights);
        Self {
            mode: mode.map_or(0, |m| m.id),
            draw: mode.map(|m| m.draw).unwrap_or_default(),
            constants: values::constants(&settings.shader, &shaders.constants),
            tonemap: if mode.is_some_and(|m| m.tonemap) { settings.view.tonemap as u32 } else { TONEMAP_OFF },
            encode: mode.map_or(Encode::Color, |m| m.encode).id(),
            samples,
            scene_format,
            output_format,
            materials: materials.clone(),
            shared_features: shared_features(settings),
            light_count: if lights <= UNROLLED_LIGHTS { lights as u32 } else { 0 },
            sky: settings.environment.is_shown(&settings.view) && mode.is_some_and(|m| m.tonemap),
            accumulates: mode.is_some_and(|m| m.accumulate),
            through: mode.is_some_and(|m| m.through),
        }
    }

    /// The same picture in another mode, with this tone map where it applies.
    pub fn with_mode(&self, mode: &Mode, tonemap: Tonemap) -> Self {
        Self {
            mode: mode.id,
            tonemap: if mode.tonemap { tonemap as u32 } else { TONEMAP_OFF },
            encode: mode.encode.id(),
            draw: mode.draw,
            sky: self.sky && mode.tonemap,
            accumulates: mode.accumulate,
            through: mode.through,
            ..self.clone()
        }
    }

    pub(super) fn model_key(&self, material: MaterialVariant) -> PipelineKey {
        let mut specialization = vec![
            (SPEC_MODE, self.mode),
            (SPEC_ALPHA_MODE, material.alpha),
            (SPEC_FEATURES, material.features | self.shared_features),
            (SPEC_LIGHT_COUNT, self.light_count),
        ];
        specialization.extend_from_slice(&self.constants);
        let raster = match self.draw {
            DrawAs::Lines => Raster::Lines,
            DrawAs::Layers => Raster::Added,
            DrawAs::Surfaces if material.alpha == interface::ALPHA_BLEND => match self.mode {
                interface::MODE_FINAL => Raster::Blended,
                // A debug mode has coverage 1, and its flags in alpha must not blend.
                _ => Raster::Replaced,
            },
            DrawAs::Surfaces => Raster::Solid,
        };
        PipelineKey {
            pass: Pass::Model { raster, class: material.class },
            format: self.scene_format,
            samples: self.samples,
            specialization,
        }
    }

    /// Whether opaque surfaces look otherwise through those that light passes through.
    pub(super) fn has_own_behind(&self) -> bool {
        let passes = self.materials.iter().any(|material| passes_light(*material));
        passes && self.through && self.mode != interface::MODE_FINAL
    }

    /// The pipeline that draws a material for those to see: that of the picture, if it is opaque.
    pub(super) fn behind_key(&self, material: MaterialVariant) -> PipelineKey {
        let is_opaque = material.alpha != interface::ALPHA_BLEND && !passes_light(material);
        if !is_opaque || !self.has_own_behind() {
            return self.model_key(material);
        }
        Self { mode: interface::MODE_FINAL, draw: DrawAs::Surfaces, ..self.clone() }.model_key(material)
    }

    pub(super) fn tonemap_key(&self) -> PipelineKey {
        let mut specialization = vec![(SPEC_TONEMAP, self.tonemap), (SPEC_ENCODE, self.encode)];
        specialization.extend_from_slice(&self.constants);
        PipelineKey { pass: Pass::Tonemap, format: self.output_format, samples: 1, specialization }
    }

    /// The sky's pipeline, when it is seen.
    pub(super) fn sky_key(&self) -> Option<PipelineKey> {
        self.sky.then(|| PipelineKey {
            pass: Pass::Sky,
            format: self.scene_format,
            samples: self.samples,
            specialization: self.constants.clone(),
        })
    }

    /// The pipeline that adds a frame to the mean, when frames add up.
    pub(super) fn average_key(&self) -> Option<PipelineKey> {
        self.accumulates.then(|| PipelineKey {
            pass: Pass::Average,
            format: vk::Format::R32G32B32A32_SFLOAT,
            samples: 1,
            specialization: Vec::new(),
        })
    }

    pub(super) fn keys(&self) -> impl Iterator<Item = PipelineKey> {
        self.materials
            .iter()
            .flat_map(|m| [self.model_key(*m), self.behind_key(*m)])
            .chain([self.tonemap_key()])
            .chain(self.sky_key())
            .chain(self.average_key())
    }
}

fn passes_light(material: MaterialVariant) -> bool {
    material.features & interface::FEATURE_TRANSMISSION != 0
}

/// What a frame's materials have in common.
fn shared_features(settings: &Settings) -> u32 {
    let mut features = 0;
    if settings.environment.is_lit() {
        features |= interface::FEATURE_ENVIRONMENT;
    }
    if settings.lights.rect.enabled && settings.lights.source != LightSource::None {
        features |= interface::FEATURE_RECT_LIGHTS;
    }
    features
}

/// The mode of this slug, or the tree's first mode.
pub(super) fn mode<'a>(shaders: &'a ShaderSet, slug: &str) -> Option<&'a Mode> {
    shaders.modes.iter().find(|m| m.slug == slug).or_else(|| shaders.modes.first())
}
