//! Draws further modes beside the picture, each with a view of its own, so that each has its range, its samples and its mean.
//!
//! Each mode has a `View` of its own, with its own range, accumulation buffer and probe.

use std::sync::Arc;

use super::cell::Cell;
use super::{FRAMES_IN_FLIGHT, Screen};
use crate::app::engine::Engine;
use crate::app::frames::picture::frame_of_mode;
use crate::app::state::State;
use crate::app::state::grid::{PictureRect, cells};
use crate::gpu::{Encoder, GpuError, Image, Use};
use crate::render::{Output, Redraw, View};

impl Screen {
    /// Splits the viewport into grid cells. The selected mode takes its cell through the normal path.
    pub(super) fn arrange_grid(&mut self, state: &State) {
        let modes = state.grid.modes();
        let selected = &state.session.settings.mode;
        let is_on = state.grid.is_on() && !state.compare.is_on();
        let place = modes.iter().position(|mode| mode == selected).filter(|_| is_on);
        let Some(place) = place else {
            self.rect = self.whole;
            self.cells.clear();
            return;
        };
        let rects = cells(modes.len(), self.whole);
        self.rect = rects[place];
        let others: Vec<_> = modes.iter().zip(&rects).filter(|(mode, _)| *mode != selected).collect();
        self.cells.retain(|cell| others.iter().any(|(mode, _)| **mode == cell.mode));
        for cell in &mut self.cells {
            if let Some((_, rect)) = others.iter().find(|(mode, _)| **mode == cell.mode) {
                cell.rect = **rect;
            }
        }
        self.wanted = others.into_iter().map(|(mode, rect)| (mode.clone(), *rect)).collect();
    }

    /// Updates the cells. Without memory, the grid ends.
    pub(super) fn prepare_grid(&mut self, state: &mut State, engine: &mut Engine) -> Result<(), GpuError> {
        let wanted = std::mem::take(&mut self.wanted);
        let prepared = wanted.into_iter().try_for_each(|(mode, rect)| self.prepare_cell(state, engine, mode, rect));
        if self.survive(prepared)?.is_none() {
            self.cells.clear();
            state.grid.end();
        }
        Ok(())
    }

    fn prepare_cell(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        mode: String,
        rect: PictureRect,
    ) -> Result<(), GpuError> {
        let at = match self.cells.iter().position(|cell| cell.mode == mode) {
            Some(at) => at,
            None => {
                let view = View::new(&engine.gpu, engine.resources.layouts(), FRAMES_IN_FLIGHT)?;
                let image = view.output_image(rect.size)?;
                self.cells.push(Cell { mode, rect, view, image, shown: None });
                self.cells.len() - 1
            }
        };
        let cell = &mut self.cells[at];
        if (cell.image.desc().width, cell.image.desc().height) != rect.size {
            cell.image = cell.view.output_image(rect.size)?;
        }
        cell.shown = frame_of_mode(state, engine, &cell.mode, rect.size, cell.shown.take())?;
        if let Some(shown) = &cell.shown {
            cell.view.prepare(&shown.frame)?;
        }
        Ok(())
    }

    /// Draws the cells over `target`, which is in [`Use::Color`] before and after.
    pub(super) fn draw_grid(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        target: &Arc<Image>,
    ) -> Result<(), GpuError> {
        for cell in &mut self.cells {
            let Some(shown) = &cell.shown else { continue };
            let output = Output { image: &cell.image, before: Use::Undefined, at: (0, 0) };
            let (view, frame) = (&mut cell.view, &shown.frame);
            encoder.untimed(|encoder| view.draw(encoder, slot, frame, &output, Redraw::IfChanged))?;
            encoder.transition(&cell.image, Use::Color, Use::CopyFrom);
            encoder.transition(target, Use::Color, Use::CopyTo);
            encoder.copy_image_to(&cell.image, target, cell.rect.at);
            encoder.transition(target, Use::CopyTo, Use::Color);
        }
        Ok(())
    }

    /// The cell under the mouse and the pixel of its picture.
    pub(super) fn mouse_cell(&self) -> Option<(usize, (u32, u32))> {
        self.cells.iter().enumerate().find_map(|(index, cell)| Some((index, pixel_in(cell.rect, self.mouse.at)?)))
    }

    /// The mode of the grid at a place of the window.
    pub(in crate::app) fn grid_mode_at(&self, at: glam::Vec2) -> Option<String> {
        self.cells.iter().find(|cell| pixel_in(cell.rect, at).is_some()).map(|cell| cell.mode.clone())
    }
}

/// The pixel of a rectangle at a place of the window.
fn pixel_in(rect: PictureRect, at: glam::Vec2) -> Option<(u32, u32)> {
    let (x, y) = (at.x - rect.at.0 as f32, at.y - rect.at.1 as f32);
    let (width, height) = rect.size;
    (x >= 0.0 && y >= 0.0).then_some((x as u32, y as u32)).filter(|(x, y)| *x < width && *y < height)
}
