//! The Python package: scripts in `tests/python`, with the program of this build. `scripts/test-python` makes their environment.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::support::process::{Finished, finish};
use crate::support::window::Display;

/// A path in the repository.
fn in_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The interpreter with the packages of the tests.
pub(super) fn interpreter() -> &'static Path {
    static FOUND: OnceLock<PathBuf> = OnceLock::new();
    FOUND.get_or_init(|| {
        std::env::var_os("SPECULA_PYTHON").map(PathBuf::from).unwrap_or_else(|| {
            let made = Command::new("bash").arg(in_repository("scripts/test-python")).output().unwrap();
            assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
            PathBuf::from(String::from_utf8(made.stdout).unwrap().trim())
        })
    })
}

/// Runs a script of `tests/python` in `folder`. It finds the package of the repository and the program of this build.
#[track_caller]
pub(super) fn run_script(script: &str, folder: &Path) -> Finished {
    run_script_with(Command::new(interpreter()), (script, &[]), folder)
}

/// [`run_script`] by a command that starts the interpreter, with arguments.
#[track_caller]
pub(super) fn run_script_with(mut command: Command, (script, args): (&str, &[&str]), folder: &Path) -> Finished {
    command.arg(in_repository("tests/python").join(script)).args(args).current_dir(folder);
    command.env("PYTHONPATH", in_repository("assets/python")).env("PYTHONDONTWRITEBYTECODE", "1");
    command.env("SPECULA", env!("CARGO_BIN_EXE_specula")).env("REPOSITORY", env!("CARGO_MANIFEST_DIR"));
    let ended = finish(&mut command);
    println!("{}", ended.stdout);
    assert_eq!(ended.code, Some(0), "{}\n{}", ended.stdout, ended.stderr);
    ended
}

#[test]
fn a_session_draws_edits_measures_and_survives() {
    run_script("session.py", tempfile::tempdir().unwrap().path());
}

#[test]
fn a_session_writes_its_own_tree_and_all_kinds_of_files() {
    run_script("own_tree.py", tempfile::tempdir().unwrap().path());
}

#[test]
fn the_python_of_the_pages_runs() {
    run_script("pages.py", tempfile::tempdir().unwrap().path());
}

#[test]
fn sessions_leave_nothing_behind() {
    run_script("endings.py", tempfile::tempdir().unwrap().path());
}

#[test]
fn a_session_with_a_window_draws_what_one_without_draws() {
    let (folder, display) = (tempfile::tempdir().unwrap(), Display::new());
    let mut command = Command::new(interpreter());
    command.env("DISPLAY", display.name()).env_remove("WAYLAND_DISPLAY");
    for (variable, inner) in [("XDG_RUNTIME_DIR", "runtime"), ("XDG_STATE_HOME", "state")] {
        fs::create_dir(folder.path().join(inner)).unwrap();
        command.env(variable, folder.path().join(inner));
    }
    run_script_with(command, ("window.py", &[]), folder.path());
    let left: Vec<_> = fs::read_dir(folder.path().join("runtime")).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn the_notebooks_run() {
    run_script("notebooks.py", tempfile::tempdir().unwrap().path());
}

#[test]
fn package_and_notebooks_pass_the_strict_type_check() {
    run_script("type_check.py", tempfile::tempdir().unwrap().path());
}

#[test]
fn licenses_and_description_of_the_packages_are_whole() {
    run_script("packages.py", tempfile::tempdir().unwrap().path());
}

/// The wheel is installed without a network into a new environment. numpy comes from that of the tests.
#[test]
fn a_wheel_in_a_new_environment_draws_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |inner: &str| folder.path().join(inner);
    fs::create_dir_all(path("root/bin")).unwrap();
    let program = path("root/bin/specula");
    fs::copy(env!("CARGO_BIN_EXE_specula"), &program).unwrap();
    let stripped = Command::new("strip").arg(&program).status().unwrap();
    assert!(stripped.success());
    let in_folder = |program: &Path| {
        let mut command = Command::new(program);
        command.current_dir(folder.path()).env_remove("SPECULA").env_remove("PYTHONPATH");
        command
    };
    let python = interpreter();
    let mut wheel = in_folder(python);
    wheel.arg(in_repository("scripts/packaging/wheel.py")).args(["root", "specula", "0.1.0", "Test", "linux_x86_64"]);
    wheel.arg(in_repository("assets/python/README.md")).arg(in_repository("assets/python/specula")).arg("out");
    let file = finish(&mut wheel);
    assert_eq!(file.code, Some(0), "{}", file.stderr);
    let made = finish(in_folder(python).args(["-m", "venv", "--without-pip", "new"]));
    assert_eq!(made.code, Some(0), "{}", made.stderr);
    let install = ["-m", "pip", "--python", "new/bin/python", "install", "--quiet", "--no-index", "--no-deps"];
    let installed = finish(in_folder(python).args(install).arg(file.stdout.trim()));
    assert_eq!(installed.code, Some(0), "{}", installed.stderr);
    let script = "import numpy, sys, importlib.metadata as m\n\
        import specula\n\
        assert m.requires('specula') == ['numpy'], m.requires('specula')\n\
        assert specula.find_program() == sys.prefix + '/bin/specula', specula.find_program()\n\
        assert specula.__file__.startswith(sys.prefix), specula.__file__\n\
        with specula.Session('sphere-grid', env='none', size=(64, 36)) as session:\n\
        \x20   picture = session.render()\n\
        assert picture.shape == (36, 64, 4) and picture[..., 3].max() == 255, picture\n\
        print('drawn')";
    let numpy = finish(Command::new(python).args(["-c", "import numpy; print(numpy.__path__[0])"]));
    let site = Path::new(numpy.stdout.trim()).parent().unwrap();
    let link = finish(
        in_folder(&path("new/bin/python")).args(["-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]),
    );
    fs::write(Path::new(link.stdout.trim()).join("numpy-of-the-tests.pth"), site.display().to_string()).unwrap();
    // No program on PATH, and none in the variable: that of the wheel.
    let mut draw = in_folder(&path("new/bin/python"));
    let drawn = finish(draw.args(["-c", script]).env("PATH", "/usr/bin:/bin"));
    assert_eq!(drawn.stdout.trim(), "drawn", "{}", drawn.stderr);
}
