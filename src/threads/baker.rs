//! The baker bakes environments and the tables of the BRDF, reads measured BRDFs and builds what random paths trace, each on a thread of its own. The window keeps drawing with the previous
//! one, and the newest request wins.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use super::message::{Message, MessageSender, TaskKind};
use super::results::BakeMessage;
use crate::cancel::Running;
use crate::frame::{EnvironmentKey, MeasuredKey, TablesKey};
use crate::gpu::{Gpu, fault, return_freed_memory};
use crate::pipeline::PipelineSet;
use crate::render::{
    BakeControl, GpuEnvironment, PathTracing, PathTracingKey, PathTracingRequest, Resources, Tables, measured_buffer,
};
use crate::scene::MeasuredBrdf;

/// A running bake.
struct Bake {
    number: u64,
    key: Arc<EnvironmentKey>,
    progress: (f32, String),
}

/// Starts bakes, and cancels outdated ones.
pub(crate) struct Baker {
    gpu: Arc<Gpu>,
    sender: MessageSender,
    bake: Option<Bake>,
    /// The newest tables. The window ignores results for older ones.
    tables: Option<Arc<TablesKey>>,
    /// The newest read. The window ignores results of older ones.
    reading: Option<MeasuredKey>,
    /// The path-tracing resources being built. The window ignores results for older ones.
    tracing: Option<PathTracingKey>,
    /// Number of the newest bake. Older bakes end before their next pass.
    newest: Arc<AtomicU64>,
    /// Number of the newest read. Nobody waits for older ones.
    newest_read: Arc<AtomicU64>,
    threads: Vec<JoinHandle<()>>,
}

