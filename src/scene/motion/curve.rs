//! Values over time: keys, and how they are interpolated.

use std::ops::Range;
use std::sync::Arc;

use glam::DQuat;

use super::transform::slerp;

/// How values between two keys follow from theirs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Interpolation {
    /// The value of the key before.
    Step,
    /// Along the line between both; rotations along the shorter arc.
    #[default]
    Linear,
    /// A cubic Hermite spline with the tangents of the keys.
    CubicSpline,
}

/// Keys. The values before the first and after the last are theirs.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Seconds, ascending, finite, at least one.
    times: Arc<[f32]>,
    /// Finite: for each key a value; for a spline the tangent towards it, the value, and the tangent from it.
    values: Arc<[f32]>,
    /// How many numbers a value has, at least 1.
    width: usize,
    interpolation: Interpolation,
}

impl Curve {
    /// A curve; `None` if the numbers do not fit each other: see its fields.
    pub fn new(times: Arc<[f32]>, values: Arc<[f32]>, interpolation: Interpolation) -> Option<Self> {
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let keys = times.len().checked_mul(per_key).filter(|keys| *keys > 0)?;
        let width = values.len() / keys;
        let is_sound = width > 0
            && width * keys == values.len()
            && times.iter().chain(values.iter()).all(|number| number.is_finite())
            && times.is_sorted();
        is_sound.then_some(Self { times, values, width, interpolation })
    }

    /// How many numbers a value has.
    pub fn width(&self) -> usize {
        self.width
    }

    /// How values between two keys follow from theirs.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// Whether a key has another number than 0.
    pub fn is_ever_nonzero(&self) -> bool {
        self.values.iter().any(|number| *number != 0.0)
    }

    /// The times of the keys, seconds, ascending.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// Number of keys.
    pub fn keys(&self) -> usize {
        self.times.len()
    }

    /// Time of the last key, seconds.
    pub fn end_s(&self) -> f32 {
        self.times.last().copied().unwrap_or_default()
    }

    /// The value at a time, with all its numbers mixed alike.
    pub fn numbers(&self, time_s: f64) -> Vec<f64> {
        let (left, right, at, length_s) = self.segment(time_s);
        match self.interpolation {
            _ if left == right => self.value(left).collect(),
            Interpolation::Step => self.value(left).collect(),
            Interpolation::Linear => self.value(left).zip(self.value(right)).map(|(a, b)| a + (b - a) * at).collect(),
            Interpolation::CubicSpline => self.spline(left, right, at, length_s),
        }
    }

    /// The value at a time as a rotation; `None` if values do not have four numbers.
    pub fn rotation(&self, time_s: f64) -> Option<DQuat> {
        let unit = |numbers: Vec<f64>| {
            let [x, y, z, w] = numbers.try_into().ok()?;
            let rotation = DQuat::from_xyzw(x, y, z, w);
            Some(if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY })
        };
        let (left, right, at, _) = self.segment(time_s);
        if self.interpolation != Interpolation::Linear || left == right {
            return unit(self.numbers(time_s));
        }
        Some(slerp(unit(self.value(left).collect())?, unit(self.value(right).collect())?, at))
    }

    /// The keys around a time, the part 0..1 of the way from one to the other, and their distance in seconds.
    fn segment(&self, time_s: f64) -> (usize, usize, f64, f64) {
        let after = self.times.partition_point(|key| f64::from(*key) <= time_s);
        if after == 0 {
            return (0, 0, 0.0, 0.0);
        }
        let (left, right) = (after - 1, after.min(self.times.len() - 1));
        let (from, to) = (f64::from(self.times[left]), f64::from(self.times[right]));
        let at = if to > from { (time_s - from) / (to - from) } else { 0.0 };
        (left, right, at, to - from)
    }

    /// The value of a key.
    fn value(&self, key: usize) -> impl Iterator<Item = f64> {
        let (part, parts) = if self.interpolation == Interpolation::CubicSpline { (1, 3) } else { (0, 1) };
        self.part(key * parts + part)
    }

    fn part(&self, index: usize) -> impl Iterator<Item = f64> {
        let range: Range<usize> = index * self.width..(index + 1) * self.width;
        self.values[range].iter().map(|number| f64::from(*number))
    }

    /// glTF 2.0, appendix C.5.
    fn spline(&self, left: usize, right: usize, t: f64, length_s: f64) -> Vec<f64> {
        let (t2, t3) = (t * t, t * t * t);
        let leaving = self.part(left * 3 + 2);
        let entering = self.part(right * 3);
        let values = self.value(left).zip(self.value(right));
        let mix = |((a, b), (leave, enter)): ((f64, f64), (f64, f64))| {
            (2.0 * t3 - 3.0 * t2 + 1.0) * a
                + length_s * (t3 - 2.0 * t2 + t) * leave
                + (-2.0 * t3 + 3.0 * t2) * b
                + length_s * (t3 - t2) * enter
        };
        values.zip(leaving.zip(entering)).map(mix).collect()
    }
}
