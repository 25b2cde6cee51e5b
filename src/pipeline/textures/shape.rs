//! Tells from the sizes of a texture's files how large the image is, and how it is cut out of them.

use crate::gpu::Gpu;
use crate::shader::graph::{Texture, TextureKind};

/// The largest number of texels of a texture's first level. With mip levels in half floats it takes 2.3 GiB.
const MOST_TEXELS: u64 = 1 << 28;

/// How the layers of an image come from its files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Each file is a layer.
    Files,
    /// Each layer is a tile of the only file, at this column and row of tiles.
    Tiles(Vec<[u32; 2]>),
    /// As tiles, but the last layer is upside down: the face -Z of a vertical cross.
    VerticalCross(Vec<[u32; 2]>),
    /// The only file is an equirectangular picture.
    Panorama,
}

/// The size of an image, and how it is cut out of its files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    /// Width of a layer, texels.
    pub(super) width: u32,
    /// Height of a layer, texels.
    pub(super) height: u32,
    /// Faces of a cube, slices of a volume, or layers.
    pub(super) layers: u32,
    pub(super) cut: Cut,
}

impl Shape {
    /// The shape of a texture whose files have these widths and heights in pixels, in their order.
    ///
    /// # Errors
    /// A message that begins with a file, if the sizes do not fit the kind of the texture.
    pub(super) fn of(texture: &Texture, sizes: &[(u32, u32)]) -> Result<Self, String> {
        let file = |index: usize| texture.files[index].path.as_str();
        let (width, height) = sizes[0];
        if width == 0 || height == 0 {
            return Err(format!("{} has no pixels", file(0)));
        }
        if let Some(other) = sizes.iter().position(|size| *size != sizes[0]) {
            let (found, first) = (pixels(sizes[other]), pixels(sizes[0]));
            return Err(format!("{} has {found} pixels, and {} has {first}; expected one size", file(other), file(0)));
        }
        let tiles = |(columns, rows): (u32, u32), at: Vec<[u32; 2]>| Self {
            width: width / columns,
            height: height / rows,
            layers: at.len() as u32,
            cut: Cut::Tiles(at),
        };
        let whole = Self { width, height, layers: sizes.len() as u32, cut: Cut::Files };
        let found = pixels((width, height));
        match texture.kind {
            TextureKind::Flat => Ok(whole),
            TextureKind::Cube if sizes.len() > 1 => match width == height {
                true => Ok(whole),
                false => Err(format!("{} has {found} pixels; expected a square face", file(0))),
            },
            TextureKind::Cube => {
                faces_of(width, height).ok_or_else(|| format!("{} has {found} pixels; expected {FACES}", file(0)))
            }
            TextureKind::Volume | TextureKind::Array if sizes.len() > 1 || texture.desc.image.contains('*') => {
                Ok(whole)
            }
            // Without a number, a table has as many slices as they are wide.
            TextureKind::Volume | TextureKind::Array => {
                let layers = texture.desc.layers.unwrap_or(width.min(height));
                if texture.desc.layers.is_none() && width.max(height) != layers.saturating_mul(layers) {
                    return Err(format!(
                        "{} has {found} pixels, from which the number of slices does not follow; add layers=8, or name a file \
                         each with a `*`",
                        file(0)
                    ));
                }
                match strip(width, height, layers).map_err(|message| format!("{} {message}", file(0)))? {
                    Strip::Across => Ok(tiles((layers, 1), (0..layers).map(|x| [x, 0]).collect())),
                    Strip::Down => Ok(tiles((1, layers), (0..layers).map(|y| [0, y]).collect())),
                }
            }
        }
    }

    /// A message if the device has no such image.
    pub(super) fn beyond(&self, gpu: &Gpu, kind: TextureKind) -> Option<String> {
        let Self { width, height, layers, .. } = *self;
        let found = pixels((width, height));
        let (most, most_layers) = match kind {
            TextureKind::Flat => (gpu.max_image_size(), 1),
            TextureKind::Cube => (gpu.max_cube_size(), 6),
            TextureKind::Volume => (gpu.max_volume_size(), gpu.max_volume_size()),
            TextureKind::Array => (gpu.max_image_size(), gpu.max_layers()),
        };
        let what = match kind {
            TextureKind::Flat => "",
            TextureKind::Cube => " in a face of a cube map",
            TextureKind::Volume => " in a slice of a volume",
            TextureKind::Array => " in a layer",
        };
        if width > most || height > most {
            return Some(format!("has {found} pixels{what}; this device has at most {most} a side"));
        }
        if layers > most_layers {
            let what = if kind == TextureKind::Volume { "slices" } else { "layers" };
            return Some(format!("has {layers} {what}; this device has at most {most_layers}"));
        }
        let texels = u64::from(width) * u64::from(height) * u64::from(layers);
        (texels > MOST_TEXELS).then(|| format!("has {texels} texels in all; expected at most {MOST_TEXELS}"))
    }
}

