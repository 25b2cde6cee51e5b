//! How `render`, as a process, writes files: full disks, links, pipes and signals.

use std::fs;
use std::io::Read as _;
use std::os::unix::fs::symlink;
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;

use crate::support::process::{PATIENCE, finish, run, specula};
use crate::support::{Tree, glb, open_image};
use notify::{RecursiveMode, Watcher as _};
use serde_json::json;
use tempfile::TempDir;

/// Arguments of a `render` that is fast.
const QUICK: [&str; 8] = ["render", "sphere-grid", "--env", "none", "--size", "64x48", "--lights", "orbit"];

fn render(directory: &Path, out: &str) -> crate::support::process::Finished {
    run(directory, &[&QUICK[..], &["--out", out]].concat())
}

fn names_in(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A directory that contains an old picture.
fn with_old_picture() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("old.png"), "old").unwrap();
    directory
}

#[test]
fn a_picture_knows_its_scene_and_finds_its_model_from_elsewhere() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (mut json, bin) = glb::document(&glb::quad(1.0), &glb::gray());
    json["scenes"].as_array_mut().unwrap().push(json!({ "nodes": [1] }));
    json["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0, "rotation": [0.0, 0.0, 0.38, 0.92] }));
    fs::write(here.join("two.glb"), glb::container(&json, &bin)).unwrap();
    let render = |args: &[&str], out: &str| {
        run(here, &[&["render", "--env", "none", "--size", "48x32", "--out", out], args].concat()).expect(0, &[]);
        open_image(&here.join(out))
    };
    let (first, second) = (render(&["two.glb"], "first.png"), render(&["two.glb", "--scene", "1"], "second.png"));
    assert!(first != second, "both scenes look alike");
    assert!(render(&["--look", "second.png"], "again.png") == second, "another scene");
    assert!(render(&["--look", "second.png", "--scene", "0"], "again.png") != second, "the option is ignored");
    fs::create_dir_all(here.join("far/away")).unwrap();
    fs::rename(here.join("second.png"), here.join("far/away/second.png")).unwrap();
    assert!(render(&["--look", "far/away/second.png"], "again.png") == second, "another picture from elsewhere");
}

#[test]
fn a_full_disk_is_an_error_and_the_old_picture_stays() {
    let directory = with_old_picture();
    let path = directory.path();
    // No file may grow beyond 512 or 1024 bytes, depending on the shell. The picture must be larger, and smaller than the
    // buffers of most writers, which report errors only when they are flushed.
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_specula")]).args(QUICK).args(["--out", "old.png"]);
    finish(command.current_dir(path).stdin(Stdio::null())).expect(1, &["cannot write old.png", "large"]);
    assert_eq!(fs::read(path.join("old.png")).unwrap(), b"old");
    assert_eq!(names_in(path), ["old.png"]);
    // The same picture without the limit.
    render(path, "old.png").expect(0, &[]);
    let bytes = fs::metadata(path.join("old.png")).unwrap().len();
    assert!((1025..8192).contains(&bytes), "a picture of {bytes} bytes does not test this");
}

#[test]
fn a_link_stays_and_its_target_is_replaced() {
    let directory = with_old_picture();
    let path = directory.path();
    fs::create_dir(path.join("pictures")).unwrap();
    symlink("pictures/new.png", path.join("between.png")).unwrap();
    symlink("between.png", path.join("link.png")).unwrap();
    symlink("old.png", path.join("to-old.png")).unwrap();
    // A target that does not exist yet, and one that does.
    for (link, target) in [("link.png", "pictures/new.png"), ("to-old.png", "old.png")] {
        render(path, link).expect(0, &[]);
        assert!(path.join(link).is_symlink(), "{link} was replaced");
        assert!(!path.join(target).is_symlink());
        assert_eq!(open_image(&path.join(target)).into_rgb8().dimensions(), (64, 48));
    }
    symlink("no/such/folder/x.png", path.join("nowhere.png")).unwrap();
    render(path, "nowhere.png").expect(1, &["cannot write nowhere.png", "no folder no/such/folder"]);
    symlink("circle.png", path.join("circle.png")).unwrap();
    render(path, "circle.png").expect(1, &["cannot write circle.png", "symbolic links"]);
}

#[test]
fn pipes_and_devices_are_written_to() {
    let directory = tempfile::tempdir().unwrap();
    let pipe = directory.path().join("pipe.png");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let (sender, bytes) = channel();
    let reader = pipe.clone();
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        fs::File::open(reader).unwrap().read_to_end(&mut bytes).unwrap();
        let _ = sender.send(bytes);
    });
    render(directory.path(), "pipe.png").expect(0, &[]);
    let picture = image::load_from_memory(&bytes.recv_timeout(PATIENCE).unwrap()).unwrap();
    assert_eq!((picture.width(), picture.height()), (64, 48));
    assert!(!pipe.is_file(), "the pipe was replaced");

    for (link, device) in [("null.png", "/dev/null"), ("full.exr", "/dev/full"), ("out.png", "/dev/stdout")] {
        symlink(device, directory.path().join(link)).unwrap();
    }
    render(directory.path(), "null.png").expect(0, &[]);
    render(directory.path(), "full.exr").expect(1, &["cannot write full.exr", "No space"]);
    let piped = render(directory.path(), "out.png");
    assert!(piped.expect(0, &[]).stdout.contains("IHDR"), "standard output is no PNG");
    assert_eq!(names_in(directory.path()), ["full.exr", "null.png", "out.png", "pipe.png"]);
    render(directory.path(), "pipe.png").expect(1, &["cannot write pipe.png: nobody reads this pipe"]);
}

