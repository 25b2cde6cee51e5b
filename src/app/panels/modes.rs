//! The debug modes of the tree, by group; the one on screen is marked.

use egui::{RichText, Ui};

use super::QUIET;
use crate::app::document::Document;

pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    let Some(shaders) = document.pipelines.as_ref().map(|p| p.shaders.clone()) else {
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
            let on = document.settings.mode == mode.slug;
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
            if on && document.shown_in_list != mode.slug {
                document.shown_in_list.clone_from(&mode.slug);
                response.scroll_to_me(None);
            }
            if response.clicked() {
                document.settings.mode.clone_from(&mode.slug);
            }
        }
    });
}
