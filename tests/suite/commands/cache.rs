//! Compiled stages on disk: a start takes them, and no picture is ever that of another text.

use std::fs;

use crate::support::Tree;
use crate::support::process::{Finished, finish, specula};

const QUICK: [&str; 8] = ["render", "sphere-grid", "--env", "none", "--size", "64x48", "--lights", "orbit"];

/// A tree and the cache of the processes that render it.
struct Cached {
    tree: Tree,
}

impl Cached {
    /// `user_radiance` multiplies by a factor, of a file that is included around two corners.
    fn new() -> Self {
        let tree = Tree::new();
        let text = tree.edited("user.glsl", "return radiance;", "return radiance * factor();");
        let (version, rest) = text.split_at(text.find("#include").unwrap());
        tree.write("user.glsl", &format!("{version}#include \"more/a.glsl\"\n{rest}"));
        fs::create_dir(tree.path("more")).unwrap();
        tree.write("more/a.glsl", "#include \"b.glsl\"\n");
        tree.write("b.glsl", "float factor() { return 0.5; }\n");
        Self { tree }
    }

    /// Renders with the cache `name`. Returns the picture and what the program said.
    fn render(&self, name: &str) -> (Vec<u8>, Finished) {
        let mut command = specula(&self.tree.beside(""));
        command.env("SPECULA_CACHE", self.tree.beside(name));
        let finished = finish(command.args(QUICK).args(["--validate", "--out", "out.exr"]));
        finished.expect(0, &[]);
        (fs::read(self.tree.beside("out.exr")).unwrap(), finished)
    }

    /// Renders with the cache, and fails unless the picture is the one without.
    #[track_caller]
    fn picture(&self, what: &str) -> Vec<u8> {
        let (picture, _) = self.render("cache");
        let fresh = self.tree.beside("fresh");
        let _ = fs::remove_dir_all(&fresh);
        assert!(picture == self.render("fresh").0, "{what}: the picture is that of another text");
        picture
    }

    /// The files of compiled stages.
    fn entries(&self) -> Vec<std::path::PathBuf> {
        let entries = fs::read_dir(self.tree.beside("cache").join("stages")).unwrap();
        entries.map(|entry| entry.unwrap().path()).collect()
    }
}

#[test]
fn compiled_stages_outlive_the_process_and_never_the_text() {
    let cached = Cached::new();
    let first = cached.picture("the first start");
    let count = cached.entries().len();
    // A stage has a list of paths and a module, which begins with SPIR-V's magic number.
    let is_module = |path: &std::path::PathBuf| fs::read(path).unwrap().starts_with(&0x0723_0203u32.to_le_bytes());
    let modules = cached.entries().iter().filter(|path| is_module(path)).count();
    assert!(modules > 0 && count == 2 * modules, "{modules} modules in {count} entries");
    assert!(cached.picture("the second start") == first);
    assert_eq!(cached.entries().len(), count, "a second start compiled again");

    cached.tree.write("b.glsl", "float factor() { return 0.25; }\n");
    let edited = cached.picture("an edit of an included file");
    assert!(edited != first);
    cached.tree.write("more/b.glsl", "float factor() { return 0.125; }\n");
    let nearer = cached.picture("a file where one was looked for first");
    assert!(nearer != edited);
    fs::remove_file(cached.tree.path("more/b.glsl")).unwrap();
    assert!(cached.picture("that file is gone") == edited);
    cached.tree.write("b.glsl", "float factor() { return 0.5; }\n");
    assert!(cached.picture("the first text") == first);
}

#[test]
fn damaged_stages_are_compiled_again() {
    let cached = Cached::new();
    let first = cached.picture("the first start");
    for path in cached.entries() {
        let mut bytes = fs::read(&path).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 4;
        fs::write(&path, bytes).unwrap();
    }
    assert!(cached.picture("flipped bits") == first);
    cached.entries().iter().for_each(|path| fs::write(path, b"").unwrap());
    assert!(cached.picture("empty files") == first);
}

#[test]
fn every_start_tells_the_warnings() {
    let cached = Cached::new();
    let text = cached.tree.read("b.glsl");
    cached.tree.write("b.glsl", &format!("#extension GL_ARB_no_such_thing : enable\n{text}"));
    for start in ["first", "second"] {
        let (_, told) = cached.render("cache");
        assert!(told.stderr.contains("GL_ARB_no_such_thing"), "the {start} start: {told:#?}");
    }
}
