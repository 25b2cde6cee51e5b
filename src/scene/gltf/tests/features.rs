//! The features that a material needs of the shaders, and the variants of a model.

use super::super::super::features;
use super::super::super::model::Topology;
use super::*;
use crate::interface as contract;

impl Model {
    /// Selects the variant with this name for every primitive; the empty name selects the default materials.
    ///
    /// # Errors
    /// As [`Model::variant`]. The model is unchanged then.
    fn select_variant(&mut self, name: &str) -> Result<(), String> {
        let variant = self.variant(name)?;
        for primitive in std::sync::Arc::make_mut(&mut self.primitives) {
            primitive.material = primitive.material_in(variant);
        }
        Ok(())
    }
}

/// The features of the only material of a square, except for how its occlusion is read.
fn bits(builder: &Builder) -> u32 {
    let model = builder.model();
    features(&model, &model.materials[1], model.primitives[0].attributes, Topology::Triangles)
        & !contract::FEATURE_PACKED_OCCLUSION
}

/// A square with a material of these extensions, which may use texture 0.
fn with(extensions: Value) -> Builder {
    let mut builder = Builder::square();
    builder.image("normalTexture", &materials::png(1, 1));
    builder.json["materials"][0] = json!({ "extensions": extensions });
    builder
}

fn named(name: &str, values: Value) -> Builder {
    with(json!({ format!("KHR_materials_{name}"): values }))
}

#[test]
fn an_extension_without_effect_is_no_feature() {
    let texture = json!({ "index": 0 });
    for (name, values) in [
        ("clearcoat", json!({ "clearcoatRoughnessFactor": 1, "clearcoatNormalTexture": texture })),
        ("anisotropy", json!({ "anisotropyRotation": 1, "anisotropyTexture": texture })),
        ("sheen", json!({ "sheenRoughnessFactor": 1, "sheenColorTexture": texture })),
        ("specular", json!({ "specularFactor": 1, "specularColorFactor": [1, 1, 1] })),
        ("iridescence", json!({ "iridescenceThicknessMaximum": 900, "iridescenceTexture": texture })),
        ("iridescence", json!({ "iridescenceFactor": 1, "iridescenceThicknessMaximum": 0 })),
        ("transmission", json!({ "transmissionTexture": texture })),
        ("volume", json!({ "thicknessFactor": 1 })),
        ("dispersion", json!({ "dispersion": 1 })),
        ("diffuse_transmission", json!({ "diffuseTransmissionColorFactor": [0, 0, 0] })),
        ("ior", json!({ "ior": 2 })),
    ] {
        assert_eq!(bits(&named(name, values)), 0, "{name}");
    }
}

#[test]
fn an_extension_with_effect_is_its_feature_alone() {
    let texture = json!({ "index": 0 });
    for (name, values, feature) in [
        ("clearcoat", json!({ "clearcoatFactor": 0.1 }), contract::FEATURE_CLEARCOAT),
        (
            "clearcoat",
            json!({ "clearcoatFactor": 1, "clearcoatNormalTexture": texture }),
            contract::FEATURE_CLEARCOAT | contract::FEATURE_CLEARCOAT_NORMAL,
        ),
        ("anisotropy", json!({ "anisotropyStrength": 0.1 }), contract::FEATURE_ANISOTROPY),
        ("sheen", json!({ "sheenColorFactor": [0, 0, 0.1] }), contract::FEATURE_SHEEN),
        ("specular", json!({ "specularFactor": 0.5 }), contract::FEATURE_SPECULAR),
        ("specular", json!({ "specularColorFactor": [1, 1, 0.5] }), contract::FEATURE_SPECULAR),
        ("specular", json!({ "specularTexture": texture }), contract::FEATURE_SPECULAR),
        ("specular", json!({ "specularColorTexture": texture }), contract::FEATURE_SPECULAR),
        ("iridescence", json!({ "iridescenceFactor": 0.1 }), contract::FEATURE_IRIDESCENCE),
        ("transmission", json!({ "transmissionFactor": 0.1 }), contract::FEATURE_TRANSMISSION),
        ("diffuse_transmission", json!({ "diffuseTransmissionFactor": 0.1 }), contract::FEATURE_DIFFUSE_TRANSMISSION),
        ("pbrSpecularGlossiness", json!({ "specularFactor": [0, 0, 0] }), contract::FEATURE_SPECULAR_GLOSSINESS),
    ] {
        assert_eq!(bits(&named(name, values.clone())), feature, "{name} {values}");
    }
    let mut metal = with(json!({}));
    metal.json["materials"][0]["extras"] = json!({ "specula": { "conductor_n": [1, 1, 1], "conductor_k": [1, 1, 1] } });
    assert_eq!(bits(&metal), contract::FEATURE_CONDUCTOR);
}

