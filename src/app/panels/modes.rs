//! The list of debug modes by group, with the selected mode highlighted and a search.

use egui::{RichText, Ui, vec2};

use super::{PanelState, QUIET};
use crate::shader::ShaderSet;
use crate::shader::annotation::Mode;

/// Shows the list. `current` is the slug of the selected mode. `features` are those of the model; modes for which it has no data are
/// folded away.
pub(super) fn show(
    ui: &mut Ui,
    shaders: Option<&ShaderSet>,
    features: Option<u32>,
    current: &mut String,
    state: &mut PanelState,
) {
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
    let is_found = |mode: &Mode| words.iter().all(|word| text_of(mode).contains(word));
    let found: Vec<(usize, &Mode)> = shaders.modes.iter().enumerate().filter(|(_, mode)| is_found(mode)).collect();
    if found.is_empty() {
        ui.label(RichText::new("No mode has these words").small().color(QUIET));
    }
    // Who searches for a mode sees it, and the selected mode is never folded away.
    let has_data = |mode: &Mode| {
        let has_feature = mode.needs == 0 || features.is_none_or(|features| features & mode.needs != 0);
        has_feature || !words.is_empty() || *current == mode.slug
    };
    let mut chosen = None;
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for modes in found.chunk_by(|a, b| a.1.group == b.1.group) {
            let group = &modes[0].1.group;
            let (shown, folded): (Vec<_>, Vec<_>) = modes.iter().copied().partition(|(_, mode)| has_data(mode));
            ui.add_space(6.0);
            ui.label(RichText::new(group).small().color(QUIET));
            let mut list = |ui: &mut Ui, modes: &[(usize, &Mode)]| {
                for (index, mode) in modes {
                    let is_current = *current == mode.slug;
                    let response = row(ui, *index, mode, is_current);
                    if is_current && *scrolled_to != mode.slug {
                        scrolled_to.clone_from(&mode.slug);
                        response.scroll_to_me(None);
                    }
                    if response.clicked() {
                        chosen = Some(mode.slug.clone());
                    }
                }
            };
            list(ui, &shown);
            if !folded.is_empty() {
                let title = RichText::new(format!("{} without data", folded.len())).small().color(QUIET);
                let header = egui::CollapsingHeader::new(title).id_salt(("without data", group));
                let header = header.show_unindented(ui, |ui| list(ui, &folded)).header_response;
                header.on_hover_text("Modes of features that no material of this model has");
            }
        }
    });
    if let Some(slug) = chosen {
        *current = slug;
    }
}

/// Shows a mode with its keys at the right.
fn row(ui: &mut Ui, index: usize, mode: &Mode, is_current: bool) -> egui::Response {
    let digit = (index < 10).then(|| char::from_digit((index as u32 + 1) % 10, 10)).flatten();
    let keys = mode.key.into_iter().chain(digit).map(String::from).collect::<Vec<_>>().join(" ");
    let keys = RichText::new(keys).small().monospace().color(QUIET);
    let button =
        egui::Button::selectable(is_current, &mode.name).right_text(keys).min_size(vec2(ui.available_width(), 18.0));
    ui.add(button.truncate()).on_hover_text(format!("{}\n\n--mode {}", mode.doc, mode.slug))
}

/// What the search looks through, in small letters.
fn text_of(mode: &Mode) -> String {
    format!("{} {} {} {}", mode.name, mode.slug, mode.group, mode.doc).to_lowercase()
}
