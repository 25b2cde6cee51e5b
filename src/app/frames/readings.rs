//! Values from engine and screen for the panels.

use super::memory::MemoryClock;
use super::readout::readout;
use super::title::title;
use crate::app::engine::Engine;
use crate::app::panels::overlay::swatches::swatches;
use crate::app::readings::{LegendOf, Readings};
use crate::app::screen::Screen;
use crate::app::state::State;

/// The values at the start of a frame.
pub(super) fn readings<'a>(
    state: &State,
    engine: &'a Engine,
    screen: &'a Screen,
    memory: &'a mut MemoryClock,
) -> Readings<'a> {
    // Those of a preview are not the picture's.
    let pixel = screen.pixel_under_mouse(state.shown()).filter(|_| state.previews.is_whole());
    let value = pixel.and_then(|pixel| {
        let sides = if screen.has_reference() { state.side_names() } else { None };
        readout(&pixel, sides)
    });
    Readings {
        value,
        title: title(state, screen.accumulated(state.previews.is_preview())),
        legend: legend(state, screen),
        thumbnails: screen.between.thumbnails(),
        texture: screen.shown_texture(),
        baking: engine.threads.baker.progress(),
        pipelines: engine.resources.pipelines().map_or(0, |set| set.count()),
        baked: &engine.resources.environment().report,
        memory: state.workspace.sight.timing.then(|| memory.read(&engine.gpu)),
    }
}

/// The contents of the legend for the picture under the mouse.
fn legend(state: &State, screen: &Screen) -> Option<LegendOf> {
    let (frame_state, view) = screen.pointed_view(state.shown())?;
    let mode = frame_state.mode()?.clone();
    let scene = state.session.scene();
    Some(LegendOf {
        swatches: swatches(&mode, scene.as_ref(), &frame_state.shaders),
        mode,
        limits: view.limits(),
        range_sample: view.range_sample().cloned(),
        colormap: frame_state.display.colormap(),
        exposure: frame_state.exposure(),
    })
}
