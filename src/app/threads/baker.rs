//! The baker bakes environments, reads measured BRDFs and builds what random paths trace, each on a thread of its own. The window keeps drawing with the previous
//! one, and the newest request wins.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use super::{Message, Outbox};
use crate::gpu::{Buffer, Gpu, return_freed_memory};
use crate::render::{
    BakeControl, BakeError, EnvironmentKey, GpuEnvironment, MeasuredKey, PipelineSet, TraceKey, TraceRequest, Traced,
    read_measured,
};

/// Messages of the baker.
pub(in crate::app) enum BakeMessage {
    /// Number of the bake, the fraction that is done, 0..1, and the next pass.
    Progress(u64, f32, String),
    /// The result of a bake.
    Environment(u64, EnvironmentKey, Result<Arc<GpuEnvironment>, BakeError>),
    /// A measured BRDF.
    Measured(MeasuredKey, Result<Arc<Buffer>, String>),
    /// What random paths trace.
    Traced(TraceKey, Result<Arc<Traced>, String>),
}

/// A running bake.
struct Bake {
    key: EnvironmentKey,
    progress: (f32, String),
}

/// Starts bakes, and cancels outdated ones.
pub(in crate::app) struct Baker {
    gpu: Arc<Gpu>,
    outbox: Outbox,
    bake: Option<Bake>,
    /// The newest read. The window takes its result, and ignores those of older ones.
    pub(in crate::app) reading: Option<MeasuredKey>,
    /// The newest hierarchy that is being built. The window takes its result, and ignores those of older ones.
    pub(in crate::app) tracing: Option<TraceKey>,
    /// Number of the newest bake. Older bakes end before their next pass.
    newest: Arc<AtomicU64>,
    threads: Vec<JoinHandle<()>>,
}

impl Baker {
    pub(super) fn new(gpu: &Arc<Gpu>, outbox: &Outbox) -> Self {
        let (newest, threads) = Default::default();
        Self { gpu: gpu.clone(), outbox: outbox.clone(), bake: None, reading: None, tracing: None, newest, threads }
    }

    /// The fraction of the running bake that is done, and its next pass.
    pub(in crate::app) fn progress(&self) -> Option<&(f32, String)> {
        self.bake.as_ref().map(|bake| &bake.progress)
    }

    /// Bakes `key` with `set` and cancels any other bake. `None` only cancels.
    pub(in crate::app) fn bake(&mut self, set: &Arc<PipelineSet>, key: Option<EnvironmentKey>) {
        if self.bake.as_ref().map(|bake| &bake.key) == key.as_ref() {
            return;
        }
        let number = self.newest.fetch_add(1, Ordering::SeqCst) + 1;
        self.bake = None;
        let Some(key) = key else { return };
        self.bake = Some(Bake { key: key.clone(), progress: (0.0, String::new()) });
        let (set, newest) = (set.clone(), self.newest.clone());
        self.spawn("baker", move |outbox| {
            let progress = |done: f32, next: &str| {
                outbox.send(Message::Bake(BakeMessage::Progress(number, done, next.to_owned())));
            };
            let superseded = || newest.load(Ordering::SeqCst) != number;
            let control = BakeControl { progress: &progress, superseded: &superseded, from_disk: true };
            let result = GpuEnvironment::bake(&set, &key.name, &control);
            // Release the set before the window takes the result.
            drop(set);
            outbox.send(Message::Bake(BakeMessage::Environment(number, key, result)));
        });
    }

    /// Reads a measured BRDF, unless it is being read.
    pub(in crate::app) fn read(&mut self, key: Option<MeasuredKey>) {
        let Some(key) = key.filter(|key| self.reading.as_ref() != Some(key)) else { return };
        self.reading = Some(key.clone());
        let gpu = self.gpu.clone();
        self.spawn("reader", move |outbox| {
            let result = read_measured(&gpu, &key).map_err(|error| error.to_string());
            drop(gpu);
            outbox.send(Message::Bake(BakeMessage::Measured(key, result)));
        });
    }

    /// Builds what random paths trace, unless it is being built.
    pub(in crate::app) fn trace(&mut self, request: Option<TraceRequest>) {
        let Some(request) = request.filter(|request| self.tracing.as_ref() != Some(request.key())) else { return };
        self.tracing = Some(request.key().clone());
        let gpu = self.gpu.clone();
        self.spawn("tracer", move |outbox| {
            let result = Traced::new(&gpu, &request).map_err(|error| error.to_string());
            let key = request.key().clone();
            // Release the device objects before the window takes the result.
            drop((gpu, request));
            return_freed_memory();
            outbox.send(Message::Bake(BakeMessage::Traced(key, result)));
        });
    }

    /// Stores the progress of a bake, if it is the newest.
    pub(in crate::app) fn set_progress(&mut self, number: u64, done: f32, next: String) {
        if let Some(bake) = self.bake.as_mut().filter(|_| self.newest.load(Ordering::SeqCst) == number) {
            bake.progress = (done, next);
        }
    }

    /// Marks a bake as ended. Returns whether it is the newest.
    pub(in crate::app) fn ended(&mut self, number: u64) -> bool {
        let is_newest = self.newest.load(Ordering::SeqCst) == number;
        self.bake = self.bake.take().filter(|_| !is_newest);
        is_newest
    }

    /// Cancels the running bake after a panic. Returns its key.
    pub(in crate::app) fn abandon_bake(&mut self) -> Option<EnvironmentKey> {
        self.newest.fetch_add(1, Ordering::SeqCst);
        self.bake.take().map(|bake| bake.key)
    }

    fn spawn(&mut self, name: &'static str, body: impl FnOnce(&Outbox) + Send + 'static) {
        self.threads.retain(|thread| !thread.is_finished());
        self.threads.push(self.outbox.spawn(name, body));
    }
}

impl Drop for Baker {
    fn drop(&mut self) {
        self.newest.fetch_add(1, Ordering::SeqCst);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}
