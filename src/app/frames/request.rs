//! Extracts the request of a frame from state and engine.

use super::progress::is_settled;
use super::results::shown;
use crate::app::actions::select::selected_instances;
use crate::app::engine::Engine;
use crate::app::interface::Shown;
use crate::app::screen::{FrameRequest, OutlineRequest, TextureDraw};
use crate::app::state::State;
use crate::app::state::adaptive::plan::Plan;
use crate::app::widgets::theme::SELECTION;
use crate::render::tools::OutlineStyle;
use crate::render::{BoundFrame, Redraw};

/// Width of the outline, points.
const WIDTH: f32 = 2.0;

/// The request for `frame`, shown as planned, below `interface`.
pub(super) fn frame_request<'a>(
    state: &mut State,
    engine: &mut Engine,
    (frame, plan): (Option<&'a BoundFrame>, Plan),
    interface: &'a Shown,
    copies_window: bool,
) -> FrameRequest<'a> {
    FrameRequest {
        frame,
        // Paths that nobody sees are traced where they are written.
        redraw: if plan == Plan::Kept || !state.has_window { Redraw::ToneMap } else { redraw(state, engine, frame) },
        plan,
        outline: outline(state, engine, frame, interface.pixels_per_point),
        texture: texture(state, engine),
        primitives: &interface.primitives,
        pixels_per_point: interface.pixels_per_point,
        copies_window,
    }
}

/// How much of the frame to draw. While the panel Timing is open, new shaders get a few more frames than they need, to be
/// measured.
fn redraw(state: &mut State, engine: &Engine, frame: Option<&BoundFrame>) -> Redraw {
    let Some(frame_state) = frame.map(|frame| &frame.state) else { return Redraw::IfChanged };
    let is_measurable = state.workspace.sight.timing && is_settled(state, engine) && !frame_state.pipelines.accumulates;
    match is_measurable && state.timing.wants_frame(&shown(frame_state)) {
        true => Redraw::Always,
        false => Redraw::IfChanged,
    }
}

/// The outline of the selected instances; `None` without a selection. Screenshots and recordings do not have it.
fn outline(
    state: &mut State,
    engine: &mut Engine,
    frame: Option<&BoundFrame>,
    pixels_per_point: f32,
) -> Option<OutlineRequest> {
    let selected = selected_instances(state);
    if selected.is_empty() || !frame?.state.pipelines.draws_model {
        return None;
    }
    let [r, g, b, _] = SELECTION.to_array().map(|channel| f32::from(channel) / 255.0);
    let style = OutlineStyle { color: [r, g, b], width: WIDTH * pixels_per_point };
    Some(OutlineRequest { tools: engine.tools()?, selected, style })
}

/// The texture that the panel Texture shows.
fn texture(state: &State, engine: &mut Engine) -> Option<TextureDraw> {
    let request = state.workspace.sight.texture.clone()?;
    let tools = engine.tools()?;
    let texture = engine.resources.texture(&request.source)?.clone();
    Some(TextureDraw { tools, texture, request })
}
