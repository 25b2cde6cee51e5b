//! The numbers of the settings as the panels and the command palette show them: name, unit, decimals and range.

use std::ops::RangeInclusive;

use crate::settings::{LightSource, Settings, limits};
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
    /// Whether equal steps of the slider are equal factors.
    pub(super) is_logarithmic: bool,
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
        let (is_logarithmic, is_negated) = (false, false);
        Self { path, light: 0, name, unit, slider, decimals, is_logarithmic, is_negated, doc, place, is_used: |_| true }
    }

    const fn when(mut self, is_used: fn(&Settings) -> bool) -> Self {
        self.is_used = is_used;
        self
    }

    const fn logarithmic(mut self) -> Self {
        self.is_logarithmic = true;
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
            _ => return self.name.to_owned(),
        };
        format!("{group}: {}", self.name.to_lowercase())
    }

    /// The panel in which its row is.
    pub(super) fn group(&self) -> &'static str {
        match self.path.split_once('.') {
            Some(("environment", _)) => "Environment",
            Some(("lights", _)) => "Lights",
            Some(("material", _)) => "Model",
            Some(("view", _)) => "Output",
            _ => "Camera",
        }
    }
}

const TURN: (f64, f64) = (-180.0, 180.0);
const WHOLE: (f64, f64) = (0.0, 1.0);
/// Unit of lengths around the model.
const RADII: &str = " R";

pub(super) static EXPOSURE: Number = Number::new(
    ("view.ev", "Exposure"),
    ((-16.0, 16.0), 1, " EV"),
    "Exposure compensation in stops: +1 is twice as bright. It is -EV100: light in cd/m² is multiplied by 1 / (1.2 × 2^EV100)",
    |settings, _| &mut settings.view.ev,
)
.negated();

pub(super) static FIELD_OF_VIEW: Number =
    Number::new(("camera.fovy", "Field of view"), ((5.0, 120.0), 0, "°"), "Vertical field of view", |settings, _| {
        &mut settings.camera.fovy
    });

pub(super) static ROTATION: Number = Number::new(
    ("environment.rotation", "Rotation"),
    (TURN, 0, "°"),
    "Rotation of the environment around +Y (Alt+drag)",
    |settings, _| &mut settings.environment.rotation,
)
.when(|settings| settings.environment.is_lit());
pub(super) static INTENSITY: Number = Number::new(
    ("environment.intensity", "Intensity"),
    ((0.0, 8.0), 2, "×"),
    "Factor on the map, whose values are cd/m²",
    |settings, _| &mut settings.environment.intensity,
)
.when(|settings| settings.environment.is_lit());
pub(super) static BLUR: Number = Number::new(
    ("environment.blur", "Blur"),
    (WHOLE, 2, ""),
    "Blur of the map behind the model, as a roughness: 0 is sharp",
    |settings, _| &mut settings.environment.blur,
)
.when(|settings| settings.environment.is_shown(&settings.view));

