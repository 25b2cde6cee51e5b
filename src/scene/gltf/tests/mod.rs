//! Tests of the loader on small files built in code.

mod compression;
mod curves;
mod damaged;
mod extensions;
mod features;
mod geometry;
mod growth;
mod image_based;
mod invalid;
mod left_out;
mod materials;
mod memory;
mod motion;
mod nodes;
mod opened;
mod placeholders;
mod pointers;
mod together;
mod visibility;

use serde_json::{Value, json};

use super::super::error::{LoadError, Problem};
use super::super::model::Model;
use super::super::{Caller, LoadOptions, load, load_bytes, open, open_for};

/// componentType numbers of the specification.
const I8: u32 = 5120;
const U8: u32 = 5121;
const I16: u32 = 5122;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// A builder of glTF files. Change `json` freely: indexing an object creates its keys.
#[derive(Clone)]
struct Builder {
    json: Value,
    bin: Vec<u8>,
}

impl Builder {
    /// One node with one mesh with one triangle in the XY plane, facing +Z.
    fn triangle() -> Self {
        Self::positions(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    }

    /// A square of two triangles in the XY plane, facing +Z, with texture coordinates as an upright picture has them.
    fn square() -> Self {
        let mut builder = Self::positions(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
        builder.attribute_f32("NORMAL", "VEC3", &[0.0, 0.0, 1.0].repeat(4));
        builder.attribute_f32("TEXCOORD_0", "VEC2", &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        builder.indices(U8, &[0, 1, 2, 0, 2, 3]);
        builder
    }

    fn positions(positions: &[f32]) -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "meshes": [{ "name": "m", "primitives": [{ "attributes": {} }] }],
            "accessors": [], "bufferViews": [], "buffers": [{ "byteLength": 0 }],
        });
        let mut builder = Self { json, bin: Vec::new() };
        builder.attribute_f32("POSITION", "VEC3", positions);
        builder
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }))
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    fn attribute_f32(&mut self, name: &str, kind: &str, values: &[f32]) -> usize {
        let width = if kind == "SCALAR" { 1 } else { usize::from(kind.as_bytes()[3] - b'0') };
        let accessor = self.accessor(kind, F32, values.len() / width, bytemuck::cast_slice(values));
        self.primitive()["attributes"][name] = json!(accessor);
        accessor
    }

    fn indices(&mut self, component: u32, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = match component {
            U8 => indices.iter().map(|&i| i as u8).collect(),
            U16 => indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect(),
            _ => indices.iter().flat_map(|&i| i.to_le_bytes()).collect(),
        };
        let accessor = self.accessor("SCALAR", component, indices.len(), &bytes);
        self.primitive()["indices"] = json!(accessor);
        accessor
    }

    /// Adds an image, a texture of it and a material that has it as `slot`; gives the material to the mesh.
    fn image(&mut self, slot: &str, bytes: &[u8]) {
        let view = self.view(bytes);
        let image = self.push("images", json!({ "bufferView": view }));
        let texture = self.push("textures", json!({ "source": image }));
        let info = json!({ "index": texture });
        let material = match slot {
            "baseColorTexture" | "metallicRoughnessTexture" => json!({ "pbrMetallicRoughness": { slot: info } }),
            _ => json!({ slot: info }),
        };
        let material = self.push("materials", material);
        self.primitive()["material"] = json!(material);
    }

    fn glb(&self) -> Vec<u8> {
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let mut out = b"glTF".to_vec();
        let word = |out: &mut Vec<u8>, value: usize| out.extend_from_slice(&(value as u32).to_le_bytes());
        word(&mut out, 2);
        word(&mut out, 12 + 8 + text.len() + 8 + bin.len());
        word(&mut out, text.len());
        out.extend_from_slice(b"JSON");
        out.extend_from_slice(&text);
        word(&mut out, bin.len());
        out.extend_from_slice(b"BIN\0");
        out.extend_from_slice(&bin);
        out
    }

    fn load(&self) -> Result<Model, LoadError> {
        load_bytes("test", &self.glb())
    }

    #[track_caller]
    fn model(&self) -> Model {
        let model = self.load().unwrap_or_else(|error| panic!("{error}"));
        assert_sound(&model);
        model
    }

    /// The warnings of a file that loads without some part of it.
    #[track_caller]
    fn told(&self) -> String {
        let warnings = self.model().warnings;
        assert!(!warnings.is_empty(), "no warning");
        warnings.join("\n")
    }

    /// The message of a file that must not load.
    #[track_caller]
    fn error(&self) -> String {
        let error = self.load().expect_err("an error");
        assert!(!matches!(*error.problem, Problem::Refused { .. }), "{error}");
        error.to_string()
    }
}

/// The invariants of `Model`, on which drawing relies.
#[track_caller]
fn assert_sound(model: &Model) {
    for primitive in model.primitives.iter() {
        assert!(primitive.material < model.materials.len());
        assert!(primitive.indices.iter().all(|&index| (index as usize) < primitive.vertices.len()));
        for vertex in &primitive.vertices {
            let normal = glam::Vec3::from(vertex.normal);
            let tangent = glam::Vec4::from(vertex.tangent);
            assert!(normal.is_normalized(), "{vertex:?}");
            assert!(tangent.truncate().is_normalized() && tangent.w.abs() == 1.0, "{vertex:?}");
        }
    }
    for material in model.materials.iter() {
        assert!(material.textures.iter().flatten().all(|used| used.texture < model.textures.len()));
    }
    assert!(model.textures.iter().all(|texture| texture.image < model.images.len()));
    assert!(model.images.iter().all(|image| !image.texels.is_empty() && image.bytes() > 0));
    assert!(model.instances.iter().all(|instance| instance.primitive < model.primitives.len()));
}
