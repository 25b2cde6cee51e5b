//! Compressed files hold the same model as plain ones.

use std::collections::HashSet;

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder, PointAttribute,
    PointIndex,
};
use meshoptimizer_rs::{Workspace, codec};

use super::super::file::buffers::{Buffers, Files};
use super::super::file::container;
use super::super::file::opened::Place;
use super::super::geometry::accessor::Reader;
use super::super::left_out::LeftOut;
use super::super::{instancing, nodes};
use super::*;

/// A plane of `side` x `side` quads, that is not flat.
pub(super) fn plane(side: usize) -> (Vec<f32>, Vec<u32>) {
    let row = side + 1;
    let position = |at: usize| [(at % row) as f32, (at / row) as f32, ((at * 7) % 5) as f32];
    let corner = |quad: usize| (quad / side * row + quad % side) as u32;
    let row = row as u32;
    let quads = (0..side * side).map(corner);
    let indices = quads.flat_map(|c| [c, c + 1, c + row, c + 1, c + row + 1, c + row]).collect();
    ((0..(side + 1) * (side + 1)).flat_map(position).collect(), indices)
}

fn plain((positions, indices): &(Vec<f32>, Vec<u32>)) -> Builder {
    let mut builder = Builder::positions(positions);
    builder.indices(U32, indices);
    builder
}

/// Replaces the data of a buffer view by a compressed stream in another view's range.
fn compress(builder: &mut Builder, extension: &str, view: usize, stream: &[u8], fields: Value) {
    let at = builder.view(stream);
    let range = builder.json["bufferViews"][at].clone();
    builder.json["bufferViews"].as_array_mut().unwrap().pop();
    let mut object = json!({ "buffer": 0, "byteOffset": range["byteOffset"], "byteLength": range["byteLength"] });
    object.as_object_mut().unwrap().extend(fields.as_object().unwrap().clone());
    let plain = builder.json["bufferViews"][view].clone();
    let length = plain["byteLength"].clone();
    builder.json["bufferViews"][view] =
        json!({ "buffer": 1, "byteLength": length, "extensions": { extension: object } });
    builder.json["buffers"][1] = json!({ "byteLength": length });
    builder.json["extensionsRequired"] = json!([extension]);
    builder.json["extensionsUsed"] = json!([extension]);
}

/// A plane whose positions and indices are compressed by meshopt.
pub(super) fn meshopt(extension: &str, shape: &(Vec<f32>, Vec<u32>)) -> Builder {
    let (positions, indices) = shape;
    let mut workspace = Workspace::default();
    let mut builder = plain(shape);
    builder.push("buffers", json!({ "byteLength": 0 }));
    let vertices = codec::encode_vertex_buffer(
        bytemuck::cast_slice(positions),
        positions.len() / 3,
        12,
        codec::VertexEncoding::DEFAULT,
        &mut workspace,
    )
    .unwrap();
    let fields = json!({ "byteStride": 12, "count": positions.len() / 3, "mode": "ATTRIBUTES" });
    compress(&mut builder, extension, 0, &vertices, fields);
    let triangles = codec::encode_index_buffer(indices, codec::IndexEncoding::DEFAULT, &mut workspace).unwrap();
    let fields = json!({ "byteStride": 4, "count": indices.len(), "mode": "TRIANGLES" });
    compress(&mut builder, extension, 1, &triangles, fields);
    builder
}

