//! The state of the window's thread: session, resources and the last complete picture. No other thread uses them.

mod compare;
mod edits;
mod execute;
mod inspect;
mod learning;
mod loaded;
mod messages;
mod picture;
mod recording;
mod restored;
mod select;
mod session;
mod stages;
mod tools;

use std::sync::Arc;
use std::time::Instant;

use super::control::Controlled;
use super::dialog::Dialog;
use super::drawn::compare::Compare;
use super::drawn::generations::Generations;
use super::drawn::last_complete::{LastComplete, target};
use super::drawn::waits::Waits;
use super::options::{AppOptions, Early};
use super::state::exercise::Learning;
use super::state::grid::Grid;
use super::state::hint::Hint;
use super::state::history::History;
use super::state::inspection::Inspection;
use super::state::last_session::LastSessions;
use super::state::model::ModelStatus;
use super::state::notices::Notices;
use super::state::playback::Playback;
use super::state::recent::Recent;
use super::state::selection::Selected;
use super::state::shaders::edits::Edits;
use super::state::shaders::stages::StageTable;
use super::state::shaders::status::ShaderStatus;
use super::state::shaders::versions::Versions;
use super::state::timing::Timing;
use super::state::watched_files::WatchedFiles;
use super::state::workspace::Workspace;
use crate::control::Clients;
use crate::events::{Event, ReloadEvent, emit};
use crate::frame::{Clock, Scene};
use crate::gpu::{Gpu, GpuError, SetLayouts};
use crate::message;
use crate::pipeline::endless_loop;
use crate::recovery::{Recorder, SessionState};
use crate::render::tools::Tools;
use crate::render::{BoundFrame, Resources};
use crate::session::Session;
use crate::settings::LightSource;
use crate::shader::{Compiler, Diagnostic, Source};
use crate::threads::worker::{Snapshot, Worker};
use crate::threads::{MessageSender, Threads};

/// A loop that did not end.
struct EndlessLoop {
    words: [u32; 2],
    /// `None` until its line has been found.
    diagnostic: Option<Diagnostic>,
}

/// A reload whose first frame has not finished.
struct FirstFrame {
    generation: u64,
    event: ReloadEvent,
}

/// The pipelines of outlines and pictures of textures.
#[derive(Default)]
struct ToolsState {
    made: Option<Arc<Tools>>,
    /// Whether they were asked for.
    is_asked: bool,
}

/// The window's state apart from the screen.
pub(super) struct Viewer {
    pub(super) session: Session,
    pub(super) workspace: Workspace,
    pub(super) shader: ShaderStatus,
    pub(super) model: ModelStatus,
    pub(super) notices: Notices,
    /// Those who get events.
    pub(super) events: Clients,
    pub(super) controlled: Controlled,
    pub(super) start: Instant,
    /// The time of animated shaders.
    pub(super) playback: Playback,
    pub(super) history: History,
    /// The inspected pixel.
    pub(super) inspection: Inspection,
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
    selected_cache: Option<(Selected, Scene, Arc<[bool]>)>,
    /// The pipelines of outlines and pictures of textures, once something has asked for them.
    tools: ToolsState,
    /// Whether the user has not said which lights shine, so that a model with lights shines by its own.
    follows_lights: bool,
    /// The lights that the last model was shown with because of that.
    followed_source: LightSource,
    pub(super) gpu: Arc<Gpu>,
    pub(super) resources: Resources,
    /// Before the threads: dropping it ends the thread of a second shader tree, for which they wait.
    pub(super) compare: Compare,
    /// Dropping the threads waits for those that use the device.
    pub(super) threads: Threads,
    watched: WatchedFiles,
    pub(super) recorder: Recorder,
    allow_outside: bool,
    shown: Option<LastComplete>,
    /// The versions of the shaders that were on screen.
    pub(super) versions: Versions,
    /// Their pipelines and last pictures.
    generations: Generations,
    pub(super) edits: Edits,
    /// The times of the last frames.
    pub(super) timing: Timing,
    /// The stages of the shaders on screen.
    pub(super) stages: StageTable,
    /// The time in the last frame.
    clock: Clock,
    /// Whether nothing was missing for the last frame.
    is_complete: bool,
    /// Whether the last frame showed the settings, and lacked nothing but stages that it does not need.
    shows_settings: bool,
    /// The work that the picture waits for, and since when; `None` when it has everything.
    waits: Option<(Waits, Instant)>,
    first_frame: Option<FirstFrame>,
    /// Whether the names in the settings were compared with those that the shaders declare.
    names_checked: bool,
    /// The shader generation that was last shown with all of its stages and light.
    settled: Option<u64>,
    /// The loop that did not end in the last picture.
    endless_loop: Option<EndlessLoop>,
    pub(super) compiler: Arc<Compiler>,
    /// The shader tree.
    source: Source,
    ready: bool,
    /// The message about a lack of memory.
    shortage: Option<String>,
    /// The work of a plain start, if this was one.
    plain: Option<SessionState>,
    /// Whether the last session is offered over the picture.
    pub(super) offers_session: bool,
    /// The file dialog that is open.
    choosing: Option<Dialog>,
    pub(super) screenshot: bool,
    pub(super) quit: bool,
}

