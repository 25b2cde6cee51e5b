//! The loader parses, decodes and uploads models. The old model stays on screen until then, and the newest request wins: an older one
//! stops before its next file or image, and is not uploaded.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Weak};
use std::time::Instant;

use super::gate::DeviceGate;
use super::message::{Message, MessageSender, TaskKind};
use super::results::Loaded;
use crate::cancel::Running;
use crate::gpu::{Gpu, SetLayouts, fault, return_freed_memory};
use crate::render::GpuModel;
use crate::scene::{self, LoadError, LoadOptions, Model};

/// A model that is being read. This needs no device, so it starts before the window opens. Dropping this stops the reading before the next
/// file or image.
pub(crate) struct Reading {
    path: Option<PathBuf>,
    start: Instant,
    canceled: Arc<AtomicBool>,
    model: Option<Running<Result<Model, LoadError>>>,
}

impl Reading {
    /// The model, or `None` as soon as `superseded` says so.
    fn wait_unless(&mut self, superseded: &dyn Fn() -> bool) -> Option<Result<Model, LoadError>> {
        self.model.take()?.wait_unless(superseded)
    }
}

impl Drop for Reading {
    fn drop(&mut self) {
        self.canceled.store(true, Ordering::Relaxed);
    }
}

/// Starts to read a model: parse, decode, generate tangents.
pub(crate) fn read(path: Option<PathBuf>, options: LoadOptions) -> Reading {
    let (start, canceled) = (Instant::now(), Arc::new(AtomicBool::new(false)));
    let (file, stops) = (path.clone(), canceled.clone());
    let model = Running::start(move || {
        let model = scene::open_unless(file.as_deref(), &options, &|| stops.load(Ordering::Relaxed));
        fault::delay("load-delay-ms");
        model
    });
    Reading { path, start, canceled, model: Some(model) }
}

/// Uploads models and counts the loads.
pub(crate) struct Loader {
    // Weak, because a load that outlives the window must not keep the device alive.
    gpu: Weak<Gpu>,
    layouts: Weak<SetLayouts>,
    gate: Arc<DeviceGate>,
    sender: MessageSender,
    /// Number of the newest load.
    newest: Arc<AtomicU64>,
}

impl Loader {
    pub(crate) fn new((gpu, layouts): (&Arc<Gpu>, &Arc<SetLayouts>), sender: &MessageSender) -> Self {
        let (gpu, layouts) = (Arc::downgrade(gpu), Arc::downgrade(layouts));
        Self { gpu, layouts, gate: Arc::default(), sender: sender.clone(), newest: Arc::default() }
    }

    /// Whether no load has begun after the one with this number.
    pub(crate) fn is_newest(&self, number: u64) -> bool {
        self.newest.load(Ordering::Relaxed) == number
    }

    /// Reads a model and uploads it. Sends the result as a message, unless a newer load begins first.
    pub(crate) fn load(&self, path: Option<PathBuf>, options: LoadOptions) {
        self.finish(move || read(path, options));
    }

    /// [`Loader::load`] for a model whose reading has begun.
    pub(crate) fn upload(&self, reading: Reading) {
        self.finish(move || reading);
    }

    fn finish(&self, begin: impl FnOnce() -> Reading + Send + 'static) {
        let number = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
        let (gpu, layouts, gate, newest) =
            (self.gpu.clone(), self.layouts.clone(), self.gate.clone(), self.newest.clone());
        self.sender.spawn(TaskKind::Loader(number), move |sender| {
            let superseded = || newest.load(Ordering::Relaxed) != number;
            let mut reading = begin();
            let Some(model) = reading.wait_unless(&superseded) else { return };
            let upload = |model: Model| {
                let files = model.files.to_vec();
                let (gpu, layouts) = (gpu.upgrade()?, layouts.upgrade()?);
                Some(GpuModel::upload(&gpu, &layouts, model).map_err(|error| (error.to_string(), files)))
            };
            let result = match model {
                // Uploads wait here for each other, so the one that is next may no longer be the newest.
                Ok(model) => gate.pass(|| (!superseded()).then(|| upload(model)).flatten()).flatten(),
                Err(error) => Some(Err((error.to_string(), error.files))),
            };
            return_freed_memory();
            if let Some(result) = result {
                let (path, ms) = (reading.path.take(), reading.start.elapsed().as_secs_f64() * 1e3);
                sender.send(Message::Loaded(Box::new(Loaded { number, path, result, ms })));
            }
        });
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.newest.fetch_add(1, Ordering::Relaxed);
        self.gate.close();
    }
}
