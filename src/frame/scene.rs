//! The model as the settings show it: variant (KHR_materials_variants), materials, place, and what is drawn of it.
//!
//! `Scene::loaded` identifies the resources. `Scene::model` stands where `model.*` places it, with its bounds, lights
//! and cameras, and shares the primitives, so framing, shadows, path tracing and picking need not know of the
//! transform. Materials that `materials.*` or `material.override` change get a uniform block and a descriptor set with
//! the same images; nothing is compiled unless a feature appears. A channel of the override reads its texture as 1 by a
//! view of the image with other components (`Image::with_ones`).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::MaterialVariant;
use super::material_variant::shared_features;
use crate::gpu::PrimitiveClass;
use crate::interface::{self, ATTRIBUTE_COLOR};
use crate::scene::{
    self, AlphaMode, Instance, Material, Model, Pose, Sides, Topology, override_material, replace_channels,
    replace_factors,
};
use crate::settings::{MaterialChannel, MaterialOverride, MaterialValues, ModelSettings, SceneSettings, Settings};

/// The settings that turn a model into a scene.
#[derive(Clone, Debug, PartialEq)]
struct Look {
    variant: Option<usize>,
    /// The material override, if it replaces anything.
    material: Option<MaterialOverride>,
    materials: BTreeMap<String, MaterialValues>,
    parts: SceneSettings,
    place: ModelSettings,
}

impl Look {
    /// A variant that the model lacks is ignored: see [`Model::variant`].
    fn new(model: &Model, settings: &Settings) -> Self {
        let material = settings.material;
        Self {
            variant: model.variant(&settings.variant).unwrap_or(None),
            material: (material.enabled || !material.channels.is_empty()).then_some(material),
            materials: settings.materials.clone(),
            parts: settings.scene.clone(),
            place: settings.model,
        }
    }

    fn is_of(&self, model: &Model, settings: &Settings) -> bool {
        let Settings { material, materials, scene, model: place, variant, .. } = settings;
        let replaces = material.enabled || !material.channels.is_empty();
        (&self.materials, &self.parts, &self.place) == (materials, scene, place)
            && self.material == replaces.then_some(*material)
            && self.variant == model.variant(variant).unwrap_or(None)
    }
}

/// A model with the selected variant, materials and transform. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The model that was loaded.
    loaded: Arc<Model>,
    /// The model at the place that the settings give it.
    model: Arc<Model>,
    look: Arc<Look>,
    /// Where the parts of the model are at the moment, with the place that the settings give it. `model` stands there.
    pose: Arc<Pose>,
    /// Whether each instance is drawn. `None` draws all.
    visible: Option<Arc<[bool]>>,
    /// The materials that differ from those of the model, by index; empty if none does.
    changed: Arc<[Option<Material>]>,
    materials: Arc<BTreeSet<MaterialVariant>>,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.has_same_draws(other) && (Arc::ptr_eq(&self.pose, &other.pose) || self.pose == other.pose)
    }
}

/// How one instance is drawn.
pub(crate) struct Appearance {
    /// Index into `Model::materials`; `None` is the material override.
    pub(crate) material: Option<usize>,
    pub(crate) double_sided: bool,
    /// `interface::ATTRIBUTE_*` bits that the shader may use.
    pub(crate) attributes: u32,
    pub(crate) variant: MaterialVariant,
}

impl Scene {
    /// The scene that `settings` select. A variant that the model lacks is ignored: see [`Model::variant`].
    pub fn new(model: &Arc<Model>, settings: &Settings) -> Self {
        Self::with(None, model, settings)
    }

    /// [`Scene::new`], or a clone of `previous` if that is the same scene. Collecting the materials of a large model takes
    /// time.
    pub fn update(previous: Option<&Self>, model: &Arc<Model>, settings: &Settings) -> Self {
        let previous = previous.filter(|scene| Arc::ptr_eq(&scene.loaded, model));
        let is_same = |scene: &&Self| scene.look.is_of(model, settings);
        previous.filter(is_same).cloned().unwrap_or_else(|| Self::with(previous, model, settings))
    }

    /// The same scene with only the instances whose entry is `true`, as far as it draws them.
    pub fn only(&self, mut visible: Vec<bool>) -> Self {
        if let Some(before) = &self.visible {
            visible.iter_mut().zip(before.iter()).for_each(|(now, before)| *now &= before);
        }
        Self { visible: Some(visible.into()), ..self.clone() }.collected()
    }

    fn with(previous: Option<&Self>, loaded: &Arc<Model>, settings: &Settings) -> Self {
        let look = Look::new(loaded, settings);
        let model = match (look.place.transform(), previous.filter(|scene| scene.look.place == look.place)) {
            (None, _) => loaded.clone(),
            (Some(_), Some(previous)) => previous.model.clone(),
            (Some(transform), None) => Arc::new(loaded.placed(transform)),
        };
        let pose = Arc::new(model.rest_pose());
        let scene = Self {
            pose,
            visible: model.visible(&look.parts).map(Into::into),
            changed: changed(&model, &look),
            loaded: loaded.clone(),
            model,
            look: Arc::new(look),
            materials: Arc::default(),
        };
        scene.collected()
    }

