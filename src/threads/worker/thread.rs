//! The worker's thread: takes jobs, compiles edits first, then builds the newest pipeline request.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, bounded};

use super::job::{Build, Edit, Job, Snapshot};
use crate::file_kind::FileKind;
use crate::frame::PipelineRequest;
use crate::gpu::fault;
use crate::message::panic_text;
use crate::pipeline::{Outcome, PipelineSet, Reloader};
use crate::recovery::Recorder;
use crate::settings::Settings;
use crate::shader::annotation::neighbors;
use crate::shader::{Change, Diagnostic, ShaderSet, Source, TreePath, text_hash};
use crate::threads::message::{Message, MessageSender, TaskKind};
use crate::threads::results::WorkerMessage;

/// How many times in a row the thread restarts after a panic.
const RESTARTS: u32 = 3;
/// How long the worker waits for the first frame of a reload.
const LONGEST_FRAME: Duration = Duration::from_secs(2);

/// Joins an edit with an older one that has not been compiled yet.
fn join(old: Option<Edit>, new: Edit) -> Edit {
    match old {
        Some(old) => Edit { change: old.change.and(new.change), since: old.since, ..new },
        None => new,
    }
}

pub(super) struct Thread {
    pub(super) reloader: Reloader,
    pub(super) snapshot: Arc<Mutex<Snapshot>>,
    pub(super) inbox: Receiver<Job>,
    pub(super) edits: Arc<AtomicU64>,
    /// How many of `edits` were taken out of the inbox.
    pub(super) edits_taken: u64,
    /// Whether the first reload has begun.
    pub(super) has_compiled: bool,
    /// Panics since the last completed reload.
    pub(super) panics: u32,
    /// The thumbnails whose pipelines have not been built yet, and their set.
    pub(super) thumbnails: Option<(Arc<PipelineSet>, VecDeque<Arc<PipelineRequest>>)>,
    /// The preview whose pipelines have not been built yet, and its set.
    pub(super) preview: Option<(Arc<PipelineSet>, VecDeque<Arc<PipelineRequest>>)>,
    /// The inspector's modes whose pipelines have not been built yet, and their set.
    pub(super) inspected: Option<(Arc<PipelineSet>, VecDeque<Arc<PipelineRequest>>)>,
    /// The latest build of a thumbnail's pipelines, which may still run.
    pub(super) low_priority: Option<JoinHandle<()>>,
    /// The frame whose pipelines the driver is queried about.
    pub(super) questions: Option<Build>,
    /// Whether the last reload has left stages to [`Thread::finish`].
    pub(super) unfinished: bool,
    /// Whether the first frame of the last reload is on screen. Until then, the driver needs the CPU.
    pub(super) is_shown: bool,
    pub(super) recorder: Recorder,
    pub(super) sender: MessageSender,
}

