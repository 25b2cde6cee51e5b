//! Material extensions: values, defaults, mistakes.

use super::super::super::model::Material;
use super::*;
use crate::interface as contract;

/// A square whose material has these extensions, and two textures to refer to.
fn with(extensions: Value) -> Builder {
    let mut builder = Builder::square();
    builder.image("normalTexture", &materials::png(1, 1));
    let texture = json!({ "source": 0, "sampler": 0 });
    builder.json["samplers"] = json!([{ "wrapS": 33071 }]);
    builder.push("textures", texture);
    builder.json["materials"][0] = json!({ "name": "m", "extensions": extensions });
    builder
}

fn material(extensions: Value) -> Material {
    let model = with(extensions).model();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    model.materials[1].clone()
}

/// Everything but the name, for comparison.
fn content(material: &Material) -> String {
    format!("{:?}", Material { name: String::new(), ..material.clone() })
}

const NAMES: [&str; 10] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
];

#[test]
fn an_empty_extension_changes_nothing_and_may_be_required() {
    for name in NAMES {
        let mut builder = with(json!({ name: {} }));
        builder.json["extensionsUsed"] = json!([name]);
        builder.json["extensionsRequired"] = json!([name]);
        let model = builder.model();
        assert_eq!(content(&model.materials[1]), content(&Material::default()), "{name}");
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        let damaged = with(json!({ name: 7 }));
        let expected = format!("{name}: expected an object, found 7; the extension is left out. Export");
        assert!(damaged.told().contains(&expected), "{}", damaged.told());
        assert_eq!(content(&damaged.model().materials[1]), content(&Material::default()), "{name}");
    }
}

#[test]
fn values_of_layers() {
    let material = material(json!({
        "KHR_materials_clearcoat": {
            "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
            "clearcoatNormalTexture": { "index": 0, "scale": -2 },
        },
        "KHR_materials_sheen": { "sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.4 },
        "KHR_materials_iridescence": {
            "iridescenceFactor": 0.6, "iridescenceIor": 1.8, "iridescenceThicknessMinimum": 50,
            "iridescenceThicknessMaximum": 20,
        },
        "KHR_materials_anisotropy": { "anisotropyStrength": 0.7, "anisotropyRotation": -7 },
    }));
    let numbers = material.numbers;
    let coat = (numbers.clearcoat_factor, numbers.clearcoat_roughness, numbers.clearcoat_normal_scale);
    assert_eq!(coat, (0.5, 0.25, -2.0));
    assert_eq!((numbers.sheen_color, numbers.sheen_roughness), ([0.1, 0.2, 0.3], 0.4));
    // If the maximum is below the minimum, the map is read inverted.
    assert_eq!((numbers.iridescence_factor, numbers.iridescence_ior), (0.6, 1.8));
    assert_eq!(numbers.iridescence_thickness_nm, [50.0, 20.0]);
    let (sin, cos) = (-7.0_f32).sin_cos();
    assert_eq!((numbers.anisotropy_strength, numbers.anisotropy_rotation), (0.7, [cos, sin]));
}

#[test]
fn values_of_what_is_beneath() {
    let material = material(json!({
        "KHR_materials_specular": { "specularFactor": 0.5, "specularColorFactor": [2, 1, 0] },
        "KHR_materials_ior": { "ior": 2.42 },
        "KHR_materials_transmission": { "transmissionFactor": 0.9 },
        "KHR_materials_volume": { "thicknessFactor": 3, "attenuationColor": [0, 0.5, 1], "attenuationDistance": 0.01 },
        "KHR_materials_dispersion": { "dispersion": 4 },
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [1, 0.5, 0],
        },
    }));
    let numbers = material.numbers;
    assert_eq!((numbers.specular_factor, numbers.specular_color), (0.5, [2.0, 1.0, 0.0]));
    assert_eq!((numbers.ior, numbers.transmission_factor, numbers.dispersion), (2.42, 0.9, 4.0));
    assert_eq!((numbers.thickness, numbers.attenuation_distance), (3.0, 0.01));
    assert_eq!(numbers.attenuation_color, [0.0, 0.5, 1.0]);
    assert_eq!(numbers.diffuse_transmission_factor, 0.25);
    assert_eq!(numbers.diffuse_transmission_color, [1.0, 0.5, 0.0]);
    assert_eq!(Material::default().numbers.attenuation_distance, f32::INFINITY);
}

