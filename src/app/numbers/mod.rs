//! The numbers of the settings as the panels and the command palette show them: name, unit, decimals and range.

mod list;

use std::ops::RangeInclusive;

use crate::settings::{Settings, limits};
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::{Constant, Parameter};
pub(super) use list::{
    AMBIENT, BLUR, DIRECTION, EXPOSURE, FIELD_OF_VIEW, INTENSITY, MATERIAL, ORBIT, RECTANGLE, ROTATION, SPIN,
    TRANSFORM, all,
};

/// How a number is shown and what it can be.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    /// Ends of the slider; `None` for a number without one.
    pub(super) slider: Option<(f64, f64)>,
    /// Smallest and largest valid value.
    pub(super) limits: (f64, f64),
    /// Text behind the number, with a space in front where the unit needs one.
    pub(super) suffix: String,
    pub(super) decimals: usize,
    /// Whether equal steps of the slider are equal factors.
    pub(super) is_logarithmic: bool,
    /// Whether the number is the square of the place on the slider.
    pub(super) is_squared: bool,
    /// Whether a positive number has its sign.
    pub(super) is_signed: bool,
}

impl Scale {
    /// The scale of a number that a shader tree declares.
    fn declared(range: Option<(f64, f64)>, unit: &str, is_whole: bool) -> Self {
        let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let limits = range.unwrap_or((f64::MIN, f64::MAX));
        Self {
            slider: range,
            limits,
            suffix,
            decimals: if is_whole { 0 } else { decimals(range) },
            is_logarithmic: false,
            is_squared: false,
            is_signed: false,
        }
    }

    /// The number with its unit.
    pub(super) fn text(&self, number: f64) -> String {
        // Without the sum, a number that rounds to 0 from below has a sign.
        let digits = 10_f64.powi(self.decimals as i32);
        let rounded = (number * digits).round() / digits + 0.0;
        let (sign, decimals) = (if self.is_signed && rounded >= 0.0 { "+" } else { "" }, self.decimals);
        format!("{sign}{rounded:.decimals$}{}", self.suffix)
    }

    /// The number that a user types, with or without its unit.
    ///
    /// # Errors
    /// A message, if the text is no number or the number is outside of the limits.
    pub(super) fn parse(&self, text: &str) -> Result<f64, String> {
        let text = text.trim();
        let plain = text.strip_suffix(self.suffix.trim()).unwrap_or(text).trim_end();
        let number = plain.parse::<f64>().ok().filter(|number| number.is_finite());
        let number = number.ok_or_else(|| format!("`{text}` is not a number"))?;
        let (low, high) = self.limits;
        let is_valid = (low..=high).contains(&number);
        if is_valid { Ok(number) } else { Err(format!("It can be {}", self.told((low, high)))) }
    }

    /// The range of the slider in words.
    pub(super) fn range_text(&self) -> String {
        self.slider.map_or_else(|| "any number".to_owned(), |range| self.told(range))
    }

    fn told(&self, (low, high): (f64, f64)) -> String {
        let end =
            |number: f64| if number.abs() < 1e4 { self.text(number) } else { format!("{number:e}{}", self.suffix) };
        format!("{} to {}", end(low), end(high))
    }
}

/// Decimals with which a slider over this range has at least a hundred steps: 2 or more.
fn decimals(range: Option<(f64, f64)>) -> usize {
    let span = range.map_or(1.0, |(low, high)| high - low);
    (2.0 - span.max(1e-6).log10()).ceil().clamp(2.0, 6.0) as usize
}

/// A number of the settings.
#[derive(Clone)]
pub(super) struct Number {
    /// Path for `--set`. A `*` stands for the index of an orbiting light.
    path: &'static str,
    light: usize,
    /// Name in its row.
    pub(super) name: &'static str,
    /// Suffix of the number.
    unit: &'static str,
    /// Ends of the slider.
    slider: (f64, f64),
    decimals: usize,
    is_logarithmic: bool,
    is_squared: bool,
    /// Whether the row shows the negative of the setting.
    is_negated: bool,
    /// Meaning, for the hover text.
    pub(super) doc: &'static str,
    place: fn(&mut Settings, usize) -> &mut f32,
    /// Whether the number changes the picture.
    is_used: fn(&Settings) -> bool,
}

