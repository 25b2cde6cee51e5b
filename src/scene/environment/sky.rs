//! The built-in clear sky with a sun: the analytic model of Preetham, Shirley & Smits 1999, "A Practical Analytic Model
//! for Daylight" (P99 below), over gray ground.
//!
//! The sky's mean luminance is scaled to 0.5 cd/m^2. The sun's illuminance on a surface that faces it is 8 times the sky's
//! on the ground, as on a clear day at this elevation. Its disc of 0.53 degrees therefore has a luminance near 3e5 cd/m^2,
//! beyond the range of half floats.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use glam::{DVec3, Vec3};

use super::Environment;
use super::direction::texel_solid_angle;
use super::panorama::peak;

/// Haze: 2 is very clear air, 6 is hazy (P99, section 3).
const TURBIDITY: f64 = 2.6;
/// Position of the sun: degrees from +Z towards +X, and above the horizon. It is left of the default camera.
const SUN_AZIMUTH: f32 = -25.0;
const SUN_ELEVATION: f32 = 40.0;
/// Angular radius of the disc, radians: 0.53 degrees across.
pub const SUN_RADIUS: f64 = 0.265 * PI / 180.0;
/// Ratio of the sun's illuminance (surface facing it) to the sky's (horizontal surface).
const SUN_OVER_SKY: f64 = 8.0;
/// Mean luminance of the upper hemisphere, cd/m^2.
const MEAN_SKY: f64 = 0.5;
/// Reflectance of the ground, linear RGB.
const GROUND_ALBEDO: DVec3 = DVec3::new(0.13, 0.12, 0.105);
/// Below the horizon, the ground blends into the horizon's haze over about this angle, radians.
const HAZE: f64 = 0.02;
/// Luminance of linear RGB (Rec. 709).
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Direction to the center of the sun.
pub fn sun_direction() -> Vec3 {
    super::super::camera::direction(SUN_AZIMUTH.to_radians(), SUN_ELEVATION.to_radians())
}

/// Generates sun, sky and ground, with `width` columns and half as many rows.
pub fn make(width: u32) -> Environment {
    let sky = Sky::new();
    let scale = MEAN_SKY / sky.mean_luminance();
    let radiance = |direction: DVec3| sky.radiance(direction) * scale;

    let sky_irradiance = hemisphere(|direction| radiance(direction) * direction.y);
    let color = sun_color(sky.sun_zenith_angle);
    let sun_irradiance = color * (SUN_OVER_SKY * sky_irradiance.dot(LUMINANCE) / color.dot(LUMINANCE));
    // A Lambertian ground: L = albedo E / pi.
    let ground = GROUND_ALBEDO * (sky_irradiance + sun_irradiance * sky.sun.y) / PI;

    let mut environment = Environment::render(width, |direction| {
        let direction = direction.as_dvec3();
        if direction.y >= 0.0 {
            return radiance(direction).as_vec3();
        }
        let horizon = radiance(DVec3::new(direction.x, 0.0, direction.z).normalize_or(DVec3::X));
        ground.lerp(horizon, (direction.y / HAZE).exp()).as_vec3()
    });
    add_sun(&mut environment, sky.sun, sun_irradiance);
    environment.peak = peak(&environment.pixels);
    environment
}

/// The clear sky for one position of the sun, in P99's unit (kcd/m^2).
struct Sky {
    sun: DVec3,
    sun_zenith_angle: f64,
    /// For luminance Y and chromaticities x, y: the zenith value over F(0, theta_sun), and the coefficients of F.
    perez: [(f64, [f64; 5]); 3],
}

