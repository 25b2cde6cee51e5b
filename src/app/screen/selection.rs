//! The outline of the selection, over the picture on the screen. Screenshots and recordings do not have it.

use std::sync::Arc;

use super::Screen;
use crate::app::actions::select::selected_instances;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::selection::stands_out;
use crate::app::widgets::theme::SELECTION;
use crate::gpu::{Encoder, GpuError, Image};
use crate::render::BoundFrame;
use crate::render::tools::{Outline, OutlineStyle};

/// Width of the line, points.
const WIDTH: f32 = 2.0;

impl Screen {
    /// Draws the outline of the selected instances of `frame` over its picture in `target`, which is in [`crate::gpu::Use::Color`] before
    /// and after. Without a selection, or if that is all of a single node, it does nothing and has no targets.
    pub(super) fn draw_outline(
        &mut self,
        encoder: &mut Encoder,
        state: &mut State,
        engine: &mut Engine,
        frame: Option<&BoundFrame>,
        target: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let selected = selected_instances(state);
        let stands_out =
            |frame: &BoundFrame| frame.state.scene.as_ref().is_some_and(|scene| stands_out(scene, &selected));
        let frame =
            frame.filter(|frame| frame.state.pipelines.draws_model && !selected.is_empty() && stands_out(frame));
        let Some((frame, tools)) = frame.and_then(|frame| Some((frame, engine.tools()?))) else {
            self.outline = None;
            return Ok(());
        };
        let size = frame.state.size;
        let outline = match self.outline.take().filter(|outline| outline.fits(size)) {
            Some(outline) => outline,
            None => Outline::new(&tools, size)?,
        };
        let [r, g, b, _] = SELECTION.to_array().map(|channel| f32::from(channel) / 255.0);
        let style = OutlineStyle { color: [r, g, b], width: WIDTH * self.egui.pixels_per_point() };
        let is_selected = |instance: usize| selected.get(instance) == Some(&true);
        encoder.pass("outline", |encoder| outline.draw(encoder, frame, is_selected, (target, self.rect.at), style));
        self.outline = Some(outline);
        Ok(())
    }
}
