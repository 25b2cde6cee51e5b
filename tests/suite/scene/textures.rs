//! Textures in the form of their files: compressed, with their own mip levels, with more than 8 bits.

use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::{Mat4, Vec3};
use serde_json::json;

use crate::support::process::{finish, specula};
use crate::support::{SIZE, assert_validated, glb, load, render, renderer, settings};
use specula::interface::{TEXTURE_BASE_COLOR, TEXTURE_EMISSIVE, TEXTURE_METALLIC_ROUGHNESS, TEXTURE_OCCLUSION};
use specula::render::Capture;
use specula::scene::{Image, Instance, Material, Model, Primitive, Sampler, TexelForm, Texels, Texture, TextureUse};

/// Pictures of 32x32 texels with all levels, as Binomial's encoder has written them, and the levels as Binomial's transcoder gives them in BC7.
const FILES: [(&str, &[u8], &[u8]); 2] = [
    ("uastc", include_bytes!("../../textures/uastc.ktx2"), include_bytes!("../../textures/uastc.bc7")),
    ("etc1s", include_bytes!("../../textures/etc1s.ktx2"), include_bytes!("../../textures/etc1s.bc7")),
];

/// The levels of such a picture as RGBA8.
fn decoded(bc7: &[u8]) -> Vec<u8> {
    let (mut out, mut rest) = (Vec::new(), bc7);
    for side in [32_usize, 16, 8, 4, 2, 1] {
        let columns = side.div_ceil(4);
        let mut padded = vec![0; (4 * columns).pow(2) * 4];
        for at in 0..columns * columns {
            let (block, later) = rest.split_at(16);
            bcdec_rs::bc7(block, &mut padded[(at / columns * 16 * columns + at % columns * 4) * 4..], columns * 16);
            rest = later;
        }
        out.extend(padded.chunks(columns * 16).take(side).flat_map(|row| &row[..side * 4]));
    }
    out
}

/// A square with texture coordinates and a material that shows its textures unchanged, as a file. `image`: its base color.
fn file(image: &[u8], mime: &str) -> Vec<u8> {
    let material = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.0 } });
    let (mut json, mut bin) = glb::document(&glb::quad(1.0), &material);
    let mut view = |bytes: &[u8]| {
        let view = json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() });
        bin.extend(bytes);
        bin.resize(bin.len().next_multiple_of(4), 0);
        view
    };
    let uv = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let views = [view(bytemuck::cast_slice(&uv)), view(image)];
    let first = json["bufferViews"].as_array().unwrap().len();
    json["bufferViews"].as_array_mut().unwrap().extend(views);
    let accessors = json["accessors"].as_array_mut().unwrap();
    accessors.push(json!({ "bufferView": first, "componentType": 5126, "count": 4, "type": "VEC2" }));
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(accessors.len() - 1);
    json["images"] = json!([{ "bufferView": first + 1, "mimeType": mime }]);
    json["textures"] = json!([{ "source": 0 }]);
    if mime == "image/ktx2" {
        json["extensionsUsed"] = json!(["KHR_texture_basisu"]);
        json["textures"] = json!([{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }]);
    }
    json["buffers"][0]["byteLength"] = json!(bin.len());
    glb::container(&json, &bin)
}

/// The square with these images in slots of its material.
fn model(images: &[(u32, Image)]) -> Model {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(1, 1).write_to(&mut png, image::ImageFormat::Png).unwrap();
    let mut model = load(&file(&png.into_inner(), "image/png"));
    model.images = Arc::new(images.iter().map(|(_, image)| image.clone()).collect());
    let texture = |image| Texture { image, sampler: Sampler::default() };
    model.textures = Arc::new((0..images.len()).map(texture).collect());
    let material = &mut Arc::make_mut(&mut model.materials)[1];
    material.textures[TEXTURE_BASE_COLOR as usize] = None;
    for (texture, (slot, _)) in images.iter().enumerate() {
        let used = TextureUse { texture, uv_set: 0, uv_from_mesh: glam::Affine2::IDENTITY };
        material.textures[*slot as usize] = Some(used);
    }
    (material.numbers.metallic_factor, material.numbers.emissive_factor) = (1.0, [1.0; 3]);
    model
}

fn stored(size: (u32, u32), form: TexelForm, levels: u32, bytes: Vec<u8>) -> Image {
    Image::new("image".into(), size.0, size.1, Texels::Stored { form, levels, bytes })
}

const PLAIN: [&str; 3] = ["environment.name=none", "view.msaa=1", "view.background=none"];

/// The largest difference of the visible pixels.
fn difference(a: &Capture, b: &Capture) -> f32 {
    let pixels = a.raw.iter().zip(&b.raw).filter(|(a, _)| a[3] == 1.0);
    assert!(pixels.clone().count() > 100, "the square is visible");
    pixels.flat_map(|(a, b)| (0..3).map(|channel| (a[channel] - b[channel]).abs())).fold(0.0, f32::max)
}

