//! Draws further modes beside the picture. Each has a view of its own, with its own range, accumulation buffer and probe.

use std::sync::Arc;

use glam::Vec2;

use super::request::FRAMES_IN_FLIGHT;
use crate::app::engine::last_complete::LastComplete;
use crate::app::state::grid::PictureRect;
use crate::gpu::{Encoder, Gpu, GpuError, Image, SetLayouts, Use};
use crate::render::{Output, Redraw, View};

/// A mode beside the picture.
pub(in crate::app) struct Cell {
    pub(super) mode: String,
    rect: PictureRect,
    pub(super) view: View,
    image: Arc<Image>,
    /// The last complete frame; `None` until the pipelines are ready.
    pub(in crate::app) shown: Option<LastComplete>,
}

impl Cell {
    /// Allocates the targets of its frame.
    pub(in crate::app) fn prepare(&mut self) -> Result<(), GpuError> {
        self.shown.as_ref().map_or(Ok(()), |shown| self.view.prepare(&shown.frame))
    }
}

/// The modes of the grid beside the selected one.
#[derive(Default)]
pub(super) struct Cells(pub(super) Vec<Cell>);

impl Cells {
    /// Drops all cells but these.
    pub(super) fn arrange(&mut self, others: &[(String, PictureRect)]) {
        let place = |cell: &Cell| others.iter().find(|(mode, _)| *mode == cell.mode).map(|(_, rect)| *rect);
        self.0.retain_mut(|cell| place(cell).map(|rect| cell.rect = rect).is_some());
    }

    /// The cell of a mode, with an image of its size.
    pub(super) fn cell(
        &mut self,
        (gpu, layouts): (&Arc<Gpu>, &Arc<SetLayouts>),
        mode: &str,
        rect: PictureRect,
    ) -> Result<&mut Cell, GpuError> {
        let at = match self.0.iter().position(|cell| cell.mode == mode) {
            Some(at) => at,
            None => {
                let view = View::new(gpu, layouts, FRAMES_IN_FLIGHT)?;
                let image = view.output_image(rect.size)?;
                self.0.push(Cell { mode: mode.to_owned(), rect, view, image, shown: None });
                self.0.len() - 1
            }
        };
        let cell = &mut self.0[at];
        if (cell.image.desc().width, cell.image.desc().height) != rect.size {
            cell.image = cell.view.output_image(rect.size)?;
        }
        Ok(cell)
    }

    /// Draws the cells over `target`, which is in [`Use::Color`] before and after.
    pub(super) fn draw(&mut self, encoder: &mut Encoder, slot: usize, target: &Arc<Image>) -> Result<(), GpuError> {
        for cell in &mut self.0 {
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

    /// The cell at a place of the window, and the pixel of its picture.
    pub(super) fn at(&self, at: Vec2) -> Option<(usize, (u32, u32))> {
        self.0.iter().enumerate().find_map(|(index, cell)| Some((index, pixel_in(cell.rect, at)?)))
    }

    /// The cell whose value is read.
    pub(super) fn probed(&self) -> Option<&Cell> {
        self.0.iter().find(|cell| cell.view.probe.is_some())
    }
}

/// The pixel of a rectangle at a place of the window.
fn pixel_in(rect: PictureRect, at: Vec2) -> Option<(u32, u32)> {
    let (x, y) = (at.x - rect.at.0 as f32, at.y - rect.at.1 as f32);
    let (width, height) = rect.size;
    (x >= 0.0 && y >= 0.0).then_some((x as u32, y as u32)).filter(|(x, y)| *x < width && *y < height)
}
