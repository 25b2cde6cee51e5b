//! Goals that the user's BRDF is measured for, without a picture.

use super::goal::Check;
use crate::gpu::GpuError;
use crate::measure::{BrdfMeter, Grid, Surface};

/// Coarse enough for a software device, fine enough to find the worst place.
const ROWS: u32 = 10;
const ANGLES: Grid = Grid { rows: ROWS, roughness: (0.1, 1.0), columns: 9, theta: (0.0, 80.0), samples: 1024 };

/// Whether a goal is reached, and what was measured.
pub(super) type Verdict = (bool, String);

/// Measures the BRDF. `None` for a goal of another kind. `solved` is called for the solution's BRDF if that is needed.
pub(super) fn verdict(
    check: &Check,
    meter: &BrdfMeter,
    solved: impl FnOnce(Surface, Grid) -> Result<Vec<[f32; 3]>, GpuError>,
) -> Option<Result<Verdict, GpuError>> {
    Some(match check {
        Check::Furnace { metallic, base_color, roughness, within } => {
            let surface = Surface { base_color: *base_color, metallic: *metallic };
            let grid = Grid { roughness: *roughness, ..ANGLES };
            let is_white = *base_color == [1.0; 3];
            furnace(meter, surface, grid, *within, (!is_white).then_some(solved))
        }
        Check::Normalization { within } => normalization(meter, *within),
        Check::Reciprocity { within } => reciprocity(meter, *within),
        _ => return None,
    })
}

fn furnace(
    meter: &BrdfMeter,
    surface: Surface,
    grid: Grid,
    within: f64,
    solved: Option<impl FnOnce(Surface, Grid) -> Result<Vec<[f32; 3]>, GpuError>>,
) -> Result<Verdict, GpuError> {
    let found = meter.furnace(surface, grid)?;
    let expected = match solved {
        Some(solved) => solved(surface, grid)?,
        None => vec![[1.0; 3]; found.len()],
    };
    let channels = found.as_flattened().iter().zip(expected.as_flattened()).enumerate();
    let all = channels.map(|(index, (found, expected))| (index / 3, f64::from(*found), f64::from(*expected)));
    let Some((cell, found, expected)) = worst(all) else { return Ok((false, "nothing was measured".into())) };
    let (row, column) = (cell as u32 / grid.columns, cell as u32 % grid.columns);
    let what = match (surface.metallic > 0.5, surface.base_color == [1.0; 3]) {
        (true, true) => "white metal",
        (true, false) => "a colored metal",
        (false, true) => "a white surface that is no metal",
        (false, false) => "a colored surface that is no metal",
    };
    let place = format!("at roughness {:.1} and {:.0}°", grid.roughness_of(row), grid.theta_of(column));
    let is_good = (found - expected).abs() <= within;
    let says = format!("{what} {place} reflects {} of the light", number(found));
    Ok((is_good, with_expected(says, is_good, expected)))
}

fn normalization(meter: &BrdfMeter, within: f64) -> Result<Verdict, GpuError> {
    let grid = Grid { rows: ROWS, roughness: (0.1, 1.0), columns: 1, theta: (0.0, 0.0), samples: 4096 };
    let all = meter.normalization(grid)?;
    let all = all.into_iter().enumerate().map(|(row, found)| (row, f64::from(found), 1.0));
    let Some((row, found, expected)) = worst(all) else { return Ok((false, "nothing was measured".into())) };
    let is_good = (found - expected).abs() <= within;
    let says =
        format!("the integral of D (n·h) is {} at roughness {:.1}", number(found), grid.roughness_of(row as u32));
    Ok((is_good, with_expected(says, is_good, expected)))
}

fn reciprocity(meter: &BrdfMeter, within: f64) -> Result<Verdict, GpuError> {
    let grid = Grid { rows: ROWS, roughness: (0.1, 1.0), columns: 16, theta: (0.0, 0.0), samples: 256 };
    let mut worst = (0.0_f64, 0);
    for metallic in [0.0, 1.0] {
        let surface = Surface { base_color: [0.8, 0.5, 0.2], metallic };
        for (index, found) in meter.reciprocity(surface, grid)?.into_iter().enumerate() {
            let error = if found.error.is_nan() { f64::INFINITY } else { f64::from(found.error) };
            if error > worst.0 {
                worst = (error, index as u32 / grid.columns);
            }
        }
    }
    let (error, row) = worst;
    let is_good = error <= within;
    let roughness = grid.roughness_of(row);
    let says = if is_good {
        format!("f(l, v) and f(v, l) differ by {:.2} % at most", error * 100.0)
    } else if error < 100.0 {
        format!(
            "f(l, v) and f(v, l) differ by {:.0} % at roughness {roughness:.1}; they should be equal",
            error * 100.0
        )
    } else {
        format!("f(l, v) is not a finite number at roughness {roughness:.1}")
    };
    Ok((is_good, says))
}

/// The cell with the largest difference. NaN is the largest.
fn worst(all: impl Iterator<Item = (usize, f64, f64)>) -> Option<(usize, f64, f64)> {
    let off = |(_, found, expected): &(usize, f64, f64)| {
        let difference = (found - expected).abs();
        if difference.is_nan() { f64::INFINITY } else { difference }
    };
    all.max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// A number for messages.
pub(super) fn number(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => "no finite number".to_owned(),
        0.0 => "0".to_owned(),
        large if large >= 100.0 => format!("{value:.0}"),
        large if large >= 0.1 => format!("{value:.2}"),
        small if small >= 0.001 => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// A measured value, with the expected one if it differs.
pub(super) fn with_expected(says: String, is_good: bool, expected: f64) -> String {
    if is_good { says } else { format!("{says}; {} was expected", number(expected)) }
}
