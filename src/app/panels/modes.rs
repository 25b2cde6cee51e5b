//! The debug modes by group, as a gallery of thumbnails or as a list, with a search. The picture previews the mode that the mouse rests
//! on.

use egui::{RichText, Ui, vec2};

use super::theme::icon;
use super::{PanelState, QUIET, mode_tile};
use crate::shader::annotation::Mode;
use crate::shader::{PATHS_STAGE, ShaderSet};

/// Width of the button that switches between gallery and list, points.
const TOGGLE: f32 = 34.0;

/// Shows the modes. `current` is the slug of the selected mode. `features` are those of the model; modes for which it has no data are
/// folded away. Returns whether a mode that the user adds has no place beside the others.
pub(super) fn show(
    ui: &mut Ui,
    shaders: Option<&ShaderSet>,
    features: Option<u32>,
    current: &mut String,
    state: &mut PanelState,
) -> bool {
    let Some(shaders) = shaders else {
        ui.label(RichText::new("Compiling shaders…").color(QUIET));
        return false;
    };
    let PanelState { search, scrolled_to, gallery, grid, .. } = state;
    ui.horizontal(|ui| {
        let width = ui.available_width() - TOGGLE - if search.is_empty() { 0.0 } else { 24.0 };
        ui.add(
            egui::TextEdit::singleline(search)
                .hint_text(format!("{}  Search {} modes", icon::MAGNIFYING_GLASS, shaders.modes.len()))
                .desired_width(width),
        );
        if !search.is_empty() && ui.small_button(icon::X).on_hover_text("Show all modes").clicked() {
            search.clear();
        }
        let (name, hint) =
            if gallery.is_on { (icon::LIST, "Show names only") } else { (icon::GRID_FOUR, "Show thumbnails") };
        if ui.add_sized([TOGGLE - 6.0, 18.0], egui::Button::new(name)).on_hover_text(hint).clicked() {
            gallery.is_on = !gallery.is_on;
        }
    });
    if grid.is_on() {
        let text = format!("{}  {} modes side by side", icon::SQUARES_FOUR, grid.modes().len());
        let close = egui::Button::new(RichText::new(text).small()).right_text(icon::X);
        let hint = "Click to show the selected mode alone (Esc). Ctrl+click adds a mode or takes it away";
        if ui.add(close.min_size(vec2(ui.available_width(), 18.0))).on_hover_text(hint).clicked() {
            grid.end();
        }
    }
    let adds = ui.input(|input| input.modifiers.command);
    let mut added = None;
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
        let (columns, size) = mode_tile::columns(ui.available_width());
        gallery.size = size;
        let is_gallery = gallery.is_on;
        for modes in found.chunk_by(|a, b| a.1.group == b.1.group) {
            let group = &modes[0].1.group;
            let (shown, folded): (Vec<_>, Vec<_>) = modes.iter().copied().partition(|(_, mode)| has_data(mode));
            ui.add_space(6.0);
            ui.label(RichText::new(group).small().color(QUIET));
            let mut list = |ui: &mut Ui, modes: &[(usize, &Mode)]| {
                let mut item = |ui: &mut Ui, (index, mode): &(usize, &Mode)| {
                    let is_current = *current == mode.slug;
                    let response = match is_gallery {
                        true => mode_tile::show(ui, mode, keys(*index, mode).first().copied(), is_current, gallery),
                        false => row(ui, *index, mode, is_current),
                    };
                    let hint = "Ctrl+click shows it beside the others";
                    let response = response.on_hover_text(format!("{}\n\n--mode {}\n{hint}", mode.doc, mode.slug));
                    if is_current && *scrolled_to != mode.slug {
                        scrolled_to.clone_from(&mode.slug);
                        response.scroll_to_me(None);
                    }
                    // Random paths take seconds on a software device.
                    if response.hovered() && !mode.accumulate && !mode.traces {
                        gallery.hover(&mode.slug);
                    }
                    if response.clicked() {
                        *(if adds { &mut added } else { &mut chosen }) = Some(mode.slug.clone());
                    }
                };
                match is_gallery {
                    true => mode_tile::grid(ui, columns, modes, &mut item),
                    false => modes.iter().for_each(|mode| item(ui, mode)),
                }
            };
            list(ui, &shown);
            if !folded.is_empty() {
                let title = RichText::new(format!("{} without data", folded.len())).small().color(QUIET);
                let header = egui::CollapsingHeader::new(title).id_salt(("without data", group));
                let header = header.show_unindented(ui, |ui| list(ui, &folded)).header_response;
                header.on_hover_text("The scene has no data for these modes");
            }
        }
    });
    if let Some(slug) = chosen {
        *current = slug;
    }
    let added = added.and_then(|slug| shaders.modes.iter().find(|mode| mode.slug == slug));
    added.is_some_and(|mode| mode.stage == PATHS_STAGE || mode.accumulate || !grid.toggle(&mode.slug, current))
}

/// Shows a mode with its keys at the right.
fn row(ui: &mut Ui, index: usize, mode: &Mode, is_current: bool) -> egui::Response {
    let keys = keys(index, mode).into_iter().map(String::from).collect::<Vec<_>>().join(" ");
    let keys = RichText::new(keys).small().monospace().color(QUIET);
    let button =
        egui::Button::selectable(is_current, &mode.name).right_text(keys).min_size(vec2(ui.available_width(), 18.0));
    ui.add(button.truncate())
}

/// The keys that select a mode: its letter, and a digit for the first ten.
fn keys(index: usize, mode: &Mode) -> Vec<char> {
    let digit = (index < 10).then(|| char::from_digit((index as u32 + 1) % 10, 10)).flatten();
    mode.key.into_iter().chain(digit).collect()
}

/// Returns the lowercase text that the search matches against.
fn text_of(mode: &Mode) -> String {
    format!("{} {} {} {}", mode.name, mode.slug, mode.group, mode.doc).to_lowercase()
}
