//! The list of debug modes by group, with the selected mode highlighted and a search.

use egui::{RichText, Ui};

use super::{PanelState, QUIET};
use crate::shader::ShaderSet;
use crate::shader::annotation::Mode;

/// Shows the list. `current` is the slug of the selected mode.
pub(super) fn show(ui: &mut Ui, shaders: Option<&ShaderSet>, current: &mut String, state: &mut PanelState) {
    let Some(shaders) = shaders else {
        ui.label(RichText::new("Compiling shaders…").color(QUIET));
        return;
    };
    let PanelState { search, scrolled_to, .. } = state;
    ui.horizontal(|ui| {
        let width = ui.available_width() - if search.is_empty() { 0.0 } else { 24.0 };
        ui.add(egui::TextEdit::singleline(search).hint_text("Search modes").desired_width(width));
        if !search.is_empty() && ui.small_button("x").on_hover_text("Show all modes").clicked() {
            search.clear();
        }
    });
    let words: Vec<String> = search.to_lowercase().split_whitespace().map(str::to_owned).collect();
    let found = |mode: &Mode| words.iter().all(|word| text_of(mode).contains(word));
    if !words.is_empty() && !shaders.modes.iter().any(found) {
        ui.label(RichText::new("No mode has these words").small().color(QUIET));
    }
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut group = "";
        for (index, mode) in shaders.modes.iter().enumerate().filter(|(_, mode)| found(mode)) {
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

/// What the search looks through, in small letters.
fn text_of(mode: &Mode) -> String {
    format!("{} {} {} {}", mode.name, mode.slug, mode.group, mode.doc).to_lowercase()
}
