//! Bad input: every mistake is named with its place, as an error if nothing is left to show, and nothing panics.

use super::*;

/// A file that uses many features, for tests that damage it.
fn rich() -> Builder {
    let mut builder = Builder::square();
    builder.image("normalTexture", &materials::png(2, 2));
    builder.attribute_f32("COLOR_0", "VEC3", &[1.0; 12]);
    let indices = builder.view(&[1, 2]);
    let values = builder.view(bytemuck::cast_slice(&[0.5_f32; 6]));
    builder.json["accessors"][0]["sparse"] = json!({
        "count": 2, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values }
    });
    builder.json["samplers"] = json!([{ "wrapS": 10497 }]);
    builder.json["textures"][0]["sampler"] = json!(0);
    builder.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]);
    builder.json["nodes"][0]["camera"] = json!(0);
    // The readers of all extensions see damaged numbers too.
    builder.json["extensions"]["KHR_materials_variants"]["variants"] = json!([{ "name": "a" }]);
    builder.primitive()["extensions"]["KHR_materials_variants"]["mappings"] =
        json!([{ "material": 0, "variants": [0] }]);
    builder.json["materials"][0]["extensions"] = json!({
        "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatRoughnessTexture": { "index": 0, "texCoord": 0 } },
        "KHR_materials_ior": { "ior": 1.5 },
        "KHR_materials_volume": { "attenuationDistance": 1, "attenuationColor": [1, 1, 0] },
    });
    builder.json["materials"][0]["extras"]["specula"] = json!({ "conductor_n": [1, 1, 1], "conductor_k": [0, 0, 0] });
    builder
}

/// [`rich`] with another value in its JSON.
fn damaged(pointer: &str, value: &Value) -> Builder {
    let mut builder = rich();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = builder.json.pointer_mut(parent).unwrap_or_else(|| panic!("{parent}"));
    match key.parse::<usize>() {
        Ok(index) => parent[index] = value.clone(),
        Err(_) => parent[key] = value.clone(),
    }
    builder
}

/// Sets a value in the JSON of [`rich`] and expects an error with a word.
#[track_caller]
fn assert_refused(pointer: &str, value: Value, word: &str) {
    let error = damaged(pointer, &value).error();
    assert!(error.contains(word), "{pointer} = {value}: {error}");
}

/// Sets a value in the JSON of [`rich`] and expects a model with a warning that has a word.
#[track_caller]
fn assert_told(pointer: &str, value: Value, word: &str) {
    let told = damaged(pointer, &value).told();
    assert!(told.contains(word), "{pointer} = {value}: {told}");
}