    /// The scene with the kinds of its materials.
    fn collected(mut self) -> Self {
        let replacement = self.replacement();
        let drawn = self.instances().map(|instance| self.appearance(instance, replacement.as_ref()).variant);
        let materials = drawn.collect();
        self.materials = Arc::new(materials);
        self
    }

    /// The model at the place that the settings give it.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Where the parts of the model are.
    pub fn pose(&self) -> &Arc<Pose> {
        &self.pose
    }

    /// Whether both draw the same primitives with the same materials, wherever they are.
    pub fn has_same_draws(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.loaded, &other.loaded)
            && (Arc::ptr_eq(&self.look, &other.look) || self.look == other.look)
            && self.visible == other.visible
    }

    /// The model that was loaded.
    pub fn loaded(&self) -> &Arc<Model> {
        &self.loaded
    }

    /// The kinds of material in use.
    pub fn materials(&self) -> &BTreeSet<MaterialVariant> {
        &self.materials
    }

    /// `FEATURE_*` bits of the materials in use, and of the light of `settings`.
    pub fn features(&self, settings: &Settings) -> u32 {
        self.materials.iter().fold(shared_features(settings), |all, material| all | material.features)
    }

    /// Whether an instance is drawn.
    pub fn is_visible(&self, instance: usize) -> bool {
        self.visible.as_ref().is_none_or(|visible| visible.get(instance) == Some(&true))
    }

    /// Which sides of an instance are drawn.
    pub fn sides(&self, instance: usize) -> Sides {
        let Some(placed) = self.model.instances.get(instance).filter(|_| self.is_visible(instance)) else {
            return Sides::None;
        };
        let is_replaced = self.look.material.is_some_and(|material| material.enabled);
        let both = !is_replaced && self.material(self.material_of(placed)).double_sided;
        if both { Sides::Both } else { Sides::Front }
    }

    /// Index into `Model::materials` of the material that an instance has in the selected variant.
    pub fn material_of(&self, instance: &Instance) -> usize {
        self.model.primitives[instance.primitive].material_in(self.look.variant)
    }

    /// A material of the model with the values of the settings.
    pub fn material(&self, index: usize) -> &Material {
        self.changed_material(index).unwrap_or(&self.model.materials[index])
    }

    /// The material with this index, if the settings change it.
    pub(crate) fn changed_material(&self, index: usize) -> Option<&Material> {
        self.changed.get(index).and_then(Option::as_ref)
    }

    /// The instances that are drawn.
    pub(crate) fn instances(&self) -> impl Iterator<Item = &Instance> {
        self.numbered_instances().map(|(_, instance)| instance)
    }

    /// The instances that are drawn, with their indices.
    pub(crate) fn numbered_instances(&self) -> impl Iterator<Item = (usize, &Instance)> {
        self.model.instances.iter().enumerate().filter(|(index, _)| self.is_visible(*index))
    }

    /// The material that replaces all of the model's, if there is one.
    pub(crate) fn replacement(&self) -> Option<Material> {
        self.look.material.as_ref().filter(|material| material.enabled).map(override_material)
    }

    /// How an instance is drawn, given [`Scene::replacement`].
    pub(crate) fn appearance(&self, instance: &Instance, replacement: Option<&Material>) -> Appearance {
        let primitive = &self.model.primitives[instance.primitive];
        let own = self.material_of(instance);
        let material = replacement.unwrap_or_else(|| self.material(own));
        // Vertex colors belong to the replaced base color.
        let has_own_color = replacement.is_none() && !material.constant.has(MaterialChannel::BaseColor);
        let attributes = if has_own_color { primitive.attributes } else { primitive.attributes & !ATTRIBUTE_COLOR };
        Appearance {
            material: replacement.is_none().then_some(own),
            double_sided: material.double_sided,
            attributes,
            variant: MaterialVariant {
                alpha: match material.alpha_mode {
                    AlphaMode::Opaque => interface::ALPHA_OPAQUE,
                    AlphaMode::Mask => interface::ALPHA_MASK,
                    AlphaMode::Blend => interface::ALPHA_BLEND,
                },
                features: scene::features(&self.model, material, attributes, primitive.topology),
                class: match primitive.topology {
                    Topology::Points => PrimitiveClass::Points,
                    Topology::Lines | Topology::LineStrip => PrimitiveClass::Lines,
                    Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan => PrimitiveClass::Triangles,
                },
            },
        }
    }
}

/// The materials that the settings change, by their indices; empty if they change none.
fn changed(model: &Model, look: &Look) -> Arc<[Option<Material>]> {
    let channels = look.material.as_ref().filter(|material| !material.enabled);
    if channels.is_none() && look.materials.is_empty() {
        return Arc::default();
    }
    let change = |(index, material): (usize, &Material)| {
        let values = model.material_values(index, &look.materials);
        if channels.is_none() && values.is_none() {
            return None;
        }
        let mut material = material.clone();
        values.into_iter().for_each(|values| replace_factors(&mut material, values));
        channels.into_iter().for_each(|channels| replace_channels(&mut material, channels));
        Some(material)
    };
    model.materials.iter().enumerate().map(change).collect()
}
