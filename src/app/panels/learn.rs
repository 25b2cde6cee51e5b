//! The panel Learn: the exercise that is open with its goals, or the list of all.

mod lesson;
mod list;
mod mark;

use egui::{RichText, ScrollArea, Ui};

use lesson::Results;

use crate::app::command::program::LEARN;
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::exercise::{LearnCommand, Learning};
use crate::app::widgets::theme::{ACCENT, GOOD, QUIET};
use crate::learn::exercises;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Learn", Group::Modes, "exercises lessons", || Box::new(ui)).scrolls_itself();

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let state = context.state;
    let results = match state.has_errors() {
        true => Results::Broken,
        false if state.shader.compiling || state.learning.is_outdated(context.shaders.generation) => Results::Old,
        false => Results::New,
    };
    show(ui, &state.learning, results, &mut commands.list);
}

/// Shows the panel.
fn show(ui: &mut Ui, learning: &Learning, results: Results, commands: &mut Vec<Command>) {
    bar(ui, learning, commands);
    match learning.exercise.as_ref().filter(|_| !learning.shows_list) {
        Some(exercise) => lesson::show(ui, learning, exercise, results, commands),
        None => {
            let list = |ui: &mut Ui| list::show(ui, learning, commands);
            ScrollArea::vertical().id_salt("list").auto_shrink(false).show(ui, list);
        }
    }
}

/// Where the student is, and how to go on.
fn bar(ui: &mut Ui, learning: &Learning, commands: &mut Vec<Command>) {
    let all = exercises();
    let open = learning.exercise.as_ref().filter(|_| !learning.shows_list);
    let number = open.map(|exercise| exercise.number).filter(|number| *number > 0);
    let mut ask = |command| commands.push(LEARN.with(command));
    ui.horizontal(|ui| {
        if let Some(number) = number {
            let text = RichText::new(format!("Exercise {number} of {}", all.len())).small().color(QUIET);
            ui.label(text);
        } else if let Some(own) = open {
            ui.label(RichText::new(format!("Exercise {}", own.name)).small().color(QUIET));
        } else {
            ui.label(
                RichText::new(format!("{} of {} solved", learning.progress.solved(), all.len())).small().color(QUIET),
            );
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let button = |ui: &mut Ui, text: &str, hover: &str, to: Option<usize>| {
                let button = ui.add_enabled(to.is_some(), egui::Button::new(text)).on_hover_text(hover);
                to.filter(|_| button.clicked())
            };
            let (before, after) = (number.map(|n| n - 1), number.map(|n| n + 1));
            let exists = |n: &usize| (1..=all.len()).contains(n);
            if number.is_some() {
                let next = button(ui, "Next", "Open the next exercise", after.filter(exists));
                let previous = button(ui, "Previous", "Open the previous exercise", before.filter(exists));
                next.or(previous).into_iter().for_each(|number| ask(LearnCommand::Open(number)));
            }
            let is_toggle = learning.exercise.is_some();
            let text = if learning.shows_list { "Back" } else { "All" };
            if is_toggle && ui.button(text).on_hover_text("List all exercises").clicked() {
                ask(LearnCommand::List);
            }
        });
    });
    dots(ui, learning, commands);
    ui.separator();
}

/// A dot for each exercise: filled when it is solved. A click opens it.
fn dots(ui: &mut Ui, learning: &Learning, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(2.0, 2.0);
        for exercise in exercises() {
            let is_open = learning.exercise.as_ref().is_some_and(|open| open.name == exercise.name);
            let (rect, response) = ui.allocate_exact_size(egui::vec2(18.0, 18.0), egui::Sense::click());
            crate::app::widgets::spoken::button(&response, &exercise.title);
            let record = learning.progress.of(exercise);
            let color = if record.solved { GOOD } else { QUIET };
            let (center, radius) = (rect.center(), if is_open { 6.0 } else { 4.5 });
            match record.solved {
                true => _ = ui.painter().circle_filled(center, radius, color),
                false => _ = ui.painter().circle_stroke(center, radius, egui::Stroke::new(1.5, color)),
            }
            if is_open {
                ui.painter().circle_stroke(center, radius + 2.5, egui::Stroke::new(1.5, ACCENT));
            }
            let state = if record.solved { "solved" } else { "not solved yet" };
            let hover = format!("{}: {}\n{}, {state}", exercise.number, exercise.title, exercise.idea);
            if response.on_hover_text(hover).on_hover_cursor(egui::CursorIcon::PointingHand).clicked() {
                commands.push(LEARN.with(LearnCommand::Open(exercise.number)));
            }
        }
    });
}
