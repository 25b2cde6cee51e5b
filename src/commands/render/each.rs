//! `--each`: a picture of each of many models.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use specula::file_kind::{FileKind, models_in};
use specula::message;
use specula::scene::find_model;

use super::Failure;
use super::args::Args;
use crate::commands::common::Models;

/// The placeholder for the name of a model in `--out`.
const NAME: &str = "{name}";

/// Calls `draw` with the options of each model. A model that cannot be drawn does not keep the others away.
///
/// # Errors
/// A wrong name of the files, no models, or the device is lost; after the last model, that some could not be drawn.
pub fn run(mut args: Args, mut draw: impl FnMut(&mut Args) -> Result<(), Failure>) -> Result<(), Failure> {
    let pattern = match args.out.to_str() {
        Some("specula.png") => "{name}.png".to_owned(),
        Some(out) if out.contains(NAME) => out.to_owned(),
        _ => {
            let message =
                format!("--each writes a file for each model, whose name has {NAME}, as --out 'out/{NAME}.png'");
            return Err(Failure::Usage(message));
        }
    };
    let models = named(args.models.all())?;
    let common = args.common.clone();
    let mut failed = Vec::new();
    for (number, (name, path)) in models.iter().enumerate() {
        message::tell(format_args!("model {} of {}: {}", number + 1, models.len(), path.display()));
        (args.models, args.common) = (Models::from(Some(path.clone())), common.clone());
        args.out = pattern.replace(NAME, name).into();
        match draw(&mut args) {
            Ok(()) => {}
            Err(failure @ (Failure::Usage(_) | Failure::Device(_) | Failure::Window(_))) => return Err(failure),
            Err(failure) => {
                failure.tell();
                failed.push(path.display().to_string());
            }
        }
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::Input(format!("{} of {} models have no picture: {}", failed.len(), models.len(), failed.join(", "))))
}

/// The models by their names. A folder stands for the models in it, or for the folders in it that hold one, by the names of these.
fn named(paths: Vec<PathBuf>) -> Result<BTreeMap<String, PathBuf>, Failure> {
    let mut found: Vec<(String, PathBuf)> = Vec::new();
    for path in paths {
        if FileKind::of(&path) != FileKind::Folder {
            found.push((stem(&path), path));
            continue;
        }
        let known = found.len();
        found.extend(models_in(&path).into_iter().map(|model| (stem(Path::new(&model)), model.into())));
        if found.len() == known {
            let folders = std::fs::read_dir(&path).into_iter().flatten().flatten().map(|entry| entry.path());
            let models = folders.filter(|folder| folder.is_dir());
            found.extend(models.filter_map(|folder| Some((stem(&folder), find_model(&folder).ok()?))));
        }
        if found.len() == known {
            return Err(Failure::Usage(format!("{} has no models", path.display())));
        }
    }
    let mut out = BTreeMap::new();
    for (name, path) in found {
        if let Some(other) = out.insert(name.clone(), path.clone()) {
            let (a, b) = (other.display(), path.display());
            return Err(Failure::Usage(format!("the pictures of {a} and {b} would have the same name, {name}")));
        }
    }
    match out.is_empty() {
        true => Err(Failure::Usage("--each needs models, or folders with some".into())),
        false => Ok(out),
    }
}

/// The last part of a path without its extension. That of a folder has none.
fn stem(path: &Path) -> String {
    let name = if path.is_dir() { path.file_name() } else { path.file_stem() };
    name.unwrap_or_default().to_string_lossy().into_owned()
}
