//! Traces for other programs, and tells them of the pinned pixel.

use std::time::Duration;

use serde_json::json;

use super::trace::{REST, REST_ON_CPU, final_picture, request_of};
use crate::app::engine::Engine;
use crate::app::frames::progress::moves;
use crate::app::state::State;
use crate::events::{Event, emit};
use crate::threads::Traced;

/// Begins the next trace, and tells of another pixel or picture once it rests. Returns the time until that is to be looked at again.
pub(in crate::app) fn update_guests(state: &mut State, engine: &mut Engine, is_safe_mode: bool) -> Option<Duration> {
    if is_safe_mode {
        state.guests.fail("nothing is traced in safe mode");
        return None;
    }
    let asked = state.guests.next().cloned();
    if asked.is_none() && state.events.is_empty() {
        if state.guests.is_idle() {
            engine.threads.guest_tracer.release();
        }
        return None;
    }
    let picture = final_picture(state, engine, None)?;
    if let Some(guest) = asked {
        let request = request_of(state, engine, &picture, guest.at, (guest.stage, Some(&guest.file)));
        let number = engine.threads.guest_tracer.trace(request, None);
        state.guests.begin(number, picture.settings.mode.clone());
    }
    // A picture that moves would be told of in each of its frames.
    let now = (picture, state.inspection.pin);
    if moves(state) || state.events.is_empty() || !state.guests.is_news(&now) {
        return None;
    }
    let rest = if engine.gpu_is_fast() { REST } else { REST_ON_CPU };
    if let Some(left) = state.guests.rest_left(&now, rest) {
        return Some(left);
    }
    let moved = state.inspection.has_moved();
    let generation = now.0.shaders.generation;
    emit(&state.events, &Event::Pinned { pixel: now.1, moved, generation, tree: state.source.root() });
    state.guests.tell(now);
    None
}

/// Takes the result of a trace for another program.
pub(in crate::app) fn on_guest_traced(state: &mut State, number: u64, traced: Traced) {
    let Traced { place, trace, .. } = traced;
    state.guests.take(number, |guest, mode| {
        let trace = trace?;
        let fragment = trace.visible().ok_or("every fragment is discarded at this pixel")?;
        let mut json = trace.json(fragment);
        (json["pixel"], json["mode"], json["file"]) = (json!(guest.at), json!(mode), json!(place.file));
        json["proof"]["text"] = json!(trace.proof_text(fragment));
        Ok(json)
    });
}
