//! Selects the pipelines that sort blended surfaces in each pixel.

use std::sync::Arc;

use crate::interface::VERTEX_BINDINGS;
use crate::shader::annotation::pass::PassDesc;
use crate::shader::graph::RenderPhase;
use crate::shader::{GraphPass, ShaderSet};

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
    /// The peeling of so many layers of the surfaces that `model` draws.
    pub(super) fn new(layers: u32, shaders: &ShaderSet, model: Option<&Arc<GraphPass>>) -> Self {
        if layers == 0 {
            return Self::default();
        }
        if shaders.pending.contains(PEEL_STAGE) {
            return Self { pending: PEEL_STAGE.to_owned(), ..Self::default() };
        }
        let peel = shaders.graph.passes.iter().find(|pass| pass.phase == RenderPhase::Peel);
        let pass = peel.zip(model).map(|(peel, model)| Arc::new(of_model(peel, model)));
        Self { layers, pass, pending: String::new() }
    }
}

/// The pass `peel` with the surfaces of `model`.
fn of_model(peel: &GraphPass, model: &GraphPass) -> GraphPass {
    let of_vertices = model.inputs.range(VERTEX_BINDINGS..);
    let of_vertices = of_vertices.map(|(binding, input)| (*binding, input.clone()));
    GraphPass {
        desc: PassDesc { model: model.desc.model, cull: model.desc.cull, ..peel.desc.clone() },
        pre_rasterization: model.pre_rasterization.clone(),
        inputs: peel.inputs.clone().into_iter().chain(of_vertices).collect(),
        ..peel.clone()
    }
}
