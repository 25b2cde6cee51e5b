//! Decodes a pixel of the HDR target: color, coverage and flags. `shaders/common/pixel.glsl` encodes it.

use serde_json::{Value, json};

use super::{Mode, Numbers};
use crate::interface::{FLAG_NO_DATA, FLAG_NOT_FINITE};
use crate::message::grouped;

/// Most samples per pixel for which the average still separates coverage and flags.
const MOST_SAMPLES: f32 = 8.0;
/// The contribution of a flag to the average if one sample has it.
const ONE_NO_DATA: f32 = FLAG_NO_DATA as f32 / MOST_SAMPLES;
const ONE_NOT_FINITE: f32 = FLAG_NOT_FINITE as f32 / MOST_SAMPLES;
/// Characters of a number in [`PixelValue::text`].
const NUMBER_WIDTH: usize = 10;

/// The value of a pixel in the picture or a debug mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelValue {
    /// Linear RGB times coverage, before exposure, and coverage, 0..1. The shader replaces NaN by 0 and infinity by the largest
    /// value of the HDR target.
    pub value: [f32; 4],
    /// Whether the mode has no data at one or more of the pixel's samples. The display shows a checkerboard there.
    pub no_data: bool,
    /// Whether the value is NaN or infinite at one or more of the pixel's samples.
    pub not_finite: bool,
}

impl PixelValue {
    /// Decodes a texel of the HDR target: one sample, or the average of up to 8.
    ///
    /// Coverage is exact unless a transparent surface is blended over a flag.
    pub fn decode([r, g, b, alpha]: [f32; 4]) -> Self {
        // The shaders of a tree that stores no flags may write NaN.
        if ![r, g, b, alpha].iter().all(|number| number.is_finite()) {
            return Self { value: [r, g, b, alpha.clamp(0.0, 1.0)], no_data: false, not_finite: true };
        }
        let not_finite = alpha >= ONE_NOT_FINITE;
        Self {
            value: [r, g, b, (alpha % ONE_NO_DATA).min(1.0)],
            no_data: alpha % ONE_NOT_FINITE >= ONE_NO_DATA && !not_finite,
            not_finite,
        }
    }

    /// The text of a value that was read on its own: one number per component of the mode, the unit, and whether the value is
    /// before exposure; or the meaning of its number; or `no data`; or `NaN`, which includes infinity. The width depends only on
    /// the mode.
    pub fn text(&self, mode: &Mode) -> String {
        match &mode.numbers {
            Some(numbers) => self.meaning(numbers),
            None => self.text_in_picture(mode),
        }
    }

    /// The text of a pixel's value in the frame. Unlike [`PixelValue::text`], this is a color where the display shows one for
    /// each number.
    pub fn text_in_picture(&self, mode: &Mode) -> String {
        match self.parts_in_picture(mode) {
            [text, unit] if unit.is_empty() => text,
            [text, unit] => format!("{text} {unit}"),
        }
    }

    /// The two parts of [`PixelValue::text_in_picture`]: numbers or words, and what follows them, such as the unit.
    pub fn parts_in_picture(&self, mode: &Mode) -> [String; 2] {
        if let Some(text) = self.words(mode) {
            return [text, String::new()];
        }
        let count = usize::from(mode.components).clamp(1, 3);
        let width = count * (NUMBER_WIDTH + 1) - 1;
        let of = match (mode.is_displayed, mode.tonemap) {
            (true, _) => "displayed",
            (false, true) => "before exposure",
            (false, false) => "",
        };
        let unit = [&mode.unit, of].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ");
        let words = match self {
            Self { not_finite: true, .. } => "NaN",
            Self { no_data: true, .. } => "no data",
            _ => {
                let numbers: Vec<String> = self.value[..count].iter().map(|number| text_of(*number)).collect();
                return [numbers.join(" "), unit];
            }
        };
        [format!("{words:>width$}"), " ".repeat(unit.chars().count())]
    }

    /// The JSON of a value that was read on its own: null is no data, "NaN" is not finite. A number with a meaning is an integer
    /// or a name; all others are RGB times coverage, and coverage.
    pub fn json(&self, mode: &Mode) -> Value {
        match (self, &mode.numbers) {
            (Self { not_finite: true, .. }, _) => json!("NaN"),
            (Self { no_data: true, .. }, _) => Value::Null,
            (_, None) => json!(self.value),
            _ if !self.is_covered() => Value::Null,
            (_, Some(Numbers::Index)) => json!(self.number()),
            (_, Some(Numbers::Names(names))) => match names.get(self.number() as usize) {
                // A sign, for example.
                Some(name) => name.parse::<i64>().map_or_else(|_| json!(name), |number| json!(number)),
                None => json!(self.number()),
            },
        }
    }

