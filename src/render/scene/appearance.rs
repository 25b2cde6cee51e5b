//! A scene in other materials: a variant of the model's (KHR_materials_variants), or one material over all. Nothing is uploaded
//! again but that one material.

use std::sync::{Arc, PoisonError};

use crate::gpu::{Gpu, GpuError, SetLayouts};
use crate::interface::ATTRIBUTE_COLOR;
use crate::scene::{Material, Model, override_material};
use crate::settings::{MaterialOverride, Settings};

use crate::render::scene::materials::{materials, variant};
use crate::render::scene::{GpuDraw, GpuScene};

/// What a scene can be dressed in.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dress {
    variant: Option<usize>,
    material: Option<MaterialOverride>,
}

impl GpuScene {
    /// The scene of `model` in the variant and the material that the settings name; itself when they name none. A variant that
    /// the model does not have counts as none: see [`Model::variant`].
    ///
    /// # Errors
    /// Out of memory.
    pub fn dressed(
        self: &Arc<Self>,
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        model: &Model,
        settings: &Settings,
    ) -> Result<Arc<Self>, GpuError> {
        let dress = Dress {
            variant: model.variant(&settings.variant).unwrap_or(None),
            material: settings.material.enabled.then_some(settings.material),
        };
        if dress.variant.is_none() && dress.material.is_none() {
            return Ok(self.clone());
        }
        let mut last = self.last_dress.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, scene)) = last.as_ref().filter(|(worn, _)| *worn == dress) {
            return Ok(scene.clone());
        }
        let over = dress.material.as_ref().map(override_material);
        let mut sets = self.materials.clone();
        if let Some(material) = &over {
            let alone = Model { materials: vec![material.clone()], ..Model::default() };
            sets.extend(materials(gpu, layouts, &alone, &self.stand_ins)?);
        }
        let last_set = sets.len() - 1;
        let draws = self.draws.iter().map(|draw| dressed_draw(draw, model, &dress, over.as_ref(), last_set));
        let scene = self.with(sets, draws.collect());
        *last = Some((dress, scene.clone()));
        Ok(scene)
    }
}

fn dressed_draw(draw: &GpuDraw, model: &Model, dress: &Dress, over: Option<&Material>, last_set: usize) -> GpuDraw {
    let Some(primitive) = model.primitives.get(draw.push.primitive_id as usize) else { return draw.clone() };
    let own = primitive.material_in(dress.variant);
    let (index, material) = over.map_or((own, &model.materials[own]), |over| (last_set, over));
    // Colors of the vertices belong to the material that is replaced.
    let mut push = draw.push;
    if over.is_some() {
        push.attributes &= !ATTRIBUTE_COLOR;
    }
    GpuDraw {
        material: index,
        double_sided: material.double_sided,
        variant: variant(model, primitive, material, push.attributes),
        push,
        ..draw.clone()
    }
}
