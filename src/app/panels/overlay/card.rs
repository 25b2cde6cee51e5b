//! The cards over the picture.

use std::sync::Arc;

use egui::{Align2, Area, Color32, CornerRadius, FontId, Frame, Galley, Id, Margin, Order, Rect, Stroke, Ui};

use crate::app::widgets::theme::CARD;

/// Points between the edge of the picture and a card.
const MARGIN: f32 = 12.0;
/// Points between the edge of a card and its text.
const PADDING: f32 = 12.0;

/// A text that wraps where a card would be wider than `width` with its margins. An area keeps its first size, and so would wrap a
/// longer text at the width of the previous text.
pub(super) fn wrapped(ui: &Ui, text: &str, font: FontId, color: Color32, width: f32) -> Arc<Galley> {
    let width = (width - 2.0 * (MARGIN + PADDING + 1.0)).max(80.0);
    ui.painter().layout(text.to_owned(), font, color, width)
}

/// An area at a corner of the picture.
pub(super) fn area(id: Id, corner: Align2, picture: Rect) -> Area {
    let at = corner.pos_in_rect(&picture.shrink(MARGIN));
    Area::new(id).order(Order::Middle).pivot(corner).fixed_pos(at).constrain_to(picture)
}

/// The frame of a card.
pub(super) fn card(edge: impl Into<Color32>) -> Frame {
    Frame::new()
        .fill(CARD.color().gamma_multiply(0.93))
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(CornerRadius::same(6))
        .inner_margin(Margin::symmetric(PADDING as i8, 8))
}
