//! The files in the folder of a session.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Where a file is written before it gets its name.
pub(super) fn unfinished(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.unfinished"))
}

/// A record of a session's folder; `None` if there is none that can be read.
pub(super) fn read<T: DeserializeOwned>(folder: &Path, name: &str) -> Option<T> {
    serde_json::from_slice(&fs::read(folder.join(name)).ok()?).ok()
}

/// Writes a file whole or not at all: the process may crash at any moment.
pub(super) fn write(folder: &Path, name: &str, value: &impl Serialize) -> io::Result<()> {
    let unfinished = unfinished(folder, name);
    fs::write(&unfinished, serde_json::to_vec(value)?)?;
    fs::rename(unfinished, folder.join(name))
}
