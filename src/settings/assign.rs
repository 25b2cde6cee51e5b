//! `path=value`, as `--set` takes it.

use super::catalog::{self, setting};
use super::value::Value;
use super::{Settings, factors};
use crate::message::{did_you_mean, either};

/// Before the name of a material.
const MATERIALS: &str = "materials.";
/// Where the list of all settings is.
const SEE: &str = "(see `specula help set`)";
/// The same, after a name that was probably meant.
const SEE_ALL: &str = "`specula help set` lists all";

impl Settings {
    /// Applies `path=value`, as `--set` takes it: a dotted path (`lights.orbit.0.strength`), or the bare name of one of the shader
    /// tree's own constants or parameters; then a TOML value, numbers joined by commas, or text without quotes.
    ///
    /// Whether the shader tree has such a name is not checked here.
    ///
    /// # Errors
    /// No `=`, a path that does not exist, or a value of the wrong kind: what was expected, with the nearest name.
    pub fn assign(&mut self, assignment: &str) -> Result<(), String> {
        // The name of a material may have a `=`, its factors have none.
        let is_factor = assignment.trim_start().starts_with(MATERIALS);
        let parts = if is_factor { assignment.rsplit_once('=') } else { assignment.split_once('=') };
        let (path, text) =
            parts.ok_or_else(|| format!("'{assignment}' has no value: expected path=value, as in view.ev=1 {SEE}"))?;
        let (path, text) = (path.trim(), text.trim());
        if let Some(of_material) = path.strip_prefix(MATERIALS) {
            return self.assign_factor(of_material, text);
        }
        let known = self.known()?;
        let is_own = !path.contains('.') && known.get(path).is_none();
        let full = if is_own { format!("shader.{path}") } else { path.to_owned() };
        let old = find(&known, &full)?;
        let is_text = matches!(old, Some(toml::Value::String(_))) && !full.starts_with("shader.");
        // A list of names: numbers in it are names too.
        let is_names = matches!(old, Some(toml::Value::Array(list)) if list.iter().all(toml::Value::is_str));
        let value = match parse(text) {
            toml::Value::Array(list) if is_names && list.iter().all(toml::Value::is_str) => toml::Value::Array(list),
            _ if is_names => toml::Value::String(text.trim_matches('"').into()),
            value if is_text && !value.is_str() => toml::Value::String(text.into()),
            value => value,
        };
        let mut root = toml::Value::try_from(&*self).map_err(|e| e.to_string())?;
        set_at(&mut root, &full, value)?;
        *self = root.try_into().map_err(|e: toml::de::Error| {
            let takes = takes(&full, text, old, e.message());
            if text.is_empty() {
                format!("{path} has no value; {takes}")
            } else {
                format!("{path} cannot be '{text}'; {takes}")
            }
        })?;
        Ok(())
    }

    /// Sets a factor of one material. `path`: the material's name, which may have dots and be in quotes, and the factor's.
    fn assign_factor(&mut self, path: &str, text: &str) -> Result<(), String> {
        let (material, name) = path.rsplit_once('.').filter(|(material, _)| !material.is_empty()).ok_or_else(|| {
            format!("'{MATERIALS}{path}' names no factor: expected {MATERIALS}NAME.FACTOR, as {MATERIALS}Shell.roughness=0.3")
        })?;
        let unquoted = material.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
        let material = unquoted.unwrap_or(material);
        let factor = factors::named(name)?;
        let value = parse(text).try_into().map_err(|_| {
            let takes = if factor.is_color() { "3 numbers, as 0.9,0.1,0.1" } else { "a number" };
            format!("{MATERIALS}{path} cannot be '{text}'; it takes {takes}, {}", factor.entry().valid.text())
        })?;
        self.materials.entry(material.to_owned()).or_default().insert(factor, value);
        Ok(())
    }

    /// A table of all settings, including those that have no value, to look up paths and types.
    pub(super) fn known(&self) -> Result<toml::Value, String> {
        let mut all = self.clone();
        all.camera.eye.get_or_insert_default();
        all.camera.target.get_or_insert_default();
        all.camera.up.get_or_insert_default();
        toml::Value::try_from(all).map_err(|e| e.to_string())
    }
}

