//! The way of a model to the device: what arrives there, and what stays behind on the CPU.

use std::sync::Arc;

use crate::support::{SIZE, glb, load, render, renderer, settings};
use specula::interface::{TEXTURE_BASE_COLOR, TEXTURE_EMISSIVE, TEXTURE_METALLIC_ROUGHNESS, TEXTURE_OCCLUSION, Vertex};
use specula::scene::{Image, Model, Primitive, Sampler, Texture, TextureUse};

/// All levels of a square image of this side are more than half of the staging buffer.
const SIDE: u32 = 2048;

/// A square whose material reads one image of a single color in each of these slots.
fn textured(slots: &[(u32, [u8; 4])]) -> Model {
    let mut model = load(&glb::model(&glb::quad(1.0), &glb::gray()));
    for (index, &(slot, color)) in slots.iter().enumerate() {
        let rgba8 = color.repeat((SIDE * SIDE) as usize);
        Arc::make_mut(&mut model.images).push(Image::rgba8(format!("image {index}"), SIDE, SIDE, rgba8));
        Arc::make_mut(&mut model.textures).push(Texture { image: index, sampler: Sampler::default() });
        let used = TextureUse { texture: index, uv_set: 0, uv_from_mesh: glam::Affine2::IDENTITY };
        Arc::make_mut(&mut model.materials)[1].textures[slot as usize] = Some(used);
    }
    model
}

#[test]
fn a_model_larger_than_the_staging_buffer_arrives_whole_and_its_pixels_leave_the_cpu() {
    let mut model = textured(&[
        (TEXTURE_BASE_COLOR, [255, 0, 0, 255]),
        (TEXTURE_EMISSIVE, [0, 255, 0, 255]),
        (TEXTURE_METALLIC_ROUGHNESS, [9, 204, 102, 255]),
        (TEXTURE_OCCLUSION, [51, 9, 9, 255]),
    ]);
    let material = &mut Arc::make_mut(&mut model.materials)[1];
    material.numbers.base_color_factor = [1.0; 4];
    material.numbers.emissive_factor = [1.0; 3];
    (material.numbers.metallic_factor, material.numbers.roughness_factor) = (1.0, 1.0);
    // 34 MB of vertices and as many of indices, which nothing draws, lie before those of the square.
    let square = model.primitives[0].clone();
    let vertices = vec![Vertex::default(); (34 << 20) / size_of::<Vertex>()];
    Arc::make_mut(&mut model.primitives).insert(0, Primitive { vertices, indices: vec![0; (34 << 20) / 4], ..square });
    model.instances[0].primitive = 1;

    let unlit = ["environment.name=none", "view.msaa=1"];
    let mut headless = renderer(model, settings(&unlit), SIZE);
    for (mode, expected) in [
        ("base-color", [1.0, 0.0, 0.0]),
        ("emissive", [0.0, 1.0, 0.0]),
        ("roughness", [0.8; 3]),
        ("metallic", [0.4; 3]),
        ("occlusion", [0.2; 3]),
    ] {
        let capture = render(&mut headless, mode);
        let found = capture.raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{mode}: {found:?}, not {expected:?}");
    }
    let model = headless.model();
    assert!(model.images.iter().all(|image| image.texels.is_empty() && image.width == SIDE));
    assert_eq!(model.primitives[1].vertices.len(), 4, "picking reads the vertices");
}
