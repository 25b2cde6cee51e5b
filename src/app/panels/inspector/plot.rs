//! Axes and lines of the inspector's plots. The values before the last edit are dashed.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use super::super::theme::QUIET;

/// Lines of the grid.
pub(super) const GRID: Color32 = Color32::from_gray(52);
/// Size of the numbers at the axes, points.
const FONT: f32 = 10.0;

/// A line of a plot.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub(super) color: Color32,
    pub(super) is_dashed: bool,
}

impl Pen {
    /// Draws a line through `points`. Points that are not finite interrupt it.
    pub(super) fn line(self, painter: &Painter, points: &[Pos2]) {
        let stroke = Stroke::new(if self.is_dashed { 1.2 } else { 1.6 }, self.color);
        let is_finite = |point: &Pos2| point.x.is_finite() && point.y.is_finite();
        for part in points.split(|point| !is_finite(point)) {
            let part = thinned(part);
            match self.is_dashed {
                true => painter.extend(Shape::dashed_line(&part, stroke, 5.0, 4.0)),
                false => drop(painter.add(Shape::line(part, stroke))),
            }
        }
    }
}

/// The points without those that lie on the one before: most of a narrow lobe is at the origin.
fn thinned(points: &[Pos2]) -> Vec<Pos2> {
    let mut kept: Vec<Pos2> = Vec::new();
    for point in points {
        if kept.last().is_none_or(|last| last.distance(*point) > 0.4) {
            kept.push(*point);
        }
    }
    kept
}

/// A small text of a plot.
pub(super) fn note(painter: &Painter, at: Pos2, anchor: Align2, text: &str) {
    painter.text(at, anchor, text, FontId::proportional(FONT), QUIET.color());
}

/// The name of an arrow, with its color, on a dark ground.
pub(super) fn name(painter: &Painter, at: Pos2, text: &str, color: Color32) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(FONT), color);
    let rect = Align2::CENTER_CENTER.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand2(vec2(2.0, 0.0)), 2.0, Color32::from_black_alpha(140));
    painter.galley(rect.min, galley, color);
}

/// An arrow with a small head.
pub(super) fn arrow(painter: &Painter, from: Pos2, to: Pos2, color: Color32) {
    let stroke = Stroke::new(1.2, color);
    let back = (from - to).normalized() * 6.0;
    let side = 0.5 * back.rot90();
    painter.line_segment([from, to], stroke);
    painter.line_segment([to + back + side, to], stroke);
    painter.line_segment([to + back - side, to], stroke);
}

/// A number in few characters, for the scale of a plot.
pub(super) fn short(number: f32) -> String {
    match number.abs() {
        magnitude if magnitude >= 100.0 => format!("{number:.0}"),
        magnitude if magnitude >= 10.0 => format!("{number:.1}"),
        magnitude if magnitude >= 0.01 || magnitude == 0.0 => format!("{number:.2}"),
        _ => format!("{number:.1e}"),
    }
}

/// A half disk in which a value is a length in the direction of its angle.
pub(super) struct HalfDisk {
    pub(super) center: Pos2,
    pub(super) radius: f32,
    /// The value at the rim.
    pub(super) most: f32,
}

impl HalfDisk {
    /// The largest half disk in `rect`, with room for numbers.
    pub(super) fn within(rect: Rect, most: f32) -> Self {
        let radius = (0.5 * rect.width() - 18.0).min(rect.height() - 30.0).max(10.0);
        Self { center: pos2(rect.center().x, rect.max.y - 14.0), radius, most }
    }

    /// The point of a value at an angle from the normal, degrees; positive is right.
    pub(super) fn at(&self, deg: f32, value: f32) -> Pos2 {
        self.direction(deg, self.radius * value / self.most)
    }

    /// The point at this distance from the center, points.
    pub(super) fn direction(&self, deg: f32, length: f32) -> Pos2 {
        let (sin, cos) = deg.to_radians().sin_cos();
        pos2(self.center.x + length * sin, self.center.y - length * cos)
    }

