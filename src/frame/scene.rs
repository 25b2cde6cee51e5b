//! The model as the settings show it: variant (KHR_materials_variants), materials, place, and what is drawn of it.
//!
//! `Scene::loaded` identifies the resources. `Scene::model` stands where `model.*` places it, with its bounds, lights
//! and cameras, in the pose of a moment, and shares what does not move, so framing, shadows, path tracing and picking need
//! not know of either. Materials that `materials.*` or `material.override` change get a uniform block and a descriptor set with
//! the same images; nothing is compiled unless a feature appears. A channel of the override reads its texture as 1 by a
//! view of the image with other components (`Image::with_ones`).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::MaterialVariant;
use super::material_variant::shared_features;
use crate::gpu::PrimitiveClass;
use crate::interface::{self, ATTRIBUTE_COLOR};
use crate::scene::{
    self, AlphaMode, Instance, Material, Model, Places, Playing, Pose, Sides, Topology, moved_materials,
    override_material, replace_channels, replace_factors,
};
use crate::settings::{
    AddedModel, AnimationSettings, MaterialChannel, MaterialOverride, MaterialValues, ModelSettings, SceneSettings,
    Settings,
};

/// The settings that turn a model into a scene.
#[derive(Clone, Debug, PartialEq)]
struct Look {
    variant: Option<usize>,
    /// The material override, if it replaces anything.
    material: Option<MaterialOverride>,
    materials: BTreeMap<String, MaterialValues>,
    parts: SceneSettings,
    place: ModelSettings,
    added: Vec<AddedModel>,
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
            added: settings.added.clone(),
        }
    }

    fn places(&self, model: &Model) -> Places {
        model.places(&self.place, &self.added)
    }

    fn is_of(&self, model: &Model, settings: &Settings) -> bool {
        let Settings { material, materials, scene, model: place, added, variant, .. } = settings;
        let replaces = material.enabled || !material.channels.is_empty();
        (&self.materials, &self.parts, &self.place, &self.added) == (materials, scene, place, added)
            && self.material == replaces.then_some(*material)
            && self.variant == model.variant(variant).unwrap_or(None)
    }
}