/// The corners of all triangles, in a form that no order of vertices changes.
fn corners(model: &Model) -> Vec<[[u32; 3]; 3]> {
    let primitive = &model.primitives[0];
    let corner = |&index: &u32| primitive.vertices[index as usize].position.map(f32::to_bits);
    let mut all: Vec<[[u32; 3]; 3]> = primitive
        .indices
        .chunks_exact(3)
        .map(|triangle| {
            let mut corners: [_; 3] = std::array::from_fn(|c| corner(&triangle[c]));
            let first = (0..3).min_by_key(|&c| corners[c]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

#[test]
fn meshopt_gives_the_plain_model() {
    let shape = plane(9);
    let expected = corners(&plain(&shape).model());
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        assert_eq!(corners(&meshopt(extension, &shape).model()), expected, "{extension}");
    }
}

#[test]
fn a_damaged_stream_costs_its_meshes_unless_there_is_a_fallback() {
    let extension = "EXT_meshopt_compression";
    let mut builder = meshopt(extension, &plane(3));
    builder.json["bufferViews"][0]["extensions"][extension]["byteLength"] = json!(20);
    let error = builder.error();
    assert!(error.contains("bufferViews[0].extensions.EXT_meshopt_compression: expected a valid stream"), "{error}");
    // With data of its own and an extension that is only used.
    let mut builder = meshopt(extension, &plane(3));
    let original = plain(&plane(3));
    for view in 0..2 {
        let at = builder.view(
            &original.bin[original.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize..]
                [..original.json["bufferViews"][view]["byteLength"].as_u64().unwrap() as usize],
        );
        let range = builder.json["bufferViews"][at].clone();
        let plain = &mut builder.json["bufferViews"][view];
        (plain["buffer"], plain["byteOffset"]) = (json!(0), range["byteOffset"].clone());
        plain["extensions"][extension]["byteLength"] = json!(20);
    }
    builder.json.as_object_mut().unwrap().remove("extensionsRequired");
    let model = builder.model();
    assert_eq!(corners(&model), corners(&original.model()));
    assert_eq!(model.warnings.iter().filter(|w| w.contains("the uncompressed data is used")).count(), 2);
}

#[test]
fn streams_that_claim_too_much_are_refused_at_once() {
    let extension = "EXT_meshopt_compression";
    let mut builder = meshopt(extension, &plane(3));
    for count in [1_u64 << 31, u64::MAX / 2] {
        builder.json["bufferViews"][0]["extensions"][extension]["count"] = json!(count);
        let error = builder.error();
        assert!(error.contains("at most 1024 MiB in all when decoded"), "{error}");
    }
}

/// A triangle strip of one triangle whose accessors have no data: it is in a Draco stream.
pub(super) fn draco(shape: &(Vec<f32>, Vec<u32>)) -> Builder {
    let (positions, indices) = shape;
    let mut position = PointAttribute::new();
    position.init(GeometryAttributeType::Position, 3, DataType::Float32, false, positions.len() / 3);
    position.buffer_mut().update_f32s_le(0, positions);
    let mut mesh = Mesh::new();
    mesh.set_num_points(positions.len() / 3);
    let id = mesh.add_attribute(position);
    mesh.set_num_faces(indices.len() / 3);
    for (face, corners) in indices.chunks_exact(3).enumerate() {
        mesh.set_face(FaceIndex(face as u32), [0, 1, 2].map(|c| PointIndex(corners[c])));
    }
    let id = mesh.attribute(id).unique_id();
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut stream = EncoderBuffer::new();
    encoder.encode(&EncoderOptions::new(), &mut stream).unwrap();
    let mut builder = plain(shape);
    for accessor in 0..2 {
        builder.json["accessors"][accessor].as_object_mut().unwrap().remove("bufferView");
    }
    let view = builder.view(stream.data());
    let object = json!({ "bufferView": view, "attributes": { "POSITION": id } });
    builder.primitive()["extensions"] = json!({ "KHR_draco_mesh_compression": object });
    builder.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    builder.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    builder
}

#[test]
fn draco_gives_the_plain_model() {
    let shape = plane(9);
    assert_eq!(corners(&draco(&shape).model()), corners(&plain(&shape).model()));
}

#[test]
fn a_damaged_draco_stream_names_its_primitive() {
    let mut builder = draco(&plane(3));
    let view = builder.json["bufferViews"].as_array().unwrap().len() - 1;
    builder.json["bufferViews"][view]["byteLength"] = json!(12);
    let error = builder.error();
    assert!(error.contains("primitives[0].extensions.KHR_draco_mesh_compression: expected a valid stream"), "{error}");
    let mut builder = draco(&plane(3));
    builder.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = json!(77);
    assert!(builder.error().contains("an attribute 77 in the stream (POSITION)"));
}

#[test]
fn damaged_streams_cause_no_panic() {
    let shape = plane(3);
    let files = [meshopt("KHR_meshopt_compression", &shape).glb(), draco(&shape).glb()];
    crate::damaged::each(400, &[&files[0], &files[1]], damaged::load_or_refuse);
}

#[test]
fn instances_of_a_node() {
    let mut builder = Builder::triangle();
    let translations: [f32; 6] = [1.0, 0.0, 0.0, 0.0, 2.0, 0.0];
    let scales: [f32; 6] = [1.0, 1.0, 1.0, 3.0, 3.0, 3.0];
    let translation = builder.accessor("VEC3", F32, 2, bytemuck::cast_slice(&translations));
    let scale = builder.accessor("VEC3", F32, 2, bytemuck::cast_slice(&scales));
    let attributes = json!({ "TRANSLATION": translation, "SCALE": scale });
    builder.json["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    builder.json["nodes"][0]["translation"] = json!([0.0, 0.0, 5.0]);
    builder.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let model = builder.model();
    let at = |instance: usize| model.instances[instance].world_from_object.transform_point3(glam::Vec3::X);
    assert_eq!(model.instances.len(), 2);
    assert_eq!([at(0), at(1)], [glam::vec3(2.0, 0.0, 5.0), glam::vec3(3.0, 2.0, 5.0)]);
    builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json!({});
    assert_eq!(builder.model().instances.len(), 1);
    let told = builder.told();
    assert!(
        told.contains("expected TRANSLATION, ROTATION or SCALE, found none of them; the extension is left"),
        "{told}"
    );
}

#[test]
fn instances_are_limited_by_their_memory_alone() {
    let with = |count: usize| {
        let mut builder = Builder::triangle();
        let twin = builder.primitive().clone();
        builder.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(twin);
        let at = builder.push("accessors", json!({ "componentType": F32, "type": "VEC3", "count": count }));
        builder.json["nodes"][0]["extensions"] =
            json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": at } } });
        builder
    };
    let model = with(40_000).model();
    assert_eq!((model.instances.len(), model.warnings.len()), (80_000, 0), "{:?}", model.warnings);
    // More are only expanded here, since a model of a million draws takes seconds.
    let count = 1 << 19;
    let glb = with(count).glb();
    let document = container::parse(&glb).unwrap();
    let (mut tried, mut left_out, mut warnings) = (Vec::new(), LeftOut::default(), Vec::new());
    let mut files = Files::new((Place::Nowhere, 0), false, &|| false, &mut tried);
    let buffers = Buffers::load(&document.root, document.bin, &mut files, &mut left_out).unwrap();
    let reader = Reader { root: &document.root, buffers: &buffers, memory: &files.memory };
    let scene = nodes::walk(&document.root, None, &HashSet::new()).unwrap();
    let placed = instancing::expand(reader, scene.meshes, &mut left_out, &mut warnings).unwrap();
    // Two primitives of 1 KiB each, beside the accessor.
    let shown = ((1 << 30) - 12 * count) / 2048;
    assert_eq!((placed.len(), left_out.warnings().count()), (shown, 0));
    let expected = format!("MiB more than there are for so small a file; {} of them are left out.", count - shown);
    assert!(warnings.len() == 1 && warnings[0].contains(&expected), "{warnings:?}");
}

#[test]
fn a_hidden_node_is_not_shown_nor_those_below_it() {
    let mut builder = Builder::triangle();
    builder.push("nodes", json!({ "children": [2], "extensions": { "KHR_node_visibility": { "visible": false } } }));
    builder.push("nodes", json!({ "mesh": 0 }));
    builder.json["scenes"][0]["nodes"] = json!([0, 1]);
    let model = builder.model();
    assert_eq!(model.instances.len(), 1);
    assert!(model.warnings[0].contains("KHR_node_visibility hides 1 nodes"), "{:?}", model.warnings);
}
