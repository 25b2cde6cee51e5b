//! glTF binaries made in code.

use serde_json::{Value, json};

/// Triangles with normals.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit; empty for a mesh without.
    pub normals: Vec<[f32; 3]>,
    /// Three a triangle, counterclockwise from the front.
    pub indices: Vec<u32>,
}

/// A square in the plane z = 0 that faces +Z.
pub fn quad(half: f32) -> Mesh {
    Mesh {
        positions: vec![[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// A unit sphere around the origin. Normals equal positions, so that interpolated and normalized they still do.
pub fn sphere(rings: u32, sectors: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        let polar = std::f32::consts::PI * ring as f32 / rings as f32;
        for sector in 0..=sectors {
            let azimuth = std::f32::consts::TAU * sector as f32 / sectors as f32;
            let position = [polar.sin() * azimuth.sin(), polar.cos(), polar.sin() * azimuth.cos()];
            mesh.positions.push(position);
        }
    }
    mesh.normals.clone_from(&mesh.positions);
    for ring in 0..rings {
        for sector in 0..sectors {
            let a = ring * (sectors + 1) + sector;
            let b = a + sectors + 1;
            mesh.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
        }
    }
    mesh
}

/// A GLB container around any JSON.
pub fn container(json: &Value, bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let chunks = [(b"JSON", padded(json.to_string().as_bytes(), b' ')), (b"BIN\0", padded(bin, 0))];
    let mut out = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, bytes) in chunks {
        out.extend((bytes.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(bytes);
    }
    let length = (out.len() as u32).to_le_bytes();
    out[8..12].copy_from_slice(&length);
    out
}

/// The JSON and the buffer of a GLB.
pub fn parts(bytes: &[u8]) -> (Value, Vec<u8>) {
    let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let json = &bytes[20..20 + length(12)];
    (serde_json::from_slice(json).unwrap(), bytes[20 + length(12) + 8..].to_vec())
}

/// The document of one mesh, one material and one node, and its buffer; tests bend it before they pack it.
pub fn document(mesh: &Mesh, material: &Value) -> (Value, Vec<u8>) {
    let mut bin = Vec::new();
    let mut views = Vec::new();
    let mut accessors = Vec::new();
    let mut attributes = json!({});
    let floats = |values: &[[f32; 3]]| values.iter().flatten().flat_map(|f| f.to_le_bytes()).collect::<Vec<u8>>();
    for (name, values) in [("POSITION", &mesh.positions), ("NORMAL", &mesh.normals)] {
        if values.is_empty() {
            continue;
        }
        let bytes = floats(values);
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }));
        bin.extend(bytes);
        attributes[name] = json!(accessors.len());
        let bound = |pick: fn(f32, f32) -> f32| {
            let mut bound = values[0];
            values.iter().for_each(|v| (0..3).for_each(|i| bound[i] = pick(bound[i], v[i])));
            bound
        };
        accessors.push(json!({ "bufferView": accessors.len(), "componentType": 5126, "count": values.len(),
            "type": "VEC3", "min": bound(f32::min), "max": bound(f32::max) }));
    }
    views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": mesh.indices.len() * 4, "target": 34963 }));
    bin.extend(mesh.indices.iter().flat_map(|i| i.to_le_bytes()));
    let indices = accessors.len();
    accessors
        .push(json!({ "bufferView": indices, "componentType": 5125, "count": mesh.indices.len(), "type": "SCALAR" }));
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": bin.len() }],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": indices, "material": 0 }] }],
        "materials": [material],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "scene": 0,
    });
    (json, bin)
}

/// An axis-aligned box with flat normals. `outwards`: faces and normals point away from its center.
pub fn cuboid(min: [f32; 3], max: [f32; 3], outwards: bool) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, sign) in [(min, -1.0), (max, 1.0)] {
            let first = mesh.positions.len() as u32;
            for (at_u, at_v) in [(min[u], min[v]), (max[u], min[v]), (max[u], max[v]), (min[u], max[v])] {
                let mut corner = side;
                (corner[u], corner[v]) = (at_u, at_v);
                mesh.positions.push(corner);
                let mut normal = [0.0; 3];
                normal[axis] = if outwards { sign } else { -sign };
                mesh.normals.push(normal);
            }
            let corners = if outwards == (sign > 0.0) { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            mesh.indices.extend(corners.map(|corner| first + corner));
        }
    }
    mesh
}