impl Viewer {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        options: AppOptions,
        early: Early,
        sender: &MessageSender,
    ) -> Result<Self, GpuError> {
        let session = Session::new(options.settings);
        let lights = &session.settings.lights;
        let resources = Resources::new(gpu, layouts, lights.ambient_color.map(|c| c * lights.ambient_strength))?;
        let snapshot = Snapshot {
            settings: session.shared_settings(),
            scene: None,
            target: target(gpu, &session.settings),
            suns: session.revisions.suns_of(&session.settings),
        };
        let source = options.source;
        let recorder = options.recorder;
        let worker = Worker::start((gpu, layouts), &options.compiler, source.clone(), snapshot, &recorder, sender);
        let threads = Threads::start((gpu, layouts), &options.compiler, worker, early.watcher, sender);
        let edits = Edits::new(&session.settings.expression);
        let mut viewer = Self {
            session,
            workspace: Workspace::default(),
            shader: ShaderStatus { compiling: true, ..Default::default() },
            model: ModelStatus { path: options.model.clone(), ..Default::default() },
            notices: Notices::default(),
            events: early.events,
            controlled: Controlled::default(),
            start: options.start,
            playback: Playback::default(),
            history: History::default(),
            inspection: Inspection::default(),
            grid: Grid::default(),
            recent: Recent::restored(),
            last_sessions: LastSessions::restored(),
            hint: Hint::restored(),
            learning: Learning::restored(),
            selected: Selected::Nothing,
            selected_cache: None,
            tools: ToolsState::default(),
            follows_lights: options.follows_lights,
            followed_source: LightSource::default(),
            gpu: gpu.clone(),
            resources,
            threads,
            watched: WatchedFiles::default(),
            recorder,
            allow_outside: options.allow_outside,
            shown: None,
            versions: Versions::default(),
            generations: Generations::default(),
            compare: Compare::default(),
            edits,
            timing: Timing::default(),
            stages: StageTable::default(),
            clock: Clock::default(),
            is_complete: false,
            shows_settings: false,
            waits: None,
            first_frame: None,
            names_checked: false,
            settled: None,
            endless_loop: None,
            compiler: options.compiler,
            source: source.clone(),
            ready: false,
            shortage: None,
            offers_session: options.plain.is_some(),
            plain: options.plain,
            choosing: None,
            screenshot: false,
            quit: false,
        };
        viewer.watch_tree(&source);
        viewer.find_exercise();
        viewer.threads.loader.upload(early.reading);
        viewer.begin_loading(options.model);
        viewer.report_loss();
        viewer.compare_at_start(options.compare);
        Ok(viewer)
    }

    /// Whether the next picture differs: the lights orbit, a shader or a pass moves while the time runs, or a key has just been
    /// pressed.
    pub(super) fn moves(&self) -> bool {
        let runs = if self.is_animated() { self.playback.runs() } else { self.playback.ends_press() };
        self.session.settings.lights.spin != 0.0 || runs
    }

    /// Whether a shader of the picture reads keys.
    pub(super) fn reads_keys(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.frame.reads_keys())
    }

    /// Whether a shader of the picture, or a pass that is drawn, reads the time or what it drew before.
    pub(super) fn is_animated(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.frame.is_animated())
    }

    /// Whether the device is faster than the display, so that vertical sync saves work.
    pub(super) fn gpu_is_fast(&self) -> bool {
        self.gpu.info().kind != "cpu"
    }

    /// Whether an edit is being compiled, or has not been drawn. Whatever else there is to draw waits for it.
    pub(super) fn awaits_edit(&self) -> bool {
        self.threads.worker.is_compiling() || self.times_next_frame()
    }

    /// Whether to measure the next frame, because it is the first of a shader generation or of the model.
    pub(super) fn times_next_frame(&self) -> bool {
        self.first_frame.is_some() || (!self.ready && self.session.model().is_some())
    }

    /// Reports the first frame of a reload or of the model. `frame` has finished `ms` milliseconds after it began, and took the
    /// device `device_ms`.
    pub(super) fn frame_done(&mut self, frame: Option<&BoundFrame>, ms: f64, device_ms: Option<f64>) {
        let Some(state) = frame.map(|frame| &frame.state) else { return };
        if let Some(first) = self.first_frame.take_if(|first| first.generation == state.shaders.generation) {
            self.versions.time(first.generation, ms, device_ms);
            self.report(ReloadEvent { first_frame_ms: ms, ..first.event });
            self.threads.worker.shown();
        }
        if !self.ready && state.scene.is_some() {
            self.ready = true;
            let ms = self.start.elapsed().as_secs_f64() * 1e3;
            emit(&self.events, &Event::Ready { device: &self.gpu.info().name, ms });
            // After this build the worker also builds the neighboring modes.
            if let Some(set) = self.resources.pipelines() {
                self.threads.worker.build(set, &state.pipelines);
            }
        }
    }

    /// Looks for the line of a loop that did not end, on another thread. The diagnostic comes as a message.
    pub(super) fn on_endless_loop(&mut self, words: [u32; 2]) {
        let is_known = self.endless_loop.as_ref().is_some_and(|known| known.words == words);
        let Some(shaders) = self.session.shaders.clone().filter(|_| !is_known) else { return };
        self.endless_loop = Some(EndlessLoop { words, diagnostic: None });
        let (gpu, compiler, source) = (self.gpu.clone(), self.compiler.clone(), self.source.clone());
        self.threads.explain(words, move || endless_loop(&gpu, words, &shaders, &compiler, &source));
    }

    /// Removes the diagnostic of a loop that did not end: in the current picture, all loops end.
    pub(super) fn all_loops_end(&mut self) {
        if let Some(EndlessLoop { diagnostic: Some(ended), .. }) = self.endless_loop.take() {
            self.session.diagnostics.retain(|diagnostic| *diagnostic != ended);
        }
    }

    /// Whether a loop that did not end has cut the picture on screen short, so that it is not the last good one.
    pub(super) fn is_cut_short(&self) -> bool {
        self.endless_loop.as_ref().is_some_and(|endless| endless.diagnostic.is_some())
    }

    /// Shows the diagnostics of a reload after the diagnostic of a loop that did not end.
    fn set_diagnostics(&mut self, of_reload: Vec<Diagnostic>) {
        let of_loop = self.endless_loop.iter().filter_map(|endless| endless.diagnostic.clone());
        self.session.diagnostics = of_loop.chain(of_reload).collect();
    }

    /// Shows a message for a few seconds.
    pub(super) fn say(&mut self, text: impl Into<String>) {
        let text = text.into();
        message::tell(&text);
        emit(&self.events, &Event::Message { message: &text });
        self.notices.say(text);
    }

    /// Shows a failure until the user dismisses it.
    fn keep_saying(&mut self, text: String) {
        if self.notices.keep(text.clone()) {
            emit(&self.events, &Event::Failure { message: &text });
            message::tell(text);
        }
    }

    /// Shows a message while memory is short. Returns whether the message changes.
    pub(super) fn set_shortage(&mut self, error: Option<&GpuError>) -> bool {
        let text = error.map(|error| format!("{error}. The last picture stays."));
        if self.shortage == text {
            return false;
        }
        if let Some(old) = std::mem::replace(&mut self.shortage, text.clone()) {
            self.notices.end(&old);
        }
        if let Some(text) = text {
            self.forget_references();
            self.keep_saying(text);
        }
        true
    }

    /// The shader tree.
    pub(super) fn source(&self) -> &Source {
        &self.source
    }

    fn watch_tree(&mut self, source: &Source) {
        if let Err(message) = self.threads.watch_tree(source) {
            self.say(message);
        }
    }

    /// Watches the files of the model, the environment, the measured BRDF and the compared picture.
    pub(super) fn watch_files(&mut self) {
        let session = &self.session;
        let look_up = || session.environment_files().into_iter().chain(session.measured_files()).collect();
        let files = self.watched.changed(&session.settings, &self.model.files, self.compare.files(), look_up);
        if let Some(Err(message)) = files.map(|files| self.threads.watch_files(files)) {
            self.say(message);
        }
    }

    /// Moves the orbiting lights by `seconds`.
    pub(super) fn turn_lights(&mut self, seconds: f32) {
        let lights = &mut self.session.settings.lights;
        if lights.spin == 0.0 {
            return;
        }
        for light in &mut lights.orbit {
            light.azimuth = (light.azimuth + lights.spin * seconds + 180.0).rem_euclid(360.0) - 180.0;
        }
    }
}
