//! Graphs of the last frames, one column for each.

use egui::{Align2, Color32, Mesh, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::state::State;
use crate::app::state::timing::{FRAMES, Timing};
use crate::app::widgets::theme::{EDGE, LINE, QUIET, TEXT, Tone, WARNING, small_font};

/// Heights of the graphs, in points.
const PASSES: f32 = 64.0;
const CPU: f32 = 36.0;
/// Colors of passes, by their place in the frame. The last color is shared by all further passes.
const COLORS: [Tone; 8] = [
    Tone::new(0x5eb6ff, 0x1f7fd1),
    Tone::new(0xffb054, 0xc87400),
    Tone::new(0x7ecc80, 0x3c8c40),
    Tone::new(0xd682d6, 0xa04aa0),
    Tone::new(0xf0e26e, 0x9a8a00),
    Tone::new(0x6acece, 0x138c8c),
    Tone::new(0xe87874, 0xc0403a),
    Tone::new(0x8c9098, 0x6a6e76),
];
/// Colors of the CPU's graph.
pub(super) const UI: Tone = COLORS[0];
pub(super) const RECORD: Tone = COLORS[1];

/// The color of the pass at this place.
pub(super) fn color(index: usize) -> Color32 {
    COLORS[index.min(COLORS.len() - 1)].color()
}

/// The value at the top of a graph: a round number above nearly all values, so that one slow frame does not flatten the rest.
fn top_of(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let high = sorted.get(sorted.len().saturating_sub(1) * 19 / 20).copied().unwrap_or(1.0).max(0.01) * 1.1;
    let step = 10f64.powf(high.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|factor| factor * step).into_iter().find(|top| *top >= high).unwrap_or(high)
}

/// Column rectangles that are drawn as one mesh.
struct Columns {
    mesh: Mesh,
    rect: Rect,
    top: f64,
}

impl Columns {
    /// The left and right edge of a column; the newest frame is at the right.
    fn edges(rect: Rect, index: usize, count: usize) -> (f32, f32) {
        let width = rect.width() / FRAMES as f32;
        let left = rect.right() - width * (count - index) as f32;
        (left, left + width)
    }

    /// Adds a part of a column from `low` to `high`.
    fn add(&mut self, (left, right): (f32, f32), (low, high): (f64, f64), color: Color32) {
        let y = |value: f64| self.rect.bottom() - self.rect.height() * (value / self.top).clamp(0.0, 1.0) as f32;
        let rect = Rect::from_min_max(pos2(left, y(high)), pos2(right, y(low)));
        if rect.height() > 0.0 {
            self.mesh.add_colored_rect(rect, color);
        }
    }
}

/// The area of a graph with its scale.
fn area(ui: &mut Ui, height: f32, top: f64) -> (Rect, Response, Painter) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 2.0, EDGE);
    let text = format!("{top} ms");
    painter.text(rect.left_top() + vec2(3.0, 1.0), Align2::LEFT_TOP, text, small_font(), QUIET.color());
    (rect, response, painter)
}

/// The index of the column under the mouse.
fn hovered(response: &Response, rect: Rect, count: usize) -> Option<usize> {
    let at = response.hover_pos()?;
    (0..count).find(|index| {
        let (left, right) = Columns::edges(rect, *index, count);
        (left..right).contains(&at.x)
    })
}

