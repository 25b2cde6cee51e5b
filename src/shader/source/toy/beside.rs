//! The files beside a toy, as suggestions for a name that does not exist.

use std::path::Path;

use crate::message::{best, likeness};
use crate::shader::source::pattern::Pattern;
use crate::shader::source::read::names_in;

/// Names of images that are no files.
const SPECIAL: [&str; 2] = ["self", "keyboard"];
/// The endings of files that a channel can name.
const ENDINGS: [&str; 9] = ["png", "jpg", "jpeg", "hdr", "exr", "cube", "glsl", "frag", "fs"];
/// Files that a help text lists at most.
const LISTED: usize = 12;

/// Whether a file exists, or with a `*` in its name one of several.
pub(super) fn is_there(folder: &Path, file: &str) -> bool {
    match Pattern::of(file) {
        Some(pattern) => names_in(&folder_of(folder, file).1).iter().any(|name| pattern.part(name).is_some()),
        None => folder.join(file).exists(),
    }
}

/// A message and a help text about a file that does not exist. `name`: as the author writes it.
pub(super) fn not_found(folder: &Path, name: &str, file: &str) -> (String, String) {
    let (prefix, inside) = folder_of(folder, file);
    let mut files: Vec<String> = names_in(&inside).into_iter().filter(|name| can_be_named(name)).collect();
    files.sort();
    let files: Vec<String> = files.into_iter().map(|name| format!("{prefix}{name}")).collect();
    let like = |candidate: &str| likeness(stem(file), stem(candidate));
    let candidates = SPECIAL.into_iter().chain(files.iter().map(String::as_str));
    let hint = best(candidates.map(|candidate| (like(candidate), candidate)));
    let hint = hint.map(|name| format!(" Did you mean \"{name}\"?")).unwrap_or_default();
    let message = format!("\"{name}\" not found in {}.{hint}", folder.display());
    let mut listed: Vec<String> = files.iter().take(LISTED).map(|name| format!("\"{name}\"")).collect();
    if files.len() > LISTED {
        listed.push(format!("{} more files", files.len() - LISTED));
    }
    let listed = if listed.is_empty() { "no images or shaders".to_owned() } else { listed.join(", ") };
    let help = format!("there are {listed}; \"self\", what this file drew one frame ago, and \"keyboard\", its keys");
    (message, help)
}

/// The folder part of a name, with its slash, and that folder.
fn folder_of(folder: &Path, file: &str) -> (String, std::path::PathBuf) {
    match file.rsplit_once('/') {
        Some((inside, _)) => (format!("{inside}/"), folder.join(inside)),
        None => (String::new(), folder.to_owned()),
    }
}

fn can_be_named(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    ENDINGS.iter().any(|known| known.eq_ignore_ascii_case(ending))
}

/// A name without its ending, so that names with the same ending are not alike for that.
fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
