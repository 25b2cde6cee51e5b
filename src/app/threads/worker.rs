//! The worker compiles shaders and builds pipelines, so that the window never waits for either.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::{Message, Outbox};
use crate::gpu::{Gpu, SetLayouts, fault};
use crate::interface::{FEATURE_NORMAL_TEXTURE, FEATURE_PACKED_OCCLUSION};
use crate::render::{
    MaterialVariant, Outcome, PipelineRequest, PipelineSet, Reload, Reloader, Scene, TargetFormat, tree_name,
};
use crate::settings::Settings;
use crate::shader::{Change, Compiler, ShaderSet, Source};

/// The settings, scene and target that the window draws now. A reload builds their pipelines.
#[derive(Clone)]
pub(in crate::app) struct Snapshot {
    pub(in crate::app) settings: Settings,
    pub(in crate::app) scene: Option<Scene>,
    pub(in crate::app) target: TargetFormat,
}

impl Snapshot {
    fn request(&self, shaders: &ShaderSet) -> PipelineRequest {
        let mut request = PipelineRequest::new(&self.settings, shaders, self.scene.as_ref(), self.target);
        if self.scene.is_none() {
            // While the model loads, build the pipeline that most models need.
            let features = FEATURE_NORMAL_TEXTURE | FEATURE_PACKED_OCCLUSION;
            request.materials = BTreeSet::from([MaterialVariant { features, ..Default::default() }]);
        }
        request
    }
}

/// Messages of the worker.
pub(in crate::app) enum WorkerMessage {
    /// A reload is finished.
    Reloaded {
        reload: Box<Reload>,
        /// Milliseconds from the first file event to the settled set of changes.
        detect_ms: f64,
        /// Name of the tree.
        tree: String,
    },
    /// The result of the last [`Worker::build`].
    Built(Result<(), String>),
}

/// Changed files, and the times of the first event and of the settled set.
struct Edit {
    change: Change,
    since: Instant,
    settled: Instant,
}

type Build = (Arc<PipelineSet>, PipelineRequest);

enum Job {
    Edit(Edit),
    OpenTree(Source),
    Build(Build),
}

/// Sends jobs, and counts those that make a running reload stale.
#[derive(Clone)]
struct Jobs {
    sender: Sender<Job>,
    edits: Arc<AtomicU64>,
}

impl Jobs {
    fn send(&self, job: Job) {
        if !matches!(job, Job::Build(_)) {
            self.edits.fetch_add(1, Ordering::SeqCst);
        }
        // Fails only after a panic of the thread, which the window learns from its own message.
        let _ = self.sender.send(job);
    }

    fn edit(&self, change: Change, since: Instant) {
        self.send(Job::Edit(Edit { change, since, settled: Instant::now() }));
    }
}

/// The window's end of the worker. Dropping it ends the thread and waits for it.
pub(in crate::app) struct Worker {
    jobs: Option<Jobs>,
    snapshot: Arc<Mutex<Snapshot>>,
    /// The newest build request that has not succeeded yet.
    asked: Option<Build>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread, which first compiles the whole tree.
    pub(super) fn start(
        (gpu, layouts): (&Arc<Gpu>, &Arc<SetLayouts>),
        compiler: &Arc<Compiler>,
        source: Source,
        snapshot: Snapshot,
        outbox: &Outbox,
    ) -> Self {
        let (sender, inbox) = unbounded();
        let edits = Arc::new(AtomicU64::new(0));
        let snapshot = Arc::new(Mutex::new(snapshot));
        let mut state = Thread {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            compiler: compiler.clone(),
            reloader: Reloader::new(gpu, layouts, compiler, source),
            snapshot: snapshot.clone(),
            inbox,
            edits: edits.clone(),
            edits_taken: 0,
            outbox: outbox.clone(),
        };
        let thread = outbox.spawn("worker", move |_| state.run());
        let worker = Self { jobs: Some(Jobs { sender, edits }), snapshot, asked: None, thread: Some(thread) };
        worker.change(Change::All, Instant::now());
        worker
    }

    /// Sets what the next reload builds pipelines for.
    pub(in crate::app) fn set_snapshot(&self, snapshot: Snapshot) {
        *self.snapshot.lock().unwrap_or_else(PoisonError::into_inner) = snapshot;
    }

    /// Compiles the stages that a change makes dirty. `since` is the time of its first file event.
    pub(in crate::app) fn change(&self, change: Change, since: Instant) {
        self.jobs.iter().for_each(|jobs| jobs.edit(change.clone(), since));
    }

