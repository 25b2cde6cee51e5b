//! Traces the pixels around one, for the values that a statement has beside it.

use super::HeadlessError;
use super::pixel_tracer::{PixelTracer, TracePlan, TraceTools, TracedPixel};
use crate::shader::PixelValue;
use crate::shader::trace::Neighborhood;

impl PixelTracer {
    /// The values of a file's statements at a square of pixels around the one of `pixel`. Pipelines are compiled for the first pixel of each
    /// kind of material alone.
    ///
    /// # Errors
    /// The stage is not one that a single pixel is drawn with, no pixel has the file, or a device error.
    pub fn neighborhood(
        &mut self,
        pixel: &TracedPixel<'_>,
        tools: &mut TraceTools<'_>,
        file: &str,
    ) -> Result<Neighborhood, HeadlessError> {
        if !TracePlan::new(pixel, &[file])?.is_of_pixel() {
            let message =
                "only a stage that draws the surfaces of the model, or a local pass, is traced around a pixel";
            return Err(HeadlessError::Settings(message.to_owned()));
        }
        let size = pixel.whole.size;
        Neighborhood::new(pixel.at, size, file, |at| {
            if (tools.is_canceled)() {
                return Err(HeadlessError::Canceled);
            }
            let pixel = TracedPixel { at, ..*pixel };
            let trace = TracePlan::new(&pixel, &[file])
                .and_then(|plan| self.trace(&plan, tools, &[file], &PixelValue::default()));
            match trace {
                Ok(trace) => Ok(Some(trace)),
                // The stage does not draw there.
                Err(HeadlessError::Settings(_)) => Ok(None),
                Err(error) => Err(error),
            }
        })
    }
}
