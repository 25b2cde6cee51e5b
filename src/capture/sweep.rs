//! `PATH=VALUES`: a setting or a parameter of the shaders, and the values that a sheet shows of it.

use crate::scene::environment::BUILT_IN;
use crate::session::Session;
use crate::settings::{MaterialChannel, Setting, Settings, Valid, setting};
use crate::shader::spirv::reflect::Scalar;

/// Values of a range without a count.
const STEPS: u32 = 5;
/// Most values of a range.
const MOST_STEPS: u32 = 1000;

/// A setting and the values that it takes one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    path: String,
    values: Values,
}

#[derive(Clone, Debug, PartialEq)]
enum Values {
    /// All names that it takes, or its whole range.
    All,
    List(Vec<String>),
    /// So many numbers at equal distances.
    Range(f64, f64, u32),
}

/// The kinds of values of a setting.
#[derive(Default)]
struct Takes {
    title: String,
    unit: String,
    names: Vec<String>,
    range: Option<(f64, f64)>,
    is_whole: bool,
}

impl Sweep {
    /// Reads `PATH=a,b`, `PATH=0..1`, `PATH=0..1/9` or `PATH`. Values that have commas are separated by semicolons.
    ///
    /// # Errors
    /// No path, no value, or a range without a sense.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (path, values) = text.split_once('=').map_or((text, None), |(path, values)| (path, Some(values.trim())));
        let path = path.trim().to_owned();
        if path.is_empty() || values == Some("") {
            return Err("expected PATH=VALUES, as material.roughness=0..1 or view.tonemap=aces,neutral".to_owned());
        }
        let Some(values) = values else { return Ok(Self { path, values: Values::All }) };
        if let Some((low, high)) = values.split_once("..") {
            let (high, steps) = high.split_once('/').map_or((high, Some(STEPS)), |(high, n)| (high, n.parse().ok()));
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
            if let (Some(low), Some(high)) = (number(low), number(high)) {
                let steps = steps.filter(|steps| (2..=MOST_STEPS).contains(steps));
                let steps = steps.ok_or_else(|| format!("expected LOW..HIGH/COUNT with 2 to {MOST_STEPS} values"))?;
                return Ok(Self { path, values: Values::Range(low, high, steps) });
            }
        }
        let separator = if values.contains(';') { ';' } else { ',' };
        let list = values.split(separator).map(|value| value.trim().to_owned()).collect();
        Ok(Self { path, values: Values::List(list) })
    }

    /// The values, as `--set` takes them.
    ///
    /// # Errors
    /// The setting has no list of values of its own, and none was given.
    pub(super) fn values(&self, session: &Session) -> Result<Vec<String>, String> {
        let takes = self.takes(session);
        let (low, high, steps) = match &self.values {
            Values::List(list) => return Ok(list.clone()),
            Values::All if !takes.names.is_empty() => return Ok(takes.names),
            Values::Range(low, high, steps) => (*low, *high, *steps),
            Values::All => {
                let missing = || format!("{0} needs values, as `--sweep {0}=a,b` or `--sweep {0}=0..1`", self.path);
                let (low, high) = takes.range.ok_or_else(missing)?;
                (low, high, STEPS)
            }
        };
        let numbers = (0..steps).map(|step| {
            let number = low + (high - low) * f64::from(step) / f64::from(steps - 1);
            if takes.is_whole { number.round() } else { (number * 1e6).round() * 1e-6 }
        });
        let mut values: Vec<String> = numbers.map(|number| (number as f32).to_string()).collect();
        values.dedup();
        Ok(values)
    }

    /// Sets a value. A channel of the material override replaces that of all materials.
    ///
    /// # Errors
    /// The setting does not exist or cannot have this value.
    pub(super) fn apply(&self, settings: &mut Settings, value: &str) -> Result<(), String> {
        let channel = self.path.strip_prefix("material.");
        let channel = MaterialChannel::ALL.into_iter().find(|known| channel == Some(known.name()));
        if let Some(channel) = channel.filter(|channel| !settings.material.replaces(*channel)) {
            settings.material.channels.set(channel, true);
        }
        settings.assign(&format!("{}={value}", self.path)).map_err(|problem| format!("--sweep: {problem}"))?;
        settings.check()
    }

    /// The caption of a picture: the setting with its value and unit, and the value with its unit alone.
    pub(super) fn label(&self, value: &str, session: &Session) -> [String; 2] {
        let takes = self.takes(session);
        let short = format!("{value}{}", takes.unit);
        [format!("{} {short}", takes.title), short]
    }

    fn takes(&self, session: &Session) -> Takes {
        let shaders = session.shaders.clone().unwrap_or_default();
        let constant = shaders.constants.iter().find(|constant| constant.name == self.path);
        let parameter = shaders.parameters.iter().find(|parameter| parameter.name == self.path);
        let of_tree = |title: &str, unit: &str, choices: &[(String, i64)], scalar, range: Option<(f64, f64)>| Takes {
            title: title.to_owned(),
            unit: if unit.is_empty() { String::new() } else { format!(" {unit}") },
            names: match scalar {
                Scalar::Bool => ["false", "true"].map(str::to_owned).to_vec(),
                _ => choices.iter().map(|(name, _)| name.clone()).collect(),
            },
            range,
            is_whole: matches!(scalar, Scalar::Int | Scalar::Uint),
        };
        match (constant, parameter, setting(&self.path)) {
            (Some(own), ..) => of_tree(&own.label, "", &own.choices, own.scalar, own.range),
            (_, Some(own), _) => of_tree(&own.label, &own.unit, &own.choices, own.kind.scalar(), own.range),
            (.., Some(setting)) => of_setting(setting, session),
            _ => Takes { title: self.path.clone(), ..Takes::default() },
        }
    }
}

