//! A buffer, stream or extension that cannot be used costs the parts that need it, with a warning, and not the model.

use super::compression::{draco, meshopt, plane};
use super::motion::animate;
use super::*;

/// Two triangles beside each other, the meshes 'left' and 'right'. The data of the right one are in the second buffer.
fn two() -> Builder {
    let mut builder = Builder::triangle();
    let right = builder.bin.clone();
    builder.json["meshes"][0]["name"] = json!("left");
    builder.push("buffers", json!({ "byteLength": right.len(), "uri": "right.bin" }));
    let view = builder.push("bufferViews", json!({ "buffer": 1, "byteLength": right.len() }));
    let accessor =
        builder.push("accessors", json!({ "bufferView": view, "componentType": F32, "count": 3, "type": "VEC3" }));
    let mesh = json!({ "name": "right", "primitives": [{ "attributes": { "POSITION": accessor } }] });
    builder.push("meshes", mesh);
    builder.push("nodes", json!({ "mesh": 1, "name": "right", "translation": [3, 0, 0] }));
    builder.json["scenes"][0]["nodes"] = json!([0, 1]);
    builder
}

/// Adds the mesh, with all that it needs, of a model as a second one beside this.
fn beside(mut builder: Builder) -> Builder {
    let plain = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let position = builder.accessor("VEC3", F32, 3, bytemuck::cast_slice(&plain));
    builder.push("meshes", json!({ "name": "plain", "primitives": [{ "attributes": { "POSITION": position } }] }));
    builder.push("nodes", json!({ "mesh": 1 }));
    builder.json["scenes"][0]["nodes"] = json!([0, 1]);
    builder
}

/// The model and its warnings, with the names of the primitives that are left.
#[track_caller]
fn left_of(model: &Model) -> (Vec<&str>, String) {
    assert_sound(model);
    (model.primitives.iter().map(|primitive| primitive.name.as_str()).collect(), model.warnings.join("\n"))
}

#[test]
fn a_missing_or_short_buffer_costs_the_meshes_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let (path, left, right) =
        (folder.path().join("m.gltf"), folder.path().join("left.bin"), folder.path().join("right.bin"));
    let mut builder = two();
    builder.json["buffers"][0]["uri"] = json!("left.bin");
    std::fs::write(&path, builder.json.to_string()).unwrap();
    std::fs::write(&left, &builder.bin).unwrap();
    let load = || load(&path, &LoadOptions::default());
    let missing = load().unwrap();
    let (names, told) = left_of(&missing);
    assert_eq!((names, missing.instances.len()), (vec!["left #0"], 1));
    let start = format!("meshes[1] \"right\".primitives[0]: buffers[1] needs the file {}", right.display());
    assert!(told.starts_with(&start) && told.contains("; the primitive is left out. Put it there or export"), "{told}");
    assert!(missing.files.contains(&right), "its repair is not waited for: {:?}", missing.files);
    // Enough of a buffer for one mesh, or for none.
    std::fs::write(&right, &builder.bin[..20]).unwrap();
    let short = load().unwrap();
    let (names, told) = left_of(&short);
    assert_eq!(names, ["left #0"]);
    assert!(
        told.contains("buffers[1]: expected 36 bytes (byteLength), found 20 bytes; the buffer is used as far"),
        "{told}"
    );
    let words = "meshes[1] \"right\".primitives[0]: buffers[1]: expected 36 bytes (byteLength), found 20 bytes; the";
    assert!(told.contains(words), "{told}");
    std::fs::write(&right, &builder.bin).unwrap();
    assert_eq!(left_of(&load().unwrap()), (vec!["left #0", "right #0"], String::new()));
    // Without any mesh, the model is an error, which names the first.
    std::fs::remove_file(&left).unwrap();
    std::fs::remove_file(&right).unwrap();
    let error = load().unwrap_err();
    assert!(error.to_string().contains("left.bin") && error.files.contains(&left), "{error}");
}

#[test]
fn parts_with_one_reason_are_one_warning() {
    let mut builder = two();
    let primitive = builder.json["meshes"][1]["primitives"][0].clone();
    builder.json["meshes"][1]["primitives"] = vec![primitive; 5].into();
    let (told, model) = (builder.told(), builder.model());
    assert_eq!((model.warnings.len(), model.primitives.len()), (1, 1), "{told}");
    let place = |number: usize| format!("meshes[1] \"right\".primitives[{number}]");
    let start = format!("{}, {}, {}, others: ", place(0), place(1), place(2));
    assert!(told.starts_with(&start) && told.contains("; 5 such primitives are left out."), "{told}");
}

