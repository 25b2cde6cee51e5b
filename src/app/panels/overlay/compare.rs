//! The border between the picture and the one that it is compared with, and the names of both.

use egui::{
    Align2, Area, Color32, CursorIcon, Id, LayerId, Order, Painter, Pos2, Rect, Sense, Stroke, Vec2, pos2, vec2,
};

use crate::app::viewer::{Compare, Difference, Viewer};
use crate::app::widgets::theme::{PICTURE_ACCENT, small_font};

/// Width of the strip that the mouse takes hold of, in points.
const GRIP: f32 = 16.0;
/// Radius of the mark in its middle, in points.
const MARK: f32 = 9.0;
/// Space around a name, in points.
const MARGIN: Vec2 = vec2(8.0, 4.0);

/// Shows the border over the picture, and moves it with the mouse. It lies below messages and errors.
pub(super) fn show(egui: &egui::Context, viewer: &mut Viewer, picture: Rect) {
    let Some([earlier, now]) = viewer.comparison_labels() else { return };
    let painter = egui.layer_painter(LayerId::new(Order::Background, Id::new("compare"))).with_clip_rect(picture);
    let bottom = picture.center_bottom() - vec2(0.0, 12.0);
    if viewer.compare.is_held() {
        return name(&painter, bottom, Align2::CENTER_BOTTOM, &earlier);
    }
    let compare = &mut viewer.compare;
    if compare.shows_map {
        map(&painter, compare, picture);
        return name(&painter, bottom, Align2::CENTER_BOTTOM, "FLIP: black is equal, white is the largest difference");
    }
    let x = picture.min.x + compare.wipe * picture.width();
    let strip = Rect::from_center_size(pos2(x, picture.center().y), vec2(GRIP, picture.height()));
    let area = Area::new(Id::new("wipe")).order(Order::Middle).fixed_pos(strip.min).constrain(false).fade_in(false);
    let response = area.show(egui, |ui| ui.allocate_response(strip.size(), Sense::drag())).inner;
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged() || response.drag_stopped()) {
        compare.wipe = ((at.x - picture.min.x) / picture.width().max(1.0)).clamp(0.0, 1.0);
        // The next press finds the strip where the last frame had it.
        egui.request_repaint();
    }
    let is_active = response.hovered() || response.dragged();
    let (stroke, center) = (Stroke::new(if is_active { 2.0 } else { 1.0 }, PICTURE_ACCENT), strip.center());
    painter.vline(center.x, picture.y_range(), stroke);
    painter.circle(center, MARK, Color32::from_black_alpha(190), stroke);
    for side in [-1.0, 1.0] {
        let tip = center + vec2(side * 0.7 * MARK, 0.0);
        let back = tip - vec2(side * 0.35 * MARK, 0.0);
        painter.line(vec![back + vec2(0.0, -3.0), tip, back + vec2(0.0, 3.0)], stroke);
    }
    response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    let beside = |side: f32| pos2(x + side * 10.0, bottom.y);
    name(&painter, beside(-1.0), Align2::RIGHT_BOTTOM, &earlier);
    name(&painter, beside(1.0), Align2::LEFT_BOTTOM, &now);
}

/// Covers the picture with the map of the difference.
fn map(painter: &Painter, compare: &mut Compare, picture: Rect) {
    let Some(Difference { map, texture, part, .. }) = &mut compare.difference else { return };
    let load = || painter.ctx().load_texture("difference", map.clone(), egui::TextureOptions::NEAREST);
    let texture = texture.get_or_insert_with(load).id();
    let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
    let at = |corner: Pos2| picture.min + corner.to_vec2() * picture.size();
    painter.image(texture, Rect::from_min_max(at(part.min), at(part.max)), uv, Color32::WHITE);
}

/// Writes the name of one of the pictures.
fn name(painter: &Painter, at: Pos2, corner: Align2, text: &str) {
    let text = painter.layout_no_wrap(text.to_owned(), small_font(), Color32::from_gray(220));
    let inner = corner.anchor_size(at, text.size() + 2.0 * MARGIN);
    painter.rect_filled(inner, 4.0, Color32::from_black_alpha(200));
    painter.galley(inner.min + MARGIN, text, Color32::WHITE);
}
