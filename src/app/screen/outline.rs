//! Draws the outline of the selection over a picture.

use std::sync::Arc;

use super::request::OutlineRequest;
use crate::gpu::{Encoder, GpuError, Image};
use crate::render::tools::{Outline, OutlineStyle};
use crate::render::{BoundFrame, View};

/// Draws the outline over the picture of `frame`, which `view` has drawn, at its place in an image in [`crate::gpu::Use::Color`]. `targets`
/// are those of the last outline; without a request there are none. A `scale` below 1 makes the outline as much thinner as the picture is
/// smaller.
pub(super) fn draw_outline(
    encoder: &mut Encoder,
    targets: &mut Option<Outline>,
    (frame, view): (&BoundFrame, &View),
    request: Option<&OutlineRequest>,
    (target, at): (&Arc<Image>, (u32, u32)),
    scale: f32,
) -> Result<(), GpuError> {
    let before = targets.take();
    let Some(OutlineRequest { tools, selected, style }) = request else { return Ok(()) };
    let outline = match before.filter(|outline| outline.fits(frame.state.size)) {
        Some(outline) => outline,
        None => Outline::new(tools, frame.state.size)?,
    };
    let Some(placed) = view.placed() else { return Ok(()) };
    let is_selected = |instance: usize| selected.get(instance) == Some(&true);
    let style = OutlineStyle { width: style.width * scale, ..*style };
    encoder.pass("outline", |encoder| {
        outline.draw(encoder, (frame, placed), is_selected, (target, at), style);
    });
    *targets = Some(outline);
    Ok(())
}
