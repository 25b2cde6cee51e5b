//! Traces the pixels around one, for the values that a statement has beside it.

use super::HeadlessError;
use super::pixel_tracer::{PixelTracer, TracePlan, TraceTools, TracedPixel};
use crate::shader::PixelValue;
use crate::shader::trace::Neighborhood;

/// Kinds of material beside that of the pixel for which pipelines are compiled.
const MOST_KINDS: usize = 16;

impl PixelTracer {
    /// The values of a file's statements at a square of pixels around the one of `pixel`. Pipelines are compiled for the first pixel of each
    /// kind of material alone; on a software device, whose frames would wait for that, for the pixel's own alone: the others have no values.
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
        let own = TracePlan::new(pixel, &[file])?.of_drawn_fragments();
        self.trace(&own, tools, &[file], &PixelValue::default())?;
        let mut kinds = if self.is_on_cpu() { 0 } else { MOST_KINDS };
        Neighborhood::new(pixel.at, size, file, |at| {
            if (tools.is_canceled)() {
                return Err(HeadlessError::Canceled);
            }
            let pixel = TracedPixel { at, ..*pixel };
            let trace = TracePlan::new(&pixel, &[file]).and_then(|plan| {
                let plan = plan.of_drawn_fragments();
                if !self.is_built(&plan, tools, file)? {
                    let none = || HeadlessError::Settings("another kind of material".to_owned());
                    kinds = kinds.checked_sub(1).ok_or_else(none)?;
                }
                self.trace(&plan, tools, &[file], &PixelValue::default())
            });
            match trace {
                Ok(trace) => Ok(Some(trace)),
                // The stage does not draw there.
                Err(HeadlessError::Settings(_)) => Ok(None),
                Err(error) => Err(error),
            }
        })
    }
}
