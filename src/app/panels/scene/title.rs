//! The title of the details of a selection.

use egui::{RichText, Ui};

use crate::app::widgets::elide::middle;
use crate::app::widgets::theme::{QUIET, body_font};

/// Kind and name of what is selected.
pub(super) fn title(ui: &mut Ui, kind: &str, name: &str) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(kind).small().color(QUIET));
        let shown = middle(ui.painter(), name, &body_font(), ui.available_width());
        ui.label(RichText::new(shown).strong()).on_hover_text(name);
    });
}
