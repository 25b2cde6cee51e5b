//! The command `playback`: the clock of animated shaders.

use serde::Deserialize;
use serde_json::json;

use super::spec::{Outcome, Spec, Until};
use crate::app::control::short;
use crate::app::engine::Engine;
use crate::app::state::State;

/// Fields of `playback`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct PlaybackFields {
    pub(in crate::app) paused: Option<bool>,
    pub(in crate::app) step: bool,
    pub(in crate::app) restart: bool,
    pub(in crate::app) time: Option<f32>,
    pub(in crate::app) speed: Option<f32>,
}

pub(in crate::app) static PLAYBACK: Spec<PlaybackFields> = Spec::new("playback", play).takes(
    r#""paused"?: bool, "step"?: true, "restart"?: true, "time"?: s, "speed"?: factor"#,
    "The clock of animated shaders and models. When another model or tree is opened it begins at 0, and in a window it runs. Result: time, paused, speed",
);

fn play(state: &mut State, _: &mut Engine, asked: PlaybackFields) -> Outcome {
    if asked.time.is_some_and(|time| !time.is_finite()) {
        return Err("`time` is not finite; it takes seconds".to_owned());
    }
    if let Some(speed) = asked.speed.filter(|speed| !(0.0..=100.0).contains(speed)) {
        return Err(format!("`speed` is {speed}; it can be 0 to 100"));
    }
    let playback = &mut state.playback;
    playback.speed = asked.speed.unwrap_or(playback.speed);
    playback.paused = asked.paused.unwrap_or(playback.paused);
    if asked.restart {
        playback.restart();
    }
    if let Some(time) = asked.time {
        playback.seek(time);
    }
    if asked.step {
        playback.step();
    }
    let is_animated = state.is_animated();
    let playback = &state.playback;
    Ok(Until::Now(
        json!({ "time": short(playback.time_s()), "paused": playback.paused, "speed": short(playback.speed), "is_animated": is_animated }),
    ))
}
