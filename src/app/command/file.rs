//! Commands that open files and folders.

use std::path::{Path, PathBuf};

use super::about::{About, Group};
use super::compare::{COMPARE, CompareFields};
use super::fields::{Fields, needs};
use super::models::show_models;
use super::program::SAY;
use super::shortcut::Shortcut;
use super::spec::{Command, Outcome, Spec, Until};
use crate::app::actions::files::{begin_reading, edit, find_tree, leave_single_file, load_models, wanted_models};
use crate::app::actions::sessions::restore_session;
use crate::app::dialog;
use crate::app::editor::Place;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::dialog::Dialog;
use crate::app::state::workspace::PanelRequest;
use crate::file_kind::{self, FileKind};
use crate::message::did_you_mean;
use crate::picture::{may_hold_look, read_checked_look};
use crate::scene::{BUILT_IN, MeasuredKind, Problem, find_model};
use crate::settings::{AddedModel, MOST_ADDED};
use crate::shader::{self, Source};
use crate::threads::Message;

/// A path and what to open it as.
#[derive(Clone, Debug)]
pub(in crate::app) enum Open {
    /// By the kind of the file.
    File(PathBuf),
    Model(PathBuf),
    /// A model that is shown beside those on screen.
    Beside(PathBuf),
    Environment(PathBuf),
    Tree(PathBuf),
    Look(PathBuf),
    Measured(PathBuf),
}

pub(in crate::app) static OPEN: Spec<Open> = Spec::new("open", open).parsed(
    r#""file" | "model" | "beside" | "environment" | "tree" | "look" | "measured": "path or name""#,
    "Opens a file or folder; `beside` shows a model beside those on screen. Done when its final picture is on screen",
    parse,
);

pub(in crate::app) static SHOW_GALLERY: Spec<()> =
    Spec::plain("gallery", |state, _, ()| state.workspace.request(PanelRequest::ShowGallery))
        .label("Open the gallery", "built-in models environments pictures browse")
        .of_window();

pub(in crate::app) static RESTORE_SESSION: Spec<()> =
    Spec::plain("restore-session", |state, engine, ()| restore_session(state, engine))
        .label("Restore the last session", "continue")
        .of_window();

/// Whether later windows go on with the last session by themselves.
pub(in crate::app) static RESTORE_ALWAYS: Spec<bool> =
    Spec::act("restore-always", |state, _, always| state.last_sessions.set_always(always)).of_window();

/// Offers the last session no longer.
pub(in crate::app) static REFUSE_SESSION: Spec<()> =
    Spec::plain("refuse-session", |state, _, ()| state.offers_session = false).of_window();

/// Opens what the user chooses in the file dialog.
pub(in crate::app) static CHOOSE: Spec<Dialog> = Spec::new("choose", choose)
    .arguments(|_| Dialog::File)
    .label("Open a file", "model environment shader measured BRDF")
    .shortcuts(Group::Program, &[Shortcut::key('o').ctrl()], "open a model, an environment or a shader")
    .of_window();

/// Shows a model that the user chooses beside those on screen.
pub(in crate::app) static CHOOSE_BESIDE: Spec<()> =
    Spec::fallible("choose-beside", |state, engine, ()| choose(state, engine, Dialog::Beside))
        .label("Add a model beside this one", "open several second compare side by side")
        .of_window();

pub(in crate::app) static CHOOSE_TREE: Spec<()> =
    Spec::fallible("choose-tree", |state, engine, ()| choose(state, engine, Dialog::Tree))
        .label("Open a shader tree", "folder")
        .of_window();

pub(in crate::app) static OPEN_BUILT_IN: Spec<()> =
    Spec::fallible("open-built-in", |state, engine, ()| open(state, engine, Open::Tree(shader::BUILT_IN.into())))
        .label("Open the built-in shaders", "tree default back")
        .of_window();

/// Writes the built-in shaders to a folder, or to one that the user chooses, and opens them.
pub(in crate::app) static NEW_TREE: Spec<Option<PathBuf>> =
    Spec::new("new-tree", |state, engine, folder| match folder {
        None => choose(state, engine, Dialog::New),
        Some(folder) => {
            engine.threads.wait(move || Some(Message::NewTree(dialog::write_tree(folder))));
            Ok(Until::DONE)
        }
    })
    .of_window();

