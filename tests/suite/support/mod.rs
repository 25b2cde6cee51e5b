//! Shared by the tests: devices and a compiler, shader trees that can be edited, models
//! made in code, and the program as a child process.

pub mod browser;
mod device;
pub mod glb;
pub mod hdr;
pub mod process;
mod renderer;
mod root_window;
pub mod served;
pub mod video;
pub mod window;
pub mod xdnd;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use specula::headless::{Headless, HeadlessError};
use specula::pipeline::{Outcome, Reload};
use specula::render::Capture;
use specula::scene::{Model, built_in, load_bytes};
use specula::settings::{Settings, Tonemap};
use specula::shader::{Change, Compiler, Diagnostic, Library, Source, TreePath, check, embedded};
use tempfile::TempDir;

pub use device::gpu;
pub use renderer::{Renderer, render, renderer};

/// Large enough for every feature of the models, small enough for a software device.
pub const SIZE: (u32, u32) = (96, 64);

/// The compiler of all tests.
pub fn compiler() -> &'static Arc<Compiler> {
    static COMPILER: OnceLock<Arc<Compiler>> = OnceLock::new();
    COMPILER.get_or_init(|| Arc::new(Compiler::new().unwrap()))
}

/// Fails on the first message that the validation layers ever said about the device of this test.
pub fn assert_validated() {
    let messages = gpu().validation_messages();
    assert!(messages.is_empty(), "validation layers:\n{}", messages.join("\n"));
}

/// Whether this is a long run (`SPECULA_LONG=1`), by hand: more steps, graphs and rows than a run of all tests can have.
pub fn is_long() -> bool {
    std::env::var_os("SPECULA_LONG").is_some_and(|value| value == "1")
}

/// A shader tree of its own in a temporary folder.
pub struct Tree {
    directory: TempDir,
}

impl Tree {
    /// The tree that the program embeds.
    pub fn new() -> Self {
        let tree = Self { directory: tempfile::tempdir().unwrap() };
        embedded::write_to(&tree.root(), None).unwrap();
        tree
    }

    /// Its root; the folder above is the test's as well.
    pub fn root(&self) -> PathBuf {
        self.directory.path().join("shaders")
    }

    /// A file of it.
    pub fn path(&self, file: &str) -> PathBuf {
        self.root().join(file)
    }