/// The message about a name that is neither a setting nor one of the shader tree's `own` names. `describe` says what one of those
/// takes.
pub fn unknown_setting(name: &str, own: &[&str], describe: impl Fn(&str) -> Option<String>) -> String {
    let nearest = catalog::nearest(name, own);
    let hint = nearest.as_ref().map_or_else(String::new, |nearest| {
        let takes = if own.contains(&nearest.as_str()) { describe(nearest) } else { numbers(nearest) };
        let takes = takes.map(|takes| format!(", which takes {takes}")).unwrap_or_default();
        format!(" Did you mean `{nearest}`{takes}?")
    });
    // The list of all names would hide the one that is meant.
    if nearest.is_some() {
        return format!("unknown setting `{name}`.{hint} {SEE_ALL}");
    }
    let list = own.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let list = if list.is_empty() { "none".to_owned() } else { list };
    format!(
        "unknown setting `{name}`. Shader parameters: {list}. Settings: `view.ev`, `lights.orbit.0.strength`, ... {SEE}"
    )
}

/// A TOML value, or numbers joined by commas; anything else is text.
fn parse(text: &str) -> toml::Value {
    let plain = toml::from_str::<toml::Table>(&format!("value = {text}")).ok();
    let numbers = || {
        let numbers = text.split(',').map(|n| n.trim().parse().ok().map(toml::Value::Float));
        numbers.collect::<Option<Vec<_>>>().filter(|numbers| numbers.len() > 1).map(toml::Value::Array)
    };
    let value = plain.and_then(|mut table| table.remove("value")).or_else(numbers);
    value.unwrap_or_else(|| toml::Value::String(text.into()))
}

/// The value at a path; `None` where a value for the shader tree can be inserted.
fn find<'a>(root: &'a toml::Value, path: &str) -> Result<Option<&'a toml::Value>, String> {
    let mut place = root;
    let mut above = String::new();
    for key in path.split('.') {
        let below = match place {
            toml::Value::Table(table) => table.get(key),
            toml::Value::Array(array) => key.parse::<usize>().ok().and_then(|i| array.get(i)),
            _ => return Err(format!("unknown setting `{path}`. `{above}` is a value and has no part '{key}' {SEE}")),
        };
        let full = if above.is_empty() { key.to_owned() } else { format!("{above}.{key}") };
        place = match (below, place) {
            (Some(below), _) => below,
            (None, toml::Value::Array(array)) => {
                let last = array.len().saturating_sub(1);
                return Err(format!("unknown setting `{path}`. After `{above}` comes a number from 0 to {last} {SEE}"));
            }
            (None, _) if matches!(above.as_str(), "shader" | "passes") && full == path => return Ok(None),
            (None, _) => {
                let nearest = catalog::nearest(path, &[]);
                let hint = nearest.as_ref().map(|name| format!(" Did you mean `{name}`?")).unwrap_or_default();
                if nearest.is_some() {
                    return Err(format!("unknown setting `{path}`.{hint} {SEE_ALL}"));
                }
                let place_name = if above.is_empty() { "At the top".to_owned() } else { format!("Below `{above}`") };
                return Err(format!("unknown setting `{path}`. {place_name} there are {} {SEE}", keys(place)));
            }
        };
        above = full;
    }
    Ok(Some(place))
}

fn keys(value: &toml::Value) -> String {
    let mut keys: Vec<&str> = value.as_table().into_iter().flat_map(|table| table.keys().map(String::as_str)).collect();
    keys.sort_unstable();
    if keys.is_empty() { "no settings".into() } else { keys.join(", ") }
}

/// `a number, 0 to 1`, if the setting is a number or several numbers with limits.
fn numbers(path: &str) -> Option<String> {
    let setting = setting(path)?;
    let range = setting.entry.valid.text();
    match setting.default {
        Value::Number(_) if !range.is_empty() => Some(format!("a number, {range}")),
        Value::Numbers(_) if !range.is_empty() => Some(format!("3 numbers, {range}")),
        _ => None,
    }
}

