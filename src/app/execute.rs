//! Carries out the commands of panels, keys, the palette and of programs outside.

use std::path::PathBuf;
use std::time::Instant;

use crate::app::actions::compare::compare_with;
use crate::app::actions::compare::write::write_version;
use crate::app::actions::edits::{draft, write_edits};
use crate::app::actions::exercises::learn;
use crate::app::actions::files::{edit, load_model, open_tree};
use crate::app::actions::inspect::inspect;
use crate::app::actions::restored::{show_newest, show_version};
use crate::app::actions::select::{
    hide_selected, isolate_selected, look_through, place_rectangle, select_at, show_all,
};
use crate::app::actions::sessions::restore_session;
use crate::app::actions::watch::watch_files;
use crate::app::command::{Command, CompareWith, open_as};
use crate::app::control::ask_self;
use crate::app::dialog;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::dialog::Dialog;
use crate::app::state::workspace::PanelRequest;
use crate::picture::read_checked_look;
use crate::shader::Change;
use crate::threads::Message;

pub(in crate::app) fn execute(state: &mut State, engine: &mut Engine, command: Command) {
    match command {
        Command::Reload => {
            // A build that failed, for example without memory, is tried again.
            engine.threads.worker.built();
            state.shader.compiling = true;
            engine.threads.worker.change(Change::All, Instant::now());
        }
        Command::Settings(settings) => state.session.settings = *settings,
        Command::Panels(request) => state.workspace.request(request),
        Command::ToggleDifference => state.compare.shows_map ^= true,
        Command::Unpin => state.inspection.unpin(),
        Command::FollowMouse(follows) => state.inspection.follows = follows,
        Command::HideDiagnostics => state.session.diagnostics.clear(),
        Command::HideWarnings => {
            state.notices.dismiss();
            state.model.shows_warnings = false;
        }
        Command::DismissHint => state.hint.dismiss(),
        Command::RefuseSession => state.offers_session = false,
        Command::AskDriver(asks) => (state.shader.asks_driver, state.shader.told) = (asks, None),
        Command::CancelCapture(number) => state.captures.cancel_one(number),
        Command::Undo if !state.history.undo(&mut state.session.settings) => state.say("There is nothing to undo"),
        Command::Redo if !state.history.redo(&mut state.session.settings) => state.say("There is nothing to redo"),
        Command::Undo | Command::Redo => {}
        Command::FrameModel => state.frame_model(),
        Command::ViewFrom(side) => {
            let camera = &mut state.session.settings.camera;
            camera.frame_model();
            [camera.azimuth, camera.elevation] = side.angles();
        }
        Command::KeepCamera(number) => {
            let settings = &mut state.session.settings;
            settings.bookmarks.insert(number.to_string(), settings.camera.clone());
            state.say(format!("Saved this camera as {number}. Ctrl+{number} returns to it"));
        }
        Command::RecallCamera(number) => match state.session.settings.bookmarks.get(&number.to_string()).cloned() {
            Some(camera) => state.session.settings.camera = camera,
            None => state.say(format!("No camera is saved as {number}. Ctrl+Shift+{number} saves the current one")),
        },
        Command::Screenshot => state.screenshot = true,
        Command::Pick(at) => {
            inspect(state, at);
            select_at(state, at);
        }
        Command::Select(selected) => state.select(selected),
        Command::HideSelected => hide_selected(state),
        Command::IsolateSelected => isolate_selected(state),
        Command::ShowAll => show_all(state),
        Command::OpenPanel(panel) => state.workspace.request(PanelRequest::Open(panel)),
        Command::OpenInspector(page) => {
            state.inspection.page = page;
            state.workspace.request(PanelRequest::Open(Panel::Inspector));
        }
        Command::LookThrough(camera) => look_through(state, camera),
        Command::PlaceRectangle => place_rectangle(state),
        Command::Quit => state.quit = true,
        Command::Edit(place) => edit(state, engine, &place),
        Command::Choose(_) if state.choosing.is_some() => state.say("The file dialog is already open"),
        Command::Choose(dialog) => {
            state.choosing = Some(dialog);
            engine.threads.wait(move || Some(Message::Chosen(dialog::choose(dialog))));
        }
        Command::ShowGallery => state.workspace.request(PanelRequest::ShowGallery),
        Command::RestoreSession => restore_session(state, engine),
        Command::RestoreAlways(always) => state.last_sessions.set_always(always),
        Command::Say(text) => state.say(text),
        Command::Ask(request) => ask_self(state, engine, *request),
        Command::CancelCaptures => state.cancel_captures(),
        Command::Compare(with) => compare_with(state, engine, with),
        Command::ShowVersion(Some(number)) => show_version(state, engine, number),
        Command::ShowVersion(None) => show_newest(state, engine),
        Command::WriteVersion(number) => write_version(state, engine, number),
        Command::NewTree(_) if state.choosing.is_some() => state.say("The file dialog is already open"),
        Command::NewTree(folder) => {
            state.choosing = Some(Dialog::New);
            engine.threads.wait(move || Some(Message::NewTree(dialog::write_tree(folder))));
        }
        Command::Learn(command) => learn(state, engine, command),
        Command::Draft(edits) => draft(state, engine, edits),
        Command::WriteEdits(edits) => write_edits(state, engine, edits),
        Command::OpenTree(path) => open_tree(state, engine, &path),
        Command::OpenModel(path) => load_model(state, engine, Some(path)),
        Command::OpenEnvironment(path) => state.session.settings.environment.name = path.display().to_string(),
        Command::OpenLook(path) => {
            engine.threads.wait(move || Some(Message::Look(read_checked_look(&path).map(Box::new))));
        }
        Command::OpenMeasured(path) => {
            state.session.settings.measured = path.display().to_string();
            state.session.settings.mode = "measured".into();
        }
    }
    watch_files(state, engine);
}

/// Opens a file or folder that was dropped on the window. While pictures are compared, another picture takes part.
pub(in crate::app) fn open_path(state: &mut State, engine: &mut Engine, path: PathBuf) {
    if state.compare.takes(&path) {
        return execute(state, engine, Command::Compare(CompareWith::File(path)));
    }
    execute(state, engine, open_as(path).unwrap_or_else(Command::Say));
}
