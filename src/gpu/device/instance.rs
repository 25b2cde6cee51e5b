//! The Vulkan instance, with the messenger of the validation layers.

use std::ffi::{CStr, CString, c_char};

use ash::{ext, vk};
use raw_window_handle::RawDisplayHandle;

use super::validation::{Messages, messenger_info};
use crate::gpu::GpuError;
use crate::gpu::error::Context;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// A loaded Vulkan library and an instance made from it. `Drop` destroys the messenger, then the instance.
pub(in crate::gpu) struct Instance {
    pub(in crate::gpu) entry: ash::Entry,
    pub(in crate::gpu) raw: ash::Instance,
    /// Whether VK_EXT_debug_utils is enabled.
    pub(in crate::gpu) has_debug_utils: bool,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Messages>,
}

impl Instance {
    /// Creates an instance that can open windows on `display`, with validation layers if `validation` is set.
    pub(in crate::gpu) fn new(validation: bool, display: Option<RawDisplayHandle>) -> Result<Self, GpuError> {
        // SAFETY: loading the system's Vulkan loader runs its initializers, as every Vulkan program does.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| GpuError::NoLoader(e.to_string()))?;
        let layers = if validation { vec![validation_layer(&entry)?] } else { Vec::new() };
        let has_debug_utils = validation || offers_debug_utils(&entry);
        let mut extensions: Vec<*const c_char> = Vec::new();
        if has_debug_utils {
            extensions.push(ext::debug_utils::NAME.as_ptr());
        }
        if let Some(display) = display {
            let required =
                ash_window::enumerate_required_extensions(display).context("querying the window extensions")?;
            extensions.extend_from_slice(required);
        }
        let messages = Box::<Messages>::default();
        let name = CString::new("specula").unwrap_or_default();
        let app = vk::ApplicationInfo::default().application_name(&name).api_version(vk::API_VERSION_1_3);
        let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
        let mut messenger = messenger_info(&messages);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&app)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions);
        if validation {
            info = info.push_next(&mut features).push_next(&mut messenger);
        }
        // SAFETY: all pointers in `info` live until the call returns.
        let raw = unsafe { entry.create_instance(&info, None) };
        let raw = match raw {
            Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => return Err(GpuError::NoDriver),
            Err(vk::Result::ERROR_EXTENSION_NOT_PRESENT) if display.is_some() => {
                return Err(GpuError::NoDevice("the Vulkan loader cannot open windows on this display".into()));
            }
            other => other.context("creating the Vulkan instance")?,
        };
        let mut instance = Self { entry, raw, has_debug_utils, messenger: None, messages };
        if validation {
            let utils = ext::debug_utils::Instance::new(&instance.entry, &instance.raw);
            // SAFETY: the instance has the extension, and `messages` is boxed beside the messenger, which goes first.
            let messenger = unsafe { utils.create_debug_utils_messenger(&messenger_info(&instance.messages), None) };
            instance.messenger = Some((utils, messenger.context("creating the validation messenger")?));
        }
        Ok(instance)
    }

    /// Messages of the validation layers, oldest first.
    pub(in crate::gpu) fn messages(&self) -> Vec<String> {
        self.messages.all()
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: everything made from this instance is gone. The loaded library outlives both calls.
        unsafe {
            if let Some((utils, messenger)) = &self.messenger {
                utils.destroy_debug_utils_messenger(*messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// The name of the validation layer, if it is installed.
fn validation_layer(entry: &ash::Entry) -> Result<*const c_char, GpuError> {
    // SAFETY: the entry is loaded.
    let available = unsafe { entry.enumerate_instance_layer_properties() }.context("listing the Vulkan layers")?;
    match available.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
        true => Ok(VALIDATION_LAYER.as_ptr()),
        false => Err(GpuError::NoValidation),
    }
}

/// Whether the loader or a driver offers VK_EXT_debug_utils; the validation layer always does.
fn offers_debug_utils(entry: &ash::Entry) -> bool {
    // SAFETY: the entry is loaded.
    let offered = unsafe { entry.enumerate_instance_extension_properties(None) }.unwrap_or_default();
    offered.iter().any(|extension| extension.extension_name_as_c_str() == Ok(ext::debug_utils::NAME))
}
