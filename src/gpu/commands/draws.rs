//! Draws whose arguments are in a list, so that one command can draw many.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::encoder::Encoder;
use crate::gpu::Buffer;

/// The arguments of a draw, as Vulkan lays them out (`VkDrawIndexedIndirectCommand`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct DrawCommand {
    /// Number of indices.
    pub index_count: u32,
    /// Number of instances.
    pub instance_count: u32,
    /// Number of the first index in the index buffer.
    pub first_index: u32,
    /// Added to each index.
    pub vertex_offset: i32,
    /// `gl_BaseInstance` of the stages.
    pub first_instance: u32,
}

/// Consecutive commands of a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawRun {
    /// Number of the first command.
    pub first: u32,
    /// Number of commands.
    pub count: u32,
    /// Indices of all of them.
    pub indices: u64,
}

impl Encoder {
    /// Draws a run of commands, which all have this many instances. `buffer` holds the same commands; without it, or on a device that takes
    /// one draw at once, they are recorded one by one.
    pub fn draw_run(&mut self, commands: &[DrawCommand], buffer: Option<&Arc<Buffer>>, run: &DrawRun, instances: u32) {
        let at_once = self.gpu.draw_features().at_once;
        let DrawRun { first, count, indices } = *run;
        self.counter.draw_run(count, indices, instances);
        let device = &self.gpu.device;
        let stride = size_of::<DrawCommand>() as u32;
        let Some(buffer) = buffer.filter(|_| at_once > 1 && count > 1) else {
            for draw in &commands[first as usize..][..count as usize] {
                let DrawCommand { index_count, instance_count, first_index, vertex_offset, first_instance } = *draw;
                // SAFETY: this encoder records the command buffer; the loader has checked that the indices are in range.
                unsafe {
                    device.cmd_draw_indexed(
                        self.raw,
                        index_count,
                        instance_count,
                        first_index,
                        vertex_offset,
                        first_instance,
                    );
                }
            }
            return;
        };
        let mut done = 0;
        while done < count {
            let part = at_once.min(count - done);
            let offset = u64::from(first + done) * u64::from(stride);
            // SAFETY: this encoder records the command buffer. The buffer holds the commands, which the loader has checked, and is kept.
            unsafe { device.cmd_draw_indexed_indirect(self.raw, buffer.raw, offset, part, stride) };
            done += part;
        }
        self.keep(buffer);
    }
}
