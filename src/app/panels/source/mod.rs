//! The panel Source: a file of the shader tree with the values that its statements have at the pinned pixel, now and before the last edit.

mod bar;
#[cfg(test)]
mod choice_tests;
mod choices;
mod code;
mod colors;
mod cost;
mod declared;
mod definition;
mod edit;
#[cfg(test)]
mod edit_tests;
mod find;
mod fold;
mod functions;
#[cfg(test)]
mod gesture_tests;
mod head;
mod hover;
mod look;
mod model;
mod neighborhood;
mod number;
mod row;
mod scroll;
mod tail;
#[cfg(test)]
mod tests;
mod text_lines;
mod values;

use egui::{RichText, Ui};

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::theme::QUIET;
use crate::recovery::TypedText;
use code::Parts;
use edit::Editor;
use find::Find;
use fold::Folds;
use model::CodeModel;
use number::NumberDrag;
use scroll::Scroll;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec = PanelSpec::new(
    Panel::SOURCE.0,
    Group::Shaders,
    "code values trace statements debugger editor lines which light too bright",
    || Box::<SourceState>::default(),
)
.opens_on_request()
.below_picture()
.scrolls_itself();

/// State of the panel between frames.
#[derive(Default)]
struct SourceState {
    model: CodeModel,
    editor: Editor,
    find: Find,
    folds: Folds,
    drag: NumberDrag,
    scroll: Scroll,
}

impl PanelUi for SourceState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        commands.sight.source = true;
        let state = context.state;
        let Some(shaders) = &state.session.shaders else {
            ui.label(RichText::new("Compiling shaders…").small().color(QUIET));
            return;
        };
        let Self { model, editor, find, folds, drag, scroll } = self;
        editor.update(state);
        model.update(state, shaders, |path| folds.of(path), |path| editor.text(path));
        find.take_keys(ui);
        head::show(ui, state, (shaders, model), (editor, folds, scroll), commands);
        find.show(ui, model, scroll);
        match model.path().is_some_and(|path| editor.has(path)) {
            true => editor.show(ui, state, model, (find, scroll), commands),
            false => code::show(ui, state, model, Parts { find, editor, folds, drag, scroll }, commands),
        }
    }

    fn on_request(&mut self, request: &PanelRequest) {
        if let PanelRequest::RestoreTyped(typed) = request {
            self.editor.restore(typed);
        }
    }

    fn unsaved(&self) -> Vec<TypedText> {
        self.editor.unsaved()
    }
}
