//! How values become colors on the display: the range of numbers, the channels and the colors that stand for a number.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::part::{Choice, SettingType};
use super::value::Value;

/// The range of values that the picture spreads over the display, `view.range`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum ViewRange {
    /// `mode`: as the mode stores its values. Data 0..1, vectors -1..1, light by exposure and tone map.
    #[default]
    Mode,
    /// `auto`: the range of the picture's values, in modes whose values have a unit or leave 0..1, and of a watched expression. Light
    /// stays exposed.
    Auto,
    /// `fit`: the range of the picture's values, in every mode.
    Fit,
    /// `LOW..HIGH`: this range, in every mode.
    Fixed(f32, f32),
}

impl FromStr for ViewRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<f32>().ok().filter(|number| number.is_finite());
        match text.trim() {
            "mode" => Ok(Self::Mode),
            "auto" => Ok(Self::Auto),
            "fit" => Ok(Self::Fit),
            other => match other.split_once("..").and_then(|(low, high)| Some((number(low)?, number(high)?))) {
                Some((low, high)) if low < high => Ok(Self::Fixed(low, high)),
                Some((low, high)) => Err(format!("the low end {low} of the range is not below its high end {high}")),
                None => Err("it can be mode, auto, fit or two numbers as 0..5".into()),
            },
        }
    }
}

impl fmt::Display for ViewRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mode => f.write_str("mode"),
            Self::Auto => f.write_str("auto"),
            Self::Fit => f.write_str("fit"),
            Self::Fixed(low, high) => write!(f, "{low}..{high}"),
        }
    }
}

impl TryFrom<String> for ViewRange {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl SettingType for ViewRange {
    const TAKES: &'static str = String::TAKES;

    fn value(&self) -> Value {
        Value::Text(self.to_string())
    }

    fn set(&mut self, value: &Value) {
        if let Value::Text(text) = value
            && let Ok(range) = text.parse()
        {
            *self = range;
        }
    }
}

impl From<ViewRange> for String {
    fn from(range: ViewRange) -> Self {
        range.to_string()
    }
}

/// The channels that the picture shows, `view.channels`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Channels {
    /// All three.
    #[default]
    Rgb,
    /// The first, as gray.
    R,
    /// The second, as gray.
    G,
    /// The third, as gray.
    B,
    /// Coverage, as gray.
    A,
}

impl Choice for Channels {}

impl Channels {
    /// The number in `Frame::channels`.
    pub(crate) fn id(self) -> u32 {
        self as u32
    }
}

/// The colors that stand for a number, `view.colormap`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Colormap {
    /// Gray, or the colors of the mode.
    #[default]
    None,
    /// Dark violet, green, yellow: even steps of lightness (van der Walt and Smith 2015, matplotlib).
    Viridis,
    /// Black, violet, orange, white: even steps of lightness (van der Walt and Smith 2015, matplotlib).
    Magma,
    /// Blue, green, red: many hues, for reading values (Mikhailov 2019).
    Turbo,
    /// Blue, gray, red: for errors around 0 (Moreland 2009).
    Coolwarm,
    /// Blue, cyan, green, yellow, red: false color.
    Heat,
}

impl Choice for Colormap {}

use crate::interface::COLORMAP_STEPS;

/// Samples of each colormap, sRGB.
const VIRIDIS: [u32; COLORMAP_STEPS] = [
    0x44_01_54, 0x48_18_6a, 0x47_2d_7b, 0x42_40_86, 0x3b_52_8b, 0x33_63_8d, 0x2c_72_8e, 0x26_82_8e, 0x21_91_8c,
    0x1f_a0_88, 0x28_ae_80, 0x3f_bc_73, 0x5e_c9_62, 0x84_d4_4b, 0xad_dc_30, 0xd8_e2_19, 0xfd_e7_25,
];
const MAGMA: [u32; COLORMAP_STEPS] = [
    0x00_00_04, 0x0a_08_22, 0x1d_11_47, 0x36_10_6b, 0x51_12_7c, 0x6a_1c_81, 0x83_26_81, 0x9c_2e_7f, 0xb7_37_79,
    0xd0_41_6f, 0xe7_52_63, 0xf5_6b_5c, 0xfc_89_61, 0xfe_a7_72, 0xfe_c4_88, 0xfd_e2_a3, 0xfc_fd_bf,
];
const TURBO: [u32; COLORMAP_STEPS] = [
    0x30_12_3b, 0x40_40_a2, 0x46_6b_e3, 0x42_94_ff, 0x28_bc_eb, 0x18_dd_c2, 0x32_f2_98, 0x6d_fe_62, 0xa4_fc_3c,
    0xcd_ec_34, 0xee_cf_3a, 0xfd_ac_34, 0xfb_7e_21, 0xeb_50_0e, 0xd0_2f_05, 0xa9_16_01, 0x7a_04_03,
];
const COOLWARM: [u32; COLORMAP_STEPS] = [
    0x3b_4c_c0, 0x4e_68_d8, 0x62_82_ea, 0x77_9a_f7, 0x8d_b0_fe, 0xa3_c2_fe, 0xb9_d0_f9, 0xcc_d9_ed, 0xdd_dc_dc,
    0xec_d3_c5, 0xf5_c4_ac, 0xf7_b0_93, 0xf4_98_7a, 0xeb_7d_62, 0xdd_5f_4b, 0xca_3b_37, 0xb4_04_26,
];

impl Colormap {
    /// Its colors at equal steps from 0 to 1, linear RGB; grays for [`Colormap::None`].
    pub fn colors(self) -> [[f32; 3]; COLORMAP_STEPS] {
        let table = match self {
            Self::None => return std::array::from_fn(|i| [linear_from_srgb(step(i)); 3]),
            // Each channel is a tent with a flat top. Its corners lie on the steps.
            Self::Heat => {
                let tent = |i: usize, peak: f32| (1.5 - (4.0 * step(i) - peak).abs()).clamp(0.0, 1.0);
                return std::array::from_fn(|i| [tent(i, 3.0), tent(i, 2.0), tent(i, 1.0)]);
            }
            Self::Viridis => &VIRIDIS,
            Self::Magma => &MAGMA,
            Self::Turbo => &TURBO,
            Self::Coolwarm => &COOLWARM,
        };
        table.map(|hex| [16, 8, 0].map(|shift| linear_from_srgb(((hex >> shift) & 255) as f32 / 255.0)))
    }
}

fn step(index: usize) -> f32 {
    index as f32 / (COLORMAP_STEPS - 1) as f32
}

/// sRGB electro-optical transfer function (IEC 61966-2-1): linear light from an encoded value, both 0..1.
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_read_as_it_is_written() {
        for text in ["mode", "auto", "fit", "0..1", "-2.5..7", "0.001..0.002"] {
            assert_eq!(text.parse::<ViewRange>().unwrap().to_string(), text);
        }
        for (text, words) in
            [("0..0", "not below"), ("5..1", "not below"), ("x", "mode, auto, fit"), ("0..inf", "0..5")]
        {
            assert!(text.parse::<ViewRange>().unwrap_err().contains(words), "{text}");
        }
    }

    #[test]
    fn heat_has_the_colors_of_false_color() {
        let colors = Colormap::Heat.colors();
        assert_eq!(colors[0], [0.0, 0.0, 0.5]);
        assert_eq!(colors[8], [0.5, 1.0, 0.5]);
        assert_eq!(colors[16], [0.5, 0.0, 0.0]);
    }
}
