//! An exercise: its text, its goals with what was measured, hints and the solution.

use egui::{Align, Frame, Id, Label, Margin, Rect, RichText, ScrollArea, Ui, UiBuilder, pos2, vec2};

use super::mark::mark;
use crate::app::command::program::LEARN;
use crate::app::command::spec::Command;
use crate::app::state::exercise::{LearnCommand, Learning, Measured};
use crate::app::state::shaders::difference::Kind;
use crate::app::widgets::theme::{ACCENT, EDGE, ERROR, GOOD, QUIET, STRONG, TEXT, WARNING, small_mono};
use crate::learn::{Exercise, Finding, exercises};

/// The shaders that the results were measured on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Results {
    /// The shaders of now.
    New,
    /// The shaders before the last edit, which is being measured.
    Old,
    /// The shaders before an edit that does not compile.
    Broken,
}

/// Height of a panel below which the text scrolls with the goals, points.
const LOW: f32 = 110.0;
/// Largest part of the panel's height that the goals take.
const PART: f32 = 0.55;

/// Shows the exercise: its text above, its goals below, and its buttons at the bottom, where they stay in sight.
pub(super) fn show(
    ui: &mut Ui,
    learning: &Learning,
    exercise: &Exercise,
    results: Results,
    commands: &mut Vec<Command>,
) {
    // Goals and buttons take the height that they had in the last frame.
    let buttons_id = Id::new("height of the buttons of an exercise");
    let spacing = ui.spacing().item_spacing.y;
    let foot = height_of(ui, buttons_id).unwrap_or(2.0 * ui.spacing().interact_size.y);
    let rest = Rect::from_min_max(ui.cursor().min, ui.max_rect().max - vec2(0.0, foot + spacing));
    lesson(&mut ui.new_child(UiBuilder::new().max_rect(rest)), learning, exercise, results, commands);
    let below = Rect::from_min_max(pos2(rest.left(), rest.bottom() + spacing), ui.max_rect().max);
    let ui = &mut ui.new_child(UiBuilder::new().max_rect(below));
    buttons(ui, learning, exercise, commands);
    set_height(ui, buttons_id, ui.min_rect().height());
}

/// The text and the goals.
fn lesson(ui: &mut Ui, learning: &Learning, exercise: &Exercise, results: Results, commands: &mut Vec<Command>) {
    // Each exercise scrolls by itself.
    let scroll = |id: &str| ScrollArea::vertical().id_salt((id, &exercise.name)).auto_shrink(false);
    if ui.available_height() < LOW {
        scroll("text").show(ui, |ui| {
            goals(ui, learning, exercise, results, commands);
            ui.separator();
            about(ui, learning, exercise, commands);
        });
        return;
    }
    let id = Id::new(("height of the goals", &exercise.name));
    let whole = ui.available_height();
    let known = height_of(ui, id).unwrap_or(0.4 * whole);
    let below = known.min(PART * whole);
    let above = whole - below - 3.0 * ui.spacing().item_spacing.y;
    scroll("text").max_height(above).show(ui, |ui| about(ui, learning, exercise, commands));
    ui.separator();
    let shown = scroll("goals").show(ui, |ui| goals(ui, learning, exercise, results, commands));
    set_height(ui, id, shown.content_size.y);
}

/// The height that a part of the panel had in the last frame.
fn height_of(ui: &Ui, id: Id) -> Option<f32> {
    ui.data(|data| data.get_temp(id))
}

/// Keeps the height of a part for the next frame, which follows at once if it has changed.
fn set_height(ui: &Ui, id: Id, height: f32) {
    if height_of(ui, id) != Some(height) {
        ui.data_mut(|data| data.insert_temp(id, height));
        ui.ctx().request_repaint();
    }
}

/// The text of the exercise, the hints that were asked for, and the solution.
fn about(ui: &mut Ui, learning: &Learning, exercise: &Exercise, commands: &mut Vec<Command>) {
    let mut ask = |command| commands.push(LEARN.with(command));
    ui.add_space(4.0);
    ui.label(RichText::new(&exercise.title).strong());
    ui.label(RichText::new(&exercise.idea).color(ACCENT));
    ui.add_space(4.0);
    text(ui, &exercise.text);
    ui.label(RichText::new(format!("Source: {}", exercise.source)).small().color(QUIET));
    ui.add_space(6.0);
    for (index, hint) in exercise.hints.iter().take(learning.progress.of(exercise).hints).enumerate() {
        ui.add_space(2.0);
        ui.label(RichText::new(format!("Hint {}: {hint}", index + 1)).color(WARNING));
    }
    if solution(ui, learning) {
        ask(LearnCommand::Solve);
    }
    ui.add_space(8.0);
    // A button has just opened the end of the text.
    if ui.data_mut(|data| data.remove_temp::<()>(asked_id())).is_some() {
        ui.scroll_to_cursor(Some(Align::BOTTOM));
    }
}

