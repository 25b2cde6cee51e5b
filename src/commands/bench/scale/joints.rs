//! `bench scale`: how the time of a frame grows with the number of joints that move a mesh.

use serde_json::{Value, json};
use specula::headless::Headless;
use specula::scene::{Model, load_bytes};

use super::steps::{Growth, Times, frames};
use crate::commands::Failure;
use crate::commands::bench::context::Bench;

/// Numbers of joints.
const JOINTS: [usize; 4] = [10, 100, 1_000, 10_000];
/// Types of components in glTF.
const FLOAT: u32 = 5126;
const U16: u32 = 5123;
const U32: u32 = 5125;

/// Times the frames of an animation that moves each joint of a skin.
pub(super) fn joints(bench: &Bench<'_>, headless: &mut Headless) -> Result<Vec<Value>, Failure> {
    let (mut found, mut growth) = (Vec::new(), Growth::default());
    for (index, joints) in JOINTS.into_iter().enumerate() {
        bench.progress.begin("step", (index, JOINTS.len()), &format!("{joints} joints"));
        headless.set_model(skinned(joints)?)?;
        let Times { cpu, device } = frames(bench, headless, Headless::draw_next)?;
        let growth = growth.to(cpu["min"].as_f64());
        found.push(json!({ "joints": joints, "cpu_ms": cpu, "device_ms": device, "growth": growth }));
    }
    Ok(found)
}

/// A file in the making: accessors over one buffer.
#[derive(Default)]
struct File {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    /// Adds an accessor. Returns its index.
    fn add(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len() }));
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = self.views.len() - 1;
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        view
    }

    fn floats(&mut self, kind: &str, values: &[f32], components: usize) -> usize {
        self.add(kind, FLOAT, values.len() / components, bytemuck::cast_slice(values))
    }
}

/// A row of triangles, each on a joint of its own that an animation moves.
fn skinned(joints: usize) -> Result<Model, Failure> {
    let mut file = File::default();
    let width = 1.0 / joints as f32;
    let triangle = |joint: usize| {
        let x = joint as f32 * width;
        [[x, 0.0, 0.0], [x + width, 0.0, 0.0], [x, 0.5, 0.0]]
    };
    let corners: Vec<[f32; 3]> = (0..joints).flat_map(triangle).collect();
    let position = file.floats("VEC3", corners.as_flattened(), 3);
    file.accessors[position]["min"] = json!([0.0, 0.0, 0.0]);
    file.accessors[position]["max"] = json!([1.0, 0.5, 0.0]);
    let of_corners: Vec<[u16; 4]> = (0..3 * joints).map(|corner| [(corner / 3) as u16, 0, 0, 0]).collect();
    let joint = file.add("VEC4", U16, 3 * joints, bytemuck::cast_slice(&of_corners));
    let weight = file.floats("VEC4", [1.0_f32, 0.0, 0.0, 0.0].repeat(3 * joints).as_slice(), 4);
    let indices: Vec<u32> = (0..3 * joints as u32).collect();
    let indices = file.add("SCALAR", U32, indices.len(), bytemuck::cast_slice(&indices));
    let times = file.floats("SCALAR", &[0.0, 1.0, 2.0], 1);
    (file.accessors[times]["min"], file.accessors[times]["max"]) = (json!([0.0]), json!([2.0]));
    let moved = file.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.0], 3);

    // Node 0 has the mesh; the joints follow.
    let numbers: Vec<usize> = (1..=joints).collect();
    let nodes: Vec<Value> =
        std::iter::once(json!({ "mesh": 0, "skin": 0 })).chain(numbers.iter().map(|_| json!({}))).collect();
    let channel = |node: &usize| json!({ "sampler": 0, "target": { "node": node, "path": "translation" } });
    let attributes = json!({ "POSITION": position, "JOINTS_0": joint, "WEIGHTS_0": weight });
    let document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": (0..=joints).collect::<Vec<_>>() }],
        "nodes": nodes,
        "skins": [{ "joints": numbers }],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": indices }] }],
        "animations": [{
            "samplers": [{ "input": times, "output": moved }],
            "channels": numbers.iter().map(channel).collect::<Vec<_>>(),
        }],
        "buffers": [{ "byteLength": file.bin.len() }],
        "bufferViews": file.views,
        "accessors": file.accessors,
    });
    let model = load_bytes("joints", &container(&document, &file.bin));
    model.map_err(|error| Failure::Input(format!("the model of {joints} joints: {error}")))
}

/// A GLB of a document and its buffer.
fn container(document: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + bin.len();
    let word = |number: usize| (number as u32).to_le_bytes();
    [b"glTF".as_slice(), &word(2), &word(length), &word(json.len()), b"JSON", &json, &word(bin.len()), b"BIN\0", bin]
        .concat()
}
