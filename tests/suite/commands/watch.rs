//! `render --watch` as a child process: every way of saving updates the picture, and no error loses it.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::Instant;

use crate::support::process::{PATIENCE, Running, specula};
use crate::support::{Tree, glb, hdr, line_of, srgb};
use notify::{RecursiveMode, Watcher as _};

const USER: &str = "user.glsl";
const MODEL: &str = "model/quad.glb";

/// `specula render --watch` on its own tree, with a square that fills the picture.
struct Watched {
    tree: Tree,
    running: Running,
    original: String,
    pictures: Receiver<()>,
    _watcher: notify::RecommendedWatcher,
}

impl Watched {
    fn new() -> Self {
        Self::with(|_, command| {
            command.args(["--env", "none"]);
        })
    }

    /// `prepare` may add files beside the tree, and options.
    fn with(prepare: impl FnOnce(&Tree, &mut Command)) -> Self {
        let tree = Tree::new();
        let original = tree.read(USER);
        fs::create_dir(tree.beside("model")).unwrap();
        fs::write(tree.beside(MODEL), glb::model(&glb::quad(9.0), &glb::gray())).unwrap();
        fs::create_dir(tree.beside("out")).unwrap();
        let (sender, pictures) = channel();
        let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            // Ignore the events of reading the picture.
            if event.is_ok_and(|event| !event.kind.is_access()) {
                let _ = sender.send(());
            }
        })
        .unwrap();
        watcher.watch(&tree.beside("out"), RecursiveMode::NonRecursive).unwrap();
        let mut command = specula(&tree.beside(""));
        command.args(["render", MODEL, "--shaders", "shaders", "--out", "out/picture.png", "--size", "32x24"]);
        command.args(["--watch", "--events", "json", "--validate", "--tonemap", "none", "--set", "view.msaa=1"]);
        command.args(["--eye", "0,0,3", "--target", "0,0,0"]);
        prepare(&tree, &mut command);
        let mut running = Running::start(&mut command);
        running.event("ready");
        Self { tree, running, original, pictures, _watcher: watcher }
    }

    /// A `user.glsl` that fills the picture with this encoded gray.
    fn text(&self, gray: u8) -> String {
        let value = format!("    return vec3({:?} / 255.0) / frame.exposure;", f32::from(gray));
        self.original.replace("    return radiance;", &value)
    }

    fn picture(&self) -> PathBuf {
        self.tree.beside("out/picture.png")
    }

    /// Waits until the picture shows this gray.
    #[track_caller]
    fn shows(&self, gray: u8, how: &str) {
        let expected = (srgb(f64::from(gray) / 255.0) * 255.0).round() as u8;
        self.until(&format!("gray {gray} ({expected} encoded) after {how}"), |pixel| {
            pixel.iter().all(|channel| channel.abs_diff(expected) <= 1)
        });
    }

    /// Waits until `is` accepts the center pixel. Checks again whenever the file changes.
    #[track_caller]
    fn until(&self, what: &str, is: impl Fn([u8; 3]) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let pixel = center(&self.picture());
            if is(pixel) {
                return;
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if self.pictures.recv_timeout(left).is_err() {
                panic!("the picture never showed {what}; it is {pixel:?}. {}", self.running.story());
            }
        }
    }
}

/// The center pixel. The file must always exist and be complete.
#[track_caller]
fn center(path: &Path) -> [u8; 3] {
    let png = crate::support::open_image(path).into_rgb8();
    assert_eq!(png.dimensions(), (32, 24));
    png.get_pixel(16, 12).0
}

/// The model in another color.
fn colored([r, g, b]: [f32; 3]) -> Vec<u8> {
    let mut material = glb::gray();
    material["pbrMetallicRoughness"]["baseColorFactor"] = serde_json::json!([r, g, b, 1.0]);
    glb::model(&glb::quad(9.0), &material)
}

fn rename_over(path: &Path, text: &str) {
    let new = path.with_extension("glsl.new");
    fs::write(&new, text).unwrap();
    fs::rename(&new, path).unwrap();
}

#[test]
fn every_way_of_saving_shows() {
    let mut watched = Watched::new();
    let path = watched.tree.path(USER);
    rename_over(&path, &watched.text(10));
    let event = watched.running.reload(true);
    watched.shows(10, "a rename over the file");
    assert!(event["changed"][0].as_str().unwrap().ends_with("user.glsl"), "{event}");
    assert_eq!(event["stages"], serde_json::json!(["pbr.frag"]), "{event}");
    for time in ["detect_ms", "compile_ms", "pipeline_ms", "first_frame_ms"] {
        assert!(event[time].as_f64().is_some_and(|ms| ms >= 0.0), "{time} in {event}");
    }

    fs::write(&path, watched.text(20)).unwrap();
    watched.running.reload(true);
    watched.shows(20, "truncate and write");

    fs::remove_file(&path).unwrap();
    fs::write(&path, watched.text(30)).unwrap();
    watched.shows(30, "delete and create");

    // vim with a backup: the old file is moved away first.
    fs::rename(&path, path.with_extension("glsl~")).unwrap();
    fs::write(&path, watched.text(40)).unwrap();
    watched.shows(40, "a backup by rename");
}

