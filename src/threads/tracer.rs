//! The tracer draws the pinned pixel with a stage that logs what its statements do, while the panel Source is open. The newest request wins.

use std::sync::Arc;
use std::time::Instant;

use super::message::{Message, MessageSender, TaskKind};
use super::newest::{Newest, Turn};
use super::results::Traced;
use crate::frame::{Clock, TargetFormat};
use crate::gpu::Gpu;
use crate::headless::{HeadlessError, PixelTracer, Prepared, TracePlan, TraceTools, TracedPixel};
use crate::pipeline::PipelineSet;
use crate::render::{BoundFrame, Resources, View};
use crate::session::Session;
use crate::shader::trace::{Neighborhood, Trace};
use crate::shader::{Compiler, ShaderSet, Source};

/// Copies of what the picture is drawn with, the pixel, and the file whose statements are traced.
pub(crate) struct TraceRequest {
    pub(crate) compiler: Arc<Compiler>,
    pub(crate) session: Session,
    pub(crate) resources: Resources,
    pub(crate) source: Source,
    pub(crate) clock: Clock,
    pub(crate) size: (u32, u32),
    pub(crate) at: (u32, u32),
    /// `None`: the first that has the file, or that of the picture.
    pub(crate) stage: Option<String>,
    /// `None`: that of the stage itself.
    pub(crate) file: Option<String>,
}

/// An older version of the shaders.
pub(crate) struct OlderVersion {
    pub(crate) shaders: Arc<ShaderSet>,
    pub(crate) set: Arc<PipelineSet>,
    /// A frame with the light that its shaders baked, if there is one.
    pub(crate) like: Option<BoundFrame>,
}

/// A request to the thread.
enum Asked {
    /// A trace, and an older version of the shaders to compare with.
    Trace(Box<TraceRequest>, Option<OlderVersion>),
    /// The pixels around one.
    Around(Box<TraceRequest>),
    /// The modules that a click would need, for at most this many kinds of material.
    Prepare(Box<TraceRequest>, usize),
    /// The panel is closed: the memory is free for other things.
    Release,
}

/// The thread. Dropping this ends its trace before the next step and waits for that.
pub(crate) struct Tracer {
    gpu: Arc<Gpu>,
    thread: Newest<Asked>,
    done: fn(u64, Box<Traced>) -> Message,
    /// Whether the thread may hold memory of the device.
    is_used: bool,
}

impl Tracer {
    /// `done`: the message of a trace, by the number of its request.
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        sender: &MessageSender,
        task: TaskKind,
        done: fn(u64, Box<Traced>) -> Message,
    ) -> Self {
        Self { gpu: gpu.clone(), thread: Newest::new(task, sender), done, is_used: false }
    }

    /// Traces a pixel, then the same in an older version, and drops the previous request. Returns the number of the request.
    pub(crate) fn trace(&mut self, request: TraceRequest, before: Option<OlderVersion>) -> u64 {
        self.is_used = true;
        self.ask(Asked::Trace(Box::new(request), before))
    }

    /// Traces a file at the pixels around one, and drops the previous request. Returns the number of the request.
    pub(crate) fn trace_around(&mut self, request: TraceRequest) -> u64 {
        self.is_used = true;
        self.ask(Asked::Around(Box::new(request)))
    }

    /// Compiles what a trace of the request's file needs at any pixel, for at most this many kinds of material, and drops the previous request.
    /// Returns the number of the request.
    pub(crate) fn prepare(&mut self, request: TraceRequest, most: usize) -> u64 {
        self.is_used = true;
        self.ask(Asked::Prepare(Box::new(request), most))
    }

    /// Ends what is under way before its next step.
    pub(crate) fn cancel(&self) {
        self.thread.supersede();
    }

    /// Ends what is under way, and releases the memory.
    pub(crate) fn release(&mut self) {
        if std::mem::take(&mut self.is_used) {
            self.ask(Asked::Release);
        }
    }

    fn ask(&mut self, asked: Asked) -> u64 {
        self.thread.request(asked, || {
            let (gpu, done, mut tracer) = (self.gpu.clone(), self.done, None);
            move |sender: &MessageSender, turn: &Turn<'_>, asked| match asked {
                Asked::Release => tracer = None,
                Asked::Around(mut request) => {
                    let around = around(&gpu, &mut tracer, &mut request, turn).map_err(|error| error.to_string());
                    if !turn.is_superseded() {
                        sender.send(Message::TracedAround(turn.number, Box::new(around)));
                    }
                }
                Asked::Prepare(mut request, most) => {
                    let start = Instant::now();
                    let result = prepare(&gpu, &mut tracer, &mut request, most, turn);
                    if !turn.is_superseded() {
                        let (result, ms) =
                            (result.map_err(|error| error.to_string()), start.elapsed().as_secs_f64() * 1e3);
                        sender.send(Message::TracePrepared(turn.number, Box::new(result), ms));
                    }
                }
                Asked::Trace(mut request, before) => {
                    let start = Instant::now();
                    let number = turn.number;
                    let result = trace(&gpu, &mut tracer, &mut request, None, turn);
                    if turn.is_superseded() {
                        return;
                    }
                    let is_good = result.trace.is_ok();
                    let ms = start.elapsed().as_secs_f64() * 1e3;
                    sender.send(done(number, Box::new(Traced { ms, ..result })));
                    let Some(before) = before.filter(|_| is_good) else { return };
                    let result = trace(&gpu, &mut tracer, &mut request, Some(&before), turn);
                    if !turn.is_superseded() {
                        // Without it, the newer trace stands alone: the older version may lack the file, or its light is gone.
                        let found = result.trace.ok().map(|trace| Box::new((before.shaders, trace)));
                        sender.send(Message::TracedBefore(number, found));
                    }
                }
            }
        })
    }
}

