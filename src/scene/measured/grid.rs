//! Places between the samples of a table, as in `shaders/brdf/measured.glsl`.

use glam::Vec3;

/// Two neighboring samples of one axis, and how far on the way from the one to the other.
#[derive(Clone, Copy)]
pub(super) struct Between {
    pub low: usize,
    pub high: usize,
    pub t: f32,
}

impl Between {
    /// `x` in samples on an axis that ends: before the first and after the last sample, those hold.
    pub fn clamped(x: f32, count: usize) -> Self {
        let x = x.clamp(0.0, (count - 1) as f32);
        let low = (x as usize).min(count - 2);
        Self { low, high: low + 1, t: x - low as f32 }
    }

    /// `x` in samples, -1 <= x <= count, on an axis that comes round.
    pub fn around(x: f32, count: usize) -> Self {
        let low = x.floor();
        let index = (low + count as f32) as usize % count;
        Self { low: index, high: (index + 1) % count, t: x - low }
    }

    /// Linear between the values of `f` at both samples.
    pub fn mix(self, f: impl Fn(usize) -> Vec3) -> Vec3 {
        f(self.low).lerp(f(self.high), self.t)
    }
}

/// The triple at `cell`.
pub(super) fn triple(values: &[f32], cell: usize) -> Vec3 {
    Vec3::from_slice(&values[cell * 3..])
}
