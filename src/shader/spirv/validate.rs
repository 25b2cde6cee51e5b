//! Binds the validator of SPIRV-Tools, which is part of the shaderc library: what it refuses, a driver may crash on.
//!
//! Tests validate every module that this program rewrites. A user never waits for it.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;

/// `spv_target_env` of Vulkan 1.3.
const VULKAN_1_3: c_int = 25;
const SUCCESS: c_int = 0;

/// `spv_const_binary_t`
#[repr(C)]
struct Binary {
    code: *const u32,
    word_count: usize,
}

/// `spv_diagnostic_t`. The first three fields are `spv_position_t`.
#[repr(C)]
struct Message {
    line: usize,
    column: usize,
    index: usize,
    error: *const c_char,
    is_text_source: bool,
}

// libspirv.h of SPIRV-Tools. A context and options are opaque.
unsafe extern "C" {
    fn spvContextCreate(env: c_int) -> *mut c_void;
    fn spvContextDestroy(context: *mut c_void);
    fn spvValidatorOptionsCreate() -> *mut c_void;
    fn spvValidatorOptionsDestroy(options: *mut c_void);
    fn spvValidatorOptionsSetScalarBlockLayout(options: *mut c_void, value: bool);
    fn spvValidateWithOptions(
        context: *const c_void,
        options: *const c_void,
        binary: *const Binary,
        message: *mut *mut Message,
    ) -> c_int;
    fn spvDiagnosticDestroy(message: *mut Message);
}

/// Checks a module against the rules of SPIR-V and of Vulkan 1.3 with scalar block layout.
///
/// # Errors
/// The validator's message: the broken rule, and the instruction that breaks it.
pub fn validate(words: &[u32]) -> Result<(), String> {
    let binary = Binary { code: words.as_ptr(), word_count: words.len() };
    let mut message: *mut Message = ptr::null_mut();
    // SAFETY: the declarations above are those of libspirv.h. The validator reads `binary`, which outlives the call, and nothing
    // keeps a pointer to it. The objects are destroyed once, after their last use, and destroying null does nothing. A message is
    // null or valid until it is destroyed, and its text ends in NUL.
    unsafe {
        let context = spvContextCreate(VULKAN_1_3);
        let options = spvValidatorOptionsCreate();
        spvValidatorOptionsSetScalarBlockLayout(options, true);
        let result = spvValidateWithOptions(context, options, &raw const binary, &raw mut message);
        let text = message.as_ref().map(|message| CStr::from_ptr(message.error).to_string_lossy().into_owned());
        spvDiagnosticDestroy(message);
        spvValidatorOptionsDestroy(options);
        spvContextDestroy(context);
        if result == SUCCESS { Ok(()) } else { Err(text.unwrap_or_else(|| format!("SPIRV-Tools returned {result}"))) }
    }
}
