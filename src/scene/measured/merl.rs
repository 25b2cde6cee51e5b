//! The format of the MERL database (Matusik et al. 2003), little endian: three `i32` (90, 90, 180), then doubles: the
//! planes red, green and blue. In a plane phi_d varies fastest, then theta_d, then theta_h.
//!
//! The axes are the half and difference angles of Rusinkiewicz 1998: h is the half vector, at (theta_h, phi_h). After
//! the rotation that takes h to the normal, l is at (theta_d, phi_d). An isotropic BRDF does not depend on phi_h.
//! Swapping l and v adds pi to phi_d, so by reciprocity phi_d from 0 to pi is enough.
//!
//! Bins of theta_d and phi_d are 1 degree wide. theta_h = 90 degrees (i / 90)^2, which is finest at the highlight. The
//! database's own reader truncates, so bin i covers i to i + 1 and its value belongs to the center, i + 0.5. Specula
//! interpolates linearly between the centers; in i for theta_h.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use super::decoded::{Decoded, interleave, triple, warn_of_negative};
use super::error::MeasuredProblem;
use super::kind::{MERL_CELLS as CELLS, MERL_DIMENSIONS as DIMENSIONS, MERL_HEADER_BYTES as HEADER_BYTES};

pub(super) const THETA_H: usize = DIMENSIONS[0] as usize;
pub(super) const THETA_D: usize = DIMENSIONS[1] as usize;
pub(super) const PHI_D: usize = DIMENSIONS[2] as usize;

/// Converts stored values to 1/sr: one factor per channel (from the database's reader).
pub(super) const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// The header's three numbers; `None` if it is too short.
pub(super) fn dimensions(header: &[u8]) -> Option<[i32; 3]> {
    let (numbers, _) = header.as_chunks::<4>();
    let [a, b, c] = numbers.get(..3)? else { return None };
    Some([a, b, c].map(|bytes| i32::from_le_bytes(*bytes)))
}

/// `bytes` is a whole file.
pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, MeasuredProblem> {
    let mut values = interleave(&bytes[HEADER_BYTES..], SCALE)?;
    let negative = fill(&mut values);
    Ok(Decoded { values, warnings: warn_of_negative(negative, 3 * CELLS).into_iter().collect() })
}

pub(super) fn cell(theta_h: usize, theta_d: usize, phi_d: usize) -> usize {
    (theta_h * THETA_D + theta_d) * PHI_D + phi_d
}

/// Makes every value fit for interpolation and returns how many failed measurements there were. A bin whose center is
/// below the horizon holds -1, but is interpolated with the last bins above it. It gets the value of the previous
/// theta_d, so that interpolation adds no dark rim. The bin theta_d = 0 has l = v = h, which is never below. All other
/// negative values are failed measurements and become 0.
fn fill(values: &mut [f32]) -> usize {
    let mut negative = 0;
    for theta_h in 0..THETA_H {
        for theta_d in 0..THETA_D {
            for phi_d in 0..PHI_D {
                let at = cell(theta_h, theta_d, phi_d);
                if triple(values, at).min_element() > 0.0 {
                    continue;
                }
                let (l, v) = directions(theta_h, theta_d, phi_d);
                let below = theta_d > 0 && l.z.min(v.z) <= 0.0;
                for channel in 0..3 {
                    let value = values[at * 3 + channel];
                    if below && value <= 0.0 {
                        values[at * 3 + channel] = values[cell(theta_h, theta_d - 1, phi_d) * 3 + channel];
                    } else if value < 0.0 {
                        values[at * 3 + channel] = 0.0;
                        negative += 1;
                    }
                }
            }
        }
    }
    negative
}

/// l and v at the center of a bin, with phi_h = 0.
pub(super) fn directions(theta_h: usize, theta_d: usize, phi_d: usize) -> (Vec3, Vec3) {
    let middle = |i: usize, count: usize| (i as f32 + 0.5) / count as f32;
    let (sin_h, cos_h) = (FRAC_PI_2 * middle(theta_h, THETA_H).powi(2)).sin_cos();
    let (sin_d, cos_d) = (FRAC_PI_2 * middle(theta_d, THETA_D)).sin_cos();
    let (sin_phi, cos_phi) = (PI * middle(phi_d, PHI_D)).sin_cos();
    let h = Vec3::new(sin_h, 0.0, cos_h);
    let aside = sin_d * Vec3::new(cos_phi * cos_h, sin_phi, -cos_phi * sin_h);
    (cos_d * h + aside, cos_d * h - aside)
}
