//! `iridescent_fresnel` of KHR_materials_iridescence: Belcour & Barla 2017 without polarization.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

/// A thin film in air, or under a clear coat.
#[derive(Clone, Debug)]
pub struct Film {
    /// 0..1.
    pub strength: f64,
    pub ior: f64,
    /// Nanometers.
    pub thickness: f64,
    /// Index of the medium above: that of air, 1, or of the coat, 1.5 (KHR_materials_iridescence, "Clearcoat").
    pub outside: f64,
}

/// Reflectance of a smooth boundary at normal incidence, from the indices on both sides.
fn r0(a: f64, b: f64) -> f64 {
    ((a - b) / (a + b)).powi(2)
}

fn schlick(r0: f64, cosine: f64) -> f64 {
    r0 + (1.0 - r0) * (1.0 - cosine).powi(5)
}

/// The response of X, Y and Z to waves with a path difference of `path` meters and a phase shift: Gaussians over the
/// wavenumber, with a second one for X in the blue.
fn sensed(path: f64, phase: f64) -> DVec3 {
    let gaussian = |height: f64, center: f64, variance: f64| {
        let distance = TAU * path;
        height * (TAU * variance).sqrt() * (center * distance + phase).cos() * (-variance * distance * distance).exp()
    };
    let x = gaussian(5.4856e-13, 1.6810e6, 4.3278e9) + gaussian(9.7470e-14, 2.2399e6, 4.5282e9);
    let y = gaussian(4.4201e-13, 1.7953e6, 9.3046e9);
    let z = gaussian(5.2481e-13, 2.2084e6, 6.6121e9);
    DVec3::new(x, y, z) / 1.0685e-7
}

/// Linear Rec. 709 from XYZ, rows.
const RGB_FROM_XYZ: [[f64; 3]; 3] =
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]];

impl Film {
    /// Reflectance at the angle with this cosine, for a base with the reflectance `f0` in air. The specification adds
    /// 1e-4 to avoid a reflectance of 1; this does not. Clamps to 0 from below (the specification) and to 1 from above
    /// (the renderer).
    pub fn fresnel(&self, f0: DVec3, cosine: f64) -> DVec3 {
        // Snell's law, from air into the film, and into what is above it.
        let cosine2 = 1.0 - (1.0 - cosine * cosine) / (self.ior * self.ior);
        let cosine1 = (1.0 - (1.0 - cosine * cosine) / (self.outside * self.outside)).sqrt();
        if cosine2 < 0.0 {
            return DVec3::ONE;
        }
        let cosine2 = cosine2.sqrt();
        let path = 2.0 * self.ior * self.thickness * 1e-9 * cosine2;
        // The outer face: from above into the film, and back out.
        let r12 = schlick(r0(self.ior, self.outside), cosine1);
        let t121 = 1.0 - r12;
        let phase21 = if self.ior < self.outside { 0.0 } else { PI };
        let rgb_from_xyz = DMat3::from_cols_array_2d(&RGB_FROM_XYZ).transpose();
        let channel = |c: usize| {
            let base_ior = (1.0 + f0[c].sqrt()) / (1.0 - f0[c].sqrt());
            let r23 = schlick(r0(base_ior, self.ior), cosine2);
            let phase = phase21 + if base_ior < self.ior { PI } else { 0.0 };
            let r123 = (r12 * r23).clamp(1e-5, 0.9999);
            let rs = t121 * t121 * r23 / (1.0 - r123);
            let orders = (1..=2).map(|m| {
                let order = f64::from(m);
                2.0 * (rs - t121) * r123.powf(order / 2.0) * (rgb_from_xyz * sensed(order * path, order * phase))[c]
            });
            (r12 + rs + orders.sum::<f64>()).clamp(0.0, 1.0)
        };
        DVec3::new(channel(0), channel(1), channel(2))
    }
}
