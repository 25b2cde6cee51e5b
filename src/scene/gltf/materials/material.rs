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
use crate::scene::gltf::left_out::{LeftOut, Part};
use crate::scene::gltf::place::place;
use crate::scene::gltf::values::{self, Extensions, Fields, clamp};
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

/// Reads all materials. An extension, texture or number that cannot be used costs itself alone.
pub fn read(root: &json::Root, left_out: &mut LeftOut) -> Materials {
    let mut collector = Collector::new(root);
    let mut materials = vec![Material::default()];
    for (index, material) in root.materials.iter().enumerate() {
        let place = place("materials", index, material.name.as_deref());
        materials.push(read_one(material, &place, &mut collector));
    }
    let Collector { textures, images, warnings, left_out: of_materials, .. } = collector;
    left_out.append(of_materials);
    Materials { materials, textures, images, warnings }
}

fn read_one(source: &json::Material, place: &str, collector: &mut Collector<'_>) -> Material {
    let known = source.extensions.as_ref();
    let alpha_mode = collector.left_out.unless(Part::ALPHA_MODE, place, alpha_mode(source, place));
    let mut material = Material {
        name: source.name.clone().unwrap_or_default(),
        alpha_mode: alpha_mode.unwrap_or_default(),
        double_sided: source.double_sided,
        unlit: known.is_some_and(|extensions| extensions.unlit.is_some()),
        ..Material::default()
    };
    if let Some(cutoff) = source.alpha_cutoff {
        let place = format!("{place}.alphaCutoff");
        material.numbers.alpha_cutoff = clamp(cutoff.0, 0.0..=f32::MAX, &place, &mut collector.warnings);
    }
    let others = known.map(|extensions| &extensions.others).cloned().unwrap_or_default();
    extensions(&mut material, &others, |name| name == SPECULAR_GLOSSINESS, place, collector);
    // If a material has specular-glossiness, its metallic-roughness is only a fallback. Both use the same members.
    if !material.specular_glossiness {
        metallic_roughness(&mut material, &source.pbr_metallic_roughness, place, collector);
    }
    relief(&mut material, source, place, collector);
    emission(&mut material, source, place, collector);
    extensions(&mut material, &others, |name| name != SPECULAR_GLOSSINESS, place, collector);
    let conductor = conductor::read(&mut material, source, place);
    collector.left_out.unless(Part::EXTENSION, place, conductor);
    material
}

/// Reads the extensions with chosen names.
fn extensions(
    material: &mut Material,
    others: &Extensions,
    is_chosen: impl Fn(&str) -> bool,
    place: &str,
    collector: &mut Collector<'_>,
) {
    let place = format!("{place}.extensions");
    let is_read = |name: &str| is_chosen(name) && others.contains_key(name);
    for extension in EXTENSIONS.iter().filter(|extension| is_read(extension.name)) {
        let before = material.clone();
        let read = Fields::open(others, extension.name, &place).and_then(|fields| match fields {
            Some(fields) => (extension.read)(&mut Reader { material, collector, fields, others }),
            None => Ok(()),
        });
        if collector.left_out.unless(Part::EXTENSION, &place, read).is_none() {
            *material = before;
        }
    }
}

fn metallic_roughness(
    material: &mut Material,
    pbr: &json::material::PbrMetallicRoughness,
    place: &str,
    collector: &mut Collector<'_>,
) {
    let at = |name: &str| format!("{place}.pbrMetallicRoughness.{name}");
    let mut base = pbr.base_color_factor.0;
    for channel in &mut base {
        *channel = clamp(*channel, 0.0..=1.0, &at("baseColorFactor"), &mut collector.warnings);
    }
    material.numbers.base_color_factor = base;
    material.numbers.metallic_factor =
        clamp(pbr.metallic_factor.0, 0.0..=1.0, &at("metallicFactor"), &mut collector.warnings);
    material.numbers.roughness_factor =
        clamp(pbr.roughness_factor.0, 0.0..=1.0, &at("roughnessFactor"), &mut collector.warnings);
    let slot = Ok(pbr.base_color_texture.as_ref().map(TextureSlot::new));
    collector.bind(material, contract::TEXTURE_BASE_COLOR, slot, &at("baseColorTexture"));
    let slot = Ok(pbr.metallic_roughness_texture.as_ref().map(TextureSlot::new));
    collector.bind(material, contract::TEXTURE_METALLIC_ROUGHNESS, slot, &at("metallicRoughnessTexture"));
}

/// Reads the normal and occlusion textures.
fn relief(material: &mut Material, source: &json::Material, place: &str, collector: &mut Collector<'_>) {
    if let Some(normal) = &source.normal_texture {
        let place = format!("{place}.normalTexture");
        let scale = values::finite(normal.scale, &format!("{place}.scale"));
        material.numbers.normal_scale = collector.left_out.unless(Part::NUMBER, &place, scale).unwrap_or(1.0);
        let others = normal.extensions.as_ref().map(|extensions| &extensions.others);
        let slot = TextureSlot::raw(normal.index.value(), normal.tex_coord, others, &place);
        collector.bind(material, contract::TEXTURE_NORMAL, slot.map(Some), &place);
    }
    if let Some(occlusion) = &source.occlusion_texture {
        let place = format!("{place}.occlusionTexture");
        let strength = format!("{place}.strength");
        material.numbers.occlusion_strength =
            clamp(occlusion.strength.0, 0.0..=1.0, &strength, &mut collector.warnings);
        let others = occlusion.extensions.as_ref().map(|extensions| &extensions.others);
        let slot = TextureSlot::raw(occlusion.index.value(), occlusion.tex_coord, others, &place);
        collector.bind(material, contract::TEXTURE_OCCLUSION, slot.map(Some), &place);
    }
}

fn emission(material: &mut Material, source: &json::Material, place: &str, collector: &mut Collector<'_>) {
    let at = |name: &str| format!("{place}.{name}");
    let strength =
        source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    let strength = clamp(strength, 0.0..=f32::MAX, &at("emissiveStrength"), &mut collector.warnings);
    let mut factor = source.emissive_factor.0;
    for channel in &mut factor {
        *channel = clamp(*channel, 0.0..=1.0, &at("emissiveFactor"), &mut collector.warnings);
    }
    // Finite, since no factor is above 1.
    material.numbers.emissive_factor = (Vec3::from(factor) * strength).to_array();
    let slot = Ok(source.emissive_texture.as_ref().map(TextureSlot::new));
    collector.bind(material, contract::TEXTURE_EMISSIVE, slot, &at("emissiveTexture"));
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
