//! The memory that images and buffers of passes take, and its limit.

use std::collections::{BTreeMap, BTreeSet};

use super::desc::PassDesc;
use super::images::buffer_of;
use super::lifetimes;
use crate::gpu::GpuError;
use crate::render::bound_frame::BoundFrame;
use crate::shader::annotation::pass::Target;

/// Fails if the images and buffers of passes take more memory than the user allows.
pub(super) fn check(frame: &BoundFrame) -> Result<(), GpuError> {
    let (request, size, limit) = (&frame.state.pipelines, frame.state.size, frame.state.pass_memory);
    let slots = lifetimes::slots(&request.passes, request.shown_pass.as_deref(), |pass, image| {
        PassDesc::new(pass, image, size)
    });
    let mut taken = BTreeSet::new();
    let mut scratch = Vec::new();
    let mut buffers = BTreeMap::new();
    let mut total = 0;
    for pass in &request.passes {
        for image in pass.note.images().filter(|_| pass.note.to == Target::Image) {
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
            let (name, place) = (pass.name(), &pass.note.place);
            return Err(GpuError::OutOfMemory(format!(
                "creating the images and buffers of the pass `{name}` ({}:{}): passes take {} MiB so far, and `--memory` allows {}",
                place.file,
                place.line,
                total.div_ceil(1 << 20),
                limit >> 20
            )));
        }
    }
    Ok(())
}
