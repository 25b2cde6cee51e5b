//! Results on disk that take long to make, in a folder for each kind: what bakes compute, compiled stages, the driver's pipelines.
//!
//! The folders are in `$SPECULA_CACHE`, or in `specula` of the user's cache folder. A name is the hash of all inputs of an entry, so an
//! entry is never stale; it ends in a hash of itself, so a damaged one counts as absent. Beyond 512 MiB the oldest of a folder are removed.
//! Only the user can read the files.

use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use crate::regular_file;

/// Size of a folder in bytes. Beyond it, the oldest entries are deleted.
const MOST_BYTES: u64 = 512 << 20;
const BAKED: &str = "baked";
const ENDING: &str = "bake";
/// Ends the names of files that are being written.
const PART: &str = "part";
/// The process that has begun to write a file longer ago has ended without finishing it.
const LONGEST_WRITE: Duration = Duration::from_secs(3600);
/// Bytes of the checksum at the end of a file: XXH3 of the rest.
const CHECKSUM: u64 = 8;

/// The name of an entry: a hash of all its inputs and of Specula's version.
pub(crate) fn key(parts: &[&[u8]]) -> String {
    let mut hasher = Xxh3::new();
    hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    format!("{:032x}", hasher.digest128())
}

/// The folder `name` in `$SPECULA_CACHE` or in `specula` of the user's cache folder. `None` without a home folder.
fn folder(name: &str) -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = set("SPECULA_CACHE")
        .or_else(|| set("XDG_CACHE_HOME").map(|p| p.join("specula")))
        .or_else(|| set("HOME").map(|p| p.join(".cache/specula")))?;
    Some(base.join(name))
}

fn file(folder: &Path, key: &str) -> PathBuf {
    folder.join(format!("{key}.{ENDING}"))
}

/// An entry of the folder `name`. One with a wrong checksum counts as absent.
pub(crate) fn read(name: &str, key: &str) -> Option<Vec<u8>> {
    read_from(&folder(name)?, key)
}

fn read_from(folder: &Path, key: &str) -> Option<Vec<u8>> {
    let mut bytes = regular_file::read(&file(folder, key), MOST_BYTES).ok()?;
    let end = bytes.len().checked_sub(CHECKSUM as usize)?;
    let is_whole = bytes[end..] == xxh3_64(&bytes[..end]).to_le_bytes();
    bytes.truncate(end);
    is_whole.then_some(bytes)
}

/// A baked entry of exactly `size` bytes.
pub(crate) fn load(key: &str, size: u64) -> Option<Vec<u8>> {
    contains(key, size).then(|| read(BAKED, key)).flatten().filter(|bytes| bytes.len() as u64 == size)
}

/// Whether [`load`] will find an entry of this size, unless it is damaged.
pub(crate) fn contains(key: &str, size: u64) -> bool {
    let metadata = folder(BAKED).and_then(|folder| std::fs::metadata(file(&folder, key)).ok());
    metadata.is_some_and(|metadata| metadata.len() == size + CHECKSUM)
}

/// Stores a baked entry.
pub(crate) fn store(key: &str, bytes: &[u8]) {
    store_in(BAKED, key, bytes);
}

/// Stores an entry in the folder `name`. A failure costs only time, so it is traced and not reported.
pub(crate) fn store_in(name: &str, key: &str, bytes: &[u8]) {
    let Some(folder) = folder(name) else { return };
    if let Err(error) = write(&folder, key, bytes) {
        tracing::debug!("{}: the cache was not written: {error}", folder.display());
    }
}

fn write(folder: &Path, key: &str, bytes: &[u8]) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    // Another process may read the entry at the same time, so it must appear complete.
    // Two threads may write the same entry.
    static WRITES: AtomicU64 = AtomicU64::new(0);
    let number = WRITES.fetch_add(1, Ordering::Relaxed);
    let temporary = folder.join(format!("{key}.{}-{number}.{PART}", std::process::id()));
    let mut file_of_part = regular_file::create_private(&temporary)?;
    file_of_part.write_all(bytes)?;
    file_of_part.write_all(&xxh3_64(bytes).to_le_bytes())?;
    drop(file_of_part);
    std::fs::rename(&temporary, file(folder, key))?;
    prune(folder)
}

/// Deletes the oldest entries of a cache that is too large, and what ended processes have left unfinished. Other processes may delete
/// files at the same time.
fn prune(folder: &Path) -> std::io::Result<()> {
    let mut entries: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
    for entry in std::fs::read_dir(folder)?.flatten() {
        let path = entry.path();
        let Ok(metadata) = std::fs::metadata(&path) else { continue };
        let modified = metadata.modified()?;
        match path.extension().and_then(OsStr::to_str) {
            Some(ENDING) => entries.push((modified, metadata.len(), path)),
            Some(PART) if modified.elapsed().is_ok_and(|age| age > LONGEST_WRITE) => _ = std::fs::remove_file(path),
            _ => {}
        }
    }
    entries.sort();
    let mut total: u64 = entries.iter().map(|(_, size, _)| size).sum();
    for (_, size, path) in entries {
        if total <= MOST_BYTES {
            break;
        }
        // A file that cannot be deleted, or that somebody else has deleted, must not keep the others.
        let _ = std::fs::remove_file(path);
        total -= size;
    }
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn pruning_survives_a_file_that_vanishes_and_deletes_unfinished_ones() {
        let folder = tempfile::tempdir().unwrap();
        let in_folder = |name: &str| folder.path().join(name);
        // A link to nothing: the folder lists it, but its metadata cannot be read, as of a file that was deleted meanwhile.
        std::os::unix::fs::symlink("nothing", in_folder("gone.bake")).unwrap();
        std::fs::write(in_folder("new.2.part"), "half").unwrap();
        let old = std::fs::File::create(in_folder("old.1.part")).unwrap();
        old.set_modified(SystemTime::UNIX_EPOCH).unwrap();
        write(folder.path(), "key", b"bytes").unwrap();
        assert_eq!(read_from(folder.path(), "key").unwrap(), b"bytes");
        use std::os::unix::fs::PermissionsExt as _;
        let mode = in_folder("key.bake").metadata().unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600, "others can read it");
        assert!(in_folder("new.2.part").exists(), "another process may be writing it");
        assert!(!in_folder("old.1.part").exists(), "an ended process has left it");
    }
}