impl Sky {
    fn new() -> Self {
        let sun = sun_direction().as_dvec3().normalize();
        let (t, theta) = (TURBIDITY, sun.y.acos());
        let linear = |slopes: [f64; 5], offsets: [f64; 5]| std::array::from_fn(|i| slopes[i] * t + offsets[i]);
        // P99, appendix A.2: the coefficients of Y, x and y.
        let luminance = linear([0.1787, -0.3554, -0.0227, 0.1206, -0.0670], [-1.4630, 0.4275, 5.3251, -2.5771, 0.3703]);
        let x = linear([-0.0193, -0.0665, -0.0004, -0.0641, -0.0033], [-0.2592, 0.0008, 0.2125, -0.8989, 0.0452]);
        let y = linear([-0.0167, -0.0950, -0.0079, -0.0441, -0.0109], [-0.2608, 0.0092, 0.2102, -1.6537, 0.0529]);
        // P99, appendix A.2: the zenith values.
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * theta);
        let zenith_luminance = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        let chromaticity = |rows: [[f64; 4]; 3]| {
            let cubic = |[a, b, c, d]: [f64; 4]| ((a * theta + b) * theta + c) * theta + d;
            (cubic(rows[0]) * t + cubic(rows[1])) * t + cubic(rows[2])
        };
        let zenith_x = chromaticity([
            [0.00166, -0.00375, 0.00209, 0.0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ]);
        let zenith_y = chromaticity([
            [0.00275, -0.00610, 0.00317, 0.0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ]);
        let over_sun = |(zenith, coefficients)| (zenith / perez(&coefficients, 1.0, theta, sun.y), coefficients);
        let perez = [(zenith_luminance, luminance), (zenith_x, x), (zenith_y, y)].map(over_sun);
        Self { sun, sun_zenith_angle: theta, perez }
    }

    /// P99, eqs. 3 and 4: value = zenith * F(theta, gamma) / F(0, theta_sun). For `direction.y >= 0`.
    fn radiance(&self, direction: DVec3) -> DVec3 {
        let cos_gamma = direction.dot(self.sun).clamp(-1.0, 1.0);
        // exp(B / cos theta) tends to 0 at the horizon; the bound keeps the quotient finite.
        let cos_theta = direction.y.max(1e-3);
        let gamma = cos_gamma.acos();
        let value = |(scale, coefficients): &(f64, [f64; 5])| scale * perez(coefficients, cos_theta, gamma, cos_gamma);
        let [luminance, x, y] = self.perez.each_ref().map(value);
        rgb_from_xyy(x, y, luminance)
    }

    fn mean_luminance(&self) -> f64 {
        hemisphere(|direction| self.radiance(direction)).dot(LUMINANCE) / TAU
    }
}

/// Perez' distribution: F = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma) (P99, eq. 3).
fn perez(&[a, b, c, d, e]: &[f64; 5], cos_theta: f64, gamma: f64, cos_gamma: f64) -> f64 {
    (1.0 + a * (b / cos_theta).exp()) * (1.0 + c * (d * gamma).exp() + e * cos_gamma * cos_gamma)
}

/// CIE xyY to linear RGB with Rec. 709 primaries (IEC 61966-2-1). Negative components of colors outside the gamut
/// become 0.
fn rgb_from_xyy(x: f64, y: f64, luminance: f64) -> DVec3 {
    let xyz = DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance;
    DVec3::new(
        DVec3::new(3.2406, -1.5372, -0.4986).dot(xyz),
        DVec3::new(-0.9689, 1.8758, 0.0415).dot(xyz),
        DVec3::new(0.0557, -0.2040, 1.0570).dot(xyz),
    )
    .max(DVec3::ZERO)
}

/// Color of sunlight at the ground, linear RGB: transmittance of Rayleigh and aerosol scattering at 650, 550 and 450 nm
/// (P99, appendix A.1, whose other absorptions are small in comparison).
fn sun_color(zenith_angle: f64) -> DVec3 {
    // Relative optical mass; the formula takes the angle in degrees.
    let mass = 1.0 / (zenith_angle.cos() + 0.15 * (93.885 - zenith_angle.to_degrees()).powf(-1.253));
    let beta = 0.04608 * TURBIDITY - 0.04586;
    let transmittance = |micrometers: f64| {
        let rayleigh = 0.008735 * micrometers.powf(-4.08);
        let aerosol = beta * micrometers.powf(-1.3);
        (-(rayleigh + aerosol) * mass).exp()
    };
    DVec3::new(transmittance(0.65), transmittance(0.55), transmittance(0.45))
}

/// Integral over the hemisphere y > 0, by midpoints of equal steps in height and azimuth, which have equal solid
/// angles.
fn hemisphere(f: impl Fn(DVec3) -> DVec3) -> DVec3 {
    const HEIGHTS: usize = 64;
    const AZIMUTHS: usize = 128;
    let mut sum = DVec3::ZERO;
    for i in 0..HEIGHTS {
        let y = (i as f64 + 0.5) / HEIGHTS as f64;
        let radius = (1.0 - y * y).sqrt();
        for j in 0..AZIMUTHS {
            let (sin, cos) = ((j as f64 + 0.5) / AZIMUTHS as f64 * TAU).sin_cos();
            sum += f(DVec3::new(radius * sin, y, radius * cos));
        }
    }
    sum * (TAU / (HEIGHTS * AZIMUTHS) as f64)
}

/// Adds a disc of uniform radiance. Each texel receives the fraction of the disc that it covers, so the total is the
/// sun's irradiance at any resolution.
fn add_sun(environment: &mut Environment, sun: DVec3, irradiance: DVec3) {
    let (width, height) = (environment.width as usize, environment.height as usize);
    let covered = disc(sun, SUN_RADIUS, width, height);
    // The sum differs from the disc's solid angle by the quadrature error over latitudes. Dividing by the sum makes the
    // energy exact.
    let radiance = irradiance / covered.iter().map(|(_, solid_angle)| solid_angle).sum::<f64>();
    for (texel, solid_angle) in covered {
        let added = radiance * (solid_angle / texel_solid_angle(texel / width, width, height));
        let [r, g, b, _] = &mut environment.pixels[texel];
        for (value, added) in [r, g, b].into_iter().zip(added.to_array()) {
            *value += added as f32;
        }
    }
}

/// The texels that a disc around `center` covers, each with the covered solid angle. Exact in azimuth; by midpoints of
/// 64 latitudes within each row. The disc must not reach a pole or the left edge.
fn disc(center: DVec3, radius: f64, width: usize, height: usize) -> Vec<(usize, f64)> {
    const LATITUDES: usize = 64;
    let theta = center.y.acos();
    let phi = center.x.atan2(-center.z) + PI;
    let (row, column) = (height as f64 / PI, width as f64 / TAU);
    let mut covered = Vec::new();
    for y in rows(theta - radius, theta + radius, row).filter(|y| *y < height) {
        let mut texels = std::collections::BTreeMap::<usize, f64>::new();
        for i in 0..LATITUDES {
            let at = (y as f64 + (i as f64 + 0.5) / LATITUDES as f64) / row;
            // Spherical law of cosines: cos r = cos theta cos at + sin theta sin at cos(half the width).
            let cos_half = (radius.cos() - theta.cos() * at.cos()) / (theta.sin() * at.sin());
            if cos_half >= 1.0 {
                continue;
            }
            let half = cos_half.max(-1.0).acos();
            let solid_angle_per_phi = at.sin() / (row * LATITUDES as f64);
            for x in rows(phi - half, phi + half, column) {
                let (left, right) = (x as f64 / column, (x as f64 + 1.0) / column);
                let overlap = (right.min(phi + half) - left.max(phi - half)).max(0.0);
                *texels.entry(x % width).or_default() += overlap * solid_angle_per_phi;
            }
        }
        covered.extend(texels.into_iter().map(|(x, solid_angle)| (y * width + x, solid_angle)));
    }
    covered
}

/// The range of texels that an interval of angles touches.
fn rows(from: f64, to: f64, texels_per_radian: f64) -> Range<usize> {
    (from.max(0.0) * texels_per_radian).floor() as usize..(to * texels_per_radian).ceil() as usize
}
