//! Previews of lower resolution while the picture moves, and the whole picture in parts once it rests: which of both a frame shows.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::picture::interim;
use super::progress::{awaits_edit, is_settled, moves};
use crate::app::engine::Engine;
use crate::app::screen::{ENLARGE, POLL, Part, Screen};
use crate::app::state::State;
use crate::app::state::adaptive::plan::Plan;
use crate::app::state::adaptive::{Change, Drawn, NextFrame};
use crate::events::{Event, emit};
use crate::frame::{BEYOND, Clock, FrameState, TargetFormat};
use crate::gpu::GpuError;
use crate::render::BoundFrame;
use crate::shader::GraphPass;

/// Passes whose time does not follow the size of the picture.
const FIXED: [&str; 3] = ["ui", ENLARGE, "texture"];

/// How much longer a multisampled pixel takes than one with a single sample, about.
const SAMPLES: f64 = 2.0;

/// The next step between frames.
pub(super) enum Step {
    /// A frame is due.
    Frame,
    /// Nothing else may be drawn for so long.
    After(Duration),
    /// No parts are left to draw.
    Done,
}

/// How the next frame shows the picture of `frame`. `before`: the frame before. `is_held`: whether a value is dragged. A lack of memory for a
/// preview shows the whole picture.
pub(super) fn plan(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    (frame, before): (Option<&BoundFrame>, Option<&BoundFrame>),
    is_held: bool,
) -> Result<Plan, GpuError> {
    let Some(frame) = frame else { return Ok(Plan::Whole) };
    // While a value is dragged, new light of the same pipelines and the pipelines of a draft are steps of a movement.
    let is_alike = |before: &BoundFrame| match is_held {
        true => state.edits.draft.is_some() || before.has_same_pipelines(frame),
        false => before.is_drawn_alike(frame),
    };
    let has_new = before.is_none_or(|before| before.state.size != frame.state.size || !is_alike(before));
    let is_alone = state.has_window && !state.compare.is_on() && !screen.has_reference() && !state.grid.is_on();
    let accumulates = frame.state.pipelines.accumulates;
    let is_single = frame.stands_alone() && !(accumulates && frame.is_animated());
    if !state.previews.may_preview(state.session.settings.view.adaptive) || !is_alone || !is_single {
        screen.end_previews();
        state.previews.show_whole(if has_new { Change::New } else { Change::Nothing }, accumulates);
        return Ok(Plan::Whole);
    }
    let is_same = |before: &BoundFrame| Arc::ptr_eq(&before.state, &frame.state) || before.state.is_same(&frame.state);
    let change = match before {
        _ if has_new => Change::New,
        Some(before) if is_same(before) && before.is_drawn_alike(frame) => Change::Nothing,
        _ => Change::Moved,
    };
    let view = &screen.view;
    let plan = state.previews.plan(&NextFrame {
        change,
        accumulates,
        is_held: view.holds(frame),
        improves: view.improves(frame),
        has_parts: view.rows_in_parts(frame) >= frame.state.size.1,
        is_awaited: is_awaited(state),
        now: Instant::now(),
    });
    if plan != Plan::Preview || (change == Change::Nothing && screen.previews(frame)) {
        return Ok(plan);
    }
    let preview = preview_of(state, engine, frame)?;
    let prepared = screen.prepare_preview(preview, frame);
    if screen.survive(prepared)?.is_none() {
        state.previews.show_whole(Change::Nothing, accumulates);
        return Ok(Plan::Whole);
    }
    Ok(plan)
}

/// Whether a command or a key waits for the whole picture.
fn is_awaited(state: &State) -> bool {
    state.screenshot || state.waiting.needs_picture()
}

