//! The inspected pixel of a single shader file: the displayed color, and the values in the images of its passes. It has no model whose
//! modes could be drawn.

use crate::app::screen::Screen;
use crate::app::state::State;
use crate::app::state::inspection::Reading;

/// The pixel that each frame reports, if the inspector shows one. `mouse`: the pixel under the mouse.
pub(super) fn toy_pixel(state: &State, mouse: Option<(u32, u32)>) -> Option<(u32, u32)> {
    let is_on = state.shader.is_single_file && state.workspace.sight.inspector;
    let own = &state.inspection;
    let last = || own.reading.as_ref().map(|reading| (reading.at[0], reading.at[1]));
    let pinned = own.pin.map(|[x, y]| (x, y));
    pinned.or_else(|| mouse.or_else(last).filter(|_| own.follows)).filter(|_| is_on)
}

/// Takes the values of the newest finished frame. Returns whether the inspector shows others.
pub(super) fn take_toy_pixel(state: &mut State, screen: &Screen) -> bool {
    let Some((x, y)) = screen.view.probe_passes else { return false };
    let values = screen.pass_pixels();
    let (Some((_, first)), Some(shown)) = (values.first(), state.shown()) else { return false };
    let (at, picture, camera) = ([x, y], first.picture, shown.camera);
    let is_known = |reading: &Reading| (reading.at, reading.picture) == (at, picture);
    if state.inspection.reading.as_ref().is_some_and(is_known) {
        return false;
    }
    state.inspection.reading = Some(Reading {
        at,
        values: values.into_iter().map(|(slug, pixel)| (slug, (pixel.value, picture))).collect(),
        picture,
        is_complete: true,
        is_of_toy: true,
        exposure: 1.0,
        camera,
        lights: Vec::new(),
        names: None,
        texels: Vec::new(),
    });
    true
}
