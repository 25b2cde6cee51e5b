//! Draws single pixels with a stage that logs what its statements do. What was compiled for a version of the shaders is kept for the next
//! pixel.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use super::HeadlessError;
use super::near_pixel::NearPixel;
use super::offscreen_view::OffscreenView;
use super::stage_plan::{self, StagePlan};
use super::traced_lights::traced_lights;
use crate::frame::{Clock, FrameState, Revisions};
use crate::gpu::{Buffer, Gpu, Memory, SetLayouts, vk};
use crate::pipeline::{PipelineSet, Reloader};
use crate::render::{BoundFrame, Redraw, Resources};
use crate::settings::Settings;
use crate::shader::trace::{Invocations, LoggingStage, Target, Trace, TraceableStage, TracedStage, log};
use crate::shader::{Compiler, Mode, PixelValue, ShaderSet, Source, StageKind};

/// Stages that are kept: two of the newest version of the shaders, and of the one before.
const MOST_STAGES: usize = 4;
/// Files of a stage whose pipelines are kept.
const MOST_FILES: usize = 4;
/// Lists of constants for which the files of a stage are kept.
const MOST_CONSTANTS: usize = 16;

/// A pixel of a frame.
#[derive(Clone, Copy)]
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
    /// The times of frames before it, for passes that depend on them.
    pub earlier: &'a [Clock],
    /// The pixel, from the upper left corner.
    pub at: (u32, u32),
    /// The mode that is drawn.
    pub mode: &'a Mode,
    /// The stage that is traced; `None` for the one that draws the pixel, or that has the wanted file.
    pub stage: Option<&'a str>,
    /// The invocation of a compute stage; `None` for that of the pixel.
    pub invocation: Option<[u32; 3]>,
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

impl<'a> TraceTools<'a> {
    /// Those of a command, which nothing cancels.
    pub fn new(resources: &'a mut Resources, reloader: &'a Reloader) -> Self {
        let library = reloader.library();
        Self { resources, compiler: library.compiler(), source: library.source(), is_canceled: &|| false }
    }
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
        self.files.truncate(MOST_CONSTANTS - 1);
        self.files.insert(0, (constants, files.clone()));
        files
    }
}

struct Group {
    files: BTreeSet<String>,
    stage: TracedStage,
    /// The pipelines of the frame, with this stage.
    set: Option<Arc<PipelineSet>>,
}

/// A pixel, and how the frame draws it.
pub struct TracePlan<'a> {
    pixel: &'a TracedPixel<'a>,
    near: NearPixel,
    stage: StagePlan,
    state: Arc<FrameState>,
}

impl<'a> TracePlan<'a> {
    /// The plan to trace the statements of these files of the tree; without files, those of the stage that draws the pixel.
    ///
    /// # Errors
    /// The frame has no such stage, or it does not run for this pixel.
    pub fn new(pixel: &'a TracedPixel<'a>, files: &[&str]) -> Result<Self, HeadlessError> {
        let (x, y) = pixel.at;
        if x >= pixel.whole.size.0 || y >= pixel.whole.size.1 {
            return Err(HeadlessError::Settings(format!("the pixel {x},{y} is outside of the picture")));
        }
        let near = NearPixel::new(pixel.whole, pixel.settings, pixel.revisions, pixel.at);
        let mut near = near.ok_or_else(|| HeadlessError::Settings("there is no picture to trace".to_owned()))?;
        let all = near.state_of(stage_plan::Extent::All, pixel.mode, pixel.clock, &pixel.whole.shaders);
        let stage = stage_plan::choose(&all, pixel.stage, files)?;
        let stage = stage_plan::plan(&all, &stage, pixel.at, pixel.invocation)?;
        // Where a pixel has several samples, their plain mean is compared, which keeps the bits of equal ones.
        near.target.weighs &= stage.samples == 1;
        let state = near.state_of(stage.extent, pixel.mode, pixel.clock, &pixel.whole.shaders);
        Ok(Self { pixel, near, stage, state })
    }

    /// Whether the stage draws a pixel without the rest of the picture.
    pub(super) fn is_of_pixel(&self) -> bool {
        matches!(self.stage.of, Invocations::Pixel(..)) && !self.stage.is_whole
    }

    /// The path of the stage.
    pub fn stage(&self) -> &str {
        &self.stage.stage
    }

    /// All stages of the frame that can be traced.
    pub fn stages(&self) -> Vec<TraceableStage> {
        stage_plan::traceable(&self.near.state_of(
            stage_plan::Extent::All,
            self.pixel.mode,
            self.pixel.clock,
            &self.pixel.whole.shaders,
        ))
    }

    /// The frame at a time, with these shaders.
    fn state(&self, clock: Clock, shaders: &Arc<ShaderSet>) -> Arc<FrameState> {
        self.near.state_of(self.stage.extent, self.pixel.mode, clock, shaders)
    }

