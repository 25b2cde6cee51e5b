//! Draws a pixel of the picture with a stage that logs what its statements do.

use super::pixel_tracer::{PixelTracer, TracePlan, TraceTools, TracedPixel};
use super::{Headless, HeadlessError};
use crate::frame::Clock;
use crate::shader::Mode;
use crate::shader::trace::Trace;

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
}

impl Headless {
    /// Traces statements at a pixel. It is drawn once without a log, and once with a log for each group of files. Passes that depend on
    /// earlier frames get those of the sequence.
    ///
    /// # Errors
    /// As [`Headless::render`]; the picture has no such stage, the stage has no such file, or it does not run for the pixel.
    pub fn trace(&mut self, request: &TraceRequest<'_>) -> Result<Trace, HeadlessError> {
        let TraceRequest { at, mode, stage, invocation, files } = *request;
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
        let plan = TracePlan::new(&pixel, files)?;
        let mut tracer = PixelTracer::new(&self.gpu, &self.layouts)?;
        let mut tools = TraceTools::new(&mut self.resources, &self.reloader);
        let shown = tracer.value(&plan, &mut tools)?;
        tracer.trace(&plan, &mut tools, files, &shown)
    }
}
