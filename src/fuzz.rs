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
    use std::collections::BTreeSet;
    use std::io::{Cursor, Write as _};

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;
    use crate::damaged;

    /// A target under its name in `tests/fuzz`, how many damaged files it gets in each run, and the whole files.
    type Target = (&'static str, fn(&[u8]), usize, Vec<Vec<u8>>);

    const MODEL: &[u8] = include_bytes!("../assets/variants.glb");

    fn targets() -> [Target; 10] {
        let words: [u16; 12] = [0, 96, 12, 0, 2, 0, 0, 0, 2, 16, 0, 3];
        let mut sparse: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        sparse.extend((0..400_u32).map(|byte| (byte % 3) as u8));
        let draco = [&b"DRACO\x02\x02\x01\x01\0\0"[..], &[3; 60]].concat();
        let images =
            [&include_bytes!("../tests/textures/uastc.ktx2")[..], include_bytes!("../tests/textures/etc1s.ktx2")];
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        archive.start_file("a.glb", SimpleFileOptions::default()).unwrap();
        archive.write_all(MODEL).unwrap();
        let hdr = [&b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n"[..], &[9, 8, 7, 129].repeat(32)].concat();
        let shader = "//@pass a to=picture\n//@texture noise \"noise.png\" repeat\nuniform sampler2D noise;\n\
            const uint A = 1u; //@mode a \"A\"\nvoid main() {}\n";
        let table = "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
        [
            ("gltf", gltf, 60, vec![MODEL.to_vec()]),
            ("accessors", accessors, 300, vec![sparse]),
            ("draco", super::draco, 200, vec![draco]),
            ("meshopt", meshopt, 100, vec![[&[0, 0, 2, 9][..], &[0xa0; 80]].concat()]),
            ("image", image, 300, images.map(<[u8]>::to_vec).to_vec()),
            ("archive", super::archive, 60, vec![archive.finish().unwrap().into_inner()]),
            ("environment", environment, 100, vec![hdr]),
            ("measured", measured, 3, vec![vec![1; 64]]),
            ("annotations", annotations, 100, vec![shader.into()]),
            ("cube", cube, 100, vec![table.into()]),
        ]
    }

    /// The files in the folder of a target below `SPECULA_SEEDS`, in the order of their names.
    fn seeds(target: &str) -> Vec<Vec<u8>> {
        let Some(folder) = std::env::var_os("SPECULA_SEEDS") else { return Vec::new() };
        let files = std::fs::read_dir(Path::new(&folder).join(target)).into_iter().flatten();
        let paths: BTreeSet<_> = files.map(|file| file.unwrap().path()).collect();
        paths.iter().map(|path| std::fs::read(path).unwrap()).collect()
    }

    /// As libFuzzer would, but without looking for new paths. More files are damaged beside their readers.
    #[test]
    #[expect(clippy::print_stdout, reason = "long runs are watched")]
    fn damaged_files_cause_no_panic_in_any_target() {
        for (name, target, few, mut files) in targets() {
            let start = std::time::Instant::now();
            files.extend(seeds(name));
            let files: Vec<&[u8]> = files.iter().map(Vec::as_slice).collect();
            files.iter().for_each(|file| target(file));
            let count = damaged::each(few, &files, target);
            println!("{name}: {count} damaged of {} files in {:.1} s", files.len(), start.elapsed().as_secs_f64());
        }
    }

    #[test]
    fn every_target_takes_nothing_and_what_is_no_file() {
        for (_, target, ..) in targets() {
            target(&[]);
            target(b"glTF\x02\0\0\0 and what is not glTF, in some more bytes than a header has");
        }
    }

    /// The package has a target for each function of this file, and a program for each target.
    #[test]
    fn the_package_of_libfuzzer_has_these_targets() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz");
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let names: BTreeSet<String> = targets().iter().map(|(name, ..)| (*name).to_owned()).collect();
        for name in &names {
            let text = std::fs::read_to_string(folder.join(format!("targets/{name}.rs"))).unwrap();
            assert!(text.contains(&format!("fuzz_target!(|data: &[u8]| specula::fuzz::{name}(data))")), "{text}");
            assert!(manifest.contains(&format!("name = \"{name}\"\npath = \"targets/{name}.rs\"")), "{name}");
        }
        let files = std::fs::read_dir(folder.join("targets")).unwrap();
        let files = files.map(|file| file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned());
        assert_eq!(files.collect::<BTreeSet<String>>(), names);
        let functions = include_str!("fuzz.rs").split("mod tests").next().unwrap();
        assert_eq!(functions.matches("\npub fn ").count(), names.len());
    }
}