/// Where egui notes that a hint or the solution was asked for, until it is shown.
fn asked_id() -> Id {
    Id::new("a hint or the solution was asked for")
}

/// The buttons for the file, hints, the solution and the start.
fn buttons(ui: &mut Ui, learning: &Learning, exercise: &Exercise, commands: &mut Vec<Command>) {
    let mut ask = |command| commands.push(LEARN.with(command));
    let record = learning.progress.of(exercise);
    ui.horizontal_wrapped(|ui| {
        let place = learning.folder.join(&exercise.open.file);
        let hover = format!("{}\nOpens the file at the line to look at", place.display());
        if ui.button(format!("Open {}", exercise.open.file)).on_hover_text(hover).clicked() {
            ask(LearnCommand::Edit);
        }
        let most = exercise.hints.len();
        let is_left = record.hints < most;
        let text = if is_left { format!("Hint ({} of {most})", record.hints + 1) } else { "No more hints".to_owned() };
        let hover = "The first hint is a nudge; the last one is almost the solution";
        if ui.add_enabled(is_left, egui::Button::new(text)).on_hover_text(hover).clicked() {
            ui.data_mut(|data| data.insert_temp(asked_id(), ()));
            ask(LearnCommand::Hint);
        }
        let text = if learning.solution.is_some() { "Hide the solution" } else { "Show the solution" };
        let hover = "Shows the lines that the solution changes. Your files stay as they are";
        if ui.button(text).on_hover_text(hover).clicked() {
            ui.data_mut(|data| data.insert_temp(asked_id(), ()));
            ask(LearnCommand::Solution);
        }
        let (text, hover) = match learning.asks {
            true => ("Discard my edits", "Overwrites your files with the original ones"),
            false => ("Start over", "Restores the original files. Asks before it overwrites yours"),
        };
        if ui.button(text).on_hover_text(hover).clicked() {
            ask(LearnCommand::StartOver);
        }
    });
}

/// Paragraphs; lines that begin with four spaces are formulas or code.
fn text(ui: &mut Ui, text: &str) {
    for block in blocks(text) {
        match block {
            Block::Paragraph(words) => _ = ui.add(Label::new(words).wrap()),
            Block::Formula(lines) => {
                Frame::new().fill(EDGE.color()).corner_radius(4).inner_margin(Margin::symmetric(10, 6)).show(
                    ui,
                    |ui| {
                        ui.set_width(ui.available_width());
                        ui.add(Label::new(RichText::new(lines).monospace().color(STRONG)).wrap());
                    },
                );
            }
        }
        ui.add_space(3.0);
    }
}

/// A part of a text.
#[derive(Debug, PartialEq, Eq)]
enum Block {
    Paragraph(String),
    Formula(String),
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    for part in text.trim_matches('\n').split("\n\n").filter(|part| !part.trim().is_empty()) {
        let formula: Option<Vec<&str>> = part.lines().map(|line| line.strip_prefix("    ")).collect();
        blocks.push(match formula {
            Some(lines) => Block::Formula(lines.join("\n")),
            None => Block::Paragraph(part.lines().map(str::trim).collect::<Vec<_>>().join(" ")),
        });
    }
    blocks
}

/// The verdict with the way to the next exercise, and the goals: gray before they are measured and while an edit is being measured, else green
/// or red, each with what was found.
fn goals(ui: &mut Ui, learning: &Learning, exercise: &Exercise, results: Results, commands: &mut Vec<Command>) {
    let findings: &[Finding] = match &learning.measured {
        Measured::Findings(findings) if results != Results::Broken => findings,
        _ => &[],
    };
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(if exercise.goals.len() == 1 { "Goal" } else { "Goals" }).strong());
        let state = match (&learning.measured, results) {
            (_, Results::Broken) => "your edit does not compile yet",
            (Measured::Nothing, Results::Old) => "measured when the picture is complete",
            (_, Results::Old) => "measuring; these results are of the edit before",
            (Measured::Failed(_), _) => "not measured",
            _ => "measured",
        };
        ui.label(RichText::new(state).small().color(QUIET)).on_hover_text(
            "Specula measures your shaders in the background after every save. The picture does not wait for it",
        );
        if learning.is_solved() && results == Results::New {
            ui.label(RichText::new("Solved. Well done!").strong().color(GOOD));
            let has_next = (1..exercises().len()).contains(&exercise.number);
            if has_next && ui.button("Next").on_hover_text("Open the next exercise").clicked() {
                commands.push(LEARN.with(LearnCommand::Open(exercise.number + 1)));
            }
        }
    });
    for (index, goal) in exercise.goals.iter().enumerate() {
        let finding = findings.get(index);
        let state = finding.filter(|_| results == Results::New).map(|finding| finding.passed);
        let color = state.map_or(QUIET, |passed| if passed { GOOD } else { ERROR });
        ui.horizontal_top(|ui| {
            mark(ui, state);
            ui.vertical(|ui| {
                ui.add(Label::new(&goal.says).wrap());
                if let Some(finding) = finding {
                    ui.add(Label::new(RichText::new(&finding.found).small().color(color)).wrap());
                }
            });
        });
    }
    if let Measured::Failed(message) = &learning.measured {
        ui.add(Label::new(RichText::new(message).small().color(ERROR)).wrap());
    }
}

