//! The user interface on the device: its triangles over the picture, and the pictures that panels show.

use std::sync::Arc;

use super::Screen;
use crate::gpu::{Attachments, Encoder, GpuError, Image, Rect, Use};
use crate::render::tools::Tools;

impl Screen {
    /// Draws the user interface over an image in [`Use::Color`].
    pub(super) fn draw_ui(
        &mut self,
        encoder: &mut Encoder,
        image: &Arc<Image>,
        pixels_per_point: f32,
        primitives: &[egui::ClippedPrimitive],
    ) -> Result<(), GpuError> {
        let (width, height) = (image.desc().width, image.desc().height);
        encoder.transition(image, Use::Color, Use::Color);
        let area = Rect { x: 0, y: 0, width, height };
        let over = Attachments { area, ..Attachments::of(image) };
        encoder.begin_rendering(&over);
        self.ui.draw(encoder, (width, height), pixels_per_point, primitives)?;
        encoder.end_rendering();
        Ok(())
    }

    /// The picture of a texture for egui, and the part of it that shows the texture.
    pub(in crate::app) fn shown_texture(&self) -> Option<(egui::TextureId, egui::Rect)> {
        self.texture.shown()
    }

    /// Makes room for the picture of a texture. A lack of memory is kept for the end of the frame.
    pub(in crate::app) fn prepare_texture(&mut self, tools: &Tools, size: (u32, u32)) -> Result<(), GpuError> {
        let prepared = self.texture.prepare((&mut self.ui, &mut self.frames), tools, size);
        self.survive(prepared).map(drop)
    }

    /// Drops the thumbnails of modes if they do not fit any more. SYNC: waits for all frames; this is rare, because thumbnails change their
    /// size only with the width of their panel.
    pub(in crate::app) fn fit_thumbnails(&mut self, points: [f32; 2], pixels_per_point: f32) -> Result<(), GpuError> {
        if self.between.is_misfit(points, pixels_per_point) {
            self.frames.wait_all()?;
            self.between.drop_thumbnails(&mut self.ui)?;
        }
        Ok(())
    }

    /// Uploads egui's textures, and frees those that no later frame uses. The next frame tries a failed upload again.
    /// SYNC: waits for the frames in flight; this is rare, because textures change only with a new glyph or image.
    pub(in crate::app) fn take_textures(&mut self, delta: egui::TexturesDelta) -> Result<(), GpuError> {
        if !delta.is_empty() || !self.textures.is_empty() {
            self.frames.wait_all()?;
            self.ui.free_textures(&self.textures)?;
            self.textures.free.clear();
            self.textures.append(delta);
            self.ui.set_textures(&self.textures)?;
            self.textures.set.clear();
        }
        Ok(())
    }
}
