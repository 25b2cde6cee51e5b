//! All settings of the user in one serde struct. The window, `--set`, look files and the tests all use it.

mod alike;
mod assign;
mod catalog;
mod declare;
mod display;
mod entry;
mod environment;
mod expression;
mod factors;
mod lights;
mod list;
mod look;
mod material;
mod scene;
mod value;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::message::did_you_mean;

pub use assign::unknown_setting;
pub use catalog::{Setting, catalog, setting, table};
use declare::settings;
pub use display::{Channels, Colormap, ViewRange};
pub use entry::{Curve, Entry, Slider, Unit, Valid};
pub use environment::EnvironmentSettings;
pub use expression::ExpressionSettings;
pub use factors::{Factor, FactorValue, MaterialValues, path as factor_path};
pub use lights::{LightSettings, LightSource, OrbitLight, RectLight};
pub use look::LookError;
pub use material::{MaterialChannel, MaterialChannels, MaterialOverride};
pub use scene::{ModelSettings, SceneSettings};
use value::{Choice, Part as _};
pub use value::{Value, choice_name};

settings! {
    /// All settings. A look file is this struct as TOML. `--set` takes dotted paths into it.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Settings {
        /// Debug mode; `specula modes` lists them.
        mode: String = "final".into();
        /// Camera.
        camera: CameraSettings;
        /// Lights.
        lights: LightSettings;
        /// Variant of the model's materials (KHR_materials_variants); without one its own materials.
        variant: String, row("Variant");
        /// Material override: one material replaces all of the model's, or some channels of them.
        material: MaterialOverride;
        /// Factors of single materials of the model, by name of the material.
        materials: BTreeMap<String, MaterialValues>;
        /// Visible parts of the model.
        scene: SceneSettings;
        /// Where the model stands.
        model: ModelSettings;
        /// Environment.
        environment: EnvironmentSettings;
        /// File of a measured BRDF, for the modes `measured...`.
        measured: String;
        /// The expression that the mode `expression` shows.
        expression: ExpressionSettings;
        /// Exposure, tone mapping, background, multisampling.
        view: ViewSettings;
        /// Cameras that the user has kept, by their number.
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        bookmarks: BTreeMap<String, CameraSettings>;
        /// Declared passes that are switched on or off, by name. The others are as their `//@pass` says.
        passes: BTreeMap<String, bool>;
        /// Values of the constants and parameters that `//@ui` annotations declare, by name.
        shader: BTreeMap<String, ShaderValue>;
    }
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

settings! {
    /// The camera. Without `eye`, `azimuth` and `elevation` frame the model.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct CameraSettings {
        /// Vertical field of view.
        fovy: f32 = 35.0, limits(1.0, 170.0) unit(DEGREES) row("Field of view") slider(5.0, 120.0, 0);
        /// Position of the camera in meters: x, y, z. Without it, the camera frames the model.
        #[serde(skip_serializing_if = "Option::is_none")]
        eye: Option<[f32; 3]>, unit(METERS) row("Position");
        /// The point that the camera looks at and orbits around, in meters: x, y, z. Without it, the center of the model.
        #[serde(skip_serializing_if = "Option::is_none")]
        target: Option<[f32; 3]>, unit(METERS) row("Target");
        /// Framing: angle around the model, from +Z towards +X.
        azimuth: f32 = 30.0, limits(-1e6, 1e6) unit(DEGREES);
        /// Framing: angle above the horizon.
        elevation: f32 = 15.0, limits(-90.0, 90.0) unit(DEGREES);
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

impl Choice for Tonemap {}

/// The default background. Modes that show data instead of light also use it if the background is `env`.
const BACKGROUND: &str = "#1b1d21";

settings! {
    /// How the renderer turns radiance into a picture.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ViewSettings {
        /// Exposure as EV100: light in cd/m² is multiplied by 1 / (1.2 × 2^EV100), so +1 is half as bright. The window shows the exposure
        /// compensation in stops, -EV100: there, +1 is twice as bright.
        ev: f32 = 0.0, limits(-30.0, 30.0) unit(EV100) row("Exposure") negated(-16.0, 16.0, 1);
        /// Curve that maps exposed light to the range of the display.
        tonemap: Tonemap, row("Tone map");
        /// What is behind the model: none (transparent), env (the environment), or a color as #rrggbb.
        background: String = BACKGROUND.into(), row("Background")
            choices(&[("environment", "env"), ("dark gray", BACKGROUND), ("transparent", "none")]);
        /// The values shown as black and white. mode: as the mode stores them; auto: fit to the picture, in modes whose values have a unit
        /// or leave 0..1, and for a watched expression; fit: fit to the picture in every mode, in place of exposure and tone map;
        /// LOW..HIGH: these two.
        range: ViewRange, words("mode, auto, fit or LOW..HIGH") row("Range") title("Range of values")
            choices(&[("as the mode stores them", "mode"), ("auto", "auto"), ("fit to the picture", "fit")]);
        /// Channels that the picture shows. A single channel is shown in gray; a is coverage.
        channels: Channels, row("Channels");
        /// Colors that stand for a number, in modes with one component and for a single channel. none: the colors of the mode. viridis and
        /// magma have even steps of lightness (van der Walt and Smith 2015), turbo has many hues (Mikhailov 2019), and coolwarm diverges
        /// from a neutral middle (Moreland 2009).
        colormap: Colormap, row("Colormap") title("Colors of numbers");
        /// Draw the edges of the triangles over the picture, in every mode.
        wireframe: bool, row("Wireframe") title("Wireframe over the picture");
        /// Noise of half an 8-bit step, which hides banding in smooth light. The window has it, `render` does not; data and EXR files never
        /// have it.
        dither: bool, row("Dither");
        /// Multisampling: samples of each pixel.
        msaa: u32 = 4, one_of(&[1, 4]) unit(SAMPLES) row("Samples") title("Samples per pixel");
        /// Frames that `render` averages in modes that accumulate.
        frames: u32 = 64, whole(1, 100_000) unit(FRAMES);
        /// Reflections of a random path after the first, in modes that trace the model. 0 leaves direct light.
        bounces: u32 = 4, whole(0, 64) unit(REFLECTIONS);
        /// Memory that images and buffers of passes may take.
        pass_memory: u32 = 2048, whole(1, 1 << 20) unit(MEBIBYTES);
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
    /// The value of the setting at a path, or of one of its numbers.
    pub fn value(&self, path: &str) -> Option<Value> {
        self.at(path)
    }

    /// Sets the value at a path. A path that does not exist, or a value of another type, changes nothing.
    pub fn set_value(&mut self, path: &str, value: &Value) {
        self.set_at(path, value);
    }

    /// Checks that every value is valid.
    ///
    /// # Errors
    /// A message with the setting, its value and the valid values.
    pub fn check(&self) -> Result<(), String> {
        for setting in catalog() {
            self.at(&setting.path).map_or(Ok(()), |value| setting.entry.check(&setting.path, &value))?;
        }
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
        Ok(())
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
            ("view.frames=0", "view.frames is 0; it can be 1 to 100000"),
            ("view.msaa=2", "view.msaa is 2; it can be 1 or 4"),
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
