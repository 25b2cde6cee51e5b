//! Applies the results of the threads to the state and the engine.

mod bakes;
mod loaded;
mod panics;
pub(super) mod reloads;

use std::path::PathBuf;

use crate::app::actions::checks::on_operations_checked;
use crate::app::actions::compare::file::{on_picture_fits, on_picture_read};
use crate::app::actions::compare::on_compared;
use crate::app::actions::compare::tree::{on_second_tree, on_second_tree_found};
use crate::app::actions::compare::write::{on_files_written, on_version_written};
use crate::app::actions::costs::{on_functions_timed, on_version_timed};
use crate::app::actions::edits::{on_typed_written, on_written};
use crate::app::actions::exercises::{on_checked, on_exercise, on_prepared};
use crate::app::actions::guests::on_guest_traced;
use crate::app::actions::inspect::{on_curves, on_not_finite};
use crate::app::actions::sessions::show_look;
use crate::app::actions::texts::on_text_written;
use crate::app::actions::trace::{on_trace_prepared, on_traced};
use crate::app::actions::trees::on_tree_found;
use crate::app::actions::watch::watch_files;
use crate::app::command::file::{OPEN, Open, all_chosen};
use crate::app::command::{execute, on_asked};
use crate::app::engine::Engine;
use crate::app::messages::bakes::on_bake;
use crate::app::messages::loaded::{on_files_changed, on_loaded};
use crate::app::messages::panics::on_panic;
use crate::app::messages::reloads::{
    arrange_for, check_names, on_completed, on_reload, remember_tree, show_endless_loop,
};
use crate::app::state::State;
use crate::app::state::workspace::PanelRequest;
use crate::threads::Message;
use crate::threads::NoDialog;
use crate::threads::WorkerMessage;

pub(in crate::app) fn on_message(state: &mut State, engine: &mut Engine, message: Message) {
    match message {
        Message::Worker(WorkerMessage::Built(Err(message))) => {
            state.waiting.fail(&message);
            state.say(message);
        }
        Message::Worker(WorkerMessage::Built(Ok(()))) => {
            engine.threads.worker.built();
            state.stages.invalidate();
        }
        Message::Worker(WorkerMessage::DriverTold) => state.stages.invalidate(),
        // The message wakes the window, which draws the thumbnails.
        Message::Worker(WorkerMessage::ThumbnailsBuilt) => {}
        Message::Worker(WorkerMessage::Reloaded { reload, detect_ms, source, edits }) => {
            engine.threads.worker.reloaded(edits);
            state.shader.compiling = false;
            state.shader.tree = source.name();
            state.shader.location = source.location().map(Into::into);
            arrange_for(state, source.is_toy());
            engine.threads.follow_tree(&source);
            // Newer texts may have been put over the built-in shaders since.
            state.source = state.text_writes.over(source);
            remember_tree(state, &reload.outcome);
            on_reload(state, engine, &reload, detect_ms);
        }
        Message::Worker(WorkerMessage::TreeFound { path, tree, edits }) => {
            on_tree_found(state, engine, &path, tree, edits);
        }
        Message::Worker(WorkerMessage::Completed(reload)) => on_completed(state, engine, &reload),
        Message::Loaded(loaded) => on_loaded(state, engine, *loaded),
        Message::Bake(message) => on_bake(state, engine, message),
        Message::EndlessLoop(words, diagnostic) => show_endless_loop(state, words, diagnostic.map(|found| *found)),
        Message::FilesChanged(paths) => on_files_changed(state, engine, &paths),
        Message::Curves(measured) => on_curves(state, *measured),
        Message::NotFinite(number, found) => on_not_finite(state, number, *found),
        Message::Traced(number, traced) => on_traced(state, number, *traced),
        Message::OperationsChecked(number, result) => on_operations_checked(state, number, result),
        Message::FunctionsTimed(number, result) => on_functions_timed(state, number, result),
        Message::VersionTimed(number, result) => on_version_timed(state, number, result),
        Message::GuestTraced(number, traced) => on_guest_traced(state, number, *traced),
        Message::TracedBefore(number, before) => state.traces.take_before(number, before.map(|before| *before)),
        Message::TracePrepared(number, prepared, ms) => on_trace_prepared(state, number, *prepared, ms),
        Message::TracedAround(number, around) => state.traces.around.take(number, *around),
        Message::TypedWritten(file, typed, written) => on_typed_written(state, file, typed, written),
        Message::TextWritten(number, written) => on_text_written(state, engine, number, written),
        Message::SourceText(path, text) => state.traces.saved.take(path, text),
        Message::Say(text) => state.say(text),
        Message::Tools(Ok(tools)) => engine.tools.made = Some(tools),
        Message::Tools(Err(message)) => {
            state.say(format!("Selections have no outline, and textures cannot be shown: {message}"));
        }
        Message::Look(Ok(look)) => {
            let model = show_look(state, engine, *look);
            state.say("Opened the look");
            if model.is_none() {
                check_names(state);
            }
            state.waiting.look_read(Ok(model));
            watch_files(state, engine);
        }
        Message::Written(written) => on_written(state, engine, written),
        Message::Look(Err(message)) => {
            state.say(message.clone());
            state.waiting.look_read(Err(message));
        }
        Message::Asked(asked) => on_asked(state, engine, *asked),
        // The screen has taken them.
        Message::Accessibility(_) | Message::Pictures(_) => {}
        Message::Captures(number, done, of) => state.captures.progress(number, done, of),
        Message::Captured(number) => state.captures.ended(number),
        Message::Compared(number, compared) => on_compared(state, number, compared),
        Message::PictureRead(number, read) => on_picture_read(state, engine, number, read),
        Message::PictureFits(number, still) => on_picture_fits(state, engine, number, still),
        Message::SecondTreeFound(number, found) => on_second_tree_found(state, engine, number, found),
        Message::SecondTree(number, message) => on_second_tree(state, engine, number, message),
        Message::VersionWritten(number, written) => on_version_written(state, engine, number, written),
        Message::FilesWritten(written) => on_files_written(state, written),
        Message::Chosen(answer) => on_chosen(state, engine, answer),
        Message::NewTree(Ok(path)) => execute(state, engine, OPEN.with(Open::Tree(path))),
        Message::NewTree(Err(message)) => state.say(message),
        Message::Listed(folder, files) => state.listing.take(&folder, files),
        Message::Prepared(exercise, prepared) => on_prepared(state, engine, &exercise, prepared),
        Message::Exercise(folder, exercise) => on_exercise(state, engine, folder, exercise),
        Message::Checked(checked) => on_checked(state, checked),
        Message::Panicked(task, text) => on_panic(state, engine, task, &text),
    }
}

/// Opens what the user has chosen in the dialog that is open. Without a dialog of the desktop, the window lists the files itself.
fn on_chosen(state: &mut State, engine: &mut Engine, answer: Result<Vec<PathBuf>, NoDialog>) {
    let dialog = state.choosing.take();
    match answer {
        Ok(paths) => {
            let commands = all_chosen(state, dialog, paths);
            commands.into_iter().for_each(|command| execute(state, engine, command));
        }
        Err(NoDialog) => state.workspace.request(PanelRequest::ChooseFile(dialog)),
    }
}
