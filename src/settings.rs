//! All settings of the user in one serde struct. The window, `--set`, look files and the tests all use it.

mod assign;
mod catalog;
mod display;
mod environment;
mod expression;
mod factors;
mod lights;
mod list;
mod look;
mod material;
mod range;
mod scene;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::message::did_you_mean;

pub use assign::unknown_setting;
pub use catalog::{Setting, catalog, limits, told};
pub use display::{Channels, Colormap, ViewRange};
pub use environment::EnvironmentSettings;
pub use expression::ExpressionSettings;
pub use factors::{Factor, FactorInfo, FactorValue, MaterialValues, path as factor_path};
pub use lights::{LightSettings, LightSource, OrbitLight, RectLight};
pub use look::LookError;
pub use material::{MaterialChannel, MaterialChannels, MaterialOverride};
use range::Range;
pub use scene::{ModelSettings, SceneSettings};

/// All settings. A look file is this struct as TOML. `--set` takes dotted paths into it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Slug of the debug mode.
    pub mode: String,
    /// Camera.
    pub camera: CameraSettings,
    /// Lights.
    pub lights: LightSettings,
    /// Name of a variant of the model (KHR_materials_variants); empty for the model's default materials.
    pub variant: String,
    /// Material override: one material replaces all of the model's, or some channels of them.
    pub material: MaterialOverride,
    /// Factors of single materials of the model, by name of the material.
    pub materials: BTreeMap<String, MaterialValues>,
    /// Visible parts of the model.
    pub scene: SceneSettings,
    /// Where the model stands.
    pub model: ModelSettings,
    /// Environment.
    pub environment: EnvironmentSettings,
    /// File of a measured BRDF, which the modes of the group Measured show; empty for none.
    pub measured: String,
    /// The expression that the mode `expression` shows.
    pub expression: ExpressionSettings,
    /// Exposure, tone mapping, background, multisampling.
    pub view: ViewSettings,
    /// Cameras that the user has kept, by their number.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub bookmarks: BTreeMap<String, CameraSettings>,
    /// Declared passes that are switched on or off, by name. The others are as their `//@pass` says.
    pub passes: BTreeMap<String, bool>,
    /// Values of the constants and parameters that `//@ui` annotations declare, by name.
    pub shader: BTreeMap<String, ShaderValue>,
}

/// The pass of the shipped tree that draws the model's shadow on the ground.
pub const GROUND: &str = "ground";

impl Settings {
    /// Initial settings of a window: the model, its shadow on the ground, and a blurred environment as background.
    pub fn of_window() -> Self {
        let mut settings = Self::default();
        settings.view.background = "env".into();
        settings.environment.blur = 0.3;
        settings.view.range = ViewRange::Auto;
        settings.view.dither = true;
        settings.passes.insert(GROUND.into(), true);
        settings
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: "final".into(),
            camera: CameraSettings::default(),
            lights: LightSettings::default(),
            variant: String::new(),
            material: MaterialOverride::default(),
            materials: BTreeMap::new(),
            scene: SceneSettings::default(),
            model: ModelSettings::default(),
            environment: EnvironmentSettings::default(),
            measured: String::new(),
            expression: ExpressionSettings::default(),
            view: ViewSettings::default(),
            bookmarks: BTreeMap::new(),
            passes: BTreeMap::new(),
            shader: BTreeMap::new(),
        }
    }
}

/// A value of a shader constant or parameter.
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

/// The camera. Without `eye`, `azimuth` and `elevation` frame the model.
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

/// Tone maps, in the order of `TONEMAP_*` in common/tonemap.glsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Tonemap {
    /// Clip at 1.
    None,
    /// x / (1 + x) on each channel.
    Reinhard,
    /// x / (1 + x) on luminance.
    ReinhardLuminance,
    /// Hable's filmic curve.
    Uncharted2,
    /// Narkowicz's approximation of ACES.
    #[default]
    Aces,
    /// Hill's approximation of ACES RRT + ODT.
    AcesHill,
    /// AgX.
    Agx,
    /// Khronos PBR Neutral.
    Neutral,
}

/// How the renderer turns radiance into a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ViewSettings {
    /// Tone map.
    pub tonemap: Tonemap,
    /// EV100: exposure is 1 / (1.2 * 2^ev), so a larger value is darker. The window shows it with the other sign.
    pub ev: f32,
    /// `none`, `env` or `#rrggbb`.
    pub background: String,
    /// Range of values that the picture spreads over the display.
    pub range: ViewRange,
    /// Channels that the picture shows.
    pub channels: Channels,
    /// Colors that stand for a number.
    pub colormap: Colormap,
    /// Whether light is dithered before it is stored with 8 bits.
    pub dither: bool,
    /// Whether the edges of the triangles lie over the picture.
    pub wireframe: bool,
    /// Samples per pixel, 1 or 4.
    pub msaa: u32,
    /// Number of frames that accumulating modes average when rendering without a window.
    pub frames: u32,
    /// How often a random path goes on from the surface that it has hit, in the modes that trace the model. 0 leaves direct light.
    pub bounces: u32,
    /// Memory that images and buffers of passes may take, MiB.
    pub pass_memory: u32,
}

