//! Reads the material extensions, and Specula's data in a material's `extras`.

use glam::{Vec3, Vec4};
use gltf::json;

use super::textures::Collector;
use crate::interface as contract;
use crate::scene::error::Problem;
use crate::scene::gltf::values::{self, Fields};
use crate::scene::model::{
    Anisotropy, Clearcoat, Conductor, DiffuseTransmission, Iridescence, Material, Sheen, Specular, Volume,
};

/// Far above any real material. Its square is still finite in `f32`.
const LARGEST_IOR: f32 = 1e4;
const SPECULAR: &str = "KHR_materials_specular";
const SPECULAR_GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";

/// The arguments of a function that reads an extension.
struct Reader<'a, 'root> {
    material: &'a mut Material,
    collector: &'a mut Collector<'root>,
    fields: Fields<'a>,
}

/// A function that reads an extension.
type Read = fn(&mut Reader<'_, '_>) -> Result<(), Problem>;

const READERS: &[(&str, Read)] = &[
    ("KHR_materials_anisotropy", anisotropy),
    ("KHR_materials_clearcoat", clearcoat),
    ("KHR_materials_diffuse_transmission", diffuse_transmission),
    ("KHR_materials_dispersion", dispersion),
    ("KHR_materials_iridescence", iridescence),
    ("KHR_materials_sheen", sheen),
    (SPECULAR, specular),
    ("KHR_materials_transmission", transmission),
    ("KHR_materials_volume", volume),
];

/// Reads all extensions of a material except specular-glossiness and those that the parser knows.
pub fn read(
    material: &mut Material,
    source: &json::Material,
    place: &str,
    collector: &mut Collector<'_>,
) -> Result<(), Problem> {
    if let Some(others) = source.extensions.as_ref().map(|extensions| &extensions.others) {
        let place = format!("{place}.extensions");
        for (name, read) in READERS {
            if let Some(fields) = Fields::open(others, name, &place)? {
                read(&mut Reader { material, collector, fields })?;
            }
        }
        if let Some(fields) = Fields::open(others, "KHR_materials_ior", &place)? {
            let reflects = others.contains_key(SPECULAR) || others.contains_key(SPECULAR_GLOSSINESS);
            ior(&mut Reader { material, collector, fields }, reflects)?;
        }
    }
    conductor(material, source, place)
}

/// Reads specular-glossiness. Returns `false` if the material does not have it.
pub fn specular_glossiness(
    material: &mut Material,
    source: &json::Material,
    place: &str,
    collector: &mut Collector<'_>,
) -> Result<bool, Problem> {
    let Some(others) = source.extensions.as_ref().map(|extensions| &extensions.others) else { return Ok(false) };
    let Some(fields) = Fields::open(others, SPECULAR_GLOSSINESS, &format!("{place}.extensions"))? else {
        return Ok(false);
    };
    let mut reader = Reader { material, collector, fields };
    let diffuse = reader.unit_all("diffuseFactor", [1.0; 4])?;
    let specular = reader.unit_all("specularFactor", [1.0; 3])?;
    let glossiness = reader.fields.roughness("glossinessFactor", 1.0)?;
    reader.texture("diffuseTexture", contract::TEXTURE_BASE_COLOR)?;
    reader.texture("specularGlossinessTexture", contract::TEXTURE_METALLIC_ROUGHNESS)?;
    material.specular_glossiness = true;
    material.base_color_factor = Vec4::from(diffuse);
    material.specular.color = Vec3::from(specular);
    material.roughness_factor = glossiness;
    material.metallic_factor = 0.0;
    Ok(true)
}

impl Reader<'_, '_> {
    fn unit(&mut self, key: &str, default: f32) -> Result<f32, Problem> {
        self.fields.clamped(key, default, 0.0..=1.0, &mut self.collector.warnings)
    }

    fn unit_all<const N: usize>(&mut self, key: &str, default: [f32; N]) -> Result<[f32; N], Problem> {
        self.fields.clamped_all(key, default, 0.0..=1.0, &mut self.collector.warnings)
    }

