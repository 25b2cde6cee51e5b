//! The state of the window, in stores without objects of the user interface, of the window system or of the device. Each store keeps one
//! invariant and has its own tests. Stores know neither the engine nor panels.

pub(super) mod adaptive;
pub(super) mod arrangement;
pub(super) mod captures;
pub(super) mod checks;
pub(super) mod compare;
pub(super) mod costs;
pub(super) mod dialog;
pub(super) mod exercise;
pub(super) mod grid;
pub(super) mod guests;
pub(super) mod hint;
pub(super) mod history;
pub(super) mod inspection;
pub(super) mod last_session;
pub(super) mod listing;
pub(super) mod model;
pub(super) mod notices;
pub(super) mod opened;
pub(super) mod picture;
pub(super) mod picture_subject;
pub(super) mod playback;
pub(super) mod recent;
mod resting;
pub(super) mod selection;
pub(super) mod shaders;
mod shown_version;
pub(super) mod text_writes;
pub(super) mod timing;
pub(super) mod trace;
pub(super) mod waiting;
pub(super) mod waits;
pub(super) mod watched_files;
pub(super) mod window_size;
pub(super) mod workspace;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use crate::control::Clients;
use crate::events::{Event, ReloadEvent, SelectedEvent, emit};
use crate::frame::{FrameState, Scene};
use crate::message;
use crate::recovery::SessionState;
use crate::render::NotFinitePixels;
use crate::scene::LoadOptions;
use crate::session::Session;
use crate::settings::{EnvironmentSettings, LightSource, Settings};
use crate::shader::expression;
use crate::shader::rewrite::{Edit, defaults};
use crate::shader::{Diagnostic, Severity, Source};
use adaptive::Previews;
use captures::Captures;
use checks::Checks;
use compare::Compare;
use costs::Costs;
use dialog::Dialog;
use exercise::Learning;
use grid::Grid;
use guests::Guests;
use hint::Hint;
use history::History;
use inspection::Inspection;
use last_session::LastSessions;
use listing::Listing;
use model::ModelStatus;
use notices::Notices;
use opened::Opened;
use picture::Picture;
use playback::Playback;
use recent::Recent;
use selection::{Selected, name_or};
use shaders::edits::{Edits, Texts};
use shaders::stages::StageTable;
use shaders::status::ShaderStatus;
use shaders::versions::Versions;
use text_writes::TextWrites;
use timing::Timing;
use trace::Traces;
use waiting::Waiting;
use watched_files::WatchedFiles;
use workspace::Workspace;

/// A loop that did not end.
pub(super) struct EndlessLoop {
    pub(super) words: [u32; 2],
    /// `None` until its line has been found.
    pub(super) diagnostic: Option<Diagnostic>,
}

/// A reload whose first frame has not finished.
pub(super) struct FirstFrame {
    pub(super) generation: u64,
    pub(super) event: ReloadEvent,
}

