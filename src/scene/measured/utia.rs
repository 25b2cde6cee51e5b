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

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec3;

use super::decoded::{Decoded, interleave, warn_of_negative};
use super::error::MeasuredProblem;
use super::grid::{Between, triple};
use super::kind::{MeasuredKind, UTIA_DIRECTIONS as DIRECTIONS, UTIA_STEPS};

const THETA: usize = UTIA_STEPS[0];
const PHI: usize = UTIA_STEPS[1];
const THETA_STEP: f32 = PI / 12.0;
const PHI_STEP: f32 = TAU / PHI as f32;

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

/// The samples between which `direction`, above the horizon, lies.
fn between(direction: Vec3) -> (Between, Between) {
    let theta = direction.truncate().length().atan2(direction.z);
    let phi = direction.y.atan2(direction.x);
    let phi = if phi < 0.0 { phi + TAU } else { phi };
    (Between::clamped(theta / THETA_STEP, THETA), Between::around(phi / PHI_STEP, PHI))
}

/// Looks up l and v, both above the horizon.
pub(super) fn evaluate(values: &[f32], l: Vec3, v: Vec3) -> Vec3 {
    let (theta_l, phi_l) = between(l);
    let (theta_v, phi_v) = between(v);
    let seen = |l: usize| theta_v.mix(|theta| phi_v.mix(|phi| triple(values, l * DIRECTIONS + theta * PHI + phi)));
    theta_l.mix(|theta| phi_l.mix(|phi| seen(theta * PHI + phi)))
}

/// Encodes `f` as a file.
pub(super) fn encode(f: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<u8> {
    let direction = |index: usize| {
        let (sin_theta, cos_theta) = (THETA_STEP * (index / PHI) as f32).sin_cos();
        let (sin_phi, cos_phi) = (PHI_STEP * (index % PHI) as f32).sin_cos();
        Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
    };
    let cells = DIRECTIONS * DIRECTIONS;
    let mut bytes = vec![0; MeasuredKind::Utia.file_bytes()];
    for cell in 0..cells {
        let value = f(direction(cell / DIRECTIONS), direction(cell % DIRECTIONS)).as_dvec3().to_array();
        for (channel, stored) in value.iter().enumerate() {
            let at = (channel * cells + cell) * size_of::<f64>();
            bytes[at..at + size_of::<f64>()].copy_from_slice(&stored.to_le_bytes());
        }
    }
    bytes
}
