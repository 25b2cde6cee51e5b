//! The targets of KHR_animation_pointer that need a place of their own.

use super::motion::{animate, at};
use super::*;
use crate::scene::material::Material;
use crate::scene::moved_materials;

fn to(pointer: &str) -> Value {
    json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } })
}

/// The material of a square in the middle of these moves, and the warnings.
fn moved(material: Value, moves: &[(&str, &str, &[f32])]) -> (Option<Material>, String) {
    let mut builder = Builder::square();
    builder.image("normalTexture", &materials::png(2, 2));
    builder.json["materials"][0] = material;
    builder.json["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 2, "znear": 0, "zfar": 9 } },
    ]);
    builder.json["nodes"] = json!([{ "mesh": 0, "children": [1, 2] }, { "camera": 0 }, { "camera": 1 }]);
    let channels: Vec<_> = moves.iter().map(|(path, kind, values)| (to(path), "LINEAR", *kind, *values)).collect();
    animate(&mut builder, &[0.0, 1.0], &channels);
    let model = builder.model();
    let half = at(&model, 0.5);
    assert_eq!(half.cameras, model.cameras);
    let moved = moved_materials(&half.materials, &half.pose.values).into_iter().next().map(|(_, material)| material);
    (moved, model.warnings.join("\n"))
}

#[test]
fn films_and_coats_move() {
    let material = json!({ "extensions": {
        "KHR_materials_iridescence": { "iridescenceFactor": 1 },
        "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatNormalTexture": { "index": 0, "scale": 0.5 } },
    } });
    let film = "/materials/0/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum";
    let coat = "/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale";
    let (moved, told) = moved(material, &[(film, "SCALAR", &[0.0, 300.0]), (coat, "SCALAR", &[1.0, -2.0])]);
    let numbers = moved.unwrap().numbers;
    assert_eq!((numbers.iridescence_thickness_nm, numbers.clearcoat_normal_scale), ([150.0, 400.0], -0.5), "{told}");
    assert_eq!(told, "");
}

#[test]
fn specular_glossiness_moves_and_its_fallback_does_not() {
    let glossy = "KHR_materials_pbrSpecularGlossiness";
    let material = json!({ "extensions": { glossy: { "glossinessFactor": 0.75, "diffuseTexture": { "index": 0 } } } });
    let at = |member: &str| format!("/materials/0/extensions/{glossy}/{member}");
    let offset = at("diffuseTexture/extensions/KHR_texture_transform/offset");
    let moves = [
        (at("diffuseFactor"), "VEC4", &[0.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.0, 1.0][..]),
        (at("specularFactor"), "VEC3", &[0.0, 0.0, 0.0, 1.0, 0.5, 0.25]),
        (at("glossinessFactor"), "SCALAR", &[0.5, 1.0]),
        (offset, "VEC2", &[0.0, 0.0, 1.0, 0.5]),
        ("/materials/0/pbrMetallicRoughness/roughnessFactor".to_owned(), "SCALAR", &[0.0, 0.0]),
        ("/materials/0/pbrMetallicRoughness/baseColorFactor".to_owned(), "VEC4", &[0.0; 8]),
    ];
    let moves: Vec<(&str, &str, &[f32])> =
        moves.iter().map(|(path, kind, values)| (path.as_str(), *kind, *values)).collect();
    let (moved_one, told) = moved(material, &moves);
    let moved_one = moved_one.unwrap();
    assert_eq!(moved_one.numbers.base_color_factor, [0.5, 0.25, 0.0, 1.0], "{told}");
    assert_eq!((moved_one.numbers.specular_color, moved_one.numbers.roughness_factor), ([0.5, 0.25, 0.125], 0.75));
    assert_eq!(moved_one.textures[0].unwrap().uv_from_mesh.translation, glam::Vec2::new(0.5, 0.25));
    assert_eq!(told, "");
    // A material without the extension has no such factors.
    let (none, told) = moved(json!({}), &moves[..1]);
    assert!(none.is_none() && told.contains("expected a pointer to what Specula can move"), "{told}");
}

#[test]
fn planes_and_aspects_of_cameras_move_nothing_and_tell_nothing() {
    let numbers = ["perspective/aspectRatio", "perspective/znear", "perspective/zfar"];
    let of_other = ["orthographic/xmag", "orthographic/znear", "orthographic/zfar"];
    let paths: Vec<String> = numbers
        .iter()
        .map(|member| format!("/cameras/0/{member}"))
        .chain(of_other.iter().map(|member| format!("/cameras/1/{member}")))
        .collect();
    let moves: Vec<(&str, &str, &[f32])> =
        paths.iter().map(|path| (path.as_str(), "SCALAR", &[1.0, 2.0][..])).collect();
    let (none, told) = moved(json!({}), &moves);
    assert!(none.is_none() && told.is_empty(), "{told}");
}