/// The stores of the window. Nothing in it needs the device, so panels are tested over it.
pub(super) struct State {
    pub(super) session: Session,
    /// Whether somebody sees the picture in a window.
    pub(super) has_window: bool,
    pub(super) workspace: Workspace,
    /// The picture on screen.
    pub(super) picture: Picture,
    /// Previews of it, while it moves.
    pub(super) previews: Previews,
    pub(super) shader: ShaderStatus,
    pub(super) model: ModelStatus,
    pub(super) notices: Notices,
    /// Those who get events.
    pub(super) events: Clients,
    /// Commands that are not done yet.
    pub(super) waiting: Waiting<Self>,
    pub(super) captures: Captures,
    /// The number of the client whose command is being carried out.
    pub(super) asking: u64,
    /// The start of the program.
    pub(super) start: Instant,
    /// The time of animated shaders.
    pub(super) playback: Playback,
    pub(super) history: History,
    /// The inspected pixel.
    pub(super) inspection: Inspection,
    /// The traces of the inspected pixel.
    pub(super) traces: Traces,
    /// Traces for other programs.
    pub(super) guests: Guests,
    /// The checks of the picture.
    pub(super) checks: Checks,
    /// Times that are measured while the picture rests.
    pub(super) costs: Costs,
    /// The modes that the picture shows side by side.
    pub(super) grid: Grid,
    /// Files that were open, in this run and before.
    pub(super) recent: Recent,
    pub(super) last_sessions: LastSessions,
    pub(super) hint: Hint,
    /// The exercise that is open.
    pub(super) learning: Learning,
    /// Selected item of the scene.
    pub(super) selected: Selected,
    /// The selected instances of a scene.
    pub(super) selected_cache: Option<(Selected, Scene, Arc<[bool]>)>,
    /// Whether the user has not said which lights shine, so that a model with lights shines by its own.
    pub(super) follows_lights: bool,
    /// The lights that the last model was shown with because of that.
    pub(super) followed_source: LightSource,
    /// The same of the environment.
    pub(super) follows_environment: bool,
    /// The environment that the last model was shown in because of that.
    pub(super) followed_environment: String,
    /// The picture that the user compares with.
    pub(super) compare: Compare,
    pub(super) watched: WatchedFiles,
    pub(super) load_options: LoadOptions,
    /// The versions of the shaders that were on screen.
    pub(super) versions: Versions,
    pub(super) edits: Edits,
    pub(super) text_writes: TextWrites,
    /// The times of the last frames.
    pub(super) timing: Timing,
    /// The stages of the shaders on screen.
    pub(super) stages: StageTable,
    pub(super) first_frame: Option<FirstFrame>,
    /// Whether the names in the settings were compared with those that the shaders declare.
    pub(super) names_checked: bool,
    /// The loop that did not end in the last picture.
    pub(super) endless_loop: Option<EndlessLoop>,
    /// The shader tree.
    pub(super) source: Source,
    pub(super) ready: bool,
    /// The message about a lack of memory.
    pub(super) shortage: Option<String>,
    /// The work of a plain start, if this was one.
    pub(super) plain: Option<SessionState>,
    /// Whether the last session is offered over the picture.
    pub(super) offers_session: bool,
    /// The file dialog that is open.
    pub(super) choosing: Option<Dialog>,
    /// The folder that the command palette lists.
    pub(super) listing: Listing,
    /// Files that are opened and not read yet.
    pub(super) opened: Opened,
    pub(super) screenshot: bool,
    /// Whether the window closes.
    pub(super) quit: bool,
    /// Whether the user has asked for that. Then unsaved text may keep the window open.
    pub(super) quits_by_hand: bool,
    /// The name of the device and its version of Vulkan.
    pub(super) device: String,
    /// Whether the driver tells statistics of its code.
    pub(super) tells_statistics: bool,
}

impl State {
    /// A window that has shown nothing yet, and that remembers no earlier one.
    pub(in crate::app) fn new(settings: Settings, source: Source) -> Self {
        let session = Session::new(settings);
        Self {
            edits: Edits::new(&session.settings.expression),
            session,
            has_window: true,
            workspace: Workspace::default(),
            picture: Picture::default(),
            previews: Previews::default(),
            shader: ShaderStatus { compiling: true, ..Default::default() },
            model: ModelStatus::default(),
            notices: Notices::default(),
            events: Clients::default(),
            waiting: Waiting::default(),
            captures: Captures::default(),
            asking: 0,
            start: Instant::now(),
            playback: Playback::default(),
            history: History::default(),
            inspection: Inspection::default(),
            traces: Traces::default(),
            guests: Guests::default(),
            checks: Checks::default(),
            costs: Costs::default(),
            grid: Grid::default(),
            recent: Recent::default(),
            last_sessions: LastSessions::default(),
            hint: Hint::default(),
            learning: Learning::default(),
            selected: Selected::Nothing,
            selected_cache: None,
            follows_lights: false,
            followed_source: LightSource::default(),
            follows_environment: false,
            followed_environment: EnvironmentSettings::default().name,
            compare: Compare::default(),
            watched: WatchedFiles::default(),
            load_options: LoadOptions::default(),
            versions: Versions::default(),
            text_writes: TextWrites::default(),
            timing: Timing::default(),
            stages: StageTable::default(),
            first_frame: None,
            names_checked: false,
            endless_loop: None,
            source,
            ready: false,
            shortage: None,
            plain: None,
            offers_session: false,
            choosing: None,
            listing: Listing::default(),
            opened: Opened::default(),
            screenshot: false,
            quit: false,
            quits_by_hand: false,
            device: String::new(),
            tells_statistics: false,
        }
    }

