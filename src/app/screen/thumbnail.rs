//! Draws the thumbnails of the versions, one at a time, while the panel that shows them is open.

use super::{PendingThumbnail, Screen};
use crate::app::engine::Engine;
use crate::app::frames::picture::missing_thumbnail;
use crate::app::frames::progress::awaits_edit;
use crate::app::panels::timeline::THUMBNAIL;
use crate::app::state::State;
use crate::app::state::shaders::versions::Thumbnail;
use crate::gpu::{GpuError, Use};
use crate::render::{Output, Redraw, View};

impl Screen {
    /// Draws the next missing thumbnail, unless an edit is under way.
    pub(super) fn record_thumbnail(&mut self, state: &State, engine: &Engine) -> Result<(), GpuError> {
        self.lacks_thumbnails &= state.workspace.sight.timeline;
        if self.thumbnail.is_some() || self.lacks_thumbnails || awaits_edit(state, engine) {
            return Ok(());
        }
        let size = THUMBNAIL * self.egui.pixels_per_point();
        let Some((number, frame)) = missing_thumbnail(state, engine, (size.x.round() as u32, size.y.round() as u32))
        else {
            self.thumbnails = None;
            return Ok(());
        };
        let view = match &mut self.thumbnails {
            Some(view) => view,
            none => none.insert(View::new(&engine.gpu, engine.resources.layouts(), 1)?),
        };
        view.prepare(&frame)?;
        let image = view.output_image(frame.state.size)?;
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        let encoder = self.background.encoder()?;
        view.draw(encoder, 0, &frame, &output, Redraw::IfChanged)?;
        self.thumbnail = view.read_back(encoder, &image)?.map(|readback| PendingThumbnail { number, readback });
        Ok(())
    }

    /// Stores a finished thumbnail in its version.
    pub(super) fn take_thumbnail(&mut self, state: &mut State) {
        let is_finished = |_: &mut PendingThumbnail| self.background.is_finished();
        let Some(PendingThumbnail { number, readback }) = self.thumbnail.take_if(is_finished) else { return };
        let capture = readback.finish();
        let size = [capture.width as usize, capture.height as usize];
        let thumbnail = Thumbnail { size, rgba8: capture.rgba8 };
        state.versions.set_thumbnail(number, thumbnail);
    }
}
