//! Loads models on a thread of their own: parse, decode, upload. The old model stays on screen meanwhile.

use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use winit::event_loop::EventLoopProxy;

use crate::gpu::{Gpu, SetLayouts};
use crate::render::GpuScene;
use crate::scene::{self, LoadOptions, Model};

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

/// Starts a load; the result comes as a message. The thread must have ended before the process does.
pub(super) fn load(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    proxy: &EventLoopProxy<Message>,
    path: Option<PathBuf>,
    options: LoadOptions,
    ticket: u64,
) -> JoinHandle<()> {
    let (gpu, layouts, proxy) = (gpu.clone(), layouts.clone(), proxy.clone());
    std::thread::spawn(move || {
        let start = Instant::now();
        let model = scene::open(path.as_deref(), &options);
        let result = model.map_err(|e| (e.to_string(), e.files)).and_then(|model| {
            let scene = GpuScene::upload(&gpu, &layouts, &model).map_err(|e| (e.to_string(), model.files.clone()))?;
            Ok((model, scene))
        });
        // The window may be gone by now; then nobody waits for the model.
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let _ = proxy.send_event(Message::Loaded(Box::new(Loaded { ticket, path, result, ms })));
    })
}
