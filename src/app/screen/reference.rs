//! Draws the picture that the user compares with over the left part of the picture. It has a view of its own, so that neither
//! disturbs what the other keeps between frames.

use std::sync::Arc;

use super::{FRAMES_IN_FLIGHT, Screen};
use crate::app::viewer::{Reference, Viewer};
use crate::gpu::{Encoder, GpuError, Image, Use};
use crate::render::{BoundFrame, Output, Readback, Redraw, View};

/// The view of the reference, and the image that it draws to.
pub(super) struct ReferenceView {
    pub(super) view: View,
    image: Arc<Image>,
    /// The frame that was drawn last.
    pub(super) frame: BoundFrame,
    /// The part of the width that shows it, from the left, 0..1.
    part: f32,
}

impl ReferenceView {
    /// How many columns of a picture show the reference.
    fn columns(&self) -> u32 {
        (self.part.clamp(0.0, 1.0) * self.frame.state.size.0 as f32).round() as u32
    }

    /// Draws the reference to its image.
    fn draw(&mut self, encoder: &mut Encoder, slot: usize) -> Result<(), GpuError> {
        let Self { view, image, frame, .. } = self;
        let output = Output { image, before: Use::Undefined, at: (0, 0) };
        encoder.untimed(|encoder| view.draw(encoder, slot, frame, &output, Redraw::IfChanged))
    }

    /// Draws the reference and records its readback.
    pub(super) fn copy(&mut self, encoder: &mut Encoder, slot: usize) -> Result<Option<Readback>, GpuError> {
        self.draw(encoder, slot)?;
        self.view.read_back(encoder, &self.image)
    }
}

impl Screen {
    /// Allocates what the reference needs beside the picture `live`, and drops it when nothing is compared. Without memory, the
    /// comparison ends.
    pub(super) fn prepare_reference(&mut self, viewer: &mut Viewer, live: Option<&BoundFrame>) -> Result<(), GpuError> {
        let Some(live) = live else { return Ok(()) };
        let prepared = viewer.reference(live).and_then(|reference| self.reference_view(viewer, reference));
        self.reference = self.survive(prepared)?.flatten();
        Ok(())
    }

    fn reference_view(
        &mut self,
        viewer: &Viewer,
        reference: Option<Reference>,
    ) -> Result<Option<ReferenceView>, GpuError> {
        let Some(Reference { frame, part }) = reference else { return Ok(None) };
        let (mut view, image) = match self.reference.take() {
            Some(ReferenceView { view, image, .. }) => (view, Some(image)),
            None => (View::new(&viewer.gpu, viewer.resources.layouts(), FRAMES_IN_FLIGHT)?, None),
        };
        view.prepare(&frame)?;
        let fits = |image: &Arc<Image>| (image.desc().width, image.desc().height) == frame.state.size;
        let image = match image.filter(fits) {
            Some(image) => image,
            None => view.output_image(frame.state.size)?,
        };
        Ok(Some(ReferenceView { view, image, frame, part }))
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
        // Both pictures have one range, or an edit that doubles a value would change nothing.
        let live = self.last.as_ref().map(|live| &live.state);
        let is_same_mode = live.is_some_and(|live| live.pipelines.mode == reference.frame.state.pipelines.mode);
        reference.view.follow_limits(is_same_mode.then(|| self.view.limits()));
        encoder.pass("compare", |encoder| {
            reference.draw(encoder, slot)?;
            let (image, columns) = (&reference.image, reference.columns());
            encoder.transition(image, Use::Color, Use::CopyFrom);
            encoder.transition(target, Use::Color, Use::CopyTo);
            encoder.copy_columns_to(image, columns, target, at);
            encoder.transition(target, Use::CopyTo, Use::Color);
            Ok(())
        })
    }

    /// Whether a pixel of the picture shows the reference.
    pub(super) fn is_in_reference(&self, (x, _): (u32, u32)) -> bool {
        self.reference.as_ref().is_some_and(|reference| x < reference.columns())
    }
}
