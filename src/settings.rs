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
    /// World position, meters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f32; 3]>,
    /// Looked-at point, meters.
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
                OrbitLight { color: [1.0, 0.93, 0.82], strength: 14.0, distance: 2.0, azimuth: 0.0, polar: 50.0 },
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

/// Tone maps, in the order of `TONEMAP_*` in common/tonemap.glsl.
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
    /// `none` or `#rrggbb`.
    pub background: String,
    /// Samples a pixel, 1 or 4.
    pub msaa: u32,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self { tonemap: Tonemap::default(), ev: 0.0, background: "#1b1d21".into(), msaa: 4 }
    }
}

impl ViewSettings {
    /// Linear color and alpha behind the model.
    ///
    /// # Errors
    /// A text that is neither `none` nor a color, in words.
    pub fn background_linear(&self) -> Result<[f32; 4], String> {
        let text = self.background.as_str();
        if text == "none" {
            return Ok([0.0; 4]);
        }
        let expected = || format!("background '{text}' is neither none nor #rrggbb (as #1b1d21)");
        let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii()).ok_or_else(expected)?;
        let rgb = u32::from_str_radix(digits, 16).map_err(|_| expected())?;
        let channel = |shift: u32| linear_from_srgb(((rgb >> shift) & 255) as f32 / 255.0);
        Ok([channel(16), channel(8), channel(0), 1.0])
    }
}

/// sRGB electro-optical transfer function (IEC 61966-2-1): linear light from an encoded value, both 0..1.
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

impl Settings {
    /// Reads a look file.
    ///
    /// # Errors
    /// TOML that does not parse or names that do not exist, in words with line and column.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|e| e.to_string())
    }

    /// The settings as a look file.
    pub fn to_toml(&self) -> String {
        toml::to_string_pretty(self).unwrap_or_default()
    }

    /// Refuses values that no picture can be made of.
    ///
    /// # Errors
    /// The setting, what it is and what it can be, in words.
    pub fn check(&self) -> Result<(), String> {
        let camera = &self.camera;
        let numbers = [
            ("camera.fovy", camera.fovy, 1.0, 170.0),
            ("camera.elevation", camera.elevation, -90.0, 90.0),
            ("camera.azimuth", camera.azimuth, -1e6, 1e6),
            ("view.ev", self.view.ev, -30.0, 30.0),
            ("lights.ambient_strength", self.lights.ambient_strength, 0.0, 1e9),
            ("lights.spin", self.lights.spin, -1e4, 1e4),
            ("lights.ambient_color.0", self.lights.ambient_color[0], 0.0, 1e6),
            ("lights.ambient_color.1", self.lights.ambient_color[1], 0.0, 1e6),
            ("lights.ambient_color.2", self.lights.ambient_color[2], 0.0, 1e6),
        ];
        let orbit = self.lights.orbit.iter().enumerate();
        let lights = orbit.flat_map(|(i, l)| {
            [
                ("strength", l.strength, 0.0, 1e9),
                ("distance", l.distance, 1e-3, 1e6),
                ("azimuth", l.azimuth, -1e6, 1e6),
                ("polar", l.polar, -1e6, 1e6),
                ("color.0", l.color[0], 0.0, 1e6),
                ("color.1", l.color[1], 0.0, 1e6),
                ("color.2", l.color[2], 0.0, 1e6),
            ]
            .map(|(name, value, low, high)| (format!("lights.orbit.{i}.{name}"), value, low, high))
        });
        let named = numbers.map(|(name, value, low, high)| (name.to_owned(), value, low, high));
        for (name, value, low, high) in named.into_iter().chain(lights) {
            if !(low..=high).contains(&value) {
                return Err(format!("{name} is {value}; it can be {low} to {high}"));
            }
        }
        let vectors = [("camera.eye", camera.eye), ("camera.target", camera.target)];
        for (name, vector) in vectors {
            if vector.is_some_and(|v| !v.iter().all(|c| c.is_finite())) {
                return Err(format!("{name} must have finite numbers"));
            }
        }
        self.view.background_linear()?;
        match self.view.msaa {
            1 | 4 => Ok(()),
            other => Err(format!("view.msaa is {other}; it can be 1 or 4")),
        }
    }

    /// Applies `path=value`, as `--set` takes it: a dotted path (`lights.orbit.0.strength`), or the bare name of a shader's own
    /// constant or parameter; a TOML value, or text without quotes.
    ///
    /// # Errors
    /// No `=`, a path that does not exist, or a value of the wrong kind, in words.
    pub fn assign(&mut self, assignment: &str) -> Result<(), String> {
        let (path, text) = assignment
            .split_once('=')
            .ok_or_else(|| format!("'{assignment}' is not path=value, as in lights.ambient_strength=0.2"))?;
        let (path, text) = (path.trim(), text.trim());
        let value = toml::from_str::<toml::Table>(&format!("value = {text}"))
            .ok()
            .and_then(|mut table| table.remove("value"))
            .unwrap_or_else(|| toml::Value::String(text.into()));
        let mut root = toml::Value::try_from(&*self).map_err(|e| e.to_string())?;
        let is_own = !path.contains('.') && root.get(path).is_none();
        let full = if is_own { format!("shader.{path}") } else { path.to_owned() };
        set_at(&mut root, &full, value)?;
        *self = root.try_into().map_err(|e: toml::de::Error| {
            let cause = e.to_string().trim().replace('\n', " ");
            format!("cannot set {path} to {text}: {cause}")
        })?;
        Ok(())
    }
}

