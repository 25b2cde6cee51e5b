//! A tile of the gallery of modes: a thumbnail with the mode's name below and its key as a badge.

use egui::{Align2, Color32, CornerRadius, Rect, Response, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::app::gallery::Thumbnails;
use crate::app::widgets::theme::{ACCENT, EDGE, LINE, QUIET, small_font, small_mono_font};
use crate::shader::Mode;

/// The smallest width of a tile, points.
const NARROW: f32 = 92.0;
/// The largest width of a tile, points.
const WIDE: f32 = 160.0;
/// Points between tiles.
const GAP: f32 = 6.0;
/// Height of the name below a thumbnail, points.
const NAME: f32 = 18.0;
const ROUND: CornerRadius = CornerRadius::same(4);

/// The number of tiles in a row of this width, and the size of their thumbnails, in points.
pub(super) fn columns(width: f32) -> (usize, egui::Vec2) {
    let columns = ((width + GAP) / (NARROW + GAP)).floor().max(1.0);
    let tile = ((width - (columns - 1.0) * GAP) / columns).floor().clamp(48.0, WIDE);
    (columns as usize, vec2(tile, (tile * 0.75).round()))
}

/// Shows tiles of modes, row by row. `tile` shows one.
pub(super) fn grid<T>(ui: &mut Ui, columns: usize, tiles: &[T], mut tile: impl FnMut(&mut Ui, &T)) {
    ui.spacing_mut().item_spacing = vec2(GAP, GAP);
    for row in tiles.chunks(columns) {
        ui.horizontal(|ui| row.iter().for_each(|item| tile(ui, item)));
    }
}

/// Shows a mode. `key` selects it. Returns its response, and whether it is in sight.
pub(super) fn show(
    ui: &mut Ui,
    mode: &Mode,
    key: Option<char>,
    is_current: bool,
    (thumbnails, size): (&Thumbnails, egui::Vec2),
) -> (Response, bool) {
    let (rect, response) = ui.allocate_exact_size(size + vec2(0.0, NAME), Sense::click());
    crate::app::widgets::spoken::button(&response, &mode.name);
    if !ui.is_rect_visible(rect) {
        return (response, false);
    }
    let picture = Rect::from_min_size(rect.min, size);
    let painter = ui.painter();
    painter.rect_filled(picture, ROUND, EDGE);
    match thumbnails.texture.zip(thumbnails.places.get(&mode.slug)) {
        Some((texture, place)) => {
            let image = egui::Image::new((texture, size)).uv(*place).corner_radius(ROUND);
            image.paint_at(ui, picture);
        }
        None => {
            let font = small_font();
            painter.text(picture.center(), Align2::CENTER_CENTER, without_thumbnail(mode), font, QUIET.color());
        }
    }
    let stroke = match (is_current, response.hovered()) {
        (true, _) => Stroke::new(2.0, ACCENT),
        (false, true) => Stroke::new(1.0, QUIET),
        (false, false) => Stroke::new(1.0, LINE),
    };
    painter.rect_stroke(picture, ROUND, stroke, StrokeKind::Inside);
    if let Some(key) = key {
        badge(ui, picture, key);
    }
    let visuals = ui.visuals();
    let color = if is_current { ACCENT.color() } else { visuals.text_color() };
    let mut job = egui::text::LayoutJob::simple_singleline(mode.name.clone(), small_font(), color);
    job.wrap = egui::text::TextWrapping::truncate_at_width(size.x);
    let name = ui.painter().layout_job(job);
    let left = picture.center().x - 0.5 * name.size().x;
    ui.painter().galley(pos2(left, picture.max.y + 2.0), name, color);
    (response, true)
}

/// The key that selects the mode, in a corner.
fn badge(ui: &Ui, picture: Rect, key: char) {
    let at = Rect::from_min_size(pos2(picture.max.x - 19.0, picture.min.y + 4.0), vec2(15.0, 15.0));
    ui.painter().rect_filled(at, CornerRadius::same(3), Color32::from_black_alpha(170));
    let font = small_mono_font();
    ui.painter().text(at.center(), Align2::CENTER_CENTER, key, font, Color32::from_gray(225));
}

/// Text that replaces a missing thumbnail.
fn without_thumbnail(mode: &Mode) -> &'static str {
    match mode {
        mode if mode.pass.is_some() => "image of a pass",
        mode if mode.accumulate || mode.traces => "random paths",
        _ => "",
    }
}