/// Describes the values that fit at a path where `old` is, after serde refused `text` because of `cause`.
fn takes(path: &str, text: &str, old: Option<&toml::Value>, cause: &str) -> String {
    let setting = setting(path);
    if let Some(setting) = setting.filter(|setting| !setting.names.is_empty()) {
        let hint = did_you_mean(text, setting.names.iter().map(String::as_str));
        return format!("it can be {}.{hint}", either(&setting.names));
    }
    let within = setting.map(|setting| setting.entry.valid.text()).filter(|range| !range.is_empty());
    let within = within.map(|range| format!(", {range}")).unwrap_or_default();
    match old {
        _ if path.starts_with("passes.") => "it takes true or false".into(),
        _ if path.starts_with("shader.") => "it takes a number, numbers as 1,0.8,0.6, true, false or a name".into(),
        Some(toml::Value::Float(_)) => format!("it takes a number{within}"),
        Some(toml::Value::Integer(_)) => "it takes a whole number, 0 or more".into(),
        Some(toml::Value::Boolean(_)) => "it takes true or false".into(),
        Some(toml::Value::Array(list)) if list.is_empty() || list.iter().any(toml::Value::is_str) => {
            let known = if path == "material.override" { "base_color, metallic, roughness, anisotropy" } else { "any" };
            format!("it takes a list of names ({known}), as a,b")
        }
        Some(toml::Value::Array(list)) if list.iter().all(toml::Value::is_float) => {
            format!("it takes {} numbers, as 0.9{}", list.len(), ",0.1".repeat(list.len().saturating_sub(1)))
        }
        Some(toml::Value::Array(_)) => format!("it is a list of settings, as {path}.0"),
        // The setting itself says what it takes.
        Some(toml::Value::String(_)) => cause.to_owned(),
        Some(group) => format!("it is a group of settings: {}", keys(group)),
        None => cause.to_owned(),
    }
}

