//! The card of the first start.

use egui::{Align2, Id, Rect, RichText, Ui};

use super::card::{area, card};
use crate::app::command::file::{NEW_TREE, OPEN_EDITOR};
use crate::app::command::program::{DISMISS_HINT, LEARN};
use crate::app::command::spec::Command;
use crate::app::editor::Place;
use crate::app::state::State;
use crate::app::state::exercise::LearnCommand;
use crate::app::widgets::theme::{ACCENT, QUIET};
use crate::learn::exercises;

/// Shows the card while the hint is not dismissed. Returns its rectangle.
pub(super) fn show(egui: &egui::Context, state: &State, picture: Rect, commands: &mut Vec<Command>) -> Option<Rect> {
    if !state.hint.is_shown() || picture.width() < 300.0 || picture.height() < 200.0 {
        return None;
    }
    // Which tree it is is known with the first shaders. A single file is the user's own already.
    if state.shader.tree.is_empty() || state.shader.is_single_file {
        return None;
    }
    let tree = state.shader.location.clone();
    // An area keeps its first size, so another text is another area.
    let id = Id::new(("hint", tree.is_some(), picture.width() as u32));
    let mut is_done = false;
    let shown = area(id, Align2::RIGHT_BOTTOM, picture).fade_in(false).show(egui, |ui| {
        card(ACCENT).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).clamp(200.0, 400.0));
            match tree {
                Some(folder) => {
                    ui.label(RichText::new("Edit a shader and save it: the picture updates").strong());
                    ui.label(RichText::new(folder.display().to_string()).monospace().small().color(ACCENT));
                    ui.label(RichText::new("Begin with brdf/ndf.glsl, the shape of the highlights. user.glsl is for your own additions.").color(QUIET));
                    buttons(ui, commands, &mut is_done, |ui| {
                        let hover = "Opens the folder with $SPECULA_EDITOR, $VISUAL, $EDITOR or an installed editor";
                        let is_clicked = ui.button("Open in the editor").on_hover_text(hover).clicked();
                        is_clicked.then_some(OPEN_EDITOR.with(Place { file: folder, line: None, column: None }))
                    });
                }
                None => {
                    ui.label(RichText::new("You are looking at the built-in shaders").strong());
                    let text =
                        "Write them to a folder of your own, edit a file there and save it: the picture updates.";
                    ui.label(RichText::new(text).color(QUIET));
                    let standard = state.hint.folder.clone();
                    buttons(ui, commands, &mut is_done, |ui| {
                        let hover = "Writes the shaders there, as `specula new` does, and opens them";
                        let text = format!("Write to ./{}", standard.display());
                        let standard = ui.button(text).on_hover_text(hover).clicked().then_some(standard);
                        let chosen =
                            ui.button("Choose…").on_hover_text("Writes them to a folder that you choose").clicked();
                        (standard.is_some() || chosen).then_some(NEW_TREE.with(standard))
                    });
                }
            }
        });
    });
    if is_done {
        commands.push(DISMISS_HINT.with(()));
    }
    Some(shown.response.rect)
}

/// A row of buttons: the given ones, the exercises, and the end of the hint.
fn buttons(
    ui: &mut Ui,
    commands: &mut Vec<Command>,
    is_done: &mut bool,
    first: impl FnOnce(&mut Ui) -> Option<Command>,
) {
    ui.add_space(2.0);
    ui.horizontal_wrapped(|ui| {
        let command = first(ui);
        // A tree that has just been written is shown with its path, and the other hint.
        *is_done |= command.as_ref().is_some_and(|command| command.is_a(&OPEN_EDITOR));
        commands.extend(command);
        let hover = format!("{} short exercises about shading, which Specula checks", exercises().len());
        if ui.button("Learn…").on_hover_text(hover).clicked() {
            commands.push(LEARN.with(LearnCommand::List));
            *is_done = true;
        }
        if ui.button("Got it").on_hover_text("Do not show this again").clicked() {
            *is_done = true;
        }
    });
}