#[test]
fn features_that_need_others() {
    let glass = |thickness: f32, transmission: f32, diffuse: f32| {
        bits(&with(json!({
            "KHR_materials_transmission": { "transmissionFactor": transmission },
            "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": diffuse },
            "KHR_materials_volume": { "thicknessFactor": thickness },
            "KHR_materials_dispersion": { "dispersion": 1 },
        })))
    };
    let (clear, diffuse) = (contract::FEATURE_TRANSMISSION, contract::FEATURE_DIFFUSE_TRANSMISSION);
    assert_eq!(glass(0.0, 1.0, 0.0), clear, "a thin wall does not bend light");
    assert_eq!(glass(1.0, 1.0, 0.0), clear | contract::FEATURE_VOLUME | contract::FEATURE_DISPERSION);
    assert_eq!(glass(1.0, 0.0, 1.0), diffuse | contract::FEATURE_VOLUME);
    // Without texture coordinates there is no tangent frame, but a direction around the object.
    let mut bare = with(json!({
        "KHR_materials_anisotropy": { "anisotropyStrength": 1 },
        "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatNormalTexture": { "index": 0 } },
    }));
    bare.primitive()["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    assert_eq!(bits(&bare), contract::FEATURE_CLEARCOAT | contract::FEATURE_ANISOTROPY);
    assert!(bare.model().warnings[0].contains("around the object's Y axis"), "{:?}", bare.model().warnings);
    // Unlit materials get no light.
    let unlit = json!({ "KHR_materials_unlit": {}, "KHR_materials_clearcoat": { "clearcoatFactor": 1 } });
    assert_eq!(bits(&with(unlit)), contract::FEATURE_UNLIT);
}

#[test]
fn occlusion_is_packed_when_it_can_be_read_with_metallic_roughness() {
    let mut builder = Builder::square();
    builder.image("metallicRoughnessTexture", &materials::png(2, 2));
    for size in [2, 3] {
        let view = builder.view(&materials::png(size, 2));
        let image = builder.push("images", json!({ "bufferView": view }));
        builder.push("textures", json!({ "source": image }));
    }
    builder.json["samplers"] = json!([{ "wrapS": 33071 }]);
    builder.push("textures", json!({ "source": 0, "sampler": 0 }));
    let scaled = json!({ "KHR_texture_transform": { "scale": [2, 2] } });
    let packed = |info: Value| {
        let mut builder = builder.clone();
        if !info.is_null() {
            builder.json["materials"][0]["occlusionTexture"] = info;
        }
        let model = builder.model();
        features(&model, &model.materials[1], 0, Topology::Triangles) == contract::FEATURE_PACKED_OCCLUSION
    };
    assert!(packed(json!(null)), "nothing to read");
    assert!(packed(json!({ "index": 0 })), "one texture");
    assert!(packed(json!({ "index": 1 })), "two images of one size");
    assert!(!packed(json!({ "index": 2 })), "two images of two sizes");
    assert!(!packed(json!({ "index": 3 })), "another sampler");
    assert!(!packed(json!({ "index": 0, "texCoord": 1 })), "other texture coordinates");
    assert!(!packed(json!({ "index": 0, "extensions": scaled })), "another transform");
}

/// Two primitives of one mesh; the second has another material in two of three variants.
fn shoe() -> Builder {
    let mut builder = Builder::square();
    builder.json["materials"] = json!([{ "name": "sole" }, { "name": "red" }, { "name": "blue" }]);
    builder.primitive()["material"] = json!(0);
    let mut upper = builder.primitive().clone();
    upper["extensions"]["KHR_materials_variants"]["mappings"] =
        json!([{ "material": 1, "variants": [0] }, { "material": 2, "variants": [2], "name": "sea" }]);
    builder.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(upper);
    builder.json["extensionsRequired"] = json!(["KHR_materials_variants"]);
    builder.json["extensions"]["KHR_materials_variants"]["variants"] =
        json!([{ "name": "Fire" }, { "name": "Plain" }, { "name": "Sea" }]);
    builder
}

