//! The title of the details of a selection.

use egui::{Label, RichText, Ui};

use crate::app::widgets::theme::QUIET;

/// Kind and name of what is selected.
pub(super) fn title(ui: &mut Ui, kind: &str, name: &str) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(kind).small().color(QUIET));
        ui.add(Label::new(RichText::new(name).strong()).truncate());
    });
}
