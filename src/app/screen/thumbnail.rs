//! Draws the thumbnails of the versions, one at a time, while the panel that shows them is open.

use std::sync::Arc;

use super::background::Background;
use crate::gpu::{GpuError, SetLayouts, Use};
use crate::render::{BoundFrame, Capture, Output, Readback, Redraw, View};

/// The thumbnails of versions that are being drawn.
#[derive(Default)]
pub(in crate::app) struct VersionThumbnails {
    /// Draws them while some are missing.
    view: Option<View>,
    /// The version, and its thumbnail on the way from the device.
    pending: Option<(u64, Readback)>,
    /// Whether none are drawn, because memory is short.
    is_short: bool,
}

impl VersionThumbnails {
    /// Whether the next one can be drawn. `in_sight`: whether their panel is.
    pub(in crate::app) fn is_free(&mut self, in_sight: bool) -> bool {
        self.is_short &= in_sight;
        self.pending.is_none() && !self.is_short
    }

    /// Releases the view: all thumbnails are there.
    pub(in crate::app) fn rest(&mut self) {
        self.view = None;
    }

    /// Draws none until their panel is opened again.
    pub(super) fn fail(&mut self) {
        *self = Self { is_short: true, ..Self::default() };
    }

    /// The version whose thumbnail is being drawn. It is dropped.
    pub(super) fn stop(&mut self) -> Option<u64> {
        self.pending.take().map(|(number, _)| number)
    }

    /// Draws the thumbnail of a version.
    pub(super) fn record(
        &mut self,
        background: &mut Background,
        layouts: &Arc<SetLayouts>,
        (number, frame): &(u64, BoundFrame),
    ) -> Result<(), GpuError> {
        let view = match &mut self.view {
            Some(view) => view,
            none => none.insert(View::new(background.gpu(), layouts, 1)?),
        };
        view.prepare(frame)?;
        let image = view.output_image(frame.state.size)?;
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        let encoder = background.encoder()?;
        view.draw(encoder, 0, frame, &output, Redraw::IfChanged)?;
        self.pending = view.read_back(encoder, &image)?.map(|readback| (*number, readback));
        Ok(())
    }

    /// A finished thumbnail and its version.
    pub(super) fn take(&mut self, background: &Background) -> Option<(u64, Capture)> {
        let (number, readback) = self.pending.take_if(|_| background.is_finished())?;
        Some((number, readback.finish()))
    }
}
