//! Descriptor sets and the pipeline layout, both fixed by [`crate::interface`].

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use super::blank::Blank;
use super::buffer::Buffer;
use super::image::Image;
use super::sampler::Sampler;
use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError, fault};
use crate::interface::{self, BindingKind};

const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_CONTROL.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_EVALUATION.as_raw()
        | vk::ShaderStageFlags::GEOMETRY.as_raw()
        | vk::ShaderStageFlags::FRAGMENT.as_raw()
        | vk::ShaderStageFlags::COMPUTE.as_raw(),
);

/// The stages that the device supports.
pub(super) fn stages(gpu: &Gpu) -> vk::ShaderStageFlags {
    let mesh = vk::ShaderStageFlags::TASK_EXT | vk::ShaderStageFlags::MESH_EXT;
    if gpu.mesh_shader.is_some() { STAGES | mesh } else { STAGES }
}

/// The stages that may read a set. A device need not offer more than 32 samplers to one stage (lavapipe 22.3 does not), and all
/// sets together contain more.
fn stages_of(gpu: &Gpu, set: u32) -> vk::ShaderStageFlags {
    match set {
        interface::SET_TASK => vk::ShaderStageFlags::COMPUTE,
        interface::SET_MATERIAL | interface::SET_PASS => stages(gpu) & !vk::ShaderStageFlags::COMPUTE,
        _ => stages(gpu),
    }
}

/// The descriptor set layouts of the contract, and the pipeline layout over them. All pipelines share it, so a reload
/// replaces pipelines and nothing else.
pub struct SetLayouts {
    gpu: Arc<Gpu>,
    pub(super) sets: Vec<vk::DescriptorSetLayout>,
    pub(in crate::gpu) pipeline: vk::PipelineLayout,
    pub(in crate::gpu) blank: Blank,
}

impl SetLayouts {
    /// [`SetLayouts::new`] with placeholders that are ready for use.
    pub(super) fn with_blank(gpu: &Arc<Gpu>, blank: Blank) -> Result<Arc<Self>, GpuError> {
        let count = interface::BINDINGS.iter().map(|b| b.set + 1).max().unwrap_or(0);
        let pipeline = vk::PipelineLayout::null();
        let mut layouts = Self { gpu: gpu.clone(), sets: Vec::new(), pipeline, blank };
        for set in 0..count {
            let bindings: Vec<_> = interface::BINDINGS
                .iter()
                .filter(|b| b.set == set)
                .map(|b| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(b.binding)
                        .descriptor_type(descriptor_type(b.kind))
                        .descriptor_count(1)
                        .stage_flags(stages_of(gpu, set))
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the device is live.
            let layout = unsafe { gpu.device.create_descriptor_set_layout(&info, None) };
            let layout = layout.context("creating a descriptor set layout")?;
            gpu.name(layout, set_name(set));
            layouts.sets.push(layout);
        }
        let (stage_flags, size) = (stages(gpu), interface::PUSH_CONSTANT_SIZE);
        let ranges = [vk::PushConstantRange { stage_flags, offset: 0, size }];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts.sets).push_constant_ranges(&ranges);
        // SAFETY: the set layouts are live.
        layouts.pipeline =
            unsafe { gpu.device.create_pipeline_layout(&info, None) }.context("creating the pipeline layout")?;
        gpu.name(layouts.pipeline, "pipeline layout");
        Ok(Arc::new(layouts))
    }

    pub(in crate::gpu) fn push_stages(&self) -> vk::ShaderStageFlags {
        stages(&self.gpu)
    }
}

impl Drop for SetLayouts {
    fn drop(&mut self) {
        // SAFETY: pipelines and descriptor sets hold an `Arc` of this, so none is left. Vulkan ignores a null layout.
        unsafe {
            self.gpu.device.destroy_pipeline_layout(self.pipeline, None);
            for layout in &self.sets {
                self.gpu.device.destroy_descriptor_set_layout(*layout, None);
            }
        }
    }
}

/// The debug name of a descriptor set without a name.
fn set_name(set: u32) -> &'static str {
    match set {
        interface::SET_FRAME => "frame set",
        interface::SET_MATERIAL => "material set",
        interface::SET_PASS => "pass set",
        interface::SET_TASK => "task set",
        _ => "descriptor set",
    }
}

fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::Sampler2D | BindingKind::Sampler2DArray | BindingKind::SamplerCube => {
            vk::DescriptorType::COMBINED_IMAGE_SAMPLER
        }
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
    }
}

/// A descriptor set with a pool of its own. It keeps every resource alive that it points to.
pub struct DescriptorSet {
    layouts: Arc<SetLayouts>,
    pool: vk::DescriptorPool,
    pub(in crate::gpu) raw: vk::DescriptorSet,
    pub(in crate::gpu) index: u32,
    _kept: Vec<Arc<dyn Any + Send + Sync>>,
}

/// Collects the descriptors of a new set.
#[derive(Default)]
pub struct SetWriter {
    buffers: Vec<(u32, vk::DescriptorBufferInfo)>,
    images: Vec<(u32, vk::DescriptorImageInfo)>,
    kept: Vec<Arc<dyn Any + Send + Sync>>,
    name: Option<String>,
}

impl SetWriter {
    /// Sets the name that GPU debuggers and validation messages show. Without one, a set is named after its number.
    pub fn named(mut self, name: &str) -> Self {
        self.name = Some(name.to_owned());
        self
    }

