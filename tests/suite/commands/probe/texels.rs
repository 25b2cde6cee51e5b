//! The texels of a material's textures at a pixel.

use std::io::Cursor;

use image::{ImageFormat, Rgba, RgbaImage};
use serde_json::{Value, json};

use crate::support::glb;

const COLORS: [[u8; 4]; 4] = [[255, 0, 0, 255], [0, 255, 0, 128], [0, 0, 255, 255], [188, 64, 32, 255]];

/// A square with an image of two by two texels of these colors. The left edge has `u` = 0, the upper edge `v` = 0.
fn square(transform: Option<Value>, sampler: &Value) -> Vec<u8> {
    let (mut json, mut bin) = glb::document(&glb::quad(1.0), &glb::gray());
    let image = RgbaImage::from_fn(2, 2, |x, y| Rgba(COLORS[(y * 2 + x) as usize]));
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).unwrap();
    let mut add = |bytes: &[u8]| {
        bin.resize(bin.len().next_multiple_of(4), 0);
        let views = json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }));
        bin.extend(bytes);
        views.len() - 1
    };
    let uv = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let uv_view = add(&uv.iter().flatten().flat_map(|f| f.to_le_bytes()).collect::<Vec<_>>());
    let image_view = add(png.get_ref());
    let accessors = json["accessors"].as_array_mut().unwrap();
    accessors.push(json!({ "bufferView": uv_view, "componentType": 5126, "count": 4, "type": "VEC2" }));
    let accessor = accessors.len() - 1;
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(accessor);
    json["images"] = json!([{ "bufferView": image_view, "mimeType": "image/png", "name": "four colors" }]);
    json["samplers"] = json!([sampler]);
    json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    let mut used = json!({ "index": 0 });
    if let Some(transform) = transform {
        json["extensionsUsed"] = json!(["KHR_texture_transform"]);
        used["extensions"] = json!({ "KHR_texture_transform": transform });
    }
    let material = &mut json["materials"][0];
    material["pbrMetallicRoughness"]["baseColorTexture"] = used;
    material["emissiveTexture"] = json!({ "index": 0 });
    material["normalTexture"] = json!({ "index": 0 });
    json["buffers"][0]["byteLength"] = json!(bin.len());
    glb::container(&json, &bin)
}

/// Probes a pixel of the square, which fills the picture, in front of the camera.
fn probe(model: &[u8], at: &str) -> Value {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("square.glb"), model).unwrap();
    let args =
        ["square.glb", "--at", at, "--json", "--mode", "uv0", "--eye", "0,0,4", "--target", "0,0,0", "--fovy", "20"];
    super::probe(directory.path(), &args).expect(0, &[]).json()
}

#[test]
fn a_pixel_has_the_texel_of_each_texture() {
    let model = square(None, &json!({}));
    // 96x64 pixels; the picture is 1.41 meters high.
    for (at, texel) in [("40,20", [0, 0]), ("56,20", [1, 0]), ("40,44", [0, 1]), ("56,44", [1, 1])] {
        let found = probe(&model, at);
        let textures = found["textures"].as_array().unwrap();
        let slots: Vec<&str> = textures.iter().map(|texture| texture["texture"].as_str().unwrap()).collect();
        assert_eq!(slots, ["base color", "normal", "emissive"], "{found}");
        let color = COLORS[texel[1] * 2 + texel[0]];
        for texture in textures {
            assert_eq!((&texture["texel"], &texture["size"]), (&json!(texel), &json!([2, 2])), "{at} {texture}");
            assert_eq!((&texture["stored"], &texture["image"]), (&json!(color), &json!("four colors")), "{texture}");
            let is_srgb = texture["texture"] != "normal";
            assert_eq!(texture["srgb"], is_srgb);
            for (linear, byte) in super::numbers(&texture["linear"]).iter().zip(color).take(3) {
                let encoded = f64::from(byte) / 255.0;
                let shown = if is_srgb { crate::support::srgb(*linear) } else { *linear };
                assert!((shown - encoded).abs() < 1e-4, "{texture}");
            }
            // What the shader has, interpolated by the device.
            let uv = super::numbers(&found["modes"]["uv0"]);
            let own = super::numbers(&texture["uv"]);
            assert!(own.iter().zip(&uv).all(|(own, uv)| (own - uv).abs() < 1e-3), "{uv:?} {texture}");
        }
    }
}

#[test]
fn transform_and_wrap_move_the_texel() {
    // u + 1.5 repeats as u + 0.5; v + 1 is mirrored to 1 - v.
    let transform = json!({ "offset": [1.5, 1.0] });
    let model = square(Some(transform), &json!({ "wrapS": 10497, "wrapT": 33648 }));
    let found = probe(&model, "40,20");
    let [base, normal] = [0, 1].map(|at| found["textures"][at].clone());
    assert_eq!((&base["texel"], &base["stored"]), (&json!([1, 1]), &json!(COLORS[3])), "{base}");
    assert_eq!((&normal["texel"], &normal["stored"]), (&json!([0, 0]), &json!(COLORS[0])), "{normal}");
    let [uv, mesh] = ["uv", "mesh_uv"].map(|name| super::numbers(&base[name]));
    assert!((uv[0] - mesh[0] - 0.5).abs() < 1e-4 && (uv[1] + mesh[1] - 1.0).abs() < 1e-4, "{base}");
}
