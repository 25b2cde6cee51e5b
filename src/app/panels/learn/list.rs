//! The list of all exercises.

use egui::{Color32, Response, RichText, Sense, Ui, pos2, vec2};

use super::mark::paint_mark;
use crate::app::command::program::LEARN;
use crate::app::command::spec::Command;
use crate::app::state::exercise::{LearnCommand, Learning};
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{ACCENT, QUIET, body_font, small_font};
use crate::learn::{Exercise, Level, exercises};

/// Height of a row, in points.
const HEIGHT: f32 = 22.0;
/// Width of the mark before a title, with its gap, in points.
const MARK: f32 = 24.0;

/// Shows the list.
pub(super) fn show(ui: &mut Ui, learning: &Learning, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    ui.label(RichText::new("Learn shading by repairing it").strong());
    let text = "Each exercise is a folder of shaders in which something is wrong or missing. You edit it in your own editor. Specula \
        measures the result after every save and tells you what it found.";
    ui.label(RichText::new(text).color(QUIET));
    ui.add_space(6.0);
    let next = learning.progress.next().map(|exercise| exercise.number);
    for exercise in exercises() {
        let is_solved = learning.progress.of(exercise).solved;
        if row(ui, exercise, is_solved, next == Some(exercise.number)).clicked() {
            commands.push(LEARN.with(LearnCommand::Open(exercise.number)));
        }
    }
    ui.add_space(8.0);
    let folder = learning.parent();
    let text = format!("Exercises are stored in {}", folder.display());
    ui.label(RichText::new(text).small().color(QUIET))
        .on_hover_text("`specula learn --dir FOLDER` chooses another folder");
}

/// Shows an exercise as one button: its mark, number and title, and its difficulty at the right.
fn row(ui: &mut Ui, exercise: &Exercise, is_solved: bool, is_next: bool) -> Response {
    let level = match exercise.level {
        Level::Easy => "easy",
        Level::Medium => "medium",
        Level::Hard => "hard",
    };
    let title = format!("{}  {}", exercise.number, exercise.title);
    // A title that has no room beside the level takes more lines.
    let level_text = ui.painter().layout_no_wrap(level.to_owned(), small_font(), QUIET.color());
    let room = ui.available_width() - MARK - level_text.size().x - 12.0;
    let lines = ui.painter().layout(title.clone(), body_font(), Color32::PLACEHOLDER, room);
    let height = HEIGHT.max(lines.size().y + 4.0);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    let state = if is_solved { ", solved" } else { "" };
    spoken::button(&response, &format!("{title}, {level}{state}"));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact(&response);
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        if response.hovered() || response.has_focus() {
            painter.rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
        }
        let middle = rect.center().y;
        paint_mark(&painter, pos2(rect.min.x + 0.5 * MARK, middle), is_solved.then_some(true));
        let size = level_text.size();
        painter.galley(pos2(rect.max.x - 6.0 - size.x, middle - 0.5 * size.y), level_text, QUIET.color());
        let color = if is_next { ACCENT.color() } else { visuals.text_color() };
        painter.galley(pos2(rect.min.x + MARK, middle - 0.5 * lines.size().y), lines, color);
    }
    let hover = format!("{}\nOpen the exercise: {}\nDifficulty: {level}", exercise.title, exercise.idea);
    response.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text(hover)
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    #[test]
    fn the_whole_row_is_one_button() {
        let exercise = &exercises()[0];
        let show = |ui: &mut Ui, clicks: &mut usize| {
            *clicks += usize::from(row(ui, exercise, false, true).clicked());
        };
        let mut harness = Harness::new_ui_state(show, 0);
        harness.run();
        let button = harness.get_by_role(Role::Button);
        let rect = button.rect();
        assert!(rect.width() > 100.0 && (rect.height() - HEIGHT).abs() < 1.0, "{rect:?}");
        // At the right end, beside the title.
        harness.hover_at(pos2(rect.max.x - 2.0, rect.center().y));
        harness.drag_at(pos2(rect.max.x - 2.0, rect.center().y));
        harness.drop_at(pos2(rect.max.x - 2.0, rect.center().y));
        harness.run();
        assert_eq!(*harness.state(), 1);
    }
}