fn of_setting(setting: &Setting, session: &Session) -> Takes {
    let entry = setting.entry;
    let names = match (setting.path.as_str(), setting.takes) {
        ("environment.name", _) => BUILT_IN.map(str::to_owned).to_vec(),
        ("variant", _) => session.model().map(|model| model.variants.to_vec()).unwrap_or_default(),
        (_, "true or false") => ["false", "true"].map(str::to_owned).to_vec(),
        _ => setting.names.clone(),
    };
    let range = match (entry.slider, entry.valid) {
        (Some(slider), _) if !slider.is_negated => Some(slider.ends),
        (_, Valid::Limits(low, high)) => Some((low.into(), high.into())),
        _ => None,
    };
    // A row of the window shows the negative of such a setting.
    let is_negated = entry.slider.is_some_and(|slider| slider.is_negated);
    let title = [entry.title, entry.label].into_iter().find(|title| !title.is_empty() && !is_negated);
    Takes {
        title: title.unwrap_or(&setting.path).to_owned(),
        unit: entry.unit.suffix.to_owned(),
        names,
        range: range.filter(|_| setting.takes.ends_with("number")),
        is_whole: setting.takes == "whole number",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Result<Vec<String>, String> {
        Sweep::parse(text)?.values(&Session::default())
    }

    #[test]
    fn a_sweep_is_a_list_a_range_or_all_there_is() {
        assert_eq!(values("material.roughness=0..1").unwrap(), ["0", "0.25", "0.5", "0.75", "1"]);
        assert_eq!(values("camera.fovy = 20..50/4").unwrap(), ["20", "30", "40", "50"]);
        assert_eq!(values("view.frames=1..3/5").unwrap(), ["1", "2", "3"]);
        assert_eq!(values("view.tonemap=aces, agx").unwrap(), ["aces", "agx"]);
        assert_eq!(values("material.base_color=1,0,0;0,1,0").unwrap(), ["1,0,0", "0,1,0"]);
        assert_eq!(values("view.wireframe").unwrap(), ["false", "true"]);
        assert!(values("view.tonemap").unwrap().contains(&"neutral".to_owned()));
        assert_eq!(values("environment.name").unwrap(), BUILT_IN);
        assert_eq!(values("material.metallic").unwrap().len(), 5);
        assert!(values("camera.eye").unwrap_err().contains("needs values"));
        assert!(values("a=0..1/1").unwrap_err().contains("2 to 1000"));
        assert!(Sweep::parse("=1").is_err() && Sweep::parse("a=").is_err());
    }

    #[test]
    fn a_channel_of_the_material_is_replaced_where_it_is_swept() {
        let mut settings = Settings::default();
        Sweep::parse("material.roughness").unwrap().apply(&mut settings, "0.25").unwrap();
        assert!(settings.material.channels.has(MaterialChannel::Roughness) && settings.material.roughness == 0.25);
        assert!(Sweep::parse("view.tonmap").unwrap().apply(&mut settings, "x").unwrap_err().contains("view.tonemap"));
    }
}
