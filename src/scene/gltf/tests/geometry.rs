//! Accessors, topologies, normals, tangents.

use super::super::super::model::Topology;
use super::*;
use crate::interface as contract;

fn positions(model: &Model) -> Vec<[f32; 3]> {
    model.primitives[0].vertices.iter().map(|vertex| vertex.position).collect()
}

#[test]
fn index_types() {
    for component in [U8, U16, U32] {
        let mut builder = Builder::square();
        builder.indices(component, &[2, 3, 0, 0, 1, 2]);
        let primitive = &builder.model().primitives[0];
        let drawn: Vec<_> =
            primitive.indices.iter().map(|&i| primitive.vertices[i as usize].position[..2].to_vec()).collect();
        assert_eq!(drawn, [[1., 1.], [0., 1.], [0., 0.], [0., 0.], [1., 0.], [1., 1.]], "{component}");
    }
}

#[test]
fn no_indices_draws_all_vertices() {
    let model = Builder::triangle().model();
    assert_eq!(model.primitives[0].indices, [0, 1, 2]);
    assert_eq!(model.bounds.max, glam::Vec3::new(1.0, 1.0, 0.0));
}

#[test]
fn sparse_accessor_replaces_elements() {
    let mut builder = Builder::triangle();
    let indices = builder.view(&1_u16.to_le_bytes());
    let values = builder.view(bytemuck::cast_slice(&[7.0_f32, 8.0, 9.0]));
    builder.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": indices, "componentType": U16 }, "values": { "bufferView": values }
    });
    assert_eq!(positions(&builder.model()), [[0., 0., 0.], [7., 8., 9.], [0., 1., 0.]]);
    // Without a buffer view the rest is zero.
    builder.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(positions(&builder.model()), [[0., 0., 0.], [7., 8., 9.], [0., 0., 0.]]);
}

#[test]
fn accessor_without_buffer_view_is_zeros() {
    let mut builder = Builder::square();
    let zeros = builder.push("accessors", json!({ "componentType": F32, "count": 4, "type": "VEC4" }));
    builder.primitive()["attributes"]["COLOR_0"] = json!(zeros);
    assert!(builder.model().primitives[0].vertices.iter().all(|vertex| vertex.color == [0.0; 4]));
}

#[test]
fn interleaved_with_a_stride() {
    let mut builder = Builder::triangle();
    // Position and normal in turn; the last element ends with the view.
    let data: Vec<f32> = (0..3).flat_map(|i| [i as f32, (i * i) as f32, 0.0, 0.0, 0.0, 2.0]).collect();
    let view = builder.view(bytemuck::cast_slice(&data));
    builder.json["bufferViews"][view]["byteStride"] = json!(24);
    for (name, offset) in [("POSITION", 0), ("NORMAL", 12)] {
        let accessor =
            json!({ "bufferView": view, "byteOffset": offset, "componentType": F32, "count": 3, "type": "VEC3" });
        let accessor = builder.push("accessors", accessor);
        builder.primitive()["attributes"][name] = json!(accessor);
    }
    let model = builder.model();
    assert_eq!(positions(&model), [[0., 0., 0.], [1., 1., 0.], [2., 4., 0.]]);
    assert_eq!(model.primitives[0].vertices[2].normal, [0.0, 0.0, 1.0]);
}

