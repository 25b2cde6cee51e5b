//! The files beside a toy, as suggestions for a name that does not exist.

use std::path::{Path, PathBuf};

use super::channel::SHADERS;
use crate::message::{best, likeness};
use crate::shader::source::pattern::Pattern;
use crate::shader::source::read::names_in;

/// Names of images that are not files.
const SPECIAL: [&str; 2] = ["self", "keyboard"];
/// The extensions of files that a channel can name.
const ENDINGS: [&str; 9] = ["png", "jpg", "jpeg", "hdr", "exr", "cube", "glsl", "frag", "fs"];
/// Most files that a help text lists.
const LISTED: usize = 8;

/// Whether a file exists, or with a `*` in its name one of several.
pub(super) fn is_there(folder: &Path, file: &str) -> bool {
    match Pattern::of(file) {
        Some(pattern) => names_in(&folder_of(folder, file).1).iter().any(|name| pattern.part(name).is_some()),
        None => folder.join(file).exists(),
    }
}

/// A message and a help text about a file that does not exist. `name`: as the author writes it in the file `own`.
pub(super) fn not_found(folder: &Path, own: &str, name: &str, file: &str) -> (String, String) {
    let (prefix, inside) = folder_of(folder, file);
    let names = names_in(&inside).into_iter().filter(|name| can_be_named(name));
    let mut files: Vec<String> = names.map(|name| format!("{prefix}{name}")).filter(|name| name != own).collect();
    // Images first, or shaders if the name is one.
    files.sort_by_cached_key(|other| (is_shader(other) != is_shader(file), other.clone()));
    let like = |candidate: &str| likeness(stem(file), stem(candidate));
    let special = best(SPECIAL.into_iter().map(|name| (like(name), name)));
    let beside = best(files.iter().map(|name| (like(name), name.as_str())));
    // A name without an extension is hardly that of a file.
    let hint = if file.contains('.') { beside.or(special) } else { special.or(beside) };
    let hint = hint.map(|name| format!(" Did you mean \"{name}\"?")).unwrap_or_default();
    let message = format!("\"{name}\" not found in {}.{hint}", folder.display());
    let mut listed: Vec<String> = files.iter().take(LISTED).map(|name| format!("\"{name}\"")).collect();
    if files.len() > LISTED {
        listed.push(format!("{} more files", files.len() - LISTED));
    }
    let listed = if listed.is_empty() { "no images or other shaders".to_owned() } else { listed.join(", ") };
    let help = format!("there are {listed}; \"self\", what this file drew one frame ago, and \"keyboard\", its keys");
    (message, help)
}

/// The folder part of a name, with its slash, and that folder.
fn folder_of(folder: &Path, file: &str) -> (String, PathBuf) {
    match file.rsplit_once('/') {
        Some((inside, _)) => (format!("{inside}/"), folder.join(inside)),
        None => (String::new(), folder.to_owned()),
    }
}

fn is_shader(name: &str) -> bool {
    SHADERS.iter().any(|ending| name.ends_with(ending))
}

fn can_be_named(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    ENDINGS.iter().any(|known| known.eq_ignore_ascii_case(ending))
}

/// A name without its extension, so that a shared extension does not count as similarity.
fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
