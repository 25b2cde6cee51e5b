//! Draws single pixels with a stage that logs what its statements do. What was compiled for a version of the shaders is kept for the next
//! pixel.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use super::HeadlessError;
use super::near_pixel::NearPixel;
use super::offscreen_view::OffscreenView;
use crate::frame::{Clock, FrameState, PipelineKey, Revisions, mode_sets};
use crate::gpu::{Buffer, Gpu, Memory, SetLayouts, vk};
use crate::pipeline::PipelineSet;
use crate::render::{BoundFrame, Redraw, Resources};
use crate::settings::Settings;
use crate::shader::trace::{LoggingStage, Trace, TracedStage, log};
use crate::shader::{Compiler, Mode, PixelValue, ShaderSet, Source};

/// Versions of the shaders whose stages are kept: the newest, and the one before.
const MOST_STAGES: usize = 2;
/// Files of a stage whose pipelines are kept.
const MOST_FILES: usize = 4;

/// A pixel of a frame, which is drawn with one sample.
pub struct TracedPixel<'a> {
    /// The frame.
    pub whole: &'a Arc<FrameState>,
    /// The pipelines of its shaders.
    pub set: &'a Arc<PipelineSet>,
    /// Of shaders that are older than the newest: a frame with the light that they baked, if there is one.
    pub older: Option<Option<&'a BoundFrame>>,
    /// Its settings.
    pub settings: &'a Settings,
    /// The revisions of its files.
    pub revisions: Revisions,
    /// Its time.
    pub clock: Clock,
    /// The pixel, from the upper left corner.
    pub at: (u32, u32),
    /// The mode that is drawn.
    pub mode: &'a Mode,
}

/// The objects that draw a pixel: the window's or the command's objects.
pub struct TraceTools<'a> {
    /// Everything that the frame needs on the device.
    pub resources: &'a mut Resources,
    /// Compiles the stage.
    pub compiler: &'a Compiler,
    /// The tree, for the names of its files.
    pub source: &'a Source,
    /// Whether the result is no longer needed.
    pub is_canceled: &'a dyn Fn() -> bool,
}

/// Lists of constants with which a stage is specialized.
type Constants = BTreeSet<Vec<(u32, u32)>>;

/// A stage that logs, and the statements of a group of its files.
struct Kept {
    shaders: Arc<ShaderSet>,
    stage: String,
    logging: LoggingStage,
    /// The files whose statements the stage keeps, by the constants.
    files: Vec<(Constants, Vec<String>)>,
    groups: VecDeque<Group>,
}

impl Kept {
    /// The files whose statements the stage keeps with these constants.
    fn files_of(&mut self, constants: Constants) -> Vec<String> {
        if let Some((_, files)) = self.files.iter().find(|(of, _)| *of == constants) {
            return files.clone();
        }
        let files = self.logging.files(&constants.iter().map(Vec::as_slice).collect::<Vec<_>>());
        self.files.push((constants, files.clone()));
        files
    }
}

struct Group {
    files: BTreeSet<String>,
    stage: TracedStage,
    /// The pipelines of the frame, with this stage.
    set: Option<Arc<PipelineSet>>,
}

/// The pixel as the frame draws it.
struct Plan {
    near: NearPixel,
    state: Arc<FrameState>,
}

/// Draws pixels with logs. It has a view and a log of its own, so the picture and its history stay as they are.
pub struct PixelTracer {
    own: OffscreenView,
    log: Arc<Buffer>,
    kept: VecDeque<Kept>,
}

