//! Resolves the pointers of KHR_animation_pointer to what the model has.

use std::collections::HashSet;

use gltf::json;
use serde_json::Value;

use crate::interface as contract;
use crate::scene::extensions::SPECULAR_GLOSSINESS;
use crate::scene::gltf::environment;
use crate::scene::motion::{Property, Rig, Values};
use crate::settings::Factor;

/// The extension's name.
pub const EXTENSION: &str = "KHR_animation_pointer";

/// The place of the visibility of a node, below the node.
const VISIBLE: &str = "extensions/KHR_node_visibility/visible";

/// The property that a pointer names.
pub enum Pointed {
    /// A property of a node, as the `path` of a channel names it; or of all nodes that show a mesh, if these have no weights of their own.
    Nodes(Vec<usize>, String),
    /// Whether a node is visible.
    Visible(usize),
    /// One morph weight of such nodes.
    Weight(Vec<usize>, usize),
    /// Numbers of properties, from the given one on, and how many.
    Values(Vec<Values>, usize, usize),
    /// Numbers that Specula does not use, so that nothing moves.
    Unused,
}

/// The place of a factor: below a material, its property, its first number there, and the values that the file may leave out.
type Place = (&'static str, fn(usize) -> Property, usize, &'static [f64]);

const MATERIAL: &[Place] = &[
    ("pbrMetallicRoughness/baseColorFactor", Property::BaseColor, 0, &[1.0; 4]),
    ("pbrMetallicRoughness/metallicFactor", |m| Property::Factor(m, Factor::Metallic), 0, &[1.0]),
    ("pbrMetallicRoughness/roughnessFactor", |m| Property::Factor(m, Factor::Roughness), 0, &[1.0]),
    ("alphaCutoff", |m| Property::Factor(m, Factor::AlphaCutoff), 0, &[0.5]),
    ("normalTexture/scale", |m| Property::Factor(m, Factor::NormalScale), 0, &[1.0]),
    ("occlusionTexture/strength", |m| Property::Factor(m, Factor::Occlusion), 0, &[1.0]),
    ("emissiveFactor", Property::Emission, 0, &[0.0; 3]),
    ("extensions/KHR_materials_emissive_strength/emissiveStrength", Property::Emission, 3, &[1.0]),
    ("extensions/KHR_materials_anisotropy/anisotropyStrength", Property::Anisotropy, 0, &[0.0]),
    ("extensions/KHR_materials_anisotropy/anisotropyRotation", Property::Anisotropy, 1, &[0.0]),
    ("extensions/KHR_materials_ior/ior", |m| Property::Factor(m, Factor::Ior), 0, &[1.5]),
    ("extensions/KHR_materials_specular/specularFactor", |m| Property::Factor(m, Factor::Specular), 0, &[1.0]),
    (
        "extensions/KHR_materials_specular/specularColorFactor",
        |m| Property::Factor(m, Factor::SpecularColor),
        0,
        &[1.0; 3],
    ),
    ("extensions/KHR_materials_clearcoat/clearcoatFactor", |m| Property::Factor(m, Factor::Clearcoat), 0, &[0.0]),
    (
        "extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor",
        |m| Property::Factor(m, Factor::ClearcoatRoughness),
        0,
        &[0.0],
    ),
    ("extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", Property::CoatNormalScale, 0, &[1.0]),
    ("extensions/KHR_materials_sheen/sheenColorFactor", |m| Property::Factor(m, Factor::SheenColor), 0, &[0.0; 3]),
    ("extensions/KHR_materials_sheen/sheenRoughnessFactor", |m| Property::Factor(m, Factor::SheenRoughness), 0, &[0.0]),
    ("extensions/KHR_materials_iridescence/iridescenceFactor", |m| Property::Factor(m, Factor::Iridescence), 0, &[0.0]),
    ("extensions/KHR_materials_iridescence/iridescenceIor", |m| Property::Factor(m, Factor::IridescenceIor), 0, &[1.3]),
    ("extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", Property::ThinnestFilm, 0, &[100.0]),
    (
        "extensions/KHR_materials_iridescence/iridescenceThicknessMaximum",
        |m| Property::Factor(m, Factor::IridescenceThickness),
        0,
        &[400.0],
    ),
    (
        "extensions/KHR_materials_transmission/transmissionFactor",
        |m| Property::Factor(m, Factor::Transmission),
        0,
        &[0.0],
    ),
    ("extensions/KHR_materials_volume/thicknessFactor", |m| Property::Factor(m, Factor::Thickness), 0, &[0.0]),
    (
        "extensions/KHR_materials_volume/attenuationColor",
        |m| Property::Factor(m, Factor::AttenuationColor),
        0,
        &[1.0; 3],
    ),
    (
        "extensions/KHR_materials_volume/attenuationDistance",
        |m| Property::Factor(m, Factor::AttenuationDistance),
        0,
        &[1e6],
    ),
    ("extensions/KHR_materials_dispersion/dispersion", |m| Property::Factor(m, Factor::Dispersion), 0, &[0.0]),
    (
        "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor",
        |m| Property::Factor(m, Factor::DiffuseTransmission),
        0,
        &[0.0],
    ),
    (
        "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
        |m| Property::Factor(m, Factor::DiffuseTransmissionColor),
        0,
        &[1.0; 3],
    ),
];

