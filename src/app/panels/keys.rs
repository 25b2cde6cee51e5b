//! The list of keys.

use egui::{Key, Label, RichText, Ui, Window, vec2};

use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ACCENT, QUIET, hide_hover_texts};

/// Keys and what they do, in short; assets/manual/window.md says more.
const KEYS: &[(&str, &str)] = &[
    ("1 … 9, 0", "the first ten modes"),
    ("[  ]", "previous mode, next mode"),
    ("letters", "the mode with this letter in the list; press it again to go back"),
    ("Esc", "close this list, unpin the pixel, select nothing, or show one mode alone; otherwise the final picture"),
    ("drag", "orbit"),
    ("Ctrl+drag, Shift+middle drag", "pan"),
    ("Shift+drag, Alt+drag, middle drag", "turn the environment"),
    ("wheel", "zoom"),
    ("right button + W A S D Q E", "look around and fly"),
    ("click", "read this pixel in the Inspector, and select what is there"),
    ("Ctrl+H, Alt+H", "hide the selection; draw everything again"),
    ("/", "draw only the selection; press again to draw everything"),
    ("Ctrl+drag on a light", "change the distance of the light; a plain drag turns it around the model"),
    ("double click", "look at this point and orbit around it"),
    ("hold Space", "show the picture before the last edit, or the other picture of a comparison"),
    ("Ctrl+K", "keep this picture and compare with it; press again to stop"),
    ("R, Home", "frame the model"),
    ("Numpad 1, 3, 7", "view from the front, the right or the top; with Ctrl, from the opposite side"),
    ("Ctrl+Shift+1 … 9", "save this camera under a number"),
    ("Ctrl+1 … 9", "return to the camera with this number"),
    ("Ctrl+click on a mode", "show it beside the others; a click in the picture keeps one of them"),
    ("L", "start or stop the orbiting lights"),
    ("H", "hide or show the panels"),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo and redo a change of the settings"),
    ("double click on a name", "reset the setting; the menu of the name copies its option"),
    ("Ctrl+O", "open a model, environment or shader"),
    ("Ctrl+P", "find a mode, setting, panel or command"),
    ("F1, ?", "show this list"),
    ("F5", "compile everything again"),
    ("F12", "save a screenshot as specula-1.png and so on"),
    ("Ctrl+Q", "quit"),
];

/// Width of the list in points, and of the column with the keys.
const WIDTH: f32 = 540.0;
const COLUMN: f32 = 210.0;
/// Height of the title, the filter and the margins, in points.
const AROUND: f32 = 90.0;

/// State of the list between frames.
#[derive(Default)]
pub(super) struct KeyList {
    filter: String,
    /// Whether it was open in the last frame.
    is_shown: bool,
}

/// Shows the list over the picture while it is `open`. `closes`: whether Escape is meant for the list.
pub(super) fn show(egui: &egui::Context, list: &mut KeyList, open: &mut bool, closes: bool) {
    if closes && egui.input(|input| input.key_pressed(Key::Escape)) {
        *open = false;
    }
    if !*open {
        return *list = KeyList::default();
    }
    let is_new = !std::mem::replace(&mut list.is_shown, true);
    let room = egui.content_rect();
    let window = Window::new(RichText::new("Keys").strong()).open(open).collapsible(false).resizable(false);
    // Above the cards over the picture.
    let window = window.order(egui::Order::Foreground);
    let window = window.pivot(egui::Align2::CENTER_CENTER).default_pos(room.center());
    hide_hover_texts(egui);
    window.show(egui, |ui| {
        ui.set_width(WIDTH.min(room.width() - 40.0));
        let field = search::field(ui, &mut list.filter, "keys", 0.0);
        if is_new {
            field.request_focus();
        }
        let height = (room.height() - AROUND).max(60.0);
        // egui fades to the color of a panel, which is not that of this window.
        ui.spacing_mut().scroll.fade.strength = 0.0;
        // The height does not follow the filter, so that the window stays in place.
        egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
            let found: Vec<_> = found(&list.filter).collect();
            if found.is_empty() {
                Words::new(&list.filter).no_match(ui, "key");
            }
            found.into_iter().for_each(|(keys, meaning)| row(ui, keys, meaning));
        });
    });
}

/// The rows that have all words of the filter.
fn found(filter: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let words = Words::new(filter);
    KEYS.iter().copied().filter(move |(keys, meaning)| words.are_in(&format!("{keys} {meaning}")))
}

fn row(ui: &mut Ui, keys: &str, meaning: &str) {
    ui.horizontal_top(|ui| {
        let column = COLUMN.min(0.45 * ui.available_width());
        ui.allocate_ui(vec2(column, 16.0), |ui| {
            ui.set_width(column);
            ui.add(Label::new(RichText::new(keys).monospace().color(ACCENT)).wrap());
        });
        ui.add(Label::new(RichText::new(meaning).color(QUIET)).wrap());
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filter_finds_keys_and_meanings() {
        let keys = |filter| found(filter).map(|(keys, _)| keys).collect::<Vec<_>>();
        assert_eq!(keys("ctrl undo"), ["Ctrl+Z, Ctrl+Shift+Z"]);
        assert_eq!(keys("PAN"), ["Ctrl+drag, Shift+middle drag", "H", "Ctrl+P"]);
        assert_eq!(keys("").len(), KEYS.len());
        assert!(keys("no such key").is_empty());
    }
}
