//! Morph weights that the settings hold, whatever the file and its clips say.

use crate::message::did_you_mean;
use crate::scene::model::Model;
use crate::settings::AnimationSettings;

impl Model {
    /// The names by which settings refer to morph targets, in the order of the file: their own, or their numbers in their meshes. Targets of
    /// equal name, as those of a face and of its eyebrows, move together.
    pub fn target_keys(&self) -> Vec<String> {
        let mut keys: Vec<String> = Vec::new();
        for (_, key) in self.keyed_targets() {
            if !keys.contains(&key) {
                keys.push(key);
            }
        }
        keys
    }

    /// The weights that the settings hold, each with its index in `Pose::weights`. Names that the model does not have are left out: see
    /// [`Model::unknown_target`].
    pub fn held_weights(&self, settings: &AnimationSettings) -> Vec<(usize, f32)> {
        if settings.weights.is_empty() {
            return Vec::new();
        }
        let held: Vec<(&str, f32)> = settings.weights.iter().filter_map(|entry| held(entry)).collect();
        let weight = |key: &str| held.iter().rev().find(|(name, _)| *name == key).map(|(_, weight)| *weight);
        self.keyed_targets().filter_map(|(index, key)| Some((index, weight(&key)?))).collect()
    }

    /// A sentence about an entry of the settings that is of no morph target, or no weight.
    pub fn unknown_target(&self, settings: &AnimationSettings) -> Option<String> {
        let keys = self.target_keys();
        let is_known = |entry: &&String| held(entry).is_some_and(|(name, _)| keys.iter().any(|key| key == name));
        let entry = settings.weights.iter().find(|entry| !is_known(entry))?;
        let Some((name, _)) = held(entry) else {
            return Some(format!("'{entry}' is no morph weight: expected NAME:WEIGHT, as smile:0.5"));
        };
        let hint = did_you_mean(name, keys.iter().map(String::as_str));
        let known = if keys.is_empty() { "it has none".to_owned() } else { format!("it has {}", keys.join(", ")) };
        Some(format!("the model has no morph target '{name}': {known}.{hint}"))
    }

    /// The weight of the first morph target of this key, in the pose of this model.
    pub fn weight_of(&self, key: &str) -> f32 {
        let index = self.keyed_targets().find(|(_, of)| of == key).map(|(index, _)| index);
        index.and_then(|index| self.pose.weights.get(index)).copied().unwrap_or_default()
    }

    /// The index of each weight of `Pose::weights`, and the key of its target.
    fn keyed_targets(&self) -> impl Iterator<Item = (usize, String)> {
        let names = &self.motion.target_names;
        let weights = self.motion.rig.nodes.iter().flat_map(|node| node.weights.clone().enumerate());
        weights.map(|(number, index)| match names.get(index) {
            Some(name) if !name.is_empty() => (index, name.clone()),
            _ => (index, number.to_string()),
        })
    }
}

/// The entry of the settings that holds a morph target.
pub fn held_entry(name: &str, weight: f32) -> String {
    format!("{name}:{weight}")
}

/// The name and the weight of an entry of the settings.
fn held(entry: &str) -> Option<(&str, f32)> {
    let (name, weight) = entry.rsplit_once(':')?;
    Some((name.trim(), weight.trim().parse::<f32>().ok().filter(|weight| weight.abs() <= 1000.0)?))
}
