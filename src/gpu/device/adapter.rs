//! The physical devices of this machine: which are there, which Specula can use, and which one it takes.

use std::ffi::CStr;

use ash::{khr, vk};

use super::instance::Instance;
use crate::gpu::GpuError;
use crate::gpu::error::Context;
use crate::message::did_you_mean;

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
    /// Why Specula cannot use the device; `None` if it can.
    pub refused: Option<String>,
}

/// All Vulkan devices of this machine, usable or not.
///
/// # Errors
/// There is no Vulkan loader, or the instance cannot be created.
pub fn adapters() -> Result<Vec<AdapterInfo>, GpuError> {
    let instance = Instance::new(false, None)?;
    // SAFETY: the instance is live.
    let devices = unsafe { instance.raw.enumerate_physical_devices() }.context("listing the Vulkan devices")?;
    Ok(devices.into_iter().map(|physical| describe(&instance.raw, physical, false)).collect())
}

/// Which formats the device with `part` in its name, or the fastest kind, has for textures, without opening it.
///
/// # Errors
/// As [`adapters`], or there is no such device.
pub fn texture_formats(part: Option<&str>, formats: &[vk::Format]) -> Result<Vec<bool>, GpuError> {
    let instance = Instance::new(false, None)?;
    let (physical, _) = choose(&instance.raw, part, false)?;
    Ok(formats.iter().map(|format| has_texture_format(&instance.raw, physical, *format)).collect())
}

/// Whether shaders sample and filter a format, and it can be copied and scaled.
pub(in crate::gpu) fn has_texture_format(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    format: vk::Format,
) -> bool {
    use vk::FormatFeatureFlags as Has;
    let needs =
        Has::SAMPLED_IMAGE | Has::SAMPLED_IMAGE_FILTER_LINEAR | Has::BLIT_SRC | Has::TRANSFER_SRC | Has::TRANSFER_DST;
    // SAFETY: `physical` comes from this live instance.
    let properties = unsafe { instance.get_physical_device_format_properties(physical, format) };
    properties.optimal_tiling_features.contains(needs)
}

/// Takes the fastest kind of device whose name contains `part`. `window` is whether it must show windows.
pub(in crate::gpu) fn choose(
    instance: &ash::Instance,
    part: Option<&str>,
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
    let named = |info: &AdapterInfo| part.is_none_or(|p| info.name.to_lowercase().contains(&p.to_lowercase()));
    match all.into_iter().find(|(_, info)| info.refused.is_none() && named(info)) {
        Some(found) => Ok(found),
        None if list.is_empty() => Err(GpuError::NoDriver),
        None => Err(GpuError::NoDevice(match part {
            Some(part) => {
                let hint = did_you_mean(part, names.iter().flat_map(|name| name.split_whitespace()));
                format!("no usable device has '{part}' in its name.{hint} Devices:{list}")
            }
            None => format!("Specula can use none of these:{list}"),
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

/// Why Specula cannot use a device, or `None` if it can.
fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice, version: u32, window: bool) -> Option<String> {
    if version < vk::API_VERSION_1_3 {
        return Some("its driver has no Vulkan 1.3".into());
    }
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut v12).push_next(&mut v13);
    // SAFETY: as above; the chain is valid for the call.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let core = features.features;
    let needs = [
        (v13.dynamic_rendering, "dynamic rendering"),
        (v13.synchronization2, "synchronization2"),
        (v13.shader_terminate_invocation, "`discard` in shaders (shaderTerminateInvocation)"),
        (v12.buffer_device_address, "buffer device address"),
        (v12.scalar_block_layout, "scalar block layout"),
        (core.geometry_shader, "`gl_PrimitiveID` in fragment shaders (geometryShader)"),
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

/// The first queue family with graphics and compute.
pub(in crate::gpu) fn graphics_family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
    // SAFETY: `physical` comes from this live instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    families.iter().position(|f| f.queue_flags.contains(wanted)).map(|i| i as u32)
}
