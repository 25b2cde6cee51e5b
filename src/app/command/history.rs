//! Undo and redo.

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::{Spec, Until};
use crate::app::actions::texts::take_back;
use crate::app::comparison_labels::new_values;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::history::Files;
use crate::settings::Settings;

pub(in crate::app) static UNDO: Spec<()> = Spec::fallible("undo", |state, engine, ()| {
    let before = state.session.shared_settings();
    let files = state.history.undo(&mut state.session.settings).ok_or("there is nothing to undo")?;
    tell(state, "Undone", &before);
    Ok(after(state, engine, files, false))
})
.line("Takes the last change of a setting back, or what the window last wrote to the shader files")
.label("Undo", "")
.shortcuts(
    Group::Program,
    &[Shortcut::key('z').ctrl()],
    "undo a change of the settings, or what was written to the shader files; camera, mode and watched expression are not undone",
);

pub(in crate::app) static REDO: Spec<()> = Spec::fallible("redo", |state, engine, ()| {
    let before = state.session.shared_settings();
    let files = state.history.redo(&mut state.session.settings).ok_or("there is nothing to redo")?;
    tell(state, "Redone", &before);
    Ok(after(state, engine, files, true))
})
.line("Takes the last undo back")
.label("Redo", "")
.shortcuts(
    Group::Program,
    &[Shortcut::key('z').ctrl().shift(), Shortcut::key('y').ctrl()],
    "redo a change of the settings",
);

/// Tells the settings that a step has changed, since their panel may be out of sight.
fn tell(state: &mut State, done: &str, before: &Settings) {
    let Some(shaders) = &state.session.shaders else { return };
    let values = new_values(before, &state.session.settings, shaders);
    if !values.is_empty() {
        state.say(format!("{done}. {values}"));
    }
}

/// When a step is done: with the picture of its settings, or of the files that it has written.
fn after(state: &mut State, engine: &mut Engine, files: Files, again: bool) -> Until {
    files.map_or(Until::SHOWN, |files| Until::TextWritten(take_back(state, engine, files, again)))
}
