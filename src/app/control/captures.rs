//! Renders on a background thread: pictures of another size or mode, values of a pixel, sheets and animations.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};

use super::files::write_capture;
use super::text::{path_text, short};
use crate::app::engine::Engine;
use crate::app::frames::reference::version_pictures;
use crate::app::state::State;
use crate::app::state::captures::Job;
use crate::capture::{
    Animation, CaptureError, OffscreenCapture, Page, Renderer as _, SheetPlan, Turntable, VersionPicture,
    cells_of_modes, modes_of,
};
use crate::control::Reply;
use crate::headless::HeadlessError;
use crate::recovery::SessionState;
use crate::render::Texel;
use crate::shader::{Compiler, Source};
use crate::threads::Message;

/// Time between two reports of progress.
const REPORT: Duration = Duration::from_millis(100);
impl Job {
    /// Draws it. `size` is that of the picture on screen, `tree` has what a stage is compiled with, `work` names the model and the
    /// shader tree. Returns the result of the answer.
    fn draw(
        self,
        offscreen: &mut OffscreenCapture,
        size: (u32, u32),
        (versions, tree, work): (&[VersionPicture], (&Compiler, &Source), SessionState),
        tell: &mut dyn FnMut(u64, u64) -> bool,
    ) -> Result<Value, CaptureError> {
        let wrong = |message: String| CaptureError::Usage(message);
        match self {
            Self::Picture { to, size: own, mode, frames } => {
                if let Some(mode) = mode {
                    modes_of(offscreen.session(), std::slice::from_ref(&mode)).map_err(wrong)?;
                    offscreen.settings().mode = mode;
                }
                offscreen.set_count(frames)?;
                let (is_linear, size) = (to.holds_light(), own.unwrap_or(size));
                offscreen.set_linear(is_linear);
                let capture = if is_linear { offscreen.capture(size) } else { offscreen.capture_display(size) }?;
                let shown = SessionState { settings: offscreen.session().shared_settings(), ..work };
                write_capture(&capture, &shown, &to).map_err(CaptureError::Write)
            }
            Self::Probe { at, names } => {
                let (x, y) = at;
                if x >= size.0 || y >= size.1 {
                    let (width, height) = size;
                    return Err(wrong(format!(
                        "[{x}, {y}] is outside of the picture, which has {width}x{height} pixels"
                    )));
                }
                let modes = modes_of(offscreen.session(), &names).map_err(wrong)?;
                let values: Vec<_> = modes.iter().zip(offscreen.pixel(size, at, &modes, tell)?).collect();
                let not_finite = offscreen.not_finite((size, at), &values, tree);
                let textures: Vec<Value> = offscreen.texels(size, at)?.iter().map(Texel::json).collect();
                let values: Map<String, Value> =
                    values.iter().map(|(mode, value)| (mode.slug.clone(), short(value.json(mode)))).collect();
                let mut found =
                    json!({ "pixel": [x, y], "size": [size.0, size.1], "modes": values, "textures": textures });
                if let Some(not_finite) = not_finite {
                    found["not_finite"] = not_finite.json();
                }
                Ok(found)
            }
            Self::Sheet { file, names, size, columns } => {
                let modes = modes_of(offscreen.session(), &names).map_err(wrong)?;
                let (count, cells) = (modes.len(), cells_of_modes(&offscreen.session().settings, &modes));
                SheetPlan { cells, size, columns, page: Page::Dark }.write(offscreen, &file, tell)?;
                Ok(json!({ "file": path_text(&file), "modes": count }))
            }
            Self::Turntable { file, frames, fps, size: own, turn } => {
                let plan = Turntable { frames, fps, size: own.unwrap_or(size), turn };
                plan.write(offscreen, &file, tell)?;
                Ok(json!({ "file": path_text(&file), "frames": frames }))
            }
            Self::Timeline { file, fps, size: own } => {
                let animation = Animation::new(&file, fps, versions.len())?;
                offscreen.timeline(versions, own.unwrap_or(size), animation, tell)?;
                Ok(json!({ "file": path_text(&file), "versions": versions.len() }))
            }
        }
    }
}

/// Draws on the thread of captures.
pub(in crate::app) fn begin_capture(state: &mut State, engine: &mut Engine, reply: Reply, job: Job) {
    let (number, canceled) = match state.captures.begin(job.title(), reply.key()) {
        Ok(begun) => begun,
        Err(message) => return reply.error(message),
    };
    let versions = match job {
        Job::Timeline { .. } => version_pictures(state, engine),
        _ => Vec::new(),
    };
    let size = state.shown().map_or((1, 1), |frame_state| frame_state.size);
    let (gpu, session, resources, clock) =
        (engine.gpu.clone(), state.session.clone(), engine.resources.clone(), state.picture.clock);
    let (compiler, source, work) = (engine.compiler.clone(), state.source.clone(), state.session_state());
    let (cancels, view) = (canceled.clone(), engine.capture_view.clone());
    engine.threads.capture(number, &cancels, move |sender| {
        let mut last: Option<Instant> = None;
        let mut tell = |done: u64, of: u64| {
            if last.is_none_or(|last| last.elapsed() >= REPORT) {
                last = Some(Instant::now());
                sender.send(Message::Captures(number, done, of));
                reply.progress(done, of);
            }
            !canceled.load(Ordering::Relaxed)
        };
        let result = match tell(0, 0) {
            true => OffscreenCapture::with_view(view.take(), &gpu, session, resources, (clock, &canceled))
                .map_err(|error| CaptureError::Render(error.into()))
                .and_then(|mut offscreen| {
                    let result = job.draw(&mut offscreen, size, (&versions, (&compiler, &source), work), &mut tell);
                    view.keep(offscreen.into_view());
                    result
                }),
            false => Err(CaptureError::Canceled),
        };
        match result {
            Ok(result) => reply.done(result),
            Err(CaptureError::Render(HeadlessError::Shaders(diagnostics))) if !diagnostics.is_empty() => {
                reply.error(diagnostics[0].one_line());
            }
            Err(error) => reply.error(error.to_string()),
        }
        sender.send(Message::Captured(number));
    });
}
