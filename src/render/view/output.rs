//! Where a view's picture goes.

use std::sync::Arc;

use crate::gpu::{Attachments, Encoder, Image, Use};

/// The destination of a view's output.
pub struct Output<'a> {
    /// The image. [`super::View::draw`] leaves it in [`Use::Color`].
    pub image: &'a Arc<Image>,
    /// The use that the image is in: [`Use::Undefined`], or [`Use::Acquired`] from a swapchain.
    pub before: Use,
    /// Upper left corner of the output in the image. The rest of the image becomes black.
    pub at: (u32, u32),
}

/// Fills an image with black.
pub(super) fn clear_image(encoder: &mut Encoder, output: &Arc<Image>) {
    encoder.begin_rendering(&cleared(output));
    encoder.end_rendering();
}

/// Copies an image in [`Use::Sampled`] to its place in an output in [`Use::Color`].
pub(super) fn copy_image(encoder: &mut Encoder, display: &Arc<Image>, output: &Output<'_>) {
    encoder.transition(display, Use::Sampled, Use::CopyFrom);
    encoder.transition(output.image, Use::Color, Use::CopyTo);
    encoder.copy_image_to(display, output.image, output.at);
    encoder.transition(output.image, Use::CopyTo, Use::Color);
    encoder.transition(display, Use::CopyFrom, Use::Sampled);
}

pub(super) fn cleared(output: &Arc<Image>) -> Attachments<'_> {
    Attachments { clear: Some([0.0, 0.0, 0.0, 1.0]), ..Attachments::of(output) }
}
