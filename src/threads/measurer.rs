//! The measurer measures the BRDF of a pixel's material, for the inspector: with the newest shaders, and with those before the last edit.
//! The newest request wins.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::{Message, MessageSender, TaskKind};
use crate::gpu::Gpu;
use crate::measure::{BrdfMeter, Curves, Material, prepare};
use crate::settings::Settings;
use crate::shader::{Compiler, ShaderSet, Source};

/// Request for curves.
#[derive(Clone)]
pub(crate) struct CurvesRequest {
    /// The newest shaders, and the previous ones.
    pub(crate) shaders: [Option<Arc<ShaderSet>>; 2],
    /// The tree that the measuring stages come from.
    pub(crate) tree: Source,
    pub(crate) settings: Settings,
    pub(crate) material: Material,
}

/// Result of a request for curves.
pub(crate) struct Measured {
    /// The number of the request.
    pub(crate) number: u64,
    /// The curves of the newest shaders, or the reason why there are none.
    pub(crate) now: Result<Curves, String>,
    /// The curves of the previous shaders, if they could be measured.
    pub(crate) before: Option<Curves>,
    pub(crate) ms: f64,
}

/// The window's handle of the thread, which starts with the first request. Dropping it ends the thread and waits for it.
pub(crate) struct Measurer {
    gpu: Arc<Gpu>,
    sender: MessageSender,
    jobs: Option<Sender<(u64, CurvesRequest)>>,
    /// Number of the newest request. The work of older ones ends before its next step.
    newest: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Measurer {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), sender: sender.clone(), jobs: None, newest: Arc::default(), thread: None }
    }

    /// Starts a measurement and drops the previous request. Returns the number of the request.
    pub(crate) fn measure(&mut self, compiler: &Arc<Compiler>, request: CurvesRequest) -> u64 {
        let number = self.cancel();
        let is_over = self.thread.as_ref().is_none_or(JoinHandle::is_finished);
        if self.jobs.is_none() || is_over {
            let (sender, inbox) = unbounded();
            let meters = BrdfMeters { gpu: self.gpu.clone(), compiler: compiler.clone(), made: Vec::new() };
            let newest = self.newest.clone();
            self.thread =
                Some(self.sender.spawn(TaskKind::Measurer, move |sender| run(meters, &inbox, &newest, sender)));
            self.jobs = Some(sender);
        }
        if let Some(jobs) = &self.jobs {
            // Fails only after the thread has panicked, which the window reports.
            let _ = jobs.send((number, request));
        }
        number
    }

    /// Cancels the last request before its next step. Returns a new number.
    pub(crate) fn cancel(&mut self) -> u64 {
        self.newest.fetch_add(1, Ordering::SeqCst) + 1
    }
}

impl Drop for Measurer {
    fn drop(&mut self) {
        self.cancel();
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn run(mut meters: BrdfMeters, inbox: &Receiver<(u64, CurvesRequest)>, newest: &AtomicU64, sender: &MessageSender) {
    while let Ok(first) = inbox.recv() {
        let (number, request) = inbox.try_iter().last().unwrap_or(first);
        let is_canceled = || newest.load(Ordering::SeqCst) != number;
        if is_canceled() {
            continue;
        }
        let start = Instant::now();
        let [now, before] = &request.shaders;
        meters.made.retain(|(of, _)| request.shaders.iter().flatten().any(|kept| Arc::ptr_eq(kept, of)));
        let Some(now) = now else { continue };
        let now = meters.curves(now, &request);
        let before = before.as_ref().filter(|_| !is_canceled()).map(|before| meters.curves(before, &request));
        if is_canceled() {
            continue;
        }
        let before = before.and_then(Result::ok);
        let ms = start.elapsed().as_secs_f64() * 1e3;
        sender.send(Message::Curves(Box::new(Measured { number, now, before, ms })));
    }
}

/// The compiled measuring stages of the newest shaders and of the previous ones.
struct BrdfMeters {
    gpu: Arc<Gpu>,
    compiler: Arc<Compiler>,
    /// By shaders, with the settings that their tables were baked for.
    made: Vec<(Arc<ShaderSet>, (Settings, BrdfMeter))>,
}

impl BrdfMeters {
    fn curves(&mut self, shaders: &Arc<ShaderSet>, request: &CurvesRequest) -> Result<Curves, String> {
        // Only the author's constants and parameters count.
        let settings = Settings { shader: request.settings.shader.clone(), ..Settings::default() };
        let made = self.made.iter_mut().find(|(of, _)| Arc::ptr_eq(of, shaders)).map(|(_, made)| made);
        let meter = match made {
            Some((of, meter)) if *of == settings => meter,
            Some(made) => {
                let meter = made.1.with(&settings).map_err(|error| error.to_string())?;
                *made = (settings, meter);
                &mut made.1
            }
            None => {
                let meter = prepare(&self.gpu, &self.compiler, &request.tree, &shaders.texts, &settings)?;
                self.made.push((shaders.clone(), (settings, meter)));
                match self.made.last_mut() {
                    Some((_, (_, meter))) => meter,
                    None => return Err("nothing was compiled".into()),
                }
            }
        };
        Curves::measure(meter, &request.material).map_err(|error| error.to_string())
    }
}
