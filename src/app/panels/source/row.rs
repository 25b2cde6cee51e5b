//! A row of the code: its number, its code in colors, and its values at the right.

use std::ops::Range;

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, CursorIcon, Rect, Sense, Shape, Ui, WidgetInfo, WidgetType, pos2, vec2};

use super::colors::{ROW, colored};
use super::definition;
use super::find::Find;
use super::functions::Fold;
use super::look::Look;
use super::model::{CodeLine, CodeModel, Shown};
use super::number::NumberDrag;
use super::tail::Tail;
use super::values::{GAP, Values, are_old};
use crate::app::command::source::SHOW_FILE;
use crate::app::commands::Commands;
use crate::app::state::State;
use crate::app::state::trace::rows::{Note, Reach};
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{
    ACCENT, CODE_VALUE, ERROR, PANEL, QUIET, TEXT, WARNING, small_font, small_mono, small_mono_font,
};
use crate::shader::{Severity, TreePath};

/// Share of the row in sight that values and what stands before them take at most where the code would need it, too.
const MOST_VALUES: f32 = 0.55;
/// Opacity of lines that the pixel does not reach.
const MISSED: f32 = 0.42;

/// A click on a row.
pub(super) enum Clicked {
    /// Begins to type at a line, by its index.
    Edit(usize),
    /// Folds a function, or opens it.
    Fold(String),
}

/// Shows a row. Returns a click on it.
pub(super) fn show_row(
    ui: &mut Ui,
    of: (&State, &TreePath),
    model: &CodeModel,
    shown: &Shown,
    (look, find, drag): (&Look, &Find, &mut NumberDrag),
    commands: &mut Commands,
) -> Option<Clicked> {
    let width = ui.available_width();
    let (rect, _) = ui.allocate_exact_size(vec2(width, ROW), Sense::hover());
    match shown {
        Shown::Line(index) => {
            let line = model.lines.get(*index)?;
            let begins = show_line(ui, of, line, rect, (look, find, drag), commands);
            let folds = line.fold.as_ref().filter(|fold| fold_button(ui, line, fold, in_sight(ui, rect)));
            folds.map(|fold| Clicked::Fold(fold.name.clone())).or(begins.then_some(Clicked::Edit(*index)))
        }
        Shown::Message(severity, text) => {
            message(ui, rect, *severity, text, look);
            None
        }
    }
}

/// The part of a row that is in sight.
fn in_sight(ui: &Ui, rect: Rect) -> Rect {
    Rect::from_x_y_ranges(ui.clip_rect().x_range(), rect.y_range())
}

/// The id of the message in a row.
fn message_id(ui: &Ui, row: Rect) -> egui::Id {
    ui.id().with(("message", row.top() as i32))
}

fn message(ui: &mut Ui, rect: Rect, severity: Severity, text: &str, look: &Look) {
    let color = if severity == Severity::Error { ERROR } else { WARNING }.color();
    let sight = in_sight(ui, rect);
    ui.painter().rect_filled(sight, 0.0, color.gamma_multiply(0.12));
    let at = pos2(sight.left() + look.gutter, rect.center().y);
    ui.painter().text(at, Align2::LEFT_CENTER, text, small_font(), color);
    let response = ui.interact(sight, message_id(ui, rect), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, text));
    response.on_hover_text(text);
}

/// Shows a line. Returns whether it was clicked twice.
fn show_line(
    ui: &mut Ui,
    (state, path): (&State, &TreePath),
    line: &CodeLine,
    rect: Rect,
    (look, find, drag): (&Look, &Find, &mut NumberDrag),
    commands: &mut Commands,
) -> bool {
    let (row, sight) = (&line.row, in_sight(ui, rect));
    let background = background(line);
    if let Some(color) = background {
        ui.painter().rect_filled(sight, 0.0, color);
    }
    let response = ui.interact(sight, ui.id().with(("line", row.line)), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, format!("{}: {}", row.line, line.text)));
    let opacity = if row.reach == Reach::Missed { MISSED } else { 1.0 };
    let left = rect.left() + look.gutter;
    let galley = ui.painter().layout_job(colored(&line.text, &line.parts, opacity, None));
    let code_end = left + galley.size().x;
    let tail = Tail::new(ui, state, (path, line));
    let least = MOST_VALUES * sight.width() - tail.width;
    let values = Values::new(ui, (line, are_old(state)), (sight, code_end + tail.width), least);
    // Code and values never overlap: the end of the code is left out.
    let end = code_end.min(values.start - GAP - tail.width);
    let whole = ui.clip_rect();
    if end < code_end {
        ui.set_clip_rect(whole.intersect(rect.with_max_x(end - look.letter)));
    }
    ui.painter().add(found(line, find, (left, rect), look));
    ui.painter().galley(pos2(left, rect.center().y - galley.size().y / 2.0), galley, TEXT.color());
    drag.show(ui, (state, path), line, (left, rect, look), commands);
    if let Some(include) = &line.include {
        include_link(ui, row.line, include, Rect::from_x_y_ranges(left..=end, rect.y_range()), commands);
    }
    definition::links(ui, (state, path), line, (left, rect, look), commands);
    ui.set_clip_rect(whole);
    if end < code_end {
        ui.painter().text(pos2(end, rect.center().y), Align2::RIGHT_CENTER, "…", small_mono_font(), QUIET.color());
    }
    tail.show(ui, row.line, pos2(end, rect.center().y));
    gutter(ui, line, sight, background, look);
    values.show(ui, (state, path), (line, sight), commands);
    let is_clicked = response.double_clicked();
    if end < code_end {
        response.on_hover_text(small_mono(line.text.trim()));
    }
    is_clicked
}

