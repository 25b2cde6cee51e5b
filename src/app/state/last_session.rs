//! The last session of each shader tree in each working directory, kept between runs in `sessions.json`: settings with the camera, model and shader tree.
//! A window without a model and options offers to go on with it, or does so by itself if the user has chosen that.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use chrono::{DateTime, Local};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::recent::Kind;
use crate::recovery::SessionState;
use crate::scene::BUILT_IN;
use crate::shader::TreePath;
use crate::state_folder;

const FILE: &str = "sessions.json";
/// Most sessions that are remembered.
const MOST: usize = 16;

/// The content of the file.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Stored {
    /// Whether a window restores the last session by itself.
    always: bool,
    /// The newest first. One that another version has written may not be readable.
    sessions: Vec<Value>,
}

/// A session that has ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::app) struct LastSession {
    /// The working directory.
    directory: PathBuf,
    /// When its window closed, in seconds since 1970.
    at: i64,
    pub(in crate::app) work: SessionState,
    /// The file of the tree that the panel Source showed.
    #[serde(default)]
    file: Option<String>,
}

impl LastSession {
    /// Describes the session for the user.
    pub(in crate::app) fn words(&self) -> String {
        let name = |path: &PathBuf| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let model = self.work.model.as_ref().map_or_else(|| BUILT_IN[0].to_owned(), name);
        let settings = &self.work.settings;
        let mode = (settings.mode != "final").then(|| format!("mode {}", settings.mode));
        let environment = format!("environment {}", name(&PathBuf::from(&settings.environment.name)));
        let tree = self.work.tree.as_ref().map(|tree| format!("shaders of {}", Kind::Tree.name_of(tree)));
        let at = DateTime::from_timestamp(self.at, 0).map(|at| at.with_timezone(&Local));
        let at = at.map(|at| at.format("%Y-%m-%d %H:%M").to_string());
        [Some(model), tree, mode, Some(environment), at].into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// The file of the tree that the panel Source showed.
    pub(in crate::app) fn file(&self) -> Option<TreePath> {
        self.file.as_deref().map(TreePath::from)
    }

    /// Whether its model and its shader tree are still there.
    fn is_there(&self) -> bool {
        let is_model = |path: &PathBuf| path.exists() || BUILT_IN.iter().any(|name| Path::new(name) == path);
        self.work.model.as_ref().is_none_or(is_model) && self.work.tree.as_ref().is_none_or(|tree| tree.exists())
    }
}

/// Earlier sessions.
#[derive(Default)]
pub(in crate::app) struct LastSessions {
    /// Whether a window restores the last session by itself.
    always: bool,
    /// The last session in the working directory with the shader tree of the start.
    pub(in crate::app) here: Option<LastSession>,
}

impl LastSessions {
    /// The stored sessions. `tree`: the shader tree of the start; `None` is the tree in the program.
    pub(in crate::app) fn restored(tree: Option<&Path>) -> Self {
        let stored = load();
        let (directory, tree) = (std::env::current_dir().ok(), tree.map(in_full));
        let here = directory.and_then(|directory| find(&stored, &directory, tree.as_deref()));
        let here = here.filter(LastSession::is_there);
        Self { always: stored.always, here }
    }

    pub(in crate::app) fn is_always(&self) -> bool {
        self.always
    }

