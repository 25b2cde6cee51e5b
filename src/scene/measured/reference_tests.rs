//! Files of both formats, and the lookup of `shaders/brdf/measured.glsl` on the CPU, for tests.

use glam::Vec3;

use super::decoded::triple;
use super::{MeasuredBrdf, MeasuredKind};

impl MeasuredKind {
    /// Encodes `f(l, v)`, in 1/sr for directions above the horizon, as a file of this format. Other programs can read
    /// it, and the tests read it back.
    pub fn encode(self, f: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<u8> {
        match self {
            Self::Merl => merl::encode(f),
            Self::Utia => utia::encode(f),
        }
    }
}

impl MeasuredBrdf {
    /// f(l, v) in 1/sr, linearly interpolated; black if either direction is below the horizon.
    pub fn evaluate(&self, l: Vec3, v: Vec3) -> Vec3 {
        if !(l.z > 0.0 && v.z > 0.0) {
            return Vec3::ZERO;
        }
        match self.kind {
            MeasuredKind::Merl => merl::evaluate(&self.values, l, v),
            MeasuredKind::Utia => utia::evaluate(&self.values, l, v),
        }
    }
}

/// Two neighboring samples of one axis and the interpolation factor between them.
#[derive(Clone, Copy)]
struct Between {
    pub low: usize,
    pub high: usize,
    pub t: f32,
}

impl Between {
    /// `x`: position in samples, clamped to the first and last sample.
    pub fn clamped(x: f32, count: usize) -> Self {
        let x = x.clamp(0.0, (count - 1) as f32);
        let low = (x as usize).min(count - 2);
        Self { low, high: low + 1, t: x - low as f32 }
    }

    /// `x`: position in samples, -1 <= x <= count, on a periodic axis.
    pub fn around(x: f32, count: usize) -> Self {
        let low = x.floor();
        let index = (low + count as f32) as usize % count;
        Self { low: index, high: (index + 1) % count, t: x - low }
    }

    /// Interpolates linearly between `f(low)` and `f(high)`.
    pub fn mix(self, f: impl Fn(usize) -> Vec3) -> Vec3 {
        f(self.low).lerp(f(self.high), self.t)
    }
}

mod merl {
    use std::f32::consts::{FRAC_PI_2, PI};

    use glam::Vec3;

    use super::super::kind::{MERL_CELLS as CELLS, MERL_DIMENSIONS as DIMENSIONS, MERL_HEADER_BYTES as HEADER_BYTES};
    use super::super::merl::{PHI_D, SCALE, THETA_D, THETA_H, cell, directions};
    use super::{Between, MeasuredKind, triple};

    /// The database's value for directions below the horizon.
    const BELOW_HORIZON: f64 = -1.0;

    /// Looks up l and v, both above the horizon.
    ///
    /// With l + v = 2 cos(theta_d) h and l - v = 2 sin(theta_d) (across h, towards phi_d), all angles come from
    /// arctangents. They are exact at the highlight's peak, where the arccosine of a dot product is not.
    pub(super) fn evaluate(values: &[f32], l: Vec3, v: Vec3) -> Vec3 {
        let (sum, difference) = (l + v, l - v);
        let aside = sum.truncate().length();
        let theta_h = aside.atan2(sum.z);
        let theta_d = difference.length().atan2(sum.length());

        // Components along the meridian through h and across it. At the pole any meridian will do: this takes x.
        let (cos_phi, sin_phi) = if aside > 0.0 { (sum.x / aside, sum.y / aside) } else { (1.0, 0.0) };
        let (sin_h, cos_h) = theta_h.sin_cos();
        let along = difference.dot(Vec3::new(cos_h * cos_phi, cos_h * sin_phi, -sin_h));
        let across = difference.dot(Vec3::new(-sin_phi, cos_phi, 0.0));
        let phi_d = across.atan2(along);
        let phi_d = if phi_d < 0.0 { phi_d + PI } else { phi_d };

        let h = Between::clamped(THETA_H as f32 * (theta_h / FRAC_PI_2).sqrt() - 0.5, THETA_H);
        let d = Between::clamped(THETA_D as f32 * (theta_d / FRAC_PI_2) - 0.5, THETA_D);
        let phi = Between::around(PHI_D as f32 * (phi_d / PI) - 0.5, PHI_D);
        h.mix(|h| d.mix(|d| phi.mix(|phi| triple(values, cell(h, d, phi)))))
    }

    /// Encodes `f` as a file.
    pub(super) fn encode(f: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<u8> {
        let mut bytes: Vec<u8> = DIMENSIONS.iter().flat_map(|n| n.to_le_bytes()).collect();
        bytes.resize(MeasuredKind::Merl.file_bytes(), 0);
        for index in 0..CELLS {
            let (l, v) = directions(index / (THETA_D * PHI_D), index / PHI_D % THETA_D, index % PHI_D);
            let above = l.z > 0.0 && v.z > 0.0;
            let value = if above { f(l, v).as_dvec3().to_array() } else { [0.0; 3] };
            for (channel, (value, scale)) in value.iter().zip(SCALE).enumerate() {
                let stored = if above { value / scale } else { BELOW_HORIZON };
                let at = HEADER_BYTES + (channel * CELLS + index) * size_of::<f64>();
                bytes[at..at + size_of::<f64>()].copy_from_slice(&stored.to_le_bytes());
            }
        }
        bytes
    }
}

mod utia {
    use std::f32::consts::TAU;

    use glam::Vec3;

    use super::super::kind::UTIA_DIRECTIONS as DIRECTIONS;
    use super::super::utia::{PHI, THETA, THETA_STEP};
    use super::{Between, MeasuredKind, triple};

    const PHI_STEP: f32 = TAU / PHI as f32;

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
}