#[test]
fn every_texture_has_its_slot() {
    for (extension, key, slot) in [
        ("KHR_materials_clearcoat", "clearcoatTexture", contract::TEXTURE_CLEARCOAT),
        ("KHR_materials_clearcoat", "clearcoatRoughnessTexture", contract::TEXTURE_CLEARCOAT_ROUGHNESS),
        ("KHR_materials_clearcoat", "clearcoatNormalTexture", contract::TEXTURE_CLEARCOAT_NORMAL),
        ("KHR_materials_anisotropy", "anisotropyTexture", contract::TEXTURE_ANISOTROPY),
        ("KHR_materials_sheen", "sheenColorTexture", contract::TEXTURE_SHEEN_COLOR),
        ("KHR_materials_sheen", "sheenRoughnessTexture", contract::TEXTURE_SHEEN_ROUGHNESS),
        ("KHR_materials_specular", "specularTexture", contract::TEXTURE_SPECULAR),
        ("KHR_materials_specular", "specularColorTexture", contract::TEXTURE_SPECULAR_COLOR),
        ("KHR_materials_iridescence", "iridescenceTexture", contract::TEXTURE_IRIDESCENCE),
        ("KHR_materials_iridescence", "iridescenceThicknessTexture", contract::TEXTURE_IRIDESCENCE_THICKNESS),
        ("KHR_materials_transmission", "transmissionTexture", contract::TEXTURE_TRANSMISSION),
        ("KHR_materials_volume", "thicknessTexture", contract::TEXTURE_THICKNESS),
        ("KHR_materials_diffuse_transmission", "diffuseTransmissionTexture", contract::TEXTURE_DIFFUSE_TRANSMISSION),
        (
            "KHR_materials_diffuse_transmission",
            "diffuseTransmissionColorTexture",
            contract::TEXTURE_DIFFUSE_TRANSMISSION_COLOR,
        ),
        ("KHR_materials_pbrSpecularGlossiness", "diffuseTexture", contract::TEXTURE_BASE_COLOR),
        ("KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", contract::TEXTURE_METALLIC_ROUGHNESS),
    ] {
        let transform = json!({ "KHR_texture_transform": { "offset": [0.25, 0], "scale": [2, 4] } });
        let material = material(json!({ extension: { key: { "index": 1, "texCoord": 1, "extensions": transform } } }));
        let used: Vec<usize> = (0..contract::TEXTURE_COUNT).filter(|&i| material.textures[i].is_some()).collect();
        assert_eq!(used, [slot as usize], "{key}");
        let used = material.textures[slot as usize].unwrap();
        assert_eq!((used.texture, used.uv_set), (0, 1), "{key}");
        assert_eq!(used.uv_from_mesh.transform_point2(glam::Vec2::ONE), glam::Vec2::new(2.25, 4.0), "{key}");
        let info = |info: Value| with(json!({ extension: { key: info } })).told();
        let place = format!("materials[0] \"m\".extensions.{extension}.{key}");
        for (bad, words) in [
            (json!(3), ": expected an object, found 3"),
            (json!({}), ".index: expected an index into textures, found none"),
            (json!({ "index": -1 }), ".index: expected an index into textures, found -1"),
            (json!({ "index": 9 }), ": expected an index into textures of 0 to 1, found 9"),
            (json!({ "index": 0, "texCoord": "a" }), ".texCoord: expected a TEXCOORD set's number, found \"a\""),
            (
                json!({ "index": 0, "extensions": { "KHR_texture_transform": { "rotation": 1e39 } } }),
                ".extensions.KHR_texture_transform: expected finite numbers, found offset [0.0, 0.0], rotation inf",
            ),
        ] {
            let (told, expected) = (info(bad), format!("{place}{words}"));
            assert!(told.contains(&expected) && told.contains("the texture is left out"), "{told}\nlacks {expected}");
        }
    }
}

