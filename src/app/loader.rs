//! Loads models on a thread of their own: parse, decode, upload. The old model stays on screen meanwhile.

use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use winit::event_loop::EventLoopProxy;

use crate::gpu::{Gpu, SetLayouts};
use crate::render::GpuScene;
use crate::scene::{self, LoadError, LoadOptions, Model};

use super::Message;

/// A finished load.
pub(super) struct Loaded {
    /// Which one: the newest wins.
    pub(super) ticket: u64,
    /// The file; `None` is the built-in model.
    pub(super) path: Option<PathBuf>,
    /// The model, on the device too, or why not and the files that were tried.
    pub(super) result: Result<(Model, Arc<GpuScene>), (String, Vec<PathBuf>)>,
    /// How long it took, milliseconds.
    pub(super) ms: f64,
}

/// A model that is being read. Needs no device, so the first one is begun before there is a window.
pub(super) struct Reading {
    path: Option<PathBuf>,
    start: Instant,
    model: JoinHandle<Result<Model, LoadError>>,
}

/// Begins to read a model: parse, decode, tangents.
pub(super) fn read(path: Option<PathBuf>, options: LoadOptions) -> Reading {
    let file = path.clone();
    let model = std::thread::spawn(move || scene::open(file.as_deref(), &options));
    Reading { path, start: Instant::now(), model }
}

/// Uploads what was read; the result comes as a message. The thread must have ended before the process does.
pub(super) fn upload(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    proxy: &EventLoopProxy<Message>,
    reading: Reading,
    ticket: u64,
) -> JoinHandle<()> {
    let (gpu, layouts, proxy) = (gpu.clone(), layouts.clone(), proxy.clone());
    std::thread::spawn(move || {
        let Reading { path, start, model } = reading;
        let result = match model.join() {
            Ok(model) => model.map_err(|e| (e.to_string(), e.files)),
            // What it was has been printed.
            Err(_) => Err(("the loader failed; please report the model".to_owned(), path.iter().cloned().collect())),
        };
        let result = result.and_then(|model| {
            let files = model.files.clone();
            GpuScene::upload(&gpu, &layouts, model).map_err(|e| (e.to_string(), files))
        });
        // The window may be gone by now; then nobody waits for the model.
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let _ = proxy.send_event(Message::Loaded(Box::new(Loaded { ticket, path, result, ms })));
    })
}
