//! Draws a pixel of the picture with a stage that logs what its statements do.

use super::pixel_tracer::{PixelTracer, TraceTools, TracedPixel};
use super::{Headless, HeadlessError};
use crate::shader::Mode;
use crate::shader::trace::Trace;

impl Headless {
    /// Traces the statements of `files` of the tree that draw a mode at a pixel, counted from the upper left corner; without files, those of
    /// all. The pixel is drawn once without a log, and once with a log for each group of files.
    ///
    /// # Errors
    /// As [`Headless::render`]; no stage of the model draws the mode, the stage has no such file, or the model does not cover the pixel.
    pub fn trace(&mut self, at: (u32, u32), mode: &Mode, files: &[&str]) -> Result<Trace, HeadlessError> {
        let mut tracer = PixelTracer::new(&self.gpu, &self.layouts)?;
        let shown = self.pixel(at, std::slice::from_ref(mode))?.first().copied().unwrap_or_default();
        let whole = self.frame_state()?;
        let (settings, revisions) = (self.session.settings.clone(), self.session.revisions);
        let changed = || HeadlessError::Settings("the shaders have changed".to_owned());
        let set = self.resources.pipelines().cloned().ok_or_else(changed)?;
        let (clock, older) = (self.clock, None);
        let pixel = TracedPixel { whole: &whole, set: &set, older, settings: &settings, revisions, clock, at, mode };
        let library = self.reloader.library();
        let mut tools = TraceTools {
            resources: &mut self.resources,
            compiler: library.compiler(),
            source: library.source(),
            is_canceled: &|| false,
        };
        tracer.trace(&pixel, &mut tools, files, &shown)
    }
}
