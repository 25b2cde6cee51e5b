//! A value at the pixels around the pinned one, as a small picture in its hover text.

use egui::{Color32, Rect, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use super::model::CodeLine;
use crate::app::state::State;
use crate::app::state::trace::rows::Note;
use crate::app::widgets::theme::{ACCENT, ERROR, PANEL, QUIET};
use crate::shader::trace::{Neighborhood, TracedValue};

/// Width and height of a pixel, points.
const CELL: f32 = 13.0;

/// Shows the picture, or how far it is.
pub(super) fn show(ui: &mut Ui, state: &State, line: &CodeLine, note: &Note) {
    let Some(newest) = state.traces.newest().filter(|newest| newest.trace.is_ok()) else { return };
    let Some(traced) = line.row.traced else { return };
    match state.traces.around.of(newest) {
        None => {
            // Nothing that moves: frames of a software device would hold the trace up.
            ui.label(RichText::new("Tracing the pixels around it…").small().color(QUIET));
        }
        Some(Err(message)) => drop(ui.label(RichText::new(message).small().color(QUIET))),
        Some(Ok(around)) => {
            let values = around.values(traced, note.done.act, &note.done.name, state.traces.choice.which());
            if values.iter().any(Option::is_some) {
                picture(ui, around, newest.of.at, &values);
            }
        }
    }
}

fn picture(ui: &mut Ui, around: &Neighborhood, at: [u32; 2], values: &[Option<TracedValue>]) {
    let (columns, rows) = around.size;
    let (area, _) = ui.allocate_exact_size(vec2(CELL * columns as f32, CELL * rows as f32), Sense::hover());
    let range = range(values);
    let cell = |x: u32, y: u32| {
        Rect::from_min_size(pos2(area.left() + CELL * x as f32, area.top() + CELL * y as f32), vec2(CELL, CELL))
    };
    let painter = ui.painter();
    painter.rect_filled(area, 0.0, PANEL.color());
    for (index, value) in (0..).zip(values) {
        let color = value.map_or_else(|| QUIET.color().gamma_multiply(0.12), |value| color(value, range));
        painter.rect_filled(cell(index % columns, index / columns), 0.0, color);
    }
    let own = cell(at[0].saturating_sub(around.first.0), at[1].saturating_sub(around.first.1));
    painter.rect_stroke(own, 0.0, Stroke::new(1.5, ACCENT.color()), StrokeKind::Inside);
    let missing = values.iter().filter(|value| value.is_none()).count();
    let rest = if missing > 0 { format!("; not computed at {missing}") } else { String::new() };
    let text = |number: f64| TracedValue::float(number as f32).text();
    let told = format!("{columns}x{rows} pixels around it, black {} to white {}{rest}", text(range.0), text(range.1));
    ui.label(RichText::new(told).small().color(QUIET));
}

/// The numbers that are black and white: the least and the greatest; of vectors, whose numbers are red, green and blue, 0 is in the range.
fn range(values: &[Option<TracedValue>]) -> (f64, f64) {
    let values = || values.iter().flatten();
    let finite = values().flat_map(TracedValue::numbers).filter(|number| number.is_finite());
    let (mut low, mut high) = finite.fold((f64::MAX, f64::MIN), |(low, high), n| (low.min(n), high.max(n)));
    if low > high {
        return (0.0, 1.0);
    }
    if values().any(|value| value.numbers().count() > 1) {
        (low, high) = (low.min(0.0), high.max(0.0));
    }
    (low, high)
}

/// The color of a value. One without a range is gray.
fn color(value: TracedValue, (low, high): (f64, f64)) -> Color32 {
    if !value.is_finite() {
        return ERROR.color();
    }
    let share = |number: f64| {
        let share = if high > low { (number - low) / (high - low) } else { 0.5 };
        (share * 255.0).round() as u8
    };
    let numbers: Vec<u8> = value.numbers().map(share).collect();
    match numbers.as_slice() {
        [gray] => Color32::from_gray(*gray),
        [red, green] => Color32::from_rgb(*red, *green, 0),
        [red, green, blue, ..] => Color32::from_rgb(*red, *green, *blue),
        [] => Color32::TRANSPARENT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_number_is_black_and_the_greatest_white() {
        let values: Vec<Option<TracedValue>> =
            [2.0, 4.0, f32::NAN].map(TracedValue::float).map(Some).into_iter().chain([None]).collect();
        let range = range(&values);
        assert_eq!(range, (2.0, 4.0));
        assert_eq!(color(TracedValue::float(4.0), range), Color32::WHITE);
        assert_eq!(color(TracedValue::float(2.0), range), Color32::BLACK);
        assert_eq!(color(TracedValue::float(f32::INFINITY), range), ERROR.color());
        assert_eq!(color(TracedValue::float(3.0), (3.0, 3.0)), Color32::from_gray(128));
        assert_eq!(super::range(&[None]), (0.0, 1.0));
    }
}
