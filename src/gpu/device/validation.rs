//! Messages of the validation layers: logged as they come, and kept so that a test or `--validate` fails on any of them.

use std::ffi::{CStr, c_char, c_void};
use std::sync::{Mutex, PoisonError};

use ash::vk;

/// Messages of the validation layers since the start. The driver has its address, so it lives in a `Box`.
#[derive(Default)]
pub(in crate::gpu) struct Messages(Mutex<Vec<String>>);

impl Messages {
    /// All messages, oldest first.
    pub(in crate::gpu) fn all(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// How to create the messenger: it reports warnings and errors of validation.
pub(in crate::gpu) fn messenger_info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
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
    // SAFETY: Vulkan passes a valid message; `user` is the `Messages` that outlives the messenger.
    let (text, messages) = unsafe { (describe(&*data), &*user.cast_const().cast::<Messages>()) };
    tracing::error!(target: "vulkan", "{text}");
    messages.0.lock().unwrap_or_else(PoisonError::into_inner).push(text);
    vk::FALSE
}

/// The layers' text, which names the objects, and the labels of the passes that were open where the command was recorded.
///
/// # Safety
/// Every pointer in `data` is null or valid, and its strings end in NUL.
unsafe fn describe(data: &vk::DebugUtilsMessengerCallbackDataEXT<'_>) -> String {
    let text = |text: *const c_char| match text.is_null() {
        true => String::new(),
        // SAFETY: not null, so valid by this function's contract.
        false => unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned(),
    };
    let labels = match data.p_cmd_buf_labels.is_null() {
        true => &[][..],
        // SAFETY: as above; the array has `cmd_buf_label_count` entries.
        false => unsafe { std::slice::from_raw_parts(data.p_cmd_buf_labels, data.cmd_buf_label_count as usize) },
    };
    let labels: Vec<_> = labels.iter().map(|label| format!("`{}`", text(label.p_label_name))).collect();
    let message = text(data.p_message);
    if labels.is_empty() { message } else { format!("{message} (in the passes {})", labels.join(", ")) }
}
