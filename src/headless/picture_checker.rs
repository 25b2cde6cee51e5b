//! Draws a picture with stages that find assertions that fail, and operations whose result GLSL leaves open.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde_json::Value;

use super::HeadlessError;
use super::offscreen_view::OffscreenView;
use super::pixel_tracer::TraceTools;
use crate::frame::FrameState;
use crate::frame::stages::bake_stages;
use crate::gpu::{Buffer, Gpu, Memory, SetLayouts, vk};
use crate::pipeline::PipelineSet;
use crate::render::Redraw;
use crate::shader::annotation::pass::{PassSize, PassTarget};
use crate::shader::checks::{Broken, CheckBuffer, CheckedStages, Operations};
use crate::shader::compile::asserts::has_calls;
use crate::shader::{Diagnostic, ShaderSet, Source, StageKind, TreePath};

/// A picture whose operations were checked.
#[derive(Clone, Debug, Default)]
pub struct CheckedPicture {
    /// The failures and printed values, in the order of files and lines.
    pub broken: Vec<(Broken, Diagnostic)>,
    /// For each pixel, from the upper left corner, the place in `broken` of a failure there, from 1, or 0. Empty if nothing has failed.
    pub marks: Vec<u16>,
    /// Width and height of the picture.
    pub size: (u32, u32),
    /// How many operations were checked.
    pub checks: usize,
    /// Stages that the device cannot let write to buffers.
    pub left_out: BTreeSet<String>,
    /// Warnings about files with assertions that only stages have which bake light: they are not checked.
    pub baked: Vec<Diagnostic>,
    /// Operations that are not checked, since a stage has too many.
    pub dropped: usize,
    /// Whether derivatives are not checked, since fragments cannot ask which neighbors run along on this device.
    pub without_derivatives: bool,
    /// The words of a loop that did not end.
    pub endless_loop: Option<[u32; 2]>,
}

impl CheckedPicture {
    /// The failures, without printed values.
    pub fn faults(&self) -> impl Iterator<Item = &Broken> {
        self.broken.iter().map(|(broken, _)| broken).filter(|broken| broken.is_fault())
    }

    /// The findings, for programs.
    pub fn json(&self) -> Value {
        self.broken.iter().map(|(broken, diagnostic)| broken.json(diagnostic)).collect()
    }
}

/// A picture to check: the frames of a sequence, of which the last one is shown.
pub struct CheckRequest<'a> {
    /// The state of a frame with other modules of its stages.
    pub state: &'a dyn Fn(&Arc<ShaderSet>, u32) -> Arc<FrameState>,
    /// How many frames there are.
    pub frames: u32,
    /// The shaders.
    pub shaders: &'a Arc<ShaderSet>,
    /// Their pipelines.
    pub set: &'a Arc<PipelineSet>,
    /// Whether all operations are checked, and not only what the author asserts and prints.
    pub undefined: bool,
}

/// Checks pictures. It has a view of its own, so the picture and its history stay as they are.
pub struct PictureChecker {
    gpu: Arc<Gpu>,
    own: OffscreenView,
}