    fn at_least_0(&mut self, key: &str, default: f32) -> Result<f32, Problem> {
        self.fields.clamped(key, default, 0.0..=f32::MAX, &mut self.collector.warnings)
    }

    fn texture(&mut self, key: &str, texture: u32) -> Result<(), Problem> {
        let slot = self.fields.slot(key)?;
        self.collector.bind(self.material, texture, slot, &self.fields.at(key))
    }
}

fn clearcoat(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let mut coat = Clearcoat { factor: reader.unit("clearcoatFactor", 0.0)?, ..reader.material.clearcoat };
    coat.roughness = reader.fields.roughness("clearcoatRoughnessFactor", 0.0)?;
    if let Some(normal) = reader.fields.open_member("clearcoatNormalTexture")? {
        coat.normal_scale = normal.number("scale", 1.0)?;
    }
    reader.material.clearcoat = coat;
    reader.texture("clearcoatTexture", contract::TEXTURE_CLEARCOAT)?;
    reader.texture("clearcoatRoughnessTexture", contract::TEXTURE_CLEARCOAT_ROUGHNESS)?;
    reader.texture("clearcoatNormalTexture", contract::TEXTURE_CLEARCOAT_NORMAL)
}

fn anisotropy(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let strength = reader.unit("anisotropyStrength", 0.0)?;
    let rotation = reader.fields.number("anisotropyRotation", 0.0)?;
    reader.material.anisotropy = Anisotropy { strength, rotation };
    reader.texture("anisotropyTexture", contract::TEXTURE_ANISOTROPY)
}

fn sheen(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let color = Vec3::from(reader.unit_all("sheenColorFactor", [0.0; 3])?);
    let roughness = reader.fields.roughness("sheenRoughnessFactor", 0.0)?;
    reader.material.sheen = Sheen { color, roughness };
    reader.texture("sheenColorTexture", contract::TEXTURE_SHEEN_COLOR)?;
    reader.texture("sheenRoughnessTexture", contract::TEXTURE_SHEEN_ROUGHNESS)
}

fn specular(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    if reader.material.specular_glossiness {
        let place = &reader.fields.place;
        let warning = format!("{place} is ignored: the material has {SPECULAR_GLOSSINESS}, which gives F0 itself.");
        reader.collector.warnings.push(warning);
        return Ok(());
    }
    let factor = reader.unit("specularFactor", 1.0)?;
    let warnings = &mut reader.collector.warnings;
    let color = reader.fields.clamped_all("specularColorFactor", [1.0; 3], 0.0..=f32::MAX, warnings)?;
    reader.material.specular = Specular { factor, color: Vec3::from(color) };
    reader.texture("specularTexture", contract::TEXTURE_SPECULAR)?;
    reader.texture("specularColorTexture", contract::TEXTURE_SPECULAR_COLOR)
}

/// In KHR_materials_ior, 0 stands for an infinite index, whose Fresnel factor is 1. With a specular color, that color is the
/// whole reflectance, as in materials converted from specular-glossiness. Without, the material is a white mirror, as its file
/// says; that is rarely meant, so the warning says how to get another reflectance.
fn ior(reader: &mut Reader<'_, '_>, reflects: bool) -> Result<(), Problem> {
    let value = reader.fields.number("ior", 1.5)?;
    let place = reader.fields.at("ior");
    if value == 0.0 {
        let warning = if reflects {
            format!("{place} is 0, for infinity: the reflectance is 1 times the specular color.")
        } else {
            format!(
                "{place} is 0, for infinity: the material reflects all light. Glass has 1.5; {SPECULAR} gives another color."
            )
        };
        reader.collector.warnings.push(warning);
    } else if !(1.0..=LARGEST_IOR).contains(&value) {
        let expected = "an index of refraction of 1 to 10000 (1.5 for glass), or 0 for infinity";
        return Err(Problem::invalid(place, expected, value.to_string()));
    }
    reader.material.ior = value;
    Ok(())
}

