//! Instance, device, queue and allocator: [`Gpu`], which every other wrapper holds by `Arc`.

use std::ffi::{CStr, CString};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use raw_window_handle::RawDisplayHandle;

use super::error::{Context, GpuError};
use super::validation::{Messages, messenger_info};
use crate::message::did_you_mean;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// How to open a device.
#[derive(Default)]
pub struct GpuOptions {
    /// Part of the device's name, any case; `None` takes the fastest kind.
    pub device: Option<String>,
    /// Validation layers with synchronization validation.
    pub validation: bool,
    /// The display that windows will open on; `None` is headless.
    pub display: Option<RawDisplayHandle>,
}

/// A physical device as `specula info` lists it.
#[derive(Clone, Debug, serde::Serialize)]
pub struct AdapterInfo {
    /// The device's name.
    pub name: String,
    /// discrete, integrated, virtual, cpu or other.
    pub kind: &'static str,
    /// Driver name and version.
    pub driver: String,
    /// Vulkan version, as 1.3.230.
    pub api: String,
    /// Why Specula cannot use it.
    pub refused: Option<String>,
}

/// The open device. One graphics queue; an allocator; the validation messages.
pub struct Gpu {
    pub(super) entry: ash::Entry,
    pub(super) instance: ash::Instance,
    pub(super) physical: vk::PhysicalDevice,
    pub(super) device: ash::Device,
    pub(super) queue_family: u32,
    queue: Mutex<vk::Queue>,
    pub(super) allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    pub(super) surface: Option<khr::surface::Instance>,
    pub(super) swapchain: Option<khr::swapchain::Device>,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Messages>,
    pub(super) pipeline_cache: vk::PipelineCache,
    pub(super) properties: vk::PhysicalDeviceProperties,
    pub(super) anisotropy: bool,
    pub(super) wireframe: bool,
    info: AdapterInfo,
}

