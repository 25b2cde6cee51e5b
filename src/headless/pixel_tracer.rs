//! Draws single pixels with a stage that logs what its statements do.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::HeadlessError;
use super::kept_stages::{Constants, KeptStage, KeptStages, constants_of};
use super::near_pixel::NearPixel;
use super::offscreen_view::OffscreenView;
use super::stage_plan::{self, StagePlan};
use super::traced_lights::traced_lights;
use crate::frame::{Clock, FrameState, Revisions};
use crate::gpu::{Buffer, Gpu, Memory, SetLayouts, fault, vk};
use crate::pipeline::{PipelineSet, Reloader};
use crate::render::{BoundFrame, Redraw, Resources};
use crate::settings::Settings;
use crate::shader::trace::{Invocations, Target, Trace, TraceableStage, log};
use crate::shader::{Compiler, Mode, PixelValue, ShaderSet, Source};

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
    /// Whether someone waits for a click: a software device compiles the stage once more for hidden fragments.
    pub is_interactive: bool,
    /// Whether the result is no longer needed.
    pub is_canceled: &'a dyn Fn() -> bool,
}

impl<'a> TraceTools<'a> {
    /// Those of a command, which nothing cancels.
    pub fn new(resources: &'a mut Resources, reloader: &'a Reloader) -> Self {
        let library = reloader.library();
        Self {
            resources,
            compiler: library.compiler(),
            source: library.source(),
            is_interactive: false,
            is_canceled: &|| false,
        }
    }
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
        let near = near.ok_or_else(no_picture)?;
        let all = near.state_of(stage_plan::Extent::All, pixel.mode, pixel.clock, &pixel.whole.shaders);
        let stage = stage_plan::choose(&all, pixel.stage, files)?;
        let stage = stage_plan::plan(&all, &stage, pixel.at, pixel.invocation)?;
        Ok(Self::of(pixel, near, stage))
    }

    /// The plan to run a stage.
    pub(super) fn of(pixel: &'a TracedPixel<'a>, mut near: NearPixel, stage: StagePlan) -> Self {
        // Where a pixel has several samples, their plain mean is compared, which keeps the bits of equal ones.
        near.target.weighs &= stage.samples == 1;
        let state = near.state_of(stage.extent, pixel.mode, pixel.clock, &pixel.whole.shaders);
        Self { pixel, near, stage, state }
    }

    /// The same, without the fragments that others hide.
    pub(super) fn of_drawn_fragments(mut self) -> Self {
        self.stage.hides = false;
        self
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
    pub(super) fn constants(&self) -> Constants {
        constants_of(&self.state.pipelines, self.stage())
    }
}

