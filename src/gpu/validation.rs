//! The validation layers' messages: printed as they come, and counted so that a test or `--validate` can fail on one.

use std::ffi::{CStr, c_void};
use std::sync::Mutex;

use ash::vk;

/// Messages of the validation layers since the start. Its address is given to the driver, so it lives in a `Box`.
#[derive(Default)]
pub(super) struct Messages(Mutex<Vec<String>>);

impl Messages {
    /// Everything the layers said, oldest first.
    pub(super) fn all(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }
}

/// How the messenger is created: warnings and errors of validation and of wrong use.
pub(super) fn messenger_info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(on_message))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan gives a valid message, whose string is null-terminated or null; `user` is the `Messages` that outlives
    // the messenger.
    let (text, messages) = unsafe {
        let text = (*data).p_message;
        let text = if text.is_null() { "".into() } else { CStr::from_ptr(text).to_string_lossy() };
        (text, &*user.cast_const().cast::<Messages>())
    };
    tracing::error!(target: "vulkan", "{text}");
    messages.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(text.into_owned());
    vk::FALSE
}