    /// Points every descriptor that was not written to a placeholder.
    fn completed(mut self, set: u32, blank: &Blank) -> Self {
        for binding in interface::BINDINGS.iter().filter(|b| b.set == set) {
            let at = binding.binding;
            if self.buffers.iter().any(|(b, _)| *b == at) || self.images.iter().any(|(b, _)| *b == at) {
                continue;
            }
            self = match binding.kind {
                _ if interface::LOOPS.contains(&(set, at)) => self.buffer(at, &blank.loops),
                BindingKind::UniformBuffer | BindingKind::StorageBuffer => self.buffer(at, &blank.buffer),
                BindingKind::Sampler2D => self.texture(at, &blank.image, &blank.sampler),
                BindingKind::Sampler2DArray => self.texture(at, &blank.array, &blank.sampler),
                BindingKind::SamplerCube => self.texture(at, &blank.cube, &blank.sampler),
                BindingKind::StorageImage => self.storage_level(at, &blank.image, 0),
            };
        }
        self
    }

    /// Points `binding` to one level of an image, with all its layers. The image's usage must include `STORAGE`, and the image
    /// must be in [`crate::gpu::Use::Storage`] whenever the set is used.
    pub fn storage_level(mut self, binding: u32, image: &Arc<Image>, level: u32) -> Self {
        let image_view = image.level_views.get(level as usize).copied().unwrap_or_default();
        let image_layout = vk::ImageLayout::GENERAL;
        self.images.push((binding, vk::DescriptorImageInfo { sampler: vk::Sampler::null(), image_view, image_layout }));
        self.kept.push(image.clone());
        self
    }

    /// Points `binding` to a whole buffer.
    pub fn buffer(mut self, binding: u32, buffer: &Arc<Buffer>) -> Self {
        let info = vk::DescriptorBufferInfo { buffer: buffer.raw, offset: 0, range: vk::WHOLE_SIZE };
        self.buffers.push((binding, info));
        self.kept.push(buffer.clone());
        self
    }

    /// Points `binding` to an image, which must be in [`crate::gpu::Use::Sampled`] whenever the set is used.
    pub fn texture(mut self, binding: u32, image: &Arc<Image>, sampler: &Arc<Sampler>) -> Self {
        let info = vk::DescriptorImageInfo {
            sampler: sampler.raw,
            image_view: image.view,
            image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        };
        self.images.push((binding, info));
        self.kept.push(image.clone());
        self.kept.push(sampler.clone());
        self
    }
}

impl DescriptorSet {
    /// Creates set number `set` of the contract. Shaders must not read a descriptor that `writer` left unwritten.
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn new(layouts: &Arc<SetLayouts>, set: u32, writer: SetWriter) -> Result<Arc<Self>, GpuError> {
        if set == interface::SET_FRAME {
            fault::refuse("frame-set", "creating a descriptor pool")?;
        }
        let writer = writer.completed(set, &layouts.blank);
        let sizes: Vec<_> = interface::BINDINGS
            .iter()
            .filter(|b| b.set == set)
            .map(|b| vk::DescriptorPoolSize { ty: descriptor_type(b.kind), descriptor_count: 1 })
            .collect();
        let name = writer.name.as_deref().unwrap_or(set_name(set));
        let this = Self::allocate(layouts, layouts.sets[set as usize], set, &sizes, name, writer.kept)?;
        let kind = |binding: u32| {
            let found = interface::BINDINGS.iter().find(|b| b.set == set && b.binding == binding);
            found.map_or(vk::DescriptorType::UNIFORM_BUFFER, |b| descriptor_type(b.kind))
        };
        let write = |binding: u32| {
            let write = vk::WriteDescriptorSet::default().dst_set(this.raw).dst_binding(binding);
            write.descriptor_type(kind(binding)).descriptor_count(1)
        };
        let mut writes = Vec::new();
        for (binding, info) in &writer.buffers {
            writes.push(write(*binding).buffer_info(std::slice::from_ref(info)));
        }
        for (binding, info) in &writer.images {
            writes.push(write(*binding).image_info(std::slice::from_ref(info)));
        }
        // SAFETY: the set is new, so no command uses it; `_kept` keeps alive what it points to.
        unsafe { layouts.gpu.device.update_descriptor_sets(&writes, &[]) };
        Ok(Arc::new(this))
    }

    /// Allocates a set with a pool of this size. Nothing is written to it.
    pub(super) fn allocate(
        layouts: &Arc<SetLayouts>,
        layout: vk::DescriptorSetLayout,
        index: u32,
        sizes: &[vk::DescriptorPoolSize],
        name: &str,
        kept: Vec<Arc<dyn Any + Send + Sync>>,
    ) -> Result<Self, GpuError> {
        let device = &layouts.gpu.device;
        // A pool without descriptors is not allowed before Vulkan 1.4.
        let least = [vk::DescriptorPoolSize { ty: vk::DescriptorType::UNIFORM_BUFFER, descriptor_count: 1 }];
        let sizes = if sizes.is_empty() { &least } else { sizes };
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(sizes);
        // SAFETY: the device is live.
        let pool = unsafe { device.create_descriptor_pool(&info, None) }.context("creating a descriptor pool")?;
        layouts.gpu.name(pool, name);
        let mut this = Self { layouts: layouts.clone(), pool, raw: vk::DescriptorSet::null(), index, _kept: kept };
        let layout = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layout);
        // SAFETY: the pool is new, unshared and large enough.
        this.raw = unsafe { device.allocate_descriptor_sets(&info) }.context("allocating a descriptor set")?[0];
        layouts.gpu.name(this.raw, name);
        Ok(this)
    }
}

impl Drop for DescriptorSet {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, so no command in flight uses the set. Its pool frees it.
        unsafe { self.layouts.gpu.device.destroy_descriptor_pool(self.pool, None) };
    }
}