    /// The constants with which the frame specializes the stage.
    fn constants(&self) -> Constants {
        let (request, stage) = (&self.state.pipelines, self.stage());
        let keys = request.keys().filter(|key| key.stages().any(|of| of == stage));
        let mut constants: Constants = keys.map(|key| key.specialization.to_vec()).collect();
        if request.compute_stages().any(|of| of == stage) {
            constants.insert(request.pass_constants().to_vec());
        }
        constants
    }
}

/// Draws pixels with logs. It has a view and a log of its own, so the picture and its history stay as they are.
pub struct PixelTracer {
    own: OffscreenView,
    traces_vertices: bool,
    log: Arc<Buffer>,
    /// The words of a loop that did not end in the picture of the pixel.
    endless_loop: Option<[u32; 2]>,
    kept: VecDeque<Kept>,
}

impl PixelTracer {
    /// Creates the log.
    ///
    /// # Errors
    /// No memory left, or a device that cannot write it.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, HeadlessError> {
        let (traces_vertices, traces_fragments) = gpu.graphics_stores();
        if !traces_fragments {
            let name = &gpu.info().name;
            let message = format!("{name} cannot write buffers from fragment stages, which a trace needs");
            return Err(HeadlessError::Settings(message));
        }
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let log = Buffer::new(gpu, "trace", log::SIZE, usage, Memory::Readback)?;
        let (own, endless_loop, kept) = (OffscreenView::new(gpu, layouts)?, None, VecDeque::new());
        Ok(Self { own, traces_vertices, log, endless_loop, kept })
    }

    /// The files whose statements the stage of a plan has at its pixel.
    ///
    /// # Errors
    /// The stage does not compile with a log.
    pub fn files(&mut self, plan: &TracePlan<'_>, tools: &TraceTools<'_>) -> Result<Vec<String>, HeadlessError> {
        Ok(self.stage(plan, tools)?.files_of(plan.constants()))
    }

    /// The value of the pixel in the picture, or in the image of the traced pass.
    ///
    /// # Errors
    /// As [`Self::trace`].
    pub fn value(&mut self, plan: &TracePlan<'_>, tools: &mut TraceTools<'_>) -> Result<PixelValue, HeadlessError> {
        let value = self.draw_pixel(plan, tools, plan.pixel.set, false)?;
        self.endless_loop = self.own.endless_loop();
        Ok(value)
    }

    /// Traces the statements of `files` of the tree; without files, those of all. The pixel is drawn once for each group of files. `shown`:
    /// its value in the picture, which [`Self::value`] has drawn last.
    ///
    /// # Errors
    /// The stage has no such file, it does not run for the pixel, or a device error.
    pub fn trace(
        &mut self,
        plan: &TracePlan<'_>,
        tools: &mut TraceTools<'_>,
        files: &[&str],
        shown: &PixelValue,
    ) -> Result<Trace, HeadlessError> {
        let constants = plan.constants();
        let constants: Vec<&[(u32, u32)]> = constants.iter().map(Vec::as_slice).collect();
        let kept = self.stage(plan, tools)?;
        let mut trace: Option<Trace> = None;
        for group in kept.logging.groups(files, &constants).map_err(HeadlessError::Settings)? {
            if (tools.is_canceled)() {
                return Err(HeadlessError::Canceled);
            }
            let (words, redrawn) = self.draw(plan, tools, &group)?;
            let Some(traced) = self.kept.front().and_then(|kept| kept.groups.front()) else { break };
            let of = (plan.stage.of, plan.stage.target.clone(), plan.stage.samples);
            let of_group = Trace::new(&traced.stage, of, &words, shown, &redrawn);
            if of_group.fragments.is_empty() {
                break;
            }
            match &mut trace {
                Some(trace) => trace.add(of_group).map_err(HeadlessError::Settings)?,
                None => trace = Some(of_group),
            }
        }
        let mut trace = trace.ok_or_else(|| HeadlessError::Settings(plan.stage.nothing(plan.pixel.at)))?;
        trace.lights = traced_lights(&plan.state, plan.pixel.settings);
        trace.endless_loop = self.endless_loop;
        let lacks_frames = plan.pixel.earlier.len() < plan.pixel.clock.frame_index as usize;
        trace.begins_anew = lacks_frames && stage_plan::reads_earlier_frames(&plan.state, plan.stage());
        Ok(trace)
    }

    /// The stage of a frame with a log, the first of those that are kept.
    fn stage(&mut self, plan: &TracePlan<'_>, tools: &TraceTools<'_>) -> Result<&mut Kept, HeadlessError> {
        let (shaders, stage) = (&plan.pixel.whole.shaders, plan.stage());
        let is_it = |kept: &Kept| Arc::ptr_eq(&kept.shaders, shaders) && kept.stage == *stage;
        let kept = match self.kept.iter().position(is_it).and_then(|at| self.kept.remove(at)) {
            Some(kept) => kept,
            None => {
                let is_vertex = shaders.stages.get(stage).is_some_and(|stage| stage.kind == StageKind::Vertex);
                if is_vertex && !self.traces_vertices {
                    let message = "this device cannot write buffers from vertex stages, which a trace of them needs";
                    return Err(HeadlessError::Settings(message.to_owned()));
                }
                let logging = LoggingStage::new(shaders, stage, (tools.compiler, tools.source), self.log.address());
                let logging = logging.map_err(HeadlessError::Settings)?;
                let (shaders, stage) = (shaders.clone(), stage.to_owned());
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
        plan: &TracePlan<'_>,
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
        let set = match group.set.take() {
            Some(set) => set,
            None => {
                let state = plan.state(plan.pixel.clock, &group.stage.shaders);
                plan.pixel.set.variant(group.stage.shaders.clone(), &state.pipelines)?
            }
        };
        group.set = Some(set.clone());
        let layout = group.stage.layout();
        kept.groups.push_front(group);
        kept.groups.truncate(MOST_FILES);
        for (offset, length) in layout.cleared() {
            self.log.fill(offset, length, |bytes| bytes.fill(0));
        }
        let empty: Vec<u8> = log::empty(plan.stage.of).iter().flat_map(|word| word.to_le_bytes()).collect();
        self.log.write(0, &empty);
        let value = self.draw_pixel(plan, tools, &set, true)?;
        let words = |length: u64| -> Vec<u32> {
            let bytes = self.log.read_part(0, length);
            bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
        };
        let invocations = words(layout.used(0)).first().copied().unwrap_or(0);
        Ok((words(layout.used(invocations)), value))
    }

    /// Draws a pixel with the pipelines of `set`, after the frames before it, and returns its value. A loop that did not end was cut in the
    /// picture, too: its first rounds are in the log.
    fn draw_pixel(
        &mut self,
        plan: &TracePlan<'_>,
        tools: &mut TraceTools<'_>,
        set: &Arc<PipelineSet>,
        logs: bool,
    ) -> Result<PixelValue, HeadlessError> {
        let TracedPixel { at, clock, earlier, set: of_picture, .. } = *plan.pixel;
        // Passes whose image would be the same are not drawn again, but this one has to run.
        self.own.view.forget();
        self.own.view.restart_passes();
        for earlier in earlier {
            let frame = self.bind(plan, tools, of_picture, *earlier)?;
            self.own.draw(&frame, Redraw::Always, |_, _, _| Ok(()))?;
        }
        let frame = self.bind(plan, tools, set, clock)?;
        let Self { own, log, .. } = self;
        own.view.restart_mean();
        let on_display = plan.stage.target == Target::Display;
        (own.view.probe, own.view.probe_passes) = (Some(at), Some(at));
        let redraw = if plan.stage.is_whole { Redraw::Always } else { Redraw::Pixel(at.0, at.1) };
        let drawn = own.draw(&frame, redraw, |view, encoder, output| {
            if logs {
                encoder.keep(log);
                encoder.buffers_written();
            }
            if on_display { view.read_back(encoder, output) } else { Ok(None) }
        });
        (own.view.probe, own.view.probe_passes) = (None, None);
        let readback = drawn?;
        let slot = own.frames.current();
        let of_view = || own.view.pixel(slot).map(|pixel| pixel.value);
        let value = match &plan.stage.target {
            Target::Display => readback.map(|readback| displayed(readback.finish_display(), at)),
            Target::Image(name, _) => {
                let slug = format!("pass:{name}");
                own.view.pass_pixels(slot).into_iter().find(|(of, _)| *of == slug).map(|(_, pixel)| pixel.value)
            }
            Target::Picture | Target::Unknown => of_view(),
        };
        Ok(value.unwrap_or_default())
    }

    /// Binds the frame at a time to the pipelines of `set`.
    fn bind(
        &self,
        plan: &TracePlan<'_>,
        tools: &mut TraceTools<'_>,
        set: &Arc<PipelineSet>,
        clock: Clock,
    ) -> Result<BoundFrame, HeadlessError> {
        let state = plan.state(clock, &set.shaders);
        // Without counting as a request, so that the pipelines of the picture stay.
        set.build_aside(&state.pipelines)?;
        let bound = match plan.pixel.older {
            Some(like) => tools.resources.bind_older(set, &state, like)?,
            None => tools.resources.bind_variant(set, &state)?,
        };
        bound.ok_or_else(|| HeadlessError::Settings("the light of the picture is being baked".to_owned()))
    }
}

/// A pixel of the display: red, green, blue and alpha, 0..1.
fn displayed((width, _, rgba8): (u32, u32, Vec<u8>), (x, y): (u32, u32)) -> PixelValue {
    let start = 4 * (y as usize * width as usize + x as usize);
    let bytes = rgba8.get(start..start + 4).unwrap_or(&[0; 4]);
    PixelValue { value: std::array::from_fn(|at| f32::from(bytes[at]) / 255.0), ..PixelValue::default() }
}

fn changed() -> HeadlessError {
    HeadlessError::Settings("the shaders have changed".to_owned())
}
