//! The numbers of the settings as the panels and the command palette show them: name, unit, decimals and range.

use crate::settings::{Curve, Entry, Setting, Settings, Valid, Value};
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::{Constant, Parameter};

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
    pub(super) curve: Curve,
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
            curve: Curve::Linear,
            is_signed: false,
        }
    }

    /// The scale of a setting's number.
    pub(super) fn of(entry: &Entry) -> Self {
        let (low, high) = match entry.valid {
            Valid::Limits(low, high) => (f64::from(low), f64::from(high)),
            _ => (f64::from(f32::MIN), f64::from(f32::MAX)),
        };
        let is_negated = entry.slider.is_some_and(|slider| slider.is_negated);
        Self {
            slider: entry.slider.map(|slider| slider.ends),
            limits: if is_negated { (0.0 - high, 0.0 - low) } else { (low, high) },
            suffix: entry.unit.suffix.to_owned(),
            decimals: entry.slider.map_or(2, |slider| slider.decimals),
            curve: entry.slider.map_or(Curve::Linear, |slider| slider.curve),
            is_signed: is_negated,
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

/// A number of the settings: a setting, or one of the three numbers of a setting.
#[derive(Clone, Debug)]
pub(super) struct Number {
    setting: &'static Setting,
    /// Which of three numbers.
    axis: Option<usize>,
}

impl Number {
    /// The numbers of a setting: one, or three that have sliders. None for all other settings.
    pub(super) fn of(setting: &'static Setting) -> impl Iterator<Item = Self> {
        let axes: &'static [Option<usize>] = match setting.default {
            Value::Number(_) => &[None],
            Value::Numbers(_) if setting.entry.slider.is_some() => &[Some(0), Some(1), Some(2)],
            _ => &[],
        };
        axes.iter().map(move |axis| Self { setting, axis: *axis })
    }

    /// Path for `--set`.
    pub(super) fn path(&self) -> String {
        let path = &self.setting.path;
        self.axis.map_or_else(|| path.clone(), |axis| format!("{path}.{axis}"))
    }

    /// Name in its row.
    pub(super) fn name(&self) -> String {
        let label = self.setting.entry.label;
        self.axis.map_or_else(|| label.to_owned(), |axis| format!("{label} {}", ["X", "Y", "Z"][axis]))
    }

    /// Meaning, for the hover text.
    pub(super) fn doc(&self) -> &'static str {
        self.setting.entry.doc()
    }

    /// Whether the number changes the picture, with the other settings as they are.
    pub(super) fn is_used(&self, settings: &Settings) -> bool {
        settings.uses(self.setting.entry)
    }

    /// The number as its row shows it.
    pub(super) fn get(&self, settings: &Settings) -> f64 {
        // The shortest decimal text of an f32 is what the user typed.
        let number = self.option_value(settings).parse().unwrap_or_default();
        // 0.0 - 0.0 is 0, and -0.0 would show its sign.
        if self.is_negated() { 0.0 - number } else { number }
    }

    /// Sets the number from what its row shows.
    pub(super) fn set(&self, settings: &mut Settings, number: f64) {
        let number = if self.is_negated() { 0.0 - number } else { number };
        settings.set_value(&self.path(), &Value::Number(number as f32));
    }

    /// Whether the row shows the negative of the setting.
    fn is_negated(&self) -> bool {
        self.setting.entry.slider.is_some_and(|slider| slider.is_negated)
    }

    /// The setting as `--set` takes it.
    pub(super) fn option_value(&self, settings: &Settings) -> String {
        let default = match (&self.setting.default, self.axis) {
            (Value::Numbers(numbers), Some(axis)) => Value::Number(numbers[axis]),
            (default, _) => default.clone(),
        };
        // New settings have no added models.
        settings.value(&self.path()).unwrap_or(default).to_string()
    }

    /// Unit, decimals and range.
    pub(super) fn scale(&self) -> Scale {
        Scale::of(self.setting.entry)
    }

    /// Name without its row: `Light 2: azimuth`.
    pub(super) fn title(&self) -> String {
        title(self.setting, &self.name())
    }

    /// The panel in which its row is.
    pub(super) fn group(&self) -> &'static str {
        group(self.setting)
    }
}

/// The name of a setting without its row and panel. `label`: its name in the row.
pub(super) fn title(setting: &Setting, label: &str) -> String {
    let light =
        setting.path.strip_prefix("lights.orbit.").and_then(|rest| rest.split('.').next()?.parse::<usize>().ok());
    let group = match setting.group() {
        _ if !setting.entry.title.is_empty() => return setting.entry.title.to_owned(),
        _ if setting.path.starts_with("lights.ambient") => "Ambient light".to_owned(),
        "lights.rect" => "Rectangle".to_owned(),
        "environment" => "Environment".to_owned(),
        "material" => "Material override".to_owned(),
        "model" => "Model".to_owned(),
        _ => match light {
            Some(index) => format!("Light {}", index + 1),
            None => return label.to_owned(),
        },
    };
    format!("{group}: {}", label.to_lowercase())
}

/// The panel that has the row of a setting.
pub(super) fn group(setting: &Setting) -> &'static str {
    match setting.path.split_once('.') {
        Some(("environment", _)) => "Environment",
        Some(("lights", _)) => "Lights",
        Some(("view", _)) => "Output",
        Some(("camera", _)) => "Camera",
        _ => "Model",
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

/// The default of a constant; 0 or 1 for `bool`.
pub(super) fn default_of(constant: &Constant) -> f64 {
    match constant.scalar {
        Scalar::Float => f64::from(f32::from_bits(constant.default)),
        Scalar::Int => f64::from(constant.default.cast_signed()),
        Scalar::Uint | Scalar::Bool => f64::from(constant.default),
    }
}

/// The scale of a constant; `None` if it is no number.
pub(super) fn of_constant(constant: &Constant) -> Option<Scale> {
    let is_number = constant.scalar != Scalar::Bool && constant.choices.is_empty();
    is_number.then(|| Scale::declared(constant.range, &constant.unit, constant.scalar != Scalar::Float))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{catalog, setting};

    #[test]
    fn each_path_is_that_of_its_number() {
        let mut settings = Settings::of_window();
        for number in catalog().iter().flat_map(Number::of) {
            let path = number.path();
            settings.assign(&format!("{path}=0.25")).unwrap();
            let shown = if path == "view.ev" { -0.25 } else { 0.25 };
            assert_eq!(number.get(&settings), shown, "{path}");
            number.set(&mut settings, 2.0 * shown);
            let mut expected = settings.clone();
            expected.assign(&format!("{path}=0.5")).unwrap();
            assert_eq!(settings, expected, "{path}");
        }
    }

    #[test]
    fn titles_say_what_they_are_of() {
        let titles = |path: &str| Number::of(setting(path).unwrap()).map(|number| number.title()).collect::<Vec<_>>();
        assert_eq!(titles("lights.orbit.1.azimuth"), ["Light 2: azimuth"]);
        assert_eq!(titles("lights.rect.width"), ["Rectangle: width"]);
        assert_eq!(titles("lights.ambient_strength"), ["Ambient light: luminance"]);
        assert_eq!(titles("model.rotation"), ["Model: rotation x", "Model: rotation y", "Model: rotation z"]);
        assert_eq!(titles("view.ev"), ["Exposure"]);
        assert!(titles("view.msaa").is_empty());
    }

    #[test]
    fn numbers_are_shown_and_read_with_their_unit() {
        let exposure = Number::of(setting("view.ev").unwrap()).next().unwrap().scale();
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
