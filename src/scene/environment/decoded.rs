//! An image as the readers of the formats hand it on, and the limits of its size.

use super::error::EnvironmentProblem as Problem;
use super::projection::Projection;

/// Largest supported width, pixels.
pub const MAX_WIDTH: u32 = 16384;
/// Largest supported height, pixels.
pub const MAX_HEIGHT: u32 = 8192;

/// A decoded image, rows from top to bottom. Its values are not validated yet.
pub struct Decoded {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// RGB and an alpha of 1.
    pub pixels: Vec<[f32; 4]>,
    /// The projection, if the file names it. Otherwise the shape of the image decides.
    pub projection: Option<Projection>,
    /// Conversions that the file's author may not expect.
    pub warnings: Vec<String>,
}

/// Refuses a size outside the limits, or one that `available` bytes cannot hold, before anything is allocated.
/// `least_bytes` is the smallest possible size of such an image in this format.
pub fn check_size(width: u64, height: u64, least_bytes: u64, available: usize) -> Result<(u32, u32), Problem> {
    let in_bounds = |size: u64, most: u32| u32::try_from(size).ok().filter(|size| (1..=most).contains(size));
    let (Some(columns), Some(rows)) = (in_bounds(width, MAX_WIDTH), in_bounds(height, MAX_HEIGHT)) else {
        return Err(Problem::Size { width, height });
    };
    let found = available as u64;
    if found < least_bytes {
        return Err(Problem::TooShort { width: columns, height: rows, expected: least_bytes, found });
    }
    Ok((columns, rows))
}
