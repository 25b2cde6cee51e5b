//! The description of one setting, apart from its type and value: meaning, valid values, unit, and its row in a panel.

use super::value::Value;
use crate::message::either;

/// The entry of a setting. It is declared with the setting's field by `settings!`; panels, command palette, `--set`, `specula help set`
/// and the manual read it from there.
#[derive(Debug)]
pub struct Entry {
    doc: &'static str,
    /// Valid values.
    pub valid: Valid,
    /// Unit or color space.
    pub unit: Unit,
    /// Name of its row in a panel; empty for a setting without a row.
    pub label: &'static str,
    /// Name outside of its panel, where the label does not say enough; otherwise empty.
    pub title: &'static str,
    /// How its number is shown in the row. A list of numbers with a slider has a row for each of them; without one, it is a color.
    pub slider: Option<Slider>,
    /// Names and values of choices, for a setting that takes more than them.
    pub choices: &'static [(&'static str, &'static str)],
    /// When the setting changes the picture.
    pub(super) used: When,
}

/// Valid values of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Valid {
    /// All values of its type.
    Any,
    /// Smallest and largest value of a number, or of each of its numbers.
    Limits(f32, f32),
    /// Smallest and largest value of a whole number.
    Whole(u32, u32),
    /// A few whole numbers.
    OneOf(&'static [u32]),
    /// A description. The type of the setting refuses the rest.
    Words(&'static str),
}

/// A condition on other settings.
#[derive(Clone, Copy, Debug)]
pub(super) enum When {
    Always,
    /// The setting at a path has this value, as `--set` takes it. A list of names has this name.
    Is(&'static str, &'static str),
    /// The setting at a path has another value.
    Not(&'static str, &'static str),
    /// All hold.
    All(&'static [When]),
    /// At least one holds.
    Any(&'static [When]),
}

impl When {
    /// Whether it holds. `value`: the value at a path.
    pub(super) fn holds(self, value: &dyn Fn(&str) -> Option<Value>) -> bool {
        let is = |path, text| value(path).is_some_and(|value| value.is(text));
        match self {
            Self::Always => true,
            Self::Is(path, text) => is(path, text),
            Self::Not(path, text) => !is(path, text),
            Self::All(conditions) => conditions.iter().all(|condition| condition.holds(value)),
            Self::Any(conditions) => conditions.iter().any(|condition| condition.holds(value)),
        }
    }
}

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Name in lists; empty for pure numbers.
    pub name: &'static str,
    /// Text behind a number in a panel, with a space in front where the unit needs one.
    pub suffix: &'static str,
}

/// Units of settings.
pub(super) mod unit {
    use super::Unit;

    pub(in crate::settings) const NONE: Unit = Unit { name: "", suffix: "" };
    pub(in crate::settings) const FACTOR: Unit = Unit { name: "", suffix: "×" };
    pub(in crate::settings) const DEGREES: Unit = Unit { name: "degrees", suffix: "°" };
    pub(in crate::settings) const DEGREES_PER_SECOND: Unit = Unit { name: "degrees/s", suffix: "°/s" };
    pub(in crate::settings) const SECONDS: Unit = Unit { name: "seconds", suffix: " s" };
    pub(in crate::settings) const METERS: Unit = Unit { name: "meters", suffix: " m" };
    pub(in crate::settings) const NANOMETERS: Unit = Unit { name: "nm", suffix: " nm" };
    /// Radii of the model's bounding sphere.
    pub(in crate::settings) const RADII: Unit = Unit { name: "radii", suffix: " R" };
    /// Candela for a model with a radius of 1 m, which is the illuminance at a distance of one radius.
    pub(in crate::settings) const CANDELA: Unit = Unit { name: "candela", suffix: " lx" };
    pub(in crate::settings) const ILLUMINANCE: Unit = Unit { name: "lux", suffix: " lx" };
    pub(in crate::settings) const LUMINANCE: Unit = Unit { name: "cd/m^2", suffix: " cd/m²" };
    pub(in crate::settings) const EV100: Unit = Unit { name: "EV100", suffix: " EV" };
    pub(in crate::settings) const LINEAR_RGB: Unit = Unit { name: "linear RGB", suffix: "" };
    pub(in crate::settings) const SAMPLES: Unit = Unit { name: "samples", suffix: "×" };
    pub(in crate::settings) const FRAMES: Unit = Unit { name: "frames", suffix: "" };
    pub(in crate::settings) const LAYERS: Unit = Unit { name: "layers", suffix: "" };
    pub(in crate::settings) const REFLECTIONS: Unit = Unit { name: "reflections", suffix: "" };
    pub(in crate::settings) const MEBIBYTES: Unit = Unit { name: "MiB", suffix: " MiB" };
}

/// The slider of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    /// Both ends.
    pub ends: (f64, f64),
    /// Decimals of the number.
    pub decimals: usize,
    /// How a place on the slider becomes the number.
    pub curve: Curve,
    /// Whether the row shows the negative of the setting.
    pub is_negated: bool,
}

/// How a place on a slider becomes the number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curve {
    /// Equal steps are equal differences.
    #[default]
    Linear,
    /// Equal steps are equal factors.
    Logarithmic,
    /// The number is the square of the place.
    Squared,
}

