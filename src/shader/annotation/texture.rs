//! Parses `//@texture`, with which a shader tree adds image files to a frame.

use serde::Serialize;

use super::cursor::Cursor;
use super::name::name;
use super::place::AnnotationPlace;
use crate::shader::diagnostic::Diagnostic;

/// The addressing mode of a texture, for coordinates beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Wrap {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The texels at the edge are repeated.
    Clamp,
    /// The texture repeats, every other time as its mirror image.
    Mirror,
}

/// A declared texture: one or more image files of the tree.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct TextureDesc {
    /// Name in GLSL.
    pub name: String,
    /// Path of the image, relative to the file with the annotation or to the tree's root. A `*` in the file's name stands for
    /// the faces, layers or slices.
    pub image: String,
    /// Path of the file with the annotation, relative to the tree's root.
    pub declared_in: String,
    /// Whether its colors are sRGB-encoded, so that a shader reads linear light.
    pub srgb: bool,
    /// Addressing mode.
    pub wrap: Wrap,
    /// Whether it has mip levels.
    pub mips: bool,
    /// Whether the nearest texel is read where the texture is made smaller, and where it is made larger.
    pub nearest: [bool; 2],
    /// Whether the first row of each picture, face, layer and slice is at the bottom, as in OpenGL.
    pub flip: bool,
    /// Number of layers or slices in one image, 1 to 65536.
    pub layers: Option<u32>,
    /// Location of the annotation.
    #[serde(skip)]
    pub place: AnnotationPlace,
}

/// Whether a file with this extension may be the image of a `//@texture`.
pub fn is_image_extension(extension: &str) -> bool {
    ["png", "jpg", "jpeg", "hdr", "exr", "cube"].iter().any(|known| known.eq_ignore_ascii_case(extension))
}

/// The values of `min=` and `mag=`.
const IS_NEAREST: [(&str, bool); 2] = [("nearest", true), ("linear", false)];

/// Parses the rest of a `//@texture`.
pub fn texture(cursor: &mut Cursor<'_>) -> Result<TextureDesc, Box<Diagnostic>> {
    let name = name(cursor, "texture")?;
    cursor.at_end();
    let start = cursor.position();
    let Some(image) = cursor.string()? else {
        return Err(cursor.expected("the image's file in quotes"));
    };
    if image.trim().is_empty() {
        return Err(cursor.error(start..cursor.position(), "expected the name of the image's file in the quotes"));
    }
    let mut desc = TextureDesc { name, image, srgb: true, place: cursor.place().clone(), ..TextureDesc::default() };
    while !cursor.at_end() {
        let (bytes, word) = cursor.key();
        match word {
            "srgb" => desc.srgb = true,
            "linear" => desc.srgb = false,
            "repeat" => desc.wrap = Wrap::Repeat,
            "clamp" => desc.wrap = Wrap::Clamp,
            "mirror" => desc.wrap = Wrap::Mirror,
            "min" => desc.nearest[0] = cursor.one_of(word, &IS_NEAREST)?,
            "mag" => desc.nearest[1] = cursor.one_of(word, &IS_NEAREST)?,
            "mips" => desc.mips = true,
            "flip" => desc.flip = true,
            "layers" => desc.layers = Some(layers(cursor)?),
            other => {
                let message = format!(
                    "expected srgb, linear, repeat, clamp, mirror, min=, mag=, mips, flip or layers=, found `{other}`"
                );
                return Err(cursor.error(bytes, message));
            }
        }
    }
    Ok(desc)
}

fn layers(cursor: &mut Cursor<'_>) -> Result<u32, Box<Diagnostic>> {
    /// More than any device has.
    const MOST: u32 = 65536;
    let (bytes, value) = cursor.value("layers")?;
    let count = value.parse().ok().filter(|count| (1..=MOST).contains(count));
    count.ok_or_else(|| cursor.error(bytes, format!("expected layers=1 to layers={MOST}, found `{value}`")))
}
