//! Finds the model in what the user names: a file, a folder, a zip archive, or a file in one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::archive::{Archive, inside};
use crate::regular_file;
use crate::scene::error::Problem;

/// Most entries of a folder and those below it that are looked at.
const MOST_ENTRIES: usize = 5000;
/// Folders below the named one in which a model is looked for.
const DEEPEST: usize = 3;
/// Most models that a message names.
const MOST_NAMED: usize = 8;

/// A model's file and where the files lie that it names.
pub struct Opened {
    /// The file that is watched: the model, or the archive that it is in.
    pub path: PathBuf,
    /// The model's name: the stem of that file.
    pub name: String,
    /// The content of the model's file.
    pub bytes: Vec<u8>,
    /// Where the other files are.
    pub place: Place,
}

/// Where the files lie that a model names.
#[derive(Clone)]
pub enum Place {
    /// In a folder.
    Folder(PathBuf),
    /// In a folder of an archive, which is empty for its root.
    Archive(Arc<Archive>, String),
    /// Nowhere: the model is in memory.
    Nowhere,
}

/// Reads the model that `path` stands for.
///
/// # Errors
/// There is none, there are several, or it cannot be read.
pub fn open(path: &Path) -> Result<Opened, Problem> {
    let path = if path.is_dir() { find_model(path)? } else { path.to_owned() };
    match archive_of(&path) {
        Some((archive, name)) => open_archived(archive, name),
        None => {
            let bytes = regular_file::read(&path, regular_file::LARGEST).map_err(Problem::Read)?;
            let place = path.parent().map_or(Place::Nowhere, |folder| Place::Folder(folder.to_owned()));
            Ok(Opened { name: stem(&path), bytes, place, path })
        }
    }
}

/// The model in a folder: the only one, or else the only one in the folders below it that are nearest.
///
/// # Errors
/// There is none, or there are several.
pub fn find_model(folder: &Path) -> Result<PathBuf, Problem> {
    let (mut folders, mut seen) = (vec![folder.to_owned()], 0);
    for _ in 0..=DEEPEST {
        let (mut models, mut below) = (Vec::new(), Vec::new());
        for entry in folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten() {
            seen += 1;
            if seen > MOST_ENTRIES {
                break;
            }
            let path = entry.path();
            match entry.file_type() {
                _ if is_hidden(&path) => {}
                Ok(kind) if kind.is_dir() => below.push(path),
                _ if is_model(&path) => models.push(path),
                _ => {}
            }
        }
        if let Some(found) = only(models)? {
            return Ok(found);
        }
        folders = below;
    }
    Err(Problem::NoModel)
}

/// The archive that `path` leads into, and the path in it; `None` for other paths.
fn archive_of(path: &Path) -> Option<(&Path, Option<String>)> {
    let archive = path.ancestors().find(|path| has_ending(path, &["zip"]) && path.is_file())?;
    let within = path.strip_prefix(archive).ok().filter(|within| !within.as_os_str().is_empty());
    Some((archive, within.map(|within| within.to_string_lossy().into_owned())))
}

fn open_archived(path: &Path, named: Option<String>) -> Result<Opened, Problem> {
    let archive = Archive::open(path)?;
    let model = match named {
        Some(name) => inside(&name).ok_or(Problem::NoModel)?,
        None => {
            let mut models: Vec<(usize, &str)> = archive.names().filter(|name| may_be_model(name)).map(depth).collect();
            models.sort_unstable();
            let nearest = models.first().map(|(depth, _)| *depth);
            let models = models.iter().filter(|(depth, _)| Some(*depth) == nearest);
            let found = only(models.map(|(_, name)| path.join(name)).collect())?.ok_or(Problem::NoModel)?;
            found.strip_prefix(path).unwrap_or(&found).to_string_lossy().into_owned()
        }
    };
    let bytes = archive.read(&model).map_err(|source| Problem::Archive(format!("{model}: {source}")))?;
    let folder = model.rsplit_once('/').map_or(String::new(), |(folder, _)| folder.to_owned());
    Ok(Opened { path: path.to_owned(), name: stem(path), bytes, place: Place::Archive(Arc::new(archive), folder) })
}

/// The one of these models, if there is one.
///
/// # Errors
/// There are several.
fn only(mut models: Vec<PathBuf>) -> Result<Option<PathBuf>, Problem> {
    if models.len() < 2 {
        return Ok(models.pop());
    }
    models.sort();
    let count = models.len();
    let mut names: Vec<String> = models.iter().take(MOST_NAMED).map(|path| path.display().to_string()).collect();
    if count > MOST_NAMED {
        names.push(format!("and {} more", count - MOST_NAMED));
    }
    Err(Problem::SeveralModels { count, names: names.join(", ") })
}

/// A path in an archive after the number of folders above it.
fn depth(name: &str) -> (usize, &str) {
    (name.matches('/').count(), name)
}

fn may_be_model(name: &str) -> bool {
    is_model(Path::new(name)) && !Path::new(name).iter().any(|part| is_hidden(Path::new(part)) || part == "__MACOSX")
}

fn is_model(path: &Path) -> bool {
    has_ending(path, &["gltf", "glb"])
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|found| endings.iter().any(|ending| found.eq_ignore_ascii_case(ending)))
}

fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
