//! The pipeline layout of a declared pass. Its set `interface::SET_PASS` has the bindings that the stage declares.

use std::collections::BTreeMap;
use std::sync::Arc;

use ash::vk;

use super::buffer::Buffer;
use super::descriptor::{DescriptorSet, SetLayouts, stages};
use super::image::Image;
use super::sampler::Sampler;
use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};
use crate::interface::{self, BindingKind};

/// The kind of a descriptor of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PassBinding {
    /// `sampler2D`
    Texture,
    /// `image2D`
    Storage,
    /// A uniform block.
    Uniform,
    /// A buffer block.
    Buffer,
}

impl PassBinding {
    fn vulkan(self) -> vk::DescriptorType {
        match self {
            Self::Texture => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            Self::Storage => vk::DescriptorType::STORAGE_IMAGE,
            Self::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
            Self::Buffer => vk::DescriptorType::STORAGE_BUFFER,
        }
    }
}

/// The resource that a descriptor of a pass points to.
pub enum PassResource<'a> {
    /// An image in [`crate::gpu::Use::Sampled`], and its sampler.
    Texture(&'a Arc<Image>, &'a Arc<Sampler>),
    /// An image with one level in [`crate::gpu::Use::Storage`].
    Storage(&'a Arc<Image>),
    /// A uniform or storage buffer.
    Buffer(&'a Arc<Buffer>),
}

impl PassResource<'_> {
    /// A number that no other living resource has.
    pub fn id(&self) -> usize {
        match self {
            Self::Texture(image, _) | Self::Storage(image) => Arc::as_ptr(image) as usize,
            Self::Buffer(buffer) => Arc::as_ptr(buffer) as usize,
        }
    }
}

/// A pipeline layout: the sets of the contract, and a set `interface::SET_PASS` with what the stages declare by name.
pub struct PassLayout {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    bindings: PassBindings,
    empty: vk::DescriptorSetLayout,
    own: vk::DescriptorSetLayout,
    pub(in crate::gpu) pipeline: vk::PipelineLayout,
}

/// The kinds of descriptors of a [`PassLayout`], by binding.
pub type PassBindings = BTreeMap<u32, PassBinding>;