impl Gpu {
    /// Opens a device.
    ///
    /// # Errors
    /// No loader, no device that fits (the message lists each with its reason), no validation layer when asked for.
    pub fn new(options: &GpuOptions) -> Result<Arc<Self>, GpuError> {
        let messages = Box::<Messages>::default();
        let (entry, instance) = create_instance(options.validation, options.display, &messages)?;
        let messenger = match options.validation {
            true => Some(create_messenger(&entry, &instance, &messages)?),
            false => None,
        };
        let (physical, info) = choose(&instance, options.device.as_deref(), options.display.is_some())?;
        // SAFETY: `physical` was enumerated from this live instance.
        let (properties, supported) = unsafe {
            (instance.get_physical_device_properties(physical), instance.get_physical_device_features(physical))
        };
        let queue_family = graphics_family(&instance, physical)
            .ok_or_else(|| GpuError::NoDevice(format!("{} has no graphics queue", info.name)))?;
        let device = create_device(&instance, physical, queue_family, options.display.is_some(), &supported)?;
        // SAFETY: the family was asked for at device creation with one queue.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: physical,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: true,
            allocation_sizes: gpu_allocator::AllocationSizes::default(),
        })
        .map_err(|e| GpuError::Allocation { what: "the allocator".into(), message: e.to_string() })?;
        // SAFETY: the device is live; an empty cache needs no data.
        let pipeline_cache = unsafe { device.create_pipeline_cache(&vk::PipelineCacheCreateInfo::default(), None) }
            .context("creating the pipeline cache")?;
        let with_window = options.display.is_some();
        Ok(Arc::new(Self {
            surface: with_window.then(|| khr::surface::Instance::new(&entry, &instance)),
            swapchain: with_window.then(|| khr::swapchain::Device::new(&instance, &device)),
            entry,
            instance,
            physical,
            device,
            queue_family,
            queue: Mutex::new(queue),
            allocator: ManuallyDrop::new(Arc::new(Mutex::new(allocator))),
            messenger,
            messages,
            pipeline_cache,
            properties,
            anisotropy: supported.sampler_anisotropy == vk::TRUE,
            wireframe: supported.fill_mode_non_solid == vk::TRUE,
            info,
        }))
    }

    /// The device in use.
    pub fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Messages of the validation layers so far; empty without them.
    pub fn validation_messages(&self) -> Vec<String> {
        self.messages.all()
    }

    /// Whether color and depth targets can have `samples` samples.
    pub fn supports_samples(&self, samples: u32) -> bool {
        let limits = &self.properties.limits;
        let counts = limits.framebuffer_color_sample_counts & limits.framebuffer_depth_sample_counts;
        counts.contains(vk::SampleCountFlags::from_raw(samples))
    }

    /// Largest width or height of a 2D image.
    pub fn max_image_size(&self) -> u32 {
        self.properties.limits.max_image_dimension2_d
    }

    /// Nanoseconds of one timestamp tick; `None` when the queue has no timestamps.
    pub fn timestamp_period(&self) -> Option<f32> {
        (self.properties.limits.timestamp_compute_and_graphics == vk::TRUE)
            .then_some(self.properties.limits.timestamp_period)
    }

    /// SYNC: waits until the device is idle. For resize and exit only.
    pub fn wait_idle(&self) {
        let _queue = self.lock_queue();
        // SAFETY: the queue is locked, so nobody submits meanwhile. An error here means a lost device: nothing to wait for.
        let _ = unsafe { self.device.device_wait_idle() };
    }

    pub(super) fn lock_queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn lock_allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: every object made from this device holds an `Arc<Gpu>`, so none is left. The allocator goes before the device,
        // the messenger before the instance.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_pipeline_cache(self.pipeline_cache, None);
            ManuallyDrop::drop(&mut self.allocator);
            self.device.destroy_device(None);
            if let Some((utils, messenger)) = &self.messenger {
                utils.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// All Vulkan devices of this machine, usable or not.
///
/// # Errors
/// No loader, or an instance that cannot be made.
pub fn adapters() -> Result<Vec<AdapterInfo>, GpuError> {
    let (_entry, instance) = create_instance(false, None, &Messages::default())?;
    // SAFETY: the instance is live.
    let devices = unsafe { instance.enumerate_physical_devices() }.context("listing the Vulkan devices")?;
    let infos = devices.into_iter().map(|physical| describe(&instance, physical, false)).collect();
    // SAFETY: nothing made from the instance is left.
    unsafe { instance.destroy_instance(None) };
    Ok(infos)
}

fn create_instance(
    validation: bool,
    display: Option<RawDisplayHandle>,
    messages: &Messages,
) -> Result<(ash::Entry, ash::Instance), GpuError> {
    // SAFETY: loading the system's Vulkan loader runs its initializers, as every Vulkan program does.
    let entry = unsafe { ash::Entry::load() }.map_err(|e| GpuError::NoLoader(e.to_string()))?;
    let mut layers = Vec::new();
    let mut extensions: Vec<*const std::ffi::c_char> = Vec::new();
    if validation {
        // SAFETY: the entry is loaded.
        let available = unsafe { entry.enumerate_instance_layer_properties() }.context("listing the Vulkan layers")?;
        if !available.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
            return Err(GpuError::NoValidation);
        }
        layers.push(VALIDATION_LAYER.as_ptr());
        extensions.push(ext::debug_utils::NAME.as_ptr());
    }
    if let Some(display) = display {
        let required =
            ash_window::enumerate_required_extensions(display).context("asking for the window's extensions")?;
        extensions.extend_from_slice(required);
    }
    let name = CString::new("specula").unwrap_or_default();
    let app = vk::ApplicationInfo::default().application_name(&name).api_version(vk::API_VERSION_1_3);
    let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
    let mut messenger = messenger_info(messages);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&app)
        .enabled_layer_names(&layers)
        .enabled_extension_names(&extensions);
    if validation {
        info = info.push_next(&mut features).push_next(&mut messenger);
    }
    // SAFETY: all pointers in `info` live until the call returns.
    let instance = unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => GpuError::NoDevice(
            "the Vulkan loader found no driver; on Debian and Ubuntu a software one comes with: apt-get install \
             mesa-vulkan-drivers"
                .into(),
        ),
        vk::Result::ERROR_EXTENSION_NOT_PRESENT if display.is_some() => {
            GpuError::NoDevice("the Vulkan loader has no support for windows on this display".into())
        }
        result => GpuError::Vulkan { action: "creating the Vulkan instance".into(), result },
    })?;
    Ok((entry, instance))
}

fn create_messenger(
    entry: &ash::Entry,
    instance: &ash::Instance,
    messages: &Messages,
) -> Result<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT), GpuError> {
    let utils = ext::debug_utils::Instance::new(entry, instance);
    // SAFETY: the instance has the extension; `messages` is boxed in the `Gpu` that destroys the messenger first.
    let messenger = unsafe { utils.create_debug_utils_messenger(&messenger_info(messages), None) }
        .context("creating the validation messenger")?;
    Ok((utils, messenger))
}