/// Whether a file is what its ending says, at a glance. Most `.toml`, `.png` and `.bin` files are something else.
pub(in crate::app) fn may_be(kind: FileKind, path: &Path) -> bool {
    match kind {
        FileKind::Look => may_hold_look(path),
        FileKind::Measured => path.metadata().is_ok_and(|file| MeasuredKind::has_length(file.len())),
        _ => true,
    }
}

/// Reads a folder for the command palette, on a thread.
pub(in crate::app) static LIST_FOLDER: Spec<PathBuf> = Spec::act("list-folder", |state, engine, folder: PathBuf| {
    state.listing.ask(folder.clone());
    engine.threads.wait(move || {
        let files = file_kind::list(&folder, may_be);
        Some(Message::Listed(folder, files))
    });
})
.of_window();

/// Opens the command palette with the files of the working directory.
pub(in crate::app) static OPEN_PATH: Spec<()> =
    Spec::plain("open-path", |state, _, ()| state.workspace.request(PanelRequest::ChooseFile(None)))
        .label("Open a path", "file folder browse type")
        .of_window();

/// Opens a file or folder in the user's editor.
pub(in crate::app) static OPEN_EDITOR: Spec<Place> =
    Spec::new("open-editor", |state, engine, place: Place| edit(state, engine, &place).map(|()| Until::DONE))
        .of_window();

/// The commands for files and folders that were dropped together. The first model is opened, and the others stand beside it; all do if the drop
/// `adds`. While pictures are compared, another picture takes part.
pub(in crate::app) fn dropped(state: &State, paths: Vec<PathBuf>, adds: bool) -> Vec<Command> {
    if let [path] = paths.as_slice() {
        return vec![match FileKind::of(path) {
            FileKind::Model | FileKind::Folder if adds => OPEN.with(Open::Beside(path.clone())),
            _ if state.compare.takes(path) => COMPARE.with(CompareFields::file(path.clone())),
            _ => OPEN.with(Open::File(path.clone())),
        }];
    }
    let kinds: Vec<FileKind> = paths.iter().map(|path| FileKind::of(path)).collect();
    let with_model = kinds.contains(&FileKind::Model);
    // Files that a model reads by itself: buffers and textures.
    let belongs = |kind: FileKind, path: &Path| {
        let is = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        with_model && (kind == FileKind::Other || is("bin") || is("png"))
    };
    let mut opened: Vec<(FileKind, &PathBuf)> = Vec::new();
    let mut left: Vec<String> = Vec::new();
    for (kind, path) in kinds.into_iter().zip(&paths).filter(|(kind, path)| !belongs(*kind, path)) {
        // Trees and single shaders take one place, models and folders with a model another.
        let place = |kind: FileKind| match kind {
            FileKind::Shader => FileKind::ShaderTree,
            FileKind::Folder => FileKind::Model,
            other => other,
        };
        let is_first = opened.iter().all(|(other, _)| place(*other) != place(kind));
        match kind != FileKind::Other && (is_first || place(kind) == FileKind::Model) {
            true => opened.push((kind, path)),
            false => left.push(path.file_name().unwrap_or_default().to_string_lossy().into_owned()),
        }
    }
    let mut has_model = adds;
    let mut open = |(kind, path): &(FileKind, &PathBuf)| {
        let is_model = matches!(kind, FileKind::Model | FileKind::Folder);
        let is_beside = is_model && has_model;
        has_model |= is_model;
        OPEN.with(if is_beside { Open::Beside((*path).clone()) } else { Open::File((*path).clone()) })
    };
    let mut commands: Vec<Command> = opened.iter().map(&mut open).collect();
    if let Some(first) = left.first() {
        let more = if left.len() > 1 { format!(" and {} more", left.len() - 1) } else { String::new() };
        commands.push(SAY.with(format!("Not opened: {first}{more}. Open one file of a kind at a time")));
    }
    commands
}

/// The command for a path that was chosen in a dialog.
pub(in crate::app) fn chosen(dialog: Option<Dialog>, path: PathBuf) -> Command {
    match dialog {
        Some(Dialog::Picture) => COMPARE.with(CompareFields::file(path)),
        Some(Dialog::SecondTree) => COMPARE.with(CompareFields::tree(path)),
        Some(Dialog::Beside) => OPEN.with(Open::Beside(path)),
        Some(Dialog::New) => NEW_TREE.with(Some(path)),
        _ => OPEN.with(Open::File(path)),
    }
}