/// The preview of a frame: with one sample per pixel, or with its own samples until pipelines for one are there.
fn preview_of(state: &mut State, engine: &mut Engine, frame: &BoundFrame) -> Result<BoundFrame, GpuError> {
    let (single, lacking) = single_of(state, engine, frame)?;
    if let Some(single) = single {
        return Ok(single);
    }
    // Path tracing shades each small triangle in four pixels at least, with several samples more of them: it cannot wait for a rest.
    if frame.state.pipelines.accumulates
        && let Some((lacking, set)) = lacking.zip(engine.resources.pipelines())
    {
        engine.threads.worker.build_preview(set, &lacking.pipelines);
    }
    let (clock, size) = clock_and_size(state, frame);
    let shown = engine.shown.as_ref().map(|shown| interim(state, shown, clock, size));
    Ok(shown.unwrap_or_else(|| frame.clone()))
}

/// The preview of a frame of the settings with one sample per pixel, and the state that lacks pipelines.
fn single_of(
    state: &mut State,
    engine: &mut Engine,
    frame: &BoundFrame,
) -> Result<(Option<BoundFrame>, Option<Arc<FrameState>>), GpuError> {
    let target = frame.state.pipelines.target;
    if target.samples == 1 || !state.picture.shows_settings {
        return Ok((None, None));
    }
    let (clock, size) = clock_and_size(state, frame);
    let single = state.session.frame_state(clock, size, TargetFormat { samples: 1, ..target });
    let Some(single) = single else { return Ok((None, None)) };
    let (bound, missing) = engine.resources.bind(&single, false)?;
    Ok((bound, missing.pipelines.then_some(single)))
}

/// The clock and the size of the preview of a frame.
fn clock_and_size(state: &State, frame: &BoundFrame) -> (Clock, (u32, u32)) {
    let side = state.previews.side();
    (at_scale(state.picture.clock, side), scaled(frame.state.size, side))
}

/// The size of the preview of a picture.
fn scaled((width, height): (u32, u32), side: f32) -> (u32, u32) {
    let of = |pixels: u32| ((pixels as f32 * side).round() as u32).max(1);
    (of(width), of(height))
}

/// Prepares the next preview while the picture rests: has the worker build its pipelines, and draws it once, unseen. Returns the time until
/// the next step; `None` if there is none.
pub(super) fn prepare_next(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
) -> Result<Option<Duration>, GpuError> {
    let is_due = state.previews.is_planned() && state.picture.is_complete && is_settled(state, engine);
    // Path tracing has asked for its pipelines before, and would take long for a frame that nobody sees.
    let lacks = |frame: &&BoundFrame| {
        is_due && !frame.state.pipelines.accumulates && !state.previews.is_warm(&frame.state.pipelines)
    };
    let Some(frame) = screen.last_frame().filter(lacks).cloned() else { return Ok(None) };
    if let Some(left) = state.previews.time_to_warm(Instant::now()) {
        return Ok(Some(left));
    }
    if !screen.parts_are_finished() {
        return Ok(Some(POLL));
    }
    match (single_of(state, engine, &frame)?, engine.resources.pipelines()) {
        ((Some(preview), _), _) => {
            let prepared = screen.prepare_preview(preview, &frame);
            if screen.survive(prepared)?.is_some() {
                screen.warm_preview()?;
            }
        }
        // Its message wakes the window.
        ((None, Some(single)), Some(set)) => {
            engine.threads.worker.build_preview(set, &single.pipelines);
            return Ok(None);
        }
        _ => {}
    }
    state.previews.warmed(&frame.state.pipelines);
    Ok(None)
}

/// The clock with the mouse in a picture of another size.
fn at_scale(clock: Clock, side: f32) -> Clock {
    let cursor_px = if clock.cursor_px == BEYOND { BEYOND } else { clock.cursor_px.map(|pixels| pixels * side) };
    Clock { mouse_px: clock.mouse_px.map(|pixels| pixels * side), cursor_px, ..clock }
}

/// The part of the picture that a frame draws.
pub(super) enum Drawing {
    /// Nothing of it is new.
    Nothing,
    Whole,
    /// All that follows the model, which is drawn in parts.
    Rest,
    Preview,
}

