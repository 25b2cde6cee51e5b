//! A row of the command palette: the title with the matched letters, the key, the group.

use std::ops::Range;

use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{Align2, Color32, FontId, Stroke, TextStyle, Ui, pos2, vec2};

use super::search::Found;
use crate::app::widgets::theme::{ACCENT, EDGE, QUIET, STRONG, TEXT, small_mono_font};

/// Height in points.
pub(super) const HEIGHT: f32 = 22.0;
/// Width of the column with the groups, in points.
const GROUP: f32 = 78.0;
const GAP: f32 = 10.0;
/// Width of the mark of the choice in force, in points.
const CHECK_MARK: f32 = 9.0;

/// Shows a row. `note` is the key or value at the right of the title. Returns whether it was clicked.
pub(super) fn show(ui: &mut Ui, found: &Found<'_>, note: &str, is_chosen: bool) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), egui::Sense::click());
    if is_chosen || response.hovered() {
        let fill = if is_chosen { ui.visuals().selection.bg_fill } else { EDGE.color() };
        ui.painter().rect_filled(rect, 3.0, fill);
    }
    let text = rect.shrink2(vec2(6.0, 0.0));
    let quiet = if is_chosen { STRONG.color() } else { QUIET.color() };
    let small = TextStyle::Small.resolve(ui.style());
    ui.painter().text(text.right_center(), Align2::RIGHT_CENTER, found.entry.group, small.clone(), quiet);
    let at = pos2(text.right() - GROUP - GAP, text.center().y);
    let mono = small_mono_font();
    let note = ui.painter().text(at, Align2::RIGHT_CENTER, note, mono, quiet);
    let mark = if found.entry.is_in_force { CHECK_MARK + GAP } else { 0.0 };
    let room = note.left() - GAP - mark - text.left();
    let font = TextStyle::Body.resolve(ui.style());
    let colors = match is_chosen {
        true => [TEXT.color(), STRONG.color()],
        false => [ui.visuals().text_color(), ACCENT.color()],
    };
    let galley = ui.painter().layout_job(job(&found.entry.title, &found.marks, room, font, colors));
    let is_elided = galley.elided;
    if found.entry.is_in_force {
        check_mark(ui, pos2(text.left() + galley.size().x + GAP, text.center().y), colors[1]);
    }
    let corner = pos2(text.left(), text.center().y - 0.5 * galley.size().y);
    ui.painter().galley(corner, galley, colors[0]);
    let clicked = response.clicked();
    if is_elided {
        response.on_hover_text(&found.entry.title);
    }
    clicked
}

/// Marks the current choice. `left` is the middle of the mark's left edge.
fn check_mark(ui: &Ui, left: egui::Pos2, color: Color32) {
    let at = |x: f32, y: f32| left + CHECK_MARK * vec2(x, y);
    ui.painter().line(vec![at(0.0, 0.0), at(0.35, 0.35), at(1.0, -0.4)], Stroke::new(1.5, color));
}

/// A line that is truncated with an ellipsis at `width`. `colors`: of the text and of the marks.
fn job(title: &str, marks: &[Range<usize>], width: f32, font: FontId, colors: [Color32; 2]) -> LayoutJob {
    let mut job = LayoutJob { wrap: TextWrapping::truncate_at_width(width.max(0.0)), ..LayoutJob::default() };
    for (range, is_marked) in parts(title.len(), marks) {
        job.append(&title[range], 0.0, TextFormat::simple(font.clone(), colors[usize::from(is_marked)]));
    }
    job
}

/// Splits `0..length` into parts that are inside of the marks and parts that are not.
fn parts(length: usize, marks: &[Range<usize>]) -> Vec<(Range<usize>, bool)> {
    let mut cuts: Vec<usize> = marks.iter().flat_map(|mark| [mark.start, mark.end]).chain([0, length]).collect();
    cuts.sort_unstable();
    cuts.dedup();
    let is_marked = |at: usize| marks.iter().any(|mark| mark.contains(&at));
    cuts.windows(2).map(|ends| (ends[0]..ends[1], is_marked(ends[0]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_may_overlap_and_touch_the_ends() {
        assert_eq!(parts(5, &[]), [(0..5, false)]);
        assert_eq!(parts(5, &[0..2, 1..3]), [(0..1, true), (1..2, true), (2..3, true), (3..5, false)]);
        assert_eq!(parts(5, &[3..5, 3..5]), [(0..3, false), (3..5, true)]);
        assert_eq!(parts(0, &[]), []);
    }
}
