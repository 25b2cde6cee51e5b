//! Logical device, queue and allocator: [`Gpu`], which every other wrapper holds by `Arc`.

use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use raw_window_handle::RawDisplayHandle;

use super::adapter::{AdapterInfo, choose, graphics_family, has_texture_format};
use super::instance::Instance;
use super::optional::{DrawFeatures, MeshLimits, Optional};
use super::pipeline_cache::{PipelineCache, PipelineStore};
use crate::gpu::GpuError;
use crate::gpu::error::Context;

/// Bytes of the blocks from which images and buffers get memory of the device, and memory that the host maps.
const DEVICE_BLOCK: u64 = 256 << 20;
const HOST_BLOCK: u64 = 8 << 20;

/// How to open a device.
#[derive(Default)]
pub struct GpuOptions {
    /// Part of the device's name, in any case; `None` takes the fastest kind.
    pub device: Option<String>,
    /// Whether to enable the validation layers with synchronization validation.
    pub validation: bool,
    /// The display that windows will open on; `None` is headless.
    pub display: Option<RawDisplayHandle>,
    /// Keeps compiled pipelines between runs; `None` forgets them.
    pub pipelines: Option<&'static dyn PipelineStore>,
}

/// Optional stages, and their features. Every device that Specula accepts has geometry stages.
#[derive(Clone, Copy, Debug)]
pub struct OptionalStages {
    /// Whether there are tessellation stages.
    pub tessellation: bool,
    /// Whether tessellation and geometry stages can use `gl_PointSize`.
    pub point_size: bool,
    /// Whether fragment stages can run for each sample.
    pub sample_shading: bool,
    /// The limits of task and mesh stages; `None` without VK_EXT_mesh_shader.
    pub mesh: Option<MeshLimits>,
}

/// An open device with one graphics queue and one allocator.
pub struct Gpu {
    // Fields are dropped in this order: the allocator before the device, the device before the instance.
    pub(in crate::gpu) allocator: Arc<Mutex<Allocator>>,
    pub(in crate::gpu) device: Device,
    pub(in crate::gpu) instance: Instance,
    pub(in crate::gpu) physical: vk::PhysicalDevice,
    pub(in crate::gpu) queue_family: u32,
    queue: Mutex<vk::Queue>,
    pub(in crate::gpu) surface: Option<khr::surface::Instance>,
    pub(in crate::gpu) swapchain: Option<khr::swapchain::Device>,
    /// Draws with mesh stages, where the device has them.
    pub(in crate::gpu) mesh_shader: Option<ext::mesh_shader::Device>,
    pub(in crate::gpu) debug_utils: Option<ext::debug_utils::Device>,
    /// Queries pipeline statistics, where the driver offers any.
    pub(in crate::gpu) executables: Option<khr::pipeline_executable_properties::Device>,
    pub(in crate::gpu) pipeline_cache: PipelineCache,
    pub(in crate::gpu) properties: vk::PhysicalDeviceProperties,
    timestamp_bits: u32,
    pub(in crate::gpu) anisotropy: bool,
    pub(in crate::gpu) wireframe: bool,
    optional_stages: OptionalStages,
    vertex_stores: bool,
    fragment_stores: bool,
    quad_ballots: bool,
    pub(in crate::gpu) has_memory_budget: bool,
    draws: DrawFeatures,
    info: AdapterInfo,
}

