//! Conversion of colors to the primaries of Rec. 709.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Red, green, blue and white as CIE xy.
pub type Primaries = [(f32, f32); 4];

/// Those of Rec. 709, which an image has by default.
pub const REC_709: Primaries = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290)];

/// Whether two sets are the same but for rounding.
pub fn are_equal(a: &Primaries, b: &Primaries) -> bool {
    a.iter().zip(b).all(|(a, b)| (a.0 - b.0).abs().max((a.1 - b.1).abs()) <= 0.005)
}

/// XYZ of red, green and blue, in which white has a luminance of 1. `None` if they do not span colors.
pub fn xyz_from_rgb(primaries: &Primaries) -> Option<DMat3> {
    let xyz = |(x, y): (f32, f32)| DVec3::new(x.into(), y.into(), 1.0 - f64::from(x) - f64::from(y));
    let [red, green, blue, white] = primaries.map(xyz);
    let colors = DMat3::from_cols(red, green, blue);
    let scale = colors.inverse() * (white / white.y);
    let matrix = colors * DMat3::from_diagonal(scale);
    (matrix.is_finite() && matrix.determinant().abs() > 1e-6).then_some(matrix)
}

/// Converts pixels to Rec. 709. The color of a light stays as it is, so white points are not adapted to each other. `None` if the
/// primaries do not span colors.
pub fn convert(pixels: &mut [[f32; 4]], primaries: &Primaries) -> Option<()> {
    let matrix = (xyz_from_rgb(&REC_709)?.inverse() * xyz_from_rgb(primaries)?).as_mat3();
    pixels.par_iter_mut().for_each(|[r, g, b, _]| [*r, *g, *b] = (matrix * glam::Vec3::new(*r, *g, *b)).to_array());
    Some(())
}