pub(super) static SPIN: Number = Number::new(
    ("lights.spin", "Orbit speed"),
    ((-90.0, 90.0), 0, "°/s"),
    "Speed of the orbiting lights around the model; 0 stops them (L)",
    |settings, _| &mut settings.lights.spin,
)
.when(has_orbit);
pub(super) static ORBIT: [Number; 4] = [
    Number::new(
        ("lights.orbit.*.strength", "Illuminance"),
        ((0.0, 60.0), 1, " lx"),
        "Illuminance at a distance of one model radius",
        |settings, light| &mut settings.lights.orbit[light].strength,
    )
    .when(has_orbit),
    Number::new(
        ("lights.orbit.*.distance", "Distance"),
        ((0.5, 10.0), 2, RADII),
        "Distance from the model's center, in radii of the model",
        |settings, light| &mut settings.lights.orbit[light].distance,
    )
    .logarithmic()
    .when(has_orbit),
    Number::new(
        ("lights.orbit.*.azimuth", "Azimuth"),
        ((-180.0, 360.0), 0, "°"),
        "Angle around +Y, from +Z towards +X",
        |settings, light| &mut settings.lights.orbit[light].azimuth,
    )
    .when(has_orbit),
    Number::new(
        ("lights.orbit.*.polar", "Polar angle"),
        ((0.0, 180.0), 0, "°"),
        "Angle from +Y",
        |settings, light| &mut settings.lights.orbit[light].polar,
    )
    .when(has_orbit),
];
pub(super) static RECTANGLE: [Number; 6] = [
    Number::new(
        ("lights.rect.strength", "Luminance"),
        ((0.0, 60.0), 1, " cd/m²"),
        "Luminance of a white rectangle. It does not depend on the size",
        |settings, _| &mut settings.lights.rect.strength,
    )
    .when(has_rectangle),
    Number::new(
        ("lights.rect.width", "Width"),
        ((0.01, 20.0), 2, RADII),
        "Length of the horizontal edges, in radii of the model",
        |settings, _| &mut settings.lights.rect.width,
    )
    .logarithmic()
    .when(has_rectangle),
    Number::new(
        ("lights.rect.height", "Height"),
        ((0.01, 20.0), 2, RADII),
        "Length of the other edges, in radii of the model",
        |settings, _| &mut settings.lights.rect.height,
    )
    .logarithmic()
    .when(has_rectangle),
    Number::new(
        ("lights.rect.distance", "Distance"),
        ((0.5, 10.0), 2, RADII),
        "Distance from the model's center, in radii of the model",
        |settings, _| &mut settings.lights.rect.distance,
    )
    .logarithmic()
    .when(has_rectangle),
    Number::new(
        ("lights.rect.azimuth", "Azimuth"),
        ((-180.0, 360.0), 0, "°"),
        "Angle around +Y, from +Z towards +X",
        |settings, _| &mut settings.lights.rect.azimuth,
    )
    .when(has_rectangle),
    Number::new(("lights.rect.polar", "Polar angle"), ((0.0, 180.0), 0, "°"), "Angle from +Y", |settings, _| {
        &mut settings.lights.rect.polar
    })
    .when(has_rectangle),
];
pub(super) static AMBIENT: Number = Number::new(
    ("lights.ambient_strength", "Luminance"),
    ((0.0, 2.0), 2, " cd/m²"),
    "Luminance of every direction. An environment replaces the ambient light",
    |settings, _| &mut settings.lights.ambient_strength,
)
.when(|settings| !settings.environment.is_lit());

pub(super) static MATERIAL: [Number; 3] = [
    Number::new(("material.metallic", "Metallic"), (WHOLE, 2, ""), "0 is a dielectric, 1 a metal", |settings, _| {
        &mut settings.material.metallic
    })
    .when(has_material),
    Number::new(("material.roughness", "Roughness"), (WHOLE, 2, ""), "Perceptual roughness", |settings, _| {
        &mut settings.material.roughness
    })
    .when(has_material),
    Number::new(
        ("material.anisotropy", "Anisotropy"),
        (WHOLE, 2, ""),
        "Strength of the anisotropy: 0 is isotropic",
        |settings, _| &mut settings.material.anisotropy,
    )
    .when(has_material),
];
pub(super) static DIRECTION: Number = Number::new(
    ("material.anisotropy_rotation", "Direction"),
    ((-90.0, 90.0), 0, "°"),
    "Direction of the anisotropy: angle from the tangent towards the bitangent",
    |settings, _| &mut settings.material.anisotropy_rotation,
)
.when(|settings| has_material(settings) && settings.material.anisotropy > 0.0);

fn has_orbit(settings: &Settings) -> bool {
    settings.lights.source == LightSource::Orbit
}

fn has_rectangle(settings: &Settings) -> bool {
    settings.lights.rect.enabled && settings.lights.source != LightSource::None
}

fn has_material(settings: &Settings) -> bool {
    settings.material.enabled
}

/// All numbers of the settings, in the order of the panels.
pub(super) fn all(settings: &Settings) -> impl Iterator<Item = Number> {
    let lights = 0..settings.lights.orbit.len();
    let orbit = lights.flat_map(|light| ORBIT.iter().map(move |number| number.of_light(light)));
    let first = [&EXPOSURE, &FIELD_OF_VIEW, &ROTATION, &INTENSITY, &BLUR, &SPIN].into_iter().cloned();
    let last = RECTANGLE.iter().chain([&AMBIENT]).chain(&MATERIAL).chain([&DIRECTION]).cloned();
    first.chain(orbit).chain(last)
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
            assert!(catalog().iter().any(|setting| setting.path == path), "{path}");
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
