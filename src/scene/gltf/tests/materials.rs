//! Materials, textures, images, files.

use std::io::Cursor;
use std::sync::atomic::{AtomicUsize, Ordering};

use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};

use super::super::super::model::{AlphaMode, Mip, Wrap};
use super::*;
use crate::interface as contract;
use crate::scene::{TexelForm, Texels};

fn encode(format: ImageFormat, image: &DynamicImage) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, format).expect("encodes");
    out.into_inner()
}

fn red(width: u32, height: u32) -> DynamicImage {
    RgbaImage::from_pixel(width, height, Rgba([200, 30, 20, 255])).into()
}

/// A PNG of one color.
pub fn png(width: u32, height: u32) -> Vec<u8> {
    encode(ImageFormat::Png, &red(width, height))
}

#[test]
fn images_of_every_kind() {
    let deep = DynamicImage::from(red(3, 2).into_rgba16());
    let gray = DynamicImage::from(image::GrayImage::from_pixel(3, 2, image::Luma([90])));
    let cases = [
        ("png", encode(ImageFormat::Png, &red(3, 2)), [200, 30, 20]),
        ("webp", encode(ImageFormat::WebP, &red(3, 2)), [200, 30, 20]),
        ("jpeg", encode(ImageFormat::Jpeg, &red(3, 2).into_rgb8().into()), [200, 30, 20]),
        ("16 bits", encode(ImageFormat::Png, &deep), [200, 30, 20]),
        ("gray", encode(ImageFormat::Png, &gray), [90, 90, 90]),
    ];
    for (name, bytes, color) in cases {
        let mut builder = Builder::square();
        builder.image("baseColorTexture", &bytes);
        let model = builder.model();
        assert_eq!((model.images[0].width, model.images[0].height), (3, 2), "{name}");
        let pixels = model.images[0].pixels();
        for (found, expected) in pixels[..3].iter().zip(color) {
            assert!(found.abs_diff(expected) <= 4, "{name}: {:?}", &pixels[..4]);
        }
        assert_eq!(pixels[3], 255);
    }
}

#[test]
fn sixteen_bits_are_kept_unless_they_were_widened_from_eight() {
    let form = |value: u16| {
        let image = image::ImageBuffer::from_pixel(3, 2, image::Luma([value]));
        let mut builder = Builder::square();
        builder.image("normalTexture", &encode(ImageFormat::Png, &DynamicImage::ImageLuma16(image)));
        let model = builder.model();
        match &model.images[0].texels {
            Texels::Stored { form, bytes, .. } => (*form, bytes[..8].to_vec()),
            Texels::Basis(_) => unreachable!(),
        }
    };
    assert_eq!(form(0x1234), (TexelForm::Rgba16, vec![0x34, 0x12, 0x34, 0x12, 0x34, 0x12, 0xff, 0xff]));
    assert_eq!(form(0x1212), (TexelForm::Rgba8, vec![0x12, 0x12, 0x12, 255, 0x12, 0x12, 0x12, 255]));
}

#[test]
fn webp_extension_is_preferred() {
    let mut builder = Builder::square();
    builder.image("baseColorTexture", &png(1, 1));
    let view = builder.view(&encode(ImageFormat::WebP, &red(4, 4)));
    let webp = builder.push("images", json!({ "bufferView": view, "mimeType": "image/webp" }));
    builder.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = json!(webp);
    builder.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    assert_eq!(builder.model().images.iter().map(|image| image.width).collect::<Vec<_>>(), [4]);
}

#[test]
fn textures_are_shared_by_image_and_sampler() {
    let mut builder = Builder::square();
    builder.image("baseColorTexture", &png(1, 1));
    builder.json["samplers"] = json!([{ "magFilter": 9728, "minFilter": 9984, "wrapS": 33071, "wrapT": 33648 }]);
    builder.json["textures"] = json!([{ "source": 0 }, { "source": 0 }, { "source": 0, "sampler": 0 }]);
    builder.json["materials"][0]["occlusionTexture"] = json!({ "index": 1, "strength": 0.5 });
    builder.json["materials"][0]["emissiveTexture"] = json!({ "index": 2 });
    let model = builder.model();
    assert_eq!((model.images.len(), model.textures.len()), (1, 2));
    let sampler = model.textures[1].sampler;
    assert_eq!((sampler.mag_linear, sampler.min_linear, sampler.mip), (false, false, Mip::Nearest));
    assert_eq!((sampler.wrap_u, sampler.wrap_v), (Wrap::Clamp, Wrap::Mirror));
    assert_eq!(model.materials[1].numbers.occlusion_strength, 0.5);
}