/// The layouts that a cube map can be cut out of.
const FACES: &str = "six squares (6:1 or 1:6), a cross of squares (4:3 or 3:4), an equirectangular picture (2:1), \
                     or six files with a `*` in their name";

/// The six faces in an image of this size, in the order +X -X +Y -Y +Z -Z. `None` if no layout has this size.
fn faces_of(width: u32, height: u32) -> Option<Shape> {
    let (columns, rows) = [(6, 1), (1, 6), (4, 3), (3, 4), (2, 1)]
        .into_iter()
        .find(|(columns, rows)| u64::from(width) * rows == u64::from(height) * columns)?;
    let side = if (columns, rows) == (2, 1) { height.div_ceil(2) } else { width / columns as u32 };
    let cut = match (columns, rows) {
        (6, 1) => Cut::Tiles((0..6).map(|x| [x, 0]).collect()),
        (1, 6) => Cut::Tiles((0..6).map(|y| [0, y]).collect()),
        // -X +Z +X -Z side by side, +Y above and -Y below +Z.
        (4, 3) => Cut::Tiles(vec![[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]]),
        // -X +Z +X side by side, +Y above, -Y and -Z below +Z.
        (3, 4) => Cut::VerticalCross(vec![[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [1, 3]]),
        _ => Cut::Panorama,
    };
    // A picture of 4 x 3 pixels has squares of one pixel; none has less.
    (side > 0).then_some(Shape { width: side, height: side, layers: 6, cut })
}

/// The direction in which layers follow each other in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Strip {
    Across,
    Down,
}

/// The direction in which `layers` layers lie in an image: the one that the size allows, or else the one with square layers.
fn strip(width: u32, height: u32, layers: u32) -> Result<Strip, String> {
    let found = pixels((width, height));
    let (across, down) = (width.is_multiple_of(layers), height.is_multiple_of(layers));
    let (is_row, is_column) = (width / layers == height, height / layers == width);
    match (across, down) {
        (false, false) => Err(format!("has {found} pixels, which layers={layers} divides neither across nor down")),
        (true, false) => Ok(Strip::Across),
        (false, true) => Ok(Strip::Down),
        (true, true) if is_row && !is_column => Ok(Strip::Across),
        (true, true) if is_column => Ok(Strip::Down),
        (true, true) => Err(format!(
            "has {found} pixels, which layers={layers} divides into {} side by side or {} one above the other; make the \
             layers squares, or name a file each with a `*`",
            pixels((width / layers, height)),
            pixels((width, height / layers))
        )),
    }
}

fn pixels((width, height): (u32, u32)) -> String {
    format!("{width} x {height}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_runs_where_its_size_allows() {
        assert_eq!(strip(256, 16, 16), Ok(Strip::Across));
        assert_eq!(strip(8, 32, 4), Ok(Strip::Down));
        assert_eq!(strip(9, 4, 4), Ok(Strip::Down));
        assert_eq!(strip(12, 7, 4), Ok(Strip::Across));
        assert_eq!(strip(5, 5, 1), Ok(Strip::Down));
        assert!(strip(12, 8, 4).unwrap_err().contains("3 x 8 side by side or 12 x 2 one above the other"));
        assert!(strip(5, 7, 4).unwrap_err().contains("divides neither"));
    }

    #[test]
    fn the_faces_of_a_picture_follow_from_its_size() {
        let side = |width, height| faces_of(width, height).map(|shape| shape.width);
        assert_eq!([(12, 2), (2, 12), (8, 6), (6, 8), (8, 4)].map(|(w, h)| side(w, h)), [Some(2); 5]);
        assert_eq!([(4, 4), (5, 1), (0, 0)].map(|(w, h)| side(w, h)), [None; 3]);
        assert_eq!(faces_of(8, 4).map(|shape| shape.cut), Some(Cut::Panorama));
    }
}
