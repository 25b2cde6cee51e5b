//! The memory that images and buffers of passes take, and its limit.

use std::collections::{BTreeMap, BTreeSet};

use super::desc::PassDesc;
use super::lifetimes;
use crate::frame::PipelineRequest;
use crate::shader::Diagnostic;
use crate::shader::annotation::pass::{PassFormat, PassSize, PassTarget};
use crate::shader::graph::Input;

/// An error at the line of the first pass with which the images and buffers of `request` take more than `limit` bytes, for a
/// frame of this size.
pub fn beyond_memory(request: &PipelineRequest, size: (u32, u32), limit: u64) -> Option<Diagnostic> {
    let slots = lifetimes::shared_images(&request.passes, request.shown_pass.as_deref(), |pass, image| {
        PassDesc::new(pass, image, size)
    });
    let mut taken = BTreeSet::new();
    let mut scratch = Vec::new();
    let mut buffers = BTreeMap::new();
    let mut total = 0;
    for pass in &request.passes {
        for image in pass.desc.images().filter(|_| pass.desc.to == PassTarget::Image) {
            let desc = PassDesc::new(pass, image, size);
            let texel = u64::from(image.1.bytes());
            if slots.get(image.0).is_none_or(|slot| taken.insert(*slot)) {
                total += desc.texels() * texel;
            }
            // Passes share scratch images of equal description, because each pass needs them only while it draws.
            for (of, bytes) in [(desc.first_level(), texel), (desc.depth(), 4)] {
                if let Some(of) = of.filter(|of| !scratch.contains(of)) {
                    total += u64::from(of.size.0) * u64::from(of.size.1) * bytes;
                    scratch.push(of);
                }
            }
        }
        let new = pass
            .inputs
            .values()
            .filter_map(buffer_of)
            .filter(|(name, bytes)| buffers.insert((*name).to_owned(), *bytes).is_none());
        total += new.map(|(_, bytes)| u64::from(bytes)).sum::<u64>();
        if total > limit {
            let mib = total.div_ceil(1 << 20);
            let message = format!(
                "with the pass `{}` the images and buffers of passes take {mib} MiB, and --memory allows {}",
                pass.name(),
                limit >> 20
            );
            let desc = &pass.desc;
            let word = match (desc.size, desc.format) {
                (PassSize::Pixels(..), _) => "size=",
                (_, format) if format != PassFormat::default() => "format=",
                _ => desc.name.as_str(),
            };
            let help =
                "a smaller size=, a format= with fewer bytes and no keep or mips take less; --memory MIB allows more";
            return Some(desc.place.error_at(word, message).with_help(help));
        }
    }
    None
}

/// Name and size of a buffer, in bytes.
pub(super) fn buffer_of(input: &Input) -> Option<(&str, u32)> {
    match input {
        Input::Buffer(name, bytes, _) => Some((name, *bytes)),
        _ => None,
    }
}
