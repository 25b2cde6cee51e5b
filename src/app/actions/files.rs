//! Opens files: models, shader trees, and any file in the user's editor.

use crate::app::actions::work::keep_session;
use crate::app::editor::{self, Place};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::recent::Kind;
use crate::app::state::workspace::PanelRequest;
use crate::settings::{AddedModel, Settings};
use crate::shader::{BUILT_IN, Change, TreePath};
use crate::threads::Message;
use std::path::Path;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Loads a model, with the models beside it. What is on screen stays until all are ready. A model alone whose images take long to decode
/// is shown without them before; not so the one on screen, since that would lose its textures.
pub(in crate::app) fn load_model(state: &mut State, engine: &mut Engine, path: Option<PathBuf>) {
    let is_early = state.session.model().is_none() || state.model.path != path;
    engine.threads.loader.load(path.clone(), state.load_options.clone(), is_early);
    begin_loading(state, path);
}

/// Loads a scene of a model with these beside it. If it can be loaded, the settings have these from then on.
pub(in crate::app) fn load_models(
    state: &mut State,
    engine: &mut Engine,
    (first, scene): (Option<PathBuf>, Option<usize>),
    added: Vec<AddedModel>,
) {
    state.load_options.scene = scene;
    state.load_options.added = added.iter().map(|model| model.file.clone()).collect();
    state.model.added = Some(added);
    load_model(state, engine, first);
}

/// The first of the models that are shown, or that are being loaded, with its scene, and those beside it.
pub(in crate::app) fn wanted_models(state: &State) -> ((Option<PathBuf>, Option<usize>), Vec<AddedModel>) {
    let (path, scene) = state.wanted_model();
    let added = state.model.added.as_ref().unwrap_or(&state.session.settings.added);
    ((path.clone(), scene), added.clone())
}

/// Loads the models that the settings have beside the first, if others were asked for: an undo, a look or a session has changed them.
pub(in crate::app) fn follow_added(state: &mut State, engine: &mut Engine) {
    let wanted = state.session.settings.added.iter().map(|model| &model.file);
    if state.model.added.is_none() && !wanted.eq(&state.load_options.added) {
        state.load_options.added = state.session.settings.added_files();
        let ((first, scene), _) = wanted_models(state);
        state.load_options.scene = scene;
        load_model(state, engine, first);
    }
}

/// Notes that the model of `path` is being loaded, and watches the file while it is read.
pub(in crate::app) fn begin_loading(state: &mut State, path: Option<PathBuf>) {
    let more = path.iter().filter_map(|path| std::path::absolute(path).ok());
    state.model.files = state.model.files.iter().cloned().chain(more).collect();
    state.model.requested = path;
    state.model.loading = true;
}

/// Notes the files that the settings name and `before` does not. They are read before the next frame is final.
pub(in crate::app) fn begin_reading(state: &mut State, before: &Arc<Settings>) {
    let picture = &mut state.picture;
    picture.shows_settings &= !state.opened.begin(before, &state.session.settings, picture.shows_settings);
}

/// Compiles everything again. A build that failed, for example without memory, is tried again.
pub(in crate::app) fn reload(state: &mut State, engine: &mut Engine) {
    engine.threads.worker.built();
    state.shader.compiling = true;
    engine.threads.worker.change(Change::All, Instant::now());
}

/// Shows the shaders of the tree at a path, once it is found to be one. If it is none, for example because a look names one that is
/// gone, the present tree stays with its versions.
pub(in crate::app) fn find_tree(state: &mut State, engine: &mut Engine, path: &Path) {
    keep_session(state, engine);
    state.shader.compiling = true;
    engine.threads.worker.find_tree(path.to_owned());
}

/// Shows the tree of before, or the built-in one, if a single file is on screen, which draws no model.
pub(in crate::app) fn leave_single_file(state: &mut State, engine: &mut Engine) {
    if !state.shader.is_single_file {
        return;
    }
    let file = Path::new(&state.shader.tree).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let tree = state.shader.last_tree.clone();
    let shaders = tree.as_ref().map_or_else(
        || "the built-in shaders".to_owned(),
        |tree| format!("the shaders of {}", Kind::Tree.name_of(tree)),
    );
    state.say(format!("{file} draws no model. Back to {shaders}"));
    state.edits.stops_watching = true;
    find_tree(state, engine, tree.as_deref().unwrap_or(Path::new(BUILT_IN)));
}

/// Opens a file or folder in the user's editor. If there is none, the panel Source shows a file of the shaders.
///
/// # Errors
/// A message: there is no editor, and no stage has the file.
pub(in crate::app) fn edit(state: &mut State, engine: &Engine, place: &Place) -> Result<(), String> {
    let editor = match editor::open(place) {
        Ok(editor) => editor,
        Err(message) => {
            let shaders = state.session.shaders.as_ref();
            let is_shown = |path: &TreePath| shaders.is_some_and(|shaders| shaders.texts.contains_key(path));
            let Some(file) = state.source.changed(&place.file).into_iter().find(is_shown) else { return Err(message) };
            state.traces.seeks = place.line.map(|line| (file.clone(), line));
            state.traces.file = Some(file);
            state.workspace.request_in_sight(PanelRequest::Open(Panel::SOURCE));
            state.say(format!("The panel Source shows the file: {message}"));
            return Ok(());
        }
    };
    engine.threads.wait(|| editor.failure().map(Message::Say));
    Ok(())
}
