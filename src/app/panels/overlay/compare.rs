//! The border between the picture and the one that it is compared with, and the names of both.

use std::sync::Arc;

use egui::{
    Align, Align2, Area, Color32, CursorIcon, Id, LayerId, Order, Painter, Pos2, Rect, Sense, Stroke, TextureHandle,
    Vec2, pos2, vec2,
};
use image::RgbImage;

use crate::app::command::compare::{COMPARE, CompareFields};
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::state::compare::Difference;
use crate::app::widgets::theme::{PICTURE_ACCENT, small_font};

/// Width of the draggable strip, in points.
const GRIP: f32 = 16.0;
/// Radius of the mark in its middle, in points.
const MARK: f32 = 9.0;
/// Space around a name, in points.
const MARGIN: Vec2 = vec2(8.0, 4.0);
/// Least width of a name, in points.
const LEAST_ROOM: f32 = 60.0;

/// Shows the border over the picture, and moves it with the mouse. It lies below messages and errors.
pub(super) fn show(
    egui: &egui::Context,
    state: &State,
    shown: &mut ShownMap,
    picture: Rect,
    commands: &mut Vec<Command>,
) {
    let Some([earlier, now]) = state.comparison_labels() else { return };
    let painter = egui.layer_painter(LayerId::new(Order::Background, Id::new("compare"))).with_clip_rect(picture);
    let bottom = picture.center_bottom() - vec2(0.0, 12.0);
    if state.compare.is_held {
        return name(&painter, bottom, Align2::CENTER_BOTTOM, &earlier);
    }
    let compare = &state.compare;
    if compare.shows_map {
        shown.paint(&painter, compare.difference.as_ref(), picture);
        return name(&painter, bottom, Align2::CENTER_BOTTOM, "FLIP: black is equal, white is the largest difference");
    }
    let x = picture.min.x + compare.wipe * picture.width();
    let strip = Rect::from_center_size(pos2(x, picture.center().y), vec2(GRIP, picture.height()));
    let area = Area::new(Id::new("wipe")).order(Order::Middle).fixed_pos(strip.min).constrain(false).fade_in(false);
    let response = area.show(egui, |ui| ui.allocate_response(strip.size(), Sense::drag())).inner;
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged() || response.drag_stopped()) {
        let wipe = ((at.x - picture.min.x) / picture.width().max(1.0)).clamp(0.0, 1.0);
        commands.push(COMPARE.with(CompareFields::wipe(wipe)));
        // The next press finds the strip where it was in the last frame.
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

/// The map of the difference that was shown last, as a texture.
#[derive(Default)]
pub(in crate::app::panels) struct ShownMap(Option<(Arc<RgbImage>, TextureHandle)>);

impl ShownMap {
    /// Covers the picture with the map of the difference.
    fn paint(&mut self, painter: &Painter, difference: Option<&Difference>, picture: Rect) {
        let Some(Difference { map, part: [low, high], .. }) = difference else { return };
        self.0.take_if(|(shown, _)| !Arc::ptr_eq(shown, map));
        let (_, texture) = self.0.get_or_insert_with(|| {
            let size = [map.width() as usize, map.height() as usize];
            let image = egui::ColorImage::from_rgb(size, map.as_raw());
            (map.clone(), painter.ctx().load_texture("difference", image, egui::TextureOptions::NEAREST))
        });
        let uv = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let at = |[x, y]: [f32; 2]| picture.min + vec2(x, y) * picture.size();
        painter.image(texture.id(), Rect::from_min_max(at(*low), at(*high)), uv, Color32::WHITE);
    }
}

/// Writes the name of one of the pictures, in several lines where there is little room.
fn name(painter: &Painter, at: Pos2, corner: Align2, text: &str) {
    let picture = painter.clip_rect();
    let room = match corner.x() {
        Align::Min => picture.max.x - at.x,
        Align::Center => picture.width(),
        Align::Max => at.x - picture.min.x,
    };
    let room = (room - 2.0 * MARGIN.x).max(LEAST_ROOM);
    let text = painter.layout(text.to_owned(), small_font(), Color32::from_gray(220), room);
    let inner = corner.anchor_size(at, text.size() + 2.0 * MARGIN);
    painter.rect_filled(inner, 4.0, Color32::from_black_alpha(200));
    painter.galley(inner.min + MARGIN, text, Color32::WHITE);
}