/// The tangents that the loader makes follow the picture as the transform turns and mirrors it.
#[test]
fn tangents_turn_with_a_texture_transform() {
    let tangent = |transform: Value| {
        let mut builder = Builder::square();
        builder.image("normalTexture", &png(2, 2));
        builder.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = transform;
        let [x, y, z, w] = builder.model().primitives[0].vertices[0].tangent;
        [x, y, z, w].map(f32::round)
    };
    let quarter = std::f32::consts::FRAC_PI_2;
    assert_eq!(tangent(json!({})), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(tangent(json!({ "scale": [3, 2], "offset": [0.5, 0] })), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(tangent(json!({ "rotation": quarter })), [0.0, -1.0, 0.0, 1.0]);
    assert_eq!(tangent(json!({ "scale": [-1, 1] })), [-1.0, 0.0, 0.0, -1.0]);
}

/// Primitives of equal vertices get the tangents that each would have alone: those of its own texture coordinates.
#[test]
fn equal_geometry_has_tangents_of_its_own_material() {
    let mut builder = Builder::square();
    builder.image("normalTexture", &png(2, 2));
    let turned = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [-1, 1] } } });
    let turned = builder.push("materials", json!({ "normalTexture": turned }));
    let first = builder.primitive().clone();
    let mut other = first.clone();
    other["material"] = json!(turned);
    let mut mirrored = first.clone();
    let accessor = builder.accessor("VEC2", F32, 4, bytemuck::cast_slice(&[1.0_f32, 1., 0., 1., 0., 0., 1., 0.]));
    mirrored["attributes"]["TEXCOORD_0"] = json!(accessor);
    let mut plain = first.clone();
    plain.as_object_mut().unwrap().remove("material");
    builder.json["meshes"][0]["primitives"] = json!([first, other, mirrored, plain, first, other, mirrored]);
    let model = builder.model();
    let (right, left) = ([1.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, -1.0]);
    let tangents: Vec<[f32; 4]> = model.primitives.iter().map(|primitive| primitive.vertices[0].tangent).collect();
    assert_eq!(tangents, [right, left, left, right, right, left, left]);
    for (copy, first) in [(4, 0), (5, 1), (6, 2)] {
        let [copy, first] = [copy, first].map(|index: usize| &model.primitives[index]);
        assert_eq!(
            (&copy.vertices, &copy.indices, copy.attributes),
            (&first.vertices, &first.indices, first.attributes)
        );
    }
}

#[test]
fn texture_transform() {
    let mut builder = Builder::square();
    builder.image("normalTexture", &png(1, 1));
    let transform =
        json!({ "offset": [0.25, 0.5], "rotation": std::f32::consts::FRAC_PI_2, "scale": [2, 4], "texCoord": 1 });
    builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    builder.json["materials"][0]["occlusionTexture"] = json!({ "index": 0 });
    for path in ["/normalTexture", "/occlusionTexture", "/pbrMetallicRoughness/baseColorTexture"] {
        let info = builder.json["materials"][0].pointer_mut(path).unwrap();
        info["extensions"]["KHR_texture_transform"] = transform.clone();
    }
    let model = builder.model();
    for slot in [contract::TEXTURE_NORMAL, contract::TEXTURE_OCCLUSION, contract::TEXTURE_BASE_COLOR] {
        let used = model.materials[1].textures[slot as usize].unwrap();
        assert_eq!(used.uv_set, 1);
        // Counter-clockwise with v down: u turns to -v, v to u.
        let turned = |u, v| used.uv_from_mesh.transform_point2(glam::Vec2::new(u, v));
        assert!(turned(1.0, 0.0).distance(glam::Vec2::new(0.25, 0.5 - 2.0)) < 1e-6, "{}", turned(1.0, 0.0));
        assert!(turned(0.0, 1.0).distance(glam::Vec2::new(0.25 + 4.0, 0.5)) < 1e-6);
    }
    builder.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["scale"] = json!([1e39, 1]);
    assert!(builder.told().contains("finite"));
    builder.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["scale"] = json!("x");
    assert!(builder.told().contains("normalTexture.extensions.KHR_texture_transform"));
    assert_eq!(builder.model().materials[1].textures[contract::TEXTURE_NORMAL as usize], None);
}