impl PixelTracer {
    /// Creates the log.
    ///
    /// # Errors
    /// No memory left, or a device that cannot write it.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, HeadlessError> {
        if !gpu.graphics_stores().1 {
            let name = &gpu.info().name;
            let message = format!("{name} cannot write buffers from fragment stages, which a trace needs");
            return Err(HeadlessError::Settings(message));
        }
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let log = Buffer::new(gpu, "trace", log::SIZE, usage, Memory::Readback)?;
        Ok(Self { own: OffscreenView::new(gpu, layouts)?, log, kept: VecDeque::new() })
    }

    /// The stage that draws a pixel, and the files whose statements it has there.
    ///
    /// # Errors
    /// No stage of the model draws the mode, or the stage does not compile with a log.
    pub fn files(
        &mut self,
        pixel: &TracedPixel<'_>,
        tools: &TraceTools<'_>,
    ) -> Result<(String, Vec<String>), HeadlessError> {
        let Plan { state, .. } = plan(pixel)?;
        let kept = self.stage(pixel, &state, tools)?;
        Ok((kept.stage.clone(), kept.files_of(constants(&state))))
    }

    /// The value of the pixel in the picture.
    ///
    /// # Errors
    /// As [`Self::trace`].
    pub fn value(&mut self, pixel: &TracedPixel<'_>, tools: &mut TraceTools<'_>) -> Result<PixelValue, HeadlessError> {
        let Plan { state, .. } = plan(pixel)?;
        // Without counting as a request, so that the pipelines of the picture stay.
        pixel.set.build_aside(&state.pipelines)?;
        let frame = pixel.bind(tools.resources, pixel.set, &state)?;
        self.draw_pixel(&frame, pixel.at, false)
    }

    /// Traces the statements of `files` of the tree at a pixel; without files, those of all. The pixel is drawn once for each group of
    /// files. `shown`: its value in the picture.
    ///
    /// # Errors
    /// No stage of the model draws the mode, the stage has no such file, the model does not cover the pixel, or a device error.
    pub fn trace(
        &mut self,
        pixel: &TracedPixel<'_>,
        tools: &mut TraceTools<'_>,
        files: &[&str],
        shown: &PixelValue,
    ) -> Result<Trace, HeadlessError> {
        let fails = |message: String| Err(HeadlessError::Settings(message));
        let Plan { near, state } = plan(pixel)?;
        let constants = constants(&state);
        let constants: Vec<&[(u32, u32)]> = constants.iter().map(Vec::as_slice).collect();
        let kept = self.stage(pixel, &state, tools)?;
        let mut trace: Option<Trace> = None;
        for group in kept.logging.groups(files, &constants).map_err(HeadlessError::Settings)? {
            if (tools.is_canceled)() {
                return Err(HeadlessError::Canceled);
            }
            let (words, redrawn) = self.draw(pixel, &near, tools, &group)?;
            let Some(traced) = self.kept.front().and_then(|kept| kept.groups.front()) else { break };
            let of_group = Trace::new(&traced.stage, &words, shown, &redrawn);
            if of_group.fragments.is_empty() {
                break;
            }
            match &mut trace {
                Some(trace) => trace.add(of_group).map_err(HeadlessError::Settings)?,
                None => trace = Some(of_group),
            }
        }
        let (x, y) = pixel.at;
        trace.map_or_else(
            || fails(format!("the model does not cover the pixel {x},{y}: no fragment is drawn there")),
            Ok,
        )
    }

    /// The stage of a frame with a log, the first of those that are kept.
    fn stage(
        &mut self,
        pixel: &TracedPixel<'_>,
        state: &FrameState,
        tools: &TraceTools<'_>,
    ) -> Result<&mut Kept, HeadlessError> {
        let (shaders, stage) = (&pixel.whole.shaders, &state.pipelines.stage);
        let is_it = |kept: &Kept| Arc::ptr_eq(&kept.shaders, shaders) && kept.stage == *stage;
        let kept = match self.kept.iter().position(is_it).and_then(|at| self.kept.remove(at)) {
            Some(kept) => kept,
            None => {
                let logging = LoggingStage::new(shaders, stage, (tools.compiler, tools.source), self.log.address());
                let logging = logging.map_err(HeadlessError::Settings)?;
                let (shaders, stage) = (shaders.clone(), stage.clone());
                Kept { shaders, stage, logging, files: Vec::new(), groups: VecDeque::new() }
            }
        };
        self.kept.push_front(kept);
        self.kept.truncate(MOST_STAGES);
        Ok(&mut self.kept[0])
    }

    /// Draws the pixel with a log of these files. Returns the words of the log, and the value of the pixel. The group is then the first of
    /// the first stage.
    fn draw(
        &mut self,
        pixel: &TracedPixel<'_>,
        near: &NearPixel,
        tools: &mut TraceTools<'_>,
        files: &BTreeSet<String>,
    ) -> Result<(Vec<u32>, PixelValue), HeadlessError> {
        let kept = self.kept.front_mut().ok_or_else(changed)?;
        let known = kept.groups.iter().position(|group| group.files == *files);
        let mut group = match known.and_then(|at| kept.groups.remove(at)) {
            Some(group) => group,
            None => {
                let stage = kept.logging.of(files).map_err(HeadlessError::Settings)?;
                Group { files: files.clone(), stage, set: None }
            }
        };
        let state = near.state(pixel.mode, pixel.clock, &group.stage.shaders);
        let set = match &group.set {
            Some(set) => {
                set.build_aside(&state.pipelines)?;
                set.clone()
            }
            None => pixel.set.variant(group.stage.shaders.clone(), &state.pipelines)?,
        };
        group.set = Some(set.clone());
        kept.groups.push_front(group);
        kept.groups.truncate(MOST_FILES);
        let frame = pixel.bind(tools.resources, &set, &state)?;
        let empty: Vec<u8> = log::empty(pixel.at).iter().flat_map(|word| word.to_le_bytes()).collect();
        self.log.fill(0, self.log.size() as usize, |bytes| bytes.fill(0));
        self.log.write(0, &empty);
        let value = self.draw_pixel(&frame, pixel.at, true)?;
        let bytes = self.log.read();
        Ok((bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect(), value))
    }

    /// Draws a pixel, and returns its value. A loop that did not end was cut in the picture, too: its first rounds are in the log.
    fn draw_pixel(&mut self, frame: &BoundFrame, at: (u32, u32), logs: bool) -> Result<PixelValue, HeadlessError> {
        let Self { own, log, .. } = self;
        own.view.restart_passes();
        own.view.restart_mean();
        own.view.probe = Some(at);
        let drawn = own.draw(frame, Redraw::Pixel(at.0, at.1), |_, encoder, _| {
            if logs {
                encoder.keep(log);
                encoder.buffers_written();
            }
            Ok(())
        });
        own.view.probe = None;
        drawn?;
        Ok(own.view.pixel(own.frames.current()).map(|pixel| pixel.value).unwrap_or_default())
    }
}

