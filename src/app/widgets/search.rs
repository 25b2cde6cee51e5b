//! The search above a list: its field, its words, and the line where no entry has them.

use egui::{Response, RichText, TextEdit, Ui};

use super::spoken::named;
use super::theme::{QUIET, icon};

/// Up to this many entries need no search.
pub(in crate::app) const FEW: usize = 5;
/// Width of the button that empties the field, with the gap before it, in points.
const CLEAR: f32 = 24.0;

/// The words that an entry must have.
#[derive(Clone, Debug, Default)]
pub(in crate::app) struct Words {
    /// As the user typed them.
    typed: String,
    /// In small letters.
    words: Vec<String>,
}

impl Words {
    pub(in crate::app) fn new(typed: &str) -> Self {
        let words = typed.to_lowercase().split_whitespace().map(str::to_owned).collect();
        Self { typed: typed.trim().to_owned(), words }
    }

    /// Whether the search is empty, so that every entry matches.
    pub(in crate::app) fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// Whether `text` contains all of them, ignoring case.
    pub(in crate::app) fn are_in(&self, text: &str) -> bool {
        let text = if self.is_empty() { String::new() } else { text.to_lowercase() };
        self.words.iter().all(|word| text.contains(word))
    }

    /// Shows that no entry of a list of `noun`s matches.
    pub(in crate::app) fn no_match(&self, ui: &mut Ui, noun: &str) {
        ui.label(RichText::new(format!("No {noun} matches \"{}\".", self.typed)).small().color(QUIET));
    }
}

/// Shows the field with its button, and leaves `beside` points of the row to the caller. `what` names the entries, such as
/// "modes".
pub(in crate::app) fn field(ui: &mut Ui, text: &mut String, what: &str, beside: f32) -> Response {
    let mut row = |ui: &mut Ui| {
        // The button comes one frame after the first letter, when the field has made room for it.
        let has_button = !text.is_empty();
        let room = ui.available_width() - beside - if has_button { CLEAR } else { 0.0 };
        let name = format!("Search {what}");
        let hint = format!("{}  {name}", icon::MAGNIFYING_GLASS);
        let field = named(ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(room)), &name);
        let all = format!("Show all {what}");
        if has_button && named(ui.small_button(icon::X), &all).on_hover_text(&all).clicked() {
            text.clear();
        }
        field
    };
    // The caller continues the row beside the field.
    if ui.layout().is_horizontal() { row(ui) } else { ui.horizontal(row).inner }
}

/// Shows the field above a list with this many entries, unless they are few. Returns its words.
pub(in crate::app) fn above(ui: &mut Ui, text: &mut String, what: &str, entries: usize) -> Words {
    if entries <= FEW {
        return Words::default();
    }
    field(ui, text, what, 0.0);
    Words::new(text)
}

/// [`above`] for a panel without a state: egui keeps the text.
pub(in crate::app) fn above_kept(ui: &mut Ui, what: &str, entries: usize) -> Words {
    let id = ui.id().with(("search", what));
    let mut text = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let words = above(ui, &mut text, what, entries);
    ui.data_mut(|data| data.insert_temp(id, text));
    words
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    #[test]
    fn words_are_found_in_any_order_and_case() {
        let words = Words::new(" Base  COLOR ");
        assert!(words.are_in("Color of the base") && !words.are_in("color"));
        assert!(Words::new("  ").is_empty() && Words::default().are_in("anything"));
    }

    #[test]
    fn a_short_list_has_no_search_and_a_long_one_says_what_it_lacks() {
        let show = |ui: &mut Ui, entries: &mut usize| {
            let words = above_kept(ui, "fruits", *entries);
            if !words.are_in("apple pear") {
                words.no_match(ui, "fruit");
            }
        };
        let mut harness = Harness::new_ui_state(show, FEW);
        harness.run();
        assert!(harness.query_by_role(Role::TextInput).is_none());
        *harness.state_mut() = FEW + 1;
        harness.run();
        harness.get_by_label("Search fruits").focus();
        harness.run();
        harness.get_by_label("Search fruits").type_text("Plum");
        harness.run();
        harness.get_by_label("No fruit matches \"Plum\".");
        harness.get_by_label("Show all fruits").click();
        harness.run();
        assert!(harness.query_by_label("No fruit matches \"Plum\".").is_none());
    }
}