    /// [`Worker::change`] for the watcher's thread, which must end before the worker does.
    pub(super) fn changes(&self) -> impl Fn(Change, Instant) + Send + 'static {
        let jobs = self.jobs.clone();
        move |change, since| jobs.iter().for_each(|jobs| jobs.edit(change.clone(), since))
    }

    /// Builds pipelines. The newest request wins. A request that is running or has failed is not sent again.
    pub(in crate::app) fn build(&mut self, set: &Arc<PipelineSet>, request: &PipelineRequest) {
        let is_asked = |(asked, for_this): &Build| Arc::ptr_eq(asked, set) && for_this == request;
        if !self.asked.as_ref().is_some_and(is_asked) {
            self.asked = Some((set.clone(), request.clone()));
            self.send(Job::Build((set.clone(), request.clone())));
        }
    }

    /// Whether the thread has ended, after a panic.
    pub(in crate::app) fn has_ended(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Marks the newest build as successful, or lets a failed one be tried again.
    pub(in crate::app) fn built(&mut self) {
        self.asked = None;
    }

    /// Opens another shader tree.
    pub(in crate::app) fn open_tree(&self, source: Source) {
        self.send(Job::OpenTree(source));
    }

    fn send(&self, job: Job) {
        if let Some(jobs) = &self.jobs {
            jobs.send(job);
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        if let Some(jobs) = self.jobs.take() {
            // Makes a running reload stale, so that it ends early.
            jobs.edits.fetch_add(1, Ordering::SeqCst);
        }
        if let Some(thread) = self.thread.take() {
            // The thread has already sent its panic as a message.
            let _ = thread.join();
        }
    }
}

struct Thread {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    compiler: Arc<Compiler>,
    reloader: Reloader,
    snapshot: Arc<Mutex<Snapshot>>,
    inbox: Receiver<Job>,
    edits: Arc<AtomicU64>,
    /// How many of `edits` were taken out of the inbox.
    edits_taken: u64,
    outbox: Outbox,
}

impl Thread {
    /// Runs until the window drops its [`Jobs`]. Of all waiting jobs, the thread first joins and compiles the edits, then
    /// builds the newest request, even if an edit has failed.
    fn run(&mut self) {
        let mut build: Option<Build> = None;
        while let Ok(first) = self.inbox.recv() {
            let mut waiting = vec![first];
            while !waiting.is_empty() || build.is_some() {
                waiting.extend(self.inbox.try_iter());
                let mut edit = None::<Edit>;
                for job in waiting.drain(..) {
                    match job {
                        Job::Edit(new) => edit = Some(self.join(edit, new)),
                        Job::OpenTree(source) => edit = Some(self.open_tree(source)),
                        Job::Build(newest) => build = Some(newest),
                    }
                }
                if let Some(set) = edit.and_then(|edit| self.reload(edit)) {
                    // Drop a request for an older set. The window sends one for the new set.
                    build = build.filter(|(of, _)| Arc::ptr_eq(of, &set));
                } else if self.is_stale() {
                    // A newer edit has been counted and is about to arrive, or the window is closing.
                    match self.inbox.recv() {
                        Ok(job) => waiting.push(job),
                        Err(_) => return,
                    }
                } else if let Some((set, request)) = build.take() {
                    let built = set.build(&request).map_err(|error| error.to_string());
                    self.outbox.send(Message::Worker(WorkerMessage::Built(built)));
                    self.build_ahead(&set);
                }
            }
        }
    }

    /// Joins an edit with an older one that has not been compiled yet.
    fn join(&mut self, old: Option<Edit>, new: Edit) -> Edit {
        self.edits_taken += 1;
        match old {
            Some(old) => Edit { change: old.change.and(new.change), since: old.since, ..new },
            None => new,
        }
    }

    fn open_tree(&mut self, source: Source) -> Edit {
        self.edits_taken += 1;
        self.reloader = Reloader::new(&self.gpu, &self.layouts, &self.compiler, source);
        let now = Instant::now();
        Edit { change: Change::All, since: now, settled: now }
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
        let reload = self.reloader.update(edit.change, request, || edits.load(Ordering::SeqCst) > taken);
        let set = match &reload.outcome {
            Outcome::Ready(set) => Some(set.clone()),
            Outcome::Unchanged { .. } | Outcome::Failed(_) => None,
        };
        let tree = tree_name(self.reloader.library().source());
        let detect_ms = edit.settled.duration_since(edit.since).as_secs_f64() * 1e3;
        let message = WorkerMessage::Reloaded { reload: Box::new(reload), detect_ms, tree };
        self.outbox.send(Message::Worker(message));
        // At the start, leave the CPU to the loader. The window requests a build once the model is on screen.
        if let Some(set) = set.as_ref().filter(|set| set.shaders.generation > 1) {
            self.build_ahead(set);
        }
        set
    }

    /// Builds the modes before and after the current one, which `[` and `]` select, unless other work waits.
    fn build_ahead(&self, set: &Arc<PipelineSet>) {
        let (snapshot, modes) = (self.snapshot(), &set.shaders.modes);
        let request = snapshot.request(&set.shaders);
        let Some(at) = modes.iter().position(|mode| mode.id == request.mode) else { return };
        for neighbor in [(at + 1) % modes.len(), (at + modes.len() - 1) % modes.len()] {
            if !self.inbox.is_empty() || self.is_stale() {
                return;
            }
            // An error is reported when the user selects the mode.
            let _ = set.build(&request.with_mode(&modes[neighbor], snapshot.settings.view.tonemap));
        }
    }
}
