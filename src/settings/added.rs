//! Models that are shown beside the first.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use super::Settings;
use super::declare::settings;
use super::entry::Entry;
use super::part::Part;
use super::scene::ModelSettings;
use super::setting::Setting;
use super::value::Value;

/// Most models beside the first.
pub const MOST_ADDED: usize = 63;

settings! {
    /// A model beside the first. All stand in a row along +X.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct AddedModel {
        /// File, or the name of a built-in model.
        file: String;
        /// Where it stands; its translation starts at its place in the row.
        place: ModelSettings;
    }
}

impl AddedModel {
    /// A model at its place in the row.
    pub fn new(file: &str) -> Self {
        Self { file: file.to_owned(), ..Self::default() }
    }
}

impl Settings {
    /// The files of the models beside the first, in their order.
    pub fn added_files(&self) -> Vec<String> {
        self.added.iter().map(|model| model.file.clone()).collect()
    }
}

/// The user says how many there are, so the list has no settings of its own.
impl Part for Vec<AddedModel> {
    fn list(&self, _: &str, _: &'static Entry, _: &mut Vec<Setting>) {}

    fn at(&self, path: &str) -> Option<Value> {
        let (index, rest) = path.split_once('.')?;
        self.get(index.parse::<usize>().ok()?)?.at(rest)
    }

    fn set_at(&mut self, path: &str, value: &Value) {
        let Some((index, rest)) = path.split_once('.') else { return };
        if let Some(model) = index.parse::<usize>().ok().and_then(|index| self.get_mut(index)) {
            model.set_at(rest, value);
        }
    }
}

/// The setting at a path below `added`.
pub(super) fn setting(path: &str) -> Option<&'static Setting> {
    static ALL: LazyLock<Vec<Setting>> = LazyLock::new(|| {
        static MODEL: Entry = Entry::new("");
        let mut all = Vec::new();
        (0..MOST_ADDED).for_each(|index| AddedModel::default().list(&format!("added.{index}"), &MODEL, &mut all));
        all
    });
    ALL.iter().find(|setting| setting.path == path)
}

/// Checks all models.
///
/// # Errors
/// A value beyond its limits, a model without a file, or too many models.
pub(super) fn check(added: &[AddedModel]) -> Result<(), String> {
    if added.len() > MOST_ADDED {
        return Err(format!("{} models are added; at most {MOST_ADDED} can be", added.len()));
    }
    for (index, model) in added.iter().enumerate() {
        if model.file.is_empty() {
            return Err(format!("added.{index}.file is empty; it takes the file of a model"));
        }
        for name in ["rotation", "scale", "translation"] {
            let path = format!("added.{index}.place.{name}");
            if let (Some(setting), Some(value)) = (setting(&path), model.place.at(name)) {
                setting.entry.check(&path, &value)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_set_by_the_number_of_its_model() {
        let mut settings = Settings { added: vec![AddedModel::new("duck.glb")], ..Settings::default() };
        settings.assign("added.0.place.translation=1,2,3").unwrap();
        settings.assign("added.0.place.scale=2").unwrap();
        assert_eq!(settings.value("added.0.place.translation"), Some(Value::Numbers([1.0, 2.0, 3.0])));
        assert_eq!(settings.added[0].place.scale, 2.0);
        settings.check().unwrap();
        assert_eq!(Settings::from_toml(&settings.to_toml()).unwrap(), settings);
        for (assignment, words) in [
            ("added.1.place.scale=2", "After `added` comes a number from 0 to 0"),
            ("added.0.place.size=2", "unknown setting `added.0.place.size`"),
            ("added.0.place.scale=big", "it takes a number"),
        ] {
            let error = settings.assign(assignment).unwrap_err();
            assert!(error.contains(words), "{assignment}: {error}");
        }
        settings.assign("added.0.place.scale=0").unwrap();
        let error = settings.check().unwrap_err();
        assert!(error.contains("added.0.place.scale is 0; it can be 0.001 to 1000"), "{error}");
    }
}