#[test]
fn a_broken_edit_keeps_the_picture_and_says_why() {
    let mut watched = Watched::new();
    watched.tree.write(USER, &watched.text(50));
    watched.running.reload(true);
    watched.shows(50, "a good edit");
    let before = fs::read(watched.picture()).unwrap();

    let broken = watched.text(60).replace("frame.exposure;", "frame.exposures;");
    watched.tree.write(USER, &broken);
    let diagnostic = watched.running.event("diagnostic");
    assert_eq!(diagnostic["severity"], "error", "{diagnostic}");
    assert!(diagnostic["file"].as_str().unwrap().ends_with("shaders/user.glsl"), "{diagnostic}");
    assert_eq!(diagnostic["line"], line_of(&broken, "exposures"), "{diagnostic}");
    assert!(diagnostic["column"].is_u64() && diagnostic["message"].is_string(), "{diagnostic}");
    let failed = watched.running.reload(false);
    assert_eq!(fs::read(watched.picture()).unwrap(), before, "a broken edit wrote the picture");

    watched.tree.write(USER, &watched.text(70));
    let good = watched.running.reload(true);
    assert!(good["generation"].as_u64() > failed["generation"].as_u64(), "{failed} {good}");
    watched.shows(70, "the fix");

    // A broken edit is undone: nothing is drawn, but the program reports that the shaders are good again.
    watched.tree.write(USER, &broken);
    watched.running.reload(false);
    watched.tree.write(USER, &watched.text(70));
    watched.running.reload(true);
}

#[test]
fn the_picture_is_never_half_written_and_a_storm_of_saves_ends_with_the_last() {
    let watched = Watched::new();
    let (reader, stop) = read_all_the_time(watched.picture());
    // An editor that saves at every key, sometimes in the middle of a word.
    for save in 0..50_u8 {
        let text = watched.text(100 + save);
        let text = if save % 3 == 1 { text.replace("exposure;", "expo") } else { text };
        watched.tree.write(USER, &text);
    }
    // The program writes a picture for each of these while the reader reads.
    for gray in [200, 210, 220] {
        rename_over(&watched.tree.path(USER), &watched.text(gray));
        watched.shows(gray, "a storm of saves");
    }
    drop(stop);
    let reads = reader.join().expect("every read found a whole picture");
    assert!(reads > 10, "only {reads} reads");
}

/// Decodes a picture repeatedly until the sender is dropped. The thread counts the reads, and panics at an incomplete picture.
fn read_all_the_time(path: PathBuf) -> (JoinHandle<usize>, Sender<()>) {
    let (stop, stopped) = channel();
    let reader = std::thread::spawn(move || {
        let mut reads = 0;
        while stopped.try_recv() != Err(TryRecvError::Disconnected) {
            center(&path);
            reads += 1;
        }
        reads
    });
    (reader, stop)
}

#[test]
fn two_hundred_files_at_once() {
    let watched = Watched::new();
    let count = 200;
    let includes: String = (0..count).map(|i| format!("#include \"many/f{i}.glsl\"\n")).collect();
    let sum: String = (0..count).map(|i| format!("+ ONE_{i}")).collect();
    let value = format!("    return vec3((0.0 {sum}) / 255.0) / frame.exposure;");
    let text = watched.original.replace("    return radiance;", &value);
    let text = text.replace("#include \"common/color.glsl\"\n", &format!("#include \"common/color.glsl\"\n{includes}"));
    // As in a git checkout: in any order, each file as fast as the disk allows.
    watched.tree.write(USER, &text);
    fs::create_dir(watched.tree.path("many")).unwrap();
    for i in 0..count {
        watched.tree.write(&format!("many/f{i}.glsl"), &format!("const float ONE_{i} = 1.0;\n"));
    }
    watched.shows(200, "200 new files");
    for i in 0..count {
        watched.tree.write(&format!("many/f{i}.glsl"), &format!("const float ONE_{i} = 0.5;\n"));
    }
    watched.shows(100, "200 changed files");
}

#[test]
fn the_tree_may_go_away_and_come_back() {
    let mut watched = Watched::new();
    watched.tree.write(USER, &watched.text(80));
    watched.running.reload(true);
    watched.shows(80, "an edit");
    let before = fs::read(watched.picture()).unwrap();

    let away = watched.tree.beside("away");
    fs::rename(watched.tree.root(), &away).unwrap();
    watched.running.reload(false);
    assert_eq!(fs::read(watched.picture()).unwrap(), before, "the picture stays while the tree is away");
    fs::rename(&away, watched.tree.root()).unwrap();
    watched.running.reload(true);

    watched.tree.write(USER, &watched.text(90));
    watched.shows(90, "an edit after the tree came back");
    // A branch switch that replaces the whole folder.
    let other = watched.tree.beside("other");
    specula::shader::source::embedded::write_to(&other, None).unwrap();
    fs::write(other.join(USER), watched.text(120)).unwrap();
    fs::rename(watched.tree.root(), &away).unwrap();
    fs::rename(&other, watched.tree.root()).unwrap();
    watched.shows(120, "another tree in its place");
}

