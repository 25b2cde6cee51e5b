//! Passes: labeled regions of commands, whose time on the device is measured.

use ash::vk;

use super::encoder::Encoder;

impl Encoder {
    /// Records `commands` as the pass `name`. GPU debuggers and validation messages show the name as a label, and
    /// [`crate::gpu::Frames::pass_times`] reports the pass's time once the frame is finished.
    ///
    /// Passes may nest, and names may repeat. Between [`Encoder::begin_rendering`] and [`Encoder::end_rendering`] a pass is valid,
    /// but its time is not exact on a software device or a tiled GPU.
    pub fn pass<T>(&mut self, name: &str, commands: impl FnOnce(&mut Self) -> T) -> T {
        let timestamps = self.timer.as_mut().and_then(|timer| timer.reserve(name, false));
        self.gpu.begin_label(self.raw, name);
        if let Some((queries, first)) = timestamps {
            self.write_timestamp(queries, first);
        }
        let result = commands(self);
        if let Some((queries, first)) = timestamps {
            self.write_timestamp(queries, first + 1);
        }
        self.gpu.end_label(self.raw);
        result
    }

    /// Runs `commands` without measuring its passes.
    pub fn untimed<T>(&mut self, commands: impl FnOnce(&mut Self) -> T) -> T {
        let timer = self.timer.take();
        let result = commands(self);
        self.timer = timer;
        result
    }

    /// Records that the pass `name` reuses its image, so it has no commands.
    pub fn kept_pass(&mut self, name: &str) {
        if let Some((queries, first)) = self.timer.as_mut().and_then(|timer| timer.reserve(name, true)) {
            self.write_timestamp(queries, first);
            self.write_timestamp(queries, first + 1);
        }
    }

    /// Writes a timestamp when all earlier commands are finished.
    pub(in crate::gpu) fn write_timestamp(&mut self, queries: vk::QueryPool, query: u32) {
        let device = &self.gpu.device;
        // SAFETY: this encoder records the command buffer, which has reset the query.
        unsafe { device.cmd_write_timestamp2(self.raw, vk::PipelineStageFlags2::ALL_COMMANDS, queries, query) };
        // SYNC: lavapipe takes a timestamp when it next flushes its drawing, so copies and dispatches after the timestamp would
        // count as before it. Any barrier flushes, even one that orders nothing.
        if self.gpu.info().kind == "cpu" && !self.is_rendering {
            // SAFETY: as above; barriers are valid outside of rendering.
            unsafe { device.cmd_pipeline_barrier2(self.raw, &vk::DependencyInfo::default()) };
        }
    }
}
