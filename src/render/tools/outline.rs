//! The outline of selected instances: a mask of them in a target of its own, and a filter that finds its edge. The mask has no depth, so
//! the outline also shows where something hides them.
//!
//! The outline is drawn after the frame, into the swapchain's image, so screenshots never have it. Without a selection
//! nothing is drawn. Lines and points have no outline.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

use super::{MASK_FORMAT, Tools};
use crate::gpu::{
    Attachments, DescriptorSet, Encoder, GpuError, Image, ImageDesc, PassResource, PrimitiveClass, Rect, Sampler,
    SamplerDesc, Use, vk,
};
use crate::render::BoundFrame;
use crate::render::scene::{GpuDraw, PlacedScene};

/// The style of an outline.
#[derive(Clone, Copy, Debug)]
pub struct OutlineStyle {
    /// RGB as displayed.
    pub color: [f32; 3],
    /// Pixels.
    pub width: f32,
}

/// The push constants of mask.vert.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct MaskPush {
    clip_from_object: [[f32; 4]; 4],
    vertices: u64,
}

/// The push constants of outline.frag.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LinePush {
    color: [f32; 3],
    width: f32,
    size: [f32; 2],
}

/// The targets of an outline, for frames of one size.
pub struct Outline {
    tools: Arc<Tools>,
    mask: Arc<Image>,
    /// `None` if the device has no multisampling.
    multisampled: Option<Arc<Image>>,
    set: Arc<DescriptorSet>,
}

impl Outline {
    /// Creates the targets.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(tools: &Arc<Tools>, (width, height): (u32, u32)) -> Result<Self, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let gpu = &tools.gpu;
        let desc = ImageDesc::new(width, height, MASK_FORMAT, Usage::COLOR_ATTACHMENT | Usage::SAMPLED);
        let mask = Image::new(gpu, "mask of the selection", desc)?;
        let samples = tools.mask_samples;
        let desc = ImageDesc { samples, ..ImageDesc::new(width, height, MASK_FORMAT, Usage::COLOR_ATTACHMENT) };
        let multisampled =
            (samples > 1).then(|| Image::new(gpu, "multisampled mask of the selection", desc)).transpose()?;
        let sampler = Sampler::new(gpu, &SamplerDesc::BILINEAR)?;
        let set = tools.one_texture.set("outline set", &[PassResource::Texture(&mask, &sampler)])?;
        Ok(Self { tools: tools.clone(), mask, multisampled, set })
    }

    /// Whether it fits frames of this size.
    pub fn fits(&self, size: (u32, u32)) -> bool {
        (self.mask.desc().width, self.mask.desc().height) == size
    }

    /// Draws the outline of the instances of `placed` for which `is_selected` holds, over the frame that lies at `at` in
    /// `target`, which is in [`Use::Color`] before and after.
    pub fn draw(
        &self,
        encoder: &mut Encoder,
        (frame, placed): (&BoundFrame, &Arc<PlacedScene>),
        is_selected: impl Fn(usize) -> bool,
        (target, at): (&Arc<Image>, (u32, u32)),
        style: OutlineStyle,
    ) {
        let Self { tools, mask, multisampled, set } = self;
        encoder.transition(mask, Use::Undefined, Use::Color);
        let (drawn, resolve) = match multisampled {
            Some(multisampled) => {
                encoder.transition(multisampled, Use::Undefined, Use::Color);
                (multisampled, Some(mask))
            }
            None => (mask, None),
        };
        encoder.begin_rendering(&Attachments { clear: Some([0.0; 4]), resolve, ..Attachments::of(drawn) });
        encoder.bind_pipeline(&tools.mask);
        encoder.keep(placed);
        encoder.bind_indices(&placed.scene.indices);
        let clip_from_world = frame.state.camera.clip_from_world();
        let triangles = |class| class == PrimitiveClass::Triangles;
        let is_drawn = |draw: &GpuDraw| is_selected(draw.instance) && triangles(draw.variant.class);
        for (draw, push) in placed.draws().filter(|(draw, _)| is_drawn(draw)) {
            let [x, y, z, w] = push.world_from_object.map(Vec3::from);
            let world = Mat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), w.extend(1.0));
            let clip_from_object = (clip_from_world * world).to_cols_array_2d();
            encoder.push(&tools.layouts, &MaskPush { clip_from_object, vertices: push.vertices });
            encoder.draw_indexed(draw.index_count, draw.first_index, 1);
        }
        encoder.end_rendering();
        encoder.transition(mask, Use::Color, Use::Sampled);

        let (width, height) = (mask.desc().width, mask.desc().height);
        let whole = Attachments::of(target);
        let area = Rect {
            x: at.0,
            y: at.1,
            width: width.min(whole.area.width.saturating_sub(at.0)),
            height: height.min(whole.area.height.saturating_sub(at.1)),
        };
        encoder.transition(target, Use::Color, Use::Color);
        encoder.begin_rendering(&Attachments { area, ..whole });
        encoder.set_viewport(Rect { x: at.0, y: at.1, width, height });
        encoder.set_scissor(area);
        encoder.bind_pipeline(&tools.outline);
        encoder.bind_pass_set(&tools.one_texture, set);
        let size = [width as f32, height as f32];
        encoder.push(&tools.layouts, &LinePush { color: style.color, width: style.width, size });
        encoder.draw(3);
        encoder.end_rendering();
    }
}
