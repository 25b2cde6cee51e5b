//! Names of Vulkan objects and labels of command regions, as validation messages and GPU debuggers show them.
//!
//! Both use VK_EXT_debug_utils, which the instance enables wherever it is offered. Without it, every function here does
//! nothing.

use std::ffi::CString;

use ash::vk;

use super::gpu::Gpu;

impl Gpu {
    /// Names a Vulkan object that belongs to the device, not to the instance as a surface does.
    pub(in crate::gpu) fn name<H: vk::Handle>(&self, object: H, name: &str) {
        let Some(utils) = &self.debug_utils else { return };
        let name = c_string(name);
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        // SAFETY: the object is live, and only its creator has its handle yet. A name that cannot be stored changes nothing.
        let _ = unsafe { utils.set_debug_utils_object_name(&info) };
    }

    /// Opens a labeled region of commands.
    pub(in crate::gpu) fn begin_label(&self, commands: vk::CommandBuffer, label: &str) {
        let Some(utils) = &self.debug_utils else { return };
        let label = c_string(label);
        let info = vk::DebugUtilsLabelEXT::default().label_name(&label);
        // SAFETY: the command buffer is recording.
        unsafe { utils.cmd_begin_debug_utils_label(commands, &info) };
    }

    /// Closes the innermost labeled region.
    pub(in crate::gpu) fn end_label(&self, commands: vk::CommandBuffer) {
        let Some(utils) = &self.debug_utils else { return };
        // SAFETY: the command buffer is recording, and `begin_label` opened a region in it.
        unsafe { utils.cmd_end_debug_utils_label(commands) };
    }
}

/// The text up to its first NUL byte.
fn c_string(text: &str) -> CString {
    CString::new(text.split('\0').next().unwrap_or_default()).unwrap_or_default()
}
