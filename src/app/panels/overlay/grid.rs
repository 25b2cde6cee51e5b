//! The names of the modes that the picture shows side by side, and a frame around the selected one.

use egui::{Align2, Id, LayerId, Order, Rect, Stroke, StrokeKind, pos2, vec2};

use crate::app::state::grid::{GAP, Grid, PictureRect, places};
use crate::app::widgets::theme::{ACCENT, CARD, EDGE, PANEL, STRONG, small_font};
use crate::session::Session;

/// Shows the names over the picture, below cards.
pub(super) fn show(egui: &egui::Context, (session, grid): (&Session, &Grid), preview: Option<&str>, picture: Rect) {
    let Some(shaders) = &session.shaders else { return };
    if !grid.is_on() {
        return;
    }
    let painter = egui.layer_painter(LayerId::new(Order::Background, Id::new("grid"))).with_clip_rect(picture);
    let scale = egui.pixels_per_point();
    let pixel = |points: f32| (points * scale).round().max(0.0) as u32;
    let whole = PictureRect {
        at: (pixel(picture.min.x), pixel(picture.min.y)),
        size: (pixel(picture.width()), pixel(picture.height())),
    };
    let count = grid.modes().len();
    let places = places(count, whole).into_iter().map(|PictureRect { at, size }| {
        Rect::from_min_size(pos2(at.0 as f32, at.1 as f32) / scale, vec2(size.0 as f32, size.1 as f32) / scale)
    });
    // Between the pictures, and beyond the last column and row, is the color between panels.
    let gap = Stroke::new(GAP as f32 / scale, EDGE);
    let places: Vec<Rect> = places.collect();
    for rect in &places {
        painter.rect_stroke(*rect, 0.0, gap, StrokeKind::Outside);
    }
    let (rects, empty) = places.into_iter().enumerate().partition::<Vec<_>, _>(|(index, _)| *index < count);
    for (_, rect) in empty {
        painter.rect_filled(rect, 0.0, PANEL.color());
    }
    for (slug, (_, rect)) in grid.modes().iter().zip(rects) {
        let is_selected = *slug == session.settings.mode;
        // The selected mode previews the one that the mouse rests on.
        let slug = preview.filter(|_| is_selected).unwrap_or(slug);
        let name = shaders.modes.iter().find(|mode| mode.slug == slug).map_or(slug, |mode| &mode.name);
        let text = painter.layout_no_wrap(name.to_owned(), small_font(), STRONG.color());
        let card = Align2::LEFT_BOTTOM.anchor_size(rect.left_bottom() + vec2(6.0, -6.0), text.size() + vec2(14.0, 6.0));
        painter.rect_filled(card, 4.0, CARD.color().gamma_multiply(0.9));
        painter.galley(card.min + vec2(7.0, 3.0), text, STRONG.color());
        if is_selected {
            painter.rect_stroke(rect, 0.0, Stroke::new(1.5, ACCENT), StrokeKind::Inside);
        }
    }
}
