//! Finds and decodes the images that materials use. A bad image does not prevent the model from loading: `placeholder`
//! replaces it.

use std::borrow::Cow;
use std::io::{Cursor, ErrorKind};

use gltf::json;
use image::{DynamicImage, ImageDecoder as _, ImageFormat, ImageReader};
use rayon::prelude::*;

use super::placeholder::Failure;
use super::textures::Origin;
use super::{ktx2, placeholder};
use crate::message::catch_panic;
use crate::scene::error::{EXPORT_AGAIN, Problem};
use crate::scene::gltf::file::buffers::{Buffers, Files};
use crate::scene::gltf::file::uri;
use crate::scene::gltf::memory::Memory;
use crate::scene::gltf::place::{out_of_range, place};
use crate::scene::images::{TexelForm, Texels};
use crate::scene::load_options::Canceled;
use crate::scene::model::{Image, Model};

/// Maximum width and height of an image, in pixels.
const MAX_SIZE: u32 = 16384;
/// Maximum number of bytes that a decoder may allocate.
const MAX_DECODED_BYTES: u64 = 512 << 20;
/// Encoded bytes of images that take 30 ms and more to decode.
const LONG: usize = 1 << 20;
/// Maximum length of a quoted decoder message, in characters.
const LONGEST_REASON: usize = 120;

/// The first bytes of other formats, and their names.
const OTHER_FORMATS: [(&[u8], &str); 3] = [(b"\xabKTX 11\xbb", "KTX"), (b"DDS ", "DDS"), (b"sB", "a .basis file")];

/// The remedy for an image in a format that Specula does not read.
const OTHER_FORMAT: &str = "Export the image as PNG, JPEG, WebP or KTX2.";
/// The remedy for a damaged image.
const DAMAGED: &str = "Export or copy the image again.";

/// An image before decoding.
pub struct Encoded<'a> {
    name: String,
    /// The image in messages: `image 'a.png'`.
    title: String,
    bytes: Result<Cow<'a, [u8]>, Failure>,
}

/// An image after decoding, or the placeholder if decoding failed.
pub struct Decoded {
    /// The image.
    pub image: Image,
    /// Why it could not be read or decoded.
    pub failure: Option<Failure>,
}

/// Reads the encoded bytes of an image. Opens no file outside the model's folder unless the options allow it.
pub fn find<'a>(root: &json::Root, buffers: &'a Buffers<'_>, files: &mut Files<'_>, origin: Origin) -> Encoded<'a> {
    let (index, lacking) = match origin {
        Origin::Image(index) => (Some(index), None),
        Origin::Texture(index) => lacking(root, index),
    };
    let image = index.and_then(|index| root.images.get(index));
    let file = image.and_then(|image| image.uri.as_ref()).filter(|uri| !uri::is_data(uri));
    let name = image.and_then(|image| image.name.as_ref());
    let number = match (index, origin) {
        (Some(index), _) => format!("image {index}"),
        (None, Origin::Image(index) | Origin::Texture(index)) => format!("the image of texture {index}"),
    };
    let title = file.or(name).map_or_else(|| number.clone(), |name| format!("image '{}'", name.escape_debug()));
    let bytes = match (lacking, index) {
        (None, Some(index)) => read(root, buffers, files, index).map_err(|problem| Failure {
            reason: format!("{title} cannot be read ({})", shorten(&reason(&problem))),
            remedy: problem.remedy().unwrap_or(EXPORT_AGAIN),
        }),
        (lacking, _) => Err(Failure {
            reason: format!("{title} cannot be decoded ({})", lacking.unwrap_or_default()),
            remedy: OTHER_FORMAT,
        }),
    };
    Encoded { name: name.or(file).cloned().unwrap_or(number), title, bytes }
}

/// For a texture without an image that Specula can decode: the unsupported image, if any, and the reason.
fn lacking(root: &json::Root, texture: usize) -> (Option<usize>, Option<String>) {
    let extensions = root.textures.get(texture).and_then(|texture| texture.extensions.as_ref());
    let named = extensions.and_then(|extensions| extensions.others.iter().next());
    let Some((name, value)) = named else { return (None, Some("the texture names none".into())) };
    let image = value.get("source").and_then(json::Value::as_u64).and_then(|index| usize::try_from(index).ok());
    (image, Some(format!("{name} is not supported")))
}

fn read<'a>(
    root: &json::Root,
    buffers: &'a Buffers<'_>,
    files: &mut Files<'_>,
    index: usize,
) -> Result<Cow<'a, [u8]>, Problem> {
    let Some(image) = root.images.get(index) else {
        return Err(out_of_range("textures", "images", index, root.images.len()));
    };
    let place = place("images", index, image.name.as_deref());
    match (&image.uri, image.buffer_view) {
        (Some(uri), None) => Ok(Cow::Owned(files.load(uri, &place)?)),
        (None, Some(view)) => Ok(Cow::Borrowed(buffers.view(root, view, &place)?)),
        (Some(_), Some(_)) => Err(Problem::invalid(place, "a uri or a bufferView", "both")),
        (None, None) => Err(Problem::invalid(place, "a uri or a bufferView", "neither")),
    }
}

