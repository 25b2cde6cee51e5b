//! Boxes around parts of a model.

use glam::Vec3;

/// Axis-aligned bounds in world space, meters. Empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner.
    pub min: Vec3,
    /// Largest corner.
    pub max: Vec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY }
    }
}

impl Bounds {
    /// Grows to contain `point`.
    pub fn include(&mut self, point: Vec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Whether the bounds contain no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        let pick = |bit: usize, min: f32, max: f32| if bit == 0 { min } else { max };
        std::array::from_fn(|i| {
            Vec3::new(
                pick(i & 1, self.min.x, self.max.x),
                pick(i & 2, self.min.y, self.max.y),
                pick(i & 4, self.min.z, self.max.z),
            )
        })
    }

    /// Center of the box, or the origin if empty.
    pub fn center(&self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { (self.min + self.max) * 0.5 }
    }

    /// Radius of the sphere around the box, or 1 if the box is empty or a single point.
    pub fn radius(&self) -> f32 {
        let radius = if self.is_empty() { 0.0 } else { (self.max - self.min).length() * 0.5 };
        if radius > 0.0 && radius.is_finite() { radius } else { 1.0 }
    }
}
