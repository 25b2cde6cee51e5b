//! The finder looks for the first statement that makes NaN or infinity at the inspected pixel. The newest request wins.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::{Message, MessageSender, TaskKind};
use crate::frame::{Clock, FrameInputs, Revisions, Scene, TargetFormat};
use crate::gpu::{Frames, Gpu};
use crate::headless::{Search, first_not_finite};
use crate::render::Resources;
use crate::settings::Settings;
use crate::shader::not_finite::NotFinite;
use crate::shader::{Compiler, FirstNotFinite, Mode, ShaderSet, Source};

/// Copies of what a frame is drawn with, the pixel, and the mode whose value is not finite there.
pub(crate) struct FindRequest {
    pub(crate) compiler: Arc<Compiler>,
    pub(crate) settings: Settings,
    pub(crate) shaders: Arc<ShaderSet>,
    pub(crate) scene: Option<Scene>,
    pub(crate) revisions: Revisions,
    pub(crate) resources: Resources,
    pub(crate) size: (u32, u32),
    pub(crate) at: (u32, u32),
    pub(crate) mode: Mode,
    pub(crate) source: Source,
}

/// The window's handle of the thread, which starts with the first request. Dropping it ends the thread and waits for it.
pub(crate) struct Finder {
    gpu: Arc<Gpu>,
    sender: MessageSender,
    jobs: Option<Sender<(u64, Box<FindRequest>)>>,
    /// Number of the newest request. The work of older ones ends before its next step.
    newest: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Finder {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), sender: sender.clone(), jobs: None, newest: Arc::default(), thread: None }
    }

    /// Searches for the statement and drops the previous request. Returns the number of the request.
    pub(crate) fn find(&mut self, request: FindRequest) -> u64 {
        let number = self.cancel();
        let is_over = self.thread.as_ref().is_none_or(JoinHandle::is_finished);
        if self.jobs.is_none() || is_over {
            let (sender, inbox) = unbounded();
            let (gpu, newest) = (self.gpu.clone(), self.newest.clone());
            self.thread = Some(self.sender.spawn(TaskKind::Finder, move |sender| run(&gpu, &inbox, &newest, sender)));
            self.jobs = Some(sender);
        }
        if let Some(jobs) = &self.jobs {
            // Fails only after the thread has panicked, which the window reports.
            let _ = jobs.send((number, Box::new(request)));
        }
        number
    }

    /// Cancels the last request before its next step. Returns a new number.
    pub(crate) fn cancel(&mut self) -> u64 {
        self.newest.fetch_add(1, Ordering::SeqCst) + 1
    }
}

impl Drop for Finder {
    fn drop(&mut self) {
        self.cancel();
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn run(gpu: &Arc<Gpu>, inbox: &Receiver<(u64, Box<FindRequest>)>, newest: &AtomicU64, sender: &MessageSender) {
    while let Ok(first) = inbox.recv() {
        let (number, mut request) = inbox.try_iter().last().unwrap_or(first);
        let is_canceled = || newest.load(Ordering::SeqCst) != number;
        if is_canceled() {
            continue;
        }
        let found = find(gpu, &mut request, &is_canceled);
        if !is_canceled() {
            let found = NotFinite { mode: request.mode.slug.clone(), found };
            sender.send(Message::NotFinite(number, Box::new(found)));
        }
    }
}

fn find(
    gpu: &Arc<Gpu>,
    request: &mut FindRequest,
    is_canceled: &dyn Fn() -> bool,
) -> Result<Option<FirstNotFinite>, String> {
    let mut frames = Frames::new(gpu, 1).map_err(|error| error.to_string())?;
    let picture = FrameInputs {
        settings: &request.settings,
        shaders: &request.shaders,
        scene: request.scene.as_ref(),
        revisions: request.revisions,
        clock: Clock::default(),
        size: request.size,
        target: TargetFormat::full(1),
    };
    let search = Search { picture, at: request.at, mode: &request.mode, source: &request.source, is_canceled };
    first_not_finite(gpu, &request.compiler, (&mut request.resources, &mut frames), &search)
}
