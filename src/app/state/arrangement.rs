//! The panels and the arrangements of them that Specula offers, by their names.

use serde::{Deserialize, Serialize};

/// A panel that a tile shows, by its title. `crate::app::panels` lists them all; these are named elsewhere, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(in crate::app) struct Panel(pub(in crate::app) &'static str);

impl Panel {
    pub(in crate::app) const VIEWPORT: Self = Self("Viewport");
    pub(in crate::app) const MODES: Self = Self("Modes");
    pub(in crate::app) const TEXTURE: Self = Self("Texture");
    pub(in crate::app) const LEARN: Self = Self("Learn");
    pub(in crate::app) const LIGHTS: Self = Self("Lights");
    pub(in crate::app) const SHADERS: Self = Self("Shaders");
    pub(in crate::app) const TIMELINE: Self = Self("Timeline");
    pub(in crate::app) const TIMING: Self = Self("Timing");
    pub(in crate::app) const EXPRESSION: Self = Self("Expression");
    pub(in crate::app) const PARAMETERS: Self = Self("Parameters");
    pub(in crate::app) const PASSES: Self = Self("Passes");
    pub(in crate::app) const INSPECTOR: Self = Self("Inspector");
    pub(in crate::app) const SOURCE: Self = Self("Source");
    pub(in crate::app) const OUTPUT: Self = Self("Output");
    pub(in crate::app) const CAPTURE: Self = Self("Capture");
}

/// An arrangement that Specula offers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::app) enum Preset {
    /// All panels. The first one.
    #[default]
    Debug,
    /// The panels of light, camera and parameters, and a larger picture.
    Look,
    /// The versions of the shaders below the picture.
    Compare,
    /// An exercise beside the picture.
    Learn,
    /// For a single shader without a model, which opens this preset: clock, passes and shaders.
    Toy,
}

impl Preset {
    /// Those that the user chooses from.
    pub(in crate::app) const ALL: [Self; 4] = [Self::Debug, Self::Look, Self::Compare, Self::Learn];

    pub(in crate::app) fn title(self) -> &'static str {
        match self {
            Self::Debug => "Debug",
            Self::Look => "Look",
            Self::Compare => "Compare",
            Self::Learn => "Learn",
            Self::Toy => "Shader",
        }
    }

    pub(in crate::app) fn doc(self) -> &'static str {
        match self {
            Self::Debug => "Modes and shaders on the left, all settings on the right",
            Self::Look => "Light, output and parameters on the right, nothing on the left",
            Self::Compare => "The timeline of your edits below the picture, parameters on the right",
            Self::Toy => "Clock, passes and shaders beside the picture",
            Self::Learn => "An exercise beside the picture: short lessons about shading, which Specula checks",
        }
    }
}
