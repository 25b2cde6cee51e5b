//! Shader modules and pipelines.

use std::ffi::CStr;
use std::sync::Arc;
use std::time::Instant;

use ash::vk;

use super::buffer::Buffer;
use super::descriptor::SetLayouts;
use super::pass_layout::PassLayout;
use super::resource_usage::ResourceUsage;
use super::statistics::{self, CompileInfo, Executable, PipelineStage, feedback_ms};
use crate::gpu::error::Context;
use crate::gpu::watchdog::Watched;
use crate::gpu::{Gpu, GpuError, fault};

pub(super) const MAIN: &CStr = c"main";

/// A compiled shader stage.
pub struct ShaderModule {
    gpu: Arc<Gpu>,
    pub(super) raw: vk::ShaderModule,
    /// Path of its stage.
    pub name: String,
    pub(super) names_loops: bool,
    /// Its size, and that of the module before Specula's optimizer, in words.
    words: usize,
    words_before: usize,
    /// The descriptors that its functions use.
    pub usage: ResourceUsage,
}

impl ShaderModule {
    /// Creates a module from SPIR-V. `name` is the stage's path, as `pbr.frag`; pipelines are named after their modules.
    /// `names_loops`: the module writes `interface::LOOPS` when a loop does not end.
    ///
    /// # Errors
    /// The driver rejects the module or is out of memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        spirv: &[u32],
        names_loops: bool,
        usage: ResourceUsage,
    ) -> Result<Arc<Self>, GpuError> {
        Self::optimized(gpu, name, (spirv, spirv.len()), names_loops, usage)
    }

    /// [`ShaderModule::new`] for an optimized module that had `words_before` words before.
    ///
    /// # Errors
    /// As [`ShaderModule::new`].
    pub fn optimized(
        gpu: &Arc<Gpu>,
        name: &str,
        (spirv, words_before): (&[u32], usize),
        names_loops: bool,
        usage: ResourceUsage,
    ) -> Result<Arc<Self>, GpuError> {
        let info = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the words come from shaderc and `shader::spirv`, whose output is valid SPIR-V.
        let raw = unsafe { gpu.device.create_shader_module(&info, None) };
        let raw = raw.context_of("creating the shader module", &format!("`{name}`"))?;
        gpu.name(raw, name);
        let (name, words) = (name.to_owned(), spirv.len());
        Ok(Arc::new(Self { gpu: gpu.clone(), raw, name, names_loops, words, words_before, usage }))
    }

    /// Returns the report on this stage in a pipeline.
    pub(super) fn stage_info(&self, driver_ms: Option<f64>) -> PipelineStage {
        PipelineStage { stage: self.name.clone(), words_before: self.words_before, words: self.words, driver_ms }
    }
}

impl Drop for ShaderModule {
    fn drop(&mut self) {
        // SAFETY: only pipeline creation uses a module, and its caller holds an `Arc` of it.
        unsafe { self.gpu.device.destroy_shader_module(self.raw, None) };
    }
}

/// Flag for pipelines whose statistics [`statistics::read`] queries. A driver may compile such a pipeline again.
pub(super) const CAPTURE: vk::PipelineCreateFlags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;

/// Control points of a patch: a triangle of the model.
const PATCH_VERTICES: u32 = 3;

/// Values of specialization constants: pairs of `constant_id` and the four bytes of the value.
pub type Specialization = Vec<(u32, u32)>;

/// The class of topologies that a pipeline's dynamic topology must stay in.
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

/// How a pipeline writes its fragments to the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Raster {
    /// Fragments replace the target.
    #[default]
    Solid,
    /// Premultiplied alpha blending, without depth writes.
    Blended,
    /// No blending and no depth writes.
    Replaced,
    /// As [`Raster::Solid`], but only the edges of triangles are drawn, if the device supports `fillModeNonSolid`.
    Lines,
    /// Wireframe: the edges of triangles, slightly nearer than their surfaces, without depth writes.
    Edges,
    /// As [`Raster::Blended`], but only the edges of triangles are drawn, if the device supports `fillModeNonSolid`.
    BlendedLines,
    /// Additive blending without depth test; alpha becomes the maximum.
    Added,
    /// Depth alone; the color target keeps its content.
    Depth,
    /// Linear interpolation from the target to the fragment, by the weight of [`crate::gpu::Encoder::set_weight`]; alpha
    /// becomes the maximum.
    Averaged,
}

/// Stages and fixed state of a graphics pipeline.
pub struct PipelineDesc<'a> {
    /// The pre-rasterization stages, in the order in which they run. With tessellation, the primitives are patches of three
    /// vertices. With a mesh stage, there is no vertex stage.
    pub pre_rasterization: &'a [(vk::ShaderStageFlags, &'a ShaderModule)],
    /// Fragment stage.
    pub fragment: &'a ShaderModule,
    /// Formats of the color targets, by location.
    pub colors: &'a [vk::Format],
    /// Whether there is a D32 depth target, with reversed depth (greater is nearer).
    pub depth: bool,
    /// How fragments are written.
    pub raster: Raster,
    /// Samples per pixel.
    pub samples: u32,
    /// Class of primitives.
    pub class: PrimitiveClass,
    /// The pipeline layout, with what the stages read by name.
    pub layout: Arc<PassLayout>,
    /// Whether the stages find their draw by `gl_BaseInstance`.
    pub draws_by_index: bool,
}

