//! Fuzz targets: functions that read arbitrary bytes as the files that users open. They panic where the program would have a bug, so
//! also at a panic that the loader has caught. `tests/fuzz` runs them with libFuzzer; unit tests beside each reader give it damaged files.
//!
//! Only builds with `--cfg fuzzing`, which cargo-fuzz sets, and unit tests have this module.

use std::path::Path;

use serde_json::{Value, json};

use crate::scene::{EnvironmentFile, LoadError, LoadOptions, MeasuredBrdf, Model, Problem, load, load_bytes};
use crate::shader::source::snapshot::Snapshot;
use crate::shader::{Source, annotation};

/// A `.gltf` or `.glb` file.
pub fn gltf(data: &[u8]) {
    accept(load_bytes("fuzz", data));
}

/// A model whose accessors, sparse ones among them, have numbers of the first bytes. The others are its buffer.
pub fn accessors(data: &[u8]) {
    let Some((numbers, buffer)) = data.split_first_chunk::<24>() else { return };
    let word = |at: usize| u16::from_le_bytes([numbers[2 * at], numbers[2 * at + 1]]);
    let component = |at: usize| 5120 + word(at) % 8;
    let kind = |at: usize| ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"][usize::from(word(at) % 5)];
    let sparse = json!({
        "count": word(4) % 64,
        "indices": { "bufferView": word(5) % 3, "byteOffset": word(6), "componentType": 5121 + word(7) % 5 },
        "values": { "bufferView": word(8) % 3, "byteOffset": word(9) },
    });
    let mut json = triangle(buffer.len());
    json["bufferViews"] = json!([
        { "buffer": 0, "byteLength": buffer.len() },
        { "buffer": 0, "byteOffset": word(0), "byteLength": word(1), "byteStride": 4 + word(2) % 252 },
        { "buffer": 0, "byteOffset": word(2), "byteLength": buffer.len().saturating_sub(usize::from(word(2))) },
    ]);
    json["accessors"] = json!([
        { "bufferView": word(10) % 3, "byteOffset": word(3), "componentType": 5126, "count": word(11) % 99, "type": "VEC3", "sparse": sparse },
        { "componentType": component(3), "count": word(11) % 99, "type": kind(9), "sparse": sparse, "normalized": word(3) % 2 == 0 },
        { "bufferView": word(8) % 3, "componentType": component(6), "count": 3 * (word(4) % 9), "type": "SCALAR", "sparse": sparse },
    ]);
    json["meshes"][0]["primitives"][0] =
        json!({ "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 1 }, "indices": 2 });
    accept(load_bytes("fuzz", &glb(&json, buffer)));
}

/// A stream of Draco.
pub fn draco(data: &[u8]) {
    let mut json = triangle(data.len());
    json["bufferViews"] = json!([{ "buffer": 0, "byteLength": data.len() }]);
    json["accessors"] = json!([
        { "componentType": 5126, "count": 9, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1] },
        { "componentType": 5125, "count": 24, "type": "SCALAR" },
    ]);
    let draco = json!({ "bufferView": 0, "attributes": { "POSITION": 0, "NORMAL": 1 } });
    json["meshes"][0]["primitives"][0] = json!({
        "attributes": { "POSITION": 0 }, "indices": 1, "extensions": { "KHR_draco_mesh_compression": draco },
    });
    json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    accept(load_bytes("fuzz", &glb(&json, data)));
}

/// A stream of meshopt. The first bytes choose mode, filter, stride and count.
pub fn meshopt(data: &[u8]) {
    let Some(([mode, filter, stride, count], stream)) = data.split_first_chunk() else { return };
    let mode = ["ATTRIBUTES", "TRIANGLES", "INDICES"][usize::from(mode % 3)];
    let filter = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"][usize::from(filter % 5)];
    let (stride, count) = (4 * (1 + u32::from(stride % 64)), u32::from(*count));
    let packed = json!({
        "buffer": 0, "byteLength": stream.len(), "byteStride": stride, "count": count,
        "mode": mode,
        "filter": filter,
    });
    let mut json = triangle(stream.len());
    json["buffers"].as_array_mut().into_iter().for_each(|all| all.push(json!({ "byteLength": stride * count })));
    json["bufferViews"] = json!([{
        "buffer": 1, "byteLength": stride * count, "byteStride": stride,
        "extensions": { "EXT_meshopt_compression": packed },
    }]);
    json["accessors"] = json!([{ "bufferView": 0, "componentType": 5126, "count": count.max(1), "type": "VEC3" }]);
    json["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": 0 } });
    json["extensionsUsed"] = json!(["EXT_meshopt_compression"]);
    accept(load_bytes("fuzz", &glb(&json, stream)));
}

