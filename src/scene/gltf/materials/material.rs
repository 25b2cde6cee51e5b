//! Reads materials: their core properties here, the rest by the descriptors of `scene::extensions`.

use glam::Vec3;
use gltf::json;
use json::validation::Checked;

use super::conductor;
use super::reader::Reader;
use super::textures::{Collector, Origin, TextureSlot};
use crate::interface as contract;
use crate::scene::error::Problem;
use crate::scene::extensions::{EXTENSIONS, SPECULAR_GLOSSINESS};
use crate::scene::gltf::place::place;
use crate::scene::gltf::values::{self, Extensions, Fields, clamp, roughness};
use crate::scene::model::{AlphaMode, Material, Texture};

/// The materials of a file, with the textures and images that they use.
pub struct Materials {
    /// The default material, then the file's.
    pub materials: Vec<Material>,
    /// Used pairs of image and sampler.
    pub textures: Vec<Texture>,
    /// Where the used images are. `Texture::image` counts these.
    pub images: Vec<Origin>,
    /// Corrected values, one sentence each.
    pub warnings: Vec<String>,
}

/// Reads all materials.
pub fn read(root: &json::Root) -> Result<Materials, Problem> {
    let mut collector = Collector::new(root);
    let mut materials = vec![Material::default()];
    for (index, material) in root.materials.iter().enumerate() {
        let place = place("materials", index, material.name.as_deref());
        materials.push(read_one(material, &place, &mut collector)?);
    }
    let Collector { textures, images, warnings, .. } = collector;
    Ok(Materials { materials, textures, images, warnings })
}

fn read_one(source: &json::Material, place: &str, collector: &mut Collector<'_>) -> Result<Material, Problem> {
    let known = source.extensions.as_ref();
    let mut material = Material {
        name: source.name.clone().unwrap_or_default(),
        alpha_mode: alpha_mode(source, place)?,
        double_sided: source.double_sided,
        unlit: known.is_some_and(|extensions| extensions.unlit.is_some()),
        ..Material::default()
    };
    if let Some(cutoff) = source.alpha_cutoff {
        let place = format!("{place}.alphaCutoff");
        material.numbers.alpha_cutoff = clamp(cutoff.0, 0.0..=f32::MAX, &place, &mut collector.warnings)?;
    }
    let others = known.map(|extensions| &extensions.others).cloned().unwrap_or_default();
    // If a material has specular-glossiness, its metallic-roughness is only a fallback. Both use the same members.
    if others.contains_key(SPECULAR_GLOSSINESS) {
        extensions(&mut material, &others, |name| name == SPECULAR_GLOSSINESS, place, collector)?;
    } else {
        metallic_roughness(&mut material, &source.pbr_metallic_roughness, place, collector)?;
    }
    relief(&mut material, source, place, collector)?;
    emission(&mut material, source, place, collector)?;
    extensions(&mut material, &others, |name| name != SPECULAR_GLOSSINESS, place, collector)?;
    conductor::read(&mut material, source, place)?;
    Ok(material)
}

/// Reads the extensions with chosen names.
fn extensions(
    material: &mut Material,
    others: &Extensions,
    is_chosen: impl Fn(&str) -> bool,
    place: &str,
    collector: &mut Collector<'_>,
) -> Result<(), Problem> {
    let place = format!("{place}.extensions");
    for extension in EXTENSIONS.iter().filter(|extension| is_chosen(extension.name)) {
        if let Some(fields) = Fields::open(others, extension.name, &place)? {
            (extension.read)(&mut Reader { material, collector, fields, others })?;
        }
    }
    Ok(())
}

