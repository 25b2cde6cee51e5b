//! Everything of a frame beside the picture and the panels: what lies over the picture, the grid, thumbnails, and values of pixels.

use std::sync::Arc;
use std::time::Duration;

use super::Screen;
use crate::app::viewer::Viewer;
use crate::gpu::{Encoder, GpuError, Image};
use crate::render::BoundFrame;

impl Screen {
    /// Records them for frame slot `slot`, into the window's image. Returns when thumbnails and values of pixels want the next frame.
    /// An out-of-memory error in the outline, the texture, the grid or a thumbnail drops that part; any other error ends the frame.
    pub(super) fn draw_extras(
        &mut self,
        (encoder, slot): (&mut Encoder, usize),
        viewer: &mut Viewer,
        frame: Option<&BoundFrame>,
        (image, pixels_per_point): (&Arc<Image>, f32),
    ) -> Result<[Option<Duration>; 2], GpuError> {
        self.draw_reference(encoder, slot, image, self.rect.at)?;
        let outlined = self.draw_outline(encoder, viewer, frame, image);
        self.survive(outlined)?;
        let shown = self.draw_texture(encoder, viewer, frame);
        self.survive(shown)?;
        let grid = self.draw_grid(encoder, slot, image);
        if self.survive(grid)?.is_none() {
            self.cells.clear();
            viewer.panels.grid.end();
        }
        let recorded = self.record_thumbnail(encoder, slot, viewer);
        if self.survive(recorded)?.is_none() {
            // The newest picture matters more.
            (self.thumbnails, self.thumbnail, self.shortage) = (None, None, None);
            self.lacks_thumbnails = true;
        }
        let context = (&self.layouts, pixels_per_point);
        let thumbnails = self.gallery.draw(encoder, slot, viewer, &mut self.ui, context)?;
        self.inspector.take(&self.frames, Some(slot), viewer);
        let of_pixel = (self.rect.size, self.mouse.over.then(|| self.mouse_pixel()).flatten());
        let values = self.inspector.draw(encoder, slot, viewer, &self.layouts, of_pixel)?;
        Ok([thumbnails, values])
    }
}
