//! Opens files that the user names. Opening or reading a pipe or a device might never end, so both are refused before they are opened.

use std::fs::{File, metadata};
use std::io::{Error, Read as _, Result};
use std::path::Path;

/// Opens a regular file.
///
/// # Errors
/// The file cannot be opened, or is a folder, a pipe or a device.
pub(crate) fn open(path: &Path) -> Result<File> {
    if metadata(path)?.is_file() { File::open(path) } else { Err(Error::other("it is not a regular file")) }
}

/// Reads a regular file of at most `most` bytes.
///
/// # Errors
/// As [`open`], or the file is larger.
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let mut file = open(path)?;
    let size = file.metadata()?.len();
    if size > most {
        return Err(Error::other(format!("it has {size} bytes; Specula reads at most {most}")));
    }
    let mut bytes = Vec::with_capacity(size as usize);
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a regular file as text.
///
/// # Errors
/// As [`open`], or the content is not UTF-8.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    std::io::read_to_string(open(path)?)
}
