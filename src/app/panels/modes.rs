//! The list of debug modes by group, with the selected mode highlighted.

use egui::{RichText, Ui};

use super::QUIET;
use crate::shader::ShaderSet;

/// Shows the list. `current` is the slug of the selected mode, and `scrolled_to` that of the mode last scrolled to.
pub(super) fn show(ui: &mut Ui, shaders: Option<&ShaderSet>, current: &mut String, scrolled_to: &mut String) {
    let Some(shaders) = shaders else {
        ui.label(RichText::new("Compiling shaders…").color(QUIET));
        return;
    };
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut group = "";
        for (index, mode) in shaders.modes.iter().enumerate() {
            if mode.group != group {
                group = &mode.group;
                ui.add_space(6.0);
                ui.label(RichText::new(group).small().color(QUIET));
            }
            let on = *current == mode.slug;
            let digit = (index < 10).then(|| char::from_digit((index as u32 + 1) % 10, 10)).flatten();
            let hint = mode.key.into_iter().chain(digit).map(String::from).collect::<Vec<_>>().join(" ");
            let response = ui
                .horizontal(|ui| {
                    let response = ui.selectable_label(on, &mode.name);
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        ui.label(RichText::new(hint).small().monospace().color(QUIET));
                    });
                    response
                })
                .inner
                .on_hover_text(format!("{}\n\n--mode {}", mode.doc, mode.slug));
            if on && *scrolled_to != mode.slug {
                scrolled_to.clone_from(&mode.slug);
                response.scroll_to_me(None);
            }
            if response.clicked() {
                current.clone_from(&mode.slug);
            }
        }
    });
}
