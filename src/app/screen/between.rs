//! Draws thumbnails and values of pixels between frames.

use std::sync::Arc;
use std::time::Duration;

use super::background::Background;
use super::between_request::{BetweenRequest, Collected, Drawn};
use super::gallery::Gallery;
use super::inspector::PixelReader;
use super::number::NumberReader;
use super::thumbnail::VersionThumbnails;
use crate::app::gallery::Thumbnails;
use crate::gpu::{Gpu, GpuError, SetLayouts, UiRenderer};
use crate::render::Resources;

/// Polling interval for a submission's end, for which drivers send no event.
pub(in crate::app) const POLL: Duration = Duration::from_millis(2);

/// The renderers that draw between frames.
pub(in crate::app) struct Between {
    background: Background,
    gallery: Gallery,
    inspector: PixelReader,
    pub(super) number: NumberReader,
    pub(in crate::app) versions: VersionThumbnails,
    layouts: Arc<SetLayouts>,
}

impl Between {
    pub(super) fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, GpuError> {
        Ok(Self {
            background: Background::new(gpu)?,
            gallery: Gallery::default(),
            inspector: PixelReader::default(),
            number: NumberReader::default(),
            versions: VersionThumbnails::default(),
            layouts: layouts.clone(),
        })
    }

    /// Whether the device has run the last submission.
    pub(in crate::app) fn is_finished(&self) -> bool {
        self.background.is_finished()
    }

    /// Notes whether there are results that no frame has shown.
    pub(in crate::app) fn set_unseen(&mut self, is_unseen: bool) {
        self.background.is_unseen = is_unseen;
    }

    pub(in crate::app) fn is_unseen(&self) -> bool {
        self.background.is_unseen
    }

    /// The time until the next poll of the device; `None` if it draws nothing between frames.
    pub(in crate::app) fn time_to_poll(&self) -> Option<Duration> {
        (!self.is_finished()).then_some(POLL)
    }

    /// The thumbnails of modes as the panels show them.
    pub(in crate::app) fn thumbnails(&self) -> &Thumbnails {
        &self.gallery.thumbnails
    }

    /// Whether the thumbnails of modes do not fit any more.
    pub(super) fn is_misfit(&self, points: [f32; 2], pixels_per_point: f32) -> bool {
        self.gallery.is_misfit(self.background.gpu(), points, pixels_per_point)
    }

    /// Drops the thumbnails of modes. The caller has waited for the frames that use them. SYNC: waits for the last submission.
    pub(super) fn drop_thumbnails(&mut self, ui: &mut UiRenderer) -> Result<(), GpuError> {
        self.background.wait()?;
        self.gallery.drop_texture(ui);
        Ok(())
    }

    /// Collects the results of the last submission, if it is finished.
    pub(super) fn collect(&mut self) -> Collected {
        let Self { background, inspector, number, versions, .. } = self;
        let mut collected = Collected { version: versions.take(background), ..Collected::default() };
        inspector.take(background, &mut collected);
        number.take(background);
        collected.is_new = background.is_finished() && std::mem::take(&mut background.is_unread);
        collected.is_endless = collected.is_new && background.frames.endless_loop(0).is_some();
        collected
    }

    /// Draws thumbnails and values of pixels that are out of date, once the last submission is finished. A lack of memory drops them.
    pub(super) fn draw(
        &mut self,
        request: &BetweenRequest<'_>,
        resources: &mut Resources,
        ui: &mut UiRenderer,
    ) -> Result<Drawn, GpuError> {
        let mut drawn = Drawn::default();
        let recorded = self.record(request, resources, ui, &mut drawn);
        match recorded.and_then(|wait| self.background.submit().map(|()| wait)) {
            Ok(wait) => drawn.wait = wait,
            Err(error) if error.is_shortage() => {
                self.background.encoder = None;
                self.versions.fail();
                self.gallery.forget();
                self.inspector.forget();
                self.number.stop();
            }
            Err(error) => return Err(error),
        }
        Ok(drawn)
    }

    fn record(
        &mut self,
        request: &BetweenRequest<'_>,
        resources: &mut Resources,
        ui: &mut UiRenderer,
        drawn: &mut Drawn,
    ) -> Result<Option<Duration>, GpuError> {
        let Self { background, gallery, inspector, number, versions, layouts } = self;
        match request.version.as_ref().map_or(Ok(()), |version| versions.record(background, layouts, version)) {
            Err(error) if error.is_shortage() => versions.fail(),
            recorded => recorded?,
        }
        let thumbnails = gallery.draw(background, request, resources, (ui, layouts), drawn)?;
        let values = inspector.draw(background, request, resources, layouts, drawn)?;
        let number = number.draw(background, request, resources, layouts, drawn)?;
        Ok([thumbnails, values, number].into_iter().flatten().min())
    }

    /// Draws nothing between frames until something changes. Returns the version whose thumbnail was being drawn.
    pub(super) fn end(&mut self) -> Option<u64> {
        self.gallery.stop();
        self.inspector.stop();
        self.number.stop();
        self.versions.stop()
    }
}
