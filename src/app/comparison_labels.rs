//! The names of both sides of a comparison. Those of a kept picture and the present one tell in what they differ.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;

use super::setting_text::setting_text;
use super::state::State;
use super::state::compare::With;
use super::state::picture::ShownPicture;
use crate::settings::Settings;
use crate::shader::ShaderSet;

/// Most settings that are named.
const NAMED: usize = 3;

/// The contents of a picture.
struct Shown<'a> {
    version: u64,
    mode: &'a str,
    model: &'a str,
    settings: &'a Settings,
    shaders: &'a ShaderSet,
}

impl State {
    /// Label of the earlier picture; `None` if no comparison is shown.
    fn reference_label(&self) -> Option<String> {
        let before = self.version_before();
        let number = match &self.compare.with {
            Some(With::Kept(..)) => return Some("kept".to_owned()),
            Some(With::File(file)) => return Some(file.label()),
            Some(With::Tree(tree)) => return Some(tree.label()),
            Some(With::Version(number)) => *number,
            None => before.filter(|_| self.compare.is_held)?,
        };
        let next = self.versions.iter().find(|version| version.number > number)?;
        Some(if Some(number) == before {
            format!("version {number}, before the edit of {}", next.title())
        } else {
            format!("version {number}")
        })
    }

    /// The names of the earlier picture and of the present one, with what differs; `None` if no comparison is shown.
    pub(in crate::app) fn comparison_labels(&self) -> Option<[String; 2]> {
        let version = self.session.shaders.as_ref().zip(self.compare.version());
        let timed = version.and_then(|(shaders, version)| self.costs.of_version(shaders, version));
        let time = timed.map(|difference| format!(" ({})", difference.text())).unwrap_or_default();
        let earlier = self.reference_label()? + &time;
        let restored = self.edits.restored.as_ref().map(|restored| restored.number);
        let now = restored.map_or_else(|| "now".to_owned(), |number| format!("version {number}"));
        let (Some(With::Kept(kept, version)), Some(shown)) = (&self.compare.with, &self.picture.shown) else {
            return Some([earlier, now]);
        };
        let is_same_text = kept.state.shaders.texts == shown.state.shaders.texts;
        let version_now = if is_same_text { *version } else { restored.unwrap_or_else(|| self.shown_version()) };
        Some(differences(&of(kept, *version), &of(shown, version_now)))
    }

    /// Short names of the earlier picture and of the present one, for the value under the mouse; `None` if no comparison is shown.
    pub(in crate::app) fn side_names(&self) -> Option<[String; 2]> {
        let compare = &self.compare;
        if let Some(With::Kept(..)) = &compare.with {
            self.reference_label()?;
            return Some(["kept", "now"].map(str::to_owned));
        }
        let [earlier, now] = self.comparison_labels()?;
        let name = compare.file().map(|path| file_name(path)).or_else(|| compare.tree_name().map(str::to_owned));
        Some(match &compare.with {
            Some(With::Version(number)) => [format!("version {number}"), now],
            _ => [name.unwrap_or(earlier), now],
        })
    }
}

