//! Values as both formats store them: planes of doubles.

use glam::Vec3;

use super::error::MeasuredProblem;

/// Negative values are failed measurements. If more than this fraction of all values is negative, the user is warned.
const UNUSUAL: f64 = 0.05;

/// A file's values as RGB triples, and warnings about them.
pub(super) struct Decoded {
    pub values: Vec<f32>,
    pub warnings: Vec<String>,
}

/// Converts three planes of doubles (red, green, blue) to RGB triples of `f32`, multiplied by `scale`.
pub(super) fn interleave(planes: &[u8], scale: [f64; 3]) -> Result<Vec<f32>, MeasuredProblem> {
    let (doubles, _) = planes.as_chunks::<8>();
    let cells = doubles.len() / 3;
    let mut values = vec![0.0; cells * 3];
    for (index, bytes) in doubles.iter().enumerate() {
        let (channel, cell) = (index / cells, index % cells);
        let found = f64::from_le_bytes(*bytes);
        let value = (found * scale[channel]) as f32;
        if !value.is_finite() {
            return Err(MeasuredProblem::NotANumber { channel: ["red", "green", "blue"][channel], index: cell, found });
        }
        values[cell * 3 + channel] = value;
    }
    if values.iter().any(|&value| value > 0.0) { Ok(values) } else { Err(MeasuredProblem::Black) }
}

/// A warning if unusually many values (`negative` of `all`) were negative and set to 0.
pub(super) fn warn_of_negative(negative: usize, all: usize) -> Option<String> {
    let part = negative as f64 / all as f64;
    (part > UNUSUAL).then(|| {
        format!(
            "{negative} of {all} values ({:.0} %) are negative where both directions are above the horizon, and are \
             treated as 0. A few are normal. This many mean that most of the measurement failed, or that the file is \
             not what it seems.",
            100.0 * part
        )
    })
}

/// The RGB triple at `cell`.
pub(super) fn triple(values: &[f32], cell: usize) -> Vec3 {
    Vec3::from_slice(&values[cell * 3..])
}
