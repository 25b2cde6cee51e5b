//! Everything of a frame beside the picture and the panels: the grid, and what lies over the picture.

use std::sync::Arc;

use super::Screen;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::gpu::{Encoder, GpuError, Image};
use crate::render::BoundFrame;

impl Screen {
    /// Records them for frame slot `slot`, into the window's image. An out-of-memory error in the outline, the texture or the grid drops that
    /// part; any other error ends the frame.
    pub(super) fn draw_extras(
        &mut self,
        (encoder, slot): (&mut Encoder, usize),
        state: &mut State,
        engine: &mut Engine,
        frame: Option<&BoundFrame>,
        image: &Arc<Image>,
    ) -> Result<(), GpuError> {
        self.draw_reference(encoder, slot, image, self.rect.at)?;
        let outlined = self.draw_outline(encoder, state, engine, frame, image);
        self.survive(outlined)?;
        let shown = self.draw_texture(encoder, state, engine, frame);
        self.survive(shown)?;
        let grid = self.draw_grid(encoder, slot, image);
        if self.survive(grid)?.is_none() {
            self.cells.clear();
            state.grid.end();
        }
        Ok(())
    }
}
