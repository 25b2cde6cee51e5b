//! Commands that open files and folders.

use std::path::{Path, PathBuf};

use super::about::{About, Group};
use super::compare::{COMPARE, CompareFields};
use super::fields::{Fields, needs};
use super::shortcut::Shortcut;
use super::spec::{Command, Outcome, Spec, Until};
use crate::app::actions::files::{edit, find_tree, load_model};
use crate::app::actions::sessions::restore_session;
use crate::app::dialog;
use crate::app::editor::Place;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::dialog::Dialog;
use crate::app::state::workspace::PanelRequest;
use crate::file_kind::FileKind;
use crate::message::did_you_mean;
use crate::picture::read_checked_look;
use crate::scene::BUILT_IN;
use crate::shader::Source;
use crate::threads::Message;

/// A path and what to open it as.
#[derive(Clone, Debug)]
pub(in crate::app) enum Open {
    /// By the kind of the file.
    File(PathBuf),
    Model(PathBuf),
    Environment(PathBuf),
    Tree(PathBuf),
    Look(PathBuf),
    Measured(PathBuf),
}

pub(in crate::app) static OPEN: Spec<Open> = Spec::new("open", open).parsed(
    r#""file" | "model" | "environment" | "tree" | "look" | "measured": "path or name""#,
    "Opens a file or folder. Done when its final picture is on screen",
    parse,
);

pub(in crate::app) static SHOW_GALLERY: Spec<()> =
    Spec::plain("gallery", |state, _, ()| state.workspace.request(PanelRequest::ShowGallery))
        .label("Open the gallery", "built-in models environments pictures browse");

pub(in crate::app) static RESTORE_SESSION: Spec<()> =
    Spec::plain("restore-session", |state, engine, ()| restore_session(state, engine))
        .label("Restore the last session", "continue");

/// Whether later windows go on with the last session by themselves.
pub(in crate::app) static RESTORE_ALWAYS: Spec<bool> =
    Spec::act("restore-always", |state, _, always| state.last_sessions.set_always(always));

/// Offers the last session no longer.
pub(in crate::app) static REFUSE_SESSION: Spec<()> =
    Spec::plain("refuse-session", |state, _, ()| state.offers_session = false);

/// Opens what the user chooses in the file dialog.
pub(in crate::app) static CHOOSE: Spec<Dialog> = Spec::new("choose", choose)
    .arguments(|_| Dialog::File)
    .label("Open a file", "model environment shader measured BRDF")
    .shortcuts(Group::Program, &[Shortcut::key('o').ctrl()], "open a model, an environment or a shader");

pub(in crate::app) static CHOOSE_TREE: Spec<()> =
    Spec::fallible("choose-tree", |state, engine, ()| choose(state, engine, Dialog::Tree))
        .label("Open a shader tree", "folder");

/// Writes the built-in shaders to a folder, or to one that the user chooses, and opens them.
pub(in crate::app) static NEW_TREE: Spec<Option<PathBuf>> = Spec::new("new-tree", |state, engine, folder| {
    ask(state, engine, Dialog::New, move || Message::NewTree(dialog::write_tree(folder)))
});

/// Opens a file or folder in the user's editor.
pub(in crate::app) static EDIT: Spec<Place> =
    Spec::new("edit", |_, engine, place: Place| edit(engine, &place).map(|()| Until::DONE));

/// The command for a file or folder that was dropped on the window. While pictures are compared, another picture takes part.
pub(in crate::app) fn dropped(state: &State, path: PathBuf) -> Command {
    match state.compare.takes(&path) {
        true => COMPARE.with(CompareFields::file(path)),
        false => OPEN.with(Open::File(path)),
    }
}

/// The command for a path that was chosen in a dialog.
pub(in crate::app) fn chosen(dialog: Option<Dialog>, path: PathBuf) -> Command {
    match dialog {
        Some(Dialog::Picture) => COMPARE.with(CompareFields::file(path)),
        Some(Dialog::SecondTree) => COMPARE.with(CompareFields::tree(path)),
        _ => OPEN.with(Open::File(path)),
    }
}

fn choose(state: &mut State, engine: &mut Engine, dialog: Dialog) -> Outcome {
    ask(state, engine, dialog, move || Message::Chosen(dialog::choose(dialog)))
}

/// Shows a file dialog on a thread.
fn ask(
    state: &mut State,
    engine: &mut Engine,
    dialog: Dialog,
    answer: impl FnOnce() -> Message + Send + 'static,
) -> Outcome {
    if state.choosing.is_some() {
        return Err("The file dialog is already open".to_owned());
    }
    state.choosing = Some(dialog);
    engine.threads.wait(move || Some(answer()));
    Ok(Until::DONE)
}

fn open(state: &mut State, engine: &mut Engine, what: Open) -> Outcome {
    Ok(match what {
        Open::File(path) => return open(state, engine, by_kind(path)?),
        Open::Model(path) => {
            load_model(state, engine, Some(path.clone()));
            Until::Model(path)
        }
        Open::Environment(path) => {
            state.session.settings.environment.name = path.display().to_string();
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
            state.session.settings.measured = path.display().to_string();
            state.session.settings.mode = "measured".into();
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
        FileKind::Folder => Err(format!(
            "{} is no Specula shader tree: it has no interface.glsl. `specula new DIR` writes one",
            path.display()
        )),
        FileKind::Shader if Source::is_file(&path) => Ok(Open::Tree(path)),
        FileKind::Look => Ok(Open::Look(path)),
        FileKind::Shader | FileKind::Other => Err(format!(
            "{}: expected a .gltf or .glb model, an .hdr or .exr environment, a measured .binary or .bin, a look file (.toml or \
             a .png that Specula wrote), or a folder with a shader tree",
            path.display()
        )),
    }
}

type Kind = fn(PathBuf) -> Open;

/// The field that names each kind.
const KINDS: [(&str, Kind); 6] = [
    ("file", Open::File),
    ("model", Open::Model),
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
        Open::Model(path) if !is_known(&path) => {
            let hint = did_you_mean(&path.to_string_lossy(), BUILT_IN);
            Err(format!("{}: there is no such file, and no built-in model of this name.{hint}", path.display()))
        }
        open => Ok(open),
    }
}
