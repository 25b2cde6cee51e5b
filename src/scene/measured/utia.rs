//! The format of the UTIA database (Filip & Vávra 2014): doubles without a header, little endian: the planes red, green
//! and blue. A plane has 288 rows, one per direction of the light, of 288 columns, one per direction of the view. The
//! direction (theta, phi), in degrees, has the number 48 theta / 15 + phi / 7.5, with theta from 0 to 75. phi runs from
//! the tangent towards the bitangent.
//!
//! Specula interpolates linearly in all four angles. Beyond 75 degrees, where nothing was measured, it uses the value
//! at 75. (The database's own reader extrapolates the line through 60 and 75, which produces negative values and
//! doubles highlights.)
//!
//! Specula takes the values as linear and in 1/sr, as the database's own reader does. Some programs read them as sRGB
//! encoded, and the files do not say which is right; hence the warning if they reflect more light than they receive.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use super::decoded::{Decoded, interleave, triple, warn_of_negative};
use super::error::MeasuredProblem;
use super::kind::{UTIA_DIRECTIONS as DIRECTIONS, UTIA_STEPS};

pub(super) const THETA: usize = UTIA_STEPS[0];
pub(super) const PHI: usize = UTIA_STEPS[1];
pub(super) const THETA_STEP: f32 = PI / 12.0;

/// Albedos up to this are within the accuracy of such a measurement.
const LARGEST_ALBEDO: f32 = 1.05;

/// `bytes` is a whole file.
pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, MeasuredProblem> {
    let mut values = interleave(bytes, [1.0; 3])?;
    let mut negative = 0;
    for value in values.iter_mut().filter(|value| **value < 0.0) {
        *value = 0.0;
        negative += 1;
    }
    let bright = warn_of_albedo(albedo_seen_from_above(&values).max_element());
    let warnings = warn_of_negative(negative, values.len()).into_iter().chain(bright).collect();
    Ok(Decoded { values, warnings })
}

/// The albedo along the normal: the integral of f cos over the hemisphere, where each sample represents the ring of 15
/// degrees around it, and the last one also the rest down to the horizon. The first ring (7.5 degrees, 1.7 % of the
/// light) is left out, since a highlight narrower than its sample would count far too much.
fn albedo_seen_from_above(values: &[f32]) -> Vec3 {
    let mut albedo = Vec3::ZERO;
    for theta in 1..THETA {
        let inner = THETA_STEP * (theta as f32 - 0.5);
        let outer = if theta == THETA - 1 { FRAC_PI_2 } else { inner + THETA_STEP };
        let weight = PI * (outer.sin().powi(2) - inner.sin().powi(2)) / PHI as f32;
        for phi in 0..PHI {
            albedo += weight * triple(values, (theta * PHI + phi) * DIRECTIONS);
        }
    }
    albedo
}

fn warn_of_albedo(albedo: f32) -> Option<String> {
    (albedo > LARGEST_ALBEDO).then(|| {
        format!(
            "seen along the normal it reflects {albedo:.1} times the light that it receives, expected at most 1: its \
             values may not be linear, or not in 1/sr. Compare its shape, not its brightness."
        )
    })
}
