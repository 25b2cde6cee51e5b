//! The environment that a model's file brings along (`EXT_lights_image_based`).

use glam::{Mat3, Quat, Vec3};
use rayon::prelude::*;

use super::decoded::MAX_WIDTH;
use super::panorama::peak;
use super::projection::GL_ROW;
use super::{Environment, fingerprint};
use crate::settings::linear_from_srgb;

/// The name by which settings choose the environment of the model's file.
pub const MODEL: &str = "model";

/// Faces of a cube, as a file holds them.
#[derive(Clone, Debug)]
pub struct ModelEnvironment {
    /// Name of the light, or empty.
    pub name: String,
    /// Width and height of a face, pixels, at least 1.
    pub side: u32,
    /// World from cube: how the cube is turned; a unit quaternion.
    pub rotation: Quat,
    /// Factor on the values of the faces, cd/m^2, finite and not negative. Frames apply it, so that clips may move it.
    pub intensity: f32,
    /// The faces +X -X +Y -Y +Z -Z, RGBA with 8 bits a channel. The colors are sRGB-encoded and divided by alpha (RGBD). Rows are
    /// stored from the lower edge of a face of OpenGL's cube map to its upper edge, as the extension flips them.
    faces: [Vec<u8>; 6],
    fingerprint: u128,
}

impl ModelEnvironment {
    /// Largest intensity; that of `environment.intensity`.
    pub const MAX_INTENSITY: f32 = 1e6;

    /// An environment of these faces: `side * side * 4` bytes each.
    pub fn new(name: String, side: u32, (rotation, intensity): (Quat, f32), faces: [Vec<u8>; 6]) -> Self {
        let mut bytes: Vec<u8> = rotation.to_array().iter().flat_map(|number| number.to_le_bytes()).collect();
        bytes.extend(side.to_le_bytes());
        faces.iter().for_each(|face| bytes.extend(face));
        Self { name, side, rotation, intensity, faces, fingerprint: fingerprint(&bytes) }
    }

    /// The hash of all that the pixels depend on.
    pub(super) fn fingerprint(&self) -> u128 {
        self.fingerprint
    }

    /// The equirectangular image.
    pub(super) fn decode(&self) -> Environment {
        let side = self.side as usize;
        let mut row = vec![[0.0; 4]; 6 * side * side];
        row.par_chunks_exact_mut(6 * side).enumerate().for_each(|(y, row)| {
            for (face, texels) in self.faces.iter().zip(row.chunks_exact_mut(side)) {
                let from = &face.as_chunks::<4>().0[(side - 1 - y) * side..][..side];
                texels.iter_mut().zip(from).for_each(|(texel, rgbd)| *texel = radiance(*rgbd));
            }
        });
        // The faces are those of OpenGL's cube map around the axes of glTF. Layouts have the front, glTF's -Z, in their fifth face.
        let front = Mat3::from_diagonal(Vec3::new(1.0, 1.0, -1.0));
        let cube_from_world = front * Mat3::from_quat(self.rotation.inverse());
        let (width, height, pixels) = GL_ROW.unwrap((6 * self.side, self.side), &row, MAX_WIDTH, cube_from_world);
        let peak = peak(&pixels);
        let warning = (peak == 0.0).then(|| "the environment is black everywhere: it gives no light".to_owned());
        let warnings = warning.into_iter().collect();
        Environment { name: String::new(), width, height, pixels, peak, warnings }
    }
}

/// The radiance of a texel at an intensity of 1.
fn radiance([r, g, b, d]: [u8; 4]) -> [f32; 4] {
    // An alpha of 0 is no divisor; encoders write at least 1.
    let factor = 255.0 / f32::from(d.max(1));
    let [r, g, b] = [r, g, b].map(|code| linear_from_srgb(f32::from(code) / 255.0) * factor);
    [r, g, b, 1.0]
}

/// Equal environments have the same pixels. Their intensity may differ.
impl PartialEq for ModelEnvironment {
    fn eq(&self, other: &Self) -> bool {
        self.fingerprint == other.fingerprint
    }
}

impl Eq for ModelEnvironment {}
