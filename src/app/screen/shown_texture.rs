//! The picture of a texture, and what it was drawn from.

use std::sync::Arc;

use crate::app::state::workspace::TextureRequest;
use crate::frame::Scene;
use crate::gpu::{DescriptorSet, Image, UiImage};

/// The picture of a texture.
#[derive(Default)]
pub(super) struct ShownTexture {
    pub(super) image: Option<UiImage>,
    /// The texture for egui, and the part of it that shows the picture.
    pub(super) shown: Option<(egui::TextureId, egui::Rect)>,
    /// The texture that is read, with its descriptor set.
    pub(super) source: Option<(Arc<Image>, Arc<DescriptorSet>)>,
    /// Request that the image shows, and the scene whose meshes it draws.
    pub(super) drawn: Option<(TextureRequest, Option<Scene>)>,
}

impl ShownTexture {
    /// Draws the picture again: the commands of a frame were not submitted.
    pub(super) fn forget(&mut self) {
        self.drawn = None;
    }
}
