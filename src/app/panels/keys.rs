//! The list of keys.

use egui::{Key, Label, RichText, Ui, Window, vec2};

use crate::app::command::about::Group;
use crate::app::command::registry::REGISTRY;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ACCENT, QUIET, hide_hover_texts};

/// Actions of the mouse.
const MOUSE: [(&str, &str); 9] = [
    ("drag", "orbit"),
    ("Ctrl+drag, Shift+middle drag", "pan"),
    ("wheel", "zoom"),
    ("Shift+drag, Alt+drag, middle drag", "turn the environment"),
    ("right button + W A S D Q E", "look around and fly"),
    ("click", "read this pixel in the Inspector, and select what is there"),
    ("double click", "look at this point and orbit around it"),
    ("Ctrl+click on a mode", "show it beside the others; a click in the picture keeps one of them"),
    ("Ctrl+drag on a light", "change the distance of the light; a plain drag turns it around the model"),
];

/// A row of the list: keys, and what they do.
type KeyRow = (String, &'static str);

/// The rows of all lists: the mouse, the shortcuts of commands by their group, and other keys. The manual has them, too
/// (assets/manual/window.md).
fn rows() -> Vec<(Group, KeyRow)> {
    let all = REGISTRY.iter().map(|command| command.about()).filter(|about| !about.keys_doc.is_empty());
    let mut rows: Vec<_> = all.map(|about| (about.group, (about.key_names(), about.keys_doc))).collect();
    rows.extend(OTHER_KEYS.map(|(group, keys, doc)| (group, (keys.to_owned(), doc))));
    rows.extend(MOUSE.map(|(keys, doc)| (Group::Mouse, (keys.to_owned(), doc))));
    rows.sort_by_key(|(group, _)| *group);
    rows
}

/// Keys that are no shortcut of a command, and what they do.
const OTHER_KEYS: [(Group, &str, &str); 3] = [
    (Group::Program, "Ctrl++, Ctrl+-, Ctrl+0", "larger or smaller letters, or their usual size"),
    (
        Group::Picture,
        "letters",
        "the mode with this letter in the list, such as b base color or n normals; press it again to go back",
    ),
    (Group::Picture, "hold Space", "show the picture before the last edit, or the other picture of a comparison"),
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
            found.iter().for_each(|(keys, meaning)| row(ui, keys, meaning));
        });
    });
}

/// The rows that have all words of the filter.
fn found(filter: &str) -> impl Iterator<Item = KeyRow> {
    let words = Words::new(filter);
    let rows = rows().into_iter().map(|(_, row)| row);
    rows.filter(move |(keys, meaning)| words.are_in(&format!("{keys} {meaning}")))
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
        assert_eq!(keys("ctrl undo"), ["Ctrl+Z"]);
        assert_eq!(keys("PAN"), ["Ctrl+drag, Shift+middle drag", "Ctrl+P", "H"]);
        assert_eq!(keys("").len(), rows().len());
        assert!(keys("no such key").is_empty());
    }

    #[test]
    fn the_manual_has_the_same_keys() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/manual/window.md");
        let manual = std::fs::read_to_string(file).unwrap();
        let table = |group| {
            let title = match group {
                Group::Mouse => "| mouse | |",
                Group::Picture => "| modes and picture | |",
                Group::Camera => "| camera | |",
                Group::Program => "| program | |",
            };
            let rows = rows().into_iter().filter(|(of, _)| *of == group);
            let rows = rows.map(|(_, (keys, doc))| format!("| {keys} | {doc} |\n"));
            format!("{title}\n|---|---|\n{}", rows.collect::<String>())
        };
        for group in [Group::Mouse, Group::Picture, Group::Camera, Group::Program] {
            let table = table(group);
            assert!(manual.replace('`', "").contains(&table), "assets/manual/window.md lacks this table:\n{table}");
        }
    }
}
