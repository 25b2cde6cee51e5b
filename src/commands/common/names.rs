//! Interprets the name of a model or an environment: a file, a built-in name, a typing error, or another kind of
//! file, which is answered with its option.

use std::path::Path;

use specula::file_kind::{FileKind, models_in};
use specula::message::nearest;
use specula::scene::environment::MODEL;
use specula::scene::{self, BUILT_IN};

use crate::commands::Failure;

/// Whether a text looks like a name: it is not an option, and has neither an extension nor a folder, as files do.
pub fn is_word(text: &str) -> bool {
    !text.starts_with('-') && Path::new(text).extension().is_none() && !text.contains(std::path::is_separator)
}

/// Fails when there is neither such a file nor a built-in model of that name, and when the file is not a model.
pub fn check_model_path(path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    check_kind(path)?;
    let name = path.to_string_lossy();
    if path.exists() || BUILT_IN.contains(&&*name) || path.ancestors().any(is_archive) {
        return Ok(());
    }
    let list = BUILT_IN.join(", ");
    if is_word(&name) {
        let hint = suggest(nearest(&name, BUILT_IN));
        let message =
            format!("there is no model '{name}'.{hint} Name a .gltf or .glb file or a built-in model: {list}");
        return Err(Failure::Usage(message));
    }
    let beside = models_in(path.parent().unwrap_or(Path::new("")));
    let hint = suggest(nearest(&name, beside.iter().map(String::as_str)));
    Err(Failure::Input(format!("{name}: there is no such file.{hint} Built-in models: {list}")))
}

fn is_archive(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("zip")) && path.is_file()
}

fn suggest(name: Option<&str>) -> String {
    name.map(|name| format!(" Did you mean '{name}'?")).unwrap_or_default()
}

/// Refuses what its name, or its content as a folder, shows not to be a model.
fn check_kind(path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let message = match FileKind::of(path) {
        FileKind::ShaderTree => format!("{shown} is a shader tree; use `--shaders {shown}`"),
        FileKind::Folder => match scene::find_model(path) {
            Ok(_) => return Ok(()),
            Err(problem) => format!("{shown} {problem}"),
        },
        FileKind::Environment => format!("{shown} is an environment; use `--env {shown}`"),
        FileKind::Look => format!("{shown} is a look file; use `--look {shown}`"),
        FileKind::Measured if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("bin")) => {
            format!("{shown} is a measured BRDF; use `--measured {shown}`")
        }
        FileKind::Shader if !path.exists() => {
            return Err(Failure::Input(format!("{shown}: there is no such file")));
        }
        FileKind::Shader => {
            format!("{shown} is a shader; use `--shaders {}`, the folder of its tree", folder.display())
        }
        // glTF names its buffers .bin, too; the loader says more.
        FileKind::Measured | FileKind::Model | FileKind::Other => return Ok(()),
    };
    Err(Failure::Usage(message))
}

/// Fails when an environment is a word but not a built-in name. A missing file is reported where it is opened.
pub fn check_environment(name: &str) -> Result<(), Failure> {
    let known = || scene::environment::BUILT_IN.into_iter().chain([MODEL, "none"]);
    if known().any(|known| known == name) || !is_word(name) || Path::new(name).exists() {
        return Ok(());
    }
    let hint = suggest(nearest(name, known()));
    let list = known().collect::<Vec<_>>().join(", ");
    Err(Failure::Usage(format!("unknown environment '{name}'.{hint} It can be {list} or a .hdr or .exr file")))
}
