//! A view with targets of its own, which draws without a window.

use std::sync::Arc;

use super::HeadlessError;
use crate::gpu::{Encoder, Frames, Gpu, GpuError, Image, SetLayouts, Use};
use crate::render::{BoundFrame, Output, Readback, Redraw, View};

/// A view and the image that it draws to.
pub struct OffscreenView {
    /// The view.
    pub view: View,
    /// Its submissions, one at a time.
    pub frames: Frames,
    output: Option<Arc<Image>>,
    pub(super) is_software: bool,
}

/// Most pixels whose random paths a software device follows at once. A device that does not answer for long counts as lost, and it needs
/// seconds for so many.
const PATHS_AT_ONCE: u32 = 1 << 17;

impl OffscreenView {
    /// Creates the view. Its targets come with the first frame.
    ///
    /// # Errors
    /// No memory left.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, GpuError> {
        let is_software = gpu.info().kind == "cpu";
        Ok(Self { view: View::new(gpu, layouts, 1)?, frames: Frames::new(gpu, 1)?, output: None, is_software })
    }

    /// Draws a frame, records `more`, and waits for both. Loops that did not end are told by [`Self::endless_loop`].
    ///
    /// # Errors
    /// A device error.
    pub fn draw<T>(
        &mut self,
        frame: &BoundFrame,
        redraw: Redraw,
        more: impl FnOnce(&View, &mut Encoder, &Arc<Image>) -> Result<T, GpuError>,
    ) -> Result<T, HeadlessError> {
        self.view.prepare(frame)?;
        let fits = |image: &Arc<Image>| (image.desc().width, image.desc().height) == frame.state.size;
        let image = match self.output.take().filter(fits) {
            Some(image) => image,
            None => self.view.output_image(frame.state.size)?,
        };
        self.output = Some(image.clone());
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        let mut encoder = self.frames.begin()?;
        let slot = self.frames.current();
        let drawn = self.view.draw(&mut encoder, slot, frame, &output, redraw);
        let recorded = drawn.and_then(|()| more(&self.view, &mut encoder, &image));
        let result = recorded.and_then(|result| self.frames.submit(encoder, Default::default()).map(|()| result));
        if result.is_err() {
            self.view.forget();
        }
        let result = result?;
        // SYNC: this thread reads the picture, or draws the next over it.
        self.frames.wait()?;
        self.view.take_range_sample(slot);
        Ok(result)
    }

    /// Reads back the last frame, after all that was only needed to draw it is freed, and frees the targets. On a software device they are
    /// most of the memory.
    ///
    /// # Errors
    /// A device error.
    pub fn read_back_last(&mut self) -> Result<Option<Readback>, HeadlessError> {
        let Some(image) = self.output.take() else { return Ok(None) };
        self.view.free_samples();
        let mut encoder = self.frames.begin()?;
        let recorded = self.view.read_back(&mut encoder, &image);
        let result = recorded.and_then(|result| self.frames.submit(encoder, Default::default()).map(|()| result));
        // SYNC: this thread reads the picture.
        let waited = result.and_then(|result| self.frames.wait().map(|()| result));
        self.view.free_targets();
        Ok(waited?)
    }

    /// In how many rows at once the model of a frame is drawn; `None` if it is drawn as a whole. A software device takes too long for the whole
    /// of a large frame of random paths.
    pub fn rows_at_once(&self, frame: &BoundFrame, redraw: Redraw) -> Option<u32> {
        let (width, height) = frame.state.size;
        let rows = (PATHS_AT_ONCE / width).max(1);
        let has_parts = frame.state.pipelines.traces && redraw == Redraw::Always && frame.stands_alone();
        (self.is_software && has_parts && rows < height).then_some(rows)
    }

    /// Draws the next part of so many rows of the model of the next picture of a frame, and waits for it. Returns whether there are more.
    ///
    /// # Errors
    /// A device error.
    pub fn draw_part(&mut self, frame: &BoundFrame, rows: u32) -> Result<bool, HeadlessError> {
        self.view.prepare(frame)?;
        let mut encoder = self.frames.begin()?;
        let slot = self.frames.current();
        let drawn = self.view.draw_part(&mut encoder, slot, frame, (0, 0), rows);
        let drawn = drawn.and_then(|()| self.frames.submit(encoder, Default::default()));
        if drawn.is_err() {
            self.view.forget();
        }
        drawn?;
        // SYNC: the next part uses the same slot.
        self.frames.wait()?;
        // None, if there is no next picture.
        let rows = self.view.rows_in_parts(frame);
        Ok(rows > 0 && rows < frame.state.size.1)
    }

    /// The words of a loop of the last frame that did not end.
    pub fn endless_loop(&self) -> Option<[u32; 2]> {
        self.frames.endless_loop(self.frames.current())
    }
}
