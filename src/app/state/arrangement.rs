//! The panels and the arrangements of them that Specula offers, by their names.

use serde::{Deserialize, Serialize};

/// Panel that a tile shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::app) enum Panel {
    Viewport,
    Modes,
    Scene,
    Texture,
    Model,
    Shaders,
    Timeline,
    Timing,
    Expression,
    Parameters,
    Passes,
    Inspector,
    Environment,
    Lights,
    Output,
    Camera,
    Learn,
    Capture,
}

impl Panel {
    /// All panels that can be closed, in groups that share a tile at first.
    pub(in crate::app) const GROUPS: [&[Self]; 4] = [
        &[Self::Modes, Self::Scene, Self::Model, Self::Texture, Self::Learn],
        &[Self::Shaders, Self::Timeline, Self::Timing, Self::Expression],
        &[Self::Parameters, Self::Passes, Self::Inspector],
        &[Self::Environment, Self::Lights, Self::Output, Self::Camera, Self::Capture],
    ];

    /// Whether a preset opens the panel. The others open on request.
    pub(in crate::app) fn is_in_presets(self) -> bool {
        self != Self::Texture
    }

    /// Keywords for the search.
    pub(in crate::app) fn words(self) -> &'static str {
        match self {
            Self::Viewport => "picture",
            Self::Modes => "debug gallery thumbnails side by side grid",
            Self::Scene => "nodes meshes materials textures cameras lights",
            Self::Texture => "channels mip levels UV",
            Self::Model => "variant statistics transform rotation scale material override",
            Self::Shaders => "files includes stages problems driver registers",
            Self::Timeline => "versions history compare difference restore",
            Self::Timing => "GPU ms frame time memory",
            Self::Expression => "watch variable numbers of a line sliders",
            Self::Parameters => "sliders values defaults",
            Self::Passes => "clock time effects switch",
            Self::Inspector => "pixel values texels BRDF lobe albedo furnace plot",
            Self::Environment => "HDR map rotation background blur suns",
            Self::Lights => "color orbit rectangle ambient",
            Self::Output => "exposure tone map range channels colors samples",
            Self::Camera => "field of view bookmarks",
            Self::Learn => "exercises lessons",
            Self::Capture => "contact sheet turntable video timeline GIF WebP MP4 EXR size",
        }
    }

    pub(in crate::app) fn title(self) -> &'static str {
        match self {
            Self::Viewport => "Viewport",
            Self::Modes => "Modes",
            Self::Scene => "Scene",
            Self::Texture => "Texture",
            Self::Model => "Model",
            Self::Shaders => "Shaders",
            Self::Timeline => "Timeline",
            Self::Timing => "Timing",
            Self::Expression => "Expression",
            Self::Parameters => "Parameters",
            Self::Passes => "Passes",
            Self::Inspector => "Inspector",
            Self::Environment => "Environment",
            Self::Lights => "Lights",
            Self::Output => "Output",
            Self::Camera => "Camera",
            Self::Learn => "Learn",
            Self::Capture => "Capture",
        }
    }
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
