//! One bad image costs that image: a placeholder and a warning, and the rest of the model.

use super::*;
use crate::interface as contract;

const DDS: &[u8] = b"DDS  and so on";
const BASE_COLOR: usize = contract::TEXTURE_BASE_COLOR as usize;

/// A square whose material has these bytes as the image of a slot.
fn with_image(slot: &str, bytes: &[u8]) -> Builder {
    let mut builder = Builder::square();
    builder.image(slot, bytes);
    builder.json["materials"][0]["name"] = json!("Helmet");
    builder
}

/// The only warning of a model.
#[track_caller]
fn warning(builder: &Builder) -> String {
    let model = builder.model();
    assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
    model.warnings[0].clone()
}

#[test]
fn a_base_color_that_cannot_be_decoded_is_a_checkerboard() {
    let mut builder = with_image("baseColorTexture", DDS);
    builder.json["images"][0]["name"] = json!("a.dds");
    let expected = "material 'Helmet', base color texture: image 'a.dds' cannot be decoded (DDS is not supported); \
                    a checkerboard is shown in its place. Export the image as PNG, JPEG, WebP or KTX2.";
    assert_eq!(warning(&builder), expected);
    let model = builder.model();
    let used = model.materials[1].textures[BASE_COLOR].expect("the placeholder");
    let image = &model.images[model.textures[used.texture].image];
    assert_eq!(image.name, "a.dds");
    let pixels = image.pixels();
    let mut colors: Vec<&[u8]> = pixels.chunks_exact(4).collect();
    let mean = colors.iter().map(|color| u32::from(color[0])).sum::<u32>() / colors.len() as u32;
    colors.sort_unstable();
    colors.dedup();
    assert_eq!((colors.len(), mean), (2, 128), "two grays around the middle");
    assert!(colors.iter().all(|color| color[0] == color[1] && color[1] == color[2] && color[3] == 255));
}

