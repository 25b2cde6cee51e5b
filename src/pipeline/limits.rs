//! Errors about declarations that this device cannot have, each with its line.

use std::io::Cursor;

use image::{ImageError, ImageReader};

use super::cube;
use super::textures::is_cube;
use crate::gpu::Gpu;
use crate::shader::annotation::pass::PassSize;
use crate::shader::graph::Texture;
use crate::shader::{Diagnostic, Graph};

/// Images that are too large for the device, and textures that are no images.
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
    for texture in graph.textures.values() {
        let message = size(texture).map_or_else(Some, too_large);
        out.extend(message.map(|message| texture.note.place.error(format!("{} {message}", texture.path))));
    }
    out
}

/// Width and height of a texture, pixels.
fn size(texture: &Texture) -> Result<(u32, u32), String> {
    if is_cube(texture) {
        return cube::decode(&texture.bytes).map(|table| (table.width(), table.height()));
    }
    let reader = ImageReader::new(Cursor::new(&texture.bytes)).with_guessed_format();
    let size = reader.map_err(ImageError::IoError).and_then(ImageReader::into_dimensions);
    size.map_err(|error| format!("cannot be read: {error}"))
}