    /// Whether anything covers the pixel. Where nothing does, its color is 0 and has no meaning.
    fn is_covered(&self) -> bool {
        self.value[3] > 0.0
    }

    /// The number that a color of the display stands for.
    fn number(&self) -> u32 {
        self.value[0].round() as u32
    }

    /// The meaning of the number. Always of the same width.
    fn meaning(&self, numbers: &Numbers) -> String {
        let names: &[String] = if let Numbers::Names(names) = numbers { names } else { &[] };
        let width = names.iter().map(|name| name.chars().count()).fold(NUMBER_WIDTH, usize::max);
        let text = match self {
            Self { not_finite: true, .. } => "NaN".to_owned(),
            Self { no_data: true, .. } => "no data".to_owned(),
            _ if !self.is_covered() => "no data".to_owned(),
            _ => names.get(self.number() as usize).cloned().unwrap_or_else(|| self.number().to_string()),
        };
        format!("{text:>width$}")
    }

    /// The value in words, for units that read better so: `-2.1 EV`, `level 0`, `3 layers`, `1,024 texels/m`. Always of the same
    /// width.
    fn words(&self, mode: &Mode) -> Option<String> {
        let number = self.value[0];
        let (text, width) = match &*mode.unit {
            // Adding 0 takes the sign of -0 away.
            "EV" => (format!("{:+.1} EV", (number * 10.0).round() / 10.0 + 0.0), 8),
            "level" if (number - number.round()).abs() < 0.05 => (format!("level {:.0}", number.abs()), 10),
            "level" => (format!("level {number:.1}"), 10),
            "layers" if number.round() == 1.0 => ("1 layer".to_owned(), 12),
            "layers" => (format!("{number:.0} layers"), 12),
            "log2 texels/m" => (format!("{} texels/m", grouped(f64::from(number.exp2().min(1e9).round()))), 22),
            _ => return None,
        };
        let text = match self {
            Self { not_finite: true, .. } => "NaN".to_owned(),
            Self { no_data: true, .. } => "no data".to_owned(),
            _ => text,
        };
        Some(format!("{text:>width$}"))
    }
}