/// The default background. Modes that show data instead of light also use it if the background is `env`.
const BACKGROUND: &str = "#1b1d21";

impl Default for ViewSettings {
    fn default() -> Self {
        let (tonemap, background) = (Tonemap::default(), BACKGROUND.into());
        let (range, channels, colormap) = (ViewRange::default(), Channels::default(), Colormap::default());
        Self {
            tonemap,
            ev: 0.0,
            background,
            range,
            channels,
            colormap,
            dither: false,
            wireframe: false,
            msaa: 4,
            frames: 64,
            bounces: 4,
            pass_memory: 2048,
        }
    }
}

impl ViewSettings {
    /// Linear RGB and alpha of the background. For `env`, the background of modes that show data instead of light.
    ///
    /// # Errors
    /// The setting is neither `none`, `env` nor a color.
    pub fn background_linear(&self) -> Result<[f32; 4], String> {
        let text = if self.background == "env" { BACKGROUND } else { self.background.as_str() };
        if text == "none" {
            return Ok([0.0; 4]);
        }
        let expected = || {
            let hint = did_you_mean(text, ["none", "env"]);
            format!("view.background is '{text}'.{hint} It can be none, env or a color as #1b1d21 (#rrggbb)")
        };
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
    /// All numbers that have limits, each with its path.
    fn ranges(&self) -> Vec<Range> {
        let camera = &self.camera;
        let mut ranges = vec![
            Range::new("camera.fovy", camera.fovy, 1.0..=170.0),
            Range::new("camera.elevation", camera.elevation, -90.0..=90.0),
            Range::new("camera.azimuth", camera.azimuth, -1e6..=1e6),
            Range::new("view.ev", self.view.ev, -30.0..=30.0),
        ];
        ranges.extend(self.lights.ranges());
        ranges.extend(self.material.ranges());
        ranges.extend(self.model.ranges());
        let environment = self.environment.numbers();
        ranges.extend(environment.map(|(name, value, low, high)| Range::new(name, value, low..=high)));
        ranges
    }

    /// Checks that every value is valid.
    ///
    /// # Errors
    /// A message with the setting, its value and the valid values.
    pub fn check(&self) -> Result<(), String> {
        self.ranges().iter().try_for_each(Range::check)?;
        factors::check(&self.materials)?;
        let vectors = [("camera.eye", self.camera.eye), ("camera.target", self.camera.target)];
        for (name, vector) in vectors {
            if vector.is_some_and(|v| !v.iter().all(|c| c.is_finite())) {
                return Err(format!("{name} has a number that is not finite; it takes three numbers, as 0,1.5,3"));
            }
        }
        self.view.background_linear()?;
        if self.view.background == "env" && !self.environment.is_lit() {
            return Err("view.background is env, but environment.name is none, so there is no environment to show. \
                Choose another background or an environment"
                .into());
        }
        if !(1..=100_000).contains(&self.view.frames) {
            return Err(format!("view.frames is {}; it can be 1 to 100000", self.view.frames));
        }
        if self.view.bounces > 64 {
            return Err(format!("view.bounces is {}; it can be 0 to 64", self.view.bounces));
        }
        if !(1..=1 << 20).contains(&self.view.pass_memory) {
            return Err(format!("view.pass_memory is {}; it can be 1 to {} MiB", self.view.pass_memory, 1 << 20));
        }
        match self.view.msaa {
            1 | 4 => Ok(()),
            other => Err(format!("view.msaa is {other}; it can be 1 or 4")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_names_what_no_picture_can_be_made_of() {
        Settings::default().check().unwrap();
        for (assignment, words) in [
            ("material.roughness=1.5", "material.roughness is 1.5; it can be 0 to 1"),
            ("material.base_color=[0, nan, 0]", "material.base_color.1 is NaN"),
            ("material.anisotropy_rotation=inf", "material.anisotropy_rotation is inf"),
            ("lights.rect.width=0", "lights.rect.width is 0; it can be 0.001 to 1000"),
            ("lights.rect.strength=inf", "lights.rect.strength is inf"),
            ("lights.orbit.1.color=[1, 1, -1]", "lights.orbit.1.color.2 is -1"),
        ] {
            let mut settings = Settings::default();
            settings.assign(assignment).unwrap();
            let error = settings.check().unwrap_err();
            assert!(error.contains(words), "{assignment}: {error}");
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
