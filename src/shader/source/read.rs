//! Reads files of a tree on disk, and says why one cannot be used.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use super::error::{MAX_FILE_BYTES, SourceError};

/// The names of the files in a directory, without hidden files.
pub(super) fn names_in(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let files = entries.filter(|entry| entry.path().is_file());
    let names = files.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|name| !name.starts_with('.')).collect()
}

/// The text of a file below `root`.
pub(super) fn read_file(root: &Path, path: &str) -> Result<String, SourceError> {
    check_text(read_bytes(root, path, MAX_FILE_BYTES)?)
}

/// The bytes of a file below `root`.
pub(super) fn read_bytes(root: &Path, path: &str, most: u64) -> Result<Vec<u8>, SourceError> {
    let file = root.join(path);
    let size = size_of(&file, most)?;
    if leads_out(root, path) { Err(SourceError::Outside) } else { load(&file, size) }
}

/// The bytes of a file that the user has named.
pub(super) fn read_anywhere(path: &Path, most: u64) -> Result<Vec<u8>, SourceError> {
    load(path, size_of(path, most)?)
}

/// Whether symbolic links lead a path below `root` out of it. Most paths have no link on the way, which costs one call of the system for each
/// part.
pub fn leads_out(root: &Path, path: &str) -> bool {
    let file = root.join(path);
    let parts = file.ancestors().take_while(|part| *part != root);
    if !parts.into_iter().any(Path::is_symlink) {
        return false;
    }
    let ends = file.canonicalize().and_then(|file| Ok(file.starts_with(root.canonicalize()?)));
    ends.is_ok_and(|is_inside| !is_inside)
}

/// The size of a regular file of at most `most` bytes.
fn size_of(path: &Path, most: u64) -> Result<u64, SourceError> {
    let metadata = std::fs::metadata(path).map_err(io_error)?;
    match metadata.len() {
        _ if metadata.is_dir() => Err(SourceError::Directory),
        _ if !metadata.is_file() => Err(SourceError::Io("not a regular file".to_owned())),
        bytes if bytes > most => Err(SourceError::TooBig { bytes, most }),
        bytes => Ok(bytes),
    }
}

/// Reads `size` bytes of a file, and no more: a file of the kernel claims to be empty, and reading it might never end.
fn load(path: &Path, size: u64) -> Result<Vec<u8>, SourceError> {
    let mut bytes = Vec::with_capacity(size as usize);
    File::open(path).and_then(|file| file.take(size).read_to_end(&mut bytes)).map_err(io_error)?;
    Ok(bytes)
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
    let text = match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    };
    // Line breaks of an old Mac, which only the compiler would know.
    Ok(if text.contains('\r') && !text.contains('\n') { text.replace('\r', "\n") } else { text })
}

/// Whether a directory looks like a Specula shader tree: it holds an `interface.glsl`.
pub fn is_specula_tree(directory: &Path) -> bool {
    directory.join("interface.glsl").is_file()
}