/// A number in [`NUMBER_WIDTH`] characters, with six significant digits. Uses powers of ten if fewer than three would be left.
fn text_of(number: f32) -> String {
    let magnitude = number.abs();
    if magnitude != 0.0 && !(1e-3..1e6).contains(&magnitude) {
        return format!("{number:>NUMBER_WIDTH$.3e}");
    }
    let digits_before = magnitude.max(1.0).log10() as usize;
    format!("{number:>NUMBER_WIDTH$.0$}", 5_usize.saturating_sub(digits_before))
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;
    use crate::shader::Encode;

    const NO_DATA: f32 = FLAG_NO_DATA as f32;
    const NOT_FINITE: f32 = FLAG_NOT_FINITE as f32;

    /// The average of samples, resolved to a half-float target.
    fn resolved(samples: &[f32]) -> f32 {
        let sum: f32 = samples.iter().map(|alpha| f16::from_f32(*alpha).to_f32()).sum();
        f16::from_f32(sum / samples.len() as f32).to_f32()
    }

    #[test]
    fn coverage_and_flags_are_read_from_any_mix_of_samples() {
        let kinds = [0.0, 1.0, 1.0 + NO_DATA, 1.0 + NOT_FINITE];
        for samples in [1_usize, 4] {
            for mix in 0..4_usize.pow(samples as u32) {
                let alphas: Vec<f32> = (0..samples).map(|i| kinds[mix / 4_usize.pow(i as u32) % 4]).collect();
                let found = PixelValue::decode([0.5, 0.25, 0.125, resolved(&alphas)]);
                let covered = alphas.iter().filter(|alpha| **alpha >= 1.0).count() as f32 / samples as f32;
                let not_finite = alphas.contains(&(1.0 + NOT_FINITE));
                let no_data = alphas.contains(&(1.0 + NO_DATA)) && !not_finite;
                let expected = PixelValue { value: [0.5, 0.25, 0.125, covered], no_data, not_finite };
                assert_eq!(found, expected, "{alphas:?}");
            }
        }
    }

    #[test]
    fn a_transparent_surface_over_a_flag_keeps_it() {
        for coverage in [0.1, 0.5, 0.85] {
            let over = |alpha: f32| PixelValue::decode([0.0, 0.0, 0.0, coverage + (1.0 - coverage) * alpha]);
            assert!(over(1.0 + NO_DATA).no_data && over(1.0 + NOT_FINITE).not_finite, "{coverage}");
            assert!(!over(1.0).no_data && !over(1.0).not_finite);
        }
    }

    #[test]
    fn numbers_that_are_stored_as_nan_are_not_finite() {
        assert!(PixelValue::decode([f32::NAN, 0.0, 0.0, 1.0]).not_finite);
        assert!(PixelValue::decode([0.0, f32::INFINITY, 0.0, 1.0]).not_finite);
    }

    fn mode(components: u8, unit: &str, tonemap: bool) -> Mode {
        Mode { components, unit: unit.to_owned(), tonemap, encode: Encode::Data, ..Mode::default() }
    }

    #[test]
    fn text_has_the_mode_s_components_and_unit() {
        let value = PixelValue { value: [0.5, -1.25, 12345.678, 1.0], ..PixelValue::default() };
        assert_eq!(value.text(&mode(1, "m", false)), "   0.50000 m");
        assert_eq!(value.text(&mode(2, "", false)), "   0.50000   -1.25000");
        let light = "   0.50000   -1.25000    12345.7 cd/m^2 before exposure";
        assert_eq!(value.text(&mode(3, "cd/m^2", true)), light);
        let absent = PixelValue { no_data: true, ..value };
        assert_eq!(absent.text(&mode(1, "m", false)), "   no data  ");
        let broken = PixelValue { not_finite: true, ..value };
        assert_eq!(broken.text(&mode(1, "", false)), "       NaN");
    }

    #[test]
    fn some_units_are_read_as_words() {
        let of = |unit: &str, number: f32| {
            PixelValue { value: [number; 4], ..PixelValue::default() }.text(&mode(1, unit, false))
        };
        assert_eq!([of("EV", -2.12).trim(), of("EV", -0.01).trim()], ["-2.1 EV", "+0.0 EV"]);
        assert_eq!(of("level", 0.01).trim(), "level 0");
        assert_eq!(of("level", 1.34).trim(), "level 1.3");
        assert_eq!(of("log2 texels/m", 10.0).trim(), "1,024 texels/m");
        assert_eq!(of("log2 texels/m", 4.0).trim(), "16 texels/m");
        assert_eq!([of("layers", 1.0).trim(), of("layers", 3.0).trim()], ["1 layer", "3 layers"]);
        let absent = PixelValue { no_data: true, ..PixelValue::default() };
        assert_eq!(absent.text(&mode(1, "EV", false)).trim(), "no data");
    }

    #[test]
    fn numbers_that_stand_for_something_say_so() {
        let of = |numbers: &Numbers, number: f32| {
            let mode = Mode { numbers: Some(numbers.clone()), ..mode(3, "", false) };
            let value = PixelValue { value: [number, number, number, 1.0], ..PixelValue::default() };
            (value.text(&mode).trim().to_owned(), value.json(&mode))
        };
        let told = |text: &str, json: Value| (text.to_owned(), json);
        let names = |names: &[&str]| Numbers::Names(names.iter().map(|name| (*name).to_owned()).collect());
        assert_eq!(of(&Numbers::Index, 1_234_567.0), told("1234567", json!(1_234_567)));
        assert_eq!(of(&names(&["front", "back"]), 1.0), told("back", json!("back")));
        assert_eq!(of(&names(&["-1", "+1"]), 1.0), told("+1", json!(1)));
        assert_eq!(of(&names(&["finite", "NaN"]), 1.0), told("NaN", json!("NaN")));
        assert_eq!(of(&names(&["front", "back"]), 7.0), told("7", json!(7)));
        let mode = Mode { numbers: Some(Numbers::Index), ..mode(3, "", false) };
        for absent in [PixelValue { no_data: true, ..PixelValue::default() }, PixelValue::default()] {
            assert_eq!((absent.text(&mode).trim(), absent.json(&mode)), ("no data", Value::Null));
        }
        // The display shows colors.
        let green = PixelValue { value: [0.0, 0.5, 0.0, 1.0], ..PixelValue::default() };
        assert_eq!(green.text_in_picture(&mode).split_whitespace().count(), 3);
    }

    #[test]
    fn text_is_as_wide_for_every_value() {
        let mode = mode(1, "1/sr", true);
        let of = |number: f32| PixelValue { value: [number; 4], ..PixelValue::default() }.text(&mode);
        let numbers = [0.0, -0.001, 999_999.9, -123_456.7, 1e6, -65504.0, 1e-38, -f32::MAX, 1.0 / 3.0];
        let mut widths: Vec<usize> = numbers.map(|number| of(number).chars().count()).to_vec();
        widths.push(PixelValue { no_data: true, ..PixelValue::default() }.text(&mode).chars().count());
        assert!(widths.iter().all(|width| *width == widths[0]), "{widths:?} {:?}", numbers.map(of));
    }
}
