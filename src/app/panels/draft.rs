//! The buttons that write dragged numbers into their file, or go back to those of the file.

use egui::{Button, RichText, Ui};

use crate::app::command::shaders::{DRAFT, WRITE_EDITS};
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::state::shaders::edits::{Draft, NO_FOLDER};
use crate::app::widgets::theme::ACCENT;

/// Shows the buttons. `place`: whether with the line and the numbers. Returns whether the numbers of the file are to be shown.
pub(super) fn show_draft(ui: &mut Ui, state: &State, draft: &Draft, place: bool, commands: &mut Vec<Command>) -> bool {
    let changes: Vec<String> = draft.edits.iter().map(|edit| format!("{} -> {}", edit.old(), edit.new)).collect();
    let changes = changes.join(", ");
    if place {
        let file = draft.path.as_str().rsplit('/').next().unwrap_or_default();
        ui.label(RichText::new(format!("{file}:{}  {changes}", draft.line)).small().color(ACCENT));
    }
    let write = ui.add_enabled(state.has_files(), Button::new("Write").small());
    let write = write.on_hover_text(format!("Write to the file: {changes}")).on_disabled_hover_text(NO_FOLDER);
    if write.clicked() {
        commands.push(WRITE_EDITS.with(draft.edits.clone()));
    }
    let cancels = ui.small_button("Cancel").on_hover_text("Go back to the numbers in the file").clicked();
    if cancels {
        commands.push(DRAFT.with(Vec::new()));
    }
    cancels
}
