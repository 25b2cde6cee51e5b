//! Linear interpolation between samples of a table, as in `shaders/brdf/measured.glsl`.

use glam::Vec3;

/// Two neighboring samples of one axis and the interpolation factor between them.
#[derive(Clone, Copy)]
pub(super) struct Between {
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

/// The RGB triple at `cell`.
pub(super) fn triple(values: &[f32], cell: usize) -> Vec3 {
    Vec3::from_slice(&values[cell * 3..])
}