/// A model with the selected variant, materials and transform. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The model that was loaded.
    loaded: Arc<Model>,
    /// The model at the place that the settings give it, in the pose of the moment.
    model: Arc<Model>,
    look: Arc<Look>,
    /// The clips that give the pose, with their time.
    playing: Arc<[Playing]>,
    /// The morph weights that the settings hold: [`Model::held_weights`].
    held: Arc<[(usize, f32)]>,
    /// Whether the pose depends on the time.
    is_animated: bool,
    /// Whether it changes as the clock goes on. A clip that is not repeated ends.
    is_playing: bool,
    /// Whether the settings let each instance be drawn. `None`: all. The pose may hide more.
    visible: Option<Arc<[bool]>>,
    /// The materials that differ from those of the model, by index; empty if none does.
    changed: Arc<[Option<Material>]>,
    materials: Arc<BTreeSet<MaterialVariant>>,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        self.has_same_draws(other) && (Arc::ptr_eq(&self.model, &other.model) || self.model.pose == other.model.pose)
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
    /// The scene that `settings` select when the clock is at 0. A variant that the model lacks is ignored: see [`Model::variant`].
    pub fn new(model: &Arc<Model>, settings: &Settings) -> Self {
        Self::with(model, settings, 0.0)
    }

    /// The scene when the clock is at `time_s`: `previous` in another pose if only that differs. Collecting the materials of a large
    /// model takes time.
    pub fn update(previous: Option<&Self>, model: &Arc<Model>, settings: &Settings, time_s: f32) -> Self {
        let is_same = |scene: &&Self| Arc::ptr_eq(&scene.loaded, model) && scene.look.is_of(model, settings);
        match previous.filter(is_same) {
            Some(scene) => scene.at(&settings.animation, time_s),
            None => Self::with(model, settings, time_s),
        }
    }

    /// The same scene when the clock is at `time_s`, with these animations.
    #[must_use]
    pub fn at(&self, animation: &AnimationSettings, time_s: f32) -> Self {
        let playing = self.loaded.playing(animation, time_s);
        let is_animated = self.loaded.is_animated(animation, &playing);
        let is_playing = self.loaded.is_playing(animation, &playing);
        let held = self.loaded.held_weights(animation);
        if *self.playing == *playing && *self.held == *held {
            return Self { is_animated, is_playing, ..self.clone() };
        }
        let places = self.look.places(&self.loaded);
        let are_same = |(a, b): (&Playing, &Playing)| (a.clip, a.weight) == (b.clip, b.weight);
        let is_same_mix = *self.held == *held
            && self.playing.len() == playing.len()
            && self.playing.iter().zip(&playing).all(are_same);
        let extent = if is_same_mix { self.model.whole_extent() } else { self.loaded.extent(&playing, &held, &places) };
        let model = Arc::new(self.loaded.posed(&self.loaded.pose_with(&playing, &held, &places).into(), &extent));
        let has_same_materials = model.pose.has_same_materials(&self.model.pose);
        let (playing, held) = (playing.into(), held.into());
        let scene = Self { model, playing, held, is_animated, is_playing, ..self.clone() };
        if has_same_materials {
            return scene;
        }
        Self { changed: changed(&scene.model, &scene.look), ..scene }.collected()
    }

    /// The same scene with only the instances whose entry is `true`, as far as it draws them.
    pub fn only(&self, mut visible: Vec<bool>) -> Self {
        if let Some(before) = &self.visible {
            visible.iter_mut().zip(before.iter()).for_each(|(now, before)| *now &= before);
        }
        Self { visible: Some(visible.into()), ..self.clone() }.collected()
    }

    fn with(loaded: &Arc<Model>, settings: &Settings, time_s: f32) -> Self {
        let look = Look::new(loaded, settings);
        let playing = loaded.playing(&settings.animation, time_s);
        let held = loaded.held_weights(&settings.animation);
        let places = look.places(loaded);
        let model = match (&places, playing.as_slice(), held.as_slice()) {
            (places, [], []) if *places == Places::default() => loaded.clone(),
            (Places { whole: Some(place), .. }, [], []) => Arc::new(loaded.placed(*place)),
            (places, playing, held) => Arc::new(loaded.at(playing, held, places)),
        };
        let scene = Self {
            is_animated: loaded.is_animated(&settings.animation, &playing),
            is_playing: loaded.is_playing(&settings.animation, &playing),
            playing: playing.into(),
            held: held.into(),
            visible: model.visible(&look.parts).map(Into::into),
            changed: changed(&model, &look),
            loaded: loaded.clone(),
            model,
            look: Arc::new(look),
            materials: Arc::default(),
        };
        scene.collected()
    }

    /// The scene with the kinds of its materials, also of what a pose hides: so no pipeline is missing when a clip shows it.
    fn collected(mut self) -> Self {
        let replacement = self.replacement();
        let drawn =
            self.wanted_instances().map(|(_, instance)| self.appearance(instance, replacement.as_ref()).variant);
        let materials = drawn.collect();
        self.materials = Arc::new(materials);
        self
    }

    /// The model at the place that the settings give it, in the pose of the moment.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Where the parts of the model are.
    pub fn pose(&self) -> &Arc<Pose> {
        &self.model.pose
    }

    /// Whether the pose depends on the time.
    pub fn is_animated(&self) -> bool {
        self.is_animated
    }

    /// Whether the pose changes as the clock goes on.
    pub fn is_playing(&self) -> bool {
        self.is_playing
    }

    /// Whether both draw the same primitives with the same materials, wherever they are, as far as their poses do not hide them.
    pub fn has_same_draws(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.loaded, &other.loaded)
            && (Arc::ptr_eq(&self.look, &other.look) || self.look == other.look)
            && self.visible == other.visible
            && self.model.pose.has_same_materials(&other.model.pose)
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
        self.is_wanted(instance) && !self.model.pose.hidden.instance(instance)
    }

    /// Whether the settings let an instance be drawn.
    pub fn is_wanted(&self, instance: usize) -> bool {
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

    /// The first instance that is drawn with a kind of material.
    pub(crate) fn instance_with(&self, material: MaterialVariant) -> Option<usize> {
        let replacement = self.replacement();
        let is_it = |instance: &Instance| self.appearance(instance, replacement.as_ref()).variant == material;
        self.wanted_instances().find(|(_, instance)| is_it(instance)).map(|(index, _)| index)
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
    pub(crate) fn visible_instances(&self) -> impl Iterator<Item = &Instance> {
        let visible = self.model.instances.iter().enumerate().filter(|(index, _)| self.is_visible(*index));
        visible.map(|(_, instance)| instance)
    }

    /// The instances that are drawn in some pose, with their indices.
    pub(crate) fn wanted_instances(&self) -> impl Iterator<Item = (usize, &Instance)> {
        self.model.instances.iter().enumerate().filter(|(index, _)| self.is_wanted(*index))
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

/// The materials that the settings or animations change, by their indices; empty if they change none.
fn changed(model: &Model, look: &Look) -> Arc<[Option<Material>]> {
    let channels = look.material.as_ref().filter(|material| !material.enabled);
    let moved: BTreeMap<usize, Material> = moved_materials(&model.materials, &model.pose.values).into_iter().collect();
    if channels.is_none() && look.materials.is_empty() && moved.is_empty() {
        return Arc::default();
    }
    let change = |(index, material): (usize, &Material)| {
        let values = model.material_values(index, &look.materials);
        let moved = moved.get(&index);
        if channels.is_none() && values.is_none() && moved.is_none() {
            return None;
        }
        let mut material = moved.unwrap_or(material).clone();
        values.into_iter().for_each(|values| replace_factors(&mut material, values));
        channels.into_iter().for_each(|channels| replace_channels(&mut material, channels));
        Some(material)
    };
    model.materials.iter().enumerate().map(change).collect()
}