/// The difference between the files and the solution. Returns whether the user wants it written.
fn solution(ui: &mut Ui, learning: &Learning) -> bool {
    let Some(lines) = &learning.solution else { return false };
    ui.add_space(4.0);
    if lines.is_empty() {
        ui.label(RichText::new("Your files match the solution.").color(GOOD));
        return false;
    }
    Frame::new().fill(EDGE.color()).corner_radius(4).inner_margin(Margin::symmetric(8, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        egui::ScrollArea::horizontal().id_salt("solution").show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            for line in lines {
                let color = match line.kind {
                    Kind::Place => ACCENT.color(),
                    Kind::Removed => ERROR.color(),
                    Kind::Added => GOOD.color(),
                    Kind::Same => TEXT.color(),
                };
                let text = small_mono(&line.text).color(color);
                ui.add(Label::new(text).extend());
            }
        });
    });
    ui.button("Write it to my files").on_hover_text("Replaces these files. The timeline keeps your version").clicked()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    /// The panel at 720p.
    const SIZE: egui::Vec2 = egui::vec2(400.0, 480.0);

    /// The panel at 720p with letters of 1.5 times the size.
    const LARGER: egui::Vec2 = egui::vec2(370.0, 240.0);

    #[test]
    fn the_buttons_are_whole_in_a_low_and_narrow_panel() {
        for size in [SIZE, egui::vec2(400.0, 230.0), egui::vec2(230.0, 300.0)] {
            for exercise in exercises() {
                let mut learning = Learning::default();
                learning.open(Path::new("folder"), Some(exercise.clone()));
                let mut harness = Harness::builder()
                    .with_size(size)
                    .build_ui(|ui| show(ui, &learning, exercise, Results::New, &mut Vec::new()));
                harness.run();
                for text in ["Show the solution", "Start over"] {
                    let rect = harness.get_by_label(text).rect();
                    let room = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
                    assert!(room.contains_rect(rect), "`{text}` of {} is at {rect:?} in {size:?}", exercise.name);
                }
            }
        }
    }

    #[test]
    fn goals_stay_in_sight_and_results_of_an_older_edit_say_so() {
        let exercise = exercises()[2].clone();
        let mut learning = Learning::default();
        learning.open(Path::new("03-fresnel"), Some(exercise.clone()));
        let found =
            |goal: &crate::learn::Goal| Finding { goal: goal.says.clone(), passed: true, found: "right".into() };
        learning.measured = Measured::Findings(exercise.goals.iter().map(found).collect());
        let harness = |size, results| {
            let learning = &learning;
            let mut harness = Harness::builder()
                .with_size(size)
                .build_ui(move |ui| show(ui, learning, learning.exercise.as_ref().unwrap(), results, &mut Vec::new()));
            harness.run();
            harness
        };
        let new = harness(SIZE, Results::New);
        let (first, last) = (&exercise.goals[0].says, &exercise.goals.last().unwrap().says);
        let file = format!("Open {}", exercise.open.file);
        for text in [last, "Solved. Well done!", "Start over", &file] {
            let rect = new.get_by_label(text).rect();
            assert!(rect.min.y > 0.0 && rect.max.y <= SIZE.y, "`{text}` is at {rect:?}");
        }
        let larger = harness(LARGER, Results::New);
        for text in [first, "Solved. Well done!", "Start over", &file] {
            let rect = larger.get_by_label(text).rect();
            assert!(rect.min.y > 0.0 && rect.max.y <= LARGER.y, "`{text}` is at {rect:?} with larger letters");
        }
        let old = harness(SIZE, Results::Old);
        assert!(old.query_by_label("Solved. Well done!").is_none());
        old.get_by_label("measuring; these results are of the edit before");
    }

    #[test]
    fn formulas_are_told_from_paragraphs() {
        let text = "One\ntwo.\n\n    a = b\n    c\n\nThree\n";
        let expected =
            [Block::Paragraph("One two.".into()), Block::Formula("a = b\nc".into()), Block::Paragraph("Three".into())];
        assert_eq!(blocks(text), expected);
    }
}
