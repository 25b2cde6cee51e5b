//! Draws previews: the picture at a smaller size, scaled to its place in the window. They have a view of their own, so that every stage sees
//! one size, and the view of the whole picture keeps what it holds.

use std::sync::Arc;

use super::Screen;
use super::outline::draw_outline;
use super::preview_view::{ENLARGE, Preview};
use super::request::{FRAMES_IN_FLIGHT, OutlineRequest};
use crate::gpu::{Encoder, GpuError, Image, Rect, Use};
use crate::render::{BoundFrame, Output, Redraw, View};

impl Screen {
    /// Drops what previews need.
    pub(in crate::app) fn end_previews(&mut self) {
        self.preview = None;
    }

    /// Allocates what `frame` needs, the preview of another one.
    ///
    /// # Errors
    /// Out of memory.
    pub(in crate::app) fn prepare_preview(&mut self, frame: BoundFrame, of: &BoundFrame) -> Result<(), GpuError> {
        let (mut view, image, outline) = match self.preview.take() {
            Some(Preview { view, image, outline, .. }) => (view, Some(image), outline),
            // One more slot, to draw between frames.
            None => (View::new(&self.gpu, &self.layouts, FRAMES_IN_FLIGHT + 1)?, None, None),
        };
        view.prepare(&frame)?;
        let fits = |image: &Arc<Image>| (image.desc().width, image.desc().height) == frame.state.size;
        let image = match image.filter(fits) {
            Some(image) => image,
            None => view.output_image(frame.state.size)?,
        };
        self.preview = Some(Preview { view, image, frame, of: of.clone(), outline });
        Ok(())
    }

    /// Draws the preview once without showing it, so that a device which compiles with the first draw does so now.
    ///
    /// # Errors
    /// A device error other than out of memory, which ends previews.
    pub(in crate::app) fn warm_preview(&mut self) -> Result<(), GpuError> {
        let Some(Preview { view, image, frame, .. }) = &mut self.preview else { return Ok(()) };
        let output = Output { image, before: Use::Undefined, at: (0, 0) };
        let drawn = self.parts.alone(|encoder| view.draw(encoder, FRAMES_IN_FLIGHT, frame, &output, Redraw::Always));
        match drawn {
            Err(error) if error.is_shortage() => self.preview = None,
            drawn => drawn?,
        }
        Ok(())
    }

    /// Whether the last preview shows this frame of the whole picture.
    pub(in crate::app) fn previews(&self, frame: &BoundFrame) -> bool {
        let is_of = |of: &BoundFrame| Arc::ptr_eq(&of.state, &frame.state) || of.state.is_same(&frame.state);
        self.preview.as_ref().is_some_and(|preview| is_of(&preview.of))
    }

    /// The frame of the last preview, if there is one.
    pub(in crate::app) fn preview_frame(&self) -> Option<&BoundFrame> {
        self.preview.as_ref().map(|preview| &preview.frame)
    }

    /// How many frames the mean on screen has: that of the preview, or of the whole picture.
    pub(in crate::app) fn accumulated(&self, is_preview: bool) -> u32 {
        let preview = self.preview.as_ref().filter(|_| is_preview);
        preview.map_or(&self.view, |preview| &preview.view).accumulated()
    }

    /// Draws the preview to its place in `target`, which is left in [`Use::Color`], with the outline of the selection. An error in the outline
    /// is returned as a value.
    pub(super) fn draw_preview(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        outline: Option<&OutlineRequest>,
        target: &Output<'_>,
    ) -> Result<Result<(), GpuError>, GpuError> {
        let Some(Preview { view, image, frame, outline: targets, .. }) = &mut self.preview else {
            View::clear(encoder, target);
            return Ok(Ok(()));
        };
        // The range of the whole picture, so that colors do not jump.
        view.follow_limits(self.view.limits_to_follow(frame));
        let output = Output { image, before: Use::Undefined, at: (0, 0) };
        view.draw(encoder, slot, frame, &output, Redraw::IfChanged)?;
        let (width, height) = self.rect.size;
        let scale = frame.state.size.1 as f32 / height.max(1) as f32;
        let outlined = draw_outline(encoder, targets, (frame, view), outline, (image, (0, 0)), scale);
        View::clear(encoder, target);
        let (x, y) = target.at;
        encoder.pass(ENLARGE, |encoder| {
            encoder.transition(image, Use::Color, Use::CopyFrom);
            encoder.transition(target.image, Use::Color, Use::CopyTo);
            encoder.scale_to_part(image, target.image, Rect { x, y, width, height });
            encoder.transition(target.image, Use::CopyTo, Use::Color);
            encoder.transition(image, Use::CopyFrom, Use::Color);
        });
        Ok(outlined)
    }
}
