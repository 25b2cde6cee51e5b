//! Tells which parts of a picture were not checked.

use std::collections::BTreeSet;

use specula::message::warn;

/// Warns of stages that the device cannot let write to buffers, and of operations for which a stage has no room.
/// `without_derivatives`: fragments cannot ask which neighbors run along.
pub fn warn_of_unchecked(device: &str, stages: &BTreeSet<String>, (dropped, without_derivatives): (usize, bool)) {
    if !stages.is_empty() {
        let stages: Vec<&str> = stages.iter().map(String::as_str).collect();
        let stages = stages.join(", ");
        warn(format_args!("{device} cannot write buffers from these stages, which are not checked: {stages}"));
    }
    if without_derivatives {
        warn(format_args!("{device} does not tell which pixels run along, so derivatives in branches are not checked"));
    }
    if dropped > 0 {
        warn(format_args!("{dropped} operations of large stages are not checked"));
    }
}
