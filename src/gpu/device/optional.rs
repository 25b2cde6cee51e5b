//! Extensions that Specula uses where the device has them. It works without any of them.

use std::ffi::{CStr, c_char};

use ash::{ext, khr, vk};

/// Which of them a device has.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gpu) struct Optional {
    /// The driver tells numbers of compiled pipelines.
    pub(in crate::gpu) executables: bool,
    /// The driver tells how much memory the process may use.
    pub(in crate::gpu) memory_budget: bool,
}

impl Optional {
    pub(in crate::gpu) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        // SAFETY: `physical` comes from this live instance.
        let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        let has = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
        let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default();
        if has(khr::pipeline_executable_properties::NAME) {
            let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut executables);
            // SAFETY: as above; the chain is valid for the call.
            unsafe { instance.get_physical_device_features2(physical, &mut features) };
        }
        Self {
            executables: executables.pipeline_executable_info == vk::TRUE,
            memory_budget: has(ext::memory_budget::NAME),
        }
    }

    /// The names of the extensions to enable.
    pub(in crate::gpu) fn names(self) -> impl Iterator<Item = *const c_char> {
        let all = [
            (self.executables, khr::pipeline_executable_properties::NAME),
            (self.memory_budget, ext::memory_budget::NAME),
        ];
        all.into_iter().filter(|(has, _)| *has).map(|(_, name)| name.as_ptr())
    }
}
