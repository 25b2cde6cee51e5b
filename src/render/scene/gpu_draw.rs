//! One draw of a scene.

use std::sync::Arc;

use glam::Vec3;

use crate::frame::MaterialVariant;
use crate::gpu::{DescriptorSet, DrawCommand, vk};
use crate::interface::{ALPHA_BLEND, Draw};

/// One draw call, wherever the pose of a frame puts it.
#[derive(Clone)]
pub(crate) struct GpuDraw {
    /// Index into `Model::instances`.
    pub(crate) instance: usize,
    /// The push constants that do not depend on the pose.
    pub(crate) push: Draw,
    pub(crate) first_index: u32,
    pub(crate) index_count: u32,
    pub(crate) topology: vk::PrimitiveTopology,
    pub(crate) double_sided: bool,
    pub(crate) material: Arc<DescriptorSet>,
    pub(crate) variant: MaterialVariant,
    /// Center of the primitive's bounds, object space.
    pub(crate) center: Vec3,
    /// From there to its largest corner.
    pub(crate) half_size: Vec3,
}

impl GpuDraw {
    /// The command of the draw with this number.
    pub(super) fn command(&self, number: u32, instance_count: u32) -> DrawCommand {
        let Self { index_count, first_index, .. } = *self;
        DrawCommand { index_count, instance_count, first_index, vertex_offset: 0, first_instance: number }
    }

    /// Whether its back faces are drawn before its front faces, so that no other draw may come between.
    pub(crate) fn is_drawn_twice(&self) -> bool {
        self.double_sided && self.variant.alpha == ALPHA_BLEND
    }

    /// Whether one command can draw both, if both have the same winding.
    pub(super) fn shares_state(&self, other: &Self) -> bool {
        self.variant == other.variant
            && Arc::ptr_eq(&self.material, &other.material)
            && self.topology == other.topology
            && self.double_sided == other.double_sided
            && !self.is_drawn_twice()
    }
}
