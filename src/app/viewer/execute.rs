//! Carries out the commands of panels, keys, the palette and of programs outside.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::Viewer;
use crate::app::command::{Command, CompareWith, open_as};
use crate::app::dialog::Dialog;
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::app::{dialog, editor};
use crate::picture::read_checked_look;
use crate::scene::LoadOptions;
use crate::shader::{Change, Source};
use crate::threads::Message;

impl Viewer {
    pub(in crate::app) fn execute(&mut self, command: Command) {
        match command {
            Command::Reload => {
                // A build that failed, for example without memory, is tried again.
                self.threads.worker.built();
                self.shader.compiling = true;
                self.threads.worker.change(Change::All, Instant::now());
            }
            Command::Undo if !self.history.undo(&mut self.session.settings) => self.say("There is nothing to undo"),
            Command::Redo if !self.history.redo(&mut self.session.settings) => self.say("There is nothing to redo"),
            Command::Undo | Command::Redo => {}
            Command::FrameModel => self.session.settings.camera.frame_model(),
            Command::ViewFrom(side) => {
                let camera = &mut self.session.settings.camera;
                camera.frame_model();
                [camera.azimuth, camera.elevation] = side.angles();
            }
            Command::KeepCamera(number) => {
                let settings = &mut self.session.settings;
                settings.bookmarks.insert(number.to_string(), settings.camera.clone());
                self.say(format!("Saved this camera as {number}. Ctrl+{number} returns to it"));
            }
            Command::RecallCamera(number) => match self.session.settings.bookmarks.get(&number.to_string()).cloned() {
                Some(camera) => self.session.settings.camera = camera,
                None => self.say(format!("No camera is saved as {number}. Ctrl+Shift+{number} saves the current one")),
            },
            Command::Screenshot => self.screenshot = true,
            Command::Pick(at) => {
                self.inspect(at);
                self.select_at(at);
            }
            Command::Select(selected) => self.select(selected),
            Command::HideSelected => self.hide_selected(),
            Command::IsolateSelected => self.isolate_selected(),
            Command::ShowAll => self.show_all(),
            Command::OpenPanel(panel) => self.workspace.request(PanelRequest::Open(panel)),
            Command::OpenInspector(page) => {
                self.inspection.page = page;
                self.workspace.request(PanelRequest::Open(Panel::Inspector));
            }
            Command::LookThrough(camera) => self.look_through(camera),
            Command::PlaceRectangle => self.place_rectangle(),
            Command::Quit => self.quit = true,
            Command::Edit(place) => match editor::open(&place) {
                Ok(editor) => self.threads.wait(|| editor.failure().map(Message::Say)),
                Err(message) => self.say(message),
            },
            Command::Choose(_) if self.choosing.is_some() => self.say("The file dialog is already open"),
            Command::Choose(dialog) => {
                self.choosing = Some(dialog);
                self.threads.wait(move || Some(Message::Chosen(dialog::choose(dialog))));
            }
            Command::ShowGallery => self.workspace.request(PanelRequest::ShowGallery),
            Command::RestoreSession => self.restore_session(),
            Command::RestoreAlways(always) => self.last_sessions.set_always(always),
            Command::Say(text) => self.say(text),
            Command::Ask(request) => self.ask_self(*request),
            Command::CancelCaptures => self.cancel_captures(),
            Command::Compare(with) => self.compare_with(with),
            Command::ShowVersion(Some(number)) => self.show_version(number),
            Command::ShowVersion(None) => self.show_newest(),
            Command::WriteVersion(number) => self.write_version(number),
            Command::NewTree(_) if self.choosing.is_some() => self.say("The file dialog is already open"),
            Command::NewTree(folder) => {
                self.choosing = Some(Dialog::New);
                self.threads.wait(move || Some(Message::NewTree(dialog::write_tree(folder))));
            }
            Command::Learn(command) => self.learn(command),
            Command::Draft(edits) => self.draft(edits),
            Command::WriteEdits(edits) => self.write_edits(edits),
            Command::OpenTree(path) => self.open_tree(&path),
            Command::OpenModel(path) => self.load_model(Some(path)),
            Command::OpenEnvironment(path) => self.session.settings.environment.name = path.display().to_string(),
            Command::OpenLook(path) => {
                self.threads.wait(move || Some(Message::Look(read_checked_look(&path).map(Box::new))));
            }
            Command::OpenMeasured(path) => {
                self.session.settings.measured = path.display().to_string();
                self.session.settings.mode = "measured".into();
            }
        }
        self.watch_files();
    }

    /// Opens a file or folder that was dropped on the window. While pictures are compared, another picture takes part.
    pub(in crate::app) fn open_path(&mut self, path: PathBuf) {
        if self.compare.takes(&path) {
            return self.execute(Command::Compare(CompareWith::File(path)));
        }
        self.execute(open_as(path).unwrap_or_else(Command::Say));
    }

    /// Loads a model. The current model stays until the new one is ready.
    pub(super) fn load_model(&mut self, path: Option<PathBuf>) {
        self.threads.loader.load(path.clone(), LoadOptions { allow_outside: self.allow_outside });
        self.begin_loading(path);
    }

    /// Notes that the model of `path` is being loaded, and watches the file while it is read.
    pub(super) fn begin_loading(&mut self, path: Option<PathBuf>) {
        let more = path.iter().filter_map(|path| std::path::absolute(path).ok());
        self.model.files = self.model.files.iter().cloned().chain(more).collect();
        self.model.requested = path;
        self.model.loading = true;
    }

    /// Shows the shaders of another tree, once they compile. If there is none, for example because a look names one that is gone, the
    /// present tree stays with its versions.
    fn open_tree(&mut self, path: &Path) {
        let source = match Source::find(path) {
            Ok(source) => source,
            Err(message) => return self.say(message),
        };
        self.source = source.clone();
        self.settled = None;
        // Versions of another tree must never be written into this one.
        self.forget_all_references();
        self.edits.forget_draft();
        self.watch_tree(&source);
        self.shader.compiling = true;
        self.threads.worker.open_tree(source);
        self.find_exercise();
    }
}
