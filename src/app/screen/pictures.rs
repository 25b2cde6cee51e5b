//! Copies of the picture on screen.

use super::Screen;
use crate::gpu::{GpuError, Use};
use crate::render::{BoundFrame, Output, Readback, Redraw};

impl Screen {
    /// Whether the range of a frame's values is not known yet, so that a copy would not be final.
    pub(in crate::app) fn lacks_limits(&self, frame: &BoundFrame) -> bool {
        self.view.lacks_limits(frame)
    }

    /// Draws the picture as it is on screen, without panels, and copies it; `redraw` tells how much of it anew. The copy has finished. After a
    /// lack of memory, the next frame draws it again.
    pub(in crate::app) fn read_picture(
        &mut self,
        frame: &BoundFrame,
        redraw: Redraw,
    ) -> Result<Option<Readback>, GpuError> {
        let read = self.copy_picture(frame, redraw);
        if read.as_ref().is_err_and(GpuError::is_shortage) {
            self.view.forget();
            self.reference = None;
        }
        read
    }

    fn copy_picture(&mut self, frame: &BoundFrame, redraw: Redraw) -> Result<Option<Readback>, GpuError> {
        let image = self.view.output_image(frame.state.size)?;
        let mut encoder = self.frames.begin()?;
        self.check_loops();
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        let slot = self.frames.current();
        self.view.draw(&mut encoder, slot, frame, &output, redraw)?;
        self.draw_reference(&mut encoder, slot, &image, (0, 0))?;
        let readback = self.view.read_back(&mut encoder, &image)?;
        self.frames.submit(encoder, Default::default())?;
        // SYNC: the CPU reads the picture.
        self.frames.wait()?;
        Ok(readback)
    }
}
