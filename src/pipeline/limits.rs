//! Errors about declarations that this device cannot have, each with its line.

use crate::gpu::Gpu;
use crate::shader::annotation::pass::PassSize;
use crate::shader::{Diagnostic, Graph};

/// Passes whose images are too large for the device.
pub fn beyond_limits(gpu: &Gpu, graph: &Graph) -> Vec<Diagnostic> {
    let most = gpu.max_image_size();
    let too_large = |(width, height): (u32, u32)| {
        let message = format!("has {width} x {height} pixels; this device has at most {most} a side");
        (width > most || height > most).then_some(message)
    };
    let mut out = Vec::new();
    for pass in &graph.passes {
        if let PassSize::Pixels(width, height) = pass.note.size {
            let message = too_large((width, height));
            out.extend(message.map(|message| pass.note.place.error(format!("the pass `{}` {message}", pass.name()))));
        }
    }
    out
}