/// Device time of the passes, one above the other.
pub(super) fn passes(ui: &mut Ui, state: &State, names: &[String]) {
    let timing = &state.timing;
    let pictures = timing.pictures();
    let top = top_of(pictures.iter().map(|sample| sample.device_ms));
    let (rect, response, painter) = area(ui, PASSES, top);
    let mut columns = Columns { mesh: Mesh::default(), rect, top };
    for (index, sample) in pictures.iter().enumerate() {
        let edges = Columns::edges(rect, index, pictures.len());
        let mut low = 0.0;
        for (place, name) in names.iter().enumerate() {
            let ms = sample.pass_ms(name).unwrap_or_default();
            columns.add(edges, (low, low + ms), color(place));
            low += ms;
        }
        // Device time outside of all passes.
        columns.add(edges, (low, sample.device_ms), LINE.color());
    }
    painter.add(Shape::mesh(columns.mesh));
    edits(&painter, rect, timing);
    if pictures.is_empty() {
        let text = "no device times yet";
        painter.text(rect.center(), Align2::CENTER_CENTER, text, small_font(), QUIET.color());
    }
    let at = hovered(&response, rect, pictures.len());
    let text = at.and_then(|index| pictures.get(index)).map(|sample| {
        let line = |name: &String| sample.pass_ms(name).map(|ms| format!("{ms:7.2} ms  {name}"));
        let lines: Vec<String> = names.iter().filter_map(line).collect();
        format!(
            "{:7.2} ms  whole frame, {}\n{}",
            sample.device_ms,
            state.version_name(sample.shown.generation),
            lines.join("\n")
        )
    });
    let about =
        "Device time of the last frames that drew the picture, the newest at the right. A line marks new shaders";
    response.on_hover_ui(|ui| match text {
        Some(text) => drop(ui.label(egui::RichText::new(text).monospace().small())),
        None => drop(ui.label(about)),
    });
}

/// Marks the frames in which new shaders appeared.
fn edits(painter: &Painter, rect: Rect, timing: &Timing) {
    let pictures = timing.pictures();
    let pairs = pictures.iter().zip(pictures.iter().skip(1)).enumerate();
    for (index, _) in pairs.filter(|(_, (old, new))| old.shown.generation != new.shown.generation) {
        let (left, _) = Columns::edges(rect, index + 1, pictures.len());
        painter.vline(left, rect.y_range(), Stroke::new(1.0, TEXT));
    }
}

/// The CPU time of the last frames, with a line at the `limit` of the panels.
pub(super) fn cpu(ui: &mut Ui, timing: &Timing, limit: f64) {
    let frames = timing.frames();
    let top = top_of(frames.iter().map(|frame| frame.ui_ms + frame.record_ms)).max(limit);
    let (rect, response, painter) = area(ui, CPU, top);
    let mut columns = Columns { mesh: Mesh::default(), rect, top };
    for (index, frame) in frames.iter().enumerate() {
        let edges = Columns::edges(rect, index, frames.len());
        columns.add(edges, (0.0, frame.ui_ms), UI.color());
        columns.add(edges, (frame.ui_ms, frame.ui_ms + frame.record_ms), RECORD.color());
    }
    painter.add(Shape::mesh(columns.mesh));
    let y = rect.bottom() - rect.height() * (limit / top) as f32;
    painter.hline(rect.x_range(), y, Stroke::new(1.0, WARNING.color().gamma_multiply(0.6)));
    response.on_hover_text(format!("CPU time of the last frames: panels, and recording. The line is at {limit} ms"));
}

/// The history of a pass as a line.
pub(super) fn sparkline(ui: &mut Ui, values: &[f64], color: Color32, size: egui::Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let top = top_of(values.iter().copied());
    let point = |(index, value): (usize, &f64)| -> Pos2 {
        let x = rect.right() - (values.len() - 1 - index) as f32 * rect.width() / (FRAMES - 1) as f32;
        pos2(x, rect.bottom() - rect.height() * (value / top).clamp(0.0, 1.0) as f32)
    };
    if values.len() > 1 {
        ui.painter().add(Shape::line(values.iter().enumerate().map(point).collect(), Stroke::new(1.0, color)));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_slow_frame_does_not_flatten_a_graph() {
        let values = |slow: f64| (0..40).map(|_| 3.0).chain([slow]).collect::<Vec<f64>>();
        assert_eq!(top_of(values(300.0).into_iter()), 5.0);
        assert_eq!(top_of([0.4].into_iter()), 0.5);
        assert_eq!(top_of([18.0].into_iter()), 20.0);
        assert!(top_of(std::iter::empty()) > 0.0);
    }
}
