//! The loader parses, decodes and uploads models, each on a thread of its own. The old model stays on screen until then, and the
//! newest request wins.

use std::path::PathBuf;
use std::sync::{Arc, Weak};
use std::thread::JoinHandle;
use std::time::Instant;

use super::{DeviceGate, Message, MessageSender, TaskKind};
use crate::gpu::{Gpu, SetLayouts, fault, return_freed_memory};
use crate::message::panic_text;
use crate::render::GpuModel;
use crate::scene::{self, LoadError, LoadOptions, Model};

/// A finished load.
pub(crate) struct Loaded {
    /// Number of the load, counted by [`Loader::newest`].
    pub(crate) number: u64,
    /// The file; `None` is the built-in model.
    pub(crate) path: Option<PathBuf>,
    /// The model on the device, or an error message and the files that were tried.
    pub(crate) result: Result<Arc<GpuModel>, (String, Vec<PathBuf>)>,
    /// Duration in milliseconds.
    pub(crate) ms: f64,
}

/// A model that is being read. This needs no device, so it starts before the window opens.
pub(crate) struct Reading {
    path: Option<PathBuf>,
    start: Instant,
    model: JoinHandle<Result<Model, LoadError>>,
}

/// Starts to read a model: parse, decode, generate tangents.
pub(crate) fn read(path: Option<PathBuf>, options: LoadOptions) -> Reading {
    let file = path.clone();
    let model = std::thread::spawn(move || {
        let model = scene::open(file.as_deref(), &options);
        fault::delay("load-delay-ms");
        model
    });
    Reading { path, start: Instant::now(), model }
}

/// Uploads models and counts the loads.
pub(crate) struct Loader {
    // Weak, because a load that outlives the window must not keep the device alive.
    gpu: Weak<Gpu>,
    layouts: Weak<SetLayouts>,
    gate: Arc<DeviceGate>,
    sender: MessageSender,
    /// Number of the newest load.
    pub(crate) newest: u64,
}

impl Loader {
    pub(crate) fn new((gpu, layouts): (&Arc<Gpu>, &Arc<SetLayouts>), sender: &MessageSender) -> Self {
        let (gpu, layouts) = (Arc::downgrade(gpu), Arc::downgrade(layouts));
        Self { gpu, layouts, gate: Arc::default(), sender: sender.clone(), newest: 0 }
    }

    /// Uploads a model once it has been read. Sends the result as a message.
    pub(crate) fn upload(&mut self, reading: Reading) {
        self.newest += 1;
        let (gpu, layouts, gate, number) = (self.gpu.clone(), self.layouts.clone(), self.gate.clone(), self.newest);
        self.sender.spawn(TaskKind::Loader(number), move |sender| {
            let Reading { path, start, model } = reading;
            let result = match model.join() {
                Ok(model) => model.map_err(|error| (error.to_string(), error.files)),
                Err(panic) => {
                    let text = format!("the loader failed ({}); please report the model", panic_text(&*panic));
                    Err((text, path.iter().cloned().collect()))
                }
            };
            let upload = |model: Model| {
                let files = model.files.clone();
                let (gpu, layouts) = (gpu.upgrade()?, layouts.upgrade()?);
                Some(GpuModel::upload(&gpu, &layouts, model).map_err(|error| (error.to_string(), files)))
            };
            let result = match result {
                Ok(model) => gate.pass(|| upload(model)).flatten(),
                Err(error) => Some(Err(error)),
            };
            return_freed_memory();
            if let Some(result) = result {
                let ms = start.elapsed().as_secs_f64() * 1e3;
                sender.send(Message::Loaded(Box::new(Loaded { number, path, result, ms })));
            }
        });
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.gate.close();
    }
}
