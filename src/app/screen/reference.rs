//! Draws the picture that the user compares with over the left part of the picture. It has a view of its own, so that neither
//! disturbs what the other keeps between frames.

use std::sync::Arc;

use super::reference_view::{Reference, ReferenceView};
use super::{FRAMES_IN_FLIGHT, Screen};
use crate::gpu::{Encoder, GpuError, Image};
use crate::render::View;

impl Screen {
    /// Allocates what the reference needs beside the picture, or drops it when nothing is compared. A lack of memory, here or in
    /// `reference`, ends the comparison and is kept for the end of the frame.
    pub(in crate::app) fn prepare_reference(
        &mut self,
        reference: Result<Option<Reference>, GpuError>,
    ) -> Result<(), GpuError> {
        let prepared = reference.and_then(|reference| self.reference_view(reference));
        self.reference = self.survive(prepared)?.flatten();
        Ok(())
    }

    fn reference_view(&mut self, reference: Option<Reference>) -> Result<Option<ReferenceView>, GpuError> {
        let Some(Reference { frame, still, part }) = reference else { return Ok(None) };
        let (mut view, image) = match self.reference.take() {
            Some(ReferenceView { view, image, .. }) => (view, Some(image)),
            None => (View::new(&self.gpu, &self.layouts, FRAMES_IN_FLIGHT)?, None),
        };
        let stored = still.as_ref().is_some_and(|(_, still)| still.display.is_some());
        view.override_image = still.as_ref().filter(|_| !stored).map(|(_, still)| still.image.clone());
        if !stored {
            view.prepare(&frame)?;
        }
        let fits = |image: &Arc<Image>| (image.desc().width, image.desc().height) == frame.state.size;
        let image = match image.filter(fits) {
            Some(image) => image,
            None => view.output_image(frame.state.size)?,
        };
        Ok(Some(ReferenceView { view, image, frame, still, part }))
    }

    /// Draws the reference over the left part of a picture that lies at `at` in `target`, which is in [`Use::Color`] before and
    /// after.
    pub(super) fn draw_reference(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        target: &Arc<Image>,
        at: (u32, u32),
    ) -> Result<(), GpuError> {
        let Some(reference) = &mut self.reference else { return Ok(()) };
        // Both pictures share one range, or an edit that doubles a value would not be visible.
        let live = self.last.as_ref().map(|live| &live.state);
        let is_same_mode = live.is_some_and(|live| live.pipelines.mode == reference.frame.state.pipelines.mode);
        reference.view.follow_limits(is_same_mode.then(|| self.view.limits()));
        encoder.pass("compare", |encoder| reference.copy_to(encoder, slot, target, at))
    }

    /// Whether a pixel of the picture shows the reference.
    pub(super) fn is_in_reference(&self, (x, _): (u32, u32)) -> bool {
        self.reference.as_ref().is_some_and(|reference| x < reference.columns())
    }
}
