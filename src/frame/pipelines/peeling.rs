//! Selects the pipelines that sort blended surfaces in each pixel.

use std::sync::Arc;

use super::PipelineRequest;
use crate::frame::material_variant::MaterialVariant;
use crate::frame::pipeline_key::PipelineKey;
use crate::gpu::Raster;
use crate::interface::{ALPHA_BLEND, SPEC_SAMPLES};
use crate::shader::annotation::pass::PassDesc;
use crate::shader::graph::RenderPhase;
use crate::shader::{DrawAs, GraphPass, ShaderSet};

/// The stage that finds the layers of blended surfaces. A tree may lack it.
const PEEL_STAGE: &str = "peel.frag";

/// How blended surfaces are sorted in each pixel; by default they are not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Peeling {
    /// Most layers that are sorted.
    pub layers: u32,
    /// Draws the depth of the next layer, with the pre-rasterization stages of the model. `None`: blended surfaces are not sorted in
    /// each pixel.
    pub(super) pass: Option<Arc<GraphPass>>,
    /// The stage of that pass if it is not compiled yet; otherwise empty.
    pub(super) pending: String,
}

impl Peeling {
    /// The peeling of a request with these layers.
    pub(super) fn new(layers: u32, shaders: &ShaderSet, request: &PipelineRequest) -> Self {
        let has_blended = request.materials.iter().any(|material| material.alpha == ALPHA_BLEND);
        if layers == 0 || !has_blended || request.draw != DrawAs::Surfaces {
            return Self::default();
        }
        if shaders.pending.contains(PEEL_STAGE) {
            return Self { pending: PEEL_STAGE.to_owned(), ..Self::default() };
        }
        let peel = shaders.graph.passes.iter().find(|pass| pass.phase == RenderPhase::Peel);
        let pass = peel.zip(request.model_pass()).map(|(peel, model)| Arc::new(of_model(peel, model)));
        Self { layers, pass, pending: String::new() }
    }
}

/// The pass `peel` with the surfaces of `model`.
fn of_model(peel: &GraphPass, model: &GraphPass) -> GraphPass {
    let of_vertices = model.inputs.range(crate::interface::VERTEX_BINDINGS..);
    let of_vertices = of_vertices.map(|(binding, input)| (*binding, input.clone()));
    GraphPass {
        desc: PassDesc { model: model.desc.model, cull: model.desc.cull, ..peel.desc.clone() },
        pre_rasterization: model.pre_rasterization.clone(),
        inputs: peel.inputs.clone().into_iter().chain(of_vertices).collect(),
        ..peel.clone()
    }
}

impl PipelineRequest {
    /// The pass that finds the layers of blended surfaces.
    pub(crate) fn peel_pass(&self) -> Option<&Arc<GraphPass>> {
        self.peeling.pass.as_ref()
    }

    /// The pipeline that draws the depth of a blended material's next layer.
    pub(crate) fn peel_key(&self, material: MaterialVariant) -> Option<PipelineKey> {
        let pass = self.peel_pass().filter(|pass| material.alpha == ALPHA_BLEND && material.is_taken_by(pass))?;
        let key = self.key_with_model(pass, material, Raster::Depth);
        let samples = (SPEC_SAMPLES, self.target.samples);
        let specialization = std::iter::once(samples).chain(key.specialization).collect();
        Some(PipelineKey { specialization, modes: Vec::new(), ..key })
    }

    /// The pipelines that draw the depth of the next layer.
    pub(crate) fn peel_keys(&self) -> impl Iterator<Item = PipelineKey> {
        self.materials.iter().filter_map(|material| self.peel_key(*material))
    }
}
