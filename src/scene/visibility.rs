//! The instances that settings name: by node, with all below it, or by primitive.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap, HashSet};

use super::model::{Camera, Instance, Material, Model, Node};
use crate::message::did_you_mean;
use crate::settings::{CameraSettings, MaterialValues, SceneSettings};

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
        for node in self.nodes.iter() {
            // Parents come first.
            let is_below = node.parent.is_some_and(|parent| nodes[parent]);
            nodes.push(is_below || is_named(&node.name) || is_named(&number(node)));
        }
        // A node with several parents is there more than once.
        let mut of_file: HashMap<usize, bool> = HashMap::new();
        for (node, is_named) in self.nodes.iter().zip(nodes) {
            *of_file.entry(node.index).or_default() |= is_named;
        }
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

    /// [`Model::material_key`] of each material.
    pub fn material_keys(&self) -> Vec<String> {
        let mut counts: HashMap<&str, usize> = HashMap::new();
        self.materials.iter().for_each(|material| *counts.entry(&material.name).or_default() += 1);
        let key = |(index, material): (usize, &Material)| match counts[material.name.as_str()] {
            _ if material.name.is_empty() => material_number(index),
            1 => material.name.clone(),
            _ => format!("{}{}", material.name, material_number(index)),
        };
        self.materials.iter().enumerate().map(key).collect()
    }

    /// The name by which settings refer to a material: its own, followed by its number in the file if others have it too, or else that
    /// number.
    pub fn material_key(&self, index: usize) -> String {
        let Some(name) = self.materials.get(index).map(|material| &material.name) else {
            return material_number(index);
        };
        let is_unique = || self.materials.iter().filter(|other| other.name == *name).count() == 1;
        match name.is_empty() {
            true => material_number(index),
            false if is_unique() => name.clone(),
            false => format!("{name}{}", material_number(index)),
        }
    }

    /// The values that settings give a material by its name and number, its number, or its name, which may be that of others too.
    pub fn material_values<'a>(
        &self,
        index: usize,
        materials: &'a BTreeMap<String, MaterialValues>,
    ) -> Option<&'a MaterialValues> {
        if materials.is_empty() {
            return None;
        }
        self.material_names(index).iter().find_map(|name| materials.get(name))
    }

    fn material_names(&self, index: usize) -> [String; 3] {
        let (name, number) = (self.materials[index].name.clone(), material_number(index));
        [format!("{name}{number}"), number, name]
    }

    /// The name by which settings refer to a camera: its own if no other has it, or its number.
    pub fn camera_key(&self, index: usize) -> String {
        let name = unique_name(self.cameras.iter().map(|camera| &*camera.name), index);
        name.unwrap_or_else(|| format!("#{index}"))
    }

    /// The name of a scene of the file: its own if no other has it, or its number.
    pub fn scene_name(&self, index: usize) -> String {
        let name = unique_name(self.contents.scenes.iter().map(String::as_str), index);
        name.unwrap_or_else(|| format!("#{index}"))
    }

    /// The camera that settings name by its number, or the first of that name.
    pub fn camera(&self, name: &str) -> Option<&Camera> {
        match name.strip_prefix('#').and_then(|number| number.parse::<usize>().ok()) {
            Some(index) => self.cameras.get(index),
            None => self.cameras.iter().find(|camera| !name.is_empty() && *camera.name == *name),
        }
    }

    /// A sentence about a name in `settings` that is of no camera.
    pub fn unknown_camera(&self, settings: &CameraSettings) -> Option<String> {
        let name = &settings.name;
        if name.is_empty() || self.camera(name).is_some() {
            return None;
        }
        let known: Vec<String> = (0..self.cameras.len()).map(|index| self.camera_key(index)).collect();
        let hint = did_you_mean(name, known.iter().map(String::as_str));
        let list = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        Some(format!("camera.name: the model has no camera '{name}'.{hint} It has {list}"))
    }

    /// Whether a node or a primitive has this name.
    pub fn has_part(&self, name: &str) -> bool {
        let is_node = |node: &Node| node.name == name || number(node) == name;
        self.nodes.iter().any(is_node) || self.primitives.iter().any(|primitive| primitive.name == name)
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
    pub fn unknown_material<'a>(&self, names: impl Iterator<Item = &'a String>) -> Option<String> {
        let mut names = names.peekable();
        names.peek()?;
        let set: HashSet<String> = (0..self.materials.len()).flat_map(|index| self.material_names(index)).collect();
        let unknown = names.find(|name| name.is_empty() || !set.contains(*name))?;
        let known = self.material_keys();
        let hint = did_you_mean(unknown, known.iter().map(String::as_str));
        // The first is glTF's default material.
        let list = known.get(1..).unwrap_or_default().join(", ");
        Some(format!("materials: the model has no material '{unknown}'.{hint} It has {list}"))
    }
}

/// `#` and the index in the file of a material; the first is glTF's default material, which no file has.
fn material_number(index: usize) -> String {
    index.checked_sub(1).map_or_else(|| "#default".to_owned(), |number| format!("#{number}"))
}

/// The name at `index`, if it is the only one of this kind and not empty.
fn unique_name<'a>(names: impl Iterator<Item = &'a str> + Clone, index: usize) -> Option<String> {
    let name = names.clone().nth(index).filter(|name| !name.is_empty() && !name.starts_with('#'))?;
    (names.filter(|other| *other == name).count() == 1).then(|| name.to_owned())
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
    use glam::Vec3;

    use super::super::model::{Lens, Material};
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

    #[test]
    fn materials_of_equal_name_have_keys_of_their_own_and_a_name_in_common() {
        let named = |name: &str| Material { name: name.into(), ..Material::default() };
        let materials = ["", "Paint", "Glass", "Paint", ""].map(named).to_vec();
        let model = Model { materials: materials.into(), ..Model::default() };
        let keys: Vec<String> = (0..5).map(|index| model.material_key(index)).collect();
        assert_eq!(model.material_keys(), keys);
        assert_eq!(keys, ["#default", "Paint#0", "Glass", "Paint#2", "#3"]);
        let changed = |key: &str| {
            let values = BTreeMap::from([(key.to_owned(), MaterialValues::new())]);
            assert_eq!(model.unknown_material(values.keys()), None);
            (0..5).filter(|index| model.material_values(*index, &values).is_some()).collect::<Vec<usize>>()
        };
        assert_eq!(changed("Paint#2"), [3]);
        assert_eq!(changed("#2"), [3]);
        assert_eq!(changed("#default"), [0]);
        assert_eq!(changed("Paint"), [1, 3]);
        assert!(model.unknown_material(["Paint#1".to_owned()].iter()).is_some());
        assert!(model.unknown_material([String::new()].iter()).is_some());
    }

    #[test]
    fn cameras_are_named_by_name_or_number() {
        let camera = |name: &str| Camera {
            name: name.into(),
            eye: Vec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            lens: Lens::Perspective { fovy: 1.0 },
        };
        let model = Model { cameras: ["Left", "", "Left", "Top"].map(camera).to_vec(), ..Model::default() };
        let keys: Vec<String> = (0..4).map(|index| model.camera_key(index)).collect();
        assert_eq!(keys, ["#0", "#1", "#2", "Top"]);
        assert!(keys.iter().chain([&"Left".to_owned()]).all(|key| model.camera(key).is_some()));
        let unknown = |name: &str| model.unknown_camera(&CameraSettings { name: name.into(), ..Default::default() });
        assert!(unknown("Topp").unwrap().contains("no camera 'Topp'. Did you mean"));
        assert_eq!((unknown(""), unknown("#4").is_some()), (None, true));
    }
}
