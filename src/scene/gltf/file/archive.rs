//! Reads files out of a zip archive, in memory.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::{Component, Path};
use std::sync::Mutex;

use zip::ZipArchive;

use crate::regular_file;
use crate::scene::error::Problem;

/// Maximum number of files of an archive.
const MOST_FILES: usize = 100_000;
/// Maximum size of a file, unpacked.
const MOST_BYTES: u64 = 4 << 30;
/// Larger files must not unpack to more than [`MOST_TIMES`] their packed size: they are made to fill the memory.
const SUSPICIOUS: u64 = 64 << 20;
/// Geometry and textures get at most some ten times smaller.
const MOST_TIMES: u64 = 250;

/// A zip archive.
pub struct Archive {
    reader: Mutex<ZipArchive<BufReader<File>>>,
    /// The files, by their paths from the archive's root.
    files: HashMap<String, usize>,
}

impl Archive {
    /// Reads the directory of an archive.
    ///
    /// # Errors
    /// The file cannot be read, or is no zip archive.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        let file = regular_file::open(path).map_err(Problem::Read)?.into_inner();
        let archive = ZipArchive::new(BufReader::new(file)).map_err(|error| Problem::Archive(error.to_string()))?;
        if archive.len() > MOST_FILES {
            return Err(Problem::Archive(format!("it has {} files; at most {MOST_FILES} are read", archive.len())));
        }
        let named = |index: usize| Some((inside(archive.name_for_index(index)?)?, index));
        let files = (0..archive.len()).filter_map(named).collect();
        Ok(Self { files, reader: Mutex::new(archive) })
    }

    /// Paths of the files from the archive's root, in any order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Whether it has a file.
    pub fn has(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Bytes that a file unpacks to, as it says; 0 if it is not there.
    pub fn size(&self, name: &str) -> u64 {
        let mut archive = self.reader.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let entry = self.files.get(name).and_then(|index| archive.by_index_raw(*index).ok());
        entry.map_or(0, |entry| entry.size())
    }

    /// Unpacks a file.
    ///
    /// # Errors
    /// It is not there, is damaged or encrypted, or too large.
    pub fn read(&self, name: &str) -> std::io::Result<Vec<u8>> {
        let index = *self.files.get(name).ok_or(std::io::ErrorKind::NotFound)?;
        // A panic of another thread leaves the archive readable: each read seeks first.
        let mut archive = self.reader.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let mut entry = archive.by_index(index).map_err(std::io::Error::other)?;
        let (size, packed) = (entry.size(), entry.compressed_size());
        if size > MOST_BYTES || (size > SUSPICIOUS && size / MOST_TIMES > packed) {
            let found = format!("it unpacks from {packed} to {size} bytes, which is more than Specula reads");
            return Err(std::io::Error::other(found));
        }
        let mut bytes = Vec::new();
        if !usize::try_from(size).is_ok_and(|size| bytes.try_reserve_exact(size).is_ok()) {
            return Err(std::io::Error::other(format!("it has {size} bytes, for which there is not enough memory")));
        }
        entry.by_ref().take(size).read_to_end(&mut bytes)?;
        // The end of the packed data, where its checksum is compared, and which must not be further than it says.
        match entry.read(&mut [0])? {
            0 if bytes.len() as u64 == size => Ok(bytes),
            _ => Err(std::io::Error::other(format!("it does not unpack to its {size} bytes"))),
        }
    }
}

/// A path from the archive's root without `.` and `..`; `None` if it leads out of it or is that of a folder.
pub fn inside(path: &str) -> Option<String> {
    if path.ends_with(['/', '\\']) {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    let path = path.replace('\\', "/");
    for part in Path::new(&path).components() {
        match part {
            Component::Normal(name) => parts.push(name.to_str()?),
            Component::CurDir => {}
            Component::ParentDir => drop(parts.pop()?),
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}
