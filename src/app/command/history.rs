//! Undo and redo.

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::{Spec, Until};
use crate::app::actions::texts::take_back;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::history::Files;

pub(in crate::app) static UNDO: Spec<()> = Spec::fallible("undo", |state, engine, ()| {
    let files = state.history.undo(&mut state.session.settings).ok_or("there is nothing to undo")?;
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
    let files = state.history.redo(&mut state.session.settings).ok_or("there is nothing to redo")?;
    Ok(after(state, engine, files, true))
})
.line("Takes the last undo back")
.label("Redo", "")
.shortcuts(
    Group::Program,
    &[Shortcut::key('z').ctrl().shift(), Shortcut::key('y').ctrl()],
    "redo a change of the settings",
);

/// When a step is done: with the picture of its settings, or of the files that it has written.
fn after(state: &mut State, engine: &mut Engine, files: Files, again: bool) -> Until {
    files.map_or(Until::SHOWN, |files| Until::TextWritten(take_back(state, engine, files, again)))
}
