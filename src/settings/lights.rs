//! Settings of the lights: three orbiting lights, a rectangle, the model's own lights, ambient light.

use serde::{Deserialize, Serialize};

use super::declare::settings;
use super::entry::{Entry, When};
use super::part::{Choice, Part};
use super::setting::Setting;
use super::value::Value;

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

impl Choice for LightSource {}

settings! {
    /// Settings of the lights.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct LightSettings {
        /// Lights that are on: those that orbit the model, those in its file, or none.
        source: LightSource, row("Source") title("Lights");
        /// Light whose BRDF terms the modes show, counted from 1. 0: all, which means lobes summed over all lights, and light 1 for D, G, V,
        /// F, weights and cosines, which depend on the direction to a single light.
        chosen: u32, row("Terms of");
        /// Illuminance at which lights of the model without a range end. 0: they reach everything, so each costs time in every pixel.
        cutoff: f32 = 0.0, limits(0.0, 1e9) unit(ILLUMINANCE) row("Cutoff") slider(0.0, 1.0, 3) when(MODEL);
        /// Speed of the orbiting lights around the model in the window; 0 stops them (L).
        spin: f32 = 0.0, limits(-1e4, 1e4) unit(DEGREES_PER_SECOND) row("Orbit speed") slider(-90.0, 90.0, 0) when(ORBIT);
        /// The three orbiting lights.
        orbit: [OrbitLight; 3] = [
            OrbitLight::default(),
            OrbitLight { color: [0.45, 0.65, 1.0], strength: 6.0, distance: 2.2, azimuth: 95.0, polar: 75.0 },
            OrbitLight { color: [1.0, 0.42, 0.25], strength: 10.0, distance: 2.0, azimuth: 200.0, polar: 55.0 },
        ];
        /// The rectangular light, in addition to those of `source`, unless that is `none`.
        rect: RectLight;
        /// Color of the light from every direction. An environment replaces the ambient light.
        ambient_color: [f32; 3] = [0.72, 0.82, 1.0], limits(0.0, 1e6) unit(LINEAR_RGB) row("Color") when(DARK);
        /// Luminance from every direction. An environment replaces the ambient light.
        ambient_strength: f32 = 0.12, limits(0.0, 1e9) unit(LUMINANCE) row("Luminance") slider(0.0, 2.0, 2) when(DARK);
    }
}

settings! {
    /// A point light that orbits the model. Distances are in radii of the model's bounding sphere, so that every model has
    /// the same lighting.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct OrbitLight {
        /// Color.
        color: [f32; 3] = [1.0, 0.93, 0.82], limits(0.0, 1e6) unit(LINEAR_RGB) row("Color") when(ORBIT);
        /// Illuminance at a distance of one model radius: the intensity if that radius is 1 m.
        strength: f32 = 14.0, limits(0.0, 1e9) unit(CANDELA) row("Illuminance") slider(0.0, 60.0, 1) when(ORBIT);
        /// Distance from the model's center, in radii of the model.
        distance: f32 = 2.0, limits(1e-3, 1e6) unit(RADII) row("Distance") logarithmic(0.5, 10.0, 2) when(ORBIT);
        /// Angle around +Y, from +Z towards +X.
        azimuth: f32 = 0.0, limits(-1e6, 1e6) unit(DEGREES) row("Azimuth") slider(-180.0, 360.0, 0) when(ORBIT);
        /// Angle from +Y.
        polar: f32 = 50.0, limits(-1e6, 1e6) unit(DEGREES) row("Polar angle") slider(0.0, 180.0, 0) when(ORBIT);
    }
}

settings! {
    /// A one-sided rectangular light that faces the model's center. Lengths are in radii of the model's bounding sphere.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct RectLight {
        /// One-sided area light that faces the model's center.
        enabled: bool = false, row("On") title("Rectangular light");
        /// Color.
        color: [f32; 3] = [1.0; 3], limits(0.0, 1e6) unit(LINEAR_RGB) row("Color") when(RECTANGLE);
        /// Luminance of a white rectangle, independent of its size.
        strength: f32 = 6.0, limits(0.0, 1e9) unit(LUMINANCE) row("Luminance") slider(0.0, 60.0, 1) when(RECTANGLE);
        /// Length of the horizontal edges, in radii of the model.
        width: f32 = 1.2, limits(1e-3, 1e3) unit(RADII) row("Width") logarithmic(0.01, 20.0, 2) when(RECTANGLE);
        /// Length of the other edges, in radii of the model.
        height: f32 = 0.8, limits(1e-3, 1e3) unit(RADII) row("Height") logarithmic(0.01, 20.0, 2) when(RECTANGLE);
        /// Distance from the model's center, in radii of the model.
        distance: f32 = 1.8, limits(1e-3, 1e6) unit(RADII) row("Distance") logarithmic(0.5, 10.0, 2) when(RECTANGLE);
        /// Angle around +Y, from +Z towards +X.
        azimuth: f32 = -40.0, limits(-1e6, 1e6) unit(DEGREES) row("Azimuth") slider(-180.0, 360.0, 0) when(RECTANGLE);
        /// Angle from +Y.
        polar: f32 = 50.0, limits(-1e6, 1e6) unit(DEGREES) row("Polar angle") slider(0.0, 180.0, 0) when(RECTANGLE);
    }
}

const MODEL: When = When::Is("lights.source", "model");
const ORBIT: When = When::Is("lights.source", "orbit");
const RECTANGLE: When = When::All(&[When::Is("lights.rect.enabled", "true"), When::Not("lights.source", "none")]);
/// There is no environment, which would replace the ambient light.
const DARK: When = When::Is("environment.name", "none");

impl Part for [OrbitLight; 3] {
    fn list(&self, path: &str, entry: &'static Entry, list: &mut Vec<Setting>) {
        for (index, light) in self.iter().enumerate() {
            light.list(&format!("{path}.{index}"), entry, list);
        }
    }

    fn at(&self, path: &str) -> Option<Value> {
        let (index, rest) = path.split_once('.')?;
        self.get(index.parse::<usize>().ok()?)?.at(rest)
    }

    fn set_at(&mut self, path: &str, value: &Value) {
        let light =
            path.split_once('.').and_then(|(index, rest)| Some((self.get_mut(index.parse::<usize>().ok()?)?, rest)));
        if let Some((light, rest)) = light {
            light.set_at(rest, value);
        }
    }
}