#[test]
fn transcoded_textures_look_like_the_texels_of_the_transcoder_of_basis_universal() {
    for (name, ktx2, bc7) in FILES {
        let levels = &decoded(bc7);
        let mut headless = renderer(load(&file(ktx2, "image/ktx2")), settings(&PLAIN), SIZE);
        let image = headless.model().images[0].clone();
        // The software device samples BC, and neither ASTC nor ETC2.
        assert_eq!((image.form, image.levels, image.bytes()), (TexelForm::Bc7, 6, 87 * 16), "{name}");
        let found = render(&mut headless, "base-color");
        let texel = headless.texels((SIZE.0 / 2, SIZE.1 / 2)).unwrap().remove(0);
        let [x, y] = texel.place.texel;
        let expected: Vec<i32> = levels[(y * 32 + x) as usize * 4..][..4].iter().map(|byte| i32::from(*byte)).collect();
        let stored = texel.stored.map(i32::from);
        assert!(stored.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1), "{name}: {stored:?}, not {expected:?}");
        assert_eq!((texel.place.form, texel.json()["form"].as_str()), (TexelForm::Bc7, Some("BC7")));
        let plain = stored_levels(levels);
        let mut headless = renderer(model(&[(TEXTURE_BASE_COLOR, plain)]), settings(&PLAIN), SIZE);
        let expected = render(&mut headless, "base-color");
        let error = difference(&found, &expected);
        assert!(error < 0.005, "{name}: BC7 differs by {error} of linear light");
    }
    assert_validated();
}

fn stored_levels(rgba8: &[u8]) -> Image {
    stored((32, 32), TexelForm::Rgba8, 6, rgba8.to_vec())
}

/// A block of BC1 with one color of 5, 6 and 5 bits.
fn bc1(color: u16) -> Vec<u8> {
    [color.to_le_bytes(), color.to_le_bytes(), [0; 2], [0; 2]].concat()
}

#[test]
fn the_mip_levels_of_a_file_are_shown() {
    // 256 texels across are 64 blocks. Level 0 is red, and all others are green, which no averaging of red gives.
    let blocks = |level: u32| (64_usize >> level).max(1).pow(2);
    let bytes = (0..9).flat_map(|level| bc1(if level == 0 { 0xf800 } else { 0x07e0 }).repeat(blocks(level))).collect();
    let image = stored((256, 256), TexelForm::Bc1Rgb, 9, bytes);
    let mut headless = renderer(model(&[(TEXTURE_BASE_COLOR, image)]), settings(&PLAIN), (48, 48));
    assert_eq!(headless.model().images[0].form, TexelForm::Bc1Rgb);
    let small = render(&mut headless, "base-color").raw_at(24, 24).unwrap();
    assert!(small[0] < 0.01 && small[1] > 0.99, "{small:?}");
    let near = ["camera.eye=[0, 0, 0.05]", "camera.target=[0, 0, 0]"];
    near.iter().for_each(|assignment| headless.settings_mut().assign(assignment).unwrap());
    let near = render(&mut headless, "base-color").raw_at(24, 24).unwrap();
    assert!(near[0] > 0.99 && near[1] < 0.01, "{near:?}");
}

#[test]
fn sixteen_bits_and_floats_reach_the_shader() {
    let wide = |texel: [u16; 4]| {
        let bytes = texel.iter().flat_map(|word| word.to_le_bytes()).collect();
        stored((1, 1), TexelForm::Rgba16, 1, bytes)
    };
    let half = |texel: [f32; 4]| {
        let bytes = texel.iter().flat_map(|value| half::f16::from_f32(*value).to_le_bytes()).collect();
        stored((1, 1), TexelForm::Half, 1, bytes)
    };
    // sRGB 0x0180 is 4.54e-4 of light, and 30 of 65535 is nearest; of 8 bits, 1 is nearest, which is 3.04e-4.
    let images = [
        (TEXTURE_BASE_COLOR, wide([0x0180, 0x8000, 0xffff, 0xffff])),
        (TEXTURE_METALLIC_ROUGHNESS, wide([0, 0x4080, 0x6060, 0xffff])),
        (TEXTURE_EMISSIVE, half([4.0, 0.25, 0.0, 1.0])),
    ];
    let mut headless = renderer(model(&images), settings(&PLAIN), SIZE);
    let mut shown = |mode: &str| render(&mut headless, mode).raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
    let close = |found: [f32; 4], expected: [f32; 3], error: f32| {
        let differs = found.iter().zip(expected).any(|(found, expected)| (found - expected).abs() > error * expected);
        assert!(!differs, "{found:?}, not {expected:?}");
    };
    close(shown("base-color"), [30.0 / 65535.0, 0.214_04, 1.0], 0.002);
    close(shown("roughness"), [0.251_95; 3], 0.001);
    close(shown("metallic"), [0.376_47; 3], 0.001);
    close(shown("emissive"), [4.0, 0.25, 0.0], 0.001);
    let texels = headless.texels((SIZE.0 / 2, SIZE.1 / 2)).unwrap();
    let near = texels[0].stored.iter().zip([0x0180_u16, 0x8000, 0xffff, 0xffff]).all(|(a, b)| a.abs_diff(b) <= 4);
    assert!(near, "{:x?}", texels[0].stored);
    assert_eq!((texels[0].place.form, texels[1].stored[1]), (TexelForm::Rgba16, 0x4080));
}