#[test]
fn gltf_1_is_named_in_every_form() {
    let message = |text: &str| load_bytes("x.gltf", text.as_bytes()).unwrap_err().to_string();
    for (text, version) in [
        (r#"{ "asset": { "version": "1.0" }, "meshes": {}, "nodes": {}, "scenes": {} }"#, "`1.0`"),
        (r#"{ "asset": { "version": 0.8 }, "meshes": {} }"#, "`0.8`"),
        (r#"{ "meshes": {}, "nodes": {}, "scenes": {} }"#, "1.0 (its lists are objects)"),
        (r#"{ "asset": { "profile": {} }, "accessors": {} }"#, "1.0 (its lists are objects)"),
    ] {
        let error = message(text);
        assert!(error.contains(&format!("needs glTF {version}, expected 2.0. Convert the model")), "{error}");
    }
}

#[test]
fn byte_order_marks_are_no_part_of_the_json() {
    let mut builder = Builder::triangle();
    let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let mut glb = builder.glb();
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap());
    glb.splice(20..20, *b"\xef\xbb\xbf ");
    glb[12..16].copy_from_slice(&(length + 4).to_le_bytes());
    let size = glb.len() as u32;
    glb[8..12].copy_from_slice(&size.to_le_bytes());
    assert_eq!(load_bytes("x.glb", &glb).unwrap().instances.len(), 1);
    builder.json["buffers"][0]["uri"] = json!(format!("DATA:application/octet-stream;BASE64,{data}"));
    let text = format!("\u{feff}{}", builder.json);
    assert_eq!(load_bytes("x.gltf", text.as_bytes()).unwrap().instances.len(), 1);
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(load_bytes("x.gltf", &wide).unwrap_err().to_string().contains("perhaps UTF-16"));
}

/// Programs that know only paths write them with backslashes, and do not encode spaces or percent signs.
#[test]
fn paths_of_other_writers_find_their_files() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("tex")).unwrap();
    let mut builder = Builder::square();
    builder.image("emissiveTexture", &materials::png(2, 2));
    std::fs::write(folder.path().join("b.bin"), &builder.bin).unwrap();
    builder.json["buffers"][0]["uri"] = json!("b.bin");
    for (file, uri) in [
        ("tex/back.png", "tex\\back.png"),
        ("tex/back.png", ".\\tex\\back.png"),
        ("tex/50% gray.png", "tex/50% gray.png"),
        ("tex/50% gray.png", "tex\\50% gray.png"),
        ("tex/50% gray.png", "tex/50%25%20gray.png"),
        ("tex/a%20b.png", "tex/a%20b.png"),
        ("tex\\name.png", "tex\\name.png"),
    ] {
        let path = folder.path().join(file);
        std::fs::write(&path, materials::png(2, 2)).unwrap();
        builder.json["images"][0] = json!({ "uri": uri });
        let model = folder.path().join("m.gltf");
        std::fs::write(&model, builder.json.to_string()).unwrap();
        let loaded = load(&model, &LoadOptions::default()).unwrap();
        assert!(loaded.warnings.is_empty(), "{uri}: {:?}", loaded.warnings);
        assert!(
            loaded.files.contains(&path) || loaded.files.iter().any(|used| used.ends_with(file)),
            "{:?}",
            loaded.files
        );
        std::fs::remove_file(path).unwrap();
        let missing = load(&model, &LoadOptions::default()).unwrap();
        assert!(missing.warnings[0].contains("there is no such file"), "{uri}: {:?}", missing.warnings);
    }
}

#[test]
fn files_that_are_not_gltf() {
    let message = |bytes: &[u8]| load_bytes("x.glb", bytes).unwrap_err().to_string();
    assert!(message(b"").contains("is empty"));
    assert!(message(b" \n").contains("only white space"));
    assert!(message(b"\x89PNG\r\n").contains("is not a glTF file"));
    assert!(message(b"{").contains("JSON") && message(b"{").contains("line 1"));
    assert!(message(b"{}").contains("asset"));
    assert!(message(b"{\"asset\":{\"version\":\"2.0\"}}").contains("nothing to draw"));
    assert!(message(b"glTF").contains("damaged GLB"));
    let missing = load("/nonexistent/model.glb".as_ref(), &LoadOptions::default()).unwrap_err();
    assert!(missing.to_string().contains("/nonexistent/model.glb: cannot be read"));
    assert!(load(tempfile::tempdir().unwrap().path(), &LoadOptions::default()).is_err());
}

#[test]
fn damaged_containers() {
    let glb = rich().glb();
    let changed = |at: usize, value: u32| {
        let mut bytes = glb.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        load_bytes("x.glb", &bytes).unwrap_err().to_string()
    };
    assert!(changed(4, 1).contains("needs glTF 1"));
    for length in [0, 4, 12, 19, u32::MAX] {
        assert!(changed(8, length).contains("damaged GLB"), "{length}");
    }
    assert!(changed(12, u32::MAX).contains("chunk of 4294967295 bytes"));
    assert!(changed(16, 7).contains("JSON chunk first"));
}

#[test]
fn versions_and_extensions() {
    assert_refused("/asset/version", json!("1.0"), "needs glTF `1.0`, expected 2.0");
    assert_refused("/asset/version", json!("two"), "needs glTF `two`");
    assert_refused("/asset/minVersion", json!("2.1"), "needs glTF `2.1`");
    assert_refused("/extensionsRequired", json!(["EXT_something", "KHR_materials_unlit"]), "EXT_something, which");
    let mut builder = Builder::square();
    builder.json["asset"]["version"] = json!("2.7");
    builder.json["extensionsUsed"] = json!(["KHR_materials_ior", "EXT_x", "EXT_x", "EXT_y"]);
    let warnings = builder.model().warnings;
    let named = |word: &str| warnings.iter().filter(|warning| warning.contains(word)).count();
    assert_eq!((warnings.len(), named("EXT_y is ignored"), named("EXT_x")), (2, 1, 1), "{warnings:?}");
    builder.json["extensionsUsed"] = json!(["MSFT_lod", "EXT_texture_webp", "MSFT_lod", "EXT_texture_avif"]);
    assert_eq!(
        *builder.model().warnings,
        [
            "The extension EXT_texture_avif is ignored: the PNG, JPEG, WebP or KTX2 image of each texture is shown, if it has one.",
            "The extension MSFT_lod is ignored: the finest level of detail is shown at every distance.",
        ]
    );
}

#[test]
fn accessors() {
    let huge = json!(u64::MAX);
    for (key, value, word) in [
        ("count", json!(0), "at least 1"),
        ("count", huge.clone(), "elements"),
        ("count", json!(5), "inside of the bufferView"),
        ("byteOffset", huge.clone(), "inside of the bufferView"),
        ("byteOffset", json!(4), "inside of the bufferView"),
        ("bufferView", json!(99), "an index into bufferViews"),
        ("type", json!("VEC2"), "expected Vec3 of F32"),
        ("type", json!("SCALAR"), "expected Vec3 of F32"),
        ("type", json!("VEC9"), "that glTF defines"),
        ("componentType", json!(U32), "expected Vec3 of F32"),
        ("componentType", json!(1), "that glTF defines"),
    ] {
        // The other attributes would report a wrong count first.
        let mut builder = Builder::triangle();
        builder.json["accessors"][0][key] = value.clone();
        let error = builder.error();
        assert!(error.contains(word) && error.contains("accessors[0]"), "{key} = {value}: {error}");
    }
    assert_refused("/accessors/1/count", json!(3), "as many elements as POSITION has");
    assert_refused("/accessors/0/count", json!(-1), "JSON");
    assert_refused("/accessors/0/sparse/count", json!(5), "a count of 1 to 4");
    assert_refused("/accessors/0/sparse/count", json!(0), "a count of 1 to 4");
    assert_refused("/accessors/0/sparse/count", json!(4), "inside of the bufferView");
    assert_refused("/accessors/0/sparse/indices/byteOffset", huge, "inside of the bufferView");
    assert_refused("/accessors/0/sparse/indices/componentType", json!(F32), "indices of U8");
    // Byte 14 of the positions is part of a float.
    let indices = json!({ "bufferView": 0, "byteOffset": 14, "componentType": U8 });
    assert_refused("/accessors/0/sparse/indices", indices, "indices below the count of 4");
    assert_refused("/accessors/0/sparse/values/bufferView", json!(77), "an index into bufferViews");
    let mut zeros = Builder::triangle();
    zeros.json["accessors"][0] = json!({ "componentType": F32, "type": "VEC3", "count": 1_u64 << 40 });
    assert!(zeros.error().contains("without a bufferView"));
}

#[test]
fn buffers_and_views() {
    assert_refused("/bufferViews/0/byteStride", json!(4), "byteStride of at least 12");
    assert_refused("/bufferViews/0/byteStride", json!(0), "byteStride of at least 12");
    assert_refused("/bufferViews/0/byteStride", json!(u64::MAX), "inside of the bufferView");
    assert_refused("/bufferViews/0/byteLength", json!(u64::MAX), "a range inside");
    assert_refused("/bufferViews/0/byteOffset", json!(u64::MAX), "a range inside");
    assert_refused("/bufferViews/0/buffer", json!(3), "an index into buffers");
    assert_told("/buffers/0/byteLength", json!(1 << 30), "bytes (byteLength)");
    assert_refused("/buffers/0/byteLength", json!(8), "a range inside of the 8 bytes");
    assert_refused("/buffers/0/uri", json!("%ff"), "the external file `%ff`");
    assert_refused("/buffers/0/uri", json!(""), "expected a relative path, found an empty text");
    assert_refused("/buffers/0/uri", json!("data:;base64,!!"), "base64");
    let text = rich().json.to_string();
    assert!(load_bytes("x", text.as_bytes()).unwrap_err().to_string().contains("binary chunk of a GLB"));
}

#[test]
fn primitives_and_references() {
    let primitive = "/meshes/0/primitives/0";
    for (key, value, word) in [
        ("mode", json!(9), "a mode of 0 to 6"),
        ("indices", json!(99), "an index into accessors"),
        ("indices", json!(0), "expected Scalar of U8"),
        ("attributes", json!({}), "the attribute POSITION"),
        ("attributes", json!({ "POSITION": 99 }), "an index into accessors"),
    ] {
        assert_refused(&format!("{primitive}/{key}"), value, word);
    }
    assert_told(&format!("{primitive}/material"), json!(5), "replaced by the default material");
    assert_told("/textures/0/source", json!(9), "an index into images");
    assert_told("/textures/0/sampler", json!(9), "an index into samplers");
    assert_told("/samplers/0/wrapS", json!(1), "samplers[0].wrapS");
    assert_told("/samplers/0/minFilter", json!(1), "samplers[0].minFilter");
    assert_told("/materials/0/normalTexture/index", json!(9), "an index into textures");
    assert_told("/materials/0/alphaMode", json!("GLASS"), "OPAQUE, MASK or BLEND");
    assert_refused("/meshes/0/primitives", json!([]), "nothing to draw");
    let mut builder = Builder::square();
    builder.indices(U16, &[0, 1, 4]);
    assert!(builder.error().contains("indices below the vertex count of 4, found 4"));
    builder.indices(U16, &[0, 1]);
    assert!(builder.error().contains("at least 3 indices"));
    for bad in [f32::NAN, f32::INFINITY, 1e30] {
        let positions = [0.0, 0.0, 0.0, 1.0, bad, 0.0, 0.0, 1.0, 0.0];
        assert!(Builder::positions(&positions).error().contains("at vertex 1"));
    }
}

/// No panic and no broken invariant: a model that loads keeps all promises of `Model`.
fn survives(bytes: &[u8], what: std::fmt::Arguments<'_>) {
    match load_bytes("damaged", bytes) {
        Ok(model) => assert_sound(&model),
        Err(error) => assert!(!matches!(*error.problem, Problem::Refused { .. }), "{what}: {error}"),
    }
}

#[test]
fn truncation_at_every_length() {
    let glb = rich().glb();
    for length in 0..glb.len() {
        survives(&glb[..length], format_args!("cut to {length}"));
        assert!(load_bytes("cut", &glb[..length]).is_err(), "{length}");
    }
}

#[test]
fn flipped_bytes() {
    let glb = rich().glb();
    for at in 0..glb.len() {
        for bits in [0x01, 0x10, 0x80, 0xff] {
            let mut bytes = glb.clone();
            bytes[at] ^= bits;
            survives(&bytes, format_args!("byte {at} ^ {bits:#x}"));
        }
    }
}

#[test]
fn digits_changed_everywhere() {
    // Bit flips seldom leave valid JSON with another number in it; this replaces numbers.
    let builder = rich();
    let text = builder.json.to_string();
    for (at, _) in text.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
        for digits in ["0", "9", "99999999", "4294967295", "18446744073709551615", "-1", "1e39"] {
            let changed = format!("{}{digits}{}", &text[..at], &text[at + 1..]);
            if let Ok(json) = serde_json::from_str(&changed) {
                survives(&Builder { json, bin: builder.bin.clone() }.glb(), format_args!("{changed}"));
            }
        }
    }
}
