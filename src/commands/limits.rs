//! Limits of the process that are too low for a device. Drivers and allocations abort a process that exceeds them, so they are checked before.

use std::error::Error as _;

use super::Failure;

/// Address space in MiB that a device needs at least.
const LEAST_MEMORY_MIB: u64 = 1536;
/// Stack of the first thread in KiB that a window and a compiler need at least.
const LEAST_STACK_KIB: u64 = 1024;

/// Fails if this process may use too little memory, or no threads. Starts the threads that share work.
///
/// # Errors
/// A message that names the limit.
pub fn check() -> Result<(), Failure> {
    match granted().0.map(|bytes| bytes >> 20) {
        Some(mib) if mib < LEAST_MEMORY_MIB => Err(too_low("memory", 'v', mib, "MiB", LEAST_MEMORY_MIB)),
        _ => start_threads(),
    }
}

/// Fails if the first thread has too little stack.
///
/// # Errors
/// A message that names the limit.
pub fn check_stack() -> Result<(), Failure> {
    match granted().1.map(|bytes| bytes >> 10) {
        Some(kib) if kib < LEAST_STACK_KIB => Err(too_low("stack", 's', kib, "KiB", LEAST_STACK_KIB)),
        _ => Ok(()),
    }
}

fn too_low(what: &str, option: char, found: u64, unit: &str, least: u64) -> Failure {
    let limit = format!("this process may use {found} {unit} of {what} (`ulimit -{option}`)");
    Failure::Device(format!("{limit}, and Specula needs {least} {unit}: raise the limit"))
}

/// The limits of memory and stack in bytes. `None` if there is no limit.
fn granted() -> (Option<u64>, Option<u64>) {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{Resource, getrlimit};
        (getrlimit(Resource::As).current, getrlimit(Resource::Stack).current)
    }
    #[cfg(not(target_os = "linux"))]
    (None, None)
}

/// rayon panics if its threads start on first use and cannot.
fn start_threads() -> Result<(), Failure> {
    match rayon::ThreadPoolBuilder::new().build_global() {
        // Without a source, the error says that they have started before.
        Err(error) if error.source().is_some() => Err(Failure::Device(format!(
            "cannot start threads: {error}. The limit of processes (`ulimit -u`) or of memory is too low"
        ))),
        _ => Ok(()),
    }
}
