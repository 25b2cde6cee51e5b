//! Tells which parts of a picture were not checked.

use std::collections::BTreeSet;

use specula::message::warn;

/// Warns of stages that the device cannot let write to buffers, and of operations for which a stage has no room.
pub fn warn_of_unchecked(device: &str, stages: &BTreeSet<String>, dropped: usize) {
    if !stages.is_empty() {
        let stages: Vec<&str> = stages.iter().map(String::as_str).collect();
        let stages = stages.join(", ");
        warn(format_args!("{device} cannot write buffers from these stages, which are not checked: {stages}"));
    }
    if dropped > 0 {
        warn(format_args!("{dropped} operations of large stages are not checked"));
    }
}