#[test]
fn quantized_positions_normals_and_tangents() {
    let mut builder = Builder::triangle();
    builder.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let shorts: Vec<u8> =
        [0_i16, 0, 0, 0, 32767, -32768, 0, 0, -2, 4, 8, 0].iter().flat_map(|s| s.to_le_bytes()).collect();
    let position = builder.accessor("VEC3", I16, 3, &shorts);
    let view = builder.json["accessors"][position]["bufferView"].as_u64().unwrap() as usize;
    builder.json["bufferViews"][view]["byteStride"] = json!(8);
    builder.primitive()["attributes"]["POSITION"] = json!(position);
    assert_eq!(positions(&builder.model())[1..], [[32767., -32768., 0.], [-2., 4., 8.]]);
    builder.json["accessors"][position]["normalized"] = json!(true);
    assert_eq!(positions(&builder.model())[1], [1.0, -1.0, 0.0]);

    for (name, kind) in [("NORMAL", "VEC3"), ("TANGENT", "VEC4")] {
        let bytes = if name == "NORMAL" { [0, 0, 127, 0].repeat(3) } else { [127, 0, 0, 129].repeat(3) };
        let accessor = builder.accessor(kind, I8, 3, &bytes);
        let view = builder.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
        builder.json["bufferViews"][view]["byteStride"] = json!(4);
        builder.json["accessors"][accessor]["normalized"] = json!(true);
        builder.primitive()["attributes"][name] = json!(accessor);
    }
    let vertex = builder.model().primitives[0].vertices[0];
    assert_eq!((vertex.normal, vertex.tangent), ([0., 0., 1.], [1., 0., 0., -1.]));
}

#[test]
fn normalized_texture_coordinates_and_colors() {
    let mut builder = Builder::square();
    let bytes = builder.accessor("VEC4", U8, 4, &[255, 0, 51, 255].repeat(4));
    let shorts: Vec<u8> = [65535_u16, 0].repeat(4).iter().flat_map(|s| s.to_le_bytes()).collect();
    let uvs = builder.accessor("VEC2", U16, 4, &shorts);
    for (name, accessor) in [("COLOR_0", bytes), ("TEXCOORD_1", uvs)] {
        builder.json["accessors"][accessor]["normalized"] = json!(true);
        builder.primitive()["attributes"][name] = json!(accessor);
    }
    let model = builder.model();
    let vertex = model.primitives[0].vertices[0];
    assert_eq!((vertex.color, vertex.uv1), ([1.0, 0.0, 0.2, 1.0], [1.0, 0.0]));
    let expected = contract::ATTRIBUTE_COLOR | contract::ATTRIBUTE_UV1 | contract::ATTRIBUTE_UV0;
    assert_eq!(model.primitives[0].attributes & expected, expected);
    // RGB colors get an alpha of 1; beyond 1 no color reflects.
    builder.attribute_f32("COLOR_0", "VEC3", &[0.5, 0.25, 2.0].repeat(4));
    assert_eq!(builder.model().primitives[0].vertices[0].color, [0.5, 0.25, 1.0, 1.0]);
}

