//! Draws a pixel of the picture with a stage that logs what its statements do.

use super::pixel_tracer::{PixelTracer, TracePlan, TraceTools, TracedPixel};
use super::{Headless, HeadlessError, Prepared};
use crate::frame::Clock;
use crate::gpu::GpuError;
use crate::scene::pick;
use crate::shader::trace::{Neighborhood, Trace};
use crate::shader::{Diagnostic, Mode};

/// Columns and rows of the pixels in [`Headless::pixels_of_model`].
const GRID: u32 = 24;

/// The question of a trace.
#[derive(Clone, Copy, Debug)]
pub struct TraceRequest<'a> {
    /// The pixel, counted from the upper left corner.
    pub at: (u32, u32),
    /// The mode that is drawn.
    pub mode: &'a Mode,
    /// The stage; `None` for the one that draws the pixel, or the first that has the files.
    pub stage: Option<&'a str>,
    /// The invocation of a compute stage; `None` for that of the pixel.
    pub invocation: Option<[u32; 3]>,
    /// The files of the tree whose statements are traced; without files, all of the stage.
    pub files: &'a [&'a str],
    /// Whether someone waits for a click, as in [`TraceTools`].
    pub is_interactive: bool,
}

impl Headless {
    /// Traces statements at a pixel. It is drawn once without a log, and once with a log for each group of files. Passes that depend on
    /// earlier frames get those of the sequence.
    ///
    /// # Errors
    /// As [`Headless::render`]; the picture has no such stage, the stage has no such file, or it does not run for the pixel.
    pub fn trace(&mut self, request: &TraceRequest<'_>) -> Result<Trace, HeadlessError> {
        self.with_pixel(request, |pixel, tracer, tools| {
            let plan = TracePlan::new(pixel, request.files)?;
            let shown = tracer.value(&plan, tools)?;
            tracer.trace(&plan, tools, request.files, &shown)
        })
    }

    /// Compiles what [`Headless::trace`] needs for the request's first file at any pixel: for this many kinds of material, those at the
    /// request's pixel first.
    ///
    /// # Errors
    /// As [`Headless::trace`].
    pub fn prepare_trace(&mut self, request: &TraceRequest<'_>, most: usize) -> Result<Prepared, HeadlessError> {
        let file = request.files.first().copied();
        self.with_pixel(request, |pixel, tracer, tools| tracer.prepare(pixel, tools, file, most))
    }

    /// Some pixels of the picture that the model covers, those in the middle first.
    ///
    /// # Errors
    /// There is no frame yet.
    pub fn pixels_of_model(&self) -> Result<Vec<(u32, u32)>, HeadlessError> {
        let state = self.frame_state()?;
        let Some(scene) = &state.scene else { return Ok(Vec::new()) };
        let (width, height) = state.size;
        let steps = |size: u32| (1..GRID).map(move |step| size * step / GRID);
        let mut all: Vec<(u32, u32)> = steps(width).flat_map(|x| steps(height).map(move |y| (x, y))).collect();
        all.sort_by_key(|(x, y)| x.abs_diff(width / 2) + y.abs_diff(height / 2));
        let is_covered = |at: &(u32, u32)| {
            pick(scene.model(), &state.camera, state.size, *at, |instance| scene.sides(instance)).is_some()
        };
        all.retain(is_covered);
        Ok(all)
    }

    /// The values of the statements of the request's first file at a square of pixels around the pixel.
    ///
    /// # Errors
    /// As [`Headless::trace`]; the request names no file, or the stage is one that needs the whole picture.
    pub fn trace_around(&mut self, request: &TraceRequest<'_>) -> Result<Neighborhood, HeadlessError> {
        let none = || HeadlessError::Settings("the pixels around one are traced for one file".to_owned());
        let file = *request.files.first().ok_or_else(none)?;
        self.with_pixel(request, |pixel, tracer, tools| tracer.neighborhood(pixel, tools, file))
    }

    /// The loop that was cut short in the picture of a trace: a warning if it ends by itself.
    pub fn endless_loop_of(&self, trace: &Trace) -> Option<Diagnostic> {
        match self.explained(HeadlessError::Gpu(GpuError::EndlessLoop(trace.endless_loop?))) {
            HeadlessError::Shaders(found) => found.into_iter().next(),
            _ => None,
        }
    }

    /// Calls `run` with the pixel of a request and what draws it.
    fn with_pixel<T>(
        &mut self,
        request: &TraceRequest<'_>,
        run: impl FnOnce(&TracedPixel<'_>, &mut PixelTracer, &mut TraceTools<'_>) -> Result<T, HeadlessError>,
    ) -> Result<T, HeadlessError> {
        let TraceRequest { at, mode, stage, invocation, is_interactive, .. } = *request;
        self.finish_or_fail()?;
        self.provide()?;
        let is_animated = self.is_animated()?;
        let whole = self.frame_state()?;
        let (settings, revisions) = (self.session.settings.clone(), self.session.revisions);
        let changed = || HeadlessError::Settings("the shaders have changed".to_owned());
        let set = self.resources.pipelines().cloned().ok_or_else(changed)?;
        let (clock, older) = (self.clock, None);
        // A frame without animation needs no earlier frames.
        let count = if is_animated { self.sequence.frames.max(1) - 1 } else { 0 };
        let earlier: Vec<Clock> = (0..count).map(|index| self.sequence.clock(index)).collect();
        let pixel = TracedPixel {
            whole: &whole,
            set: &set,
            older,
            settings: &settings,
            revisions,
            clock,
            earlier: &earlier,
            at,
            mode,
            stage,
            invocation,
        };
        let mut tracer = match self.tracer.take() {
            Some(tracer) => tracer,
            None => PixelTracer::new(&self.gpu, &self.layouts)?,
        };
        let mut tools = TraceTools { is_interactive, ..TraceTools::new(&mut self.resources, &self.reloader) };
        let result = run(&pixel, &mut tracer, &mut tools)?;
        self.tracer = Some(tracer);
        Ok(result)
    }
}