/// Opening a pipe waits for a program that writes to it, and closing a window waits for its readers.
#[test]
fn nothing_that_reads_a_file_waits_for_a_pipe() {
    use specula::scene::{EnvironmentFile, LoadOptions, MeasuredBrdf, load};
    let directory = tempfile::tempdir().unwrap();
    let pipe = directory.path().join("EXERCISE.md");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let refuses = |name: &str, fails: fn(&Path) -> bool| {
        let ((sender, failed), pipe) = (channel(), pipe.clone());
        std::thread::spawn(move || sender.send(fails(&pipe)));
        assert!(failed.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("{name} waits")), "{name} was read");
    };
    refuses("a measured BRDF", |pipe| MeasuredBrdf::open(pipe).is_err());
    refuses("an environment", |pipe| EnvironmentFile::open(pipe.to_str().unwrap()).is_err());
    refuses("a model", |pipe| load(pipe, &LoadOptions::default()).is_err());
    refuses("a picture", |pipe| specula::picture_difference::Picture::open(pipe).is_err());
    refuses("an exercise", |pipe| specula::learn::exercise_of(pipe.parent().unwrap()).is_none());
}

/// Sends the program each signal while it writes pictures, as soon as its temporary file appears.
#[test]
fn a_signal_leaves_no_temporary_files() {
    for (signal, number) in [("TERM", 15), ("INT", 2), ("HUP", 1)] {
        let directory = tempfile::tempdir().unwrap();
        let (sender, parts) = channel();
        let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            if event.is_ok_and(|event| event.kind.is_create()) {
                let _ = sender.send(());
            }
        })
        .unwrap();
        watcher.watch(directory.path(), RecursiveMode::NonRecursive).unwrap();
        // Under `nohup`, and in a shell's background job, signals are ignored from the start.
        let mut command = Command::new("env");
        command.arg("--default-signal=HUP,INT,TERM").arg(env!("CARGO_BIN_EXE_specula")).current_dir(directory.path());
        command.args(["render", "sphere-grid", "--env", "none", "--size", "2048x2048", "--set", "view.msaa=1"]);
        command.args(["--mode", "all", "--out", "big.exr"]).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        parts.recv_timeout(PATIENCE).expect("a temporary file");
        let kill = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
        assert!(kill.success());
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(number), "{signal}: {status}");
        let left: Vec<String> = names_in(directory.path()).into_iter().filter(|name| name.contains(".part")).collect();
        assert!(left.is_empty(), "{signal} left {left:?}");
    }
}

/// `nohup` and a shell's background jobs ignore signals; so must the program.
#[test]
fn an_ignored_signal_stays_ignored() {
    let tree = crate::support::Tree::new();
    let script = "trap '' INT HUP; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_specula")]).args(QUICK);
    command.args(["--out", "out.png", "--shaders", "shaders", "--watch", "--events", "json"]);
    let mut running =
        crate::support::process::Running::start(command.current_dir(tree.beside("")).stdin(Stdio::null()));
    running.event("ready");
    for signal in ["INT", "HUP"] {
        running.signal(signal);
    }
    let text = tree.read("user.glsl");
    tree.write("user.glsl", &text.replace("return radiance;", "return radiance + 0.5;"));
    running.reload(true);
    running.signal("TERM");
    assert_eq!(running.end().signal(), Some(15));
}

#[test]
fn the_drivers_pipelines_outlive_the_process_and_a_damaged_file_is_ignored() {
    let directory = tempfile::tempdir().unwrap();
    let cache = directory.path().join("cache");
    let picture = || {
        let mut command = specula(directory.path());
        command.env("SPECULA_CACHE", &cache).args(QUICK).args(["--validate", "--out", "out.png"]);
        finish(&mut command).expect(0, &[]);
        open_image(&directory.path().join("out.png"))
    };
    let first = picture();
    let pipelines = cache.join("pipelines");
    let [name] = &names_in(&pipelines)[..] else { panic!("not one file: {:?}", names_in(&pipelines)) };
    let whole = fs::read(pipelines.join(name)).unwrap();
    assert!(picture() == first, "pipelines of the run before look different");

    let mut flipped = whole.clone();
    flipped[10] ^= 4;
    for damaged in [&whole[..whole.len() / 2], &flipped, b""] {
        fs::write(pipelines.join(name), damaged).unwrap();
        assert!(picture() == first, "a damaged file looks different");
        assert!(fs::read(pipelines.join(name)).unwrap() == whole, "the damaged file is still there");
    }
}

/// `cd tree; specula`.
#[test]
fn the_tree_in_the_working_directory_is_used() {
    let tree = Tree::new();
    tree.write("user.glsl", "no GLSL\n");
    let error = |folder: &Path| run(folder, &["check"]).expect(1, &["user.glsl"]).stderr.contains("error");
    assert!(error(&tree.beside("")) && error(&tree.root()));
}
