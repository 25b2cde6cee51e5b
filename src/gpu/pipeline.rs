//! Shader modules and graphics pipelines.

use std::ffi::CStr;
use std::sync::Arc;

use ash::vk;

use super::descriptor::SetLayouts;
use super::device::Gpu;
use super::error::{Context, GpuError};

const MAIN: &CStr = c"main";

/// A compiled shader stage.
pub struct ShaderModule {
    gpu: Arc<Gpu>,
    raw: vk::ShaderModule,
}

impl ShaderModule {
    /// Hands SPIR-V to the driver.
    ///
    /// # Errors
    /// The driver refuses the module.
    pub fn new(gpu: &Arc<Gpu>, spirv: &[u32]) -> Result<Arc<Self>, GpuError> {
        let info = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the words come from shaderc and `shader::specialize`, which make valid SPIR-V of what they compile.
        let raw = unsafe { gpu.device.create_shader_module(&info, None) }.context("creating a shader module")?;
        Ok(Arc::new(Self { gpu: gpu.clone(), raw }))
    }
}

impl Drop for ShaderModule {
    fn drop(&mut self) {
        // SAFETY: modules are used only while pipelines are created, by callers that hold the `Arc`.
        unsafe { self.gpu.device.destroy_shader_module(self.raw, None) };
    }
}

/// Values for specialization constants: `constant_id` and the four bytes of the value.
pub type Specialization = Vec<(u32, u32)>;

/// What a pipeline's topology may be changed to while recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PrimitiveClass {
    /// Point lists.
    Points,
    /// Line lists and strips.
    Lines,
    /// Triangle lists, strips and fans.
    #[default]
    Triangles,
}

/// What becomes of a pipeline's fragments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Raster {
    /// They replace what is there.
    #[default]
    Solid,
    /// Premultiplied alpha blending, without depth writes.
    Blended,
    /// They replace what is there, without depth writes.
    Replaced,
    /// The edges of triangles alone, where the device can; else as [`Raster::Solid`].
    Lines,
    /// They add up, without depth test; alpha is the largest.
    Added,
    /// Their color is mixed with what is there, by a weight that is set while recording; alpha is the largest.
    Averaged,
}

/// What a graphics pipeline is made of.
pub struct PipelineDesc<'a> {
    /// Vertex stage.
    pub vertex: &'a ShaderModule,
    /// Fragment stage.
    pub fragment: &'a ShaderModule,
    /// Color target.
    pub color: vk::Format,
    /// Whether there is a D32 depth target, tested reversed (greater is nearer).
    pub depth: bool,
    /// What becomes of the fragments.
    pub raster: Raster,
    /// Samples a pixel.
    pub samples: u32,
    /// Kind of primitive.
    pub class: PrimitiveClass,
}

/// A graphics pipeline. Viewport, scissor, cull mode, front face and topology are dynamic.
pub struct Pipeline {
    gpu: Arc<Gpu>,
    _layouts: Arc<SetLayouts>,
    pub(super) raw: vk::Pipeline,
}

impl Pipeline {
    /// Makes a pipeline.
    ///
    /// # Errors
    /// The driver refuses it or is out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, desc: &PipelineDesc<'_>) -> Result<Arc<Self>, GpuError> {
        let stage = |stage, module: &ShaderModule| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module.raw).name(MAIN)
        };
        let stages =
            [stage(vk::ShaderStageFlags::VERTEX, desc.vertex), stage(vk::ShaderStageFlags::FRAGMENT, desc.fragment)];

        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(match desc.class {
            PrimitiveClass::Points => vk::PrimitiveTopology::POINT_LIST,
            PrimitiveClass::Lines => vk::PrimitiveTopology::LINE_LIST,
            PrimitiveClass::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
        });
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let lines = desc.raster == Raster::Lines && gpu.wireframe;
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0).polygon_mode(if lines {
            vk::PolygonMode::LINE
        } else {
            vk::PolygonMode::FILL
        });
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::from_raw(desc.samples));
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(desc.depth && desc.raster != Raster::Added)
            .depth_write_enable(desc.depth && matches!(desc.raster, Raster::Solid | Raster::Lines))
            .depth_compare_op(vk::CompareOp::GREATER_OR_EQUAL);
        let attachment = blending(desc.raster).color_write_mask(vk::ColorComponentFlags::RGBA);
        let attachments = [attachment];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let mut dynamic_states = vec![vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        if desc.depth {
            dynamic_states.extend([
                vk::DynamicState::CULL_MODE,
                vk::DynamicState::FRONT_FACE,
                vk::DynamicState::PRIMITIVE_TOPOLOGY,
            ]);
        }
        if desc.raster == Raster::Averaged {
            dynamic_states.push(vk::DynamicState::BLEND_CONSTANTS);
        }
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
        let formats = [desc.color];
        let mut rendering = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
        if desc.depth {
            rendering = rendering.depth_attachment_format(vk::Format::D32_SFLOAT);
        }
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layouts.pipeline)
            .push_next(&mut rendering);
        // SAFETY: every pointer in `info` lives until the call returns; modules and layout are live. The cache is internally
        // synchronized.
        let made = unsafe { gpu.device.create_graphics_pipelines(gpu.pipeline_cache, &[info], None) };
        let raw = made.map_err(|(_, result)| result).context("creating a pipeline")?[0];
        Ok(Arc::new(Self { gpu: gpu.clone(), _layouts: layouts.clone(), raw }))
    }
}

/// A compute pipeline.
pub struct ComputePipeline {
    gpu: Arc<Gpu>,
    _layouts: Arc<SetLayouts>,
    pub(super) raw: vk::Pipeline,
}

impl ComputePipeline {
    /// Makes a pipeline of one stage.
    ///
    /// # Errors
    /// The driver refuses it or is out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, module: &ShaderModule) -> Result<Arc<Self>, GpuError> {
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module.raw)
            .name(MAIN);
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layouts.pipeline);
        // SAFETY: every pointer in `info` lives until the call returns; module and layout are live. The cache is internally
        // synchronized.
        let made = unsafe { gpu.device.create_compute_pipelines(gpu.pipeline_cache, &[info], None) };
        let raw = made.map_err(|(_, result)| result).context("creating a compute pipeline")?[0];
        Ok(Arc::new(Self { gpu: gpu.clone(), _layouts: layouts.clone(), raw }))
    }
}

impl Drop for ComputePipeline {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone; a submission in flight would hold one.
        unsafe { self.gpu.device.destroy_pipeline(self.raw, None) };
    }
}

fn blending(raster: Raster) -> vk::PipelineColorBlendAttachmentState {
    let state = vk::PipelineColorBlendAttachmentState::default();
    match raster {
        Raster::Solid | Raster::Replaced | Raster::Lines => state,
        Raster::Blended => state
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA),
        Raster::Averaged => state
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::CONSTANT_COLOR)
            .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_CONSTANT_COLOR)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE)
            .alpha_blend_op(vk::BlendOp::MAX),
        Raster::Added => state
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(vk::BlendFactor::ONE)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE)
            .alpha_blend_op(vk::BlendOp::MAX),
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone; a frame in flight would hold one.
        unsafe { self.gpu.device.destroy_pipeline(self.raw, None) };
    }
}
