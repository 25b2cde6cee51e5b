//! Which images of a frame can be one image of the device: those that are read for the last time before the other is drawn.
//!
//! Images share memory only if they have the same size, format and levels, and are drawn again with every frame.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::shader::GraphPass;
use crate::shader::annotation::pass::{PassFormat, PassTarget};
use crate::shader::graph::Input;

/// An image of the device while passes are assigned to it.
struct SharedImage<D> {
    desc: D,
    /// Index of the last pass that reads what the newest pass has drawn to it.
    last_read: usize,
}

/// The images that need not outlive their frame, by name, each with the number of its slot. Images of the same slot have equal
/// properties, and share an image of the device.
///
/// An image is left out if it lasts longer (`keep`, `before_NAME`), if a later frame may take it over because nothing that it
/// depends on has changed, or if its pass may leave texels as they were (compute).
///
/// `passes`: those of the frame, in order. `shown`: the image that the frame shows in place of the picture.
pub(super) fn shared_images<'a, D: PartialEq>(
    passes: &'a [Arc<GraphPass>],
    shown: Option<&str>,
    describe: impl Fn(&'a GraphPass, (&'a str, PassFormat)) -> D,
) -> BTreeMap<&'a str, usize> {
    let mut last_reads = BTreeMap::new();
    let mut outlive = BTreeSet::new();
    for (index, input) in
        passes.iter().enumerate().flat_map(|(i, pass)| pass.inputs.values().map(move |input| (i, input)))
    {
        match input {
            Input::Image(name) => drop(last_reads.insert(name.as_str(), index)),
            Input::Before(name) => drop(outlive.insert(name.as_str())),
            _ => {}
        }
    }
    last_reads.extend(shown.map(|name| (name, usize::MAX)));
    let mut shared: Vec<SharedImage<D>> = Vec::new();
    let mut slot_of = BTreeMap::new();
    let mut redrawn = BTreeSet::new();
    for (index, pass) in passes.iter().enumerate().filter(|(_, pass)| pass.desc.to == PassTarget::Image) {
        if !is_redrawn(pass, &redrawn) {
            continue;
        }
        redrawn.extend(pass.desc.images().map(|(name, _)| name));
        if pass.is_compute || pass.desc.keep {
            continue;
        }
        for image in pass.desc.images().filter(|(name, _)| !outlive.contains(name)) {
            let desc = describe(pass, image);
            let last_read = last_reads.get(image.0).copied().unwrap_or(index);
            let free = shared.iter().position(|slot| slot.last_read < index && slot.desc == desc);
            let slot = free.unwrap_or(shared.len());
            match shared.get_mut(slot) {
                Some(taken) => taken.last_read = last_read,
                None => shared.push(SharedImage { desc, last_read }),
            }
            slot_of.insert(image.0, slot);
        }
    }
    slot_of
}

/// Whether a pass is drawn again in every frame, whatever has changed. `redrawn`: such images of earlier passes.
fn is_redrawn(pass: &GraphPass, redrawn: &BTreeSet<&str>) -> bool {
    pass.is_compute
        || pass.desc.keep
        || pass.inputs.values().any(|input| match input {
            Input::Image(name) => redrawn.contains(name.as_str()),
            other => other.is_of_picture(),
        })
}