#[test]
fn specular_glossiness_takes_the_places_of_metallic_roughness() {
    let mut builder = with(json!({ "KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.1, 0.2, 0.3, 0.4], "specularFactor": [0.5, 0.6, 0.7], "glossinessFactor": 0.8,
    } }));
    // The fallback for others is not even read.
    builder.json["materials"][0]["pbrMetallicRoughness"] =
        json!({ "roughnessFactor": 7, "baseColorTexture": { "index": 99 } });
    let material = &builder.model().materials[1];
    assert!(material.specular_glossiness && material.textures.iter().all(Option::is_none));
    let numbers = material.numbers;
    assert_eq!(numbers.base_color_factor, [0.1, 0.2, 0.3, 0.4]);
    assert_eq!((numbers.roughness_factor, numbers.specular_color), (0.8, [0.5, 0.6, 0.7]));
    let defaults = self::material(json!({ "KHR_materials_pbrSpecularGlossiness": {} })).numbers;
    assert_eq!((defaults.base_color_factor, defaults.roughness_factor), ([1.0; 4], 1.0));
    assert_eq!(defaults.specular_color, [1.0; 3]);
    // Its F0 is not overwritten.
    builder.json["materials"][0]["extensions"]["KHR_materials_specular"] = json!({ "specularColorFactor": [0, 0, 0] });
    let model = builder.model();
    assert_eq!(model.materials[1].numbers.specular_color, [0.5, 0.6, 0.7]);
    assert!(model.warnings[0].contains("KHR_materials_specular is ignored"), "{:?}", model.warnings);
}

#[test]
fn an_index_of_refraction_of_0_is_infinite() {
    let ior = json!({ "ior": 0 });
    let color = "reflectance is 1 times the specular color";
    let cases = [
        (json!({ "KHR_materials_ior": ior }), "reflects all light. Glass has 1.5; KHR_materials_specular"),
        (json!({ "KHR_materials_ior": ior, "KHR_materials_specular": {} }), color),
        (json!({ "KHR_materials_ior": ior, "KHR_materials_pbrSpecularGlossiness": {} }), color),
    ];
    for (extensions, expected) in cases {
        let model = with(extensions).model();
        assert_eq!(model.materials[1].numbers.ior, 0.0);
        let [warning] = model.warnings.as_slice() else { panic!("{:?}", model.warnings) };
        assert!(warning.contains(expected), "{warning}");
    }
}

#[test]
fn numbers_that_make_no_sense_cost_their_extension() {
    for (extension, key, bad, expected) in [
        ("clearcoat", "clearcoatFactor", json!("1"), "a number, found \"1\""),
        ("clearcoat", "clearcoatFactor", json!(1e39), "a finite number, found inf"),
        ("sheen", "sheenColorFactor", json!([1, 1]), "3 numbers, found [1,1]"),
        ("sheen", "sheenColorFactor", json!([0, 0, -1e39]), "a finite number, found -inf"),
        ("volume", "attenuationDistance", json!(null), "a number, found null"),
        ("anisotropy", "anisotropyRotation", json!(1e39), "a finite number"),
    ] {
        let name = format!("KHR_materials_{extension}");
        let builder = with(json!({ &name: { key: bad } }));
        let words = format!("materials[0] \"m\".extensions.{name}.{key}: expected {expected}");
        let told = builder.told();
        assert!(told.starts_with(&words) && told.contains("; the extension is left out."), "{told}\nlacks {words}");
        assert_eq!(content(&builder.model().materials[1]), content(&Material::default()), "{name}");
    }
    // Metallic-roughness takes the place of specular-glossiness again.
    let mut builder = with(json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": 1 } }));
    builder.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.25);
    let material = &builder.model().materials[1];
    assert!(!material.specular_glossiness && material.numbers.roughness_factor == 0.25);
    // A number alone has its default.
    for bad in [-1, 0] {
        let builder = with(json!({ "KHR_materials_volume": { "attenuationDistance": bad, "thicknessFactor": 2 } }));
        let told = builder.told();
        assert!(told.contains(&format!("in meters, found {bad}; the number is replaced by its default")), "{told}");
        let numbers = builder.model().materials[1].numbers;
        assert_eq!((numbers.attenuation_distance, numbers.thickness), (f32::INFINITY, 2.0));
    }
}

