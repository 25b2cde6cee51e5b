//! The key of a pipeline: everything that distinguishes it from others.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use super::MaterialVariant;
use crate::gpu::{PrimitiveClass, Raster, Specialization, vk};
use crate::shader::GraphPass;
use crate::shader::spirv::primitive::Primitive;

impl MaterialVariant {
    /// Whether the pass accepts the kind of primitive that the material is on.
    pub(crate) fn is_taken_by(self, pass: &GraphPass) -> bool {
        match pass.pre_rasterization.takes {
            None => true,
            Some(Primitive::Points) => self.class == PrimitiveClass::Points,
            Some(Primitive::Lines) => self.class == PrimitiveClass::Lines,
            Some(Primitive::Triangles) => self.class == PrimitiveClass::Triangles,
            Some(Primitive::WithNeighbors) => false,
        }
    }
}

/// A pass as part of a pipeline key. Labels and docs of its annotation are ignored.
#[derive(Clone, Debug)]
pub(crate) struct KeyPass(pub(crate) Arc<GraphPass>);

impl KeyPass {
    fn parts(&self) -> impl PartialEq + Hash + '_ {
        let GraphPass { desc, pre_rasterization, phase, inputs, .. } = &*self.0;
        (&desc.stage, pre_rasterization, phase, inputs, (desc.model.is_some(), desc.quads), &desc.also)
    }
}

impl PartialEq for KeyPass {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.parts() == other.parts()
    }
}

impl Eq for KeyPass {}

impl Hash for KeyPass {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.parts().hash(state);
    }
}

/// One pipeline of a [`PipelineRequest`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PipelineKey {
    /// The pass that it draws. It determines the stages.
    pub(crate) pass: KeyPass,
    pub(crate) raster: Raster,
    pub(crate) class: PrimitiveClass,
    pub(crate) format: vk::Format,
    pub(crate) samples: u32,
    pub(crate) specialization: Specialization,
    /// Ids of the modes that its fragment stage computes, each for a target of its own; empty for the mode in `specialization`.
    pub(crate) modes: Vec<u32>,
    /// Whether its stages should find their draw in a buffer, as far as they and the device can.
    pub(crate) draws_by_index: bool,
}

impl PipelineKey {
    /// Paths of the stages.
    pub(crate) fn stages(&self) -> impl Iterator<Item = &str> {
        self.pass.0.stages()
    }
}