impl Gpu {
    /// Opens a device.
    ///
    /// # Errors
    /// There is no loader, no usable device (the message lists each device with its reason), no memory, or no validation
    /// layer although `options` asks for it.
    pub fn new(options: &GpuOptions) -> Result<Arc<Self>, GpuError> {
        let instance = Instance::new(options.validation, options.display)?;
        let with_window = options.display.is_some();
        let (physical, info) = choose(&instance.raw, options.device.as_deref(), with_window)?;
        // SAFETY: `physical` was enumerated from this live instance, in all three calls.
        let (properties, supported, families) = unsafe {
            (
                instance.raw.get_physical_device_properties(physical),
                instance.raw.get_physical_device_features(physical),
                instance.raw.get_physical_device_queue_family_properties(physical),
            )
        };
        let queue_family = graphics_family(&instance.raw, physical)
            .ok_or_else(|| GpuError::NoDevice(format!("{} has no graphics queue", info.name)))?;
        let optional = Optional::of(&instance.raw, physical);
        let device = Device(create_device(&instance.raw, physical, queue_family, (with_window, optional), &supported)?);
        // SAFETY: the family was requested at device creation with one queue.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: device.clone(),
            physical_device: physical,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: true,
            // A larger resource has a block of its own, which is freed with it. On a software device all memory is the host's, and what
            // staging buffers and textures leave behind in shared blocks would stay resident.
            allocation_sizes: gpu_allocator::AllocationSizes::new(DEVICE_BLOCK, HOST_BLOCK),
        })
        .map_err(|error| GpuError::allocation(&error, "creating the memory allocator"))?;
        let pipeline_cache = PipelineCache::new(&device, &properties, options.pipelines)?;
        let gpu = Self {
            surface: with_window.then(|| khr::surface::Instance::new(&instance.entry, &instance.raw)),
            swapchain: with_window.then(|| khr::swapchain::Device::new(&instance.raw, &device)),
            executables: optional
                .executables
                .then(|| khr::pipeline_executable_properties::Device::new(&instance.raw, &device)),
            mesh_shader: optional.mesh.map(|_| ext::mesh_shader::Device::new(&instance.raw, &device)),
            has_memory_budget: optional.memory_budget,
            draws: optional.draws,
            debug_utils: instance.has_debug_utils.then(|| ext::debug_utils::Device::new(&instance.raw, &device)),
            allocator: Arc::new(Mutex::new(allocator)),
            device,
            instance,
            physical,
            queue_family,
            queue: Mutex::new(queue),
            pipeline_cache,
            properties,
            timestamp_bits: families.get(queue_family as usize).map_or(0, |family| family.timestamp_valid_bits),
            anisotropy: supported.sampler_anisotropy == vk::TRUE,
            wireframe: supported.fill_mode_non_solid == vk::TRUE,
            optional_stages: OptionalStages {
                tessellation: supported.tessellation_shader == vk::TRUE,
                point_size: supported.shader_tessellation_and_geometry_point_size == vk::TRUE,
                sample_shading: supported.sample_rate_shading == vk::TRUE,
                mesh: optional.mesh,
            },
            vertex_stores: supported.vertex_pipeline_stores_and_atomics == vk::TRUE,
            quad_ballots: optional.quad_ballots,
            fragment_stores: supported.fragment_stores_and_atomics == vk::TRUE,
            info,
        };
        gpu.name(gpu.device.handle(), "device");
        gpu.name(queue, "graphics queue");
        gpu.name(gpu.pipeline_cache.raw, "pipeline cache");
        Ok(Arc::new(gpu))
    }

    /// The device in use.
    pub fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Messages of the validation layers so far, oldest first; none without validation.
    pub fn validation_messages(&self) -> Vec<String> {
        self.instance.messages()
    }

    /// Whether color and depth targets can have `samples` samples a pixel.
    pub fn supports_samples(&self, samples: u32) -> bool {
        let limits = &self.properties.limits;
        let counts = limits.framebuffer_color_sample_counts & limits.framebuffer_depth_sample_counts;
        counts.contains(vk::SampleCountFlags::from_raw(samples))
    }

    /// Whether shaders can filter texels of this format. Devices need not support that for full floats.
    pub fn blends_texels(&self, format: vk::Format) -> bool {
        // SAFETY: the instance is live, and the device belongs to it.
        let properties = unsafe { self.instance.raw.get_physical_device_format_properties(self.physical, format) };
        properties.optimal_tiling_features.contains(vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR)
    }

    /// Whether textures can have this format: shaders sample and filter it, and it can be copied and scaled.
    pub fn has_texture_format(&self, format: vk::Format) -> bool {
        has_texture_format(&self.instance.raw, self.physical, format)
    }

    /// Reports which optional stages the device supports.
    pub fn optional_stages(&self) -> OptionalStages {
        self.optional_stages
    }

    /// Reports how stages can tell draws apart.
    pub fn draw_features(&self) -> DrawFeatures {
        self.draws
    }

    /// Whether the driver reports pipeline statistics: [`crate::gpu::CompileInfo::statistics`].
    pub fn tells_statistics(&self) -> bool {
        self.executables.is_some()
    }

    /// Whether vertex and fragment stages can write buffers. Compute stages always can.
    pub fn graphics_stores(&self) -> (bool, bool) {
        (self.vertex_stores, self.fragment_stores)
    }

    /// Whether fragment stages can ask which invocations of their quad run along.
    pub fn quad_ballots(&self) -> bool {
        self.quad_ballots
    }

    /// Largest width or height of a 2D image, in pixels.
    pub fn max_image_size(&self) -> u32 {
        self.properties.limits.max_image_dimension2_d
    }

    /// Largest number of color targets of a draw.
    pub fn max_color_targets(&self) -> u32 {
        self.properties.limits.max_color_attachments
    }

    /// Largest width and height of a cube map's face, in pixels.
    pub fn max_cube_size(&self) -> u32 {
        self.properties.limits.max_image_dimension_cube
    }

    /// Largest width, height and depth of a volume, in texels.
    pub fn max_volume_size(&self) -> u32 {
        self.properties.limits.max_image_dimension3_d
    }

    /// Largest number of layers of an array.
    pub fn max_layers(&self) -> u32 {
        self.properties.limits.max_image_array_layers
    }

    /// The number of sampled textures that one stage can have.
    pub fn max_textures(&self) -> usize {
        let limits = &self.properties.limits;
        limits.max_per_stage_descriptor_samplers.min(limits.max_per_stage_descriptor_sampled_images) as usize
    }

    /// Nanoseconds of one timestamp tick; `None` when the queue has no timestamps.
    pub fn timestamp_period(&self) -> Option<f32> {
        (self.timestamp_bits > 0).then_some(self.properties.limits.timestamp_period)
    }

    /// Milliseconds between two timestamps of the queue, whose counter may wrap around between them.
    pub(in crate::gpu) fn ticks_to_ms(&self, begin: u64, end: u64) -> f64 {
        let mask = u64::MAX >> (64 - self.timestamp_bits.clamp(1, 64));
        let ticks = end.wrapping_sub(begin) & mask;
        // More than half the counter's range means that `end` precedes `start` by a few ticks.
        let ticks = if ticks > mask / 2 { 0 } else { ticks };
        ticks as f64 * f64::from(self.properties.limits.timestamp_period) * 1e-6
    }

    /// SYNC: waits until the device is idle. For swapchain replacement and exit only: no fence covers the presentation
    /// engine's use of an image.
    pub fn wait_idle(&self) {
        let _queue = self.lock_queue();
        // SAFETY: the queue is locked, so no thread submits meanwhile. An error means a lost device, which runs nothing.
        let _ = unsafe { self.device.device_wait_idle() };
    }

    pub(in crate::gpu) fn lock_queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(in crate::gpu) fn lock_allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: pipelines hold an `Arc<Gpu>`, so none is being created with the cache.
        unsafe { self.pipeline_cache.end(&self.device) };
    }
}

