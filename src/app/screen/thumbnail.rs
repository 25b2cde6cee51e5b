//! Draws the thumbnails of the versions, one at a time, while the panel that shows them is open.

use super::{FRAMES_IN_FLIGHT, Screen};
use crate::app::panels::timeline::THUMBNAIL;
use crate::app::viewer::Viewer;
use crate::gpu::{Encoder, GpuError, Use};
use crate::render::{Output, Readback, Redraw, View};

/// A thumbnail on the way from the device.
pub(super) struct Pending {
    /// The frame that it was drawn with.
    slot: usize,
    /// The version.
    pub(super) number: u64,
    readback: Readback,
}

impl Screen {
    /// Draws the next missing thumbnail with this frame. The first frame of an edit has none, so that it comes as early as it can.
    pub(super) fn record_thumbnail(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        viewer: &Viewer,
    ) -> Result<(), GpuError> {
        self.lacks_thumbnails &= viewer.panels.timeline.is_visible;
        if self.thumbnail.is_some() || self.lacks_thumbnails || viewer.times_next_frame() {
            return Ok(());
        }
        let size = THUMBNAIL * self.egui.pixels_per_point();
        let Some((number, frame)) = viewer.missing_thumbnail((size.x.round() as u32, size.y.round() as u32)) else {
            self.thumbnails = None;
            return Ok(());
        };
        let view = match &mut self.thumbnails {
            Some(view) => view,
            none => none.insert(View::new(&viewer.gpu, viewer.resources.layouts(), FRAMES_IN_FLIGHT)?),
        };
        view.prepare(&frame)?;
        let image = view.output_image(frame.state.size)?;
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        let readback = encoder.pass("thumbnail", |encoder| {
            encoder.untimed(|encoder| view.draw(encoder, slot, &frame, &output, Redraw::IfChanged))?;
            view.read_back(encoder, &image)
        })?;
        self.thumbnail = readback.map(|readback| Pending { slot, number, readback });
        Ok(())
    }

    /// Gives a thumbnail whose frame has finished to its version.
    pub(super) fn take_thumbnail(&mut self, viewer: &mut Viewer) {
        let is_finished = |pending: &mut Pending| self.frames.is_finished(pending.slot);
        let Some(Pending { number, readback, .. }) = self.thumbnail.take_if(is_finished) else { return };
        let capture = readback.finish();
        let size = [capture.width as usize, capture.height as usize];
        let image = egui::ColorImage::from_rgba_unmultiplied(size, &capture.rgba8);
        let texture = self.egui.load_texture(format!("version {number}"), image, egui::TextureOptions::LINEAR);
        viewer.versions.set_thumbnail(number, texture);
    }
}
