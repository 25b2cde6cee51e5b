//! A small bar that shows how large a value is: from 0 to 1 up to its tick, then logarithmic up to 10,000.

use egui::{Painter, Rect, pos2, vec2};

use super::colors::ROW;
use crate::app::state::trace::rows::Note;
use crate::app::widgets::theme::{CODE_KEYWORD, CODE_VALUE, ERROR, QUIET};
use crate::shader::trace::{Act, TracedValue};

/// Width of a bar, points.
pub(super) const WIDTH: f32 = 20.0;
/// Share of the width for 0 to 1.
const ONE: f32 = 0.6;
/// Decades behind the tick.
const DECADES: f64 = 4.0;

/// The explanation, for the hover text of a value.
pub(super) const LEGEND: &str = "Bar: size of the largest value, 0 to 1 up to the tick, then logarithmic up to 10,000; negative numbers in another color";

/// The value that the bar of a note shows: the largest one, if it has a size.
pub(super) fn value(note: &Note) -> Option<TracedValue> {
    let has_size = matches!(note.done.act, Act::Store | Act::Argument | Act::Return);
    let size = |value: &TracedValue| {
        value.numbers().fold(0.0_f64, |most, n| if n.is_nan() { f64::INFINITY } else { most.max(n.abs()) })
    };
    let values = note.done.values().filter(|value| has_size && !value.is_truth());
    values.max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// The share of the width for a number, whatever its sign.
fn length(number: f64) -> f32 {
    let size = number.abs();
    if size.is_nan() {
        1.0
    } else if size <= 1.0 {
        ONE * size as f32
    } else {
        ONE + (1.0 - ONE) * (size.log10() / DECADES).min(1.0) as f32
    }
}

/// Draws a bar with its left end at `x`, in the row around `y`: one below the other for the numbers of a vector.
pub(super) fn draw(painter: &Painter, (x, y): (f32, f32), value: TracedValue) {
    let numbers: Vec<f64> = value.numbers().collect();
    let height = (ROW - 7.0) / numbers.len().max(1) as f32;
    let top = y - (ROW - 7.0) / 2.0;
    for (index, number) in numbers.iter().enumerate() {
        let area = Rect::from_min_size(pos2(x, top + height * index as f32), vec2(WIDTH, (height - 0.7).max(1.2)));
        painter.rect_filled(area, 0.0, QUIET.color().gamma_multiply(0.14));
        let color = match (number.is_finite(), *number < 0.0) {
            (false, _) => ERROR,
            (true, true) => CODE_KEYWORD,
            (true, false) => CODE_VALUE,
        };
        let filled = Rect::from_min_size(area.min, vec2(WIDTH * length(*number), area.height()));
        painter.rect_filled(filled, 0.0, color.color().gamma_multiply(0.75));
    }
    let tick = x + ONE * WIDTH;
    let sides = top - 0.5..=top + ROW - 6.5;
    painter.vline(tick, sides, egui::Stroke::new(1.0, QUIET.color().gamma_multiply(0.5)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_grow_with_numbers_and_never_leave_their_place() {
        let lengths = [0.0, 0.25, 1.0, 1.5, 100.0, 1e4, 1e9, f64::INFINITY].map(length);
        assert!(lengths.is_sorted() && lengths[0] == 0.0 && lengths[7] == 1.0, "{lengths:?}");
        assert_eq!((length(-0.5), length(f64::NAN)), (length(0.5), 1.0));
    }
}
