//! All settings of the user in one serde struct. The window, `--set`, look files and the tests all use it.

mod added;
mod alike;
mod animation;
mod assign;
mod camera;
mod catalog;
mod check;
mod declare;
mod entry;
mod environment;
mod expression;
mod factors;
mod lights;
mod list;
mod look;
mod material;
mod part;
mod scene;
mod setting;
mod value;
mod value_display;
mod view;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use added::{AddedModel, MOST_ADDED};
pub use animation::AnimationSettings;
pub use assign::unknown_setting;
pub use camera::CameraSettings;
pub use catalog::{catalog, setting};
use declare::settings;
pub use entry::{Curve, Entry, Slider, Unit, Valid};
pub use environment::EnvironmentSettings;
pub use expression::ExpressionSettings;
pub use factors::{Factor, FactorValue, MaterialValues, path as factor_path};
pub use lights::{LightSettings, LightSource, OrbitLight, RectLight};
pub use look::LookError;
pub use material::{MaterialChannel, MaterialChannels, MaterialOverride};
use part::Part as _;
pub use part::choice_name;
pub use scene::{ModelSettings, SceneSettings};
pub use setting::Setting;
pub use value::Value;
pub use value_display::{Channels, Colormap, ViewRange, linear_from_srgb};
pub use view::{Checks, Tonemap, ViewSettings};

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
        /// Models beside the first: `added.0.file`, and where each stands, as `added.0.place.scale`.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        added: Vec<AddedModel>;
        /// Animations of the model.
        animation: AnimationSettings;
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

impl Settings {
    /// The value of the setting at a path, or of one of its numbers.
    pub fn value(&self, path: &str) -> Option<Value> {
        self.at(path)
    }

    /// Sets the value at a path. A path that does not exist, or a value of another type, changes nothing.
    pub fn set_value(&mut self, path: &str, value: &Value) {
        self.set_at(path, value);
    }

    /// Whether a setting changes the picture, with the others as they are.
    pub fn uses(&self, entry: &Entry) -> bool {
        entry.used.holds(&|path| self.at(path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_file_holds_every_setting() {
        let mut settings = Settings::default();
        settings.assign("camera.eye=[1,2,3]").unwrap();
        settings.assign("rim=0.25").unwrap();
        assert_eq!(Settings::from_toml(&settings.to_toml()).unwrap(), settings);
    }
}