/// The logical device, which `Drop` destroys. All calls go through [`Deref`].
pub(in crate::gpu) struct Device(ash::Device);

impl Deref for Device {
    type Target = ash::Device;

    fn deref(&self) -> &ash::Device {
        &self.0
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SYNC: at exit, the presentation engine may still use the last frame's semaphores.
        // SAFETY: every object made from this device holds an `Arc<Gpu>`, so none is left.
        unsafe {
            let _ = self.0.device_wait_idle();
            self.0.destroy_device(None);
        }
    }
}

fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    queue_family: u32,
    (window, optional): (bool, Optional),
    supported: &vk::PhysicalDeviceFeatures,
) -> Result<ash::Device, GpuError> {
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&priorities)];
    let swapchain = window.then_some(khr::swapchain::NAME.as_ptr());
    let extensions: Vec<_> = swapchain.into_iter().chain(optional.names()).collect();
    let core = vk::PhysicalDeviceFeatures {
        sampler_anisotropy: supported.sampler_anisotropy,
        large_points: supported.large_points,
        fill_mode_non_solid: supported.fill_mode_non_solid,
        vertex_pipeline_stores_and_atomics: supported.vertex_pipeline_stores_and_atomics,
        fragment_stores_and_atomics: supported.fragment_stores_and_atomics,
        geometry_shader: vk::TRUE,
        sample_rate_shading: supported.sample_rate_shading,
        tessellation_shader: supported.tessellation_shader,
        texture_compression_bc: supported.texture_compression_bc,
        texture_compression_etc2: supported.texture_compression_etc2,
        texture_compression_astc_ldr: supported.texture_compression_astc_ldr,
        shader_tessellation_and_geometry_point_size: supported.shader_tessellation_and_geometry_point_size,
        multi_draw_indirect: supported.multi_draw_indirect,
        draw_indirect_first_instance: supported.draw_indirect_first_instance,
        ..Default::default()
    };
    let mut v11 = vk::PhysicalDeviceVulkan11Features::default().shader_draw_parameters(optional.draws.by_index);
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default().buffer_device_address(true).scalar_block_layout(true);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        .shader_terminate_invocation(true);
    let mut executables =
        vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
    let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default().task_shader(true).mesh_shader(true);
    let mut info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&core)
        .push_next(&mut v11)
        .push_next(&mut v12)
        .push_next(&mut v13);
    if optional.executables {
        info = info.push_next(&mut executables);
    }
    if optional.mesh.is_some() {
        info = info.push_next(&mut mesh);
    }
    // SAFETY: `adapter::choose` and `Optional::of` have checked every feature and extension that is enabled here.
    unsafe { instance.create_device(physical, &info, None) }.context("opening the device")
}