fn iridescence(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let film = Iridescence {
        factor: reader.unit("iridescenceFactor", 0.0)?,
        ior: reader.fields.number("iridescenceIor", 1.3)?,
        thickness_min_nm: reader.at_least_0("iridescenceThicknessMinimum", 100.0)?,
        thickness_max_nm: reader.at_least_0("iridescenceThicknessMaximum", 400.0)?,
    };
    if film.ior < 1.0 {
        let place = reader.fields.at("iridescenceIor");
        return Err(Problem::invalid(place, "an index of refraction of at least 1", film.ior.to_string()));
    }
    reader.material.iridescence = film;
    reader.texture("iridescenceTexture", contract::TEXTURE_IRIDESCENCE)?;
    reader.texture("iridescenceThicknessTexture", contract::TEXTURE_IRIDESCENCE_THICKNESS)
}

fn transmission(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    reader.material.transmission_factor = reader.unit("transmissionFactor", 0.0)?;
    reader.texture("transmissionTexture", contract::TEXTURE_TRANSMISSION)
}

fn volume(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let thickness = reader.at_least_0("thicknessFactor", 0.0)?;
    let attenuation_color = Vec3::from(reader.unit_all("attenuationColor", [1.0; 3])?);
    let attenuation_distance = reader.fields.number("attenuationDistance", f32::INFINITY)?;
    if attenuation_distance <= 0.0 {
        let (place, found) = (reader.fields.at("attenuationDistance"), attenuation_distance.to_string());
        return Err(Problem::invalid(place, "a distance above 0, in meters", found));
    }
    reader.material.volume = Volume { thickness, attenuation_color, attenuation_distance };
    reader.texture("thicknessTexture", contract::TEXTURE_THICKNESS)
}

fn dispersion(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    reader.material.dispersion = reader.at_least_0("dispersion", 0.0)?;
    Ok(())
}

fn diffuse_transmission(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let factor = reader.unit("diffuseTransmissionFactor", 0.0)?;
    let color = Vec3::from(reader.unit_all("diffuseTransmissionColorFactor", [1.0; 3])?);
    reader.material.diffuse_transmission = DiffuseTransmission { factor, color };
    reader.texture("diffuseTransmissionTexture", contract::TEXTURE_DIFFUSE_TRANSMISSION)?;
    reader.texture("diffuseTransmissionColorTexture", contract::TEXTURE_DIFFUSE_TRANSMISSION_COLOR)
}

/// Specula's part of `extras`. All other members are ignored.
#[derive(serde::Deserialize)]
struct Extras {
    specula: Option<json::Value>,
}

/// `extras.specula.conductor_n` and `conductor_k`.
fn conductor(material: &mut Material, source: &json::Material, place: &str) -> Result<(), Problem> {
    let text = source.extras.as_ref().map(|raw| raw.get()).filter(|text| text.starts_with('{'));
    let Some(text) = text else { return Ok(()) };
    let place = format!("{place}.extras.specula");
    let parsed: Result<Extras, _> = serde_json::from_str(text);
    let extras = parsed.map_err(|error| Problem::invalid(&place, "numbers that fit", error.to_string()))?;
    let Some(value) = extras.specula else { return Ok(()) };
    let fields = Fields::new(&value, place)?;
    let (n, k) = ("conductor_n", "conductor_k");
    match (fields.get(n), fields.get(k)) {
        (None, None) => return Ok(()),
        (Some(_), Some(_)) => {}
        (None, _) => return Err(Problem::invalid(fields.at(n), format!("3 numbers, beside {k}"), "none")),
        (_, None) => return Err(Problem::invalid(fields.at(k), format!("3 numbers, beside {n}"), "none")),
    }
    let read = |key, least: f32, expected: &str| {
        let value = Vec3::from(fields.numbers(key, [0.0; 3])?);
        let found = || values::quote(fields.get(key).unwrap_or(&json::Value::Null));
        let fits = value.min_element() >= least && value.max_element() <= LARGEST_IOR;
        if !fits { Err(Problem::invalid(fields.at(key), expected, found())) } else { Ok(value) }
    };
    let n = read(n, 1e-3, "3 numbers from 0.001 to 10000")?;
    let k = read(k, 0.0, "3 numbers from 0 to 10000")?;
    material.conductor = Some(Conductor { n, k });
    Ok(())
}