impl Baker {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        let (newest, newest_read, threads) = Default::default();
        Self {
            gpu: gpu.clone(),
            sender: sender.clone(),
            bake: None,
            tables: None,
            reading: None,
            tracing: None,
            newest,
            newest_read,
            threads,
        }
    }

    /// The fraction of the running bake that is done, and its next pass.
    pub(crate) fn progress(&self) -> Option<&(f32, String)> {
        self.bake.as_ref().map(|bake| &bake.progress)
    }

    /// Bakes `key` with `set` and cancels any other bake, except that of an earlier step of the same slider: that one ends and
    /// shows, and the newest step follows. `None` only cancels. `resources` has the last bake, of which unchanged parts are
    /// reused.
    pub(crate) fn bake(&mut self, set: &Arc<PipelineSet>, key: Option<Arc<EnvironmentKey>>, resources: &Resources) {
        let running = self.bake.as_ref().map(|bake| &bake.key);
        let is_step = running.zip(key.as_ref()).is_some_and(|(running, key)| key.is_step_of(running));
        if is_step || running == key.as_ref() {
            return;
        }
        let number = self.newest.fetch_add(1, Ordering::SeqCst) + 1;
        self.bake = None;
        let Some(key) = key else { return };
        self.bake = Some(Bake { number, key: key.clone(), progress: (0.0, String::new()) });
        let (set, newest) = (set.clone(), self.newest.clone());
        let before = resources.baked_environment().cloned();
        self.spawn(TaskKind::Baker(number), move |sender| {
            fault::delay("bake-delay-ms");
            assert!(!fault::strikes("bake-panic"), "the injected fault bake-panic");
            let progress = |done: f32, next: &str| {
                sender.send(Message::Bake(BakeMessage::Progress(number, done, next.to_owned())));
            };
            let superseded = || newest.load(Ordering::SeqCst) != number;
            let control = BakeControl { progress: &progress, superseded: &superseded, from_disk: true };
            let result = GpuEnvironment::bake(&set, &key, before.as_ref(), &control);
            // Release them before the window receives the result.
            drop((set, before));
            sender.send(Message::Bake(BakeMessage::Environment(number, result)));
        });
    }

    /// Bakes the tables of `key` with `set`, unless they, or those of an earlier step of the same slider, are being baked.
    pub(crate) fn bake_tables(&mut self, set: &Arc<PipelineSet>, key: Option<Arc<TablesKey>>, resources: &Resources) {
        let is_running = |key: &Arc<TablesKey>| self.tables.as_ref().is_some_and(|running| key.is_step_of(running));
        let Some(key) = key.filter(|key| !is_running(key)) else { return };
        self.tables = Some(key.clone());
        let (set, before) = (set.clone(), resources.tables().cloned());
        self.spawn(TaskKind::Tables(key.clone()), move |sender| {
            let result = Tables::bake(&set, &key, before.as_ref());
            drop((set, before));
            sender.send(Message::Bake(BakeMessage::Tables(key, result)));
        });
    }

    /// Reads a measured BRDF, unless it is being read.
    pub(crate) fn read(&mut self, key: Option<MeasuredKey>) {
        let Some(key) = key.filter(|key| self.reading.as_ref() != Some(key)) else { return };
        self.reading = Some(key.clone());
        let number = self.newest_read.fetch_add(1, Ordering::SeqCst) + 1;
        let (gpu, newest) = (self.gpu.clone(), self.newest_read.clone());
        self.spawn(TaskKind::MeasuredBrdf(key.clone()), move |sender| {
            let path = key.path.clone();
            let read = Running::start(move || MeasuredBrdf::open(&path));
            let Some(read) = read.wait_unless(&|| newest.load(Ordering::SeqCst) != number) else { return };
            let warnings = read.iter().flat_map(|measured| &measured.warnings);
            warnings.for_each(|warning| sender.send(Message::Say(format!("warning: {warning}"))));
            let result = read.map_err(|error| error.to_string());
            let result =
                result.and_then(|measured| measured_buffer(&gpu, Some(&measured)).map_err(|error| error.to_string()));
            drop(gpu);
            sender.send(Message::Bake(BakeMessage::Measured(key, result)));
        });
    }

    /// Builds the path-tracing resources, unless they are being built.
    pub(crate) fn build_path_tracing(&mut self, request: Option<PathTracingRequest>) {
        let Some(request) = request.filter(|request| self.tracing.as_ref() != Some(request.key())) else { return };
        self.tracing = Some(request.key().clone());
        let gpu = self.gpu.clone();
        self.spawn(TaskKind::PathTracing(request.key().clone()), move |sender| {
            let result = PathTracing::new(&gpu, &request).map_err(|error| error.to_string());
            let key = request.key().clone();
            // Release the device objects before the window receives the result.
            drop((gpu, request));
            return_freed_memory();
            sender.send(Message::Bake(BakeMessage::PathTracing(key, result)));
        });
    }

    /// Stores the progress of a bake, if it is the newest.
    pub(crate) fn set_progress(&mut self, number: u64, done: f32, next: String) {
        if let Some(bake) = self.bake.as_mut().filter(|bake| bake.number == number) {
            bake.progress = (done, next);
        }
    }

    /// Marks a bake as ended. Returns its key, unless it was canceled.
    pub(crate) fn ended(&mut self, number: u64) -> Option<Arc<EnvironmentKey>> {
        self.bake.take_if(|bake| bake.number == number).map(|bake| bake.key)
    }

    /// Marks tables as baked. Returns whether they are the newest.
    pub(crate) fn has_tables(&mut self, key: &Arc<TablesKey>) -> bool {
        self.tables.take_if(|tables| tables == key).is_some()
    }

    /// Marks path-tracing resources as built. Returns whether they are the newest.
    pub(crate) fn has_path_tracing(&mut self, key: &PathTracingKey) -> bool {
        self.tracing.take_if(|tracing| tracing == key).is_some()
    }

    /// Marks a read as ended. Returns whether it is the newest.
    pub(crate) fn has_read(&mut self, key: &MeasuredKey) -> bool {
        self.reading.take_if(|reading| reading == key).is_some()
    }

    fn spawn(&mut self, task: TaskKind, body: impl FnOnce(&MessageSender) + Send + 'static) {
        self.threads.retain(|thread| !thread.is_finished());
        self.threads.extend(self.sender.spawn(task, body));
    }
}

impl Drop for Baker {
    fn drop(&mut self) {
        self.newest.fetch_add(1, Ordering::SeqCst);
        self.newest_read.fetch_add(1, Ordering::SeqCst);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}