impl Thread {
    /// Works until the window drops its [`Jobs`]. After a panic the thread starts again with a new reloader.
    pub(super) fn run(&mut self) {
        let mut edit = Some(Edit::new(Change::All, Instant::now()));
        while let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.work(edit.take()))) {
            self.sender.send(Message::Panicked(TaskKind::Worker, panic_text(&*panic).to_owned()));
            self.reloader.restart();
            self.panics += 1;
            // If each attempt panics, wait for the next edit, with which a new reloader compiles the whole tree.
            edit = (self.panics <= RESTARTS).then(|| Edit::new(Change::All, Instant::now()));
        }
        self.join_aside();
    }

    /// First joins and compiles the waiting edits, then builds the newest request, even if an edit has failed.
    fn work(&mut self, mut edit: Option<Edit>) {
        let mut build: Option<Build> = None;
        loop {
            if edit.is_none() && self.has_compiled && !self.unfinished && self.holds_back() {
                // All stages of the last good texts are compiled. Differing texts on disk follow as an edit.
                edit = Some(Edit::new(Change::Paths(BTreeSet::new()), Instant::now()));
            }
            let mut waiting = Vec::new();
            // Nothing to do, or a newer edit has been counted and is about to arrive, or the window is closing.
            let has_more = build.is_some() || (self.unfinished && self.is_shown) || self.has_idle_work();
            if edit.is_none() && (self.is_stale() || !has_more) {
                match self.next_job() {
                    Ok(job) => waiting.push(job),
                    Err(RecvTimeoutError::Timeout) => waiting.push(Job::Shown),
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
            waiting.extend(self.inbox.try_iter());
            for job in waiting {
                self.edits_taken += u64::from(job.is_edit());
                match job {
                    Job::Shown => self.is_shown = true,
                    Job::Edit(new) => edit = Some(join(edit, new)),
                    Job::FindTree(path) => {
                        let tree = Source::find(&path);
                        if tree.is_err() {
                            // Goes on with what the job has interrupted.
                            let again = Edit::new(Change::Paths(BTreeSet::new()), Instant::now());
                            edit = Some(join(edit, again));
                        }
                        let message = WorkerMessage::TreeFound { path, tree, edits: self.edits_taken };
                        self.sender.send(Message::Worker(message));
                    }
                    Job::OpenTree(source, tree) => {
                        self.reloader.open(source, tree);
                        edit = Some(Edit::new(Change::All, Instant::now()));
                    }
                    Job::Read(source, paths) => {
                        self.reloader.set_source(source);
                        edit = Some(join(edit, Edit::new(Change::Paths(paths), Instant::now())));
                    }
                    Job::Build(newest) => build = Some(newest),
                    Job::Thumbnails(set, requests) => self.thumbnails = Some((set, requests)),
                    Job::Preview((set, request)) => self.preview = Some((set, VecDeque::from([request]))),
                    Job::Inspected(set, requests) => self.inspected = Some((set, requests)),
                    Job::AskDriver(question) => self.questions = Some(question),
                }
            }
            if let Some(set) = edit.take().and_then(|edit| self.reload(edit)) {
                // Drop requests for an older set. The window sends one for the new set.
                build = build.filter(|(of, _)| Arc::ptr_eq(of, &set));
                (self.thumbnails, self.preview, self.inspected, self.questions) = (None, None, None, None);
            } else if self.is_stale() {
                // Edits go first.
            } else if self.unfinished && (self.is_shown || build.is_some()) {
                self.finish();
            } else if let Some((set, request)) = build.take() {
                let pending = request.needs_pending(&set.shaders);
                let newest = self.reloader.library().set();
                if pending && !newest.is_some_and(|newest| Arc::ptr_eq(newest, &set.shaders)) {
                    // The window does not know yet that these stages have been compiled, and asks again.
                    continue;
                }
                let built = set.build(&request).map(|_| ()).map_err(|error| error.to_string());
                let error = self.reloader.library().error_of(&request.stages());
                let error = error.map_or_else(|| "the shaders have errors".to_owned(), Diagnostic::one_line);
                let built = if pending { Err(format!("This mode does not compile: {error}")) } else { built };
                self.sender.send(Message::Worker(WorkerMessage::Built(built)));
                // A comparison requests pipelines of older sets, whose neighboring modes are not needed.
                if self.reloader.library().set().is_some_and(|newest| Arc::ptr_eq(newest, &set.shaders)) {
                    self.build_ahead(&set);
                }
            } else if !self.ask_driver() {
                self.build_thumbnail();
            }
        }
    }

    /// Whether a newer edit waits, or the window is closing.
    fn is_stale(&self) -> bool {
        self.edits.load(Ordering::SeqCst) > self.edits_taken
    }

    fn snapshot(&self) -> Snapshot {
        self.snapshot.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Compiles the edit and builds its pipelines. Returns the new set, if there is one.
    fn reload(&mut self, edit: Edit) -> Option<Arc<PipelineSet>> {
        assert!(!fault::strikes("worker-panic"), "the injected fault worker-panic");
        fault::delay("compile-delay-ms");
        let (snapshot, edits, taken) = (self.snapshot.clone(), self.edits.clone(), self.edits_taken);
        let request =
            |shaders: &Arc<ShaderSet>| snapshot.lock().unwrap_or_else(PoisonError::into_inner).request(shaders);
        let superseded = || edits.load(Ordering::SeqCst) > taken;
        let change = self.release(edit.change);
        let change = self.watch(change);
        let before = self.try_texts(&change);
        let reload = self.reloader.update_first(change, false, request, superseded);
        self.panics = 0;
        if !reload.reaches_device() {
            self.recorder.take_back(before);
        }
        let set = match &reload.outcome {
            Outcome::Ready(set) => Some(set.clone()),
            Outcome::Unchanged { .. } | Outcome::Failed(_) => None,
        };
        self.unfinished = set.as_ref().is_some_and(|set| !set.shaders.is_complete());
        self.is_shown = false;
        let source = self.reloader.library().source().clone();
        let detect_ms = edit.settled.duration_since(edit.since).as_secs_f64() * 1e3;
        let message = WorkerMessage::Reloaded { reload: Box::new(reload), detect_ms, source, edits: taken };
        self.sender.send(Message::Worker(message));
        if let Some(set) = &set {
            self.build_ahead(set);
        }
        set
    }

    /// Whether there are quarantined texts that [`Thread::release`] would release.
    fn holds_back(&self) -> bool {
        self.reloader.library().source().released().is_some()
    }

    /// Releases quarantined texts ([`Source::released`]) with a change, unless it is the first, which shows the last good texts.
    fn release(&mut self, change: Change) -> Change {
        if !self.has_compiled {
            self.has_compiled = true;
            return change;
        }
        let Some((source, paths)) = self.reloader.library().source().released() else { return change };
        self.reloader.set_source(source);
        change.and(Change::Paths(paths))
    }

    /// Adds the stage of a watched expression to a change, if the settings watch another one.
    fn watch(&mut self, change: Change) -> Change {
        let expression = self.snapshot().settings.expression.clone();
        match self.reloader.watch(&expression) {
            Ok(Some(watched)) => change.and(watched),
            Ok(None) => change,
            Err(message) => {
                self.sender.send(Message::Say(message));
                change
            }
        }
    }

    /// Records the texts of the change before they are used. Returns what [`Recorder::try_texts`] does.
    fn try_texts(&self, change: &Change) -> BTreeMap<String, u64> {
        let library = self.reloader.library();
        let source = library.source();
        let known = library.dependencies();
        let paths = match change {
            Change::Paths(paths) => paths.clone(),
            Change::All if library.set().is_some() => known.clone(),
            // The last good texts come first.
            Change::All if source.is_quarantined() => BTreeSet::new(),
            Change::All => source.list().into_iter().collect(),
        };
        // A new file may be one that was missing until now. Editors also save other files, with names and extensions of their
        // own.
        let is_shader = |path: &TreePath| {
            let is_hidden = path.as_str().split('/').any(|name| name.starts_with('.'));
            FileKind::of(Path::new(path.as_str())) == FileKind::Shader && !is_hidden
        };
        let is_tried = |path: &TreePath| known.contains(path) || is_shader(path);
        let paths = paths.into_iter().filter(is_tried);
        let texts = paths.map(|path| (path.clone(), text_hash(&source.read(&path)))).collect();
        self.recorder.try_texts(texts, source.quarantined_files())
    }

    /// Compiles the stages that the last reload has left, unless a newer edit arrives.
    fn finish(&mut self) {
        self.unfinished = false;
        let (snapshot, edits, taken) = (self.snapshot.clone(), self.edits.clone(), self.edits_taken);
        let request =
            |shaders: &Arc<ShaderSet>| snapshot.lock().unwrap_or_else(PoisonError::into_inner).request(shaders);
        let reload = self.reloader.finish(request, || edits.load(Ordering::SeqCst) > taken);
        let set = match &reload.outcome {
            Outcome::Ready(set) => Some(set.clone()),
            Outcome::Unchanged { .. } | Outcome::Failed(_) => None,
        };
        self.sender.send(Message::Worker(WorkerMessage::Completed(Box::new(reload))));
        if let Some(set) = &set {
            self.build_ahead(set);
        }
    }

    /// Waits for a job. While stages of the last reload remain, it waits [`LONGEST_FRAME`] at most, because a minimized
    /// window shows no frame.
    fn next_job(&self) -> Result<Job, RecvTimeoutError> {
        match self.unfinished {
            true => self.inbox.recv_timeout(LONGEST_FRAME),
            false => self.inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
        }
    }

    /// Whether there is work for idle times.
    fn has_idle_work(&self) -> bool {
        self.has_thumbnails() || (!self.unfinished && self.questions.is_some())
    }

    /// Queries the statistics of the next pipeline. Returns whether there was one left.
    fn ask_driver(&mut self) -> bool {
        let Some((set, request)) = self.questions.as_ref().filter(|_| !self.unfinished) else { return false };
        match set.ask_driver(request) {
            Ok(Some(ms)) => tracing::debug!("asked the driver about a pipeline, which took {ms:.1} ms"),
            Ok(None) => self.questions = None,
            Err(error) => tracing::debug!("the driver tells nothing of a pipeline: {error}"),
        }
        self.sender.send(Message::Worker(WorkerMessage::DriverTold));
        true
    }

    /// Whether pipelines of thumbnails can be built. Until all stages are compiled, an edit is not finished.
    fn has_thumbnails(&self) -> bool {
        let waiting = [&self.preview, &self.inspected, &self.thumbnails];
        !self.unfinished && waiting.into_iter().flatten().any(|(_, requests)| !requests.is_empty())
    }

    /// Builds the pipelines of the next thumbnails.
    fn build_thumbnail(&mut self) {
        if !self.has_thumbnails() {
            return;
        }
        if self.low_priority.as_ref().is_some_and(|build| !build.is_finished()) {
            // An edit may come in the meantime.
            std::thread::sleep(Duration::from_millis(1));
            return;
        }
        let waiting = [&mut self.preview, &mut self.inspected, &mut self.thumbnails].into_iter().flatten();
        let Some((set, requests)) = waiting.into_iter().find(|(_, requests)| !requests.is_empty()) else { return };
        // On failure the window shows no thumbnail, or no values.
        let Some((set, request)) = requests.pop_front().map(|request| (set.clone(), request)) else { return };
        self.join_aside();
        let sender = self.sender.clone();
        let (done, ended) = bounded::<()>(0);
        let build = move || {
            if let Err(error) = set.build_aside(&request) {
                tracing::debug!("no thumbnails: {error}");
            }
            sender.send(Message::Worker(WorkerMessage::ThumbnailsBuilt));
            drop(done);
        };
        // Without a thread, the thumbnail is missing.
        self.low_priority = std::thread::Builder::new().name("specula-thumbnails".to_owned()).spawn(build).ok();
        // The driver takes tens of milliseconds, for which an edit need not wait.
        while !self.is_stale() && self.inbox.is_empty() {
            if ended.recv_timeout(Duration::from_millis(1)) != Err(RecvTimeoutError::Timeout) {
                break;
            }
        }
    }

    /// Waits for the running build of a thumbnail's pipelines. After a panic of that thread the thumbnail is missing.
    fn join_aside(&mut self) {
        if let Some(Err(panic)) = self.low_priority.take().map(JoinHandle::join) {
            tracing::debug!("no thumbnails: {}", panic_text(&*panic));
        }
    }

    /// Builds the previous and the next mode, which `[` and `]` select, unless other work waits.
    fn build_ahead(&self, set: &Arc<PipelineSet>) {
        let snapshot = self.snapshot();
        // Until there is a model, leave the CPU to the loader. The window requests a build once the model is on screen.
        let Some(scene) = &snapshot.scene else { return };
        if !set.shaders.is_complete() || self.recorder.is_safe_mode() {
            return;
        }
        let features = Some(scene.features(&snapshot.settings) | set.shaders.hook_features());
        let Some([before, after]) = neighbors(&set.shaders.modes, &snapshot.settings.mode, features) else { return };
        for mode in [after, before] {
            if !self.inbox.is_empty() || self.is_stale() {
                return;
            }
            let settings = Arc::new(Settings { mode: mode.slug.clone(), ..(*snapshot.settings).clone() });
            let (scene, target, suns) = (snapshot.scene.clone(), snapshot.target, snapshot.suns);
            // An error is reported when the user selects the mode.
            let _ = set.build(&Snapshot { settings, scene, target, suns }.request(&set.shaders));
        }
    }
}