#[test]
fn material_numbers() {
    let mut builder = Builder::triangle();
    builder.json["materials"] = json!([{
        "name": "paint", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true, "emissiveFactor": [0.5, 1, 0],
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 1.5,
            "roughnessFactor": 0.5 },
        "extensions": { "KHR_materials_unlit": {}, "KHR_materials_emissive_strength": { "emissiveStrength": 4.0 } }
    }]);
    builder.primitive()["material"] = json!(0);
    let model = builder.model();
    let material = &model.materials[model.primitives[0].material];
    assert_eq!(
        (material.name.as_str(), material.alpha_mode, material.numbers.alpha_cutoff),
        ("paint", AlphaMode::Mask, 0.25)
    );
    assert!(material.double_sided && material.unlit);
    assert_eq!(material.numbers.emissive_factor, [2.0, 4.0, 0.0]);
    assert_eq!((material.numbers.metallic_factor, material.numbers.roughness_factor), (1.0, 0.5));
    assert!(model.warnings.len() == 1 && model.warnings[0].contains("metallicFactor is 1.5"), "{:?}", model.warnings);
    // The default material comes first and is what a primitive without one gets.
    builder.primitive().as_object_mut().unwrap().remove("material");
    assert_eq!(builder.model().primitives[0].material, 0);
    builder.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = json!(1e39);
    assert!(builder.told().contains("metallicFactor is inf"), "{}", builder.told());
    assert_eq!(builder.model().materials[1].numbers.metallic_factor, 1.0);
}

#[test]
fn third_texture_coordinates_are_warned_of() {
    let mut builder = Builder::square();
    builder.image("baseColorTexture", &png(1, 1));
    builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = json!(2);
    let model = builder.model();
    assert_eq!(model.materials[1].textures[0].unwrap().uv_set, 0);
    assert!(model.warnings[0].contains("TEXCOORD_2"));
}

