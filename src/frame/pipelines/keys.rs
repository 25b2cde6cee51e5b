//! The pipelines of a request: of the model's materials, of the tone map, of what lies behind the model, and of declared passes.

use std::sync::Arc;

use super::PipelineRequest;
use crate::frame::formats::{MEAN_FORMAT, pass_format};
use crate::frame::material_variant::{MaterialVariant, QUADS};
use crate::frame::pipeline_key::{KeyPass, PipelineKey};
use crate::gpu::{PrimitiveClass, Raster, Specialization, Swapchain, vk};
use crate::interface::{
    self, EDGES_MODE, SPEC_ALPHA_MODE, SPEC_ENCODE, SPEC_FEATURES, SPEC_LIGHT_COUNT, SPEC_MANY_LIGHTS,
    SPEC_MAPS_VALUES, SPEC_MODE, SPEC_SAMPLES, SPEC_SUN_COUNT, SPEC_TONEMAP,
};
use crate::shader::annotation::pass::{MODEL, PassTarget, TONEMAP};
use crate::shader::graph::RenderPhase;
use crate::shader::{DrawAs, GraphPass};

impl PipelineRequest {
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

    /// The key of a pipeline that draws a material to the multisampled HDR target.
    fn key_with_model(&self, pass: &Arc<GraphPass>, material: MaterialVariant, raster: Raster) -> PipelineKey {
        PipelineKey {
            pass: KeyPass(pass.clone()),
            raster,
            class: material.class,
            format: self.target.color,
            samples: self.target.samples,
            specialization: self.material_constants(material),
            modes: self.modes.iter().map(|mode| mode.id).collect(),
            draws_by_index: self.draws_by_index && !pass.desc.quads,
        }
    }

    /// The specialization of stages that draw a material.
    fn material_constants(&self, material: MaterialVariant) -> Specialization {
        let own = [
            (SPEC_MODE, self.model_mode()),
            (SPEC_ALPHA_MODE, material.alpha),
            (SPEC_FEATURES, self.features(material) | self.shared_features),
            (SPEC_LIGHT_COUNT, self.light_count),
            (SPEC_SUN_COUNT, self.sun_count),
            (SPEC_MANY_LIGHTS, u32::from(self.many_lights)),
        ];
        own.iter().chain(&self.constants).copied().collect()
    }