/// The factors of a material with specular-glossiness, which it has in place of those of `pbrMetallicRoughness`.
const GLOSSY: &[Place] = &[
    ("extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Property::BaseColor, 0, &[1.0; 4]),
    (
        "extensions/KHR_materials_pbrSpecularGlossiness/specularFactor",
        |m| Property::Factor(m, Factor::SpecularColor),
        0,
        &[1.0; 3],
    ),
    ("extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", Property::Glossiness, 0, &[1.0]),
];

/// The textures of materials.
const TEXTURES: &[(&str, u32)] = &[
    ("pbrMetallicRoughness/baseColorTexture", contract::TEXTURE_BASE_COLOR),
    ("pbrMetallicRoughness/metallicRoughnessTexture", contract::TEXTURE_METALLIC_ROUGHNESS),
    ("normalTexture", contract::TEXTURE_NORMAL),
    ("occlusionTexture", contract::TEXTURE_OCCLUSION),
    ("emissiveTexture", contract::TEXTURE_EMISSIVE),
    ("extensions/KHR_materials_clearcoat/clearcoatTexture", contract::TEXTURE_CLEARCOAT),
    ("extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", contract::TEXTURE_CLEARCOAT_ROUGHNESS),
    ("extensions/KHR_materials_clearcoat/clearcoatNormalTexture", contract::TEXTURE_CLEARCOAT_NORMAL),
    ("extensions/KHR_materials_anisotropy/anisotropyTexture", contract::TEXTURE_ANISOTROPY),
    ("extensions/KHR_materials_sheen/sheenColorTexture", contract::TEXTURE_SHEEN_COLOR),
    ("extensions/KHR_materials_sheen/sheenRoughnessTexture", contract::TEXTURE_SHEEN_ROUGHNESS),
    ("extensions/KHR_materials_specular/specularTexture", contract::TEXTURE_SPECULAR),
    ("extensions/KHR_materials_specular/specularColorTexture", contract::TEXTURE_SPECULAR_COLOR),
    ("extensions/KHR_materials_iridescence/iridescenceTexture", contract::TEXTURE_IRIDESCENCE),
    ("extensions/KHR_materials_iridescence/iridescenceThicknessTexture", contract::TEXTURE_IRIDESCENCE_THICKNESS),
    ("extensions/KHR_materials_transmission/transmissionTexture", contract::TEXTURE_TRANSMISSION),
    ("extensions/KHR_materials_volume/thicknessTexture", contract::TEXTURE_THICKNESS),
    (
        "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture",
        contract::TEXTURE_DIFFUSE_TRANSMISSION,
    ),
    (
        "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture",
        contract::TEXTURE_DIFFUSE_TRANSMISSION_COLOR,
    ),
    ("extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture", contract::TEXTURE_BASE_COLOR),
    ("extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture", contract::TEXTURE_METALLIC_ROUGHNESS),
];

/// The numbers of a camera that do not change what Specula shows.
const UNUSED_OF_CAMERA: [&str; 6] = [
    "perspective/aspectRatio",
    "perspective/zfar",
    "perspective/znear",
    "orthographic/xmag",
    "orthographic/zfar",
    "orthographic/znear",
];

/// The members of KHR_texture_transform.
const TRANSFORM: &[(&str, usize, &[f64])] =
    &[("offset", 0, &[0.0; 2]), ("rotation", 2, &[0.0]), ("scale", 3, &[1.0; 2])];

/// The nodes whose visibility animations change.
pub fn switched_nodes(animations: &[Value]) -> HashSet<usize> {
    let at = format!("/target/extensions/{EXTENSION}/pointer");
    let channels = animations.iter().filter_map(|animation| animation.get("channels")?.as_array()).flatten();
    let node = |channel: &Value| {
        let (node, path) = channel.pointer(&at)?.as_str()?.strip_prefix("/nodes/")?.split_once('/')?;
        node.parse().ok().filter(|_| path == VISIBLE)
    };
    channels.filter_map(node).collect()
}

/// Resolves a pointer of a file of which this scene is shown; `None` if the model has no such thing.
pub fn resolve(pointer: &str, (root, scene): (&json::Root, usize), rig: &Rig) -> Option<Pointed> {
    let (kind, rest) = pointer.strip_prefix('/')?.split_once('/')?;
    let (index, path) = match kind {
        "extensions" => {
            let (extension, rest) = rest.split_once("/lights/")?;
            let (index, path) = rest.split_once('/')?;
            let index = index.parse().ok()?;
            return match extension {
                "KHR_lights_punctual" => light(index, path, root, rig),
                environment::EXTENSION => image_based(index, path, root, scene),
                _ => None,
            };
        }
        _ => rest.split_once('/')?,
    };
    let index: usize = index.parse().ok()?;
    match kind {
        "nodes" if path == VISIBLE => Some(Pointed::Visible(index)),
        "nodes" => nodes(vec![index], path),
        "meshes" => {
            let shows =
                |node: &json::Node| node.mesh.is_some_and(|mesh| mesh.value() == index) && node.weights.is_none();
            let all = root.nodes.iter().enumerate().filter(|(_, node)| shows(node)).map(|(node, _)| node).collect();
            if path.starts_with("weights") { nodes(all, path) } else { None }
        }
        "materials" => material(index, path, root),
        "cameras" if UNUSED_OF_CAMERA.contains(&path) => root.cameras.get(index).map(|_| Pointed::Unused),
        "cameras" => {
            let (make, member, default): (fn(usize) -> Property, _, _) = match path {
                "perspective/yfov" => (Property::Fovy, path, 0.8),
                "orthographic/ymag" => (Property::Height, path, 1.0),
                _ => return None,
            };
            let of_file = serde_json::to_value(root.cameras.get(index)?).ok()?;
            let rest = numbers(&of_file, member, &[default]);
            let of = |camera: usize| Values { property: make(camera), numbers: rest.clone() };
            Some(Pointed::Values(rig.cameras_of(index).map(of).collect(), 0, 1))
        }
        _ => None,
    }
}

fn nodes(nodes: Vec<usize>, path: &str) -> Option<Pointed> {
    match path.strip_prefix("weights/") {
        Some(number) => Some(Pointed::Weight(nodes, number.parse().ok()?)),
        None => ["translation", "rotation", "scale", "weights"]
            .contains(&path)
            .then(|| Pointed::Nodes(nodes, path.to_owned())),
    }
}

fn material(index: usize, path: &str, root: &json::Root) -> Option<Pointed> {
    let of_file = serde_json::to_value(root.materials.get(index)?).ok()?;
    // Index 0 of the model's materials is the default material.
    let material = index + 1;
    let is_glossy = of_file.pointer(&format!("/extensions/{SPECULAR_GLOSSINESS}")).is_some();
    if is_glossy && path.starts_with("pbrMetallicRoughness/") {
        // A fallback for other viewers.
        return Some(Pointed::Unused);
    }
    if let Some((texture, member)) = path.split_once("/extensions/KHR_texture_transform/") {
        let (_, slot) = TEXTURES.iter().find(|(name, _)| *name == texture)?;
        let (_, first, default) = TRANSFORM.iter().find(|(name, _, _)| *name == member)?;
        let number = |(member, _, default): &(&str, usize, &[f64])| {
            numbers(&of_file, &format!("{texture}/extensions/KHR_texture_transform/{member}"), default)
        };
        let values = Values {
            property: Property::Texture(material, *slot),
            numbers: TRANSFORM.iter().flat_map(number).collect(),
        };
        return Some(Pointed::Values(vec![values], *first, default.len()));
    }
    let places = if is_glossy && GLOSSY.iter().any(|(name, ..)| *name == path) { GLOSSY } else { MATERIAL };
    let (_, make, first, default) = places.iter().find(|(name, ..)| *name == path)?;
    let property = make(material);
    // All numbers of the property, in their order.
    let parts = places.iter().filter(|(_, make, ..)| make(material) == property);
    let rest = parts.flat_map(|(path, _, _, default)| numbers(&of_file, path, default)).collect();
    Some(Pointed::Values(vec![Values { property, numbers: rest }], *first, default.len()))
}

fn light(index: usize, path: &str, root: &json::Root, rig: &Rig) -> Option<Pointed> {
    let lights: &[json::extensions::scene::khr_lights_punctual::Light] = root.as_ref();
    let of_file = serde_json::to_value(lights.get(index)?).ok()?;
    let number = |path: &str, default: f64| numbers(&of_file, path, &[default]);
    let outer = std::f64::consts::FRAC_PI_4;
    let angles = || [number("spot/innerConeAngle", 0.0), number("spot/outerConeAngle", outer)].concat();
    let intensity = || [numbers(&of_file, "color", &[1.0; 3]), number("intensity", 1.0)].concat();
    let (make, first, width, rest): (fn(usize) -> Property, _, _, _) = match path {
        "color" => (Property::Light, 0, 3, intensity()),
        "intensity" => (Property::Light, 3, 1, intensity()),
        "range" => (Property::Range, 0, 1, number("range", 0.0)),
        "spot/innerConeAngle" => (Property::Cone, 0, 1, angles()),
        "spot/outerConeAngle" => (Property::Cone, 1, 1, angles()),
        _ => return None,
    };
    let of = |light: usize| Values { property: make(light), numbers: rest.clone() };
    Some(Pointed::Values(rig.lights_of(index).map(of).collect(), first, width))
}

/// A number of an image-based light. The environment is the light that the scene names.
fn image_based(index: usize, path: &str, root: &json::Root, scene: usize) -> Option<Pointed> {
    let lights = root.extensions.as_ref()?.others.get(environment::EXTENSION)?.get("lights")?;
    let of_file = lights.get(index)?;
    let (property, default): (_, &[f64]) = match path {
        "intensity" => (Property::EnvironmentIntensity(0), &[1.0]),
        "rotation" => (Property::EnvironmentRotation(0), &[0.0, 0.0, 0.0, 1.0]),
        _ => return None,
    };
    if environment::index(root, scene) != Some(index) {
        return Some(Pointed::Unused);
    }
    let values = Values { property, numbers: numbers(of_file, path, default) };
    Some(Pointed::Values(vec![values], 0, default.len()))
}

/// The numbers at a path of the file, or their defaults.
fn numbers(of: &Value, path: &str, default: &[f64]) -> Vec<f64> {
    let value = of.pointer(&format!("/{path}"));
    let numbers: Option<Vec<f64>> = match value {
        Some(Value::Array(list)) => list.iter().map(Value::as_f64).collect(),
        Some(value) => value.as_f64().map(|number| vec![number]),
        None => None,
    };
    numbers.filter(|numbers| numbers.len() == default.len()).unwrap_or_else(|| default.to_vec())
}
