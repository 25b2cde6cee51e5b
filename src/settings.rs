//! Everything a user can set, as one serde struct. The window, `--set`, look files and the tests all speak it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// All settings. `toml` of this struct is a look file; dotted paths into it are what `--set` takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Slug of the debug mode on screen.
    pub mode: String,
    /// Camera.
    pub camera: CameraSettings,
    /// Lights.
    pub lights: LightSettings,
    /// Exposure, tone mapping, background, multisampling.
    pub view: ViewSettings,
    /// Values of the shader author's own `//@ui` constants and parameters, by name.
    pub shader: BTreeMap<String, ShaderValue>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: "final".into(),
            camera: CameraSettings::default(),
            lights: LightSettings::default(),
            view: ViewSettings::default(),
            shader: BTreeMap::new(),
        }
    }
}

/// A value for a shader constant or parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ShaderValue {
    /// `bool`.
    Bool(bool),
    /// Whole number.
    Int(i64),
    /// `float`.
    Float(f64),
    /// `vec2`..`vec4`.
    Vector(Vec<f64>),
    /// Name of a `choice`.
    Name(String),
}

/// The camera. Without `eye` the model is framed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraSettings {
    /// World position, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f32; 3]>,
    /// Looked-at point, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<[f32; 3]>,
    /// Vertical field of view, degrees.
    pub fovy: f32,
    /// Framing: degrees around the model from +Z towards +X.
    pub azimuth: f32,
    /// Framing: degrees above the horizon.
    pub elevation: f32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self { eye: None, target: None, fovy: 35.0, azimuth: 30.0, elevation: 15.0 }
    }
}

/// Which lights shine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum LightSource {
    /// The three orbiting lights.
    #[default]
    Orbit,
    /// The model's own KHR_lights_punctual.
    Model,
    /// None.
    None,
}

/// Lights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightSettings {
    /// Which lights shine.
    pub source: LightSource,
    /// The three orbiting lights.
    pub orbit: [OrbitLight; 3],
    /// Whether they move around the model in the window, and how fast: degrees a second.
    pub spin: f32,
    /// Which light the BRDF terms show: 0 all, else 1-based.
    pub chosen: u32,
    /// Ambient light, linear RGB.
    pub ambient_color: [f32; 3],
    /// Its strength (radiance at white).
    pub ambient_strength: f32,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self {
            source: LightSource::Orbit,
            orbit: [
                OrbitLight { color: [1.0, 0.93, 0.82], strength: 14.0, distance: 2.0, azimuth: -35.0, polar: 50.0 },
                OrbitLight { color: [0.45, 0.65, 1.0], strength: 6.0, distance: 2.2, azimuth: 95.0, polar: 75.0 },
                OrbitLight { color: [1.0, 0.42, 0.25], strength: 10.0, distance: 2.0, azimuth: 200.0, polar: 55.0 },
            ],
            spin: 0.0,
            chosen: 0,
            ambient_color: [0.72, 0.82, 1.0],
            ambient_strength: 0.12,
        }
    }
}

/// A point light that circles the model. Distances are in radii of the model's bounding sphere, so that every model is lit alike.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrbitLight {
    /// Linear RGB.
    pub color: [f32; 3],
    /// Irradiance at the model's center times distance^2: intensity in candela for a model of radius 1 m.
    pub strength: f32,
    /// Distance from the center in model radii.
    pub distance: f32,
    /// Degrees around +Y, from +Z towards +X.
    pub azimuth: f32,
    /// Degrees from +Y.
    pub polar: f32,
}

/// Tone maps, in the order of `TONEMAP_*` in tonemap.frag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Tonemap {
    /// Clip at 1.
    None,
    /// x / (1 + x) on each channel.
    Reinhard,
    /// The same on luminance.
    ReinhardLuminance,
    /// Hable's filmic curve.
    Uncharted2,
    /// Narkowicz's fit of ACES.
    #[default]
    Aces,
    /// Hill's fit of ACES RRT + ODT.
    AcesHill,
    /// AgX.
    Agx,
    /// Khronos PBR Neutral.
    Neutral,
}

/// From radiance to the picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ViewSettings {
    /// Tone map.
    pub tonemap: Tonemap,
    /// EV100: exposure is 1 / (1.2 * 2^ev).
    pub ev: f32,
    /// `none`, `env` or `#rrggbb`.
    pub background: String,
    /// Samples a pixel, 1 or 4.
    pub msaa: u32,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self { tonemap: Tonemap::default(), ev: 0.0, background: "#1b1d21".into(), msaa: 4 }
    }
}