    /// Whether a shader of the picture reads keys.
    pub(in crate::app) fn reads_keys(&self) -> bool {
        self.picture.shown.as_ref().is_some_and(|shown| shown.reads_keys)
    }

    /// Whether a shader of the picture, or a pass that is drawn, reads the time or what it drew before, or the model has an animation.
    pub(in crate::app) fn is_animated(&self) -> bool {
        self.picture.shown.as_ref().is_some_and(|shown| shown.is_animated)
    }

    /// Whether to measure the next frame, because it is the first of a shader generation or of the model.
    pub(in crate::app) fn times_next_frame(&self) -> bool {
        self.first_frame.is_some() || (!self.ready && self.session.model().is_some())
    }

    /// Removes the diagnostic of a loop that did not end: in the current picture, all loops end.
    pub(in crate::app) fn all_loops_end(&mut self) {
        if let Some(EndlessLoop { diagnostic: Some(ended), .. }) = self.endless_loop.take() {
            self.session.diagnostics.retain(|diagnostic| *diagnostic != ended);
        }
    }

    /// Whether a loop that did not end has cut the picture on screen short, so that it is not the last good one.
    pub(in crate::app) fn is_cut_short(&self) -> bool {
        self.endless_loop.as_ref().is_some_and(|endless| endless.diagnostic.is_some())
    }

    /// Shows the diagnostics of a reload after the diagnostic of a loop that did not end.
    pub(in crate::app) fn set_diagnostics(&mut self, of_reload: Vec<Diagnostic>) {
        let of_loop = self.endless_loop.iter().filter_map(|endless| endless.diagnostic.clone());
        self.session.diagnostics = of_loop.chain(of_reload).collect();
    }

    /// Shows a message for a few seconds.
    pub(in crate::app) fn say(&mut self, text: impl Into<String>) {
        let text = text.into();
        message::tell(&text);
        emit(&self.events, &Event::Message { message: &text });
        self.notices.say(text);
    }

    /// Shows a failure until the user dismisses it.
    pub(in crate::app) fn keep_saying(&mut self, text: String) {
        if self.notices.keep(text.clone()) {
            emit(&self.events, &Event::Failure { message: &text });
            message::tell(text);
        }
    }

    /// Moves the camera so that it sees the whole model.
    pub(in crate::app) fn frame_model(&mut self) {
        self.session.settings.camera.frame_model();
    }

    /// Moves the orbiting lights by `seconds`.
    pub(in crate::app) fn turn_lights(&mut self, seconds: f32) {
        let lights = &mut self.session.settings.lights;
        if lights.spin == 0.0 {
            return;
        }
        for light in &mut lights.orbit {
            light.azimuth = (light.azimuth + lights.spin * seconds + 180.0).rem_euclid(360.0) - 180.0;
        }
    }

    /// The generation of the shaders on screen.
    pub(in crate::app) fn shown_generation(&self) -> u64 {
        self.shown().map_or(0, |shown| shown.shaders.generation)
    }

    /// The number of the version before that on screen.
    pub(in crate::app) fn version_before(&self) -> Option<u64> {
        self.versions.before(self.shown_generation()).map(|version| version.number)
    }

    /// The pixels with NaN or infinity of the picture on screen.
    pub(in crate::app) fn shown_not_finite(&self) -> Option<NotFinitePixels> {
        let (generation, pixels) = self.picture.not_finite?;
        (generation == self.shown_generation() && pixels.count > 0).then_some(pixels)
    }

    /// Whether the tree is a folder or a file on disk, so that it can be written.
    pub(in crate::app) fn has_files(&self) -> bool {
        self.source.location().is_some()
    }

    /// Whether the shaders in use are those of the open tree, which may still be compiled, or not compile.
    pub(in crate::app) fn is_tree_in_use(&self) -> bool {
        self.shader.in_use.as_deref() == self.source.location()
    }

    /// The state of the picture on screen.
    pub(in crate::app) fn shown(&self) -> Option<&FrameState> {
        self.picture.shown.as_ref().map(|shown| &*shown.state)
    }

    /// The texts of the files, as they were last compiled; `None` without shaders.
    pub(in crate::app) fn texts_of_files(&self) -> Option<Texts> {
        if let Some(restored) = &self.edits.restored {
            return Some(restored.files.clone());
        }
        let mut texts = self.session.shaders.as_ref()?.texts.clone();
        texts.extend(self.edits.draft.as_ref().map(|draft| (draft.path.clone(), draft.base.clone())));
        Some(texts)
    }