/// The triangle that folds a function. Returns whether it was clicked.
fn fold_button(ui: &mut Ui, line: &CodeLine, fold: &Fold, sight: Rect) -> bool {
    let center = pos2(sight.left() + 16.0, sight.center().y);
    let area = Rect::from_center_size(center, vec2(14.0, ROW));
    let response = ui.interact(area, ui.id().with(("fold", line.row.line)), Sense::click());
    let name = fold.name.split(' ').next().unwrap_or_default();
    let is_open = fold.hidden == 0;
    spoken::button(&response, &format!("{} {name}", if is_open { "Fold" } else { "Open" }));
    let color = if response.hovered() { ACCENT.color() } else { QUIET.color().gamma_multiply(0.8) };
    let corner = |x: f32, y: f32| center + if is_open { vec2(x, y) } else { vec2(y, x) };
    let points = vec![corner(-3.5, -2.0), corner(3.5, -2.0), corner(0.0, 2.5)];
    ui.painter().add(Shape::convex_polygon(points, color, egui::Stroke::NONE));
    response.on_hover_cursor(CursorIcon::PointingHand).clicked()
}

/// Marks behind the places of a line that the search has found. `left`: where its code begins.
fn found(line: &CodeLine, find: &Find, (left, rect): (f32, Rect), look: &Look) -> Shape {
    let x = |byte: usize| left + look.letter * line.text[..byte].chars().count() as f32;
    let place = |place: Range<usize>| {
        let rect = Rect::from_x_y_ranges(x(place.start)..=x(place.end), rect.y_range());
        Shape::rect_filled(rect, 2.0, ACCENT.color().gamma_multiply(0.3))
    };
    Shape::Vec(find.places(&line.text).into_iter().map(place).collect())
}

/// Shows what stands beside a line that is typed: its number and its values. `left`: where its code begins. Returns what is behind it.
pub(super) fn beside(
    ui: &mut Ui,
    of: (&State, &TreePath),
    line: &CodeLine,
    (sight, left): (Rect, f32),
    (look, find): (&Look, &Find),
    commands: &mut Commands,
) -> Shape {
    let background = background(line);
    let end = left + look.letter * line.text.chars().count() as f32;
    gutter(ui, line, sight, background, look);
    if line.message.is_none() {
        // A line that is being typed is never cut.
        Values::new(ui, (line, are_old(of.0)), (sight, end), 0.0).show(ui, of, (line, sight), commands);
    }
    let behind = background.map_or(Shape::Noop, |color| Shape::rect_filled(sight, 0.0, color));
    Shape::Vec(vec![behind, found(line, find, (left, sight), look)])
}

