//! The other side of the comparison, and how much both sides differ: the first lines of the panel Timeline.

use egui::{Label, RichText, TextWrapMode, Ui};

use crate::app::command::compare::{COMPARE, CompareFields, TOGGLE_DIFFERENCE};
use crate::app::command::file::CHOOSE;
use crate::app::command::spec::Command;
use crate::app::state::compare::{Compare, Difference};
use crate::app::state::dialog::Dialog;
use crate::app::widgets::search;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, small_mono};

/// The entries of the panel, for its search.
pub(super) const ENTRIES: &str = "versions";
/// The meaning of the numbers of a comparison.
const FLIP: &str = "Mean FLIP (Andersson et al. 2020), 0 to 1: how different the pictures look to a viewer who flips between \
    them, 0.7 m from a 4K screen. Largest: the largest difference of a channel of the display";

/// Width of the search at the right of the buttons, in points.
const SEARCH: f32 = 180.0;

/// Shows the buttons that begin and end a comparison, and its numbers. A `search` of the versions stands beside them.
pub(in crate::app::panels) fn show(
    ui: &mut Ui,
    compare: &Compare,
    search: Option<&mut String>,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        // A control that does not fit into a row goes to the next one as a whole.
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        if compare.is_on() {
            let stop = named(ui.button("Stop"), "Stop comparing");
            if stop.on_hover_text("Stop comparing, and show the newest picture alone (Ctrl+K)").clicked() {
                commands.push(COMPARE.with(CompareFields::nothing()));
            }
            let hint = "Show the FLIP of each pixel over the picture: black is equal, white is the largest difference";
            if ui.selectable_label(compare.shows_map, "Difference").on_hover_text(hint).clicked() {
                commands.push(TOGGLE_DIFFERENCE.with(()));
            }
            for number in numbers(compare.difference.as_ref()) {
                ui.label(monospace(number)).on_hover_text(FLIP);
            }
        } else {
            let hint = "Keep the current picture with all its settings, and compare later pictures with it (Ctrl+K)";
            if ui.button("Keep this picture").on_hover_text(hint).clicked() {
                commands.push(COMPARE.with(CompareFields::picture()));
            }
        }
        ui.menu_button("Compare with…", |ui| {
            let picture = "A PNG, JPEG, HDR or EXR file. The comparison updates when the file changes";
            if ui.button("A picture…").on_hover_text(picture).clicked() {
                commands.push(CHOOSE.with(Dialog::Picture));
                ui.close();
            }
            let tree = "The same picture drawn with other shaders. The comparison updates when their files change";
            if ui.button("A shader tree…").on_hover_text(tree).clicked() {
                commands.push(CHOOSE.with(Dialog::SecondTree));
                ui.close();
            }
        });
        if compare.is_opening() {
            ui.spinner().on_hover_text("The other picture is being read or compiled");
        }
        if let Some(text) = search {
            let beside = (ui.available_width() - SEARCH).max(0.0);
            search::field(ui, text, ENTRIES, beside);
        }
    });
    if let Some(note) = compare.note() {
        ui.add(Label::new(RichText::new(note).small().color(QUIET)).wrap());
    }
}

/// How much both pictures differ.
fn numbers(difference: Option<&Difference>) -> Vec<String> {
    match difference {
        Some(Difference { flip, largest, .. }) => {
            vec![format!("FLIP {flip:.4}"), format!("largest {:.0}/255", largest * 255.0)]
        }
        None => vec!["FLIP …".to_owned()],
    }
}

/// Small text of a fixed width.
pub(super) fn monospace(text: impl Into<String>) -> RichText {
    small_mono(text)
}
