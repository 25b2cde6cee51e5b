//! Faults that tests inject through the environment variable `SPECULA_FAULT`. For tests only: users never set it.
//!
//! The form is `SPECULA_FAULT=name:value[,name:value]`, where a value is an unsigned integer. The process reads the variable
//! once, at the first question. The device layer knows these names; other layers may ask for names of their own.
//!
//! - `image-bytes:N`: creating an image of more than `N` bytes of device memory fails with [`super::GpuError::OutOfMemory`].
//! - `buffer-bytes:N`: the same for buffers.
//! - `swapchain:N`, `frame-set:N`, `frame-submit:N`, `ui-textures:N`, `ui-draw:N`: the Nth call of the process that creates a
//!   swapchain, creates a descriptor set 0, submits a frame of a window, uploads egui's textures or draws the user interface fails
//!   with [`super::GpuError::OutOfMemory`].
//! - `frame-hang-ms:N`, `pipeline-hang-ms:N`: every wait for a submission, or every graphics pipeline, takes so much longer, as if
//!   the device hung.
//! - `window-hidden:1`: a window never gets an image of its swapchain, as if it were hidden.
//! - `single-draws:1`: the device has no `multiDrawIndirect`.
//! - `by-name:1`: a shader module with a function called `lose_the_device` loses the device: from then on, every wait for a
//!   submission fails with [`super::GpuError::DeviceLost`]. One with a function called `crash_the_driver` aborts the process.
//!
//! `app` knows these:
//!
//! - `worker-panic:N`: the worker panics at the Nth reload of the process.
//! - `compile-delay-ms:N`: every reload takes so much longer.
//! - `load-delay-ms:N`: reading a model takes so much longer.
//! - `textures-delay-ms:N`: the textures of a model that is shown without them take so much longer.
//! - `closing-panic:1`, `closing-delay-ms:N`, `closing-limit-ms:N`: closing the window panics, takes so much longer, or may take so long.
//! - `bake-delay-ms:N`, `bake-panic:N`: every bake takes so much longer; the Nth bake panics.
//!
//! `headless` knows `trace-delay-ms:N`: every draw of a trace takes so much longer; and `trace-loss:N`: the Nth one loses the device.
//!
//! `frame` knows `draws-by-index:N`: models of `N` and more draws are drawn by index.
//!
//! `render` knows `decode-delay-ms:N`: decoding an environment takes so much longer; and `plain-textures:1`: textures are RGBA8, or half
//! floats, as on a device that samples no other forms.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use super::GpuError;

/// The environment variable that this module reads.
pub const VARIABLE: &str = "SPECULA_FAULT";

/// The value of the fault `name`, or `None` when `SPECULA_FAULT` does not have it.
pub fn value(name: &str) -> Option<u64> {
    static FAULTS: OnceLock<BTreeMap<String, u64>> = OnceLock::new();
    let faults = FAULTS.get_or_init(|| {
        let text = std::env::var(VARIABLE).unwrap_or_default();
        parse(&text).unwrap_or_else(|part| {
            tracing::warn!("{VARIABLE} is ignored: expected `name:number[,name:number]`, found `{part}` in `{text}`");
            BTreeMap::new()
        })
    });
    faults.get(name).copied()
}

/// Counts calls: whether this is call number N of the process for a fault `name:N`.
pub fn strikes(name: &str) -> bool {
    static CALLS: Mutex<BTreeMap<String, u64>> = Mutex::new(BTreeMap::new());
    let Some(number) = value(name) else { return false };
    let mut calls = CALLS.lock().unwrap_or_else(PoisonError::into_inner);
    let call = calls.entry(name.to_owned()).or_default();
    *call += 1;
    *call == number
}

/// Fails with [`GpuError::OutOfMemory`] at call number N of the process for a fault `name:N`. `action` continues "out of memory
/// while".
pub(super) fn refuse(name: &str, action: &str) -> Result<(), GpuError> {
    if strikes(name) { Err(GpuError::OutOfMemory(action.to_owned())) } else { Ok(()) }
}

/// Sleeps for the milliseconds that the fault `name` gives, if it is set.
pub fn delay(name: &str) {
    if let Some(ms) = value(name) {
        std::thread::sleep(std::time::Duration::from_millis(ms));
    }
}

/// Whether a fault has lost the device.
static LOST: AtomicBool = AtomicBool::new(false);

/// Carries out the fault `by-name` for a new shader module.
pub(crate) fn take_module(spirv: &[u32]) {
    if value("by-name").is_none() {
        return;
    }
    // glslang writes the names of functions into the module: four characters a word.
    let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
    let has = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
    if has(b"crash_the_driver") {
        std::process::abort();
    }
    if has(b"lose_the_device") {
        LOST.store(true, Ordering::SeqCst);
    }
}

/// Loses the device at call number N of the process for a fault `name:N`.
pub fn lose_at(name: &str) {
    if strikes(name) {
        LOST.store(true, Ordering::SeqCst);
    }
}

/// Fails once a fault has lost the device. `action` continues "the device was lost while".
pub(super) fn lose(action: &'static str) -> Result<(), GpuError> {
    if LOST.load(Ordering::SeqCst) { Err(GpuError::DeviceLost(action)) } else { Ok(()) }
}

/// Parses the variable's text. The error is the part that is not a fault.
fn parse(text: &str) -> Result<BTreeMap<String, u64>, String> {
    let parts = text.split(',').map(str::trim).filter(|part| !part.is_empty());
    let fault = |part: &str| {
        let (name, value) = part.split_once(':')?;
        Some((name.trim().to_owned(), value.trim().parse().ok()?))
    };
    parts.map(|part| fault(part).ok_or_else(|| part.to_owned())).collect()
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn faults_are_named_numbers() {
        let faults = parse("image-bytes:1000, lost-frame:3").unwrap();
        assert_eq!(faults.get("image-bytes"), Some(&1000));
        assert_eq!(faults.get("lost-frame"), Some(&3));
        assert!(parse("").unwrap().is_empty());
    }

    #[test]
    fn a_part_that_is_no_fault_is_named() {
        assert_eq!(parse("image-bytes:1000,image").unwrap_err(), "image");
        assert_eq!(parse("image-bytes:many").unwrap_err(), "image-bytes:many");
    }
}
