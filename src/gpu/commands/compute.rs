//! Dispatches of compute shaders.

use std::sync::Arc;

use ash::vk;

use super::encoder::Encoder;
use crate::gpu::{ComputePipeline, DescriptorSet};

impl Encoder {
    /// Binds each set at its own number, then runs `groups` workgroups of a pipeline.
    pub fn dispatch(&mut self, pipeline: &Arc<ComputePipeline>, sets: &[&Arc<DescriptorSet>], groups: [u32; 3]) {
        let point = vk::PipelineBindPoint::COMPUTE;
        self.keep(pipeline);
        self.loops = self.loops.take().or_else(|| pipeline.loops.clone());
        for set in sets {
            self.bind(point, pipeline.raw_layout(), set);
        }
        // SAFETY: this encoder records the command buffer; the pipeline is kept.
        unsafe {
            self.gpu.device.cmd_bind_pipeline(self.raw, point, pipeline.raw);
            self.gpu.device.cmd_dispatch(self.raw, groups[0], groups[1], groups[2]);
        }
    }

    /// SYNC: makes what compute shaders wrote to buffers visible to all later commands, and to the CPU after the fence.
    pub fn computed(&mut self) {
        self.writes_done(vk::PipelineStageFlags2::COMPUTE_SHADER, vk::AccessFlags2::SHADER_STORAGE_WRITE);
    }
}