/// A model of several meshes, each with a material of its own.
pub fn scene(parts: &[(Mesh, Value)]) -> Vec<u8> {
    let mut all = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] });
    let mut bin: Vec<u8> = Vec::new();
    let lists = ["bufferViews", "accessors", "meshes", "materials", "nodes"];
    lists.iter().for_each(|list| all[*list] = json!([]));
    for (index, (mesh, material)) in parts.iter().enumerate() {
        let (mut json, own) = document(mesh, material);
        let first = all["accessors"].as_array().unwrap().len();
        let moved = |number: &mut Value, by: usize| *number = json!(number.as_u64().unwrap() as usize + by);
        for view in json["bufferViews"].as_array_mut().unwrap() {
            let offset = view["byteOffset"].as_u64().unwrap() as usize;
            view["byteOffset"] = json!(offset + bin.len());
        }
        json["accessors"].as_array_mut().unwrap().iter_mut().for_each(|a| moved(&mut a["bufferView"], first));
        let primitive = &mut json["meshes"][0]["primitives"][0];
        moved(&mut primitive["indices"], first);
        moved(&mut primitive["material"], index);
        primitive["attributes"].as_object_mut().unwrap().values_mut().for_each(|accessor| moved(accessor, first));
        json["nodes"][0]["mesh"] = json!(index);
        for list in lists {
            let own = json[list].as_array().unwrap().clone();
            all[list].as_array_mut().unwrap().extend(own);
        }
        all["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
        bin.extend(own);
    }
    all["buffers"] = json!([{ "byteLength": bin.len() }]);
    container(&all, &bin)
}

/// A model of one mesh and one material.
pub fn model(mesh: &Mesh, material: &Value) -> Vec<u8> {
    let (json, bin) = document(mesh, material);
    container(&json, &bin)
}

/// The same with a light: a KHR_lights_punctual light on a node with this placement.
pub fn model_with_light(mesh: &Mesh, material: &Value, light: &Value, node: &Value) -> Vec<u8> {
    model_with_lights(mesh, material, light, node, 1)
}

/// The same with `count` such lights at one place.
pub fn model_with_lights(mesh: &Mesh, material: &Value, light: &Value, node: &Value, count: usize) -> Vec<u8> {
    let (mut json, bin) = document(mesh, material);
    json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    let mut node = node.clone();
    node["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
    let mut nodes = vec![json!({ "mesh": 0 })];
    nodes.resize(1 + count, node);
    json["nodes"] = json!(nodes);
    json["scenes"] = json!([{ "nodes": (0..=count).collect::<Vec<_>>() }]);
    container(&json, &bin)
}

/// Adds floats to a document. Returns the index of their accessor.
pub fn accessor(json: &mut Value, bin: &mut Vec<u8>, kind: &str, values: &[f32]) -> usize {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let views = json["bufferViews"].as_array_mut().unwrap();
    let view = views.len();
    views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }));
    bin.extend(&bytes);
    json["buffers"][0]["byteLength"] = json!(bin.len());
    let width = if kind == "SCALAR" { 1 } else { usize::from(kind.as_bytes()[3] - b'0') };
    let all = json["accessors"].as_array_mut().unwrap();
    all.push(json!({ "bufferView": view, "componentType": 5126, "count": values.len() / width, "type": kind }));
    all.len() - 1
}

/// A gray square of 1 m that goes from 1 m left of the origin to 1 m right of it in a second (clip `go`), or is 1 m up (clip `jump`).
pub fn moving_quad() -> Vec<u8> {
    let (mut json, mut bin) = document(&quad(0.5), &gray());
    let times = accessor(&mut json, &mut bin, "SCALAR", &[0.0, 1.0]);
    let right = accessor(&mut json, &mut bin, "VEC3", &[-1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let up = accessor(&mut json, &mut bin, "VEC3", &[0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let clip = |name: &str, output: usize| {
        json!({ "name": name, "samplers": [{ "input": times, "output": output }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }] })
    };
    json["animations"] = json!([clip("go", right), clip("jump", up)]);
    container(&json, &bin)
}

/// A gray dielectric.
pub fn gray() -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0,
        "roughnessFactor": 0.5 } })
}