#[test]
fn occlusion_is_not_packed_into_compressed_textures_and_is_right() {
    // Level by level, since compressed texels without levels are decoded.
    let blocks = |color: u16| -> Vec<u8> { (0..2).flat_map(|_| bc1(color)).collect() };
    // Green 32 of 63 and blue 16 of 31 are roughness and metallic; red 8 of 31 is occlusion.
    let images = [
        (TEXTURE_METALLIC_ROUGHNESS, stored((4, 4), TexelForm::Bc1Rgb, 2, blocks(32 << 5 | 16))),
        (TEXTURE_OCCLUSION, stored((4, 4), TexelForm::Bc1Rgb, 2, blocks(8 << 11))),
    ];
    let mut headless = renderer(model(&images), settings(&PLAIN), SIZE);
    for (mode, expected) in [("roughness", 32.0 / 63.0), ("metallic", 16.0 / 31.0), ("occlusion", 8.0 / 31.0)] {
        let found = render(&mut headless, mode).raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap()[0];
        assert!((found - expected).abs() < 0.006, "{mode}: {found}, not {expected}");
    }
}

/// The square as a wall that shines with its emissive texture, and a white floor before it that nothing else lights.
fn wall_and_floor(image: Image) -> Model {
    let mut model = model(&[(TEXTURE_EMISSIVE, image)]);
    let materials = Arc::make_mut(&mut model.materials);
    materials[1].numbers.base_color_factor = [0.0, 0.0, 0.0, 1.0];
    let mut white = Material::default();
    (white.numbers.metallic_factor, white.numbers.roughness_factor) = (0.0, 1.0);
    materials.push(white);
    let primitives = Arc::make_mut(&mut model.primitives);
    let floor = Primitive { material: 2, default_material: 2, ..primitives[0].clone() };
    primitives.push(floor);
    // The square faces +Z; the floor faces +Y, and begins at the lower edge of the wall.
    let placed = Mat4::from_translation(Vec3::new(0.0, -1.0, 1.0)) * Mat4::from_rotation_x(-FRAC_PI_2);
    let wall = model.instances[0].clone();
    model.instances.push(Instance { primitive: 1, world_from_object: placed * wall.world_from_object, ..wall });
    (model.bounds.min, model.bounds.max) = (Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 2.0));
    model
}

#[test]
fn path_tracing_reads_compressed_textures() {
    let (_, ktx2, bc7) = FILES[0];
    let dark = ["lights.orbit.0.strength=0", "lights.orbit.1.strength=0", "lights.orbit.2.strength=0"];
    let camera = ["camera.eye=[0, 4, 4]", "camera.target=[0, -1, 1]", "lights.ambient_strength=0"];
    let floor = |image: Image| {
        let mut headless = renderer(wall_and_floor(image), settings(&[&PLAIN[..], &dark, &camera].concat()), (24, 24));
        let (traced, base) = (render(&mut headless, "path-traced"), render(&mut headless, "base-color"));
        let pixels = traced.raw.iter().zip(&base.raw).filter(|(_, base)| base[0] == 1.0 && base[3] == 1.0);
        let sums = pixels.map(|(traced, _)| *traced).collect::<Vec<_>>();
        assert!(sums.len() > 50, "the floor is visible");
        [0, 1, 2].map(|channel| sums.iter().map(|color| color[channel]).sum::<f32>() / sums.len() as f32)
    };
    let image = load(&file(ktx2, "image/ktx2")).images[0].clone();
    let (found, expected) = (floor(image), floor(stored_levels(&decoded(bc7))));
    assert!(expected.iter().all(|light| *light > 0.01), "the wall lights the floor: {expected:?}");
    let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.02 * b);
    assert!(near, "{found:?}, not {expected:?}");
}

#[test]
fn info_counts_the_memory_of_the_form_on_the_device() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.glb"), file(FILES[0].1, "image/ktx2")).unwrap();
    let told = |fault: &str| {
        let mut command = specula(folder.path());
        finish(command.args(["info", "a.glb", "--json"]).env("SPECULA_FAULT", fault)).expect(0, &[]).json()
    };
    let (compressed, plain) = (told(""), told("plain-textures:1"));
    let form = |told: &serde_json::Value| told["model"]["forms"][0].as_str().unwrap().to_owned();
    assert_eq!([form(&compressed), form(&plain)], ["BC7", "RGBA8"]);
    let bytes = |told: &serde_json::Value| told["model"]["memory_bytes"].as_u64().unwrap();
    assert_eq!(bytes(&plain) - bytes(&compressed), 1365 * 4 - 87 * 16);
}