impl PassLayout {
    /// Creates the layout of a pass with these bindings. `draws_model`: it has the set of a material too.
    ///
    /// # Errors
    /// The device is out of memory, or its stages have fewer textures.
    pub fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        bindings: PassBindings,
        draws_model: bool,
    ) -> Result<Arc<Self>, GpuError> {
        let own = bindings.values().filter(|kind| **kind == PassBinding::Texture).count();
        let (given, most) = (textures_of_contract(draws_model), gpu.max_textures());
        if own + given > most {
            let message = format!(
                "it reads {own} images and textures by name, and {given} come with Specula; this device has {most} for a stage"
            );
            return Err(GpuError::Texture(message));
        }
        let null = vk::DescriptorSetLayout::null();
        let pipeline = vk::PipelineLayout::null();
        let mut this = Self { gpu: gpu.clone(), layouts: layouts.clone(), bindings, empty: null, own: null, pipeline };
        let stage_flags = stages(gpu);
        let own: Vec<_> = this
            .bindings
            .iter()
            .map(|(binding, kind)| {
                let layout = vk::DescriptorSetLayoutBinding::default().binding(*binding);
                layout.descriptor_type(kind.vulkan()).descriptor_count(1).stage_flags(stage_flags)
            })
            .collect();
        let set_layout = |bindings: &[vk::DescriptorSetLayoutBinding<'_>]| {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(bindings);
            // SAFETY: the device is live.
            unsafe { gpu.device.create_descriptor_set_layout(&info, None) }.context("creating a descriptor set layout")
        };
        this.own = set_layout(&own)?;
        gpu.name(this.own, "set of a pass");
        let mut sets = layouts.sets.clone();
        if !draws_model {
            // The textures of a material count among those of a stage, whether the stage reads them or not.
            this.empty = set_layout(&[])?;
            sets[interface::SET_MATERIAL as usize] = this.empty;
        }
        sets[interface::SET_PASS as usize] = this.own;
        let ranges = [vk::PushConstantRange { stage_flags, offset: 0, size: interface::PUSH_CONSTANT_SIZE }];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(&ranges);
        // SAFETY: the set layouts are live.
        this.pipeline =
            unsafe { gpu.device.create_pipeline_layout(&info, None) }.context("creating a pass's pipeline layout")?;
        gpu.name(this.pipeline, "pipeline layout of a pass");
        Ok(Arc::new(this))
    }

    /// Whether the pass has no descriptors of its own, so that no set needs to be bound.
    pub fn is_empty(&self) -> bool {
        self.bindings.is_empty()
    }

    /// The bindings of the pass set.
    pub fn bindings(&self) -> impl Iterator<Item = u32> {
        self.bindings.keys().copied()
    }

    /// Creates the pass set, with a resource for each binding.
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn set(self: &Arc<Self>, name: &str, resources: &[PassResource<'_>]) -> Result<Arc<DescriptorSet>, GpuError> {
        let sizes: Vec<_> = self
            .bindings
            .values()
            .map(|kind| vk::DescriptorPoolSize { ty: kind.vulkan(), descriptor_count: 1 })
            .collect();
        let kept: Vec<Arc<dyn std::any::Any + Send + Sync>> = resources
            .iter()
            .flat_map(|resource| -> Vec<Arc<dyn std::any::Any + Send + Sync>> {
                match resource {
                    PassResource::Texture(image, sampler) => vec![(*image).clone(), (*sampler).clone()],
                    PassResource::Storage(image) => vec![(*image).clone()],
                    PassResource::Buffer(buffer) => vec![(*buffer).clone()],
                }
            })
            .chain([self.clone() as Arc<dyn std::any::Any + Send + Sync>])
            .collect();
        let set = DescriptorSet::allocate(&self.layouts, self.own, interface::SET_PASS, &sizes, name, kept)?;
        let mut images = Vec::new();
        let mut buffers = Vec::new();
        for resource in resources {
            match resource {
                PassResource::Texture(image, sampler) => images.push([vk::DescriptorImageInfo {
                    sampler: sampler.raw,
                    image_view: image.view,
                    image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
                }]),
                PassResource::Storage(image) => images.push([vk::DescriptorImageInfo {
                    sampler: vk::Sampler::null(),
                    image_view: image.view,
                    image_layout: vk::ImageLayout::GENERAL,
                }]),
                PassResource::Buffer(buffer) => {
                    buffers.push([vk::DescriptorBufferInfo { buffer: buffer.raw, offset: 0, range: vk::WHOLE_SIZE }]);
                }
            }
        }
        let (mut images, mut buffers) = (images.iter(), buffers.iter());
        let writes: Vec<_> = self
            .bindings
            .iter()
            .zip(resources)
            .filter_map(|((binding, kind), resource)| {
                let write = vk::WriteDescriptorSet::default().dst_set(set.raw).dst_binding(*binding);
                let write = write.descriptor_type(kind.vulkan()).descriptor_count(1);
                Some(match resource {
                    PassResource::Texture(..) | PassResource::Storage(_) => write.image_info(images.next()?),
                    PassResource::Buffer(_) => write.buffer_info(buffers.next()?),
                })
            })
            .collect();
        // SAFETY: the set is new, so no command uses it. The set keeps its resources alive.
        unsafe { self.gpu.device.update_descriptor_sets(&writes, &[]) };
        Ok(Arc::new(set))
    }
}

/// The textures of the contract that a fragment stage sees.
fn textures_of_contract(draws_model: bool) -> usize {
    let is_texture = |kind: BindingKind| {
        matches!(kind, BindingKind::Sampler2D | BindingKind::Sampler2DArray | BindingKind::SamplerCube)
    };
    let is_seen = |set: u32| set == interface::SET_FRAME || (draws_model && set == interface::SET_MATERIAL);
    interface::BINDINGS.iter().filter(|binding| is_seen(binding.set) && is_texture(binding.kind)).count()
}

impl Drop for PassLayout {
    fn drop(&mut self) {
        // SAFETY: pipelines and descriptor sets hold an `Arc` of this, so none is left. Vulkan ignores a null layout.
        unsafe {
            self.gpu.device.destroy_pipeline_layout(self.pipeline, None);
            self.gpu.device.destroy_descriptor_set_layout(self.own, None);
            self.gpu.device.destroy_descriptor_set_layout(self.empty, None);
        }
    }
}
