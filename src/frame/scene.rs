//! The model with the selected variant (KHR_materials_variants) and material override.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::MaterialVariant;
use crate::gpu::PrimitiveClass;
use crate::interface::{self, ATTRIBUTE_COLOR, FEATURE_TRANSMISSION};
use crate::scene::{self, AlphaMode, Instance, Material, Model, Topology, override_material};
use crate::settings::{MaterialOverride, Settings};

/// A model with the variant and material override of the settings. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Scene {
    model: Arc<Model>,
    variant: Option<usize>,
    material_override: Option<MaterialOverride>,
    /// Whether each instance is drawn. `None` draws all.
    visible: Option<Arc<[bool]>>,
    materials: Arc<BTreeSet<MaterialVariant>>,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model)
            && self.variant == other.variant
            && self.material_override == other.material_override
            && self.visible == other.visible
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
        Self::with(model, model.variant(&settings.variant).unwrap_or(None), override_of(settings), None)
    }

    /// [`Scene::new`], or a clone of `previous` if that is the same scene. Collecting the materials of a large model takes
    /// time.
    pub fn update(previous: Option<&Self>, model: &Arc<Model>, settings: &Settings) -> Self {
        let variant = model.variant(&settings.variant).unwrap_or(None);
        let is_same = |scene: &&Self| {
            Arc::ptr_eq(&scene.model, model)
                && (scene.variant, scene.material_override) == (variant, override_of(settings))
        };
        previous.filter(is_same).cloned().unwrap_or_else(|| Self::new(model, settings))
    }

    /// The same scene with only the instances whose entry is `true`.
    pub fn only(&self, visible: Vec<bool>) -> Self {
        Self::with(&self.model, self.variant, self.material_override, Some(visible.into()))
    }

    fn with(
        model: &Arc<Model>,
        variant: Option<usize>,
        material_override: Option<MaterialOverride>,
        visible: Option<Arc<[bool]>>,
    ) -> Self {
        let mut scene = Self { model: model.clone(), variant, material_override, visible, materials: Arc::default() };
        let replacement = scene.replacement();
        let drawn = scene.instances().map(|instance| scene.appearance(instance, replacement.as_ref()).variant);
        scene.materials = Arc::new(drawn.collect());
        scene
    }

    /// The model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The kinds of material in use.
    pub fn materials(&self) -> &BTreeSet<MaterialVariant> {
        &self.materials
    }

    /// Whether a material is transmissive, so that the surfaces behind it must be drawn first.
    pub fn is_transmissive(&self) -> bool {
        self.materials.iter().any(|material| material.features & FEATURE_TRANSMISSION != 0)
    }

    /// The instances that are drawn.
    pub(crate) fn instances(&self) -> impl Iterator<Item = &Instance> {
        let is_visible = |index: usize| self.visible.as_ref().is_none_or(|visible| visible.get(index) == Some(&true));
        self.model.instances.iter().enumerate().filter(move |(index, _)| is_visible(*index)).map(|(_, i)| i)
    }

    /// Index of the material of an instance in `Model::materials`; `None` is the material override.
    pub(crate) fn material_of(&self, instance: &Instance) -> Option<usize> {
        let own = self.model.primitives.get(instance.primitive).map(|primitive| primitive.material_in(self.variant));
        own.filter(|_| self.material_override.is_none())
    }

    /// The material override, if it is enabled.
    pub(crate) fn replacement(&self) -> Option<Material> {
        self.material_override.as_ref().map(override_material)
    }

    /// How an instance is drawn, given [`Scene::replacement`].
    pub(crate) fn appearance(&self, instance: &Instance, replacement: Option<&Material>) -> Appearance {
        let primitive = &self.model.primitives[instance.primitive];
        let own = primitive.material_in(self.variant);
        let material = replacement.unwrap_or(&self.model.materials[own]);
        // Vertex colors belong to the replaced material.
        let attributes =
            if replacement.is_some() { primitive.attributes & !ATTRIBUTE_COLOR } else { primitive.attributes };
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
                features: scene::features(&self.model, material, attributes),
                class: match primitive.topology {
                    Topology::Points => PrimitiveClass::Points,
                    Topology::Lines | Topology::LineStrip => PrimitiveClass::Lines,
                    Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan => PrimitiveClass::Triangles,
                },
            },
        }
    }
}

fn override_of(settings: &Settings) -> Option<MaterialOverride> {
    settings.material.enabled.then_some(settings.material)
}
