//! Settings of the view: how the renderer turns radiance into a picture.

use serde::{Deserialize, Serialize};

use super::declare::settings;
use super::part::Choice;
use super::value_display::{Channels, Colormap, ViewRange, linear_from_srgb};
use crate::message::did_you_mean;

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
    Aces,
    /// Hill's approximation of ACES RRT + ODT.
    AcesHill,
    /// AgX.
    Agx,
    /// Khronos PBR Neutral.
    #[default]
    Neutral,
}

impl Choice for Tonemap {}

/// When a window draws previews of lower resolution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Adaptive {
    /// Where a whole picture takes long.
    #[default]
    Auto,
    /// Wherever they can be drawn.
    On,
    /// Never.
    Off,
}

impl Choice for Adaptive {}

/// Which statements and operations of the shaders the window checks on the device while the picture rests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Checks {
    /// None.
    Off,
    /// Those of `assert()` and `print()`.
    #[default]
    Assertions,
    /// Operations whose result GLSL leaves open as well.
    Undefined,
}

impl Choice for Checks {}

/// The default background. Modes that show data instead of light also use it if the background is `env`.
const BACKGROUND: &str = "#1b1d21";

settings! {
    /// How the renderer turns radiance into a picture.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ViewSettings {
        /// Exposure as EV100: light in cd/m² is multiplied by 1 / (1.2 × 2^EV100), so +1 is half as bright. The window shows the exposure
        /// compensation in stops, -EV100: there, +1 is twice as bright.
        ev: f32 = 0.7, limits(-30.0, 30.0) unit(EV100) row("Exposure") negated(-16.0, 16.0, 1);
        /// Curve that maps exposed light to the range of the display.
        tonemap: Tonemap, row("Tone map");
        /// Background behind the model: none (transparent), env (the environment), or a color as #rrggbb.
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
        /// Whether the window draws fewer pixels, with one sample each, while the camera, a slider or a light moves or an animation plays, and
        /// the whole picture once they rest. auto: where a picture takes longer than 50 ms; on: everywhere; off: nowhere. Captures, values
        /// of pixels and commands always see the whole picture.
        adaptive: Adaptive, row("Adaptive") title("Adaptive resolution");
        /// Layers of blended surfaces that are sorted in each pixel, from the farthest on (depth peeling), so that surfaces which intersect or
        /// interleave blend in the right order. 0 sorts whole primitives by their centers; so are surfaces in front of the last layer.
        blend_layers: u32, whole(0, 64) unit(LAYERS) row("Blend layers") title("Layers of blended surfaces");
        /// Frames that `render` averages in modes that accumulate.
        frames: u32 = 64, whole(1, 100_000) unit(FRAMES);
        /// Reflections of a random path after the first, in modes that trace the model. 0 leaves direct light.
        bounces: u32 = 4, whole(0, 64) unit(REFLECTIONS);
        /// Checks of the window while the picture rests. assertions: the `assert()` and `print()` of the shaders, if there are any;
        /// undefined: also operations whose result GLSL leaves open, such as division by 0; off: nothing. Pixels that fail are marked.
        checks: Checks, row("Checks") title("Checks of assertions and undefined operations");
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