impl PipelineDesc<'_> {
    fn name(&self) -> String {
        let samples = if self.samples > 1 { format!(", {} samples", self.samples) } else { String::new() };
        let Self { raster, class, .. } = self;
        let names: Vec<&str> = self.modules().map(|(_, module)| module.name.as_str()).collect();
        format!("{} ({raster:?} {class:?}{samples})", names.join(" + "))
    }

    /// The modules, in the order in which the stages run.
    fn modules(&self) -> impl Iterator<Item = (vk::ShaderStageFlags, &ShaderModule)> {
        self.pre_rasterization.iter().copied().chain([(vk::ShaderStageFlags::FRAGMENT, self.fragment)])
    }

    fn has(&self, stage: vk::ShaderStageFlags) -> bool {
        self.pre_rasterization.iter().any(|(kind, _)| *kind == stage)
    }
}

/// A graphics pipeline. Viewport, scissor, cull mode, front face, topology and the depth test's comparison are dynamic.
pub struct Pipeline {
    gpu: Arc<Gpu>,
    /// Its layout.
    pub layout: Arc<PassLayout>,
    /// Whether the stages find their draw by `gl_BaseInstance`, in a buffer whose address is in the push constants. Otherwise the push
    /// constants are the draw.
    pub draws_by_index: bool,
    /// The descriptors that its stages use.
    pub usage: ResourceUsage,
    /// Information about the compiled code.
    pub compile_info: CompileInfo,
    /// The loop report buffer, if its stages have loops that may not end.
    pub(in crate::gpu) loops: Option<Arc<Buffer>>,
    pub(in crate::gpu) raw: vk::Pipeline,
}

impl Pipeline {
    /// Whether a stage writes the loop report buffer.
    pub fn names_loops(&self) -> bool {
        self.loops.is_some()
    }

