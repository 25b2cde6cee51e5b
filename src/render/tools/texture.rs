//! Pictures of a texture as the device has it: a part, a level and channels, with the texture coordinates of meshes over it.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Affine2;

use super::{Tools, UV};
use crate::gpu::{
    Attachments, DescriptorSet, Encoder, GpuError, Image, ImageDesc, PassResource, PrimitiveClass, Rect, Sampler,
    SamplerDesc, Use, vk,
};
use crate::render::BoundFrame;

/// Format of the previews. It encodes sRGB.
pub const PREVIEW_FORMAT: vk::Format = vk::Format::B8G8R8A8_SRGB;

/// A part of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureView {
    /// Corner of the part, in texture coordinates.
    pub corner: [f32; 2],
    /// Its size, in texture coordinates.
    pub size: [f32; 2],
    /// Mip level; `None` is the level that fits the scale.
    pub level: Option<u32>,
    /// 0: RGB. 1: RGB over a checkerboard. 2 to 5: one of the channels R, G, B and A.
    pub channels: u32,
    /// Whether the texture is sRGB-encoded.
    pub is_srgb: bool,
}

/// The meshes whose texture coordinates are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct UvMesh {
    /// Index into `Model::primitives`.
    pub primitive: usize,
    /// 0 or 1.
    pub uv_set: u32,
    /// Texture coordinates from those of the mesh.
    pub uv_from_mesh: Affine2,
}

/// The push constants of texture.frag.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    corner: [f32; 2],
    size: [f32; 2],
    level: f32,
    channels: u32,
    is_srgb: u32,
    square: f32,
}

/// The push constants of uv.vert.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct UvPush {
    vertices: u64,
    first: u32,
    uv_from_mesh: [[f32; 2]; 3],
    corner: [f32; 2],
    size: [f32; 2],
    padding: u32,
}

impl Tools {
    /// Creates an image for previews of textures.
    ///
    /// # Errors
    /// Out of memory.
    pub fn preview_image(&self, side: u32) -> Result<Arc<Image>, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let desc = ImageDesc::new(side, side, PREVIEW_FORMAT, Usage::COLOR_ATTACHMENT | Usage::SAMPLED);
        Image::new(&self.gpu, "picture of a texture", desc)
    }

    /// The descriptor set that reads a texture.
    ///
    /// # Errors
    /// Out of memory.
    pub fn texture_set(&self, texture: &Arc<Image>) -> Result<Arc<DescriptorSet>, GpuError> {
        // Magnified texels stay square.
        let desc = SamplerDesc {
            mag: vk::Filter::NEAREST,
            wrap_u: vk::SamplerAddressMode::REPEAT,
            wrap_v: vk::SamplerAddressMode::REPEAT,
            ..SamplerDesc::LINEAR
        };
        let sampler = Sampler::new(&self.gpu, &desc)?;
        self.one_texture.set("set of a shown texture", &[PassResource::Texture(texture, &sampler)])
    }

    /// Draws a part of the texture in `set` to the upper left `size` pixels of `preview`, with the texture coordinates of `meshes`, which
    /// `frame` draws. `before` is the use of `preview`; it is in [`Use::Sampled`] afterwards.
    #[expect(clippy::too_many_arguments, reason = "what is drawn, and where")]
    pub fn draw_texture(
        &self,
        encoder: &mut Encoder,
        set: &Arc<DescriptorSet>,
        view: &TextureView,
        meshes: &[UvMesh],
        frame: Option<&BoundFrame>,
        (preview, before): (&Arc<Image>, Use),
        (width, height): (u32, u32),
    ) {
        encoder.transition(preview, before, Use::Color);
        let area = Rect { x: 0, y: 0, width, height };
        encoder.begin_rendering(&Attachments { area, ..Attachments::of(preview) });
        encoder.bind_pipeline(&self.texture);
        encoder.bind_pass_set(&self.one_texture, set);
        let TextureView { corner, size, level, channels, is_srgb } = *view;
        let level = level.map_or(-1.0, |level| level as f32);
        let push = Push { corner, size, level, channels, is_srgb: is_srgb.into(), square: 8.0 };
        encoder.push(&self.layouts, &push);
        encoder.draw(3);
        if let Some(scene) = frame.and_then(|frame| frame.scene.as_ref()).filter(|_| !meshes.is_empty()) {
            encoder.bind_pipeline(&self.uv);
            encoder.keep(&scene.vertices);
            encoder.bind_indices(&scene.indices);
            for mesh in meshes {
                let is_mesh = |id: u32| id as usize == mesh.primitive;
                let draw = scene
                    .draws
                    .iter()
                    .find(|draw| is_mesh(draw.push.primitive_id) && draw.variant.class == PrimitiveClass::Triangles);
                let Some(draw) = draw else { continue };
                let m = mesh.uv_from_mesh;
                let push = UvPush {
                    vertices: draw.push.vertices,
                    first: UV[usize::from(mesh.uv_set == 1)],
                    uv_from_mesh: [m.matrix2.x_axis.to_array(), m.matrix2.y_axis.to_array(), m.translation.to_array()],
                    corner,
                    size,
                    padding: 0,
                };
                encoder.push(&self.layouts, &push);
                encoder.draw_indexed(draw.index_count, draw.first_index, 1);
            }
        }
        encoder.end_rendering();
        encoder.transition(preview, Use::Color, Use::Sampled);
    }
}
