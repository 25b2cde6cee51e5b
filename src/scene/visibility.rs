//! The instances that settings name: by node, with all below it, or by primitive.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use super::model::{Instance, Model, Node};
use crate::message::did_you_mean;
use crate::settings::SceneSettings;

impl Model {
    /// Whether each instance is drawn; `None` if all are.
    pub fn visible(&self, settings: &SceneSettings) -> Option<Vec<bool>> {
        if settings.hidden.is_empty() && settings.isolated.is_empty() {
            return None;
        }
        let hidden = self.named(&settings.hidden);
        if settings.isolated.is_empty() {
            return Some(hidden.iter().map(|hidden| !hidden).collect());
        }
        let isolated = self.named(&settings.isolated);
        Some(isolated.iter().zip(hidden).map(|(isolated, hidden)| *isolated && !hidden).collect())
    }

    /// Whether each instance is named in `names`.
    pub fn named(&self, names: &[String]) -> Vec<bool> {
        let names: HashSet<&str> = names.iter().map(String::as_str).collect();
        let is_named = |name: &str| names.contains(name);
        let mut nodes = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            // Parents come first.
            let is_below = node.parent.is_some_and(|parent| nodes[parent]);
            nodes.push(is_below || is_named(&node.name) || is_named(&number(node)));
        }
        let of_file: HashMap<usize, bool> = self.nodes.iter().map(|node| node.index).zip(nodes).collect();
        let is = |instance: &Instance| {
            of_file.get(&instance.node) == Some(&true) || is_named(&self.primitives[instance.primitive].name)
        };
        self.instances.iter().map(is).collect()
    }

    /// The unique name by which settings refer to a node: its own, or its number.
    pub fn node_key(&self, at: usize) -> String {
        let Some(node) = self.nodes.get(at) else { return String::new() };
        let has = |other: &Node| other.name == node.name;
        let is_unique = is_plain(&node.name)
            && self.nodes.iter().filter(|other| has(other)).count() == 1
            && self.primitives.iter().all(|primitive| primitive.name != node.name);
        if is_unique { node.name.clone() } else { number(node) }
    }

    /// [`Model::node_key`] of all nodes.
    pub fn node_keys(&self) -> Vec<String> {
        let mut counts: HashMap<&str, usize> = HashMap::new();
        let primitives = self.primitives.iter().map(|primitive| primitive.name.as_str());
        for name in self.nodes.iter().map(|node| node.name.as_str()).chain(primitives) {
            *counts.entry(name).or_default() += 1;
        }
        let key = |node: &Node| {
            let is_unique = is_plain(&node.name) && counts.get(node.name.as_str()) == Some(&1);
            if is_unique { node.name.clone() } else { number(node) }
        };
        self.nodes.iter().map(key).collect()
    }

    /// The index in `nodes` of the node of an instance.
    pub fn node_of(&self, instance: &Instance) -> Option<usize> {
        self.nodes.iter().position(|node| node.index == instance.node)
    }

    /// The name by which settings refer to a material: its own, or its number in the file.
    pub fn material_key(&self, index: usize) -> String {
        match self.materials.get(index) {
            Some(material) if !material.name.is_empty() => material.name.clone(),
            _ if index == 0 => "#default".to_owned(),
            _ => format!("#{}", index - 1),
        }
    }

    /// A sentence about the first name in `settings` that matches no node and no primitive.
    pub fn unknown_part(&self, settings: &SceneSettings) -> Option<String> {
        let of = |list: &'static str, names: &[String]| {
            if names.is_empty() {
                return None;
            }
            let nodes = self.nodes.iter().map(|node| node.name.as_str());
            let names_of_parts =
                || nodes.clone().chain(self.primitives.iter().map(|primitive| primitive.name.as_str()));
            let known: HashSet<Cow<str>> =
                names_of_parts().map(Cow::from).chain(self.nodes.iter().map(|node| number(node).into())).collect();
            let unknown = names.iter().find(|name| !known.contains(name.as_str()))?;
            let hint = did_you_mean(unknown, names_of_parts());
            Some(format!("scene.{list}: the model has no node and no primitive '{unknown}'.{hint}"))
        };
        of("hidden", &settings.hidden).or_else(|| of("isolated", &settings.isolated))
    }

    /// A sentence about the first of these names that matches no material.
    pub fn unknown_material<'a>(&self, mut names: impl Iterator<Item = &'a String>) -> Option<String> {
        let known: Vec<String> = (0..self.materials.len()).map(|index| self.material_key(index)).collect();
        let set: HashSet<&String> = known.iter().collect();
        let unknown = names.find(|name| !set.contains(name))?;
        let hint = did_you_mean(unknown, known.iter().map(String::as_str));
        // The first is glTF's default material.
        let list = known.get(1..).unwrap_or_default().join(", ");
        Some(format!("materials: the model has no material '{unknown}'.{hint} It has {list}"))
    }
}

/// Whether a name can be used in a list of names.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && !name.contains(',') && !name.starts_with('#')
}

/// `#` and the index in the file.
fn number(node: &Node) -> String {
    format!("#{}", node.index)
}

#[cfg(test)]
mod tests {
    use super::super::{BUILT_IN, built_in};
    use super::*;

    fn model() -> Model {
        built_in(BUILT_IN[0]).unwrap().unwrap()
    }

    #[test]
    fn nodes_hide_what_is_below_them() {
        let model = model();
        let all = model.instances.len();
        let keys: Vec<String> = (0..model.nodes.len()).map(|at| model.node_key(at)).collect();
        assert_eq!(model.node_keys(), keys);
        assert_eq!(model.visible(&SceneSettings::default()), None);
        for at in 0..model.nodes.len() {
            let key = model.node_key(at);
            let below = |instance: &Instance| {
                let mut node = model.node_of(instance);
                while node.is_some() && node != Some(at) {
                    node = node.and_then(|node| model.nodes[node].parent);
                }
                node == Some(at)
            };
            let expected: Vec<bool> = model.instances.iter().map(below).collect();
            assert_eq!(model.named(std::slice::from_ref(&key)), expected, "{key}");
            let hidden = SceneSettings { hidden: vec![key.clone()], ..Default::default() };
            let isolated = SceneSettings { isolated: vec![key], ..Default::default() };
            let count = |settings| model.visible(&settings).unwrap().into_iter().filter(|visible| *visible).count();
            assert_eq!(count(hidden) + count(isolated), all);
        }
    }

    #[test]
    fn primitives_have_names_and_unknown_names_are_told() {
        let model = model();
        let primitive = &model.primitives[model.instances[0].primitive].name;
        assert!(model.named(std::slice::from_ref(primitive))[0]);
        let wrong = SceneSettings { hidden: vec!["Shel".into()], ..Default::default() };
        assert!(model.unknown_part(&wrong).unwrap().contains("no node and no primitive 'Shel'"));
        assert_eq!(model.unknown_material([model.material_key(1)].iter()), None);
        assert!(model.unknown_material(["Nickel".to_owned()].iter()).unwrap().contains("no material 'Nickel'"));
    }
}