    /// Creates a pipeline. Its debug name is made of the names of its modules and its raster state.
    ///
    /// # Errors
    /// The driver rejects the pipeline or is out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, desc: &PipelineDesc<'_>) -> Result<Arc<Self>, GpuError> {
        let (raw, compile_info) = Self::create(gpu, desc, vk::PipelineCreateFlags::empty())?;
        gpu.name(raw, &desc.name());
        let names_loops = desc.modules().any(|(_, module)| module.names_loops);
        let loops = names_loops.then(|| layouts.blank.loops.clone());
        let usage = desc.modules().fold(ResourceUsage::default(), |usage, (_, module)| usage.union(&module.usage));
        Ok(Arc::new(Self {
            gpu: gpu.clone(),
            layout: desc.layout.clone(),
            draws_by_index: desc.draws_by_index,
            usage,
            compile_info,
            loops,
            raw,
        }))
    }

    /// Builds a pipeline once more to query its statistics, which drivers keep only if the flag asks for them.
    ///
    /// # Errors
    /// As [`Pipeline::new`].
    pub fn statistics(gpu: &Arc<Gpu>, desc: &PipelineDesc<'_>) -> Result<Vec<Executable>, GpuError> {
        let (raw, _) = Self::create(gpu, desc, CAPTURE)?;
        let statistics = statistics::read(gpu, raw);
        // SAFETY: nothing has used the pipeline.
        unsafe { gpu.device.destroy_pipeline(raw, None) };
        statistics
    }

    fn create(
        gpu: &Gpu,
        desc: &PipelineDesc<'_>,
        flags: vk::PipelineCreateFlags,
    ) -> Result<(vk::Pipeline, CompileInfo), GpuError> {
        let stage = |stage, module: &ShaderModule| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module.raw).name(MAIN)
        };
        let stages: Vec<_> = desc.modules().map(|(kind, module)| stage(kind, module)).collect();

        let has_tessellation = desc.has(vk::ShaderStageFlags::TESSELLATION_CONTROL);
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(match desc.class {
            _ if has_tessellation => vk::PrimitiveTopology::PATCH_LIST,
            PrimitiveClass::Points => vk::PrimitiveTopology::POINT_LIST,
            PrimitiveClass::Lines => vk::PrimitiveTopology::LINE_LIST,
            PrimitiveClass::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
        });
        // With this origin, triangles of the default order `ccw` face the same way as the patch.
        let mut origin = vk::PipelineTessellationDomainOriginStateCreateInfo::default()
            .domain_origin(vk::TessellationDomainOrigin::LOWER_LEFT);
        let tessellation = vk::PipelineTessellationStateCreateInfo::default()
            .patch_control_points(PATCH_VERTICES)
            .push_next(&mut origin);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let lines = matches!(desc.raster, Raster::Lines | Raster::Edges | Raster::BlendedLines) && gpu.wireframe;
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0).polygon_mode(if lines {
            vk::PolygonMode::LINE
        } else {
            vk::PolygonMode::FILL
        });
        // Depth is reversed, so a positive bias is towards the eye.
        let is_biased = desc.raster == Raster::Edges;
        let raster = raster.depth_bias_enable(is_biased).depth_bias_constant_factor(64.0).depth_bias_slope_factor(1.5);
        let multisample = multisampling(gpu, desc);
        let depth = depth_test(desc);
        let written = if desc.raster == Raster::Depth { Default::default() } else { vk::ColorComponentFlags::RGBA };
        let attachment = blending(desc.raster).color_write_mask(written);
        let attachments = vec![attachment; desc.colors.len()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let mut dynamic_states = vec![vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        if desc.depth {
            let states =
                [vk::DynamicState::CULL_MODE, vk::DynamicState::FRONT_FACE, vk::DynamicState::DEPTH_COMPARE_OP];
            dynamic_states.extend(states);
            // The mesh stage declares its output primitive.
            if !desc.has(vk::ShaderStageFlags::MESH_EXT) {
                dynamic_states.push(vk::DynamicState::PRIMITIVE_TOPOLOGY);
            }
        }
        if desc.raster == Raster::Averaged {
            dynamic_states.push(vk::DynamicState::BLEND_CONSTANTS);
        }
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
        let mut rendering = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(desc.colors);
        if desc.depth {
            rendering = rendering.depth_attachment_format(vk::Format::D32_SFLOAT);
        }
        let info = vk::GraphicsPipelineCreateInfo::default()
            .flags(flags)
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(desc.layout.pipeline)
            .push_next(&mut rendering);
        let info = if has_tessellation { info.tessellation_state(&tessellation) } else { info };
        let mut parts = vec![vk::PipelineCreationFeedback::default(); stages.len()];
        let mut whole = vk::PipelineCreationFeedback::default();
        let mut feedback = vk::PipelineCreationFeedbackCreateInfo::default()
            .pipeline_creation_feedback(&mut whole)
            .pipeline_stage_creation_feedbacks(&mut parts);
        let info = info.push_next(&mut feedback);
        let name = desc.name();
        let _watched = Watched::begin(|| format!("compiling the pipeline `{name}`"));
        fault::delay("pipeline-hang-ms");
        let start = Instant::now();
        // SAFETY: every pointer in `info` lives until the call returns; modules and layout are live. The cache is internally
        // synchronized.
        let made = unsafe { gpu.device.create_graphics_pipelines(gpu.pipeline_cache.raw, &[info], None) };
        let raw = made.map_err(|(_, result)| result).context_of("creating the pipeline", &format!("`{name}`"))?[0];
        let is_cached = whole.flags.contains(vk::PipelineCreationFeedbackFlags::APPLICATION_PIPELINE_CACHE_HIT);
        let stages: Vec<PipelineStage> =
            desc.modules().zip(&parts).map(|((_, module), part)| module.stage_info(feedback_ms(part))).collect();
        let times: Vec<Option<f64>> = stages.iter().map(|stage| stage.driver_ms).collect();
        tracing::debug!("`{name}`: {:?} ms, stages {times:?} ms, cached: {is_cached}", feedback_ms(&whole));
        Ok((raw, CompileInfo::new(stages, start.elapsed().as_secs_f64() * 1e3, is_cached)))
    }
}

/// A stage that finds a layer reads the depth of each sample. NVIDIA gives it that of the pixel's center unless the state asks for samples.
fn multisampling(gpu: &Gpu, desc: &PipelineDesc<'_>) -> vk::PipelineMultisampleStateCreateInfo<'static> {
    let runs_for_samples = desc.raster == Raster::Depth && desc.samples > 1 && gpu.optional_stages().sample_shading;
    vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::from_raw(desc.samples))
        .sample_shading_enable(runs_for_samples)
        .min_sample_shading(1.0)
}

fn depth_test(desc: &PipelineDesc<'_>) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(desc.depth && desc.raster != Raster::Added)
        .depth_write_enable(desc.depth && matches!(desc.raster, Raster::Solid | Raster::Lines | Raster::Depth))
}

fn blending(raster: Raster) -> vk::PipelineColorBlendAttachmentState {
    let state = vk::PipelineColorBlendAttachmentState::default();
    match raster {
        Raster::Solid | Raster::Replaced | Raster::Lines | Raster::Edges | Raster::Depth => state,
        Raster::Blended | Raster::BlendedLines => state
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
        // SAFETY: the last `Arc` is gone, and a submission in flight would hold one.
        unsafe { self.gpu.device.destroy_pipeline(self.raw, None) };
    }
}