/// Shows the message about a line that is typed: behind its code, or below it if there is no room. It never covers code, so where the line
/// below is long, too, only the mark of the line says that there is a message.
pub(super) fn message_beside(
    ui: &mut Ui,
    (line, below): (&CodeLine, Option<&CodeLine>),
    (sight, left): (Rect, f32),
    look: &Look,
) {
    let Some((severity, text)) = &line.message else { return };
    let color = if *severity == Severity::Error { ERROR } else { WARNING }.color();
    let end = |line: &CodeLine| left + look.letter * line.text.chars().count() as f32;
    let mut job = LayoutJob::simple_singleline(text.clone(), small_font(), color);
    job.wrap =
        TextWrapping::truncate_at_width((sight.right() - end(line) - 2.0 * GAP).max(MOST_VALUES * sight.width()));
    let galley = ui.painter().layout_job(job);
    let start = sight.right() - 8.0 - galley.size().x;
    let is_free = |line: &CodeLine| end(line) + GAP <= start;
    let row = match is_free(line) {
        true => sight,
        false if below.is_none_or(|below| below.message.is_none() && is_free(below)) => sight.translate(vec2(0.0, ROW)),
        false => return,
    };
    // Values of the line below.
    cover(ui, row.with_min_x(start - GAP), (row == sight).then(|| background(line)).flatten());
    let at = pos2(start, row.center().y - galley.size().y / 2.0);
    let response = ui.interact(galley.rect.translate(at.to_vec2()), message_id(ui, sight), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, text));
    response.on_hover_text(text);
    ui.painter().galley(at, galley, color);
}

/// The color behind a line.
fn background(line: &CodeLine) -> Option<Color32> {
    match line.message.as_ref().map(|(severity, _)| *severity) {
        Some(Severity::Error) => Some(ERROR.color().gamma_multiply(0.12)),
        Some(Severity::Warning) => Some(WARNING.color().gamma_multiply(0.1)),
        None if line.row.is_first_change => Some(ACCENT.color().gamma_multiply(0.13)),
        None => None,
    }
}

/// The number of a line and its mark, over code that is scrolled below them.
fn gutter(ui: &Ui, line: &CodeLine, sight: Rect, background: Option<Color32>, look: &Look) {
    let painter = ui.painter();
    let area = sight.with_max_x(sight.left() + look.gutter - 6.0);
    painter.rect_filled(area, 0.0, PANEL.color());
    background.into_iter().for_each(|color| _ = painter.rect_filled(area, 0.0, color));
    let is_changed = line.row.notes.iter().any(Note::is_changed);
    let is_bad = line.row.notes.iter().any(|note| note.is_bad);
    let mark = pos2(sight.left() + 6.0, sight.center().y);
    let is_wrong = matches!(line.message, Some((Severity::Error, _)));
    let color = if is_bad || is_wrong { ERROR } else { ACCENT }.color();
    if line.row.is_first_change {
        let points = vec![mark + vec2(-3.0, -4.0), mark + vec2(4.0, 0.0), mark + vec2(-3.0, 4.0)];
        painter.add(egui::Shape::convex_polygon(points, color, egui::Stroke::NONE));
    } else if is_changed || is_bad || line.message.is_some() {
        painter.circle_filled(mark, 2.5, color);
    }
    let number = pos2(sight.left() + look.gutter - 14.0, sight.center().y);
    let opacity = if line.row.reach == Reach::Reached { 1.0 } else { 0.55 };
    let color = QUIET.color().gamma_multiply(opacity);
    painter.text(number, Align2::RIGHT_CENTER, line.row.line.to_string(), small_mono_font(), color);
    // Reached lines have a bar beside their numbers.
    if line.row.reach == Reach::Reached {
        let x = sight.left() + look.gutter - 9.0;
        let bar = Rect::from_x_y_ranges(x..=x + 2.0, sight.top()..=sight.bottom());
        painter.rect_filled(bar, 0.0, CODE_VALUE.color().gamma_multiply(0.55));
    }
}

fn include_link(ui: &mut Ui, line: u32, include: &TreePath, rect: Rect, commands: &mut Commands) {
    let response = ui.interact(rect, ui.id().with(("include", line)), Sense::click());
    spoken::button(&response, &format!("Open {include}"));
    if response.hovered() {
        ui.painter().hline(rect.x_range(), rect.bottom() - 2.0, egui::Stroke::new(1.0, ACCENT));
    }
    if response.clicked() {
        commands.push(SHOW_FILE.with(include.clone()));
    }
    response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(format!("Click to show {include} here"));
}

/// Covers the code below a message, with a soft edge.
fn cover(ui: &Ui, area: Rect, background: Option<Color32>) {
    let painter = ui.painter();
    for (at, opacity) in [(0.0, 0.35), (4.0, 0.6), (8.0, 1.0)] {
        let part = if opacity < 1.0 {
            Rect::from_x_y_ranges(area.left() + at..=area.left() + at + 4.0, area.y_range())
        } else {
            area.with_min_x(area.left() + at)
        };
        painter.rect_filled(part, 0.0, PANEL.color().gamma_multiply(opacity));
        background.into_iter().for_each(|color| _ = painter.rect_filled(part, 0.0, color.gamma_multiply(opacity)));
    }
}
