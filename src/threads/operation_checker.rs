//! The operation checker draws the picture with stages that find assertions that fail and undefined operations. The newest request wins.

use std::sync::Arc;

use super::message::{Message, MessageSender, TaskKind};
use super::newest::{Newest, Turn};
use crate::frame::Clock;
use crate::gpu::Gpu;
use crate::headless::{CheckRequest, CheckedPicture, HeadlessError, PictureChecker, TraceTools};
use crate::render::{Resources, View};
use crate::session::Session;
use crate::shader::{Compiler, ShaderSet, Source};

/// Copies of what the picture is drawn with.
pub(crate) struct OperationCheck {
    pub(crate) compiler: Arc<Compiler>,
    pub(crate) session: Session,
    pub(crate) resources: Resources,
    pub(crate) source: Source,
    pub(crate) clock: Clock,
    pub(crate) size: (u32, u32),
    /// Whether all operations are checked, and not only what the author asserts and prints.
    pub(crate) undefined: bool,
}

/// A request to the thread.
enum Asked {
    Check(Box<OperationCheck>),
    /// Nothing is checked any more: the memory is free for other things.
    Release,
}

/// The thread. Dropping this ends its work before the next step and waits for that.
pub(crate) struct OperationChecker {
    gpu: Arc<Gpu>,
    thread: Newest<Asked>,
    /// Whether the thread may hold memory of the device.
    is_used: bool,
}

impl OperationChecker {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), thread: Newest::new(TaskKind::OperationChecker, sender), is_used: false }
    }

    /// Checks a picture, and drops the previous request. Returns the number of the request.
    pub(crate) fn check(&mut self, request: OperationCheck) -> u64 {
        self.is_used = true;
        self.ask(Asked::Check(Box::new(request)))
    }

    /// Ends what is under way, and releases the memory.
    pub(crate) fn release(&mut self) {
        if std::mem::take(&mut self.is_used) {
            self.ask(Asked::Release);
        }
    }

    fn ask(&mut self, asked: Asked) -> u64 {
        self.thread.request(asked, || {
            let (gpu, mut checker) = (self.gpu.clone(), None);
            move |sender: &MessageSender, turn: &Turn<'_>, asked| match asked {
                Asked::Release => checker = None,
                Asked::Check(mut request) => {
                    let result = check(&gpu, &mut checker, &mut request, turn);
                    if !turn.is_superseded() {
                        let result = result.map(Arc::new).map_err(|error| error.to_string());
                        sender.send(Message::OperationsChecked(turn.number, result));
                    }
                }
            }
        })
    }
}

fn check(
    gpu: &Arc<Gpu>,
    checker: &mut Option<PictureChecker>,
    request: &mut OperationCheck,
    turn: &Turn<'_>,
) -> Result<CheckedPicture, HeadlessError> {
    let lacks = |what: &str| HeadlessError::Settings(what.to_owned());
    // Each sample would run the stages again.
    request.session.settings.view.msaa = 1;
    let target = View::target_format(gpu, 1, true).map_err(HeadlessError::Settings)?;
    let OperationCheck { compiler, session, resources, source, clock, size, undefined } = request;
    let set = resources.pipelines().cloned().ok_or_else(|| lacks("there are no shaders yet"))?;
    let shaders = set.shaders.clone();
    let checker = match checker {
        Some(checker) => checker,
        none => none.insert(PictureChecker::new(gpu, resources.layouts())?),
    };
    let state = |shaders: &Arc<ShaderSet>, _| session.frame_state_of(shaders, *clock, *size, target);
    let request = CheckRequest { state: &state, frames: 1, shaders: &shaders, set: &set, undefined: *undefined };
    let mut tools =
        TraceTools { resources, compiler, source, is_interactive: true, is_canceled: &|| turn.is_superseded() };
    checker.check(&request, &mut tools)
}
