//! Cube maps of equirectangular pictures, in the directions of Specula's environments: the center column is seen looking down
//! -Z, columns to its right are towards +X, and the first row is +Y.

use glam::{Vec2, Vec3, Vec4};
use image::{DynamicImage, Rgba32FImage, RgbaImage};
use rayon::prelude::*;

use crate::scene::environment::uv_from_direction;
use crate::scene::mips::encode_srgb;
use crate::settings::linear_from_srgb;

/// Samples along each side of a texel, which are averaged.
const POINTS: u32 = 2;

/// Linear light at the texels of an image.
struct Panorama {
    width: u32,
    height: u32,
    texels: Vec<[f32; 4]>,
}

/// The faces of `picture` in the order +X -X +Y -Y +Z -Z, each `side` texels wide: floats for float images, 8 bits for others.
/// With `srgb`, the colors of the latter are sRGB-encoded, and filtered as linear light.
pub(super) fn faces(picture: &DynamicImage, side: u32, srgb: bool) -> Vec<DynamicImage> {
    let is_float = is_float(picture);
    let mut texels: Vec<[f32; 4]> = picture.to_rgba32f().pixels().map(|pixel| pixel.0).collect();
    let is_encoded = srgb && !is_float;
    if is_encoded {
        let decode = |texel: &mut [f32; 4]| texel[..3].iter_mut().for_each(|value| *value = linear_from_srgb(*value));
        texels.par_iter_mut().for_each(decode);
    }
    let panorama = Panorama { width: picture.width(), height: picture.height(), texels };
    (0..6).map(|face| panorama.face(face, side, is_float, is_encoded)).collect()
}

/// Whether the image has floats, which are linear light.
pub(super) fn is_float(picture: &DynamicImage) -> bool {
    matches!(picture, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_))
}

impl Panorama {
    fn face(&self, face: u32, side: u32, is_float: bool, is_encoded: bool) -> DynamicImage {
        let row = |y: u32| (0..side).flat_map(move |x| self.mean(face, side, (x, y)).to_array());
        let values: Vec<f32> = (0..side).into_par_iter().flat_map_iter(row).collect();
        if is_float {
            return Rgba32FImage::from_raw(side, side, values).unwrap_or_default().into();
        }
        let byte = |(index, value): (usize, f32)| match is_encoded && index % 4 < 3 {
            true => (encode_srgb(value) * 255.0).round() as u8,
            false => (value * 255.0).round() as u8,
        };
        let bytes = values.into_iter().enumerate().map(byte).collect();
        RgbaImage::from_raw(side, side, bytes).unwrap_or_default().into()
    }

    /// The mean light of a texel.
    fn mean(&self, face: u32, side: u32, (x, y): (u32, u32)) -> Vec4 {
        let place =
            |texel: u32, point: u32| ((texel * POINTS + point) as f32 + 0.5) * (2.0 / (side * POINTS) as f32) - 1.0;
        let points = (0..POINTS).flat_map(|v| (0..POINTS).map(move |u| Vec2::new(place(x, u), place(y, v))));
        points.map(|st| self.at(direction(face, st))).sum::<Vec4>() / (POINTS * POINTS) as f32
    }

    /// Filters the four texels around a direction. The left and right edges are neighbors.
    fn at(&self, direction: Vec3) -> Vec4 {
        let at = uv_from_direction(direction) * Vec2::new(self.width as f32, self.height as f32) - 0.5;
        let (corner, part) = (at.floor(), at - at.floor());
        let texel = |dx: i32, dy: i32| {
            let x = (corner.x as i32 + dx).rem_euclid(self.width as i32);
            let y = (corner.y as i32 + dy).clamp(0, self.height as i32 - 1);
            Vec4::from_array(self.texels[(y as u32 * self.width + x as u32) as usize])
        };
        let row = |dy: i32| texel(0, dy).lerp(texel(1, dy), part.x);
        row(0).lerp(row(1), part.y)
    }
}

/// A direction through a face, not unit. `st` runs right and down as seen from inside, -1..1 (Vulkan 1.3, table "Cube map face
/// and coordinate selection").
fn direction(face: u32, st: Vec2) -> Vec3 {
    let Vec2 { x: s, y: t } = st;
    match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture whose colors are its directions: each texel of each face has its own.
    #[test]
    fn faces_look_where_they_should() {
        let picture = Rgba32FImage::from_fn(256, 128, |x, y| {
            let d = crate::scene::environment::direction_from_uv((x as f32 + 0.5) / 256.0, (y as f32 + 0.5) / 128.0);
            image::Rgba([d.x, d.y, d.z, 1.0])
        });
        for (face, image) in (0..).zip(faces(&picture.into(), 8, true)) {
            for (x, y, pixel) in image.to_rgba32f().enumerate_pixels() {
                let st = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / 4.0 - 1.0;
                let (found, expected) = (Vec3::from_slice(&pixel.0), direction(face, st).normalize());
                assert!((found - expected).length() < 0.02, "face {face}, {st}: {found} is not {expected}");
            }
        }
    }

    #[test]
    fn a_flat_picture_stays_flat() {
        let picture = RgbaImage::from_pixel(8, 4, image::Rgba([10, 128, 250, 77]));
        for srgb in [false, true] {
            for face in faces(&picture.clone().into(), 2, srgb) {
                assert!(face.to_rgba8().pixels().all(|pixel| pixel.0 == [10, 128, 250, 77]));
            }
        }
    }
}
