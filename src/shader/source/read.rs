//! Reads files of a tree on disk, and says why one cannot be used.

use std::io;
use std::path::Path;

use super::error::{MAX_FILE_BYTES, SourceError};

/// The names of the files in a directory, without hidden files.
pub(super) fn names_in(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let files = entries.filter(|entry| entry.path().is_file());
    let names = files.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|name| !name.starts_with('.')).collect()
}

pub(super) fn read_file(path: &Path) -> Result<String, SourceError> {
    check_text(read_bytes(path, MAX_FILE_BYTES)?)
}

pub(super) fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, SourceError> {
    let metadata = std::fs::metadata(path).map_err(io_error)?;
    if metadata.is_dir() {
        return Err(SourceError::Directory);
    }
    if !metadata.is_file() {
        return Err(SourceError::Io("not a regular file".to_owned()));
    }
    if metadata.len() > most {
        return Err(SourceError::TooBig { bytes: metadata.len(), most });
    }
    std::fs::read(path).map_err(io_error)
}

fn io_error(error: io::Error) -> SourceError {
    match error.kind() {
        // NotADirectory means that a part of the path is a file. For the user, the path does not exist.
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => SourceError::Missing,
        io::ErrorKind::IsADirectory => SourceError::Directory,
        _ => SourceError::Io(error.to_string()),
    }
}

pub(super) fn check_text(bytes: Vec<u8>) -> Result<String, SourceError> {
    let line_of = |offset: usize, bytes: &[u8]| {
        1 + u32::try_from(bytes[..offset].iter().filter(|byte| **byte == b'\n').count()).unwrap_or(u32::MAX - 1)
    };
    if let Some(offset) = bytes.iter().position(|byte| *byte == 0) {
        return Err(SourceError::Nul { line: line_of(offset, &bytes) });
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let line = line_of(error.utf8_error().valid_up_to(), error.as_bytes());
        SourceError::NotUtf8 { line }
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

/// Whether a directory looks like a Specula shader tree: it holds an `interface.glsl`.
pub fn is_specula_tree(directory: &Path) -> bool {
    directory.join("interface.glsl").is_file()
}