    /// The edits that would make the values of the settings defaults, or that of `only` one name; or why there are none.
    pub(in crate::app) fn edits_of_defaults(&self, only: Option<&str>) -> Result<Vec<Edit>, String> {
        let Some(shaders) = &self.session.shaders else { return Ok(Vec::new()) };
        defaults(shaders, &self.session.settings.shader, only, |path| self.source.display_path(path))
    }

    /// The files that differ from a version, with its text of each. Empty for a tree without a folder.
    pub(in crate::app) fn files_of_version(&self, number: u64) -> Vec<(PathBuf, Arc<str>)> {
        let all = self.source.root().zip(self.versions.get(number)).zip(self.texts_of_files());
        let Some(((root, version), files)) = all else { return Vec::new() };
        let texts = version.shaders.texts.iter().filter(|(path, text)| files.get(*path) != Some(*text));
        texts.map(|(path, text)| (root.join(path.as_str()), text.clone())).collect()
    }

    /// Whether each instance of the scene on screen is selected, as the last frame has found; empty if none is.
    pub(in crate::app) fn selected_instances(&self) -> Arc<[bool]> {
        self.selected_cache.as_ref().map(|(.., instances)| instances.clone()).unwrap_or_default()
    }

    /// Selects a part of the scene, and prints an event.
    pub(in crate::app) fn select(&mut self, selected: Selected) {
        if std::mem::replace(&mut self.selected, selected) == selected {
            return;
        }
        let event = self.selected_event();
        event.into_iter().for_each(|event| emit(&self.events, &Event::Selected(event)));
    }

    /// The selection by its names; `None` without a model.
    pub(in crate::app) fn selected_event(&self) -> Option<SelectedEvent> {
        let selected = self.selected;
        let scene = self.session.scene()?;
        let model = scene.model();
        let instance = match selected {
            Selected::Instance(instance) => model.instances.get(instance),
            _ => None,
        };
        let node = match selected {
            Selected::Node(node) => model.nodes.get(node),
            _ => instance.and_then(|instance| model.nodes.get(model.node_of(instance)?)),
        };
        let material = selected.material(&scene).map(|material| model.material_key(material));
        Some(SelectedEvent {
            instance: match selected {
                Selected::Instance(index) => instance.map(|_| index),
                _ => None,
            },
            node: node.map(|node| name_or(&node.name, || format!("#{}", node.index))),
            primitive: instance.map(|instance| model.primitives[instance.primitive].name.clone()),
            material,
        })
    }

    /// Ends everything that draws or writes a picture.
    pub(in crate::app) fn cancel_captures(&mut self) {
        self.waiting.cancel_captures();
        self.captures.cancel();
    }

    /// The first model that is shown or being loaded, and its scene.
    pub(in crate::app) fn wanted_model(&self) -> (&Option<PathBuf>, Option<usize>) {
        match self.model.loading {
            true => (&self.model.requested, self.load_options.scene),
            false => (&self.model.path, self.model.scene),
        }
    }

    /// The settings, the model and the shader tree.
    pub(in crate::app) fn session_state(&self) -> SessionState {
        let (model, scene) = self.wanted_model();
        let tree = self.source.location().map(Path::to_owned);
        SessionState { settings: self.session.shared_settings(), model: model.clone(), scene, tree }
    }

    /// A few words if the model on screen lacks its textures.
    pub(in crate::app) fn missing_textures(&self) -> Option<&'static str> {
        self.session.model().filter(|model| model.awaits_textures)?;
        Some(if self.model.loading { "textures are being decoded" } else { "textures are missing" })
    }

    /// Whether the shaders have errors.
    pub(in crate::app) fn has_errors(&self) -> bool {
        self.errors().next().is_some()
    }

    /// The errors of the shaders.
    pub(in crate::app) fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.session.diagnostics.iter().filter(|found| found.severity == Severity::Error)
    }

    /// Why the watched expression cannot be shown, while its mode is selected.
    pub(in crate::app) fn shown_expression_error(&self) -> Option<&Diagnostic> {
        let shaders = self.session.shaders.as_ref().filter(|_| self.session.settings.mode == expression::MODE)?;
        shaders.expression_error()
    }
}
