//! `bench scale`: how the time of a frame grows with the number of lights.

use glam::Vec3;
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::scene::{Light, LightKind, Model, built_in};
use specula::settings::LightSource;

use super::steps::{Growth, Times, frames, turned};
use crate::commands::Failure;
use crate::commands::bench::context::Bench;

/// Numbers of lights.
const LIGHTS: [usize; 4] = [1, 10, 100, 1_000];
/// The built-in model that is lit: the corner of a room, with balls.
const BASE: &str = "many-lights";
/// Lights that reach a point of the room, on average. More lights have a shorter range, as in scenes of this size.
const REACHING: f32 = 4.0;

/// Times frames of each number of lights while the camera turns. `growth` is the factor by which the device time grows from the step
/// before, or the CPU time where the device has no clock.
pub(super) fn lights(bench: &Bench<'_>, headless: &mut Headless) -> Result<Vec<Value>, Failure> {
    let missing = || Failure::Input(format!("the built-in model {BASE} is missing"));
    let base = built_in(BASE).and_then(Result::ok).ok_or_else(missing)?;
    let settings = headless.settings_mut().clone();
    headless.settings_mut().lights.source = LightSource::Model;
    let (mut found, mut growth) = (Vec::new(), Growth::default());
    for (index, count) in LIGHTS.into_iter().enumerate() {
        bench.progress.begin("step", (index, LIGHTS.len()), &format!("{count} lights"));
        let model = lit_by(&base, count);
        let range_m = model.lights.first().and_then(|light| light.range);
        headless.set_model(model)?;
        let Times { cpu, device } = frames(bench, headless, turned)?;
        let growth = growth.to(device["min"].as_f64().or_else(|| cpu["min"].as_f64()));
        found.push(json!({
            "lights": count,
            "range_m": range_m,
            "cpu_ms": cpu,
            "device_ms": device,
            "growth": growth,
        }));
    }
    *headless.settings_mut() = settings;
    Ok(found)
}

/// The model with as many point lights, spread evenly over its bounds. Each point is reached by [`REACHING`] of them, and is as bright
/// with any number.
fn lit_by(base: &Model, count: usize) -> Model {
    let size = base.bounds.max - base.bounds.min;
    let part = count as f32 / REACHING;
    let range = (size.x * size.y * size.z / (part * 4.0 / 3.0 * std::f32::consts::PI)).cbrt();
    // The R3 sequence (Roberts 2018): powers of the root of x^4 = x + 1.
    let step = Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let light = |index: usize| Light {
        name: "".into(),
        kind: LightKind::Point,
        position: base.bounds.min + size * (Vec3::splat(0.5) + step * index as f32).fract(),
        direction: Vec3::NEG_Y,
        intensity: Vec3::new(1.0, 0.9, 0.7) * (4.0 * range * range),
        range: Some(range),
    };
    Model { lights: (0..count).map(light).collect(), ..base.clone() }
}