/// Traces the pixel in the newest version of the shaders, or in an older one.
fn trace(
    gpu: &Arc<Gpu>,
    tracer: &mut Option<PixelTracer>,
    request: &mut TraceRequest,
    older: Option<&OlderVersion>,
    turn: &Turn<'_>,
) -> Traced {
    let mut traced = Traced::default();
    traced.trace = run(gpu, tracer, request, older, turn, &mut traced).map_err(|error| error.to_string());
    traced
}

/// Traces a file at the pixels around one, in the newest version of the shaders.
fn around(
    gpu: &Arc<Gpu>,
    tracer: &mut Option<PixelTracer>,
    request: &mut TraceRequest,
    turn: &Turn<'_>,
) -> Result<Neighborhood, HeadlessError> {
    let file = request.file.clone().unwrap_or_default();
    with_pixel(gpu, tracer, request, None, turn, |pixel, tracer, tools| tracer.neighborhood(pixel, tools, &file))
}

/// Compiles what a trace of the request's file needs at any pixel.
fn prepare(
    gpu: &Arc<Gpu>,
    tracer: &mut Option<PixelTracer>,
    request: &mut TraceRequest,
    most: usize,
    turn: &Turn<'_>,
) -> Result<Prepared, HeadlessError> {
    let file = request.file.clone();
    with_pixel(gpu, tracer, request, None, turn, |pixel, tracer, tools| {
        tracer.prepare(pixel, tools, file.as_deref(), most)
    })
}

/// Writes what is known before the trace to `traced`.
fn run(
    gpu: &Arc<Gpu>,
    tracer: &mut Option<PixelTracer>,
    request: &mut TraceRequest,
    older: Option<&OlderVersion>,
    turn: &Turn<'_>,
    traced: &mut Traced,
) -> Result<Trace, HeadlessError> {
    let file = request.file.clone();
    let end_if_superseded = || if turn.is_superseded() { Err(HeadlessError::Canceled) } else { Ok(()) };
    with_pixel(gpu, tracer, request, older, turn, |pixel, tracer, tools| {
        let plan = TracePlan::new(pixel, file.as_deref().as_slice())?;
        let place = &mut traced.place;
        (place.stage, place.stages) = (plan.stage().to_owned(), plan.stages());
        place.files = tracer.files(&plan, tools)?;
        let file = file.unwrap_or_else(|| place.stage.clone());
        place.file.clone_from(&file);
        end_if_superseded()?;
        let shown = tracer.value(&plan, tools)?;
        end_if_superseded()?;
        let before = tracer.built();
        let trace = tracer.trace(&plan, tools, &[&file], &shown);
        traced.built = tracer.built() - before;
        trace
    })
}

/// Calls `run` with the pixel of a request and what draws it, in the newest version of the shaders or in an older one.
fn with_pixel<T>(
    gpu: &Arc<Gpu>,
    tracer: &mut Option<PixelTracer>,
    request: &mut TraceRequest,
    older: Option<&OlderVersion>,
    turn: &Turn<'_>,
    run: impl FnOnce(&TracedPixel<'_>, &mut PixelTracer, &mut TraceTools<'_>) -> Result<T, HeadlessError>,
) -> Result<T, HeadlessError> {
    let lacks = |what: &str| HeadlessError::Settings(what.to_owned());
    let samples = request.session.settings.view.msaa;
    let target = View::target_format(gpu, samples, true).unwrap_or(TargetFormat::full(1));
    let TraceRequest { session, resources, compiler, source, clock, size, at, stage, .. } = request;
    let newest = resources.pipelines().cloned().ok_or_else(|| lacks("there are no shaders yet"))?;
    let set = older.map_or(&newest, |older| &older.set);
    let shaders = older.map_or(&newest.shaders, |older| &older.shaders);
    let slug = &session.settings.mode;
    let mode = shaders.modes.iter().find(|mode| mode.slug == *slug);
    let mode = mode.ok_or_else(|| lacks(&format!("the shaders have no mode {slug}")))?;
    let whole = session.frame_state_of(shaders, *clock, *size, target);
    let tracer = match tracer {
        Some(tracer) => tracer,
        none => none.insert(PixelTracer::new(gpu, resources.layouts())?),
    };
    let (settings, revisions) = (&session.settings, session.revisions);
    let older = older.map(|older| older.like.as_ref());
    let pixel = TracedPixel {
        whole: &whole,
        set,
        older,
        settings,
        revisions,
        clock: *clock,
        // The images of the window's passes hold earlier frames, which cannot be drawn again.
        earlier: &[],
        at: *at,
        mode,
        stage: stage.as_deref(),
        invocation: None,
    };
    run(
        &pixel,
        tracer,
        &mut TraceTools { resources, compiler, source, is_interactive: true, is_canceled: &|| turn.is_superseded() },
    )
}