#[test]
fn external_files_and_data_uris() {
    let folder = tempfile::tempdir().unwrap();
    let mut builder = Builder::square();
    builder.image("baseColorTexture", b"");
    builder.json["images"][0] = json!({ "uri": "pictures/r%C3%B6d%20f%C3%A4rg.png" });
    builder.json["buffers"][0]["uri"] = json!("data.bin");
    std::fs::create_dir(folder.path().join("pictures")).unwrap();
    std::fs::write(folder.path().join("pictures/r\u{f6}d f\u{e4}rg.png"), png(5, 5)).unwrap();
    std::fs::write(folder.path().join("data.bin"), &builder.bin).unwrap();
    let path = folder.path().join("model.gltf");
    let open = |builder: &Builder, allow_outside| {
        // A byte order mark is tolerated.
        std::fs::write(&path, format!("\u{feff}{}", builder.json)).unwrap();
        load(&path, &LoadOptions { allow_outside, ..LoadOptions::default() }).map_err(|error| error.to_string())
    };
    let model = open(&builder, false).unwrap();
    assert_sound(&model);
    assert_eq!((&*model.name, model.images[0].width, model.files.len()), ("model", 5, 3));
    assert!(model.files.iter().all(|file| file.is_absolute()), "{:?}", model.files);

    let outside = tempfile::tempdir().unwrap();
    let file = outside.path().join("data.bin");
    std::fs::write(&file, &builder.bin).unwrap();
    builder.json["buffers"][0]["uri"] = json!(file.to_str().unwrap());
    assert!(open(&builder, false).unwrap_err().contains("--allow-outside"));
    assert_sound(&open(&builder, true).unwrap());
    for (uri, word) in
        [("gone.bin", "cannot be read"), ("pictures", "regular file"), ("https://example.org/a", "scheme `https:`")]
    {
        builder.json["buffers"][0]["uri"] = json!(uri);
        let error = open(&builder, true).unwrap_err();
        assert!(error.contains(word) && error.contains("buffers[0]"), "{error}");
    }
    let hex: String = builder.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
    builder.json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream,{hex}"));
    assert_sound(&open(&builder, false).unwrap());
    // A model in memory has no folder.
    builder.json["buffers"][0]["uri"] = json!("data.bin");
    assert!(load_bytes("ball", builder.json.to_string().as_bytes()).unwrap_err().to_string().contains("built-in"));
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_need_leave_too() {
    let (folder, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut builder = Builder::square();
    builder.json["buffers"][0]["uri"] = json!("data.bin");
    let (path, link) = (folder.path().join("model.gltf"), folder.path().join("data.bin"));
    std::fs::write(&path, builder.json.to_string()).unwrap();
    for target in [outside.path().join("data.bin"), folder.path().join("other.bin")] {
        std::fs::write(&target, &builder.bin).unwrap();
        let _ = std::fs::remove_file(&link);
        std::os::unix::fs::symlink(&target, &link).unwrap();
        let refused = load(&path, &LoadOptions::default()).map_err(|error| error.to_string());
        if target.starts_with(folder.path()) {
            assert_sound(&refused.unwrap());
        } else {
            let message = refused.unwrap_err();
            assert!(message.contains("found a link to") && message.contains("--allow-outside"), "{message}");
        }
        assert_sound(&load(&path, &LoadOptions { allow_outside: true, ..LoadOptions::default() }).unwrap());
    }
}

#[test]
fn a_failed_load_names_the_files_whose_repair_to_wait_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.gltf");
    let tried = || open(Some(&path), &LoadOptions::default()).unwrap_err().files;
    assert_eq!(tried(), std::slice::from_ref(&path), "a model that does not exist");
    let mut builder = Builder::square();
    builder.image("baseColorTexture", b"");
    builder.json["images"][0] = json!({ "uri": "picture.png" });
    builder.json["buffers"][0]["uri"] = json!("data.bin");
    std::fs::write(&path, builder.json.to_string()).unwrap();
    assert_eq!(tried(), [path.clone(), folder.path().join("data.bin")], "a buffer that does not exist");
    std::fs::write(folder.path().join("data.bin"), &builder.bin).unwrap();
    let all = ["model.gltf", "data.bin", "picture.png"].map(|name| folder.path().join(name));
    // A picture that is missing or broken has a placeholder, and its repair is waited for too.
    let opened = || open(Some(&path), &LoadOptions::default()).unwrap();
    assert_eq!((opened().files.as_slice(), opened().warnings.len()), (&all[..], 1), "a picture that does not exist");
    std::fs::write(&all[2], b"no picture").unwrap();
    assert_eq!((opened().files.as_slice(), opened().warnings.len()), (&all[..], 1), "a broken picture");
    std::fs::write(&all[2], png(2, 2)).unwrap();
    assert_eq!((opened().files.as_slice(), opened().warnings.len()), (&all[..], 0));
    assert!(load_bytes("ball", b"nonsense").unwrap_err().files.is_empty());
}

#[test]
fn a_load_that_is_canceled_stops_before_the_next_image() {
    let mut builder = Builder::square();
    for slot in ["baseColorTexture", "metallicRoughnessTexture"] {
        builder.image(slot, &png(2, 2));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.glb");
    std::fs::write(&path, builder.glb()).unwrap();
    let open = |images: usize| {
        let asked = AtomicUsize::new(0);
        let canceled = || asked.fetch_add(1, Ordering::Relaxed) >= images;
        open_for(Some(&path), &LoadOptions::default(), Caller::until(&canceled))
    };
    assert_eq!(open(usize::MAX).unwrap().images.len(), 2);
    for images in 0..2 {
        assert!(matches!(*open(images).unwrap_err().problem, Problem::Canceled));
    }
}
