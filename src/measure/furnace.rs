//! The white furnace: how much of the light that falls on a surface it reflects, by roughness and angle.

use serde_json::{Value, json};

use super::{BrdfMeter, Claim, Grid, Surface, unclaimed};
use crate::gpu::GpuError;
use crate::settings::{Settings, ShaderValue};
use crate::shader::{Constant, ShaderSet};

/// A coarse grid, just fine enough to detect whether a choice changes the albedo.
const COARSE: Grid = Grid { rows: 4, roughness: (0.1, 1.0), columns: 4, theta: (0.0, 84.0), samples: 64 };

/// The directional albedo of a surface.
#[derive(Clone, Debug)]
pub struct Furnace<'a> {
    /// Linear RGB of each cell of [`Furnace::GRID`], row by row.
    pub albedo: Vec<[f64; 3]>,
    /// Smallest value; NaN when any value is NaN.
    pub min: f64,
    /// Largest value; NaN when any value is NaN.
    pub max: f64,
    /// The choices that do not claim to conserve energy and change the albedo of this surface. If there are none, the combination claims it.
    pub without: Vec<(&'a Constant, String)>,
}

impl<'a> Furnace<'a> {
    /// Largest albedo that counts as energy-conserving: the estimate has an error of up to 0.005.
    pub const MOST: f64 = 1.005;
    /// The roughness of the rows and the angles of the columns.
    pub const GRID: Grid = Grid { rows: 20, roughness: (0.05, 1.0), columns: 18, theta: (0.0, 85.0), samples: 2048 };

    /// Measures a surface. `meter` was made for `shaders` with `settings`.
    ///
    /// # Errors
    /// A device error.
    pub fn measure(
        meter: &BrdfMeter,
        (shaders, settings): (&'a ShaderSet, &Settings),
        surface: Surface,
    ) -> Result<Self, GpuError> {
        let albedo: Vec<[f64; 3]> =
            meter.furnace(surface, Self::GRID)?.into_iter().map(|albedo| albedo.map(f64::from)).collect();
        let mut without = Vec::new();
        for (constant, chosen) in unclaimed(Claim::Conserves, settings, shaders) {
            if has_part(meter, settings, constant, surface)? {
                without.push((constant, chosen));
            }
        }
        let (min, max) = extremes(&albedo);
        Ok(Self { albedo, min, max, without })
    }

    /// Whether no albedo is above [`Furnace::MOST`].
    pub fn conserves(&self) -> bool {
        self.max <= Self::MOST
    }

    /// All of it as JSON, as `specula brdf furnace --json` prints it.
    pub fn json(&self) -> Value {
        let grid = Self::GRID;
        let cells = (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (row, column)));
        let row = |((row, column), albedo): ((u32, u32), &[f64; 3])| {
            json!({ "roughness": grid.roughness_of(row), "cos_theta": grid.theta_of(column).to_radians().cos(),
                "albedo": albedo })
        };
        let rows: Vec<Value> = cells.zip(&self.albedo).map(row).collect();
        json!({ "rows": rows, "min": self.min, "max": self.max, "claims_conservation": self.without.is_empty() })
    }
}

/// Whether an unclaimed choice changes the albedo of this surface. The diffuse model, for example, does not change that of
/// a metal.
fn has_part(meter: &BrdfMeter, settings: &Settings, constant: &Constant, surface: Surface) -> Result<bool, GpuError> {
    let Some(other) = Claim::Conserves.of(constant).and_then(|names| names.first()) else { return Ok(true) };
    let mut settings = settings.clone();
    settings.shader.insert(constant.name.clone(), ShaderValue::Name(other.clone()));
    let chosen = meter.furnace(surface, COARSE)?;
    let claiming = meter.with(&settings)?.furnace(surface, COARSE)?;
    // Drivers may reorder sums when other code changes. 1e-4 is far above the rounding errors of that.
    let differs = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-4 || a.is_nan() != b.is_nan();
    Ok(chosen.as_flattened().iter().zip(claiming.as_flattened()).any(differs))
}

/// Smallest and largest value; NaN when any value is NaN.
pub fn extremes(albedo: &[[f64; 3]]) -> (f64, f64) {
    let values = || albedo.as_flattened().iter().copied();
    let with = |pick: fn(f64, f64) -> f64| {
        values().reduce(|a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { pick(a, b) }).unwrap_or(f64::NAN)
    };
    (with(f64::min), with(f64::max))
}
