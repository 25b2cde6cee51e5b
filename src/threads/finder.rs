//! The finder looks for the first statement that makes NaN or infinity at the inspected pixel. The newest request wins.

use std::sync::Arc;

use super::message::{Message, MessageSender, TaskKind};
use super::newest::Newest;
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

/// The thread. Dropping this ends its search before the next step and waits for that.
pub(crate) struct Finder {
    gpu: Arc<Gpu>,
    thread: Newest<Box<FindRequest>>,
}

impl Finder {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), thread: Newest::new(TaskKind::Finder, sender) }
    }

    /// Searches for the statement and drops the previous request. Returns the number of the request.
    pub(crate) fn find(&mut self, request: FindRequest) -> u64 {
        self.thread.request(Box::new(request), || {
            let gpu = self.gpu.clone();
            move |sender, turn, mut request| {
                let found = find(&gpu, &mut request, &|| turn.is_superseded());
                if !turn.is_superseded() {
                    let found = NotFinite { mode: request.mode.slug.clone(), found };
                    sender.send(Message::NotFinite(turn.number, Box::new(found)));
                }
            }
        })
    }

    /// Ends the search that is under way before its next step.
    pub(crate) fn cancel(&self) {
        self.thread.supersede();
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