impl PictureChecker {
    /// Creates the view.
    ///
    /// # Errors
    /// No memory left.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, HeadlessError> {
        Ok(Self { gpu: gpu.clone(), own: OffscreenView::new(gpu, layouts)? })
    }

    /// Draws the frames with stages that check their assertions, and, with `undefined`, their operations: those of the model, of the passes,
    /// and of joints and morph targets. The light of the environment is baked by stages of its own, which are not checked.
    ///
    /// # Errors
    /// A stage cannot be checked, or a device error.
    pub fn check(
        &mut self,
        request: &CheckRequest<'_>,
        tools: &mut TraceTools<'_>,
    ) -> Result<CheckedPicture, HeadlessError> {
        let state = (request.state)(request.shaders, 0);
        let (vertex, fragment) = self.gpu.graphics_stores();
        let can_write = |path: &String| match StageKind::of(&TreePath::from(path.as_str())) {
            Some(StageKind::Fragment) => fragment,
            Some(StageKind::Compute) => true,
            _ => vertex,
        };
        let (stages, left_out): (BTreeMap<_, _>, BTreeMap<_, _>) =
            stages_of(&state).into_iter().partition(|(path, _)| can_write(path));
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let bytes = CheckBuffer::bytes(stages.len(), state.size);
        let buffer = Buffer::new(&self.gpu, "checks", bytes, usage, Memory::Readback)?;
        let place = CheckBuffer { address: buffer.address(), size: state.size };
        let (compiler, source) = (tools.compiler, tools.source);
        let operations = Operations { undefined: request.undefined, derivatives: self.gpu.quad_ballots() };
        let mut checked = CheckedStages::new(request.shaders, &stages, (compiler, source), (place, operations))
            .map_err(HeadlessError::Settings)?;
        let counting = checked.counting().map_err(HeadlessError::Settings)?;
        write(&buffer, &checked.empty());
        let endless_loop = self.draw(request, tools, &counting, &buffer)?;
        let mut words = read(&buffer);
        let mut broken = checked.broken(&words);
        let mut marks = Vec::new();
        if !broken.is_empty() {
            let reading = checked.reading(&broken).map_err(HeadlessError::Settings)?;
            write(&buffer, &words);
            self.draw(request, tools, &reading, &buffer)?;
            words = read(&buffer);
            broken = checked.broken(&words);
            marks = checked.marks(&words, &broken);
        }
        let with_diagnostic = |broken: Broken| (broken.clone(), checked.diagnostic(&broken));
        Ok(CheckedPicture {
            broken: broken.into_iter().map(with_diagnostic).collect(),
            marks,
            size: state.size,
            checks: checked.check_count(),
            baked: asserting_bakes(request.shaders, &state).iter().map(|path| unchecked(source, path)).collect(),
            left_out: left_out.into_keys().collect(),
            dropped: checked.left_out(),
            without_derivatives: request.undefined && !self.gpu.quad_ballots(),
            endless_loop,
        })
    }

    /// Draws the frames with other modules of the same stages, which write to a buffer. Returns the words of a loop that did not end.
    fn draw(
        &mut self,
        request: &CheckRequest<'_>,
        tools: &mut TraceTools<'_>,
        shaders: &Arc<ShaderSet>,
        buffer: &Arc<Buffer>,
    ) -> Result<Option<[u32; 2]>, HeadlessError> {
        self.own.view.forget();
        self.own.view.restart_passes();
        let (mut variant, mut endless_loop) = (None, None);
        for index in 0..request.frames.max(1) {
            if (tools.is_canceled)() {
                return Err(HeadlessError::Canceled);
            }
            let state = (request.state)(shaders, index);
            let set = match &variant {
                Some(set) => set,
                None => variant.insert(request.set.variant(shaders.clone(), &state.pipelines)?.0),
            };
            // A later frame may draw what the first one does not.
            set.build_aside(&state.pipelines)?;
            let bound = tools.resources.bind_variant(set, &state)?;
            let baking = || HeadlessError::Settings("the light of the picture is being baked".to_owned());
            let frame = bound.ok_or_else(baking)?;
            self.own.view.restart_mean();
            self.own.draw(&frame, Redraw::Always, |_, encoder, _| {
                encoder.keep(buffer);
                encoder.buffers_written();
                Ok(())
            })?;
            endless_loop = endless_loop.or(self.own.endless_loop());
        }
        Ok(endless_loop)
    }
}

/// The stages of a frame, each with whether it draws an image of the picture's size.
fn stages_of(state: &FrameState) -> BTreeMap<String, bool> {
    let request = &state.pipelines;
    let graphics = request.keys().flat_map(|key| {
        let desc = &key.pass.0.desc;
        let is_whole = desc.to != PassTarget::Image || (desc.size == PassSize::Divided(1) && !desc.rows_up);
        key.stages().map(|stage| (stage.to_owned(), is_whole)).collect::<Vec<_>>()
    });
    let mut all: BTreeMap<String, bool> = BTreeMap::new();
    for (stage, is_whole) in graphics.chain(request.compute_stages().map(|stage| (stage.to_owned(), false))) {
        // A stage may draw several images.
        all.entry(stage).and_modify(|all_whole| *all_whole &= is_whole).or_insert(is_whole);
    }
    all
}

/// The files with assertions that stages have which bake light, and no stage of a frame.
fn asserting_bakes(shaders: &ShaderSet, state: &FrameState) -> BTreeSet<TreePath> {
    let files = |path: &str| {
        let stage = shaders.stages.get(path);
        stage.into_iter().flat_map(|stage| stage.dependencies.iter().chain([&stage.path]))
    };
    let of_frame: BTreeSet<&TreePath> = stages_of(state).keys().flat_map(|path| files(path)).collect();
    let asserts = |path: &&TreePath| shaders.texts.get(*path).is_some_and(|text| has_calls(text));
    let baked = bake_stages().flat_map(files).filter(|path| !of_frame.contains(path));
    baked.filter(asserts).cloned().collect()
}

fn unchecked(source: &Source, path: &TreePath) -> Diagnostic {
    let message = "the assertions of this file are not checked: only stages have it that bake light before the picture";
    Diagnostic::warning(source.display_path(path), message.to_owned())
}

fn write(buffer: &Buffer, words: &[u32]) {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    buffer.write(0, &bytes);
}

fn read(buffer: &Buffer) -> Vec<u32> {
    buffer.read().as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}
