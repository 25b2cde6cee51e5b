//! A second shader tree, whose picture is compared with that of the first. A thread compiles it, and again after each change of it,
//! builds its pipelines and bakes its light, so that the window waits for none of it.
//!
//! The thread compiles with a `Reloader` and a watcher of its own. For pipelines and light that `Resources::bind_older`
//! lacks, the window sends it a clone of `Resources`; the thread provides what is missing and sends back a
//! `BoundFrame`, whose light later frames use.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::Threads;
use super::message::{Message, TaskKind};
use super::results::SecondTreeMessage;
use super::worker::Snapshot;
use crate::frame::FrameState;
use crate::gpu::SetLayouts;
use crate::pipeline::{Outcome, PipelineSet, Reloader};
use crate::render::{BoundFrame, Resources};
use crate::shader::{Batch, Change, Compiler, ShaderSet, Source, Watcher};

/// A frame of the second tree, and the window's resources, which it shares.
pub(crate) struct Needs {
    pub(crate) snapshot: Snapshot,
    pub(crate) resources: Resources,
    pub(crate) set: Arc<PipelineSet>,
    pub(crate) state: Arc<FrameState>,
}

enum TreeJob {
    Change(Change),
    Provide(Box<Needs>),
}

/// The window's handle of the thread. Dropping it ends the thread, after the stage that is being compiled.
pub(crate) struct SecondTree {
    // The watcher sends jobs, so it is dropped first.
    _watcher: Option<Watcher>,
    jobs: Sender<TreeJob>,
    canceled: Arc<AtomicBool>,
    /// Its number, which its messages carry.
    pub(crate) number: u64,
}

impl SecondTree {
    /// Compiles a tree and watches it.
    ///
    /// # Errors
    /// A message, if the tree cannot be watched.
    pub(crate) fn open(
        threads: &mut Threads,
        number: u64,
        source: Source,
        (layouts, compiler): (&Arc<SetLayouts>, &Arc<Compiler>),
        snapshot: Snapshot,
    ) -> Result<Self, String> {
        let (jobs, inbox) = unbounded();
        let canceled = Arc::new(AtomicBool::new(false));
        // Watch before reading, so that no save is missed in between.
        let watcher = source.location().is_some().then(|| watch(&source, jobs.clone())).transpose()?;
        let reloader = Reloader::new(&threads.gpu, layouts, compiler, source);
        let mut tree = Tree { reloader, snapshot, canceled: canceled.clone() };
        threads.use_device(TaskKind::SecondTree(number), move |sender| {
            tree.run(&inbox, |message| sender.send(Message::SecondTree(number, message)));
        });
        Ok(Self { _watcher: watcher, jobs, canceled, number })
    }

    /// Builds and bakes what a frame needs. The newest request wins.
    pub(crate) fn provide(&self, needs: Needs) {
        // Fails only after the thread has panicked, which the window reports.
        let _ = self.jobs.send(TreeJob::Provide(Box::new(needs)));
    }
}

impl Drop for SecondTree {
    fn drop(&mut self) {
        self.canceled.store(true, Ordering::Relaxed);
    }
}

fn watch(source: &Source, jobs: Sender<TreeJob>) -> Result<Watcher, String> {
    let tree = source.clone();
    let on_batch = move |batch: Batch| {
        let paths = batch.paths.iter().flat_map(|path| tree.changed(path)).collect();
        let _ = jobs.send(TreeJob::Change(Change::Paths(paths)));
    };
    Watcher::new(source.root(), &source.files(), on_batch).map_err(|error| error.to_string())
}

/// The state of the thread.
struct Tree {
    reloader: Reloader,
    snapshot: Snapshot,
    canceled: Arc<AtomicBool>,
}

impl Tree {
    fn run(&mut self, inbox: &Receiver<TreeJob>, tell: impl Fn(SecondTreeMessage)) {
        let mut change = Some(Change::All);
        loop {
            let mut needs = None;
            if change.is_none() {
                let Ok(first) = inbox.recv() else { return };
                for job in std::iter::once(first).chain(inbox.try_iter()) {
                    match job {
                        TreeJob::Change(new) => change = Some(change.map_or(new.clone(), |old: Change| old.and(new))),
                        TreeJob::Provide(newest) => needs = Some(newest),
                    }
                }
            }
            if let Some(needs) = &needs {
                self.snapshot = needs.snapshot.clone();
            }
            if self.is_canceled() {
                return;
            }
            if let Some(message) = change.take().and_then(|change| self.compile(change)) {
                tell(message);
            }
            if let Some(needs) = needs.filter(|_| !self.is_canceled()) {
                tell(SecondTreeMessage::Provided(provide(*needs).map(Box::new)));
            }
        }
    }

    fn is_canceled(&self) -> bool {
        self.canceled.load(Ordering::Relaxed)
    }

    /// Compiles a change. `None` if it changes nothing.
    fn compile(&mut self, change: Change) -> Option<SecondTreeMessage> {
        let (snapshot, canceled) = (&self.snapshot, &self.canceled);
        let request = |shaders: &Arc<ShaderSet>| snapshot.request(shaders);
        let superseded = || canceled.load(Ordering::Relaxed);
        let first = self.reloader.update_first(change, true, request, superseded);
        let set = match first.outcome {
            Outcome::Unchanged { cleared: false } => return None,
            Outcome::Unchanged { cleared: true } => return Some(SecondTreeMessage::Compiled(None, Vec::new())),
            Outcome::Failed(diagnostics) => return Some(SecondTreeMessage::Compiled(None, diagnostics)),
            Outcome::Ready(set) => set,
        };
        if set.shaders.is_complete() {
            return Some(SecondTreeMessage::Compiled(Some(set), Vec::new()));
        }
        Some(match self.reloader.finish(request, superseded).outcome {
            Outcome::Ready(whole) => SecondTreeMessage::Compiled(Some(whole), Vec::new()),
            Outcome::Failed(diagnostics) => SecondTreeMessage::Compiled(Some(set), diagnostics),
            Outcome::Unchanged { .. } => SecondTreeMessage::Compiled(Some(set), Vec::new()),
        })
    }
}

/// Builds the pipelines of a frame, bakes its light where the window's does not fit, and binds it.
fn provide(needs: Needs) -> Result<BoundFrame, String> {
    let Needs { mut resources, set, state, .. } = needs;
    set.build(&state.pipelines).map_err(|error| error.to_string())?;
    resources.set_pipelines(&set);
    let bound = resources.provide(&state);
    // The number of suns that the tree finds in the environment is known only after the bake.
    let suns = resources.environment().sun_count();
    if suns <= state.pipelines.sun_count {
        return bound.map_err(|error| error.to_string());
    }
    let state = Arc::new(state.for_suns(suns));
    resources.provide(&state).map_err(|error| error.to_string())
}
