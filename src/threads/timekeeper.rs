//! The timekeeper draws the picture again and again while it rests: with and without each function of a stage, or in two versions of the
//! shaders, in turn. The newest request wins.

use std::sync::Arc;

use super::message::{Message, MessageSender, TaskKind};
use super::newest::{Newest, Turn};
use super::tracer::OlderVersion;
use crate::frame::{Clock, TargetFormat};
use crate::gpu::Gpu;
use crate::headless::{Contest, CostMeter, CostRequest, HeadlessError, StageCosts, TraceTools};
use crate::render::Resources;
use crate::session::Session;
use crate::shader::{Compiler, ShaderSet, Source};
use crate::statistics::Difference;

/// Copies of what the picture is drawn with.
pub(crate) struct TimedPicture {
    pub(crate) compiler: Arc<Compiler>,
    pub(crate) session: Session,
    pub(crate) resources: Resources,
    pub(crate) source: Source,
    pub(crate) clock: Clock,
    pub(crate) size: (u32, u32),
    pub(crate) target: TargetFormat,
    /// Most pairs of frames.
    pub(crate) most: usize,
}

/// The question about the picture.
pub(crate) enum TimeQuestion {
    /// The costs of the functions of a stage; without a stage, of the one that draws the picture.
    Functions(Option<String>, Vec<String>),
    /// By how much an older version of the shaders differs from the newest one.
    Version(OlderVersion),
}

/// A request to the thread.
enum Asked {
    Measure(Box<TimedPicture>, TimeQuestion),
    /// Nothing is measured any more: the memory is free for other things.
    Release,
}

/// The thread. Dropping this ends its work before the next frame and waits for that.
pub(crate) struct Timekeeper {
    gpu: Arc<Gpu>,
    thread: Newest<Asked>,
    /// Whether the thread may hold memory of the device.
    is_used: bool,
}

impl Timekeeper {
    pub(crate) fn new(gpu: &Arc<Gpu>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), thread: Newest::new(TaskKind::Timekeeper, sender), is_used: false }
    }

    /// Measures a picture, and drops the previous request. Returns the number of the request.
    pub(crate) fn measure(&mut self, picture: TimedPicture, question: TimeQuestion) -> u64 {
        self.is_used = true;
        self.ask(Asked::Measure(Box::new(picture), question))
    }

    /// Ends what is under way, and releases the memory.
    pub(crate) fn release(&mut self) {
        if std::mem::take(&mut self.is_used) {
            self.ask(Asked::Release);
        }
    }

    fn ask(&mut self, asked: Asked) -> u64 {
        self.thread.request(asked, || {
            let (gpu, mut meter) = (self.gpu.clone(), None);
            move |sender: &MessageSender, turn: &Turn<'_>, asked| match asked {
                Asked::Release => meter = None,
                Asked::Measure(mut picture, TimeQuestion::Functions(stage, functions)) => {
                    let result = functions_of(&gpu, &mut meter, &mut picture, (stage, &functions), turn);
                    if !turn.is_superseded() {
                        let result = result.map(Arc::new).map_err(|error| error.to_string());
                        sender.send(Message::FunctionsTimed(turn.number, result));
                    }
                }
                Asked::Measure(mut picture, TimeQuestion::Version(older)) => {
                    let result = version(&gpu, &mut meter, &mut picture, &older, turn);
                    if !turn.is_superseded() {
                        sender.send(Message::VersionTimed(turn.number, result.map_err(|error| error.to_string())));
                    }
                }
            }
        })
    }
}

fn lacks(what: &str) -> HeadlessError {
    HeadlessError::Settings(what.to_owned())
}

fn meter_of<'a>(
    gpu: &Arc<Gpu>,
    meter: &'a mut Option<CostMeter>,
    resources: &Resources,
) -> Result<&'a mut CostMeter, HeadlessError> {
    Ok(match meter {
        Some(meter) => meter,
        none => none.insert(CostMeter::new(gpu, resources.layouts())?),
    })
}

fn functions_of(
    gpu: &Arc<Gpu>,
    meter: &mut Option<CostMeter>,
    picture: &mut TimedPicture,
    (stage, functions): (Option<String>, &[String]),
    turn: &Turn<'_>,
) -> Result<StageCosts, HeadlessError> {
    let TimedPicture { compiler, session, resources, source, clock, size, target, most } = picture;
    let set = resources.pipelines().cloned().ok_or_else(|| lacks("there are no shaders yet"))?;
    let meter = meter_of(gpu, meter, resources)?;
    let state = |shaders: &Arc<ShaderSet>| session.frame_state_of(shaders, *clock, *size, *target);
    let request = CostRequest { state: &state, set: &set, stage: stage.as_deref(), functions, most: *most };
    let mut tools =
        TraceTools { resources, compiler, source, is_interactive: true, is_canceled: &|| turn.is_superseded() };
    meter.measure(&request, &mut tools, &mut |_, _, _| ())
}

fn version(
    gpu: &Arc<Gpu>,
    meter: &mut Option<CostMeter>,
    picture: &mut TimedPicture,
    older: &OlderVersion,
    turn: &Turn<'_>,
) -> Result<Difference, HeadlessError> {
    let TimedPicture { session, resources, clock, size, target, most, .. } = picture;
    let set = resources.pipelines().cloned().ok_or_else(|| lacks("there are no shaders yet"))?;
    let meter = meter_of(gpu, meter, resources)?;
    let light = || lacks("the light of one of the versions is gone");
    let state = session.frame_state_of(&set.shaders, *clock, *size, *target);
    set.build_aside(&state.pipelines)?;
    let newest = resources.bind_variant(&set, &state)?.ok_or_else(light)?;
    let state = session.frame_state_of(&older.shaders, *clock, *size, *target);
    older.set.build_aside(&state.pipelines)?;
    let before = resources.bind_older(&older.set, &state, older.like.as_ref())?.ok_or_else(light)?;
    let contest =
        Contest { frames: [&newest, &before], passes: &[], most: *most, is_canceled: &|| turn.is_superseded() };
    meter.compare(&contest)?.ok_or_else(|| lacks("a loop does not end in one of the versions"))
}
