//! The list of keys.

use egui::{RichText, Window};

use super::{ACCENT, QUIET};

/// Keys and what they do, in the order of the README.
const KEYS: [(&str, &str); 22] = [
    ("1 … 9, 0", "the first ten modes"),
    ("[  ]", "previous mode, next mode"),
    ("letters", "the mode with this letter in the list; the same letter again goes back"),
    ("Esc", "the final picture"),
    ("drag", "orbit"),
    ("Shift+drag, middle drag", "pan"),
    ("Alt+drag", "turn the environment"),
    ("wheel", "zoom"),
    ("right button + W A S D Q E", "look around and fly"),
    ("double click", "look at this point and orbit around it"),
    ("hold Space", "the picture before the last edit, or the one that you compare with"),
    ("Ctrl+K", "keep this picture and compare with it; again ends the comparison"),
    ("R, Home", "frame the model"),
    ("L", "let the lights orbit"),
    ("H", "hide the panels"),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo and redo a change of the settings"),
    ("double click on a name", "reset the parameter; its menu copies the option for --set"),
    ("Ctrl+P", "find a mode, setting, panel or command"),
    ("F1, ?", "these keys"),
    ("F5", "compile everything again"),
    ("F12", "screenshot, to specula-1.png and so on"),
    ("Ctrl+Q", "quit"),
];

/// Shows the list over the picture while it is `open`.
pub(super) fn show(egui: &egui::Context, open: &mut bool) {
    let window = Window::new(RichText::new("Keys").strong()).open(open).collapsible(false).resizable(false);
    window.pivot(egui::Align2::CENTER_CENTER).default_pos(egui.content_rect().center()).show(egui, |ui| {
        egui::Grid::new("keys").num_columns(2).spacing([24.0, 6.0]).show(ui, |ui| {
            for (keys, meaning) in KEYS {
                ui.label(RichText::new(keys).monospace().color(ACCENT));
                ui.label(RichText::new(meaning).color(QUIET));
                ui.end_row();
            }
        });
    });
}
