//! The times of frames, and how they grow from one step of a series to the next.

use serde_json::Value;
use specula::cpu_clock::CpuClock;
use specula::headless::{Headless, HeadlessError};

use crate::commands::bench::context::Bench;
use crate::commands::bench::samples::{round, summary};

/// Times of frames, ms, as [`summary`] reports them.
pub(super) struct Times {
    pub(super) cpu: Value,
    pub(super) device: Value,
}

/// Times `frame` as often as the user asks for samples, after one frame of the model that [`Headless::draw`] draws.
pub(super) fn frames(
    bench: &Bench<'_>,
    headless: &mut Headless,
    mut frame: impl FnMut(&mut Headless) -> Result<(), HeadlessError>,
) -> Result<Times, HeadlessError> {
    headless.draw()?;
    let (mut cpu, mut device) = (Vec::new(), Vec::new());
    for _ in 0..bench.args.samples {
        let clock = CpuClock::start();
        frame(headless)?;
        cpu.extend(clock.map(CpuClock::ms));
        device.extend(headless.device_ms());
    }
    Ok(Times { cpu: summary(cpu), device: summary(device) })
}

/// A frame of a camera that turns.
pub(super) fn turned(headless: &mut Headless) -> Result<(), HeadlessError> {
    headless.settings_mut().camera.azimuth += 0.001;
    headless.draw()
}

/// The time of the step before.
#[derive(Default)]
pub(super) struct Growth(Option<f64>);

impl Growth {
    /// The factor by which the time of a step, ms, is larger than that of the step before; `None` for the first.
    pub(super) fn to(&mut self, now: Option<f64>) -> Option<f64> {
        let before = std::mem::replace(&mut self.0, now);
        now.zip(before).map(|(now, before)| round(now / before))
    }
}
