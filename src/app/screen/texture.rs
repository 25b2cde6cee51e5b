//! The picture of the texture that the panel Texture shows. It is drawn only when it changes, and only while the panel is in sight.

use std::sync::Arc;

use super::Screen;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::gpu::{DescriptorSet, Encoder, GpuError, Image, UiImage, Use};
use crate::render::BoundFrame;

/// Sides of the image that pictures are drawn to, pixels: at least and at most.
const SIDES: (u32, u32) = (256, 2048);

impl Screen {
    /// Makes room for the preview that the panel requests in this frame, before egui draws it. SYNC: waits for the frames in
    /// flight when the panel grows beyond the last image.
    pub(super) fn prepare_texture(&mut self, state: &mut State, engine: &mut Engine) -> Result<(), GpuError> {
        let Some(request) = &state.workspace.sight.texture else { return Ok(()) };
        let side = request.size.0.max(request.size.1).next_power_of_two().clamp(SIDES.0, SIDES.1);
        let fits = |image: &UiImage| image.image().desc().width >= side;
        if self.texture.image.as_ref().is_some_and(fits) {
            return Ok(());
        }
        let Some(tools) = engine.tools() else { return Ok(()) };
        if let Some(old) = self.texture.image.take() {
            self.frames.wait_all()?;
            self.texture.shown = None;
            self.ui.remove_image(old);
        }
        self.texture.drawn = None;
        self.texture.image = Some(self.ui.add_image(&tools.preview_image(side)?)?);
        Ok(())
    }

    /// Draws the picture if it differs from the last one.
    pub(super) fn draw_texture(
        &mut self,
        encoder: &mut Encoder,
        state: &mut State,
        engine: &mut Engine,
        frame: Option<&BoundFrame>,
    ) -> Result<(), GpuError> {
        let Some(request) = state.workspace.sight.texture.clone() else { return Ok(()) };
        let Some(tools) = engine.tools() else { return Ok(()) };
        let Some(image) = self.texture.image.as_ref() else {
            // The next frame starts with one.
            self.redraws = self.shortage.is_none();
            return Ok(());
        };
        let Some(texture) = engine.resources.texture(&request.source).cloned() else { return Ok(()) };
        let scene = frame.and_then(|frame| frame.state.scene.clone());
        let wanted = (request, scene);
        if self.texture.drawn.as_ref() == Some(&wanted) {
            return Ok(());
        }
        let is_same = |(before, _): &&(Arc<Image>, Arc<DescriptorSet>)| Arc::ptr_eq(before, &texture);
        let set = match self.texture.source.as_ref().filter(is_same) {
            Some((_, set)) => set.clone(),
            None => {
                let set = tools.texture_set(&texture)?;
                self.texture.source = Some((texture, set.clone()));
                set
            }
        };
        let (request, _) = &wanted;
        let target = (image.image(), Use::Undefined);
        let side = image.image().desc().width;
        let size = (request.size.0.clamp(1, side), request.size.1.clamp(1, side));
        encoder.pass("texture", |encoder| {
            tools.draw_texture(encoder, &set, &request.view, &request.meshes, frame, target, size);
        });
        let part = egui::vec2(size.0 as f32 / side as f32, size.1 as f32 / side as f32);
        self.texture.shown = Some((image.texture, egui::Rect::from_min_size(egui::Pos2::ZERO, part)));
        self.texture.drawn = Some(wanted);
        self.redraws = true;
        Ok(())
    }
}
