//! The list of all settings, made of their entries.

use std::sync::LazyLock;

use super::entry::Entry;
use super::part::Part as _;
use super::setting::Setting;
use super::{Settings, added};
use crate::message;

/// All settings: those at the top, then group by group in the order of their declaration.
pub fn catalog() -> &'static [Setting] {
    static ALL: LazyLock<Vec<Setting>> = LazyLock::new(|| {
        static ROOT: Entry = Entry::new("");
        let mut all = Vec::new();
        Settings::default().list("", &ROOT, &mut all);
        // The settings of a group come before the groups in it.
        let groups: Vec<String> = all.iter().map(|setting| setting.group().to_owned()).collect();
        all.sort_by_key(|setting| groups.iter().position(|group| group == setting.group()));
        all
    });
    &ALL
}

/// The setting at a path, or the one that has the number at this path.
pub fn setting(path: &str) -> Option<&'static Setting> {
    let at = |path: &str| catalog().iter().find(|setting| setting.path == path);
    at(path).or_else(|| added::setting(path)).or_else(|| {
        let (whole, index) = path.rsplit_once('.')?;
        at(whole)
            .or_else(|| added::setting(whole))
            .filter(|setting| setting.takes == "3 numbers" && index.parse::<usize>().is_ok())
    })
}

