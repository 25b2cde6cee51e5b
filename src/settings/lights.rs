//! Settings of the lights: three orbiting lights, a rectangle, the model's own lights, ambient light.

use serde::{Deserialize, Serialize};

use super::Range;

/// The lights that are on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum LightSource {
    /// The three orbiting lights.
    #[default]
    Orbit,
    /// The model's own lights (KHR_lights_punctual).
    Model,
    /// No lights, only the environment.
    None,
}

/// Settings of the lights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightSettings {
    /// Which lights are on.
    pub source: LightSource,
    /// The three orbiting lights.
    pub orbit: [OrbitLight; 3],
    /// The rectangular light, in addition to those of `source`, unless that is `none`.
    pub rect: RectLight,
    /// Speed at which the orbiting lights turn around the model in the window, degrees a second; 0 stops them.
    pub spin: f32,
    /// The light that BRDF term modes show: 0 all, else 1-based.
    pub chosen: u32,
    /// Color of the ambient light, linear RGB. It is off while there is an environment.
    pub ambient_color: [f32; 3],
    /// Luminance of the ambient light if its color is white, cd/m^2.
    pub ambient_strength: f32,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self {
            source: LightSource::Orbit,
            orbit: [
                OrbitLight { color: [1.0, 0.93, 0.82], strength: 14.0, distance: 2.0, azimuth: 0.0, polar: 50.0 },
                OrbitLight { color: [0.45, 0.65, 1.0], strength: 6.0, distance: 2.2, azimuth: 95.0, polar: 75.0 },
                OrbitLight { color: [1.0, 0.42, 0.25], strength: 10.0, distance: 2.0, azimuth: 200.0, polar: 55.0 },
            ],
            rect: RectLight::default(),
            spin: 0.0,
            chosen: 0,
            ambient_color: [0.72, 0.82, 1.0],
            ambient_strength: 0.12,
        }
    }
}

/// A point light that orbits the model. Distances are in radii of the model's bounding sphere, so that every model has
/// the same lighting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrbitLight {
    /// Linear RGB.
    pub color: [f32; 3],
    /// Illuminance at the model's center in lux, times distance^2: candela for a model of radius 1 m.
    pub strength: f32,
    /// Distance from the center in model radii.
    pub distance: f32,
    /// Degrees around +Y, from +Z towards +X.
    pub azimuth: f32,
    /// Degrees from +Y.
    pub polar: f32,
}

/// A one-sided rectangular light that faces the model's center. Lengths are in radii of the model's bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RectLight {
    /// Whether it is on.
    pub enabled: bool,
    /// Linear RGB.
    pub color: [f32; 3],
    /// Luminance if its color is white, cd/m^2. It does not change with the size.
    pub strength: f32,
    /// Length of its horizontal edges.
    pub width: f32,
    /// Length of the other edges.
    pub height: f32,
    /// Distance from the model's center to the rectangle's.
    pub distance: f32,
    /// Degrees around +Y, from +Z towards +X.
    pub azimuth: f32,
    /// Degrees from +Y.
    pub polar: f32,
}

impl Default for RectLight {
    fn default() -> Self {
        Self {
            enabled: false,
            color: [1.0; 3],
            strength: 6.0,
            width: 1.2,
            height: 0.8,
            distance: 1.8,
            azimuth: -40.0,
            polar: 50.0,
        }
    }
}

impl LightSettings {
    /// All numbers with their paths and limits.
    pub(super) fn ranges(&self) -> Vec<Range> {
        let mut ranges = vec![
            Range::new("lights.ambient_strength", self.ambient_strength, 0.0..=1e9),
            Range::new("lights.spin", self.spin, -1e4..=1e4),
        ];
        ranges.extend(Range::all("lights.ambient_color", &self.ambient_color, 0.0..=1e6));
        for (i, light) in self.orbit.iter().enumerate() {
            ranges.extend(placed(&format!("lights.orbit.{i}"), light));
        }
        let RectLight { enabled: _, color, strength, width, height, distance, azimuth, polar } = self.rect;
        ranges.extend(placed("lights.rect", &OrbitLight { color, strength, distance, azimuth, polar }));
        ranges.push(Range::new("lights.rect.width", width, 1e-3..=1e3));
        ranges.push(Range::new("lights.rect.height", height, 1e-3..=1e3));
        ranges
    }
}

fn placed(path: &str, light: &OrbitLight) -> Vec<Range> {
    let mut ranges = vec![
        Range::new(format!("{path}.strength"), light.strength, 0.0..=1e9),
        Range::new(format!("{path}.distance"), light.distance, 1e-3..=1e6),
        Range::new(format!("{path}.azimuth"), light.azimuth, -1e6..=1e6),
        Range::new(format!("{path}.polar"), light.polar, -1e6..=1e6),
    ];
    ranges.extend(Range::all(&format!("{path}.color"), &light.color, 0.0..=1e6));
    ranges
}
