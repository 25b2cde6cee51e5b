//! The view through smooth glass, from KHR_materials_transmission, _volume and _dispersion.

use glam::DVec3;

/// A pane or a solid body of glass. All vectors are unit; `v` points towards the eye.
pub struct Glass {
    pub base_color: DVec3,
    pub ior: f64,
    /// 20 / Abbe number.
    pub dispersion: f64,
    /// Meters; 0 is a pane.
    pub thickness: f64,
    pub attenuation_color: DVec3,
    pub attenuation_distance: f64,
}

impl Glass {
    /// Index of refraction for red, green and blue: `halfSpread = (ior - 1) * 0.025 * dispersion`.
    pub fn iors(&self) -> [f64; 3] {
        let half_spread = (self.ior - 1.0) * 0.025 * self.dispersion;
        [self.ior - half_spread, self.ior, self.ior + half_spread]
    }

    /// The ray inside: Snell's law, n_air sin = n_glass sin, in the plane of v and n. A pane does not deflect it.
    pub fn refracted(&self, n: DVec3, v: DVec3, ior: f64) -> DVec3 {
        if self.thickness == 0.0 {
            return -v;
        }
        let along = (v - n * n.dot(v)) / ior;
        let sin2 = along.length_squared();
        -along - n * (1.0 - sin2).sqrt()
    }

    /// The fraction of light that reaches the eye: 1 - F (Schlick) times the volume's transmittance,
    /// `color^(d / distance)`.
    pub fn passes(&self, n: DVec3, v: DVec3) -> DVec3 {
        let f0 = ((1.0 - self.ior) / (1.0 + self.ior)).powi(2);
        let fresnel = f0 + (1.0 - f0) * (1.0 - n.dot(v)).powi(5);
        let left = self.attenuation_color.powf(self.thickness / self.attenuation_distance);
        self.base_color * (1.0 - fresnel) * left
    }
}
