//! Models in folders and zip archives.

use std::io::{Cursor, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;
use crate::damaged;

fn zip(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// The text of a model that keeps its buffer in a file.
fn text(builder: &Builder, uri: &str) -> Vec<u8> {
    let mut json = builder.json.clone();
    json["buffers"][0]["uri"] = json!(uri);
    json.to_string().into_bytes()
}

#[track_caller]
fn error_of(path: &Path) -> String {
    let error = load(path, &LoadOptions::default()).expect_err("an error");
    assert!(!matches!(*error.problem, Problem::Refused { .. }), "{error}");
    error.to_string()
}

#[test]
fn an_archive_opens_as_the_model_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, files: &[(&str, &[u8])]| {
        let path = folder.path().join(name);
        std::fs::write(&path, zip(files)).unwrap();
        path
    };
    let square = Builder::square();
    let plain = square.model();
    let nested = [("pack/gltf/a.gltf", &*text(&square, "../data/a%20b.bin")), ("pack/data/a b.bin", &square.bin)];
    let (glb, mac) = (square.glb(), [("__MACOSX/._a.glb", &b"x"[..]), (".hidden.glb", b"x")]);
    for path in [write("nested.zip", &nested), write("ONE.ZIP", &[&[("a.glb", &*glb)], &mac[..]].concat())] {
        let model = load(&path, &LoadOptions::default()).unwrap();
        assert_sound(&model);
        assert_eq!(model.primitives[0].vertices, plain.primitives[0].vertices);
        assert_eq!(&*model.name, path.file_stem().unwrap().to_str().unwrap());
        assert_eq!(*model.files, [path], "the archive is watched");
    }
    let two = write("two.zip", &[("x/b.glb", &glb), ("x/a.glb", &glb), ("x/y/c.glb", &glb)]);
    let told = error_of(&two);
    assert!(told.contains("has 2 models") && told.contains("two.zip/x/a.glb, ") && told.contains("x/b.glb."), "{told}");
    for inner in ["x/b.glb", "x/y/c.glb", "x/../x/a.glb"] {
        assert!(load(&two.join(inner), &LoadOptions::default()).is_ok(), "{inner}");
    }
    assert!(error_of(&two.join("x/d.glb")).contains("x/d.glb"));
    assert!(error_of(&write("none.zip", &[("notes.txt", b"x")])).contains("no .gltf or .glb"));
}

#[test]
fn paths_do_not_leave_an_archive() {
    let folder = tempfile::tempdir().unwrap();
    let (square, path) = (Builder::square(), folder.path().join("a.zip"));
    std::fs::write(folder.path().join("out.bin"), &square.bin).unwrap();
    for uri in ["../out.bin", "/etc/passwd", "x/../../out.bin", "..\\out.bin"] {
        std::fs::write(&path, zip(&[("a.gltf", &text(&square, uri)), ("../out.bin", &square.bin)])).unwrap();
        let told = error_of(&path);
        assert!(told.contains("leaves the archive") || told.contains("cannot be read"), "{uri}: {told}");
    }
}

#[test]
fn archives_that_fill_the_memory_and_damaged_ones_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.zip");
    let mut bomb = ZipWriter::new(Cursor::new(Vec::new()));
    bomb.start_file("a.glb", SimpleFileOptions::default()).unwrap();
    let zeros = vec![0; 1 << 20];
    (0..300).for_each(|_| bomb.write_all(&zeros).unwrap());
    std::fs::write(&path, bomb.finish().unwrap().into_inner()).unwrap();
    let start = Instant::now();
    let told = error_of(&path);
    assert!(told.contains("unpacks from") && start.elapsed() < Duration::from_secs(1), "{told}");
    let square = Builder::square();
    let whole = zip(&[("a.gltf", &text(&square, "a.bin")), ("a.bin", &square.bin)]);
    damaged::each(300, &[&whole], |bytes| {
        std::fs::write(&path, bytes).unwrap();
        if let Err(error) = load(&path, &LoadOptions::default()) {
            assert!(!matches!(*error.problem, Problem::Refused { .. }), "{error}");
        }
    });
    std::fs::write(&path, b"no archive").unwrap();
    assert!(error_of(&path).contains("zip archive"));
}

#[test]
fn a_folder_opens_as_its_nearest_model() {
    let folder = tempfile::tempdir().unwrap();
    let (root, square) = (folder.path(), Builder::square());
    std::fs::create_dir_all(root.join("Duck/glTF/deeper")).unwrap();
    assert!(error_of(root).contains("no .gltf or .glb"));
    std::fs::write(root.join("Duck/glTF/deeper/b.glb"), square.glb()).unwrap();
    std::fs::write(root.join("Duck/glTF/a.gltf"), text(&square, "a.bin")).unwrap();
    std::fs::write(root.join("Duck/glTF/a.bin"), &square.bin).unwrap();
    let model = load(root, &LoadOptions::default()).unwrap();
    assert_eq!((&*model.name, &model.files[0]), ("a", &root.join("Duck/glTF/a.gltf")));
    std::fs::write(root.join("Duck/glTF/c.glb"), square.glb()).unwrap();
    assert!(error_of(root).contains("has 2 models"));
}