    /// Stores whether windows restore the last session by themselves.
    pub(in crate::app) fn set_always(&mut self, always: bool) {
        self.always = always;
        state_folder::change(FILE, |stored: &mut Stored| stored.always = always);
    }
}

/// The state of the last session of this directory and shader tree, if the user wants windows to restore it by themselves.
pub fn session_to_restore(tree: Option<&Path>) -> Option<SessionState> {
    let sessions = LastSessions::restored(tree);
    sessions.here.filter(|_| sessions.always).map(|session| session.work)
}

/// Stores the state of a session that ends. `file`: see [`LastSession::file`].
pub(in crate::app) fn remember(work: &SessionState, file: Option<&TreePath>) {
    let Ok(directory) = std::env::current_dir() else { return };
    let (at, file) = (Local::now().timestamp(), file.map(TreePath::to_string));
    let session = LastSession { at, work: absolute(work.clone()), file, directory };
    state_folder::change(FILE, |stored: &mut Stored| insert(stored, session));
}

/// The state with absolute paths of files. Names of built-in models and environments stay.
fn absolute(mut work: SessionState) -> SessionState {
    work.model = work.model.map(|model| if model.exists() { in_full(&model) } else { model });
    work.tree = work.tree.as_deref().map(in_full);
    let environment = Path::new(&work.settings.environment.name);
    if environment.is_file() {
        let name = in_full(environment).display().to_string();
        Arc::make_mut(&mut work.settings).environment.name = name;
    }
    work
}

fn in_full(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

fn insert(stored: &mut Stored, session: LastSession) {
    let path = |value: &Value| value.as_str().map(PathBuf::from);
    let place = |old: &Value| Some((path(&old["directory"])?, path(&old["work"]["tree"])));
    let replaced = (session.directory.clone(), session.work.tree.clone());
    stored.sessions.retain(|old| place(old).is_some_and(|place| place != replaced));
    // Paths that are not UTF-8 are skipped.
    stored.sessions.splice(0..0, serde_json::to_value(session));
    stored.sessions.truncate(MOST);
}

fn find(stored: &Stored, directory: &Path, tree: Option<&Path>) -> Option<LastSession> {
    let sessions = stored.sessions.iter().filter_map(|value| serde_json::from_value(value.clone()).ok());
    sessions
        .into_iter()
        .find(|session: &LastSession| session.directory == directory && session.work.tree.as_deref() == tree)
}

fn load() -> Stored {
    state_folder::load(FILE).map(|text| parse(&text)).unwrap_or_default()
}

/// A file that cannot be read counts as empty.
fn parse(text: &str) -> Stored {
    serde_json::from_str(text).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    fn session(directory: &str, mode: &str) -> LastSession {
        let settings = Settings { mode: mode.to_owned(), ..Settings::of_window() };
        let work =
            SessionState { settings: Arc::new(settings), model: Some("sphere-grid".into()), ..SessionState::default() };
        LastSession { directory: directory.into(), at: 1_790_000_000, work, file: Some("user.glsl".to_owned()) }
    }

    #[test]
    fn each_tree_in_each_directory_has_its_last_session() {
        let mut stored = Stored { always: true, ..Stored::default() };
        for (directory, mode) in [("/a", "d"), ("/b", "g"), ("/a", "f")] {
            insert(&mut stored, session(directory, mode));
        }
        let read = parse(&serde_json::to_string(&stored).unwrap());
        assert!(read.always && read.sessions.len() == 2);
        assert_eq!(find(&read, Path::new("/a"), None), Some(session("/a", "f")));
        assert_eq!(find(&read, Path::new("/b"), None), Some(session("/b", "g")));
        assert_eq!(find(&read, Path::new("/c"), None), None);
        let mut toy = session("/a", "final");
        toy.work.tree = Some("/a/toy.glsl".into());
        insert(&mut stored, toy.clone());
        assert_eq!(find(&stored, Path::new("/a"), None), Some(session("/a", "f")));
        assert_eq!(find(&stored, Path::new("/a"), Some(Path::new("/a/toy.glsl"))), Some(toy));
        (0..30).for_each(|index| insert(&mut stored, session(&format!("/{index}"), "d")));
        assert_eq!(stored.sessions.len(), MOST);
    }

    #[test]
    fn what_another_version_has_written_costs_only_itself() {
        let mut stored = Stored::default();
        insert(&mut stored, session("/a", "d"));
        stored.sessions.push(serde_json::json!({ "directory": "/b", "work": 7 }));
        let read = parse(&serde_json::to_string(&stored).unwrap());
        assert!(find(&read, Path::new("/a"), None).is_some() && find(&read, Path::new("/b"), None).is_none());
        assert!(["", "7", "{\"sessions\": 1}"].iter().all(|text| parse(text).sessions.is_empty()));
    }

    #[test]
    fn a_session_without_its_files_is_not_offered() {
        assert!(session("/a", "d").is_there());
        let mut gone = session("/a", "d");
        gone.work.model = Some("/no/such/model.glb".into());
        assert!(!gone.is_there());
        assert!(session("/a", "d").words().starts_with("sphere-grid, mode d, environment studio, 2026-"));
    }
}
