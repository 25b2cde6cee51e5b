//! Hostile surroundings: output that nobody takes, limits of the process, files that are pipes, endless or not what they seem.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::support::Tree;
use crate::support::process::{Running, finish, in_shell, run, specula};

const NDF: &str = "brdf/ndf.glsl";
/// Arguments of a `render` that is fast.
const QUICK: [&str; 10] =
    ["render", "sphere-grid", "--env", "none", "--size", "64x48", "--lights", "orbit", "--out", "out.png"];

/// Runs a command of which a shell redirects the output.
fn redirected(args: &[&str], redirection: &str) -> crate::support::process::Finished {
    let directory = tempfile::tempdir().unwrap();
    let script = format!("exec \"$0\" \"$@\" {redirection}");
    finish(in_shell(specula(directory.path()).args(args), &script).current_dir(directory.path()))
}

#[test]
fn text_that_a_full_device_does_not_take_is_an_error() {
    for args in [&["modes"][..], &["modes", "--json"], &["help", "set"], &["--help"], &["info", "--json"]] {
        redirected(args, ">/dev/full").expect(1, &["cannot write to standard output: No space left"]);
    }
    redirected(&[&QUICK[..], &["--events", "json"]].concat(), ">/dev/full").expect(1, &["cannot write to standard"]);
    redirected(&["modes"], "2>/dev/full").expect(0, &[]);
    redirected(&["modes", "--shaders", "nowhere"], "2>/dev/full").expect(1, &[]);
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    for args in ["modes", "help set", "--help"] {
        let script = format!("{{ \"$0\" {args}; echo \"ended with $?\" >&2; }} | true");
        let directory = tempfile::tempdir().unwrap();
        finish(&mut in_shell(&specula(directory.path()), &script)).expect(0, &["ended with 0"]);
    }
}

/// A broken save prints its errors, which must not end the command.
#[test]
fn watching_goes_on_when_stderr_takes_nothing() {
    // The second is a pipe without a reader. The shell becomes the program, so that dropping `running` ends it.
    for stderr in ["2>/dev/full", "2> >(true)"] {
        let tree = Tree::new();
        let mut command = specula(&tree.beside(""));
        command.args(QUICK).args(["--shaders", "shaders", "--watch", "--events", "json"]);
        let script = format!("exec \"$0\" \"$@\" {stderr}");
        let mut running = Running::start(in_shell(&command, &script).current_dir(tree.beside("")).stdin(Stdio::null()));
        running.event("ready");
        let sound = tree.read(NDF);
        tree.write(NDF, &tree.edited(NDF, "alpha * alpha;", "alpha * alfa;"));
        running.reload(false);
        tree.write(NDF, &sound.replace("alpha * alpha;", "alpha;"));
        running.reload(true);
    }
}

/// Drivers and the standard library abort a process that gets no thread or no memory.
#[test]
fn limits_of_the_process_are_errors_with_a_name() {
    use std::os::unix::fs::PermissionsExt as _;
    use std::os::unix::process::CommandExt as _;
    let limited = |limits: &str, needs_another_user: bool| {
        let directory = tempfile::tempdir().unwrap();
        fs::set_permissions(directory.path(), fs::Permissions::from_mode(0o777)).unwrap();
        let program = directory.path().join("specula");
        fs::copy(env!("CARGO_BIN_EXE_specula"), &program).unwrap();
        let mut command = Command::new("bash");
        command.args(["-c", &format!("{limits} && exec \"$0\" \"$@\"")]).arg(&program).args(QUICK);
        command.current_dir(directory.path()).stdin(Stdio::null()).env("HOME", directory.path());
        // Limits of processes do not hold for root.
        if needs_another_user
            && fs::metadata("/proc/self").is_ok_and(|own| std::os::unix::fs::MetadataExt::uid(&own) == 0)
        {
            command.uid(65_534);
        }
        finish(&mut command)
    };
    limited("ulimit -u 1", true).expect(3, &["cannot start threads", "ulimit -u"]);
    limited("ulimit -v 1000000", false).expect(3, &["976 MiB of memory (`ulimit -v`)", "Specula needs"]);
    limited("ulimit -s 64", false).expect(3, &["64 KiB of stack (`ulimit -s`)"]);
    limited("ulimit -v 3000000; ulimit -s 2048", false).expect(0, &[]);
}

#[test]
fn looks_that_are_pipes_or_endless_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let render = |look: &str| run(directory.path(), &[&QUICK[..], &["--look", look]].concat());
    for name in ["look.toml", "look.png"] {
        assert!(Command::new("mkfifo").arg(directory.path().join(name)).status().unwrap().success());
        render(name).expect(1, &[name, "it is not a regular file"]);
    }
    for endless in ["/dev/zero", "/dev/random"] {
        render(endless).expect(1, &[endless, "it is not a regular file"]);
    }
    fs::File::create(directory.path().join("large.toml")).unwrap().set_len(1 << 40).unwrap();
    render("large.toml").expect(1, &["large.toml", "Specula reads at most 2097152"]);
}