    /// A place beside it.
    pub fn beside(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// The text of a file.
    pub fn read(&self, file: &str) -> String {
        fs::read_to_string(self.path(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    }

    /// Writes a file.
    pub fn write(&self, file: &str, text: &str) {
        fs::write(self.path(file), text).unwrap();
    }

    /// The text of a file with `from` replaced by `to`; `from` must be in it.
    pub fn edited(&self, file: &str, from: &str, to: &str) -> String {
        let text = self.read(file);
        assert!(text.contains(from), "{file} has no `{from}` to edit:\n{text}");
        text.replace(from, to)
    }
}

/// A renderer of a tree that a test edits. Every frame is checked by the validation layers.
pub struct Session {
    /// The tree.
    pub tree: Tree,
    /// The renderer.
    pub headless: Headless,
}

impl Session {
    /// Opens a fresh tree with a model.
    pub fn new(model: Model, settings: Settings) -> Self {
        let tree = Tree::new();
        let source = Source::disk(tree.root());
        let (headless, _) = Headless::new(gpu(), compiler(), source, model, settings, SIZE).unwrap_or_else(explain);
        Self { tree, headless }
    }

    /// Writes a file, as an editor would, and takes it in.
    pub fn save(&mut self, file: &str, text: &str) -> Reload {
        self.tree.write(file, text);
        self.changed(&[file])
    }

    /// Replaces text in a file and takes it in.
    pub fn edit(&mut self, file: &str, from: &str, to: &str) -> Reload {
        let text = self.tree.edited(file, from, to);
        self.save(file, &text)
    }

    /// Takes changed files in.
    pub fn changed(&mut self, files: &[&str]) -> Reload {
        let paths: BTreeSet<TreePath> = files.iter().map(|file| TreePath::from(*file)).collect();
        self.headless.update(Change::Paths(paths))
    }

    /// Deletes files and takes that in.
    pub fn delete(&mut self, files: &[&str]) -> Reload {
        files.iter().for_each(|file| fs::remove_file(self.tree.path(file)).unwrap());
        self.changed(files)
    }

    /// Saves each group of files. Fails unless each is refused with its message, keeps the picture `before`, and costs nothing once it
    /// is deleted again.
    #[track_caller]
    pub fn refuses(&mut self, before: &Capture, cases: &[(&[(&str, &str)], &str)]) {
        for (files, expected) in cases {
            files.iter().for_each(|(file, text)| self.tree.write(file, text));
            let names: Vec<&str> = files.iter().map(|(file, _)| *file).collect();
            let told = lines(failed(&self.changed(&names))).join("\n");
            assert!(told.contains(expected), "{told}\nis not\n{expected}");
            assert_same(before, &self.render(), expected);
            self.delete(&names);
            assert_same(before, &self.render(), "repaired");
        }
    }

    /// Saves a text whose `while` does not end. Fails unless the next frame is refused with the line of that loop. Saves `repaired` then,
    /// which must draw `drawn`.
    #[track_caller]
    pub fn ends_loop(&mut self, file: &str, (endless, repaired): (&str, &str), drawn: &Capture) {
        ready(&self.save(file, endless));
        let Err(HeadlessError::Shaders(told)) = self.headless.render().map(|_| ()) else {
            panic!("{file}: an endless loop is no error")
        };
        let told = lines(&told).join("\n");
        let expected = format!("{file}:{}: error: this loop did not end (", line_of(endless, "while"));
        assert!(told.contains(&expected), "{told}\nis not\n{expected}");
        ready(&self.save(file, repaired));
        assert_same(drawn, &self.render(), file);
    }

    /// A frame.
    pub fn render(&mut self) -> Capture {
        let capture = self.headless.render().unwrap_or_else(explain);
        assert_validated();
        capture
    }

    /// A frame of another mode.
    pub fn mode(&mut self, slug: &str) -> Capture {
        self.headless.settings_mut().mode = slug.to_owned();
        self.render()
    }

    /// Sets a setting, as `--set` does.
    pub fn set(&mut self, assignment: &str) {
        self.headless.settings_mut().assign(assignment).unwrap();
    }
}

fn explain<T>(error: HeadlessError) -> T {
    match error {
        HeadlessError::Shaders(diagnostics) => panic!("{}", lines(&diagnostics).join("\n")),
        other => panic!("{other}"),
    }
}

/// Settings from `--set` assignments, over the defaults with a fixed curve and exposure, since numbers of tests are those of these.
pub fn settings(assignments: &[&str]) -> Settings {
    let mut settings = Settings::default();
    (settings.view.tonemap, settings.view.ev) = (Tonemap::Aces, 0.0);
    assignments.iter().for_each(|assignment| settings.assign(assignment).unwrap());
    settings
}

/// A built-in model.
pub fn model(name: &str) -> Model {
    built_in(name).expect("a built-in model").unwrap()
}

/// A model from the bytes of a GLB.
pub fn load(bytes: &[u8]) -> Model {
    load_bytes("test", bytes).unwrap()
}

/// The diagnostics of a reload that must have failed.
#[track_caller]
pub fn failed(reload: &Reload) -> &[Diagnostic] {
    match &reload.outcome {
        Outcome::Failed(diagnostics) => diagnostics,
        Outcome::Ready(_) => panic!("the reload went well; stages {:?}", stages(reload)),
        Outcome::Unchanged { cleared } => panic!("the reload changed nothing (cleared: {cleared})"),
    }
}

/// Fails when a reload brought no new pipelines.
#[track_caller]
pub fn ready(reload: &Reload) {
    match &reload.outcome {
        Outcome::Ready(_) => {}
        Outcome::Failed(diagnostics) => panic!("{}", lines(diagnostics).join("\n")),
        Outcome::Unchanged { cleared } => panic!("the reload changed nothing (cleared: {cleared})"),
    }
}

/// The compiled stages, sorted.
pub fn stages(reload: &Reload) -> Vec<&str> {
    let mut stages: Vec<&str> = reload.report.stages.iter().map(|(stage, _)| stage.as_str()).collect();
    stages.sort_unstable();
    stages
}

/// Fails unless `specula check` would pass.
pub fn passes_check(session: &Session) {
    let source = Source::disk(session.tree.root());
    let mut library = Library::new(source, compiler().clone(), &specula::frame::stages::stages());
    let found = check::check(&mut library);
    assert!(found.is_empty(), "{}", lines(&found).join("\n"));
}

/// Diagnostics as editors read them.
pub fn lines(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().map(Diagnostic::one_line).collect()
}

/// The 1-based line of the first occurrence of `what`.
pub fn line_of(text: &str, what: &str) -> u32 {
    let at = text.lines().position(|line| line.contains(what)).unwrap_or_else(|| panic!("no `{what}`"));
    u32::try_from(at).unwrap() + 1
}

/// How many pixels of two pictures differ.
pub fn differing(a: &Capture, b: &Capture) -> usize {
    assert_eq!((a.width, a.height), (b.width, b.height));
    a.rgba8.chunks_exact(4).zip(b.rgba8.chunks_exact(4)).filter(|(a, b)| a != b).count()
}

/// Fails unless two pictures are the same, bit for bit.
#[track_caller]
pub fn assert_same(a: &Capture, b: &Capture, why: &str) {
    assert_eq!(differing(a, b), 0, "{why}: so many pixels differ");
    assert!(a.raw.iter().flatten().map(|x| x.to_bits()).eq(b.raw.iter().flatten().map(|x| x.to_bits())), "{why}");
}

/// Fails unless the pictures differ in more pixels than a stray one.
#[track_caller]
pub fn assert_differ(a: &Capture, b: &Capture, why: &str) {
    let count = differing(a, b);
    assert!(count > 20, "{why}: only {count} pixels differ");
}

/// sRGB's transfer function (IEC 61966-2-1), independent of the shader's.
pub fn srgb(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// A decoded PNG or EXR.
pub fn open_image(path: &Path) -> image::DynamicImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The text of README.md and of shaders/README.md.
pub fn readmes() -> String {
    let page = |path| std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    [page("README.md"), page("shaders/README.md")].concat()
}