impl Number {
    const fn new(
        (path, name): (&'static str, &'static str),
        (slider, decimals, unit): ((f64, f64), usize, &'static str),
        doc: &'static str,
        place: fn(&mut Settings, usize) -> &mut f32,
    ) -> Self {
        let (is_logarithmic, is_squared, is_negated, is_used) =
            (false, false, false, (|_| true) as fn(&Settings) -> bool);
        let light = 0;
        Self { path, light, name, unit, slider, decimals, is_logarithmic, is_squared, is_negated, doc, place, is_used }
    }

    const fn when(mut self, is_used: fn(&Settings) -> bool) -> Self {
        self.is_used = is_used;
        self
    }

    const fn logarithmic(mut self) -> Self {
        self.is_logarithmic = true;
        self
    }

    const fn squared(mut self) -> Self {
        self.is_squared = true;
        self
    }

    const fn negated(mut self) -> Self {
        self.is_negated = true;
        self
    }

    /// This number of the orbiting light with this index.
    pub(super) fn of_light(&self, light: usize) -> Self {
        Self { light, ..self.clone() }
    }

    /// Path for `--set`.
    pub(super) fn path(&self) -> String {
        self.path.replace('*', &self.light.to_string())
    }

    /// Whether the number changes the picture, with the other settings as they are.
    pub(super) fn is_used(&self, settings: &Settings) -> bool {
        (self.is_used)(settings)
    }

    /// The number as its row shows it.
    pub(super) fn get(&self, settings: &mut Settings) -> f64 {
        // The shortest decimal text of an f32 is what the user typed.
        let value = *(self.place)(settings, self.light);
        let number = value.to_string().parse().unwrap_or(f64::from(value));
        // 0.0 - 0.0 is 0, and -0.0 would show its sign.
        if self.is_negated { 0.0 - number } else { number }
    }

    /// Sets the number from what its row shows.
    pub(super) fn set(&self, settings: &mut Settings, number: f64) {
        *(self.place)(settings, self.light) = (if self.is_negated { 0.0 - number } else { number }) as f32;
    }

    /// The setting as `--set` takes it.
    pub(super) fn option_value(&self, settings: &mut Settings) -> String {
        (self.place)(settings, self.light).to_string()
    }

    /// Unit, decimals and range.
    pub(super) fn scale(&self) -> Scale {
        let limits: RangeInclusive<f32> = limits(&self.path()).unwrap_or(f32::MIN..=f32::MAX);
        let (low, high) = (f64::from(*limits.start()), f64::from(*limits.end()));
        Scale {
            slider: Some(self.slider),
            limits: if self.is_negated { (0.0 - high, 0.0 - low) } else { (low, high) },
            suffix: self.unit.to_owned(),
            decimals: self.decimals,
            is_logarithmic: self.is_logarithmic,
            is_squared: self.is_squared,
            is_signed: self.is_negated,
        }
    }

    /// Name without its row: `Light 2: azimuth`.
    pub(super) fn title(&self) -> String {
        let group = match self.path.split_once('.') {
            _ if self.path.starts_with("lights.orbit") => format!("Light {}", self.light + 1),
            _ if self.path.starts_with("lights.rect") => "Rectangle".to_owned(),
            _ if self.path.starts_with("lights.ambient") => "Ambient light".to_owned(),
            Some(("environment", _)) => "Environment".to_owned(),
            Some(("material", _)) => "Material override".to_owned(),
            Some(("model", _)) => "Model".to_owned(),
            _ => return self.name.to_owned(),
        };
        format!("{group}: {}", self.name.to_lowercase())
    }

    /// The panel in which its row is.
    pub(super) fn group(&self) -> &'static str {
        match self.path.split_once('.') {
            Some(("environment", _)) => "Environment",
            Some(("lights", _)) => "Lights",
            Some(("material" | "model", _)) => "Model",
            Some(("view", _)) => "Output",
            _ => "Camera",
        }
    }
}

/// The scale of a parameter; `None` if it is no single number.
pub(super) fn of_parameter(parameter: &Parameter) -> Option<Scale> {
    let is_number = matches!(parameter.kind, ParameterType::Float | ParameterType::Int | ParameterType::Uint);
    (is_number && parameter.choices.is_empty()).then(|| component(parameter))
}

/// The scale of each component of a parameter.
pub(super) fn component(parameter: &Parameter) -> Scale {
    let is_whole = matches!(parameter.kind, ParameterType::Int | ParameterType::Uint);
    Scale::declared(parameter.range, &parameter.unit, is_whole)
}

/// The scale of a constant; `None` if it is no number.
pub(super) fn of_constant(constant: &Constant) -> Option<Scale> {
    let is_number = constant.scalar != Scalar::Bool && constant.choices.is_empty();
    is_number.then(|| Scale::declared(constant.range, &constant.unit, constant.scalar != Scalar::Float))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::catalog;

    #[test]
    fn each_path_is_that_of_its_number() {
        let mut settings = Settings::of_window();
        for number in all(&settings.clone()) {
            let path = number.path();
            // One of several numbers has the path of all, and its index.
            let whole = path.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('.');
            assert!(catalog().iter().any(|setting| setting.path == path || setting.path == whole), "{path}");
            settings.assign(&format!("{path}=0.25")).unwrap();
            let shown = if path == "view.ev" { -0.25 } else { 0.25 };
            assert_eq!(number.get(&mut settings), shown, "{path}");
            number.set(&mut settings, 2.0 * shown);
            let mut expected = settings.clone();
            expected.assign(&format!("{path}=0.5")).unwrap();
            assert_eq!(settings, expected, "{path}");
        }
    }

    #[test]
    fn the_ends_of_every_slider_are_valid() {
        for number in all(&Settings::default()) {
            let Scale { slider, limits: (low, high), .. } = number.scale();
            let (first, last) = slider.unwrap();
            assert!(low <= first && first < last && last <= high, "{}", number.path());
            assert!(!number.doc.is_empty() && number.title().starts_with(char::is_uppercase), "{}", number.path());
        }
    }

    #[test]
    fn numbers_are_shown_and_read_with_their_unit() {
        let exposure = EXPOSURE.scale();
        assert_eq!([0.0, -0.04, 1.5, -30.0].map(|n| exposure.text(n)), ["+0.0 EV", "+0.0 EV", "+1.5 EV", "-30.0 EV"]);
        assert_eq!(["1.5", " -2 EV", "+3EV"].map(|text| exposure.parse(text)), [Ok(1.5), Ok(-2.0), Ok(3.0)]);
        for (text, words) in [("x", "`x` is not a number"), ("31", "-30.0 EV to +30.0 EV"), ("nan", "not a number")] {
            assert!(exposure.parse(text).unwrap_err().contains(words), "{text}");
        }
        let declared = Scale::declared(Some((0.0, 0.5)), "mm", false);
        assert_eq!((declared.text(0.1), declared.range_text()), ("0.100 mm".into(), "0.000 mm to 0.500 mm".into()));
        assert_eq!(Scale::declared(None, "", true).text(3.0), "3");
        assert_eq!(Scale::declared(Some((-2.0, 2.0)), "", false).text(1.0), "1.00");
    }
}
