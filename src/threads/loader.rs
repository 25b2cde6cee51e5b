//! The loader parses, decodes and uploads models. The old model stays on screen until then, and the newest request wins: an older one
//! stops before its next file or image, and is not uploaded. A model whose images take long to decode is uploaded twice: first with
//! placeholders for them, then with its textures.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Weak};
use std::time::Instant;

use super::gate::DeviceGate;
use super::message::{Message, MessageSender, TaskKind};
use super::results::Loaded;
use crate::cancel::{Running, receive_unless};
use crate::gpu::{Gpu, SetLayouts, fault, return_freed_memory};
use crate::render::GpuModel;
use crate::scene::{self, Caller, LoadError, LoadOptions, Model, background};

/// A model that is being read. This needs no device, so it starts before the window opens. Dropping this stops the reading before the next
/// file or image.
pub(crate) struct Reading {
    path: Option<PathBuf>,
    start: Instant,
    canceled: Arc<AtomicBool>,
    /// The model while its images are being decoded, if that takes long.
    early: Receiver<Model>,
    model: Option<Running<Result<Model, LoadError>>>,
}

impl Reading {
    /// The model without its images, or `None` if it comes with them or as soon as `superseded` says so.
    fn early_unless(&self, superseded: &dyn Fn() -> bool) -> Option<Model> {
        receive_unless(&self.early, superseded).ok()
    }

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

/// Starts to read a model: parse, decode, generate tangents. `is_early`: whether to show it before its images are decoded.
pub(crate) fn read(path: Option<PathBuf>, options: LoadOptions, is_early: bool) -> Reading {
    let (start, canceled) = (Instant::now(), Arc::new(AtomicBool::new(false)));
    let (file, stops) = (path.clone(), canceled.clone());
    let (sender, early) = channel();
    let model = Running::start(move || {
        let canceled = || stops.load(Ordering::Relaxed);
        let was_early = AtomicBool::new(false);
        let take_early = |model| {
            was_early.store(true, Ordering::Relaxed);
            // Nobody takes it if the load has been superseded.
            let _ = sender.send(model);
        };
        let caller = Caller { canceled: &canceled, take_early: is_early.then_some(&take_early) };
        let model = scene::open_for(file.as_deref(), &options, caller);
        fault::delay("load-delay-ms");
        if was_early.into_inner() {
            fault::delay("textures-delay-ms");
        }
        model
    });
    Reading { path, start, canceled, early, model: Some(model) }
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

    /// Reads a model and uploads it. Sends the result as a message, unless a newer load begins first. `is_early`: whether the model
    /// without its images is sent before, if they take long.
    pub(crate) fn load(&self, path: Option<PathBuf>, options: LoadOptions, is_early: bool) {
        self.finish(move || read(path, options, is_early));
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
            let upload = |model: Model, early: Option<&GpuModel>| {
                let files = model.files.to_vec();
                let (gpu, layouts) = (gpu.upgrade()?, layouts.upgrade()?);
                let uploaded = background::run_if(early.is_some(), || match early {
                    Some(early) => early.with_textures(&gpu, &layouts, model),
                    None => GpuModel::upload(&gpu, &layouts, model),
                });
                Some(uploaded.map_err(|error| (error.to_string(), files)))
            };
            // Uploads wait here for each other, so the one that is next may no longer be the newest.
            let pass = |model, early: Option<&GpuModel>| {
                gate.pass(|| (!superseded()).then(|| upload(model, early)).flatten()).flatten()
            };
            let send = |reading: &Reading, result| {
                let (path, ms) = (reading.path.clone(), reading.start.elapsed().as_secs_f64() * 1e3);
                sender.send(Message::Loaded(Box::new(Loaded { number, path, result, ms })));
            };
            // If there is no memory for it, there is none for the whole model either.
            let early = reading.early_unless(&superseded).and_then(|model| pass(model, None)?.ok());
            if let Some(early) = &early {
                send(&reading, Ok(early.clone()));
            }
            let Some(model) = reading.wait_unless(&superseded) else { return };
            let result = match model {
                Ok(model) => pass(model, early.as_deref()),
                Err(error) => Some(Err((error.to_string(), error.files))),
            };
            return_freed_memory();
            if let Some(result) = result {
                send(&reading, result);
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