fn choose(
    instance: &ash::Instance,
    wanted: Option<&str>,
    window: bool,
) -> Result<(vk::PhysicalDevice, AdapterInfo), GpuError> {
    // SAFETY: the instance is live.
    let devices = unsafe { instance.enumerate_physical_devices() }.context("listing the Vulkan devices")?;
    let mut all: Vec<_> = devices.into_iter().map(|p| (p, describe(instance, p, window))).collect();
    let list = all.iter().map(|(_, i)| match &i.refused {
        Some(why) => format!("\n  {} ({}): {why}", i.name, i.kind),
        None => format!("\n  {} ({})", i.name, i.kind),
    });
    let list = list.collect::<String>();
    let names: Vec<String> = all.iter().map(|(_, info)| info.name.clone()).collect();
    let rank = |kind: &str| ["discrete", "integrated", "virtual", "other", "cpu"].iter().position(|k| *k == kind);
    all.sort_by_key(|(_, info)| rank(info.kind));
    let named = |info: &AdapterInfo| wanted.is_none_or(|w| info.name.to_lowercase().contains(&w.to_lowercase()));
    match all.into_iter().find(|(_, info)| info.refused.is_none() && named(info)) {
        Some(found) => Ok(found),
        None if list.is_empty() => Err(GpuError::NoDevice(
            "the Vulkan loader found none; on Debian and Ubuntu a software one comes with: apt-get install \
             mesa-vulkan-drivers"
                .into(),
        )),
        None => Err(GpuError::NoDevice(match wanted {
            Some(name) => {
                let hint = did_you_mean(name, names.iter().flat_map(|name| name.split_whitespace()));
                format!("no device whose name contains '{name}' can be used.{hint} There are:{list}")
            }
            None => format!("none of these can be used:{list}"),
        })),
    }
}

fn describe(instance: &ash::Instance, physical: vk::PhysicalDevice, window: bool) -> AdapterInfo {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: `physical` comes from this live instance; the chain is valid for the call.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    let properties = properties.properties;
    let text = |s: Result<&CStr, _>| s.map(|s: &CStr| s.to_string_lossy().into_owned()).unwrap_or_default();
    let version = properties.api_version;
    AdapterInfo {
        name: text(properties.device_name_as_c_str()),
        kind: match properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
            vk::PhysicalDeviceType::CPU => "cpu",
            _ => "other",
        },
        driver: format!("{} {}", text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str())),
        api: format!(
            "{}.{}.{}",
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version)
        ),
        refused: missing(instance, physical, version, window),
    }
}

/// Why a device cannot be used, or `None`.
fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice, version: u32, window: bool) -> Option<String> {
    if version < vk::API_VERSION_1_3 {
        return Some("its driver has no Vulkan 1.3".into());
    }
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut v12).push_next(&mut v13);
    // SAFETY: as above.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let core = features.features;
    let needs = [
        (v13.dynamic_rendering, "dynamic rendering"),
        (v13.synchronization2, "synchronization2"),
        (v13.shader_terminate_invocation, "discard in shaders (shaderTerminateInvocation)"),
        (v12.buffer_device_address, "buffer device address"),
        (v12.scalar_block_layout, "scalar block layout"),
        (core.geometry_shader, "primitive ids in fragment shaders (geometryShader)"),
    ];
    let lacking: Vec<_> = needs.iter().filter(|(has, _)| *has == vk::FALSE).map(|(_, name)| *name).collect();
    if !lacking.is_empty() {
        return Some(format!("it lacks {}", lacking.join(", ")));
    }
    if graphics_family(instance, physical).is_none() {
        return Some("it has no graphics queue".into());
    }
    // SAFETY: as above.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    let has_swapchain = extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(khr::swapchain::NAME));
    (window && !has_swapchain).then(|| "it cannot show windows".into())
}

fn graphics_family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
    // SAFETY: `physical` comes from this live instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    families.iter().position(|f| f.queue_flags.contains(wanted)).map(|i| i as u32)
}

fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    queue_family: u32,
    window: bool,
    supported: &vk::PhysicalDeviceFeatures,
) -> Result<ash::Device, GpuError> {
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&priorities)];
    let extensions: &[_] = if window { &[khr::swapchain::NAME.as_ptr()] } else { &[] };
    let core = vk::PhysicalDeviceFeatures {
        sampler_anisotropy: supported.sampler_anisotropy,
        large_points: supported.large_points,
        fill_mode_non_solid: supported.fill_mode_non_solid,
        geometry_shader: vk::TRUE,
        ..Default::default()
    };
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default().buffer_device_address(true).scalar_block_layout(true);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        .shader_terminate_invocation(true);
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(extensions)
        .enabled_features(&core)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: `missing` has checked every feature and extension asked for here.
    unsafe { instance.create_device(physical, &info, None) }.context("opening the device")
}