/// Puts a value at a path that [`find`] knows.
fn set_at(root: &mut toml::Value, path: &str, value: toml::Value) -> Result<(), String> {
    let (above, last) = path.rsplit_once('.').map_or((None, path), |(above, last)| (Some(above), last));
    let index = |key: &str| key.parse::<usize>().ok();
    let mut place = root;
    for key in above.into_iter().flat_map(|above| above.split('.')) {
        let below = match place {
            toml::Value::Table(table) => table.get_mut(key),
            toml::Value::Array(array) => index(key).and_then(|i| array.get_mut(i)),
            _ => None,
        };
        place = below
            .ok_or_else(|| format!("{path} cannot be set alone, because {key} has no value yet; set all of {key}"))?;
    }
    match place {
        toml::Value::Table(table) => {
            table.insert(last.into(), value);
        }
        toml::Value::Array(array) => {
            if let Some(entry) = index(last).and_then(|i| array.get_mut(i)) {
                *entry = value;
            }
        }
        _ => {}
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Adaptive, Factor, FactorValue, ShaderValue, Tonemap};
    use super::*;

    #[test]
    fn assign_reaches_every_depth() {
        let mut settings = Settings::default();
        for assignment in [
            "mode=base-color",
            "view.ev = -1",
            "view.tonemap=reinhard-luminance",
            "view.adaptive=off",
            "lights.orbit.2.color=[1, 0, 0.5]",
            "camera.eye=[1,2,3]",
            "variant=midnight",
            "material.base_color=1, 0.5,0",
            "environment.name=7",
            "rim_color=1,.5,0",
            "measured=1,2",
            "lights.rect.enabled=true",
            "shader.rim=0.5",
            "NDF_MODEL=Beckmann",
            "material.override=roughness, metallic",
            "scene.hidden=Shell,Base #0",
            "scene.isolated=[\"a, b\"]",
            "materials.Shell.roughness=0.25",
            "materials.\"v1.2 steel\".base_color=1,0.5,0",
        ] {
            settings.assign(assignment).unwrap();
        }
        assert_eq!(settings.mode, "base-color");
        assert_eq!(settings.view.ev, -1.0);
        assert_eq!((settings.view.tonemap, settings.view.adaptive), (Tonemap::ReinhardLuminance, Adaptive::Off));
        assert_eq!(settings.lights.orbit[2].color, [1.0, 0.0, 0.5]);
        assert_eq!(settings.camera.eye, Some([1.0, 2.0, 3.0]));
        assert_eq!((settings.variant.as_str(), settings.material.base_color), ("midnight", [1.0, 0.5, 0.0]));
        assert_eq!((settings.environment.name.as_str(), settings.measured.as_str()), ("7", "1,2"));
        assert_eq!(settings.shader["rim_color"], ShaderValue::Vector(vec![1.0, 0.5, 0.0]));
        assert!(settings.lights.rect.enabled);
        let channels: Vec<&str> = settings.material.channels.names().collect();
        assert_eq!(channels, ["metallic", "roughness"]);
        assert_eq!(
            (&*settings.scene.hidden, &*settings.scene.isolated),
            (&["Shell".into(), "Base #0".into()][..], &["a, b".into()][..])
        );
        assert_eq!(settings.materials["Shell"][&Factor::Roughness], FactorValue::Number(0.25));
        assert_eq!(settings.materials["v1.2 steel"][&Factor::BaseColor], FactorValue::Color([1.0, 0.5, 0.0]));
        assert_eq!(Settings::from_toml(&settings.to_toml()).unwrap(), settings);
        assert_eq!(settings.shader["rim"], ShaderValue::Float(0.5));
        assert_eq!(settings.shader["NDF_MODEL"], ShaderValue::Name("Beckmann".into()));
    }

    #[test]
    fn assign_explains_what_it_cannot_do() {
        let mut settings = Settings::default();
        let before = settings.clone();
        for (assignment, part) in [
            (
                "view.brightness=1",
                "unknown setting `view.brightness`. Below `view` there are adaptive, background, blend_layers, bounces, channels, checks, \
                 colormap, dither, ev, frames, msaa, pass_memory, range, tonemap, wireframe (see `specula help set`)",
            ),
            (
                "view.exposure=1",
                "unknown setting `view.exposure`. Did you mean `view.ev`? `specula help set` lists all",
            ),
            ("views.ev=1", "unknown setting `views.ev`. Did you mean `view.ev`? `specula help set` lists all"),
            ("qqqq.ev=1", "At the top there are animation, camera, "),
            ("shader.rim.x=1", "unknown setting `shader.rim.x`. "),
            ("camera.eye.0=1", "eye has no value yet; set all of eye"),
            ("view.ev=bright", "view.ev cannot be 'bright'; it takes a number, -30 to 30"),
            ("view.ev=", "view.ev has no value; it takes a number, -30 to 30"),
            ("view.msaa=-1", "view.msaa cannot be '-1'; it takes a whole number, 0 or more"),
            ("view=1", "view cannot be '1'; it is a group of settings: adaptive, background, blend_layers,"),
            ("lights.orbit=1", "lights.orbit cannot be '1'; it is a list of settings, as lights.orbit.0"),
            ("lights.rect.enabled=yes", "lights.rect.enabled cannot be 'yes'; it takes true or false"),
            ("material.base_color=0.9,0.1", "cannot be '0.9,0.1'; it takes 3 numbers, as 0.9,0.1,0.1"),
            ("material.base_color=red", "material.base_color cannot be 'red'; it takes 3 numbers"),
            ("camera.eye=[1, 2, 3, 4]", "camera.eye cannot be '[1, 2, 3, 4]'; it takes 3 numbers"),
            ("rim={ x = 1 }", "rim cannot be '{ x = 1 }'; it takes a number, numbers as"),
            ("lights.orbit.3.strength=1", "After `lights.orbit` comes a number from 0 to 2"),
            ("materials.Shell.rough=1", "a material has no factor `rough`. Did you mean `roughness`?"),
            ("materials.Shell.roughness=red", "cannot be 'red'; it takes a number, 0 to 1"),
            ("materials.roughness=1", "names no factor: expected materials.NAME.FACTOR"),
            ("material.override=rough", "it takes a list of names (base_color, metallic, roughness, anisotropy)"),
            ("view.ev.x=1", "`view.ev` is a value and has no part 'x'"),
            ("view.ev", "expected path=value"),
            ("view.tonemap=filmic", "view.tonemap cannot be 'filmic'; it can be none, reinhard, reinhard-luminance, "),
            ("lights.source=5", "lights.source cannot be '5'; it can be orbit, model or none."),
        ] {
            let error = settings.assign(assignment).unwrap_err();
            assert!(error.contains(part), "{assignment}: {error}");
            assert_eq!(settings, before, "{assignment} left a trace");
        }
    }
}