impl TracedPixel<'_> {
    /// Binds a state of the frame to the pipelines of `set`.
    fn bind(
        &self,
        resources: &mut Resources,
        set: &PipelineSet,
        state: &Arc<FrameState>,
    ) -> Result<BoundFrame, HeadlessError> {
        let bound = match self.older {
            Some(like) => resources.bind_older(set, state, like)?,
            None => resources.bind_variant(set, state)?,
        };
        bound.ok_or_else(|| HeadlessError::Settings("the light of the picture is being baked".to_owned()))
    }
}

/// The frame near the pixel.
fn plan(pixel: &TracedPixel<'_>) -> Result<Plan, HeadlessError> {
    let near = NearPixel::new(pixel.whole, pixel.settings, pixel.revisions, pixel.at);
    let state = near.as_ref().map(|near| near.state(pixel.mode, pixel.clock, &pixel.whole.shaders));
    let is_traceable = |_: &_| !mode_sets([pixel.mode], 1).is_empty();
    let found = near.zip(state).filter(is_traceable).filter(|(_, state)| state.pipelines.draws_model);
    found.map(|(near, state)| Plan { near, state }).ok_or_else(|| {
        HeadlessError::Settings(format!(
            "no stage of the model draws the mode {}: what passes, random paths and toys compute cannot be traced",
            pixel.mode.slug
        ))
    })
}

/// The constants with which the frame specializes its stage.
fn constants(state: &FrameState) -> Constants {
    let keys: Vec<PipelineKey> = state.pipelines.model_keys().collect();
    keys.iter().map(|key| key.specialization.to_vec()).collect()
}

fn changed() -> HeadlessError {
    HeadlessError::Settings("the shaders have changed".to_owned())
}