/// The reason of a problem, without the file that the image's title names.
fn reason(problem: &Problem) -> String {
    match problem {
        Problem::External { source, .. } if source.kind() == ErrorKind::NotFound => "there is no such file".into(),
        Problem::External { source, .. } => source.to_string(),
        Problem::Outside { found, .. } => format!("expected a file in the model's folder, found {found}"),
        Problem::Scheme { scheme, .. } => format!("the scheme `{scheme}:` is never opened"),
        other => other.reason(),
    }
}

/// Whether decoding the images takes so long that it is worth showing the model without them.
pub fn take_long(encoded: &[Encoded<'_>]) -> bool {
    let bytes = |image: &Encoded<'_>| image.bytes.as_ref().map_or(0, |bytes| bytes.len());
    encoded.iter().map(bytes).sum::<usize>() >= LONG
}

/// A placeholder of one pixel for each image.
pub fn placeholders(model: &Model, encoded: &[Encoded<'_>]) -> Vec<Image> {
    let name = |image: &Encoded<'_>| image.name.clone();
    encoded.iter().enumerate().map(|(index, image)| placeholder::pixel(name(image), model, index)).collect()
}

/// Decodes images in parallel, and frees the encoded bytes of each as soon as it is decoded. Stops early if the load is `canceled`.
pub fn decode(encoded: Vec<Encoded<'_>>, memory: &Memory, canceled: Canceled<'_>) -> Vec<Decoded> {
    encoded.into_par_iter().map(|image| (!canceled()).then(|| decode_one(image, memory))).while_some().collect()
}

fn decode_one(encoded: Encoded<'_>, memory: &Memory) -> Decoded {
    let Encoded { name, title, bytes } = encoded;
    let pixels = bytes.and_then(|bytes| {
        // A decoder that panics at a damaged image fails only that image.
        let pixels = catch_panic(|| pixels(&bytes, memory)).unwrap_or_else(|_| Err("the decoder failed".into()));
        pixels.map_err(|reason| Failure {
            reason: format!("{title} cannot be decoded ({})", shorten(&reason)),
            remedy: if ktx2::is_ktx2(&bytes) || known_format(&bytes).is_some() { DAMAGED } else { OTHER_FORMAT },
        })
    });
    match pixels {
        Ok((width, height, texels)) => Decoded { image: Image::new(name, width, height, texels), failure: None },
        Err(failure) => Decoded { image: placeholder::checkerboard(name), failure: Some(failure) },
    }
}

/// The format of an image's content: mimeType and file endings are often wrong or absent.
fn known_format(bytes: &[u8]) -> Option<ImageFormat> {
    let known = |format: &ImageFormat| matches!(format, ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP);
    image::guess_format(bytes).ok().filter(known)
}

/// Width, height and texels, or the reason of a failure.
fn pixels(bytes: &[u8], memory: &Memory) -> Result<(u32, u32, Texels), String> {
    if ktx2::is_ktx2(bytes) {
        return ktx2::texels(bytes, MAX_SIZE, &|bytes| take(memory, bytes));
    }
    if bytes.is_empty() {
        return Err("it is empty".into());
    }
    let Some(format) = known_format(bytes) else {
        let other =
            OTHER_FORMATS.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, name)| (*name).to_owned());
        let name = other.or_else(|| image::guess_format(bytes).ok().map(|format| format!("{format:?}")));
        return Err(name.map_or("it is not PNG, JPEG, WebP or KTX2".into(), |name| format!("{name} is not supported")));
    };
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIZE);
    limits.max_image_height = Some(MAX_SIZE);
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|error| error.to_string())?;
    // Kept as RGBA of 8 or 16 bits a channel.
    let (across, up) = decoder.dimensions();
    let deep = decoder.color_type().bytes_per_pixel() / decoder.color_type().channel_count();
    take(memory, u64::from(across) * u64::from(up) * 4 * u64::from(deep))?;
    let decoded = DynamicImage::from_decoder(decoder).map_err(|error| error.to_string())?;
    let (width, height) = (decoded.width(), decoded.height());
    if width == 0 || height == 0 {
        return Err(format!("it has {width}x{height} pixels"));
    }
    let (form, bytes) = match decoded {
        // A quarter less memory until the upload.
        DynamicImage::ImageRgb8(image) => (TexelForm::Rgb8, image.into_raw()),
        _ if decoded.color().bytes_per_pixel() == 2 * decoded.color().channel_count() => sixteen_bits(decoded),
        _ => (TexelForm::Rgba8, decoded.into_rgba8().into_raw()),
    };
    Ok((width, height, Texels::Stored { form, levels: 1, bytes }))
}

/// Takes memory for the texels of an image.
fn take(memory: &Memory, bytes: u64) -> Result<(), String> {
    let of_file = memory.take(Some(bytes), "its texels");
    of_file.map_err(|problem| problem.reason())
}

/// The texels of an image with 16 bits a channel. One that was widened from 8 bits, so that both bytes of each channel are equal, has 8.
fn sixteen_bits(image: DynamicImage) -> (TexelForm, Vec<u8>) {
    let wide = image.into_rgba16().into_raw();
    if wide.iter().all(|word| word % 257 == 0) {
        return (TexelForm::Rgba8, wide.into_iter().map(|word| (word / 257) as u8).collect());
    }
    (TexelForm::Rgba16, wide.into_iter().flat_map(u16::to_le_bytes).collect())
}

/// Shortens a message to one line that fits into a sentence.
fn shorten(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST_REASON) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}
