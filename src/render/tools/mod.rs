//! Tools to inspect a scene: the outline of a selection, and pictures of textures. Their shaders are built in and not part of a
//! shader tree, so no edit breaks them. They are compiled on first use.

mod outline;
mod texture;

use std::mem::offset_of;
use std::sync::Arc;

use crate::gpu::{
    Gpu, GpuError, PassBinding, PassBindings, PassLayout, Pipeline, PipelineDesc, PrimitiveClass, Raster,
    ResourceUsage, SetLayouts, ShaderModule, Swapchain, vk,
};
use crate::interface::Vertex;
use crate::shader::{Compiler, StageKind};

pub use outline::{Outline, OutlineStyle};
pub use texture::{PREVIEW_FORMAT, TextureView, UvMesh};

/// Floats of a vertex, as the shaders here read them.
const STRIDE: usize = 18;
/// First floats of the texture coordinates in a vertex.
const UV: [u32; 2] = [10, 12];
const _: () = assert!(
    size_of::<Vertex>() == 4 * STRIDE
        && offset_of!(Vertex, position) == 0
        && offset_of!(Vertex, uv0) == 4 * UV[0] as usize
        && offset_of!(Vertex, uv1) == 4 * UV[1] as usize
);

/// Format of the mask of the selected instances.
const MASK_FORMAT: vk::Format = vk::Format::R8_UNORM;

/// The pipelines.
pub struct Tools {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    /// The layout of pipelines that read one texture.
    one_texture: Arc<PassLayout>,
    mask: Arc<Pipeline>,
    mask_samples: u32,
    outline: Arc<Pipeline>,
    texture: Arc<Pipeline>,
    uv: Arc<Pipeline>,
}

impl Tools {
    /// Compiles the shaders and creates the pipelines, in some 20 ms. Any thread may call this.
    ///
    /// # Errors
    /// A message from the compiler, or of a device without memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, compiler: &Compiler) -> Result<Arc<Self>, String> {
        let stage = |name: &str, kind, text| -> Result<_, String> {
            let words = compiler.compile_alone(name, text, kind)?;
            ShaderModule::new(gpu, name, &words, false, ResourceUsage::default()).map_err(|error| error.to_string())
        };
        let (vertex, fragment) = (StageKind::Vertex, StageKind::Fragment);
        let screen = stage("tools/screen.vert", vertex, include_str!("screen.vert"))?;
        let places = stage("tools/mask.vert", vertex, include_str!("mask.vert"))?;
        let white = stage("tools/white.frag", fragment, include_str!("white.frag"))?;
        let line = stage("tools/outline.frag", fragment, include_str!("outline.frag"))?;
        let shown = stage("tools/texture.frag", fragment, include_str!("texture.frag"))?;
        let uv_place = stage("tools/uv.vert", vertex, include_str!("uv.vert"))?;
        let uv_color = stage("tools/uv.frag", fragment, include_str!("uv.frag"))?;
        let made = || -> Result<Self, GpuError> {
            let no_texture = PassLayout::new(gpu, layouts, PassBindings::new(), false)?;
            let one_texture = PassLayout::new(gpu, layouts, PassBindings::from([(0, PassBinding::Texture)]), false)?;
            let pipeline = |vertex, fragment, format, raster, samples, layout: &Arc<PassLayout>| {
                Pipeline::new(
                    gpu,
                    layouts,
                    &PipelineDesc {
                        draws_by_index: false,
                        pre_rasterization: &[(vk::ShaderStageFlags::VERTEX, vertex)],
                        fragment,
                        colors: &[format],
                        depth: false,
                        raster,
                        samples,
                        class: PrimitiveClass::Triangles,
                        layout: layout.clone(),
                    },
                )
            };
            let mask_samples = if gpu.supports_samples(4) { 4 } else { 1 };
            Ok(Self {
                mask: pipeline(&places, &white, MASK_FORMAT, Raster::Solid, mask_samples, &no_texture)?,
                mask_samples,
                outline: pipeline(&screen, &line, Swapchain::FORMAT, Raster::Blended, 1, &one_texture)?,
                texture: pipeline(&screen, &shown, PREVIEW_FORMAT, Raster::Solid, 1, &one_texture)?,
                uv: pipeline(&uv_place, &uv_color, PREVIEW_FORMAT, Raster::BlendedLines, 1, &no_texture)?,
                gpu: gpu.clone(),
                layouts: layouts.clone(),
                one_texture,
            })
        };
        made().map(Arc::new).map_err(|error| error.to_string())
    }
}
