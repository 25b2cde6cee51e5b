//! Finds and decodes the images that materials use.

use std::borrow::Cow;
use std::io::Cursor;

use gltf::json;
use image::{ImageFormat, ImageReader};
use rayon::prelude::*;

use super::super::error::Problem;
use super::super::model::Image;
use super::buffers::{Buffers, Files};
use super::place;

/// Widest and highest image: what every Vulkan device with 16k textures takes.
const MAX_SIZE: u32 = 16384;
/// Most bytes that a decoder may ask for.
const MAX_DECODED_BYTES: u64 = 512 << 20;

/// An image before decoding.
pub struct Source<'a> {
    name: String,
    place: String,
    used_by: String,
    bytes: Cow<'a, [u8]>,
}

/// Reads the encoded bytes of an image.
pub fn find<'a>(
    root: &json::Root,
    buffers: &'a Buffers<'_>,
    files: &mut Files<'_>,
    index: usize,
    used_by: String,
) -> Result<Source<'a>, Problem> {
    let Some(image) = root.images.get(index) else {
        return Err(super::out_of_range(&used_by, "images", index, root.images.len()));
    };
    let place = place("images", index, image.name.as_deref());
    let bytes = match (&image.uri, image.buffer_view) {
        (Some(uri), None) => Cow::Owned(files.load(uri, &place)?),
        (None, Some(view)) => Cow::Borrowed(buffers.view(root, view, &place)?),
        (Some(_), Some(_)) => return Err(Problem::invalid(place, "a uri or a bufferView", "both")),
        (None, None) => return Err(Problem::invalid(place, "a uri or a bufferView", "neither")),
    };
    let uri = image.uri.as_ref().filter(|uri| !uri.starts_with("data:"));
    let name = image.name.clone().or_else(|| uri.cloned()).unwrap_or_else(|| format!("image {index}"));
    Ok(Source { name, place, used_by, bytes })
}

/// Decodes images in parallel.
pub fn decode(sources: &[Source<'_>]) -> Result<Vec<Image>, Problem> {
    sources.par_iter().map(decode_one).collect()
}

fn decode_one(source: &Source<'_>) -> Result<Image, Problem> {
    let failed = |found: String| Problem::Image { image: source.place.clone(), used_by: source.used_by.clone(), found };
    // The content decides: mimeType and file endings are often wrong, and may be absent.
    let format = match image::guess_format(&source.bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) => format,
        Ok(other) => return Err(failed(format!("{other:?}"))),
        Err(_) => return Err(failed(format!("{} bytes of another kind", source.bytes.len()))),
    };
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIZE);
    limits.max_image_height = Some(MAX_SIZE);
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(&*source.bytes), format);
    reader.limits(limits);
    let decoded = reader.decode().map_err(|error| failed(error.to_string()))?.into_rgba8();
    let (width, height) = decoded.dimensions();
    if width == 0 || height == 0 {
        return Err(failed(format!("{width}x{height} pixels")));
    }
    Ok(Image { name: source.name.clone(), width, height, rgba8: decoded.into_raw() })
}
