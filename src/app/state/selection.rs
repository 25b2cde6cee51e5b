//! The selection, which the panel Scene or a click in the picture sets.

use crate::frame::Scene;
use crate::scene::{Model, TextureSource};

/// A part of the scene. Indices are into the vectors of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(in crate::app) enum Selected {
    #[default]
    Nothing,
    /// A node with all below it.
    Node(usize),
    /// A primitive of a node.
    Instance(usize),
    Material(usize),
    Texture(TextureSource),
    Camera(usize),
    Light(LightId),
}

/// A light: one of the settings, or one of the model's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::app) enum LightId {
    Orbit(usize),
    Rectangle,
    Model(usize),
}

impl Selected {
    /// Whether each instance belongs to the selection; empty if none does.
    pub(in crate::app) fn instances(self, scene: &Scene) -> Vec<bool> {
        let model = scene.model();
        match self {
            Self::Node(node) => model.named(&[model.node_key(node)]),
            Self::Instance(instance) => (0..model.instances.len()).map(|index| index == instance).collect(),
            Self::Material(material) => {
                model.instances.iter().map(|instance| scene.material_of(instance) == material).collect()
            }
            Self::Nothing | Self::Texture(_) | Self::Camera(_) | Self::Light(_) => Vec::new(),
        }
    }

    /// The selection after a click on an instance: that instance, or nothing if it was already selected.
    pub(in crate::app) fn clicked(self, instance: Option<usize>) -> Self {
        instance.map(Self::Instance).filter(|selected| *selected != self).unwrap_or_default()
    }

    /// The name by which settings hide and isolate it.
    pub(in crate::app) fn key(self, model: &Model) -> Option<String> {
        match self {
            Self::Node(node) => Some(model.node_key(node)),
            Self::Instance(index) => {
                let instance = model.instances.get(index)?;
                let shares_node = |other: &&crate::scene::Instance| other.node == instance.node;
                match model.instances.iter().filter(shares_node).count() {
                    1 => model.node_of(instance).map(|node| model.node_key(node)),
                    _ => Some(model.primitives[instance.primitive].name.clone()),
                }
            }
            _ => None,
        }
    }

    /// The material that it has.
    pub(in crate::app) fn material(self, scene: &Scene) -> Option<usize> {
        let instances = &scene.model().instances;
        match self {
            Self::Material(material) => Some(material),
            Self::Instance(index) => instances.get(index).map(|instance| scene.material_of(instance)),
            Self::Node(_) => common_material(scene, &self.instances(scene)),
            _ => None,
        }
    }

    /// Whether the model has it.
    pub(in crate::app) fn is_in(self, model: &Model) -> bool {
        match self {
            Self::Nothing | Self::Light(LightId::Orbit(_) | LightId::Rectangle) => true,
            Self::Node(node) => node < model.nodes.len(),
            Self::Instance(instance) => instance < model.instances.len(),
            Self::Material(material) => material < model.materials.len(),
            Self::Texture(source) => source.images().all(|image| image < model.images.len()),
            Self::Camera(camera) => camera < model.cameras.len(),
            Self::Light(LightId::Model(light)) => light < model.lights.len(),
        }
    }

    /// Whether both versions of a model contain the selection, under the same name. After a file has changed, an index may refer
    /// to another part.
    pub(in crate::app) fn is_same(self, before: &Model, after: &Model) -> bool {
        self.is_in(before) && self.is_in(after) && self.name(before) == self.name(after)
    }

    fn name(self, model: &Model) -> Option<String> {
        match self {
            Self::Nothing | Self::Light(LightId::Orbit(_) | LightId::Rectangle) => None,
            Self::Node(_) | Self::Instance(_) => self.key(model),
            Self::Material(material) => Some(model.material_key(material)),
            Self::Texture(source) => source.image(model).map(|image| image.name.clone()),
            Self::Camera(camera) => Some(model.cameras[camera].name.to_string()),
            Self::Light(LightId::Model(light)) => Some(model.lights[light].name.to_string()),
        }
    }
}

/// The material that all of these instances have.
pub(in crate::app) fn common_material(scene: &Scene, instances: &[bool]) -> Option<usize> {
    let selected = scene.model().instances.iter().zip(instances).filter(|(_, is)| **is);
    let mut found = selected.map(|(instance, _)| scene.material_of(instance));
    let first = found.next()?;
    found.all(|other| other == first).then_some(first)
}

/// Names of a node, a camera or a light that may have none.
pub(in crate::app) fn name_or(name: &str, other: impl FnOnce() -> String) -> String {
    if name.is_empty() { other() } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::scene::{BUILT_IN, built_in};
    use crate::settings::Settings;

    #[test]
    fn a_selection_knows_its_instances_material_and_name() {
        let model = Arc::new(built_in(BUILT_IN[0]).unwrap().unwrap());
        let scene = Scene::new(&model, &Settings::default());
        for index in 0..model.instances.len() {
            let selected = Selected::Instance(index);
            assert_eq!(selected.instances(&scene).iter().filter(|is| **is).count(), 1);
            let material = selected.material(&scene).unwrap();
            assert!(Selected::Material(material).instances(&scene)[index]);
            let key = selected.key(&model).unwrap();
            assert!(model.named(&[key])[index]);
            assert!(selected.is_in(&model) && !selected.is_in(&Model::default()));
        }
        assert!(Selected::Nothing.instances(&scene).is_empty());
        assert_eq!(common_material(&scene, &[]), None);
    }

    #[test]
    fn a_second_click_selects_nothing() {
        let selected = Selected::Nothing.clicked(Some(2));
        assert_eq!(selected, Selected::Instance(2));
        assert_eq!(selected.clicked(Some(1)), Selected::Instance(1));
        assert_eq!(selected.clicked(Some(2)), Selected::Nothing);
        assert_eq!(selected.clicked(None), Selected::Nothing);
    }

    #[test]
    fn a_part_stays_selected_while_its_name_is_the_same() {
        let before = built_in(BUILT_IN[0]).unwrap().unwrap();
        let mut after = before.clone();
        Arc::make_mut(&mut after.materials)[1].name = "another".into();
        assert!(Selected::Material(1).is_same(&before, &before) && !Selected::Material(1).is_same(&before, &after));
        assert!(Selected::Instance(0).is_same(&before, &after));
        after.instances.clear();
        assert!(!Selected::Instance(0).is_same(&before, &after));
        assert!(Selected::Light(LightId::Orbit(0)).is_same(&before, &after));
    }
}