#[test]
fn topologies() {
    let modes = [
        (0, Topology::Points, vec![0, 1, 2, 3]),
        (1, Topology::Lines, vec![0, 1, 2, 3]),
        (2, Topology::LineStrip, vec![0, 1, 2, 3, 0]),
        (3, Topology::LineStrip, vec![0, 1, 2, 3]),
        (5, Topology::TriangleStrip, vec![0, 1, 2, 3]),
        (6, Topology::TriangleFan, vec![0, 1, 2, 3]),
    ];
    for (mode, topology, indices) in modes {
        let mut builder = Builder::positions(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
        builder.attribute_f32("NORMAL", "VEC3", &[0.0, 0.0, 1.0].repeat(4));
        builder.primitive()["mode"] = json!(mode);
        let primitive = &builder.model().primitives[0];
        assert_eq!((primitive.topology, &primitive.indices), (topology, &indices));
        assert_eq!(primitive.attributes, contract::ATTRIBUTE_NORMAL);
    }
    let mut builder = Builder::square();
    builder.indices(U8, &[0, 1, 2, 0]);
    let model = builder.model();
    assert_eq!(model.primitives[0].indices.len(), 3);
    assert!(model.warnings[0].contains("incomplete"), "{:?}", model.warnings);
}

#[test]
fn missing_normals_are_flat() {
    // Two faces of a roof share an edge: four vertices become six. A file's tangents mean nothing without its normals.
    let mut builder = Builder::positions(&[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0]);
    builder.attribute_f32("TANGENT", "VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(4));
    builder.indices(U8, &[0, 1, 2, 0, 3, 1]);
    let model = builder.model();
    let primitive = &model.primitives[0];
    assert_eq!((primitive.vertices.len(), primitive.attributes), (6, 0));
    let normals: Vec<_> = primitive.indices.iter().map(|&i| primitive.vertices[i as usize].normal).collect();
    let half = 0.5_f32.sqrt();
    assert!(normals[..3].iter().all(|n| glam::Vec3::from(*n).distance(glam::Vec3::new(-half, half, 0.0)) < 1e-6));
    assert!(normals[3..].iter().all(|n| glam::Vec3::from(*n).distance(glam::Vec3::new(half, half, 0.0)) < 1e-6));
    // A strip in one plane turns into a list that still shares its vertices.
    let mut builder = Builder::positions(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    builder.primitive()["mode"] = json!(5);
    let primitive = &builder.model().primitives[0];
    assert_eq!((primitive.topology, primitive.vertices.len()), (Topology::Triangles, 4));
    assert!(primitive.vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
}

#[test]
fn broken_normals_take_those_of_their_faces() {
    let mut builder = Builder::square();
    builder.attribute_f32("NORMAL", "VEC3", &[0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 1.0]);
    let model = builder.model();
    assert!(model.primitives[0].vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
    assert!(model.warnings.len() == 1 && model.warnings[0].contains("2 normals"), "{:?}", model.warnings);
}

#[test]
fn tangents_follow_the_picture() {
    // glTF: the tangent points to the picture's right, the bitangent (normal x tangent * w) to its top.
    let model = Builder::square().model();
    let primitive = &model.primitives[0];
    assert!(primitive.vertices.iter().all(|vertex| vertex.tangent == [1.0, 0.0, 0.0, 1.0]), "{:?}", primitive.vertices);
    assert_eq!((primitive.vertices.len(), primitive.indices.len()), (4, 6));
    let frame = contract::ATTRIBUTE_TANGENT | contract::ATTRIBUTE_TANGENT_FRAME;
    assert_eq!(primitive.attributes & frame, contract::ATTRIBUTE_TANGENT_FRAME);
    // A mirrored picture.
    let mut builder = Builder::square();
    builder.attribute_f32("TEXCOORD_0", "VEC2", &[1.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    assert!(builder.model().primitives[0].vertices.iter().all(|vertex| vertex.tangent == [-1.0, 0.0, 0.0, -1.0]));
}

#[test]
fn tangents_use_the_set_of_the_normal_texture() {
    let mut builder = Builder::square();
    builder.image("normalTexture", &materials::png(2, 2));
    // The second set is turned by 90 degrees: u runs up.
    builder.attribute_f32("TEXCOORD_1", "VEC2", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
    assert_eq!(builder.model().primitives[0].vertices[0].tangent, [1.0, 0.0, 0.0, 1.0]);
    builder.json["materials"][0]["normalTexture"]["texCoord"] = json!(1);
    assert_eq!(builder.model().primitives[0].vertices[0].tangent, [0.0, 1.0, 0.0, 1.0]);
}

#[test]
fn tangents_are_never_zero_or_nan() {
    // Texture coordinates in one point.
    let mut degenerate = Builder::square();
    degenerate.attribute_f32("TEXCOORD_0", "VEC2", &[0.5; 8]);
    // Zero and NaN in the file.
    let mut broken = Builder::square();
    broken.attribute_f32("TANGENT", "VEC4", &[0.0, 0.0, 0.0, 1.0, f32::NAN, 0.0, 0.0, f32::NAN].repeat(2));
    // Faces without area, on texture coordinates that are not numbers.
    let mut flat = Builder::square();
    flat.attribute_f32("POSITION", "VEC3", &[1.0; 12]);
    flat.attribute_f32("TEXCOORD_0", "VEC2", &[f32::NAN, f32::INFINITY].repeat(4));
    for builder in [degenerate, broken, flat] {
        let model = builder.model();
        assert!(model.warnings.iter().any(|warning| warning.contains("of 4 tangents")), "{:?}", model.warnings);
    }
    // No texture coordinates: no frame, but still numbers.
    let model = Builder::triangle().model();
    assert_eq!(model.primitives[0].attributes & contract::ATTRIBUTE_TANGENT_FRAME, 0);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}
