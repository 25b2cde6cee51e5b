//! Draws a pixel of the picture with a stage that logs what its statements do.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::pixel::NearPixel;
use super::{Headless, HeadlessError};
use crate::frame::{PipelineKey, mode_sets};
use crate::gpu::{Buffer, Memory, vk};
use crate::render::Redraw;
use crate::shader::trace::{LoggingStage, Trace, TracedStage, log};
use crate::shader::{Mode, PixelValue};

impl Headless {
    /// Traces the statements of `files` of the tree that draw a mode at a pixel, counted from the upper left corner; without files, those of
    /// all. The pixel is drawn once without a log, and once with a log for each group of files.
    ///
    /// # Errors
    /// As [`Headless::render`]; no stage of the model draws the mode, the stage has no such file, or the model does not cover the pixel.
    pub fn trace(&mut self, at: (u32, u32), mode: &Mode, files: &[&str]) -> Result<Trace, HeadlessError> {
        let fails = |message: String| Err(HeadlessError::Settings(message));
        if !self.gpu.graphics_stores().1 {
            let name = &self.gpu.info().name;
            return fails(format!("{name} cannot write buffers from fragment stages, which a trace needs"));
        }
        let near = NearPixel::new(self, at)?;
        let shaders = self.shaders();
        let state = near.as_ref().map(|near| near.state(mode, self.clock, &shaders));
        let is_traceable = |_: &_| !mode_sets([mode], 1).is_empty();
        let found = near.zip(state).filter(is_traceable).filter(|(_, state)| state.pipelines.draws_model);
        let Some((near, state)) = found else {
            return fails(format!(
                "no stage of the model draws the mode {}: what passes, random paths and toys compute cannot be traced",
                mode.slug
            ));
        };
        let shown = self.pixel(at, std::slice::from_ref(mode))?.first().copied().unwrap_or_default();
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let buffer = Buffer::new(&self.gpu, "trace", log::SIZE, usage, Memory::Readback)?;
        let (library, stage) = (self.reloader.library(), &state.pipelines.stage);
        let (compiler, source) = (library.compiler(), library.source().clone());
        let logging = LoggingStage::new(&shaders, stage, (compiler, &source), buffer.address());
        let logging = logging.map_err(HeadlessError::Settings)?;
        let keys: Vec<PipelineKey> = state.pipelines.model_keys().collect();
        let constants: BTreeSet<&[(u32, u32)]> = keys.iter().map(|key| key.specialization.as_slice()).collect();
        let constants: Vec<&[(u32, u32)]> = constants.into_iter().collect();
        let mut trace: Option<Trace> = None;
        for group in logging.groups(files, &constants).map_err(HeadlessError::Settings)? {
            let traced = logging.of(&group).map_err(HeadlessError::Settings)?;
            let (words, redrawn) = self.draw_traced(&near, at, mode, (&traced, &buffer))?;
            let of_group = Trace::new(&traced, &words, &shown, &redrawn);
            if of_group.fragments.is_empty() {
                break;
            }
            match &mut trace {
                Some(trace) => trace.add(of_group).map_err(HeadlessError::Settings)?,
                None => trace = Some(of_group),
            }
        }
        let (x, y) = at;
        trace.map_or_else(
            || fails(format!("the model does not cover the pixel {x},{y}: no fragment is drawn there")),
            Ok,
        )
    }

    /// Draws the pixel with a traced stage. Returns the words of its log in `buffer`, and the value of the pixel.
    fn draw_traced(
        &mut self,
        near: &NearPixel,
        at: (u32, u32),
        mode: &Mode,
        (traced, buffer): (&TracedStage<'_>, &Arc<Buffer>),
    ) -> Result<(Vec<u32>, PixelValue), HeadlessError> {
        let changed = || HeadlessError::Settings("the shaders have changed".to_owned());
        let set = self.resources.pipelines().cloned().ok_or_else(changed)?;
        let state = near.state(mode, self.clock, &traced.shaders);
        let set = set.variant(traced.shaders.clone(), &state.pipelines)?;
        let bound = self.resources.bind_variant(&set, &state)?;
        let frame =
            bound.ok_or_else(|| HeadlessError::Settings("the light of the picture is being baked".to_owned()))?;
        let empty: Vec<u8> = log::empty(at).iter().flat_map(|word| word.to_le_bytes()).collect();
        buffer.fill(0, buffer.size() as usize, |bytes| bytes.fill(0));
        buffer.write(0, &empty);
        self.view.restart_passes();
        self.view.restart_mean();
        self.view.probe = Some(at);
        let drawn = self.draw_frame(&frame, Redraw::Pixel(at.0, at.1), |_, encoder, _| {
            encoder.keep(buffer);
            encoder.buffers_written();
            Ok(())
        });
        self.view.probe = None;
        drawn?;
        let value = self.view.pixel(self.frames.current()).map(|pixel| pixel.value).unwrap_or_default();
        let bytes = buffer.read();
        Ok((bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect(), value))
    }
}