/// The commands for all paths that were chosen in a dialog. Several are opened as those that are dropped together.
pub(in crate::app) fn all_chosen(state: &State, dialog: Option<Dialog>, mut paths: Vec<PathBuf>) -> Vec<Command> {
    if paths.len() > 1 {
        return dropped(state, paths, dialog == Some(Dialog::Beside));
    }
    paths.pop().map(|path| chosen(dialog, path)).into_iter().collect()
}

/// Shows a file dialog on a thread.
pub(super) fn choose(state: &mut State, engine: &mut Engine, dialog: Dialog) -> Outcome {
    if state.choosing.is_some() {
        return Err("The file dialog is already open".to_owned());
    }
    state.choosing = Some(dialog);
    engine.threads.wait(move || Some(Message::Chosen(dialog::choose(dialog))));
    Ok(Until::DONE)
}

fn open(state: &mut State, engine: &mut Engine, what: Open) -> Outcome {
    Ok(match what {
        Open::File(path) => return open(state, engine, by_kind(path)?),
        Open::Model(path) => {
            let (wanted, scene) = state.wanted_model();
            let scene = scene.filter(|_| wanted.as_ref() == Some(&path));
            leave_single_file(state, engine);
            load_models(state, engine, (Some(path.clone()), scene), Vec::new());
            Until::Model(path)
        }
        Open::Beside(path) => {
            let (first, mut added) = wanted_models(state);
            if added.len() == MOST_ADDED {
                return Err(format!("{} models are shown already, and no more can be", MOST_ADDED + 1));
            }
            added.push(AddedModel::new(&path.display().to_string()));
            leave_single_file(state, engine);
            return Ok(show_models(state, engine, first, added));
        }
        Open::Environment(path) => {
            let before = state.session.shared_settings();
            state.session.settings.environment.name = path.display().to_string();
            begin_reading(state, &before);
            Until::SHOWN
        }
        Open::Tree(path) => {
            // The expression names a file of the tree before.
            state.edits.stops_watching = true;
            find_tree(state, engine, &path);
            Until::Tree(path)
        }
        Open::Look(path) => {
            engine.threads.wait(move || Some(Message::Look(read_checked_look(&path).map(Box::new))));
            Until::Look
        }
        Open::Measured(path) => {
            let before = state.session.shared_settings();
            state.session.settings.measured = path.display().to_string();
            state.session.settings.mode = "measured".into();
            begin_reading(state, &before);
            Until::SHOWN
        }
    })
}

/// How to open a file or folder.
///
/// # Errors
/// A message, if the window cannot open this kind of file.
fn by_kind(path: PathBuf) -> Result<Open, String> {
    match FileKind::of(&path) {
        FileKind::ShaderTree => Ok(Open::Tree(path)),
        FileKind::Model => Ok(Open::Model(path)),
        FileKind::Environment => Ok(Open::Environment(path)),
        FileKind::Measured => Ok(Open::Measured(path)),
        FileKind::Folder => match find_model(&path) {
            Ok(model) => Ok(Open::Model(model)),
            Err(Problem::NoModel) => Err(format!(
                "{} has no interface.glsl, so it is no Specula shader tree, and no model. `specula new DIR` writes a tree",
                path.display()
            )),
            Err(problem) => Err(format!("{} {problem}", path.display())),
        },
        FileKind::Shader if Source::is_file(&path) => Ok(Open::Tree(path)),
        FileKind::Look => Ok(Open::Look(path)),
        FileKind::Shader | FileKind::Other => Err(format!(
            "{}: expected a model (.gltf, .glb or a .zip with one), an .hdr or .exr environment, a measured .binary or .bin, a look file (.toml or \
             a .png that Specula wrote), or a folder with a shader tree",
            path.display()
        )),
    }
}

type Kind = fn(PathBuf) -> Open;

/// The field that names each kind.
const KINDS: [(&str, Kind); 7] = [
    ("file", Open::File),
    ("model", Open::Model),
    ("beside", Open::Beside),
    ("environment", Open::Environment),
    ("tree", Open::Tree),
    ("look", Open::Look),
    ("measured", Open::Measured),
];