/// A look may come from elsewhere and name any file, such as one with secrets, and a log may be public.
#[test]
fn messages_hold_no_bytes_of_the_files_that_a_look_names() {
    let directory = tempfile::tempdir().unwrap();
    let secret = "hunter2hunter2hunter2";
    let hex = "68 75 6e 74";
    fs::write(directory.path().join("secret"), secret).unwrap();
    fs::copy(directory.path().join("secret"), directory.path().join("secret.binary")).unwrap();
    fs::write(directory.path().join("env.toml"), "environment.name = \"secret\"").unwrap();
    fs::write(directory.path().join("measured.toml"), "mode = \"measured\"\nmeasured = \"secret.binary\"").unwrap();
    let says_nothing = |args: &[&str]| {
        let finished = run(directory.path(), &[&["render", "--out", "out.png"], args].concat());
        finished.expect(1, &["secret"]);
        let number = i32::from_le_bytes(*secret.as_bytes().first_chunk().unwrap()).to_string();
        for part in ["hunt", hex, &number] {
            assert!(!finished.stderr.contains(part), "{finished:#?}");
        }
    };
    says_nothing(&["--look", "env.toml"]);
    says_nothing(&["--look", "measured.toml"]);
    says_nothing(&["secret"]);
}

/// The files of the kernel claim to be regular ones of no size, and reading one may wait for ever.
#[test]
fn files_of_the_kernel_are_not_read() {
    let path = Path::new("/proc/kmsg");
    if !path.is_file() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    for args in
        [&["render", "/proc/kmsg"][..], &["render", "--env", "/proc/kmsg"], &["diff", "/proc/kmsg", "/proc/kmsg"]]
    {
        run(directory.path(), args).expect(1, &["/proc/kmsg"]);
    }
}

/// A tree from elsewhere must not read, or let the user write, files outside of it.
#[test]
fn links_of_a_tree_do_not_lead_out_of_it() {
    use std::os::unix::fs::symlink;
    let tree = Tree::new();
    let render = || run(&tree.beside(""), &[&QUICK[..], &["--shaders", "shaders"]].concat());
    fs::write(tree.beside("secret.glsl"), "hunter2 = 7;\n").unwrap();
    image::RgbImage::new(2, 2).save(tree.beside("secret.png")).unwrap();
    symlink(tree.beside("secret.glsl"), tree.path("link.glsl")).unwrap();
    symlink(tree.beside("secret.png"), tree.path("link.png")).unwrap();
    symlink(tree.beside(""), tree.path("above")).unwrap();
    symlink("/proc", tree.path("kernel")).unwrap();
    symlink("/usr", tree.path("usr")).unwrap();
    let started = std::time::Instant::now();
    render().expect(0, &[]);
    // The walk through /proc and /usr alone took 30 s.
    assert!(started.elapsed() < std::time::Duration::from_secs(20));
    let ndf = tree.read(NDF);
    for link in ["link.glsl", "above/secret.glsl"] {
        tree.write(NDF, &format!("#include \"{link}\"\n{ndf}"));
        let finished = render();
        finished.expect(1, &[NDF, "a link that leads out of the shader tree"]);
        assert!(!finished.stderr.contains("hunter2"), "{finished:#?}");
    }
    tree.write(NDF, &ndf);
    fs::create_dir_all(tree.path("passes")).unwrap();
    let pass = |image: &str| {
        format!(
            "//@pass tint \"Tint\" to=picture\n//@texture color_of_all \"{image}\"\n#version 460\n#include \"pass.glsl\"\n\
             uniform sampler2D color_of_all;\nvoid main() {{ color = texture(color_of_all, uv); }}\n"
        )
    };
    tree.write("passes/tint.frag", &pass("../link.png"));
    render().expect(1, &["link.png", "a link that leads out of the shader tree"]);
    // A link within the tree is followed.
    fs::copy(tree.beside("secret.png"), tree.path("own.png")).unwrap();
    symlink("own.png", tree.path("alias.png")).unwrap();
    tree.write("passes/tint.frag", &pass("../alias.png"));
    render().expect(0, &[]);
}

#[test]
fn a_folder_with_too_many_files_is_no_tree() {
    let tree = Tree::new();
    for folder in 0..210 {
        let folder = tree.path(&format!("many/{folder}"));
        fs::create_dir_all(&folder).unwrap();
        (0..100).for_each(|file| fs::write(folder.join(file.to_string()), "").unwrap());
    }
    let render = run(&tree.beside(""), &[&QUICK[..], &["--shaders", "shaders"]].concat());
    render.expect(1, &["has more than 20000 files and folders, too many for a shader tree"]);
}

#[test]
fn a_tree_that_does_not_fit_on_the_disk_is_not_begun() {
    let directory = tempfile::tempdir().unwrap();
    // No file may grow.
    let mut command = specula(directory.path());
    let script = "trap '' XFSZ; ulimit -f 0; exec \"$0\" \"$@\"";
    finish(in_shell(command.args(["new", "mine"]), script).current_dir(directory.path()))
        .expect(1, &["mine/", "large"]);
    assert!(!directory.path().join("mine").exists());
}