fn of(picture: &ShownPicture, version: u64) -> Shown<'_> {
    Shown {
        version,
        mode: picture.state.mode().map_or("", |mode| mode.name.as_str()),
        model: picture.state.scene.as_ref().map_or("", |scene| &scene.model().name),
        settings: &picture.settings,
        shaders: &picture.state.shaders,
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The differences, for each side: version, mode, model, environment, and settings by their labels. The mode if nothing differs.
fn differences(kept: &Shown<'_>, now: &Shown<'_>) -> [String; 2] {
    let mut parts: [Vec<String>; 2] = Default::default();
    let mut add = |texts: [String; 2]| {
        if texts[0] != texts[1] {
            parts.iter_mut().zip(texts).for_each(|(parts, text)| parts.push(text));
        }
    };
    let both = |text: &dyn Fn(&Shown<'_>) -> String| [kept, now].map(text);
    add(both(&|side| format!("version {}", side.version)));
    add(both(&|side| side.mode.to_owned()));
    add(both(&|side| side.model.to_owned()));
    add(both(&|side| file_name(Path::new(&side.settings.environment.name))));
    let (named, others) = changed([(kept.settings, kept.shaders), (now.settings, now.shaders)]);
    named.into_iter().for_each(add);
    parts[1].extend(others);
    if parts[0].is_empty() {
        return ["kept", "now"].map(|side| format!("{side}: {}", now.mode));
    }
    parts.map(|parts| parts.join(", "))
}

/// The settings that differ, by their labels and values on each side, and how many more do.
fn changed([before, after]: [(&Settings, &ShaderSet); 2]) -> (Vec<[String; 2]>, Option<String>) {
    let stored = [before, after].map(|(settings, _)| leaves(settings));
    let paths: BTreeSet<&String> = stored.iter().flat_map(BTreeMap::keys).collect();
    let changed: Vec<&String> = paths.into_iter().filter(|path| stored[0].get(*path) != stored[1].get(*path)).collect();
    let named = if changed.len() > NAMED { NAMED - 1 } else { changed.len() };
    let text = |path: &str, (settings, shaders), stored: &BTreeMap<String, String>| {
        setting_text(path, stored.get(path).map(String::as_str), settings, shaders)
    };
    let texts = changed[..named].iter().map(|path| [text(path, before, &stored[0]), text(path, after, &stored[1])]);
    let others = changed.len() - named;
    (texts.collect(), (others > 0).then(|| format!("{others} other settings")))
}

/// The settings of `after` that differ from those of `before`, by their labels: `Exposure: +0.3 EV`. Empty if the texts are equal.
pub(in crate::app) fn new_values(before: &Settings, after: &Settings, shaders: &ShaderSet) -> String {
    let (named, others) = changed([(before, shaders), (after, shaders)]);
    let environment = &after.environment.name;
    let environment = (*environment != before.environment.name).then(|| file_name(Path::new(environment)));
    let named = named.into_iter().map(|[_, after]| after);
    environment.into_iter().chain(named).chain(others).collect::<Vec<_>>().join(", ")
}

/// The settings by their paths, except those that the names of a picture or of its parts show and the camera, which a kept
/// picture follows.
fn leaves(settings: &Settings) -> BTreeMap<String, String> {
    let mut out = BTreeMap::new();
    collect("", &serde_json::to_value(settings).unwrap_or_default(), &mut out);
    let is_told = |path: &str| matches!(path, "mode" | "environment.name");
    out.retain(|path, _| !is_told(path) && !path.starts_with("camera.") && !path.starts_with("bookmarks."));
    out
}

fn collect(path: &str, value: &Value, out: &mut BTreeMap<String, String>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Object(members) => members.iter().for_each(|(name, value)| collect(&below(name), value, out)),
        Value::Array(items) if items.iter().any(Value::is_object) => {
            (0..).zip(items).for_each(|(index, value): (usize, _)| collect(&below(&index.to_string()), value, out));
        }
        value => _ = out.insert(path.to_owned(), text(value)),
    }
}

/// A value as `--set` takes it.
fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        // Settings are single floats, whose digits as doubles are meaningless.
        Value::Number(number) if number.is_f64() => (number.as_f64().unwrap_or_default() as f32).to_string(),
        Value::Array(items) => items.iter().map(text).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::ShaderValue;
    use crate::shader::Constant;
    use crate::shader::spirv::reflect::Scalar;

    fn shown<'a>(version: u64, mode: &'a str, settings: &'a Settings, shaders: &'a ShaderSet) -> Shown<'a> {
        Shown { version, mode, model: "shader-ball", settings, shaders }
    }

    #[test]
    fn the_names_tell_what_differs() {
        let (before, shaders) = (Settings::default(), ShaderSet::default());
        let labels = |version, mode, settings: &Settings| {
            differences(&shown(3, "Final", &before, &shaders), &shown(version, mode, settings, &shaders))
        };
        assert_eq!(labels(3, "Final", &before), ["kept: Final", "now: Final"]);
        assert_eq!(labels(4, "Final", &before), ["version 3", "version 4"]);
        assert_eq!(labels(4, "Depth", &before), ["version 3, Final", "version 4, Depth"]);
        let mut after = before.clone();
        after.view.ev = -0.3;
        after.camera.azimuth += 10.0;
        assert_eq!(labels(3, "Final", &after), ["Exposure: -0.7 EV", "Exposure: +0.3 EV"]);
        assert_eq!(new_values(&before, &after, &shaders), "Exposure: +0.3 EV");
        assert_eq!(new_values(&after, &before, &shaders), "Exposure: -0.7 EV");
        after.environment.name = "/maps/forest.hdr".into();
        after.environment.rotation = 90.0;
        let [kept, now] = labels(3, "Final", &after);
        assert!(
            kept.starts_with(&*before.environment.name) && now.starts_with("forest.hdr, Environment: rot"),
            "{now}"
        );
        after.lights.orbit.iter_mut().for_each(|light| light.strength += 1.0);
        assert!(labels(3, "Final", &after)[1].ends_with(", 3 other settings"), "{:?}", labels(3, "Final", &after));
    }

    #[test]
    fn settings_of_the_shaders_have_their_labels_and_choices() {
        let choices = vec![("Lambert".to_owned(), 0), ("Minnaert".to_owned(), 5)];
        let constant = Constant {
            id: 0,
            name: "DIFFUSE".into(),
            label: "Diffuse".into(),
            scalar: Scalar::Uint,
            default: 0,
            range: None,
            choices,
            choice_docs: Vec::new(),
            conserves: None,
            reciprocal: None,
            group: String::new(),
            doc: String::new(),
            unit: String::new(),
            file: String::new(),
            line: 0,
        };
        let shaders = ShaderSet { constants: vec![constant], ..ShaderSet::default() };
        let (before, mut after) = (Settings::default(), Settings::default());
        after.shader.insert("DIFFUSE".into(), ShaderValue::Name("Minnaert".into()));
        after.passes.insert("bloom".into(), true);
        let labels = differences(&shown(1, "Final", &before, &shaders), &shown(1, "Final", &after, &shaders));
        assert_eq!(labels, ["passes.bloom: default, Diffuse: Lambert", "passes.bloom: true, Diffuse: Minnaert"]);
    }
}
