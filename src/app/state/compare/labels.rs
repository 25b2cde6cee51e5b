//! The names of both sides of a comparison. Those of a kept picture and the present one tell in what they differ.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use super::With;
use crate::app::state::State;
use crate::app::state::picture::ShownPicture;
use crate::settings::Settings;

/// A value of a setting with more characters is left out.
const LONGEST: usize = 24;

/// The contents of a picture.
struct Shown<'a> {
    version: u64,
    mode: &'a str,
    model: &'a str,
    settings: &'a Settings,
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
            format!("before the edit of {}", next.title())
        } else {
            format!("version {number}")
        })
    }
    /// The names of the earlier picture and of the present one, with what differs; `None` if no comparison is shown.
    pub(in crate::app) fn comparison_labels(&self) -> Option<[String; 2]> {
        let earlier = self.reference_label()?;
        let restored = self.edits.restored.as_ref().map(|restored| restored.number);
        let now = restored.map_or_else(|| "now".to_owned(), |number| format!("version {number}"));
        let (Some(With::Kept(kept, version)), Some(shown)) = (&self.compare.with, &self.picture.shown) else {
            return Some([earlier, now]);
        };
        let is_same_text = kept.state.shaders.texts == shown.state.shaders.texts;
        let version_now = if is_same_text { *version } else { restored.unwrap_or_else(|| self.shown_generation()) };
        let [kept, now] = differences(&of(kept, *version), &of(shown, version_now));
        Some([format!("kept: {kept}"), format!("now: {now}")])
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
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The differences, for each side: version, mode, model, environment and a single setting by name, more settings by their number. The
/// mode if nothing differs.
fn differences(kept: &Shown<'_>, now: &Shown<'_>) -> [String; 2] {
    let mut parts: [Vec<String>; 2] = Default::default();
    let mut add = |a: String, b: String| {
        if a != b {
            parts[0].push(a);
            parts[1].push(b);
        }
    };
    let both = |text: &dyn Fn(&Shown<'_>) -> String| (text(kept), text(now));
    for (a, b) in [
        both(&|side| format!("version {}", side.version)),
        both(&|side| side.mode.to_owned()),
        both(&|side| side.model.to_owned()),
        both(&|side| file_name(Path::new(&side.settings.environment.name))),
    ] {
        add(a, b);
    }
    let (before, after) = (leaves(kept.settings), leaves(now.settings));
    let paths = before.keys().chain(after.keys().filter(|path| !before.contains_key(*path)));
    let changed: Vec<&String> = paths.filter(|path| before.get(*path) != after.get(*path)).collect();
    match changed.as_slice() {
        [] => {}
        [path] => {
            let value = |leaves: &BTreeMap<String, String>| match leaves.get(*path) {
                Some(value) if value.chars().count() <= LONGEST => format!("{path} {value}"),
                Some(_) => format!("another {path}"),
                None => format!("default {path}"),
            };
            parts[0].push(value(&before));
            parts[1].push(value(&after));
        }
        several => parts[1].push(format!("{} other settings", several.len())),
    }
    parts.map(|parts| if parts.is_empty() { now.mode.to_owned() } else { parts.join(", ") })
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

    fn shown<'a>(version: u64, mode: &'a str, settings: &'a Settings) -> Shown<'a> {
        Shown { version, mode, model: "shader-ball", settings }
    }

    #[test]
    fn the_names_tell_what_differs() {
        let before = Settings::default();
        let labels = |kept: Shown<'_>, now: Shown<'_>| differences(&kept, &now);
        assert_eq!(labels(shown(3, "Final", &before), shown(3, "Final", &before)), ["Final", "Final"]);
        assert_eq!(labels(shown(3, "Final", &before), shown(4, "Final", &before)), ["version 3", "version 4"]);
        let modes = labels(shown(3, "Final", &before), shown(4, "Depth", &before));
        assert_eq!(modes, ["version 3, Final", "version 4, Depth"]);
        let mut after = before.clone();
        after.view.ev = 0.3;
        after.camera.azimuth += 10.0;
        assert_eq!(labels(shown(3, "Final", &before), shown(3, "Final", &after)), ["view.ev 0.7", "view.ev 0.3"]);
        after.environment.name = "/maps/forest.hdr".into();
        after.environment.rotation = 90.0;
        let [kept, now] = labels(shown(3, "Final", &before), shown(3, "Final", &after));
        assert_eq!([&*kept, &*now], [&*before.environment.name, "forest.hdr, 2 other settings"]);
    }

    #[test]
    fn a_value_that_only_one_side_has_is_the_default_of_the_other() {
        let (before, mut after) = (Settings::default(), Settings::default());
        after.passes.insert("bloom".into(), true);
        let labels = differences(&shown(1, "Final", &before), &shown(1, "Final", &after));
        assert_eq!(labels, ["default passes.bloom", "passes.bloom true"]);
    }
}