#[test]
fn numbers_outside_of_their_range_are_moved_with_a_warning() {
    for (extension, key, bad, used) in [
        ("clearcoat", "clearcoatFactor", json!(1.5), "is 1.5, outside of its range: 1 is used"),
        ("anisotropy", "anisotropyStrength", json!(-1), "is -1, outside of its range: 0 is used"),
        ("specular", "specularColorFactor", json!([1, -2, 1]), "is -2, outside of its range: 0 is used"),
        ("iridescence", "iridescenceThicknessMinimum", json!(-5), "is -5, outside of its range: 0 is used"),
        ("transmission", "transmissionFactor", json!(2), "is 2, outside of its range: 1 is used"),
        ("volume", "thicknessFactor", json!(-1), "is -1, outside of its range: 0 is used"),
        ("dispersion", "dispersion", json!(-1), "is -1, outside of its range: 0 is used"),
        ("clearcoat", "clearcoatRoughnessFactor", json!(1.5), "is 1.5, outside of its range: 1 is used"),
        ("sheen", "sheenRoughnessFactor", json!(-1), "is -1, outside of its range: 0 is used"),
        ("pbrSpecularGlossiness", "glossinessFactor", json!(80), "is 80, outside of its range: 1 is used"),
        ("ior", "ior", json!(0.5), "is 0.5, outside of its range: 1 is used"),
        ("ior", "ior", json!(-1.5), "is -1.5, outside of its range: 1 is used"),
        ("ior", "ior", json!(65536), "is 65536, outside of its range: 10000 is used"),
        ("iridescence", "iridescenceIor", json!(0), "is 0, outside of its range: 1 is used"),
    ] {
        let name = format!("KHR_materials_{extension}");
        let model = with(json!({ &name: { key: bad } })).model();
        let expected = format!("materials[0] \"m\".extensions.{name}.{key} {used}.");
        assert_eq!(*model.warnings, [expected]);
    }
}

#[test]
fn a_number_that_json_cannot_hold_is_named_by_its_line() {
    let mut builder = Builder::triangle();
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{ "type": "point", "intensity": 12345 }]);
    let text = builder.json.to_string().replace("12345", "\n1e999");
    let error = load_bytes("x", text.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("number out of range at line 2"), "{error}");
    // The loader parses raw extensions when it uses them.
    let mut builder = with(json!({}));
    builder.json["materials"][0]["extras"] = json!({ "specula": { "conductor_n": [1, 12345, 1] } });
    let bytes = builder.bin.iter().fold(String::new(), |text, byte| format!("{text}%{byte:02x}"));
    builder.json["buffers"][0]["uri"] = json!(format!("data:,{bytes}"));
    let text = builder.json.to_string().replace("12345", "1e999");
    let told = |text: &str| load_bytes("x", text.as_bytes()).unwrap().warnings.join("\n");
    let expected = "materials[0] \"m\".extras.specula: expected numbers that fit";
    assert!(told(&text).contains(expected), "{}", told(&text));
    assert_eq!(told(&text.replace("specula", "others")), "", "foreign extras are read");
}

#[test]
fn conductors_come_in_extras() {
    let extras = |extras: Value| {
        let mut builder = with(json!({}));
        builder.json["materials"][0]["extras"] = extras;
        builder
    };
    let gold = json!({ "specula": { "conductor_n": [0.18, 0.42, 1.37], "conductor_k": [3.42, 2.35, 1.77] } });
    let material = extras(gold).model().materials[1].clone();
    let (n, k) = (material.numbers.conductor_n, material.numbers.conductor_k);
    assert_eq!((material.conductor, n, k), (true, [0.18, 0.42, 1.37], [3.42, 2.35, 1.77]));
    // Other programs' data there is ignored.
    for foreign in [
        json!(null),
        json!(5),
        json!([5]),
        json!({ "conductor_n": 1 }),
        json!({ "specula": null }),
        json!({ "specula": {} }),
    ] {
        assert!(!extras(foreign).model().materials[1].conductor);
    }
    for (bad, words) in [
        (json!({ "conductor_n": [1, 1, 1] }), "extras.specula.conductor_k: expected 3 numbers, beside conductor_n"),
        (json!({ "conductor_k": [1, 1, 1] }), "extras.specula.conductor_n: expected 3 numbers, beside conductor_k"),
        (json!({ "conductor_n": [1, 0, 1], "conductor_k": [1, 1, 1] }), "3 numbers from 0.001 to 10000, found [1,0,1]"),
        (json!({ "conductor_n": [1, 1, 1], "conductor_k": [1, 1, -1] }), "3 numbers from 0 to 10000, found [1,1,-1]"),
        (json!({ "conductor_n": [1, 1, 1], "conductor_k": 3 }), "conductor_k: expected 3 numbers, found 3"),
    ] {
        let builder = extras(json!({ "specula": bad }));
        assert!(builder.told().contains(words), "{}\nlacks {words}", builder.told());
        assert!(!builder.model().materials[1].conductor);
    }
}