impl Drawing {
    /// The part that the next frame draws.
    pub(super) fn of(screen: &Screen, frame: Option<&BoundFrame>, plan: Plan) -> Self {
        let Some(frame) = frame else { return Self::Nothing };
        match plan {
            Plan::Preview => Self::Preview,
            Plan::Whole if screen.view.rows_in_parts(frame) >= frame.state.size.1 => Self::Rest,
            Plan::Whole if !screen.view.holds(frame) => Self::Whole,
            Plan::Whole | Plan::Kept => Self::Nothing,
        }
    }

    /// The frame that the panel Timing shows the time of; `None` if it took only a part of it.
    pub(super) fn timed<'a>(&self, screen: &'a Screen, frame: Option<&'a BoundFrame>) -> Option<&'a BoundFrame> {
        match self {
            Self::Preview => screen.preview_frame(),
            Self::Rest => None,
            Self::Whole | Self::Nothing => frame,
        }
    }
}

/// Notes what the frame that has just been submitted has drawn.
pub(super) fn submitted(state: &mut State, screen: &Screen, frame: Option<&BoundFrame>, drawing: &Drawing) {
    let Some(frame) = frame else { return };
    if let Some(movement) = state.previews.take_movement() {
        let (size, ms) = (scaled(frame.state.size, movement.side).into(), movement.time().as_secs_f64() * 1e3);
        let whole_ms = movement.time_since(Instant::now()).as_secs_f64() * 1e3;
        emit(&state.events, &Event::Previews { shown: movement.previews, size, ms, whole_ms });
    }
    let samples = |frame: &BoundFrame| frame.state.pipelines.target.samples;
    let pixels = |frame: &BoundFrame| f64::from(frame.state.size.0) * f64::from(frame.state.size.1);
    let drawn = match (drawing, screen.preview_frame()) {
        (Drawing::Preview, Some(preview)) => {
            let more_samples = if samples(frame) > samples(preview) { SAMPLES } else { 1.0 };
            Drawn::Preview {
                side: state.previews.side(),
                pixels_of_whole: more_samples * pixels(frame) / pixels(preview),
                accumulates: frame.state.pipelines.accumulates,
            }
        }
        (Drawing::Whole, _) => Drawn::Whole { parts_ms: 0.0 },
        (Drawing::Rest, _) => Drawn::Whole { parts_ms: screen.parts_ms() },
        _ => return,
    };
    state.previews.submitted(screen.frames().submitted(), drawn, Instant::now());
}

/// Takes the times of the newest finished frame.
pub(super) fn take_times(state: &mut State, screen: &Screen) {
    let frames = screen.frames();
    let Some(ms) = frames.last_device_ms() else { return };
    let passes = state.shown().map_or(&[][..], |shown| &shown.pipelines.passes);
    let is_fixed = |name: &str| {
        let is_of_one_size = |pass: &GraphPass| pass.desc.size.pixels((64, 64)) == pass.desc.size.pixels((128, 128));
        FIXED.contains(&name) || passes.iter().any(|pass| pass.name() == name && is_of_one_size(pass))
    };
    let fixed_ms = frames.pass_times().iter().filter(|pass| is_fixed(&pass.name)).map(|pass| pass.ms).sum();
    if state.previews.finished(frames.timed(), ms, fixed_ms) {
        tracing::debug!("frame {}: {ms:.1} ms, of which {fixed_ms:.1} ms at any size", frames.timed());
    }
}

/// Draws the next part of the whole picture, if the last frame lacks it and nothing goes before.
pub(super) fn draw_part(state: &mut State, engine: &Engine, screen: &mut Screen) -> Result<Step, GpuError> {
    let Some(wait) = state.previews.time_to_parts(is_awaited(state), Instant::now()) else { return Ok(Step::Done) };
    // An animation never rests, and what else is drawn between frames waits for its own time.
    if awaits_edit(state, engine) || moves(state) {
        return Ok(Step::Done);
    }
    if !wait.is_zero() {
        return Ok(Step::After(wait));
    }
    if !screen.between.is_finished() {
        return Ok(Step::After(POLL));
    }
    Ok(match screen.draw_part()? {
        Part::Drawing => Step::After(POLL),
        Part::Due => Step::Frame,
        Part::Failed => {
            state.previews.give_up();
            Step::Frame
        }
    })
}
