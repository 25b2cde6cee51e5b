//! The memory of a file is limited in all, whichever of its parts claim it.

use std::time::Instant;

use super::compression::{draco, meshopt, plane};
use super::*;
use crate::scene::gltf::file::buffers::Files;
use crate::scene::gltf::file::opened::Place;
use crate::scene::gltf::guarded;
use crate::scene::gltf::memory::BASE;

/// Loads a file that may take `left` bytes.
fn load_within(left: u64, glb: &[u8]) -> Result<Model, Problem> {
    let mut tried = Vec::new();
    let files = Files::new((Place::Nowhere, 0), false, &|| false, &mut tried);
    files.memory.take(Some(BASE - left), "test").unwrap();
    guarded("small", glb, files, (None, None), Instant::now())
}

fn png(color: image::ExtendedColorType, bytes: usize) -> Vec<u8> {
    let mut out = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut out);
    image::ImageEncoder::write_image(encoder, &vec![7; 64 * 64 * bytes], 64, 64, color).unwrap();
    out
}

fn with_image(bytes: &[u8]) -> Builder {
    let mut builder = Builder::square();
    builder.image("baseColorTexture", bytes);
    builder
}

fn instanced() -> Builder {
    let mut builder = Builder::triangle();
    let at = builder.push("accessors", json!({ "componentType": F32, "type": "VEC3", "count": 100 }));
    builder.json["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": at } } });
    builder
}

/// A mesh of 8 primitives in 64 nodes.
fn repeated() -> Builder {
    let mut builder = Builder::triangle();
    let primitive = builder.primitive().clone();
    builder.json["meshes"][0]["primitives"] = vec![primitive; 8].into();
    builder.json["nodes"] = vec![json!({ "mesh": 0 }); 64].into();
    builder.json["scenes"][0]["nodes"] = (0..64).collect::<Vec<_>>().into();
    builder
}

#[test]
fn each_kind_of_part_takes_of_one_memory() {
    let cases = [
        ("vertices", Builder::triangle()),
        ("gray", with_image(&png(image::ExtendedColorType::L8, 1))),
        ("16 bits", with_image(&png(image::ExtendedColorType::Rgb16, 6))),
        ("draco", draco(&plane(9))),
        ("meshopt", meshopt("EXT_meshopt_compression", &plane(9))),
        ("instances", instanced()),
        ("nodes", repeated()),
    ];
    for (name, builder) in cases {
        let glb = builder.glb();
        let clean = |left: u64| load_within(left, &glb).is_ok_and(|model| model.warnings.is_empty());
        let enough = (4..22).map(|power| 1 << power).find(|left| clean(*left)).expect(name);
        assert!(enough > 16, "{name} takes nothing");
        // With less, the parts that do not fit are left out and the reason is told, or nothing is left to show.
        for left in [enough / 2, enough / 4, 0] {
            let told = match load_within(left, &glb) {
                Ok(model) => model.warnings.join("\n"),
                Err(problem) => problem.reason(),
            };
            let is_told =
                told.contains("MiB in all when decoded") || told.contains("more than there are for so small a file");
            assert!(is_told, "{name} with {left} of {enough} bytes: {told}");
        }
    }
}

#[test]
fn an_image_takes_what_it_is_kept_as() {
    // 64 x 64 gray pixels are 4 KiB in the file, and 16 KiB as RGBA.
    let glb = with_image(&png(image::ExtendedColorType::L8, 1)).glb();
    let without = Builder::square().glb();
    let least = |glb: &[u8]| {
        let clean = |left: &u64| load_within(*left, glb).is_ok_and(|model| model.warnings.is_empty());
        (0..32 << 10).step_by(64).find(clean).unwrap()
    };
    let difference = least(&glb) - least(&without);
    assert!((16 << 10..(16 << 10) + 128).contains(&difference), "{difference}");
}

#[test]
fn a_file_that_is_named_again_takes_its_size_again() {
    let folder = tempfile::tempdir().unwrap();
    let size = 24 << 20;
    std::fs::File::create(folder.path().join("a.bin")).unwrap().set_len(size).unwrap();
    let mut tried = Vec::new();
    let mut files = Files::new((Place::Folder(folder.path().to_owned()), 0), false, &|| false, &mut tried);
    files.load("a.bin", "buffers[0]").unwrap();
    // The first time it counts as stored: 256 times its size are free, beside those of any file.
    let times = (BASE + 256 * size) / size - 1;
    assert_eq!(files.memory.take_most(times + 5, size), times);
    let error = files.load("a.bin", "buffers[1]").unwrap_err();
    assert!(
        error.reason().contains("buffers[1]: expected a file whose parts take at most 7168 MiB"),
        "{}",
        error.reason()
    );
}