    /// Draws the rim, half of it, and the angles.
    pub(super) fn axes(&self, painter: &Painter) {
        let stroke = Stroke::new(1.0, GRID);
        for part in [0.5, 1.0] {
            let arc = (-18..=18).map(|step| self.direction(5.0 * step as f32, self.radius * part)).collect();
            painter.add(Shape::line(arc, stroke));
        }
        for deg in [-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0_f32] {
            painter.line_segment([self.center, self.direction(deg, self.radius)], stroke);
            if deg.abs() < 90.0 {
                let text = format!("{:.0}°", deg.abs());
                note(painter, self.direction(deg, self.radius + 9.0), Align2::CENTER_CENTER, &text);
            }
        }
        let below = |part: f32| pos2(self.center.x + part * self.radius, self.center.y + 2.0);
        note(painter, below(0.5), Align2::CENTER_TOP, &short(0.5 * self.most));
        note(painter, below(1.0), Align2::CENTER_TOP, &format!("{} 1/sr", short(self.most)));
    }
}

/// A chart of values over an angle of 0 to 90 degrees.
pub(super) struct Chart {
    rect: Rect,
    most: f32,
}

impl Chart {
    /// A chart in `rect`, with room for numbers. `most` is the value at the top.
    pub(super) fn within(rect: Rect, most: f32) -> Self {
        let rect = Rect::from_min_max(rect.min + vec2(26.0, 6.0), rect.max - vec2(8.0, 16.0));
        Self { rect, most }
    }

    pub(super) fn at(&self, deg: f32, value: f32) -> Pos2 {
        let (x, y) = (deg / 90.0, value / self.most);
        pos2(self.rect.min.x + x * self.rect.width(), self.rect.max.y - y * self.rect.height())
    }

    /// Draws the grid; values are in steps of a quarter, and 1 is brighter.
    pub(super) fn axes(&self, painter: &Painter) {
        for deg in [0.0, 30.0, 60.0, 90.0_f32] {
            let low = self.at(deg, 0.0);
            painter.line_segment([low, self.at(deg, self.most)], Stroke::new(1.0, GRID));
            note(painter, pos2(low.x, low.y + 2.0), Align2::CENTER_TOP, &format!("{deg:.0}°"));
        }
        let step = if self.most > 2.0 { 0.5 * self.most } else { 0.25 };
        let mut value = 0.0;
        while value <= self.most {
            let color = if value == 1.0 { Color32::from_gray(110) } else { GRID };
            painter.line_segment([self.at(0.0, value), self.at(90.0, value)], Stroke::new(1.0, color));
            let left = self.at(0.0, value);
            if ((4.0 * value) as u32).is_multiple_of(2) || self.most > 2.0 {
                note(painter, pos2(left.x - 4.0, left.y), Align2::RIGHT_CENTER, &short(value));
            }
            value += step;
        }
    }

    /// Where the chart draws.
    pub(super) fn rect(&self) -> Rect {
        self.rect
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_disk_has_the_normal_up_and_the_mirror_direction_right() {
        let disk = HalfDisk { center: pos2(100.0, 100.0), radius: 50.0, most: 2.0 };
        let close = |a: Pos2, b: Pos2| a.distance(b) < 1e-3;
        assert!(close(disk.at(0.0, 2.0), pos2(100.0, 50.0)) && close(disk.at(90.0, 1.0), pos2(125.0, 100.0)));
        assert!(close(disk.at(-90.0, 2.0), pos2(50.0, 100.0)));
    }

    #[test]
    fn points_on_top_of_each_other_are_one() {
        let points = [pos2(0.0, 0.0), pos2(0.1, 0.0), pos2(5.0, 0.0), pos2(5.0, 0.2), pos2(0.0, 0.0)];
        assert_eq!(thinned(&points), [pos2(0.0, 0.0), pos2(5.0, 0.0), pos2(0.0, 0.0)]);
    }

    #[test]
    fn scales_are_short() {
        assert_eq!([0.0, 0.324, 12.34, 250.4].map(short), ["0.00", "0.32", "12.3", "250"].map(str::to_owned));
    }
}
