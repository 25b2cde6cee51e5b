//! An exercise: its text, its goals with what was measured, hints and the solution.

use egui::{Frame, Label, Margin, RichText, Ui};

use super::mark::mark;
use crate::app::command::program::LEARN;
use crate::app::command::spec::Command;
use crate::app::state::exercise::{LearnCommand, Learning, Measured};
use crate::app::state::shaders::difference::Kind;
use crate::app::widgets::theme::{ACCENT, EDGE, ERROR, GOOD, QUIET, STRONG, TEXT, WARNING, small_mono};
use crate::learn::{Exercise, Finding, exercises};

/// Shows the exercise. `is_broken`: the newest edit does not compile.
pub(super) fn show(
    ui: &mut Ui,
    learning: &Learning,
    exercise: &Exercise,
    is_broken: bool,
    commands: &mut Vec<Command>,
) {
    let record = learning.progress.of(exercise);
    let mut ask = |command| commands.push(LEARN.with(command));
    ui.add_space(4.0);
    ui.label(RichText::new(&exercise.title).strong());
    ui.label(RichText::new(&exercise.idea).color(ACCENT));
    ui.add_space(4.0);
    text(ui, &exercise.text);
    ui.label(RichText::new(format!("Source: {}", exercise.source)).small().color(QUIET));
    ui.add_space(6.0);
    ui.horizontal_wrapped(|ui| {
        let hover =
            format!("{}\nOpens the file at the line to look at", learning.folder.join(&exercise.open.file).display());
        if ui.button(format!("Open {}", exercise.open.file)).on_hover_text(hover).clicked() {
            ask(LearnCommand::Edit);
        }
    });
    ui.separator();
    if goals(ui, learning, exercise, is_broken) {
        ask(LearnCommand::Open(exercise.number + 1));
    }
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        let most = exercise.hints.len();
        let text = format!("Hint ({} of {most})", (record.hints + 1).min(most));
        let is_left = record.hints < most;
        let text = if is_left { text } else { "No more hints".to_owned() };
        let hint = ui
            .add_enabled(is_left, egui::Button::new(text))
            .on_hover_text("The first hint is a nudge; the last one is almost the solution");
        if hint.clicked() {
            ask(LearnCommand::Hint);
        }
        let text = if learning.solution.is_some() { "Hide the solution" } else { "Show the solution" };
        if ui
            .button(text)
            .on_hover_text("Shows the lines that the solution changes. Your files stay as they are")
            .clicked()
        {
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
    for (index, hint) in exercise.hints.iter().take(record.hints).enumerate() {
        ui.add_space(2.0);
        ui.label(RichText::new(format!("Hint {}: {hint}", index + 1)).color(WARNING));
    }
    if solution(ui, learning) {
        ask(LearnCommand::Solve);
    }
    ui.add_space(8.0);
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

/// The goals, each gray before it is measured, then green or red with what was found. Returns whether the user wants the next exercise.
fn goals(ui: &mut Ui, learning: &Learning, exercise: &Exercise, is_broken: bool) -> bool {
    let findings: &[Finding] = match &learning.measured {
        Measured::Findings(findings) => findings,
        _ => &[],
    };
    let is_solved = learning.is_solved() && !is_broken;
    ui.horizontal(|ui| {
        ui.label(RichText::new(if exercise.goals.len() == 1 { "Goal" } else { "Goals" }).strong());
        let state = match (&learning.measured, learning.checking) {
            _ if is_broken => "your edit does not compile yet",
            (_, Some(_)) => "measuring…",
            (Measured::Failed(_), _) => "not measured",
            (Measured::Nothing, _) => "measured when the picture is complete",
            _ => "measured",
        };
        ui.label(RichText::new(state).small().color(QUIET)).on_hover_text(
            "Specula measures your shaders in the background after every save. The picture does not wait for it",
        );
    });
    for (index, goal) in exercise.goals.iter().enumerate() {
        let finding = findings.get(index).filter(|_| !is_broken);
        let state = finding.map(|finding| finding.passed);
        let color = if state == Some(true) { GOOD } else { ERROR };
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
    if !is_solved {
        return false;
    }
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new("Solved. Well done!").strong().color(GOOD));
        exercise.number < exercises().len() && ui.button("Next").on_hover_text("Open the next exercise").clicked()
    })
    .inner
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
    use super::*;

    #[test]
    fn formulas_are_told_from_paragraphs() {
        let text = "One\ntwo.\n\n    a = b\n    c\n\nThree\n";
        let expected =
            [Block::Paragraph("One two.".into()), Block::Formula("a = b\nc".into()), Block::Paragraph("Three".into())];
        assert_eq!(blocks(text), expected);
    }
}
