//! Undo and redo.

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::{Spec, Until};
use crate::app::actions::edits::take_back;

pub(in crate::app) static UNDO: Spec<()> = Spec::fallible("undo", |state, engine, ()| {
    let files = state.history.undo(&mut state.session.settings).ok_or("there is nothing to undo")?;
    files.into_iter().for_each(|files| take_back(engine, files, false));
    Ok(Until::SHOWN)
})
.line("Takes the last change of a setting back, or what the window last wrote to the shader files")
.label("Undo", "")
.shortcuts(
    Group::Program,
    &[Shortcut::key('z').ctrl()],
    "undo a change of the settings, or what was written to the shader files; camera and mode are not undone",
);

pub(in crate::app) static REDO: Spec<()> = Spec::fallible("redo", |state, engine, ()| {
    let files = state.history.redo(&mut state.session.settings).ok_or("there is nothing to redo")?;
    files.into_iter().for_each(|files| take_back(engine, files, true));
    Ok(Until::SHOWN)
})
.line("Takes the last undo back")
.label("Redo", "")
.shortcuts(
    Group::Program,
    &[Shortcut::key('z').ctrl().shift(), Shortcut::key('y').ctrl()],
    "redo a change of the settings",
);
