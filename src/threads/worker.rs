//! The worker compiles shaders and builds pipelines, so that the window never waits for either.

mod job;
mod thread;

use std::collections::{BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use crossbeam_channel::{Sender, unbounded};

use super::message::{MessageSender, TaskKind};
use crate::frame::PipelineRequest;
use crate::gpu::{Gpu, SetLayouts};
use crate::pipeline::{PipelineSet, Reloader};
use crate::recovery::Recorder;
use crate::shader::{Change, Compiler, Source, TreePath};
pub(crate) use job::Snapshot;
use job::{Build, Edit, Job};
use thread::Thread;

/// Sends jobs, and counts those that make a running reload stale.
#[derive(Clone)]
struct Jobs {
    sender: Sender<Job>,
    edits: Arc<AtomicU64>,
}

impl Jobs {
    fn send(&self, job: Job) {
        if job.is_edit() {
            self.edits.fetch_add(1, Ordering::SeqCst);
        }
        // Fails only while the window closes.
        let _ = self.sender.send(job);
    }
}

/// Most build requests that are remembered, so that a failed one is not sent again in every frame.
const MOST_ASKED: usize = 16;

/// The window's handle of the worker. Dropping it ends the thread and waits for it.
pub(crate) struct Worker {
    jobs: Option<Jobs>,
    /// Number of edits in the last reload whose message the window has handled.
    reloaded: u64,
    snapshot: Arc<Mutex<Snapshot>>,
    /// The build requests since the last success, the newest first: as many as the grid can show modes.
    asked: VecDeque<Build>,
    /// The last preview whose pipelines were requested.
    asked_preview: Option<Build>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread, which first compiles the whole tree.
    pub(crate) fn start(
        (gpu, layouts): (&Arc<Gpu>, &Arc<SetLayouts>),
        compiler: &Arc<Compiler>,
        source: Source,
        snapshot: Snapshot,
        recorder: &Recorder,
        sender: &MessageSender,
    ) -> Self {
        let (jobs, inbox) = unbounded();
        // The first reload, which compiles the whole tree, counts as an edit.
        let edits = Arc::new(AtomicU64::new(1));
        let snapshot = Arc::new(Mutex::new(snapshot));
        let mut state = Thread {
            reloader: Reloader::new(gpu, layouts, compiler, source),
            snapshot: snapshot.clone(),
            inbox,
            edits: edits.clone(),
            edits_taken: 1,
            has_compiled: false,
            panics: 0,
            thumbnails: None,
            preview: None,
            inspected: None,
            low_priority: None,
            questions: None,
            unfinished: false,
            is_shown: false,
            recorder: recorder.clone(),
            sender: sender.clone(),
        };
        let thread = sender.spawn(TaskKind::Worker, move |_| state.run());
        let jobs = Some(Jobs { sender: jobs, edits });
        Self { jobs, reloaded: 0, snapshot, asked: VecDeque::new(), asked_preview: None, thread }
    }

    /// Sets what the next reload builds pipelines for.
    pub(crate) fn set_snapshot(&self, snapshot: Snapshot) {
        *self.snapshot.lock().unwrap_or_else(PoisonError::into_inner) = snapshot;
    }

    /// Compiles the stages that a change makes dirty. `since` is the time of its first file event.
    pub(crate) fn change(&self, change: Change, since: Instant) {
        self.send(Job::Edit(Edit::new(change, since)));
    }

    /// Whether the window lacks the result of an edit: the edit waits, is being compiled, or its message has not been handled.
    pub(crate) fn is_compiling(&self) -> bool {
        self.edits() > self.reloaded
    }

    /// Notes that the window has handled the message of a reload with this number of edits.
    pub(crate) fn reloaded(&mut self, edits: u64) {
        self.reloaded = edits;
    }

    /// Notes that the thread has panicked, so that no result of the edits so far may come.
    pub(crate) fn panicked(&mut self) {
        self.reloaded = self.edits();
    }

    fn edits(&self) -> u64 {
        self.jobs.as_ref().map_or(0, |jobs| jobs.edits.load(Ordering::SeqCst))
    }

    /// [`Worker::change`] for the watcher's thread, which must end before the worker does.
    pub(crate) fn changes(&self) -> impl Fn(Change, Instant) + Send + 'static {
        let jobs = self.jobs.clone();
        move |change, since| jobs.iter().for_each(|jobs| jobs.send(Job::Edit(Edit::new(change.clone(), since))))
    }

    /// Builds pipelines. The newest request wins. A request that is running or has failed is not sent again.
    pub(crate) fn build(&mut self, set: &Arc<PipelineSet>, request: &Arc<PipelineRequest>) {
        let is_asked = |(asked, for_this): &Build| Arc::ptr_eq(asked, set) && for_this == request;
        if !self.asked.iter().any(is_asked) {
            self.asked.truncate(MOST_ASKED - 1);
            self.asked.push_front((set.clone(), request.clone()));
            self.send(Job::Build((set.clone(), request.clone())));
        }
    }

    /// Builds pipelines of thumbnails, one request after the other, while idle. Replaces earlier requests.
    pub(crate) fn build_thumbnails(&self, set: &Arc<PipelineSet>, requests: VecDeque<Arc<PipelineRequest>>) {
        self.send(Job::Thumbnails(set.clone(), requests));
    }

    /// Builds pipelines of a preview while idle, once. Replaces an earlier request.
    pub(crate) fn build_preview(&mut self, set: &Arc<PipelineSet>, request: &Arc<PipelineRequest>) {
        let is_asked = |(asked, for_this): &Build| Arc::ptr_eq(asked, set) && for_this == request;
        if !self.asked_preview.as_ref().is_some_and(is_asked) {
            self.asked_preview = Some((set.clone(), request.clone()));
            self.send(Job::Preview((set.clone(), request.clone())));
        }
    }

    /// [`Worker::build_thumbnails`] for the modes that the inspector reads.
    pub(crate) fn build_inspected(&self, set: &Arc<PipelineSet>, requests: VecDeque<Arc<PipelineRequest>>) {
        self.send(Job::Inspected(set.clone(), requests));
    }

    /// Queries the driver's statistics of a frame's pipelines, one after the other, while idle. Each is built once more for that.
    pub(crate) fn ask_driver(&self, set: &Arc<PipelineSet>, request: &Arc<PipelineRequest>) {
        self.send(Job::AskDriver((set.clone(), request.clone())));
    }

    /// Records that a build has succeeded, or that failed ones may be tried again.
    pub(crate) fn built(&mut self) {
        self.asked.clear();
    }

    /// Tells the worker that the first frame of a reload is on screen, so that it compiles the remaining stages.
    pub(crate) fn shown(&self) {
        self.send(Job::Shown);
    }

    /// Looks whether there is a tree at this path, which takes a while in a large folder. The answer is
    /// [`super::results::WorkerMessage::TreeFound`].
    pub(crate) fn find_tree(&self, path: PathBuf) {
        self.send(Job::FindTree(path));
    }

    /// Opens another shader tree, with its number ([`crate::shader::ShaderSet::tree`]).
    pub(crate) fn open_tree(&self, source: Source, tree: usize) {
        self.send(Job::OpenTree(source, tree));
    }

    /// Reads the same tree from another source, which changes the texts of these files.
    pub(crate) fn read_from(&self, source: Source, changed: BTreeSet<TreePath>) {
        self.send(Job::Read(source, changed));
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
            let _ = thread.join();
        }
    }
}