#[test]
fn variants_change_materials_and_back() {
    let mut model = shoe().model();
    assert_eq!(*model.variants, ["Fire", "Plain", "Sea"]);
    for (name, upper) in
        [("", "sole"), ("Fire", "red"), ("Sea", "blue"), ("Plain", "sole"), ("Fire", "red"), ("", "sole")]
    {
        model.select_variant(name).unwrap();
        let names = [0, 1].map(|i| model.materials[model.primitives[i].material].name.as_str());
        assert_eq!(names, ["sole", upper], "{name}");
    }
    model.select_variant("Sea").unwrap();
    let error = model.select_variant("sea").unwrap_err();
    assert!(error.contains("no variant 'sea': it has Fire, Plain, Sea"), "{error}");
    assert_eq!(model.materials[model.primitives[1].material].name, "blue", "a bad name changed the model");
    let error = Builder::triangle().model().select_variant("x").unwrap_err();
    assert!(error.contains("it has none"), "{error}");
}

#[test]
fn mistakes_in_variants_cost_the_variants_alone() {
    let names = "/extensions/KHR_materials_variants/variants";
    let mappings = "/meshes/0/primitives/1/extensions/KHR_materials_variants/mappings";
    for (pointer, value, words) in [
        (names, json!([{}]), "extensions.KHR_materials_variants.variants[0]: expected a variant with a name"),
        (names, json!({}), "expected a list, found {}"),
        (
            names,
            json!([{ "name": "Fire" }]),
            "mappings[1].variants: expected an index into variants of 0 to 0, found 2",
        ),
        (mappings, json!([{ "variants": [0] }]), "mappings[0].material: expected an index into materials, found none"),
        (mappings, json!([{ "material": 3, "variants": [0] }]), "an index into materials of 0 to 2, found 3"),
        (mappings, json!([{ "material": 1 }]), "mappings[0].variants: expected a list of variants"),
        (mappings, json!([{ "material": 1, "variants": [-1] }]), "expected an index into variants, found -1"),
        (mappings, json!([{ "material": 1, "variants": [0, 0] }]), "each variant once at most, found variant 0 twice"),
    ] {
        let mut builder = shoe();
        *builder.json.pointer_mut(pointer).unwrap() = value;
        let (told, model) = (builder.told(), builder.model());
        assert!(told.contains(words) && model.warnings.len() == 1, "{told}\nlacks {words}");
        // With the variants go all mappings; a mapping is that of its primitive.
        let has_variants = !told.contains("the model has no variants");
        assert_eq!(model.variants.is_empty(), !has_variants, "{told}");
        assert!(model.primitives.iter().all(|primitive| primitive.variant_materials.is_empty()));
    }
    let mut twins = shoe();
    twins.json["extensions"]["KHR_materials_variants"]["variants"][2]["name"] = json!("Fire");
    assert!(twins.model().warnings[0].contains("'Fire' is there more than once"));
}

#[test]
fn coordinates_other_than_the_first_are_a_feature() {
    let moved = contract::FEATURE_TEXTURE_COORDINATES;
    let transform = |values: Value| json!({ "index": 0, "extensions": { "KHR_texture_transform": values } });
    for (texture, expected) in [
        (json!({ "index": 0 }), 0),
        (json!({ "index": 0, "texCoord": 1 }), moved),
        (transform(json!({})), 0),
        (transform(json!({ "offset": [0, 0], "rotation": 0, "scale": [1, 1] })), 0),
        (transform(json!({ "offset": [0.5, 0] })), moved),
        (transform(json!({ "rotation": 1 })), moved),
        (transform(json!({ "scale": [2, 1] })), moved),
        (transform(json!({ "texCoord": 1 })), moved),
    ] {
        let mut builder = with(json!({}));
        builder.json["materials"][0] = json!({ "emissiveTexture": texture });
        assert_eq!(bits(&builder) & moved, expected, "{texture}");
    }
}

#[test]
fn what_a_mesh_has_not_is_no_feature() {
    let builder = with(json!({}));
    let model = builder.model();
    let asked = contract::FEATURE_UV1 | contract::FEATURE_VERTEX_COLOR;
    for (attributes, expected) in [
        (0, 0),
        (contract::ATTRIBUTE_UV1, contract::FEATURE_UV1),
        (contract::ATTRIBUTE_COLOR, contract::FEATURE_VERTEX_COLOR),
    ] {
        for unlit in [false, true] {
            let mut material = model.materials[1].clone();
            material.unlit = unlit;
            assert_eq!(
                features(&model, &material, attributes, Topology::Triangles) & asked,
                expected,
                "{attributes} {unlit}"
            );
        }
    }
}
