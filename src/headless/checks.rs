//! Draws a picture with stages that find operations whose result GLSL leaves open.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::{Headless, HeadlessError};
use crate::gpu::{Buffer, Memory, vk};
use crate::render::Redraw;
use crate::shader::checks::{Broken, CheckedStages};
use crate::shader::{Diagnostic, ShaderSet, StageKind, TreePath};

/// A picture whose operations were checked.
#[derive(Clone, Debug, Default)]
pub struct CheckedPicture {
    /// The failures and printed values, in the order of files and lines.
    pub broken: Vec<(Broken, Diagnostic)>,
    /// How many operations were checked.
    pub checks: usize,
    /// Stages that the device cannot let write to buffers.
    pub left_out: BTreeSet<String>,
    /// Operations that are not checked, since a stage has too many.
    pub dropped: usize,
}

impl Headless {
    /// Draws the frames of the sequence with stages that check their assertions, and, with `undefined`, their operations: those of the model,
    /// of the passes, and of joints and morph targets. The light of the environment is baked by stages of its own, which are not checked.
    ///
    /// # Errors
    /// As [`Headless::render`]; a stage cannot be checked.
    pub fn check_operations(&mut self, undefined: bool) -> Result<CheckedPicture, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let state = self.frame_state()?;
        let graphics = state.pipelines.keys().flat_map(|key| key.stages().map(str::to_owned).collect::<Vec<_>>());
        let all: BTreeSet<String> = graphics.chain(state.pipelines.compute_stages().map(str::to_owned)).collect();
        let (vertex, fragment) = self.gpu.graphics_stores();
        let can_write = |path: &String| match StageKind::of(&TreePath::from(path.as_str())) {
            Some(StageKind::Fragment) => fragment,
            Some(StageKind::Compute) => true,
            _ => vertex,
        };
        let (stages, left_out): (BTreeSet<String>, BTreeSet<String>) = all.into_iter().partition(can_write);
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let size = CheckedStages::size(stages.len());
        let buffer = Buffer::new(&self.gpu, "checks", size, usage, Memory::Readback)?;
        let (shaders, library) = (self.shaders(), self.reloader.library());
        let (compiler, source) = (library.compiler().clone(), library.source().clone());
        let mut checked = CheckedStages::new(&shaders, &stages, (&compiler, &source), (buffer.address(), undefined))
            .map_err(HeadlessError::Settings)?;
        let counting = checked.counting().map_err(HeadlessError::Settings)?;
        write(&buffer, &checked.empty());
        self.draw_checked(&counting, &buffer)?;
        let words = read(&buffer);
        let mut broken = checked.broken(&words);
        if !broken.is_empty() {
            let reading = checked.reading(&broken).map_err(HeadlessError::Settings)?;
            write(&buffer, &words);
            self.draw_checked(&reading, &buffer)?;
            broken = checked.broken(&read(&buffer));
        }
        let with_diagnostic = |broken: Broken| (broken.clone(), checked.diagnostic(&broken));
        let broken = broken.into_iter().map(with_diagnostic).collect();
        Ok(CheckedPicture { broken, checks: checked.check_count(), left_out, dropped: checked.left_out() })
    }

    /// Draws the frames of the sequence with other modules of the same stages, which write to a buffer.
    fn draw_checked(&mut self, shaders: &Arc<ShaderSet>, buffer: &Arc<Buffer>) -> Result<(), HeadlessError> {
        let changed = || HeadlessError::Settings("the shaders have changed".to_owned());
        let set = self.resources.pipelines().cloned().ok_or_else(changed)?;
        let target = self.frame_state()?.pipelines.target;
        self.offscreen.view.restart_passes();
        let mut variant = None;
        for index in 0..self.sequence.frames.max(1) {
            let clock = self.sequence.clock(index);
            let state = self.session.frame_state_of(shaders, clock, self.size, target);
            let set = match &variant {
                Some(set) => set,
                None => variant.insert(set.variant(shaders.clone(), &state.pipelines)?),
            };
            // A later frame may draw what the first one does not.
            set.build_aside(&state.pipelines)?;
            let bound = self.resources.bind_variant(set, &state)?;
            let baking = || HeadlessError::Settings("the light of the picture is being baked".to_owned());
            let frame = bound.ok_or_else(baking)?;
            self.offscreen.view.restart_mean();
            self.draw_frame(&frame, Redraw::Always, |_, encoder, _| {
                encoder.keep(buffer);
                encoder.buffers_written();
                Ok(())
            })?;
        }
        Ok(())
    }
}

fn write(buffer: &Buffer, words: &[u32]) {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    buffer.write(0, &bytes);
}

fn read(buffer: &Buffer) -> Vec<u32> {
    buffer.read().as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}