fn parse(about: &About, fields: Fields) -> Result<Open, String> {
    let mut given = fields.iter();
    let (Some((field, serde_json::Value::String(path))), None) = (given.next(), given.next()) else {
        return Err(needs(about));
    };
    let kind = KINDS.iter().find(|(name, _)| name == field).ok_or_else(|| {
        let hint = did_you_mean(field, KINDS.iter().map(|(name, _)| *name));
        format!("`open` has no field `{field}`.{hint} It takes {}", about.takes.unwrap_or_default())
    })?;
    let is_known = |path: &Path| BUILT_IN.iter().any(|name| Path::new(name) == path) || path.exists();
    match kind.1(PathBuf::from(path)) {
        Open::Model(path) | Open::Beside(path) if !is_known(&path) => {
            let hint = did_you_mean(&path.to_string_lossy(), BUILT_IN);
            Err(format!("{}: there is no such file, and no built-in model of this name.{hint}", path.display()))
        }
        open => Ok(open),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    /// The commands for files that are dropped together.
    fn drop_all(names: &[&str]) -> Vec<Command> {
        let state = State::new(Settings::of_window(), Source::embedded());
        dropped(&state, names.iter().map(PathBuf::from).collect(), false)
    }

    fn open(name: &str) -> Command {
        OPEN.with(Open::File(name.into()))
    }

    #[test]
    fn what_belongs_to_a_dropped_model_is_not_opened_by_itself() {
        let helmet = ["FlightHelmet.bin", "a.png", "FlightHelmet.gltf", "b.jpg", "notes.txt"];
        assert_eq!(drop_all(&helmet), [open("FlightHelmet.gltf")]);
        assert_eq!(drop_all(&["a.glb", "sky.hdr", "look.toml"])[..2], [open("a.glb"), open("sky.hdr")]);
        let told = SAY.with("Not opened: b.hdr and 1 more. Open one file of a kind at a time".to_owned());
        assert_eq!(drop_all(&["a.hdr", "b.hdr", "c.hdr"]), [open("a.hdr"), told]);
        assert_eq!(drop_all(&["a.bin"]), [open("a.bin")]);
    }

    #[test]
    fn models_that_are_dropped_together_stand_side_by_side() {
        let beside = |name: &str| OPEN.with(Open::Beside(name.into()));
        assert_eq!(drop_all(&["a.glb", "a.bin", "b.glb", "c.zip"]), [open("a.glb"), beside("b.glb"), beside("c.zip")]);
        let state = State::new(Settings::of_window(), Source::embedded());
        let added = |names: &[&str]| dropped(&state, names.iter().map(PathBuf::from).collect(), true);
        assert_eq!(added(&["a.glb"]), [beside("a.glb")]);
        assert_eq!(added(&["a.glb", "sky.hdr", "b.glb"]), [beside("a.glb"), open("sky.hdr"), beside("b.glb")]);
        assert_eq!(added(&["sky.hdr"]), [open("sky.hdr")]);
    }

    #[test]
    fn files_that_are_chosen_together_open_as_those_that_are_dropped_together() {
        let state = State::new(Settings::of_window(), Source::embedded());
        let choose =
            |dialog, names: &[&str]| all_chosen(&state, Some(dialog), names.iter().map(PathBuf::from).collect());
        let beside = |name: &str| OPEN.with(Open::Beside(name.into()));
        assert_eq!(choose(Dialog::File, &[]), []);
        assert_eq!(choose(Dialog::File, &["a.glb"]), [open("a.glb")]);
        assert_eq!(
            choose(Dialog::File, &["a.gltf", "a.bin", "b.glb", "c.hdr"]),
            drop_all(&["a.gltf", "b.glb", "c.hdr"])
        );
        assert_eq!(choose(Dialog::Beside, &["a.glb"]), [beside("a.glb")]);
        assert_eq!(choose(Dialog::Beside, &["a.glb", "b.glb"]), [beside("a.glb"), beside("b.glb")]);
    }

    #[test]
    fn a_folder_with_one_model_is_that_model() {
        let folder = tempfile::tempdir().unwrap();
        let kind = || by_kind(folder.path().to_owned());
        assert!(kind().unwrap_err().contains("no interface.glsl"));
        let model = folder.path().join("a.glb");
        std::fs::write(&model, "").unwrap();
        assert!(matches!(kind(), Ok(Open::Model(path)) if path == model));
        std::fs::write(folder.path().join("b.gltf"), "").unwrap();
        assert!(kind().unwrap_err().contains("has 2 models"));
    }
}