#[test]
fn many_reasons_are_not_all_told() {
    let mut builder = two();
    let primitive = |accessor: usize| json!({ "attributes": { "POSITION": accessor } });
    builder.json["meshes"][1]["primitives"] = (2..402).map(primitive).collect();
    let model = builder.model();
    assert_eq!(model.warnings.len(), 51);
    assert!(model.warnings[0].contains("an index into accessors of 0 to 1, found 2"), "{}", model.warnings[0]);
    assert_eq!(model.warnings[50], "350 more parts are left out, for other reasons.");
}

#[test]
fn clips_and_skins_in_a_missing_buffer_are_left_out() {
    let mut builder = two();
    let targets = [
        (json!({ "node": 0, "path": "translation" }), "LINEAR", "VEC3", &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0][..]),
        (json!({ "node": 0, "path": "scale" }), "LINEAR", "VEC3", &[1.0; 6][..]),
    ];
    animate(&mut builder, &[0.0, 1.0], &targets);
    let output = builder.json["animations"][0]["samplers"][1]["output"].as_u64().unwrap() as usize;
    builder.json["accessors"][output]["bufferView"] = json!(1);
    builder.json["skins"] =
        json!([{ "joints": [1], "inverseBindMatrices": builder.json["accessors"].as_array().unwrap().len() }]);
    builder.push("accessors", json!({ "bufferView": 1, "componentType": F32, "count": 1, "type": "MAT4" }));
    builder.json["nodes"][0]["skin"] = json!(0);
    let (told, model) = (builder.told(), builder.model());
    assert_eq!(model.motion.clips[0].channels.len(), 1, "{told}");
    assert!(model.motion.rig.skins.is_empty(), "{told}");
    for words in ["the channel is not played", "the skin is left out", "the primitive is left out"] {
        assert!(told.contains(words), "{told}\nlacks {words}");
    }
}

#[test]
fn a_texture_that_does_not_exist_costs_itself_alone() {
    let mut builder = Builder::square();
    let texture = json!({ "index": 9 });
    builder.json["materials"] = json!([{
        "name": "paint", "emissiveTexture": texture, "emissiveFactor": [1, 1, 1], "normalTexture": texture,
        "pbrMetallicRoughness": { "baseColorTexture": texture, "baseColorFactor": [0.5, 0.25, 0, 1] },
    }]);
    builder.primitive()["material"] = json!(0);
    let (told, model) = (builder.told(), builder.model());
    let material = &model.materials[1];
    assert!(material.textures.iter().all(Option::is_none));
    assert_eq!(material.numbers.base_color_factor, [0.5, 0.25, 0.0, 1.0]);
    // The factor alone would make the whole surface emit.
    assert_eq!(material.numbers.emissive_factor, [0.0; 3]);
    for slot in ["pbrMetallicRoughness.baseColorTexture", "normalTexture", "emissiveTexture"] {
        let words =
            format!("materials[0] \"paint\".{slot}: expected no use of textures, of which there are none, found 9");
        assert!(told.contains(&format!("{words}; the texture is left out. Export")), "{told}\nlacks {words}");
    }
}

#[test]
fn a_damaged_stream_costs_its_primitive() {
    let shape = plane(3);
    let extension = "EXT_meshopt_compression";
    let mut packed = beside(meshopt(extension, &shape));
    packed.json["bufferViews"][0]["extensions"][extension]["byteLength"] = json!(20);
    let mut drawn = beside(draco(&shape));
    drawn.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = json!(77);
    let mut greedy = beside(meshopt(extension, &shape));
    greedy.json["bufferViews"][0]["extensions"][extension]["count"] = json!(1_u64 << 40);
    let mut odd = beside(draco(&shape));
    odd.primitive()["extensions"]["KHR_draco_mesh_compression"] = json!({ "bufferView": "x" });
    for (builder, words) in [
        (packed, "meshes[0] \"m\".primitives[0]: bufferViews[0].extensions.EXT_meshopt_compression: expected a valid"),
        (
            drawn,
            "KHR_draco_mesh_compression: expected an attribute 77 in the stream (POSITION), found none; the primitive",
        ),
        (greedy, "a file whose parts take at most 1024 MiB in all when decoded"),
        (odd, "KHR_draco_mesh_compression: expected a compressed primitive, found"),
    ] {
        let model = builder.model();
        let (names, told) = left_of(&model);
        assert_eq!(names, ["plain #0"], "{told}");
        assert!(told.contains(words) && told.contains("the primitive is left out"), "{told}\nlacks {words}");
    }
}
