//! Modes side by side: where each lies in the window, and its frame.

use super::picture::frame_of_mode;
use crate::app::engine::Engine;
use crate::app::panels::all::PictureArea;
use crate::app::screen::Screen;
use crate::app::state::State;
use crate::app::state::grid::{PictureRect, cells};
use crate::gpu::GpuError;

/// Places the picture in the area that the panels leave, and splits it among the modes of the grid. The selected mode takes its cell through
/// the normal path. Returns the others.
pub(super) fn arrange(
    state: &State,
    screen: &mut Screen,
    area: Option<PictureArea>,
    pixels_per_point: f32,
) -> Vec<(String, PictureRect)> {
    if let Some((extent, area)) = screen.extent().zip(area) {
        screen.whole = pixels(area.rect, pixels_per_point, extent);
    }
    let modes = state.grid.modes();
    let selected = &state.session.settings.mode;
    let is_on = state.grid.is_on() && !state.compare.is_on();
    let Some(place) = modes.iter().position(|mode| mode == selected).filter(|_| is_on) else {
        screen.arrange(screen.whole, &[]);
        return Vec::new();
    };
    let rects = cells(modes.len(), screen.whole);
    let all = modes.iter().cloned().zip(rects.iter().copied());
    let others: Vec<_> = all.filter(|(mode, _)| mode != selected).collect();
    screen.arrange(rects[place], &others);
    others
}

/// Updates the cells. Without memory, the grid ends.
pub(super) fn prepare_grid(
    state: &mut State,
    engine: &mut Engine,
    screen: &mut Screen,
    cells: &[(String, PictureRect)],
) -> Result<(), GpuError> {
    let prepared = cells.iter().try_for_each(|(mode, rect)| {
        let cell = screen.cell(mode, *rect)?;
        cell.shown = frame_of_mode(state, engine, mode, rect.size, cell.shown.take())?;
        cell.prepare()
    });
    if screen.survive(prepared)?.is_none() {
        screen.end_cells();
        state.grid.end();
    }
    Ok(())
}

/// Converts a rectangle from egui's points to pixels inside the window, with at least one pixel a side.
fn pixels(rect: egui::Rect, pixels_per_point: f32, (width, height): (u32, u32)) -> PictureRect {
    let pixel = |points: f32, most: u32| ((points * pixels_per_point).round().max(0.0) as u32).min(most);
    let (x, y) = (pixel(rect.min.x, width - 1), pixel(rect.min.y, height - 1));
    let right = pixel(rect.max.x, width).saturating_sub(x).max(1);
    PictureRect { at: (x, y), size: (right, pixel(rect.max.y, height).saturating_sub(y).max(1)) }
}