impl Entry {
    /// A setting that takes all values of its type and has no row. `doc`: its effect.
    pub(super) const fn new(doc: &'static str) -> Self {
        Self {
            doc,
            valid: Valid::Any,
            unit: unit::NONE,
            label: "",
            title: "",
            slider: None,
            choices: &[],
            used: When::Always,
        }
    }

    pub(super) const fn limits(self, low: f32, high: f32) -> Self {
        Self { valid: Valid::Limits(low, high), ..self }
    }

    pub(super) const fn whole(self, low: u32, high: u32) -> Self {
        Self { valid: Valid::Whole(low, high), ..self }
    }

    pub(super) const fn one_of(self, values: &'static [u32]) -> Self {
        Self { valid: Valid::OneOf(values), ..self }
    }

    pub(super) const fn words(self, words: &'static str) -> Self {
        Self { valid: Valid::Words(words), ..self }
    }

    pub(super) const fn unit(self, unit: Unit) -> Self {
        Self { unit, ..self }
    }

    pub(super) const fn row(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    pub(super) const fn title(self, title: &'static str) -> Self {
        Self { title, ..self }
    }

    pub(super) const fn choices(self, choices: &'static [(&'static str, &'static str)]) -> Self {
        Self { choices, ..self }
    }

    pub(super) const fn when(self, used: When) -> Self {
        Self { used, ..self }
    }

    pub(super) const fn slider(self, low: f64, high: f64, decimals: usize) -> Self {
        let slider = Slider { ends: (low, high), decimals, curve: Curve::Linear, is_negated: false };
        Self { slider: Some(slider), ..self }
    }

    pub(super) const fn logarithmic(self, low: f64, high: f64, decimals: usize) -> Self {
        let slider = Slider { ends: (low, high), decimals, curve: Curve::Logarithmic, is_negated: false };
        Self { slider: Some(slider), ..self }
    }

    pub(super) const fn squared(self, low: f64, high: f64, decimals: usize) -> Self {
        let slider = Slider { ends: (low, high), decimals, curve: Curve::Squared, is_negated: false };
        Self { slider: Some(slider), ..self }
    }

    pub(super) const fn negated(self, low: f64, high: f64, decimals: usize) -> Self {
        let slider = Slider { ends: (low, high), decimals, curve: Curve::Linear, is_negated: true };
        Self { slider: Some(slider), ..self }
    }

    /// The effect of the setting, without a full stop at the end.
    pub fn doc(&self) -> &'static str {
        self.doc.trim().trim_end_matches('.')
    }

    /// Checks a value of the setting at `path`.
    pub(super) fn check(&self, path: &str, value: &Value) -> Result<(), String> {
        let refuse = |path: &str, value: &dyn std::fmt::Display| {
            Err(format!("{path} is {value}; it can be {}", self.valid.text()))
        };
        match (self.valid, value) {
            (Valid::Limits(low, high), Value::Number(number)) if !(low..=high).contains(number) => refuse(path, number),
            (Valid::Limits(low, high), Value::Numbers(numbers)) => {
                match numbers.iter().enumerate().find(|(_, number)| !(low..=high).contains(*number)) {
                    Some((index, number)) => refuse(&format!("{path}.{index}"), number),
                    None => Ok(()),
                }
            }
            (Valid::Whole(low, high), Value::Whole(number)) if !(low..=high).contains(number) => refuse(path, number),
            (Valid::OneOf(values), Value::Whole(number)) if !values.contains(number) => refuse(path, number),
            _ => Ok(()),
        }
    }
}

impl Valid {
    /// The valid values in words, as `0 to 1`; empty if all values of the type are valid.
    pub fn text(self) -> String {
        let number = |x: f32| if x.abs() >= 1e4 { format!("{x:e}") } else { x.to_string() };
        match self {
            Self::Any => String::new(),
            Self::Limits(low, high) => format!("{} to {}", number(low), number(high)),
            Self::Whole(low, high) => format!("{low} to {high}"),
            Self::OneOf(values) => either(values),
            Self::Words(words) => words.to_owned(),
        }
    }
}
