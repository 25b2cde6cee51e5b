//! Makes cargo rebuild when a file in `shaders/` or `assets/`, which the program embeds, is added or changed. Hashes what makes a module
//! of GLSL, so that the cache of modules on disk never outlives it.

#![allow(clippy::print_stdout, reason = "cargo reads it")]

use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher};
use std::path::Path;

/// The sources that compile stages, and the versions of all libraries.
const COMPILER: [&str; 2] = ["src/shader", "Cargo.lock"];

fn main() {
    for path in ["shaders", "assets"].into_iter().chain(COMPILER) {
        println!("cargo:rerun-if-changed={path}");
    }
    let mut hasher = DefaultHasher::new();
    COMPILER.iter().for_each(|path| hash(Path::new(path), &mut hasher));
    println!("cargo:rustc-env=SPECULA_COMPILER={:016x}", hasher.finish());
}

/// Hashes a file, or all files of a folder.
fn hash(path: &Path, hasher: &mut impl Hasher) {
    match fs::read_dir(path) {
        Ok(entries) => {
            let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
            paths.sort();
            paths.iter().for_each(|path| hash(path, hasher));
        }
        Err(_) => fs::read(path).unwrap_or_default().hash(hasher),
    }
}
