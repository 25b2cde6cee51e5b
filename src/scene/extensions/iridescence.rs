//! KHR_materials_iridescence: a thin film.

use super::descriptor::{Extension, bit_if, factor};
use crate::interface::{FEATURE_IRIDESCENCE, TEXTURE_IRIDESCENCE, TEXTURE_IRIDESCENCE_THICKNESS};
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_iridescence",
    read: |reader| {
        let ior = reader.within("iridescenceIor", 1.3, 1.0..=f32::MAX)?;
        let thickest = reader.at_least_0("iridescenceThicknessMaximum", 400.0)?;
        let thickness = [reader.at_least_0("iridescenceThicknessMinimum", 100.0)?, thickest];
        reader.material.numbers.iridescence_factor = reader.unit("iridescenceFactor", 0.0)?;
        reader.material.numbers.iridescence_ior = ior;
        reader.material.numbers.iridescence_thickness_nm = thickness;
        reader.texture("iridescenceTexture", TEXTURE_IRIDESCENCE);
        reader.texture("iridescenceThicknessTexture", TEXTURE_IRIDESCENCE_THICKNESS);
        Ok(())
    },
    features: |material, _| {
        let [at_0, at_1] = material.numbers.iridescence_thickness_nm;
        let has_film = at_1 > 0.0 || (at_0 > 0.0 && material.has(TEXTURE_IRIDESCENCE_THICKNESS));
        bit_if(FEATURE_IRIDESCENCE, has_film && is_used(material))
    },
    factors: &[
        factor!(Iridescence, iridescence_factor).used(is_used),
        factor!(IridescenceIor, iridescence_ior).used(is_used),
        factor!(IridescenceThickness, iridescence_thickness_nm[1]).used(is_used),
    ],
};

fn is_used(material: &Material) -> bool {
    material.numbers.iridescence_factor > 0.0
}