#[test]
fn other_slots_show_what_they_show_without_a_texture() {
    for (slot, texture, words) in [
        ("normalTexture", contract::TEXTURE_NORMAL, "normal texture: image 0"),
        ("occlusionTexture", contract::TEXTURE_OCCLUSION, "nothing is occluded"),
        ("metallicRoughnessTexture", contract::TEXTURE_METALLIC_ROUGHNESS, "its factors are used alone"),
        ("emissiveTexture", contract::TEXTURE_EMISSIVE, "no light is emitted"),
    ] {
        let mut builder = with_image(slot, b"nonsense");
        builder.json["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
        let said = warning(&builder);
        assert!(said.contains(words) && said.contains("(it is not PNG, JPEG, WebP or KTX2)"), "{said}");
        let material = &builder.model().materials[1];
        assert_eq!(material.textures[texture as usize], None, "{slot}");
        assert_eq!(material.numbers.emissive_factor == [0.0; 3], slot == "emissiveTexture");
    }
}

#[test]
fn every_kind_of_bad_image_is_named_and_unused_ones_are_not_decoded() {
    let png = materials::png(8, 8);
    for bytes in [
        &png[..40],
        b"hello",
        b"",
        &[0xff, 0xd8, 0xff, 0xe0],
        b"RIFF\0\0\0\0WEBPVP8 ",
        b"GIF89a",
        DDS,
        b"\xabKTX 20\xbb\r\n\x1a\n and so on",
    ] {
        let mut builder = with_image("emissiveTexture", bytes);
        builder.json["images"][0]["name"] = json!("glow");
        let said = warning(&builder);
        assert!(said.starts_with("material 'Helmet', emissive texture: image 'glow' cannot be decoded ("), "{said}");
        assert!(said.len() < 300 && !said.contains('\n'), "{said}");
        // A file cut short is copied again, another format exported.
        let is_other = said.contains("not supported") || said.contains("is empty") || said.contains("it is not PNG");
        let remedy =
            if is_other { "Export the image as PNG, JPEG, WebP or KTX2." } else { "Export or copy the image again." };
        assert!(said.ends_with(remedy), "{said}");
        builder.json["materials"] = json!([{}]);
        let model = builder.model();
        assert!(model.images.is_empty() && model.warnings.is_empty(), "{:?}", model.warnings);
    }
}

#[test]
fn an_image_that_cannot_be_found_costs_only_itself() {
    let again = "Export the model again, or run it through the Khronos glTF validator.";
    let beside = "Save that file beside the model and name it by its relative path.";
    for (image, words, remedy) in [
        (json!({ "bufferView": 99 }), "image 0 cannot be read (images[0]: expected an index into bufferViews", again),
        (
            json!({ "bufferView": 0, "uri": "x.png" }),
            "image 'x.png' cannot be read (images[0]: expected a uri or a",
            again,
        ),
        (json!({}), "found neither", again),
        (json!({ "uri": "https://example.org/a.png" }), "the scheme `https:` is never opened", beside),
        (json!({ "uri": "data:image/png;base64,!!" }), "base64", again),
        (json!({ "uri": "" }), "expected a relative path", again),
    ] {
        let mut builder = with_image("baseColorTexture", &materials::png(2, 2));
        builder.json["images"][0] = image.clone();
        let said = warning(&builder);
        assert!(said.contains(words) && said.contains("checkerboard") && said.ends_with(remedy), "{image}: {said}");
    }
    // A view with an image in it may not be cut short.
    let mut builder = with_image("baseColorTexture", &materials::png(2, 2));
    let view = builder.json["images"][0]["bufferView"].as_u64().unwrap() as usize;
    builder.json["bufferViews"][view]["byteOffset"] = json!(1 << 20);
    assert!(warning(&builder).contains("a range inside"), "{}", warning(&builder));
}

#[test]
fn a_texture_whose_only_image_is_of_another_extension() {
    let mut builder = with_image("baseColorTexture", DDS);
    builder.json["images"][0] = json!({ "uri": "rock.dds" });
    builder.json["textures"][0] = json!({ "extensions": { "MSFT_texture_dds": { "source": 0 } } });
    let said = warning(&builder);
    assert!(said.contains("image 'rock.dds' cannot be decoded (MSFT_texture_dds is not supported); a"), "{said}");
    builder.json["textures"][0] = json!({});
    let said = warning(&builder);
    assert!(said.contains("the image of texture 0 cannot be decoded (the texture names none)"), "{said}");
    // An extension that the file requires is an error all the same.
    builder.json["extensionsRequired"] = json!(["MSFT_texture_dds"]);
    assert!(builder.error().contains("requires MSFT_texture_dds"));
}

#[test]
fn files_outside_of_the_folder_are_not_read_for_images_either() {
    let (folder, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let picture = outside.path().join("picture.png");
    std::fs::write(&picture, materials::png(3, 3)).unwrap();
    let mut builder = with_image("baseColorTexture", b"");
    std::fs::write(folder.path().join("data.bin"), &builder.bin).unwrap();
    builder.json["buffers"][0]["uri"] = json!("data.bin");
    let path = folder.path().join("model.gltf");
    let mut open = |uri: &str, allow_outside| {
        builder.json["images"][0] = json!({ "uri": uri });
        std::fs::write(&path, builder.json.to_string()).unwrap();
        load(&path, &LoadOptions { allow_outside, ..LoadOptions::default() }).unwrap()
    };
    let uri = picture.to_str().unwrap();
    let model = open(uri, false);
    assert!(model.images[0].width != 3 && model.warnings[0].contains("--allow-outside"), "{:?}", model.warnings);
    assert!(!model.files.contains(&picture), "a file outside is not even looked for");
    let model = open(uri, true);
    assert!(model.images[0].width == 3 && model.warnings.is_empty(), "{:?}", model.warnings);
    let model = open("gone.png", false);
    let [said] = model.warnings.as_slice() else { panic!("{:?}", model.warnings) };
    assert!(said.contains("image 'gone.png' cannot be read (there is no such file)"), "{said}");
    assert!(said.ends_with("Put it there or export a self-contained .glb."), "{said}");
}

#[test]
fn one_warning_for_each_slot_names_all_materials() {
    let mut builder = with_image("baseColorTexture", DDS);
    let material = builder.json["materials"][0].clone();
    let named = |name: &str| {
        let mut material = material.clone();
        material["name"] = json!(name);
        material
    };
    builder.json["materials"] = ["a\u{1b}[31m", "", "c", "d", "e"].map(named).to_vec().into();
    builder.json["materials"][4]["normalTexture"] = json!({ "index": 0 });
    let model = builder.model();
    let starts =
        ["materials 'a\\u{1b}[31m', 1, 'c' and 2 more, base color texture: ", "material 'e', normal texture: "];
    assert_eq!(model.warnings.len(), 2, "{:?}", model.warnings);
    for (said, start) in model.warnings.iter().zip(starts) {
        assert!(said.starts_with(start), "{said}");
    }
}
