//! The border between the picture and the one that it is compared with, and the names of both.

use egui::{Align2, Area, CursorIcon, Id, Order, Pos2, Rect, RichText, Sense, Stroke, Vec2, pos2, vec2};

use super::ACCENT;
use super::overlay::card;
use crate::app::viewer::{Compare, Difference, Viewer};

/// Width of the strip that the mouse takes hold of, in points.
const GRIP: f32 = 16.0;
/// Radius of the mark in its middle, in points.
const MARK: f32 = 9.0;

/// Shows the border over the picture, and moves it with the mouse.
pub(super) fn show(egui: &egui::Context, viewer: &mut Viewer, picture: Rect) {
    let Some(earlier) = viewer.reference_label() else { return };
    if viewer.compare.is_held() {
        return name(egui, "earlier", picture.center_top() + vec2(0.0, 12.0), Align2::CENTER_TOP, &earlier, picture);
    }
    let compare = &mut viewer.compare;
    if compare.shows_map {
        map(egui, compare, picture);
    }
    let x = picture.min.x + compare.wipe * picture.width();
    let strip = Rect::from_center_size(pos2(x, picture.center().y), vec2(GRIP, picture.height()));
    let area = Area::new(Id::new("wipe")).order(Order::Middle).fixed_pos(strip.min).constrain(false).fade_in(false);
    area.show(egui, |ui| {
        let (rect, response) = ui.allocate_exact_size(strip.size(), Sense::drag());
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged() || response.drag_stopped()) {
            compare.wipe = ((at.x - picture.min.x) / picture.width().max(1.0)).clamp(0.0, 1.0);
        }
        let is_active = response.hovered() || response.dragged();
        let stroke = Stroke::new(if is_active { 2.0 } else { 1.0 }, ACCENT);
        let (painter, center) = (ui.painter().with_clip_rect(picture.expand(1.0)), rect.center());
        painter.vline(center.x, picture.y_range(), stroke);
        painter.circle(center, MARK, egui::Color32::from_black_alpha(190), stroke);
        for side in [-1.0, 1.0] {
            let tip = center + vec2(side * 0.7 * MARK, 0.0);
            let back = tip - vec2(side * 0.35 * MARK, 0.0);
            let arrow = [back + vec2(0.0, -3.0), tip, back + vec2(0.0, 3.0)];
            painter.line(arrow.to_vec(), stroke);
        }
        let hint = "Drag to move the border.\nHold Space for the earlier picture alone, Ctrl+K ends";
        response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(hint);
    });
    let beside = |side: f32| pos2(x + side * 10.0, picture.max.y - 12.0);
    name(egui, "earlier", beside(-1.0), Align2::RIGHT_BOTTOM, &earlier, picture);
    name(egui, "now", beside(1.0), Align2::LEFT_BOTTOM, "now", picture);
}

/// Covers the picture with the map of the difference.
fn map(egui: &egui::Context, compare: &mut Compare, picture: Rect) {
    let Some(Difference { map, texture, .. }) = &mut compare.difference else { return };
    let load = || egui.load_texture("difference", map.clone(), egui::TextureOptions::NEAREST);
    let texture = texture.get_or_insert_with(load).id();
    let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
    let painter = egui.layer_painter(egui::LayerId::new(Order::Background, Id::new("difference")));
    painter.image(texture, picture, uv, egui::Color32::WHITE);
}

/// Shows the name of one of the pictures.
fn name(egui: &egui::Context, id: &str, at: Pos2, corner: Align2, text: &str, picture: Rect) {
    let area = Area::new(Id::new(("compare", id))).order(Order::Middle).pivot(corner).fixed_pos(at);
    // A name that does not fit beside the border stays away.
    let room = if corner == Align2::RIGHT_BOTTOM { at.x - picture.min.x } else { picture.max.x - at.x };
    if room < 60.0 && corner != Align2::CENTER_TOP {
        return;
    }
    area.interactable(false).constrain_to(picture).fade_in(false).show(egui, |ui| {
        card(egui::Color32::from_gray(60)).inner_margin(egui::Margin::symmetric(8, 3)).show(ui, |ui| {
            ui.set_max_size(Vec2::new(room.max(60.0) - 24.0, 40.0));
            ui.add(egui::Label::new(RichText::new(text).small()).truncate());
        });
    });
}
