//! The search in the file: Ctrl+F opens it, Enter goes to the next place.

use egui::{Key, Modifiers, RichText, TextEdit, Ui};

use super::model::CodeModel;
use super::scroll::Scroll;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, icon};

/// Width of the field, points.
const FIELD: f32 = 180.0;

/// The search.
#[derive(Default)]
pub(super) struct Find {
    is_open: bool,
    text: String,
    takes_focus: bool,
    /// The place among those that were found.
    at: usize,
}

impl Find {
    /// Opens the search with Ctrl+F, unless another field has the keys.
    pub(super) fn take_keys(&mut self, ui: &Ui) {
        let is_free = ui.memory(|memory| memory.focused().is_none()) || self.is_open;
        if is_free && ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::F)) {
            (self.is_open, self.takes_focus) = (true, true);
        }
    }

    /// The bytes of a line in which the text stands.
    pub(super) fn places(&self, line: &str) -> Vec<std::ops::Range<usize>> {
        if !self.is_open || self.text.is_empty() {
            return Vec::new();
        }
        // GLSL is ASCII but for comments, whose other letters keep their bytes.
        let (line, text) = (line.to_ascii_lowercase(), self.text.to_ascii_lowercase());
        line.match_indices(&text).map(|(at, found)| at..at + found.len()).collect()
    }

    /// Shows the field, while the search is open.
    pub(super) fn show(&mut self, ui: &mut Ui, model: &CodeModel, scroll: &mut Scroll) {
        if !self.is_open {
            return;
        }
        ui.horizontal(|ui| {
            let field = TextEdit::singleline(&mut self.text).desired_width(FIELD);
            let hint = format!("{}  Find in the file", icon::MAGNIFYING_GLASS);
            let field = named(ui.add(field.hint_text(hint)), "Find in the file");
            if std::mem::take(&mut self.takes_focus) {
                field.request_focus();
            }
            let [enter, shift, escape] = ui
                .input(|input| [input.key_pressed(Key::Enter), input.modifiers.shift, input.key_pressed(Key::Escape)]);
            let found: Vec<usize> = model
                .lines
                .iter()
                .enumerate()
                .filter(|(_, line)| !self.places(&line.text).is_empty())
                .map(|of| of.0)
                .collect();
            let has_ended = field.lost_focus();
            if field.changed() {
                // The first place at or below the lines in sight.
                self.at = found.iter().position(|line| *line >= scroll.first).unwrap_or(0);
                found.get(self.at).into_iter().for_each(|line| scroll.to(*line));
            }
            let count = found.len().max(1);
            let mut step = 0;
            if has_ended && enter {
                step = if shift { count - 1 } else { 1 };
                field.request_focus();
            }
            let text = match (found.len(), self.text.is_empty()) {
                (_, true) => String::new(),
                (0, _) => "not in this file".to_owned(),
                (count, _) => format!("{} of {count} lines", self.at.min(count - 1) + 1),
            };
            ui.label(RichText::new(text).small().color(QUIET));
            if !found.is_empty() {
                if ui.small_button("<").on_hover_text("Previous (Shift+Enter)").clicked() {
                    step = count - 1;
                }
                if ui.small_button(">").on_hover_text("Next (Enter)").clicked() {
                    step = 1;
                }
            }
            let closes = named(ui.small_button(icon::X), "Close the search").on_hover_text("Esc").clicked();
            if step > 0 {
                self.at = (self.at + step) % count;
                found.get(self.at).into_iter().for_each(|line| scroll.to(*line));
            }
            if closes || (has_ended && escape) {
                self.is_open = false;
            }
        });
    }
}