/// An image of any format: PNG, JPEG, WebP, KTX2.
pub fn image(data: &[u8]) {
    let mut json = triangle(data.len());
    json["bufferViews"] = json!([{ "buffer": 0, "byteLength": data.len() }]);
    json["accessors"] =
        json!([{ "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1] }]);
    json["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": 0 }, "material": 0 });
    json["images"] = json!([{ "bufferView": 0, "mimeType": "image/png" }]);
    json["textures"] = json!([{ "source": 0 }]);
    json["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    for image in accept(load_bytes("fuzz", &glb(&json, data))).iter().flat_map(|model| model.images.iter()) {
        let mut out = vec![0; image.bytes() as usize];
        image.write(true, &mut out);
    }
}

/// A zip archive.
pub fn archive(data: &[u8]) {
    as_file("zip", data, |path| drop(accept(load(path, &LoadOptions::default()))));
}

/// An environment: Radiance HDR or OpenEXR.
pub fn environment(data: &[u8]) {
    as_file("hdr", data, |path| {
        let decoded = EnvironmentFile::open(&path.to_string_lossy()).and_then(|file| file.decode());
        let told = decoded.map_or_else(|error| error.to_string(), |_| String::new());
        assert!(!told.contains("decoder panicked"), "{told}");
    });
}

/// A measured BRDF. Only two lengths are read further, so that of UTIA is made of any.
pub fn measured(data: &[u8]) {
    as_file("binary", data, |path| drop(MeasuredBrdf::open(path)));
    let mut utia = data.to_vec();
    utia.resize(crate::scene::MeasuredKind::Utia.file_bytes(), data.first().copied().unwrap_or(0));
    as_file("bin", &utia, |path| drop(MeasuredBrdf::open(path)));
}

/// The annotations of a shader.
pub fn annotations(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let source = Source::memory([("passes/a.frag", &*text)]);
    drop(annotation::read(&Snapshot::new(&source), &["passes/a.frag".into()], &[], false));
}

/// A lookup table of colors, `.cube`.
pub fn cube(data: &[u8]) {
    drop(crate::pipeline::decode_table(data));
}

/// Fails at an error that stands for a caught panic.
fn accept(loaded: Result<Model, LoadError>) -> Option<Model> {
    match loaded {
        Ok(model) => Some(model),
        Err(LoadError { problem, .. }) => {
            assert!(!matches!(*problem, Problem::Refused { .. }), "{problem}");
            None
        }
    }
}

/// A scene of one node and one mesh, whose parts a target fills in.
fn triangle(bytes: usize) -> Value {
    json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": bytes }],
        "meshes": [{ "primitives": [{}] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "scene": 0,
    })
}

fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let padded = bin.len().next_multiple_of(4);
    let length = 12 + 8 + text.len() + 8 + padded;
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((length as u32).to_le_bytes());
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(text);
    out.extend((padded as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(bin);
    out.resize(length, 0);
    out
}

/// Gives bytes to a reader as a file that is there until it returns.
fn as_file(extension: &str, data: &[u8], read: impl FnOnce(&Path)) {
    let thread = std::thread::current().id();
    let path = std::env::temp_dir().join(format!("specula-fuzz-{}-{thread:?}.{extension}", std::process::id()));
    if std::fs::write(&path, data).is_ok() {
        read(&path);
        let _ = std::fs::remove_file(&path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::damaged;

    /// Files of all other targets are damaged beside their readers.
    #[test]
    fn damaged_accessors_and_images_cause_no_panic() {
        let words: [u16; 12] = [0, 96, 12, 0, 2, 0, 0, 0, 2, 16, 0, 3];
        let mut sparse: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        sparse.extend((0..400_u32).map(|byte| (byte % 3) as u8));
        damaged::each(300, &[&sparse], accessors);
        let uastc = include_bytes!("../tests/textures/uastc.ktx2");
        let etc1s = include_bytes!("../tests/textures/etc1s.ktx2");
        damaged::each(300, &[uastc, etc1s], image);
        damaged::each(100, &[&[&[0, 0, 2, 9][..], &[0xa0; 80]].concat()], meshopt);
    }

    #[test]
    fn every_target_takes_its_files_and_nothing() {
        let targets: [fn(&[u8]); 10] =
            [gltf, accessors, draco, meshopt, image, archive, environment, measured, annotations, cube];
        for target in targets {
            target(&[]);
            target(b"glTF\x02\0\0\0 and what is not glTF, in some more bytes than a header has");
        }
        // A stream that decodes: the target reaches the decoder.
        image(include_bytes!("../tests/textures/uastc.ktx2"));
    }
}