#[test]
fn the_model_is_watched_too() {
    let watched = Watched::new();
    let path = watched.tree.beside(MODEL);
    let replace = |bytes: &[u8]| {
        let new = watched.tree.beside("new.glb");
        fs::write(&new, bytes).unwrap();
        fs::rename(&new, &path).unwrap();
    };
    replace(&colored([1.0, 0.0, 0.0]));
    watched.until("red after the model was replaced", |[r, g, _]| r > 60 && g < r / 2);
    // A damaged model keeps the last good model on screen, and is read again once it is repaired.
    replace(b"glTF");
    replace(&colored([0.0, 1.0, 0.0]));
    watched.until("green after a damaged file", |[r, g, _]| g > 60 && r < g / 2);
}

#[test]
fn shaders_that_are_broken_from_the_start_are_waited_for() {
    let tree = Tree::new();
    let original = tree.read(USER);
    tree.write(USER, &original.replace("return radiance;", "return radianc;"));
    let mut command = specula(&tree.beside(""));
    command.args(["render", "sphere-grid", "--shaders", "shaders", "--out", "late.png", "--size", "32x24"]);
    let mut running = Running::start(command.args(["--env", "none", "--watch", "--events", "json", "--validate"]));
    running.event("diagnostic");
    assert!(!tree.beside("late.png").exists());
    tree.write(USER, &original);
    running.event("ready");
    assert!(tree.beside("late.png").exists());
}

#[test]
fn a_models_folder_may_be_removed_and_written_again() {
    let watched = Watched::new();
    let (path, away) = (watched.tree.beside(MODEL), watched.tree.beside("away"));
    let folder = path.parent().unwrap();
    fs::remove_dir_all(folder).unwrap();
    fs::create_dir(folder).unwrap();
    fs::write(&path, colored([1.0, 0.0, 0.0])).unwrap();
    watched.until("red after the folder was written again", |[r, g, _]| r > 60 && g < r / 2);
    fs::rename(folder, away).unwrap();
    fs::create_dir(folder).unwrap();
    fs::write(&path, colored([0.0, 1.0, 0.0])).unwrap();
    watched.until("green after the folder was moved and written again", |[r, g, _]| g > 60 && r < g / 2);
}

#[test]
fn an_environment_behind_links_is_baked_again() {
    let mut watched = Watched::with(|tree, command| {
        for folder in ["skies", "elsewhere"] {
            fs::create_dir(tree.beside(folder)).unwrap();
        }
        fs::write(tree.beside("elsewhere/sky.hdr"), hdr::uniform([128, 0, 0, 129])).unwrap();
        symlink("../elsewhere/sky.hdr", tree.beside("skies/sky.hdr")).unwrap();
        symlink("skies", tree.beside("folder")).unwrap();
        command.args(["--env", "folder/sky.hdr"]);
    });
    fs::write(watched.tree.beside("elsewhere/sky.hdr"), hdr::uniform([0, 128, 0, 129])).unwrap();
    watched.running.event("bake");
    fs::write(watched.tree.beside("elsewhere/new.hdr"), hdr::uniform([0, 0, 128, 129])).unwrap();
    fs::rename(watched.tree.beside("elsewhere/new.hdr"), watched.tree.beside("skies/sky.hdr")).unwrap();
    watched.running.event("bake");
}

#[test]
fn a_swapped_link_to_the_tree_is_another_tree() {
    let mut watched = Watched::with(|tree, command| {
        fs::rename(tree.root(), tree.beside("v1")).unwrap();
        symlink("v1", tree.root()).unwrap();
        command.args(["--env", "none"]);
    });
    let v2 = watched.tree.beside("v2");
    specula::shader::source::embedded::write_to(&v2, None).unwrap();
    fs::write(v2.join(USER), watched.text(130)).unwrap();
    symlink("v2", watched.tree.beside("new")).unwrap();
    fs::rename(watched.tree.beside("new"), watched.tree.root()).unwrap();
    watched.running.reload(true);
    watched.shows(130, "another tree behind the link");
    fs::write(v2.join(USER), watched.text(140)).unwrap();
    watched.shows(140, "an edit of the tree behind the link");
}

#[test]
fn without_notifications_changes_are_found_by_looking() {
    let mut watched = Watched::with(|_, command| {
        command.args(["--env", "none"]).env("SPECULA_POLL", "1");
    });
    let root = watched.tree.root();
    let told = format!("for {} (SPECULA_POLL is set); looking every 500 ms instead\n", root.display());
    for gray in [150, 160] {
        watched.tree.write(USER, &watched.text(gray));
        watched.running.reload(true);
        watched.shows(gray, "a save without notifications");
    }
    fs::write(watched.tree.beside(MODEL), colored([1.0, 0.0, 0.0])).unwrap();
    watched.tree.write(USER, &watched.original);
    watched.until("red after the model was saved", |[r, g, _]| r > 60 && g < r / 2);
    let stderr = watched.running.stderr();
    assert_eq!(stderr.matches(&told).count(), 1, "{stderr}");
    assert_eq!(stderr.matches("specula: no change notifications").count(), 1, "{stderr}");
}