    /// The pipeline that draws the wireframe of a material over the picture.
    pub(crate) fn wireframe_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let pass = self.wireframe.as_ref().filter(|pass| material.is_taken_by(pass))?;
        if material.class != PrimitiveClass::Triangles {
            return None;
        }
        let key = self.key_with_model(pass, material, Raster::Edges);
        let own = [(SPEC_TONEMAP, self.tonemap)];
        let rest =
            key.specialization.iter().map(|(id, value)| (*id, if *id == SPEC_MODE { EDGES_MODE } else { *value }));
        Some(PipelineKey { specialization: own.into_iter().chain(rest).collect(), modes: Vec::new(), ..key })
    }

    /// The pass that finds the layers of blended surfaces.
    pub(crate) fn peel_pass(&self) -> Option<&Arc<GraphPass>> {
        self.peeling.pass.as_ref()
    }

    /// The pipeline that draws the depth of a blended material's next layer.
    pub(crate) fn peel_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let pass =
            self.peel_pass().filter(|pass| material.alpha == interface::ALPHA_BLEND && material.is_taken_by(pass))?;
        let key = self.key_with_model(pass, material, Raster::Depth);
        let samples = (SPEC_SAMPLES, self.target.samples);
        let specialization = std::iter::once(samples).chain(key.specialization).collect();
        Some(PipelineKey { specialization, modes: Vec::new(), ..key })
    }

    /// The pipelines that draw the depth of the next layer.
    pub(crate) fn peel_keys(&self) -> impl Iterator<Item = PipelineKey> {
        self.materials.iter().filter_map(|material| self.peel_key(*material))
    }

    /// The pipeline that draws a material into the opaque scene color.
    pub(crate) fn opaque_scene_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let is_opaque = material.alpha != interface::ALPHA_BLEND && !self.is_transmissive(material);
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
            draws_by_index: false,
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
        // Modes that are drawn at once have displays of their own.
        let maps_values = u32::from(self.maps_values || !self.modes.is_empty());
        self.tonemap_key_with([(SPEC_TONEMAP, self.tonemap), (SPEC_ENCODE, encode), (SPEC_MAPS_VALUES, maps_values)])
    }

    /// The tone map that makes the displayed picture which a watched pass reads.
    pub(crate) fn watched_tonemap_key(&self) -> Option<PipelineKey> {
        self.watched_tonemap
            .filter(|_| self.watches_display())
            .and_then(|tonemap| self.tonemap_key_with(picture(tonemap)))
    }

    fn tonemap_key_with(&self, own: [(u32, u32); 3]) -> Option<PipelineKey> {
        let pass = self.pass_of(|pass| pass.phase == RenderPhase::Tonemap)?;
        let specialization = own.iter().chain(&self.constants).copied().collect();
        Some(self.triangle_key(pass, Raster::Solid, Swapchain::FORMAT, specialization))
    }

    /// The background pipelines in drawing order: blended ones after the others.
    pub(crate) fn background_keys(&self) -> impl Iterator<Item = PipelineKey> {
        let passes = |blend| {
            let is_drawn = move |pass: &&Arc<GraphPass>| pass.phase == RenderPhase::Model && pass.desc.background;
            self.passes.iter().filter(is_drawn).filter(move |pass| pass.desc.blend == blend)
        };
        passes(false).chain(passes(true)).map(|pass| {
            let raster = if pass.desc.blend { Raster::Blended } else { Raster::Solid };
            let key = self.triangle_key(pass, raster, self.target.color, self.pass_constants());
            PipelineKey { samples: self.target.samples, ..key }
        })
    }

    /// Whether a pass resolves the samples of each pixel. Otherwise the device averages them.
    pub(crate) fn resolves_samples(&self) -> bool {
        self.resolve_pass().is_some()
    }

    fn resolve_pass(&self) -> Option<&Arc<GraphPass>> {
        self.pass_of(|pass| pass.phase == RenderPhase::Resolve)
    }

    /// The pipeline that resolves a pixel's samples, unless their plain average is used.
    pub(crate) fn resolve_key(&self) -> Option<PipelineKey> {
        let pass = self.resolve_pass()?;
        let specialization = [&[(SPEC_SAMPLES, self.target.samples)], &*self.constants].concat();
        Some(self.triangle_key(pass, Raster::Solid, self.target.color, specialization))
    }

    /// The pipeline that adds a frame to the accumulation buffer, in an accumulating mode.
    pub(crate) fn average_key(&self) -> Option<PipelineKey> {
        let pass = self.pass_of(|pass| pass.phase == RenderPhase::Mean)?;
        Some(self.triangle_key(pass, Raster::Averaged, MEAN_FORMAT, self.constants.clone()))
    }

    /// The pipelines of a pass that is none of the built-in steps: one for each material if it draws the model, none for a
    /// compute pass.
    pub(crate) fn pass_keys(&self, pass: &Arc<GraphPass>) -> Vec<PipelineKey> {
        if pass.is_compute || pass.desc.is_built_in() || pass.desc.background {
            return Vec::new();
        }
        if pass.desc.quads {
            return vec![self.model_pass_key(pass, QUADS)];
        }
        if pass.desc.model.is_some() {
            let materials = self.materials.iter().filter(|material| material.is_taken_by(pass));
            return materials.map(|material| self.model_pass_key(pass, *material)).collect();
        }
        let format = match pass.desc.to {
            PassTarget::Image => pass_format(pass.desc.format),
            _ if pass.phase == RenderPhase::Display => Swapchain::FORMAT,
            _ => self.picture_format(),
        };
        let of_tonemap = self.watched_tonemap.filter(|_| pass.desc.watches.as_deref() == Some(TONEMAP)).map(picture);
        let constants = of_tonemap.into_iter().flatten().chain(self.pass_constants()).collect();
        vec![self.triangle_key(pass, Raster::Solid, format, constants)]
    }

    /// The specialization of declared passes that cover an image or compute, and of the background.
    pub(crate) fn pass_constants(&self) -> Specialization {
        let lights = [
            (SPEC_LIGHT_COUNT, self.light_count),
            (SPEC_SUN_COUNT, self.sun_count),
            (SPEC_MANY_LIGHTS, u32::from(self.many_lights)),
        ];
        let shared = [(SPEC_FEATURES, self.shared_features)].into_iter().chain(lights);
        shared.chain(self.constants.iter().copied()).collect()
    }

    /// The pipeline with which a pass other than the model's own draws a material of the model, or [`QUADS`].
    pub(crate) fn model_pass_key(&self, pass: &Arc<GraphPass>, material: MaterialVariant) -> PipelineKey {
        let raster = if pass.desc.blend { Raster::Blended } else { Raster::Solid };
        let key = PipelineKey { modes: Vec::new(), ..self.key_with_model(pass, material, raster) };
        match pass.desc.to {
            PassTarget::Image => PipelineKey { format: pass_format(pass.desc.format), samples: 1, ..key },
            _ => key,
        }
    }

    /// The pipelines of the model, of everything drawn with it, of the resolve and of the accumulation.
    pub(crate) fn model_keys(&self) -> impl Iterator<Item = PipelineKey> {
        let of = |m: &MaterialVariant| [self.model_key(*m), self.opaque_scene_key(*m), self.wireframe_key(*m)];
        let model = self.materials.iter().flat_map(of).flatten();
        let added = self.added_passes().flat_map(|pass| self.pass_keys(pass));
        model.chain(added).chain(self.background_keys()).chain(self.resolve_key()).chain(self.average_key())
    }

    pub(crate) fn keys(&self) -> impl Iterator<Item = PipelineKey> {
        let others = self.passes.iter().filter(|pass| pass.phase != RenderPhase::Model);
        let tonemaps = self.tonemap_keys().chain(self.watched_tonemap_key());
        self.model_keys().chain(self.peel_keys()).chain(tonemaps).chain(others.flat_map(|pass| self.pass_keys(pass)))
    }
}

/// The constants of the tone map of the final picture.
fn picture(tonemap: u32) -> [(u32, u32); 3] {
    [(SPEC_TONEMAP, tonemap), (SPEC_ENCODE, interface::ENCODE_COLOR), (SPEC_MAPS_VALUES, 0)]
}
