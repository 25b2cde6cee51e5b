//! The view that draws the other picture of a comparison.

use std::sync::Arc;

use image::RgbaImage;

use crate::gpu::{Encoder, GpuError, Image, Rect, Use};
use crate::picture_difference::Still;
use crate::render::{BoundFrame, Output, Redraw, View};
use crate::threads::Side;

/// The other picture of a comparison, as a frame draws it.
pub(in crate::app) struct Reference {
    /// The frame that draws it. For a picture from a file, the frame of the picture beside it.
    pub(in crate::app) frame: BoundFrame,
    /// The picture from a file, with the number of its request.
    pub(in crate::app) still: Option<(u64, Arc<Still>)>,
    /// The part of the width that shows it, from the left, 0..1.
    pub(in crate::app) part: f32,
}

/// The view of the reference, and the image that it draws to.
pub(super) struct ReferenceView {
    pub(super) view: View,
    pub(super) image: Arc<Image>,
    /// The frame that was drawn last.
    pub(super) frame: BoundFrame,
    /// The picture from a file that replaces it, with its number.
    pub(super) still: Option<(u64, Arc<Still>)>,
    /// The part of the width that shows it, from the left, 0..1.
    pub(super) part: f32,
}

impl ReferenceView {
    /// How many columns of a picture show the reference.
    pub(super) fn columns(&self) -> u32 {
        (self.part.clamp(0.0, 1.0) * self.frame.state.size.0 as f32).round() as u32
    }

    /// Whether the reference is a picture from a file.
    pub(super) fn is_still(&self) -> bool {
        self.still.is_some()
    }

    /// Whether the reference is the colors of a file, which no view draws.
    pub(super) fn is_stored(&self) -> bool {
        self.stored().is_some()
    }

    /// The number of the picture from a file, 0 without.
    pub(super) fn still_number(&self) -> u64 {
        self.still.as_ref().map_or(0, |(number, _)| *number)
    }

    /// The part of the picture that the reference covers.
    pub(super) fn covered(&self) -> Rect {
        let (width, height) = self.frame.state.size;
        self.still.as_ref().map_or(Rect { x: 0, y: 0, width, height }, |(_, still)| still.covered)
    }

    /// The colors of a file, which need no view.
    fn stored(&self) -> Option<(&Arc<Image>, &Arc<RgbaImage>)> {
        let (_, still) = self.still.as_ref()?;
        Some((&still.image, still.display.as_ref()?))
    }

    /// Draws the reference to its image.
    fn draw(&mut self, encoder: &mut Encoder, slot: usize) -> Result<(), GpuError> {
        // A file's light replaces the rendered frame, so its accumulation is not needed.
        let redraw = if self.is_still() { Redraw::ToneMap } else { Redraw::IfChanged };
        let Self { view, image, frame, .. } = self;
        let output = Output { image, before: Use::Undefined, at: (0, 0) };
        encoder.untimed(|encoder| view.draw(encoder, slot, frame, &output, redraw))
    }

    /// Draws the reference and records its readback.
    pub(super) fn copy(&mut self, encoder: &mut Encoder, slot: usize) -> Result<Option<Side>, GpuError> {
        if let Some((_, pixels)) = self.stored() {
            return Ok(Some(Side::Stored(pixels.clone())));
        }
        self.draw(encoder, slot)?;
        Ok(self.view.read_back(encoder, &self.image)?.map(Side::Drawn))
    }

    /// Copies the reference over the left columns of `target`, which is in [`Use::Color`] before and after.
    pub(super) fn copy_to(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        target: &Arc<Image>,
        at: (u32, u32),
    ) -> Result<(), GpuError> {
        let is_stored = self.is_stored();
        if !is_stored {
            self.draw(encoder, slot)?;
        }
        let image = self.stored().map_or(&self.image, |(image, _)| image);
        let image_use = if is_stored { Use::Sampled } else { Use::Color };
        encoder.transition(image, image_use, Use::CopyFrom);
        encoder.transition(target, Use::Color, Use::CopyTo);
        encoder.copy_columns_to(image, self.columns(), target, at);
        encoder.transition(target, Use::CopyTo, Use::Color);
        encoder.transition(image, Use::CopyFrom, image_use);
        Ok(())
    }
}