fn metallic_roughness(
    material: &mut Material,
    pbr: &json::material::PbrMetallicRoughness,
    place: &str,
    collector: &mut Collector<'_>,
) -> Result<(), Problem> {
    let at = |name: &str| format!("{place}.pbrMetallicRoughness.{name}");
    let mut base = pbr.base_color_factor.0;
    for channel in &mut base {
        *channel = clamp(*channel, 0.0..=1.0, &at("baseColorFactor"), &mut collector.warnings)?;
    }
    material.numbers.base_color_factor = base;
    material.numbers.metallic_factor =
        clamp(pbr.metallic_factor.0, 0.0..=1.0, &at("metallicFactor"), &mut collector.warnings)?;
    material.numbers.roughness_factor = roughness(pbr.roughness_factor.0, &at("roughnessFactor"))?;
    let slot = pbr.base_color_texture.as_ref().map(TextureSlot::new);
    collector.bind(material, contract::TEXTURE_BASE_COLOR, slot, &at("baseColorTexture"))?;
    let slot = pbr.metallic_roughness_texture.as_ref().map(TextureSlot::new);
    collector.bind(material, contract::TEXTURE_METALLIC_ROUGHNESS, slot, &at("metallicRoughnessTexture"))
}

/// Reads the normal and occlusion textures.
fn relief(
    material: &mut Material,
    source: &json::Material,
    place: &str,
    collector: &mut Collector<'_>,
) -> Result<(), Problem> {
    if let Some(normal) = &source.normal_texture {
        let place = format!("{place}.normalTexture");
        material.numbers.normal_scale = values::finite(normal.scale, &format!("{place}.scale"))?;
        let others = normal.extensions.as_ref().map(|extensions| &extensions.others);
        let slot = TextureSlot::raw(normal.index.value(), normal.tex_coord, others, &place)?;
        collector.bind(material, contract::TEXTURE_NORMAL, Some(slot), &place)?;
    }
    if let Some(occlusion) = &source.occlusion_texture {
        let place = format!("{place}.occlusionTexture");
        let strength = format!("{place}.strength");
        material.numbers.occlusion_strength =
            clamp(occlusion.strength.0, 0.0..=1.0, &strength, &mut collector.warnings)?;
        let others = occlusion.extensions.as_ref().map(|extensions| &extensions.others);
        let slot = TextureSlot::raw(occlusion.index.value(), occlusion.tex_coord, others, &place)?;
        collector.bind(material, contract::TEXTURE_OCCLUSION, Some(slot), &place)?;
    }
    Ok(())
}

fn emission(
    material: &mut Material,
    source: &json::Material,
    place: &str,
    collector: &mut Collector<'_>,
) -> Result<(), Problem> {
    let at = |name: &str| format!("{place}.{name}");
    let strength =
        source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    let strength = clamp(strength, 0.0..=f32::MAX, &at("emissiveStrength"), &mut collector.warnings)?;
    let mut factor = source.emissive_factor.0;
    for channel in &mut factor {
        *channel = clamp(*channel, 0.0..=1.0, &at("emissiveFactor"), &mut collector.warnings)?;
    }
    let emission = Vec3::from(factor) * strength;
    if !emission.is_finite() {
        return Err(Problem::invalid(place, "a finite emission", emission.to_string()));
    }
    material.numbers.emissive_factor = emission.to_array();
    let slot = source.emissive_texture.as_ref().map(TextureSlot::new);
    collector.bind(material, contract::TEXTURE_EMISSIVE, slot, &at("emissiveTexture"))
}

fn alpha_mode(material: &json::Material, place: &str) -> Result<AlphaMode, Problem> {
    match material.alpha_mode {
        Checked::Valid(json::material::AlphaMode::Opaque) => Ok(AlphaMode::Opaque),
        Checked::Valid(json::material::AlphaMode::Mask) => Ok(AlphaMode::Mask),
        Checked::Valid(json::material::AlphaMode::Blend) => Ok(AlphaMode::Blend),
        Checked::Invalid => {
            Err(Problem::invalid(format!("{place}.alphaMode"), "OPAQUE, MASK or BLEND", "another word"))
        }
    }
}