/// The setting that is most like an unknown path, if one is near. A path without a dot is also compared with the last parts of all
/// paths, since that is how people abbreviate them, and the last part with the words that the panels show.
pub(super) fn nearest(typed: &str, own: &[&str]) -> Option<String> {
    let settings = catalog().iter().map(|setting| (setting.path.as_str(), setting.entry.label));
    let candidates = own.iter().map(|name| (*name, "")).chain(settings);
    let (group, own_part) = typed.rsplit_once('.').unwrap_or(("", typed));
    let likeness = |path: &str, label: &str| {
        let (above, last) = path.rsplit_once('.').unwrap_or(("", path));
        let whole = message::likeness(typed, path);
        // A full name wins over an abbreviation that is equally like it, and over the words of the panel.
        let part = if group.is_empty() { message::likeness(typed, last) } else { 0.0 };
        let words = if group.is_empty() || group == above { message::likeness(own_part, label) } else { 0.0 };
        whole.max(0.99 * part).max(0.98 * words)
    };
    message::best(candidates.map(|(path, label)| (likeness(path, label), path))).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::super::entry::When;
    use super::super::value::Value;
    use super::*;

    /// The table of all settings, in Markdown: part of `assets/manual/settings.md`.
    fn table() -> String {
        let mut out =
            String::from("| setting | takes | default | range | unit | meaning |\n|---|---|---|---|---|---|\n");
        for setting in catalog() {
            let Setting { path, entry, takes, default, .. } = setting;
            let default = default.to_string();
            let default = if default.is_empty() { default } else { format!("`{default}`") };
            let (range, unit, doc) = (entry.valid.text(), entry.unit.name, setting.doc());
            out += &format!("| `{path}` | {takes} | {default} | {range} | {unit} | {doc} |\n");
        }
        out
    }

    /// Run with `SPECULA_BLESS=1` to write the table anew after a change of a setting.
    #[test]
    fn the_page_about_settings_lists_all() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/manual/settings.md");
        let (page, table) = (std::fs::read_to_string(path).unwrap(), table());
        if std::env::var_os("SPECULA_BLESS").is_some() {
            let above = page.split("| setting |").next().unwrap();
            return std::fs::write(path, format!("{above}{table}")).unwrap();
        }
        assert!(page.ends_with(&table), "{path} is stale; run this test with SPECULA_BLESS=1");
    }

    /// How `--set` and a look file read a path and its value.
    #[test]
    fn every_setting_is_read_and_set_by_its_path() {
        let defaults = toml::Value::try_from(Settings::default()).unwrap();
        for setting in catalog() {
            let mut keys = setting.path.split('.');
            let stored = keys.try_fold(&defaults, |place, key| match (place, key.parse::<usize>()) {
                (toml::Value::Array(list), Ok(index)) => list.get(index),
                (place, _) => place.get(key),
            });
            assert_eq!(stored.is_none(), setting.default == Value::Unset, "{}", setting.path);
            let mut settings = Settings::default();
            assert_eq!(settings.value(&setting.path).as_ref(), Some(&setting.default), "{}", setting.path);
            let other = match &setting.default {
                Value::Switch(on) => Value::Switch(!on),
                Value::Number(number) => Value::Number(number + 0.25),
                Value::Whole(number) => Value::Whole(number + 1),
                Value::Unset | Value::Numbers(_) => Value::Numbers([0.25, 0.5, 1.0]),
                Value::Text(_) if setting.path == "view.range" => Value::Text("0..5".into()),
                Value::Text(default) => {
                    let other = setting.names.iter().find(|name| *name != default);
                    Value::Text(other.map_or("other", String::as_str).into())
                }
                Value::Names(_) => Value::Names(vec!["roughness".into()]),
            };
            settings.set_value(&setting.path, &other);
            let mut assigned = Settings::default();
            assigned.assign(&format!("{}={other}", setting.path)).unwrap();
            assert!(settings == assigned && settings != Settings::default(), "{}", setting.path);
        }
    }

    #[test]
    fn defaults_and_sliders_are_valid() {
        for Setting { path, entry, default, .. } in catalog() {
            entry.check(path, default).unwrap();
            assert!(!entry.doc().is_empty(), "{path}");
            if let Some(slider) = entry.slider {
                for end in [slider.ends.0, slider.ends.1] {
                    let end = if slider.is_negated { -end } else { end };
                    entry.check(path, &Value::Number(end as f32)).unwrap();
                }
                assert!(slider.ends.0 < slider.ends.1 && !entry.label.is_empty(), "{path}");
            }
        }
    }

    #[test]
    fn conditions_are_on_settings() {
        fn check(condition: When) {
            match condition {
                When::Always => {}
                When::Is(path, text) | When::Not(path, text) => {
                    assert!(setting(path).is_some(), "{path}");
                    Settings::default().assign(&format!("{path}={text}")).unwrap();
                }
                When::All(conditions) | When::Any(conditions) => conditions.iter().copied().for_each(check),
            }
        }
        catalog().iter().for_each(|setting| check(setting.entry.used));
        let mut settings = Settings::default();
        for (assignment, path, is_used) in [
            ("view.background=#000000", "environment.blur", false),
            ("view.background=env", "environment.blur", true),
            ("environment.name=none", "environment.blur", false),
            ("material.override=roughness", "material.metallic", false),
            ("material.override=roughness,anisotropy", "material.anisotropy", true),
            ("material.anisotropy=0", "material.anisotropy_rotation", false),
            ("material.anisotropy=0.5", "material.anisotropy_rotation", true),
            ("material.enabled=true", "material.metallic", true),
        ] {
            settings.assign(assignment).unwrap();
            assert_eq!(settings.uses(setting(path).unwrap().entry), is_used, "{path} after {assignment}");
        }
    }

    #[test]
    fn a_setting_is_found_by_its_last_part() {
        for (typed, own, expected) in [
            ("tonemap", &[][..], Some("view.tonemap")),
            ("ndf", &["NDF"], Some("NDF")),
            ("view.exposure", &[], Some("view.ev")),
            ("roughness", &["roughness_scale"], Some("material.roughness")),
            ("exposre", &["NDF"], Some("view.ev")),
            ("qqqqq", &["NDF"], None),
            ("foo", &["NDF"], None),
        ] {
            assert_eq!(nearest(typed, own).as_deref(), expected, "{typed}");
        }
    }

    #[test]
    fn valid_values_are_told_in_words() {
        let told = |path| setting(path).map(|setting| setting.entry.valid.text());
        assert_eq!(told("camera.fovy").as_deref(), Some("1 to 170"));
        assert_eq!(told("lights.orbit.2.color.1").as_deref(), Some("0 to 1e6"));
        assert_eq!(told("view.msaa").as_deref(), Some("1 or 4"));
        assert_eq!(told("camera.eye").as_deref(), Some(""));
        assert_eq!(told("camera.fovy.0"), None);
    }
}