fn set_at(root: &mut toml::Value, path: &str, value: toml::Value) -> Result<(), String> {
    let mut place = root;
    for key in path.split('.') {
        place = match place {
            toml::Value::Table(table) => table.entry(key).or_insert_with(|| toml::Value::Table(toml::Table::new())),
            toml::Value::Array(array) => {
                let length = array.len();
                let index = key.parse::<usize>().ok();
                index.and_then(|i| array.get_mut(i)).ok_or_else(|| {
                    format!("'{key}' in {path} is not one of the {length} entries, 0 to {}", length.saturating_sub(1))
                })?
            }
            _ => return Err(format!("there is nothing below the part before '{key}' in {path}")),
        };
    }
    *place = value;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assign_reaches_every_depth() {
        let mut settings = Settings::default();
        for assignment in [
            "mode=base-color",
            "view.ev = -1",
            "view.tonemap=reinhard-luminance",
            "lights.orbit.2.color=[1, 0, 0.5]",
            "camera.eye=[1,2,3]",
            "shader.rim=0.5",
            "NDF_MODEL=Beckmann",
        ] {
            settings.assign(assignment).unwrap();
        }
        assert_eq!(settings.mode, "base-color");
        assert_eq!(settings.view.ev, -1.0);
        assert_eq!(settings.view.tonemap, Tonemap::ReinhardLuminance);
        assert_eq!(settings.lights.orbit[2].color, [1.0, 0.0, 0.5]);
        assert_eq!(settings.camera.eye, Some([1.0, 2.0, 3.0]));
        assert_eq!(settings.shader["rim"], ShaderValue::Float(0.5));
        assert_eq!(settings.shader["NDF_MODEL"], ShaderValue::Name("Beckmann".into()));
    }

    #[test]
    fn assign_explains_what_it_cannot_do() {
        let mut settings = Settings::default();
        let before = settings.clone();
        for (assignment, part) in [
            ("view.exposure=1", "exposure"),
            ("view.ev=bright", "view.ev"),
            ("lights.orbit.3.strength=1", "0 to 2"),
            ("view.ev.x=1", "nothing below"),
            ("view.ev", "path=value"),
            ("view.tonemap=filmic", "filmic"),
        ] {
            let error = settings.assign(assignment).unwrap_err();
            assert!(error.contains(part), "{assignment}: {error}");
            assert_eq!(settings, before, "{assignment} left a trace");
        }
    }

    #[test]
    fn a_look_file_holds_every_setting() {
        let mut settings = Settings::default();
        settings.assign("camera.eye=[1,2,3]").unwrap();
        settings.assign("rim=0.25").unwrap();
        assert_eq!(Settings::from_toml(&settings.to_toml()).unwrap(), settings);
    }
}
