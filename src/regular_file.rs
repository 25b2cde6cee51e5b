//! Opens files that the user or a file names, and creates files for the user alone. Opening or reading a pipe or a device might never end, so
//! both are refused before they are opened. A file of the kernel, such as /proc/kmsg, claims to be a regular one of size 0, so no more bytes
//! are read than a file claims to have.

use std::fs::{File, OpenOptions, metadata, remove_file};
use std::io::{Error, Read as _, Result, Take};
use std::path::Path;

/// Size limit of a file of text, such as a look.
pub(crate) const LONGEST_TEXT: u64 = 2 << 20;
/// Size limit of a model, a file of its data, or a picture.
pub(crate) const LARGEST: u64 = 16 << 30;

/// Opens a regular file. The limit of the returned value is its size.
///
/// # Errors
/// The file cannot be opened, or is a folder, a pipe or a device.
pub(crate) fn open(path: &Path) -> Result<Take<File>> {
    let metadata = metadata(path)?;
    if !metadata.is_file() {
        return Err(Error::other("it is not a regular file"));
    }
    Ok(File::open(path)?.take(metadata.len()))
}

/// Reads a regular file of at most `most` bytes.
///
/// # Errors
/// As [`open`], or the file is larger, or larger than the memory.
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let mut file = open(path)?;
    let size = file.limit();
    if size > most {
        return Err(Error::other(format!("it has {size} bytes; Specula reads at most {most}")));
    }
    let mut bytes = Vec::new();
    let reserved = usize::try_from(size).is_ok_and(|size| bytes.try_reserve_exact(size).is_ok());
    if !reserved {
        return Err(Error::other(format!("it has {size} bytes, for which there is not enough memory")));
    }
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a regular file as text.
///
/// # Errors
/// As [`read`] with [`LONGEST_TEXT`], or the content is not UTF-8.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    String::from_utf8(read(path, LONGEST_TEXT)?).map_err(|_| Error::other("it is not UTF-8 text"))
}

/// Creates a file that only the user can read and write, in place of one that an ended process has left.
///
/// # Errors
/// The system's.
pub(crate) fn create_private(path: &Path) -> Result<File> {
    let _ = remove_file(path);
    let mut options = OpenOptions::new();
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.write(true).create_new(true).open(path)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_the_kernel_is_empty_and_a_sparse_one_is_refused() {
        assert_eq!(read(Path::new("/proc/self/environ"), LARGEST).unwrap(), b"");
        let sparse = tempfile::NamedTempFile::new().unwrap();
        sparse.as_file().set_len(1 << 40).unwrap();
        let error = read(sparse.path(), LARGEST).unwrap_err().to_string();
        assert_eq!(error, "it has 1099511627776 bytes; Specula reads at most 17179869184");
    }
}