/// Draws pixels with logs. It has a view and a log of its own, so the picture and its history stay as they are.
pub struct PixelTracer {
    own: OffscreenView,
    stages: KeptStages,
    log: Arc<Buffer>,
    /// The words of a loop that did not end in the picture of the pixel.
    endless_loop: Option<[u32; 2]>,
    built: usize,
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
        let stages = KeptStages::new(log.address(), traces_vertices);
        Ok(Self { own: OffscreenView::new(gpu, layouts)?, stages, log, endless_loop: None, built: 0 })
    }

    /// How many pipelines with a log were built for traces so far. One that was prepared is not.
    pub fn built(&self) -> usize {
        self.built
    }

    /// The files whose statements the stage of a plan has at its pixel.
    ///
    /// # Errors
    /// The stage does not compile with a log.
    pub fn files(&mut self, plan: &TracePlan<'_>, tools: &TraceTools<'_>) -> Result<Vec<String>, HeadlessError> {
        Ok(self.stage(plan, tools)?.files_of(&plan.constants()))
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
        let mut trace: Option<Trace> = None;
        let groups = self.stage(plan, tools)?.groups(files, &constants)?;
        // A software device compiles for each depth test, which takes seconds for each group.
        let lists_hidden = !self.is_on_cpu() || (groups.len() == 1 && !tools.is_interactive);
        for files in groups {
            if (tools.is_canceled)() {
                return Err(HeadlessError::Canceled);
            }
            let mut of_group = self.draw(plan, tools, &files, shown)?;
            if of_group.fragments.is_empty() {
                break;
            }
            if plan.stage.hides && lists_hidden {
                self.own.view.draws_hidden = true;
                let all = self.draw(plan, tools, &files, shown);
                self.own.view.draws_hidden = false;
                of_group.add_hidden(all?);
            }
            match &mut trace {
                Some(trace) => trace.add(of_group).map_err(HeadlessError::Settings)?,
                None => trace = Some(of_group),
            }
        }
        let nothing = || HeadlessError::Settings(plan.stage.nothing(&plan.state.shaders, plan.pixel.at));
        let mut trace = trace.ok_or_else(nothing)?;
        trace.lights = traced_lights(&plan.state, plan.pixel.settings);
        trace.endless_loop = self.endless_loop;
        let lacks_frames = plan.pixel.earlier.len() < plan.pixel.clock.frame_index as usize;
        trace.begins_anew = lacks_frames && stage_plan::reads_earlier_frames(&plan.state, plan.stage());
        Ok(trace)
    }

    /// The stage of a plan with a log.
    pub(super) fn stage(
        &mut self,
        plan: &TracePlan<'_>,
        tools: &TraceTools<'_>,
    ) -> Result<&mut KeptStage, HeadlessError> {
        self.stages.stage(&plan.pixel.whole.shaders, plan.stage(), (tools.compiler, tools.source))
    }

    /// Whether a trace of this file compiles no pipeline.
    pub(super) fn is_built(
        &mut self,
        plan: &TracePlan<'_>,
        tools: &TraceTools<'_>,
        file: &str,
    ) -> Result<bool, HeadlessError> {
        let request = |shaders: &Arc<ShaderSet>| plan.state(plan.pixel.clock, shaders).pipelines.clone();
        Ok(self.stage(plan, tools)?.is_built(file, request))
    }

    /// Whether the device is the CPU.
    pub(super) fn is_on_cpu(&self) -> bool {
        self.own.is_software
    }

    /// Draws the pixel with a log of these files.
    pub(super) fn draw(
        &mut self,
        plan: &TracePlan<'_>,
        tools: &mut TraceTools<'_>,
        files: &BTreeSet<String>,
        shown: &PixelValue,
    ) -> Result<Trace, HeadlessError> {
        let kept = self.stage(plan, tools)?;
        let request = |shaders: &Arc<ShaderSet>| plan.state(plan.pixel.clock, shaders).pipelines.clone();
        let (group, built) = kept.group(files, plan.pixel.set, request)?;
        let (stage, set) = (group.stage.clone(), group.set.clone());
        let layout = stage.layout();
        self.built += built;
        fault::delay("trace-delay-ms");
        fault::lose_at("trace-loss");
        for (offset, length) in layout.cleared() {
            self.log.fill(offset, length, |bytes| bytes.fill(0));
        }
        let empty: Vec<u8> = log::empty(plan.stage.of).iter().flat_map(|word| word.to_le_bytes()).collect();
        self.log.write(0, &empty);
        let redrawn = self.draw_pixel(plan, tools, &set, true)?;
        let words = |length: u64| -> Vec<u32> {
            let bytes = self.log.read_part(0, length);
            bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
        };
        let invocations = words(layout.used(0)).first().copied().unwrap_or(0);
        let words = words(layout.used(invocations));
        let of = (plan.stage.of, plan.stage.target.clone(), plan.stage.samples);
        Ok(Trace::new(&stage, of, &words, shown, &redrawn))
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
            Target::Image(..) => {
                let drawing = plan.state.pipelines.passes.iter().find(|pass| pass.desc.stage == plan.stage.stage);
                let slug = format!("pass:{}", drawing.map_or("", |pass| pass.name()));
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

/// The error of a frame without a scene.
pub(super) fn no_picture() -> HeadlessError {
    HeadlessError::Settings("there is no picture to trace".to_owned())
}
