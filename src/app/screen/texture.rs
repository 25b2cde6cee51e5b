//! The picture of the texture that the panel Texture shows. It is drawn only when it changes, and only while the panel is in sight.

use std::sync::Arc;

use super::request::TextureDraw;
use crate::app::state::workspace::TextureRequest;
use crate::frame::Scene;
use crate::gpu::{DescriptorSet, Encoder, Frames, GpuError, Image, UiImage, UiRenderer, Use};
use crate::render::BoundFrame;
use crate::render::tools::Tools;

/// Sides of the image that pictures are drawn to, pixels: at least and at most.
const SIDES: (u32, u32) = (256, 2048);

/// The picture of a texture.
#[derive(Default)]
pub(super) struct ShownTexture {
    image: Option<UiImage>,
    /// The texture for egui, and the part of it that shows the picture.
    shown: Option<(egui::TextureId, egui::Rect)>,
    /// The texture that is read, with its descriptor set.
    source: Option<(Arc<Image>, Arc<DescriptorSet>)>,
    /// Request that the image shows, and the scene whose meshes it draws.
    drawn: Option<(TextureRequest, Option<Scene>)>,
}

impl ShownTexture {
    /// The picture for egui, and the part of it that shows the texture.
    pub(super) fn shown(&self) -> Option<(egui::TextureId, egui::Rect)> {
        self.shown
    }

    /// Draws the picture again: the commands of a frame were not submitted.
    pub(super) fn forget(&mut self) {
        self.drawn = None;
    }

    /// Makes room for a picture of this size before egui draws it. SYNC: waits for the frames in flight when the panel grows beyond the
    /// last image.
    pub(super) fn prepare(
        &mut self,
        (ui, frames): (&mut UiRenderer, &mut Frames),
        tools: &Tools,
        (width, height): (u32, u32),
    ) -> Result<(), GpuError> {
        let side = width.max(height).next_power_of_two().clamp(SIDES.0, SIDES.1);
        let fits = |image: &UiImage| image.image().desc().width >= side;
        if self.image.as_ref().is_some_and(fits) {
            return Ok(());
        }
        if let Some(old) = self.image.take() {
            frames.wait_all()?;
            self.shown = None;
            ui.remove_image(old);
        }
        self.drawn = None;
        self.image = Some(ui.add_image(&tools.preview_image(side)?)?);
        Ok(())
    }

    /// Draws the picture if it differs from the last one. Returns whether another frame must follow, to show it or to make room for it.
    pub(super) fn draw(
        &mut self,
        encoder: &mut Encoder,
        draw: &TextureDraw,
        frame: Option<&BoundFrame>,
    ) -> Result<bool, GpuError> {
        let TextureDraw { tools, texture, request } = draw;
        let Some(image) = self.image.as_ref() else { return Ok(true) };
        let scene = frame.and_then(|frame| frame.state.scene.as_ref());
        if self.drawn.as_ref().is_some_and(|(drawn, of)| (drawn, of.as_ref()) == (request, scene)) {
            return Ok(false);
        }
        let is_same = |(before, _): &&(Arc<Image>, Arc<DescriptorSet>)| Arc::ptr_eq(before, texture);
        let set = match self.source.as_ref().filter(is_same) {
            Some((_, set)) => set.clone(),
            None => {
                let set = tools.texture_set(texture)?;
                self.source = Some((texture.clone(), set.clone()));
                set
            }
        };
        let target = (image.image(), Use::Undefined);
        let side = image.image().desc().width;
        let size = (request.size.0.clamp(1, side), request.size.1.clamp(1, side));
        encoder.pass("texture", |encoder| {
            tools.draw_texture(encoder, &set, &request.view, &request.meshes, frame, target, size);
        });
        let part = egui::vec2(size.0 as f32 / side as f32, size.1 as f32 / side as f32);
        self.shown = Some((image.texture, egui::Rect::from_min_size(egui::Pos2::ZERO, part)));
        self.drawn = Some((request.clone(), scene.cloned()));
        Ok(true)
    }
}
