//! The list of all exercises.

use egui::{Button, RichText, Ui};

use super::mark;
use crate::app::command::Command;
use crate::app::learn::{LearnCommand, Learning};
use crate::app::panels::theme::{ACCENT, QUIET};
use crate::learn::{Level, exercises};

/// Shows the list.
pub(super) fn show(ui: &mut Ui, learning: &Learning, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    ui.label(RichText::new("Learn shading by repairing it").strong().size(17.0));
    let text = "Each exercise is a folder of shaders in which something is wrong or missing. You edit it in your own editor. Specula \
        measures the result after every save and tells you what it found.";
    ui.label(RichText::new(text).color(QUIET));
    ui.add_space(6.0);
    let next = learning.progress.next().map(|exercise| exercise.number);
    for exercise in exercises() {
        let record = learning.progress.of(exercise);
        let mut open = false;
        ui.horizontal(|ui| {
            mark(ui, record.solved.then_some(true));
            let title = RichText::new(format!("{}  {}", exercise.number, exercise.title));
            let title = if next == Some(exercise.number) { title.color(ACCENT).strong() } else { title };
            let button = Button::new(title).frame(false);
            let hover = format!("Open the exercise: {}", exercise.idea);
            open |= ui.add(button).on_hover_text(hover).clicked();
            let level = match exercise.level {
                Level::Easy => "easy",
                Level::Medium => "medium",
                Level::Hard => "hard",
            };
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.label(RichText::new(level).small().color(QUIET)).on_hover_text("Difficulty");
            });
        });
        if open {
            commands.push(Command::Learn(LearnCommand::Open(exercise.number)));
        }
    }
    ui.add_space(8.0);
    let folder = learning.parent();
    let text = format!("Exercises are stored in {}", folder.display());
    ui.label(RichText::new(text).small().color(QUIET))
        .on_hover_text("`specula learn --dir FOLDER` chooses another folder");
}
