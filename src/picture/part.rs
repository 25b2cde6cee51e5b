//! Temporary files that take the name of a finished file, and their removal when a signal ends the program.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Temporary files of this process that exist at the moment, for the signal handler.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// While this value lives, no thread of the process creates another temporary file.
pub struct Halt {
    _unfinished: MutexGuard<'static, BTreeSet<PathBuf>>,
}

/// Removes all temporary files. For a program that a signal is about to end: keep the returned value until then.
pub fn remove_unfinished() -> Halt {
    let mut unfinished = lock();
    for path in std::mem::take(&mut *unfinished) {
        // Its writer may have just finished the file.
        let _ = fs::remove_file(path);
    }
    Halt { _unfinished: unfinished }
}

/// Replaces the content of `path`, all or nothing. The content is on the disk before the old file is removed.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = PartFile::create(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// A file that is written piece by piece under a temporary name. Dropped unfinished, it leaves no file.
pub struct PartFile {
    target: PathBuf,
    part: TemporaryFile,
    file: File,
}

impl PartFile {
    /// Creates the temporary file beside `path`.
    pub fn create(path: &Path) -> io::Result<Self> {
        let (part, file) = TemporaryFile::create(path)?;
        Ok(Self { target: path.to_owned(), part, file })
    }

    /// Renames the file to its name, once its content is on the disk.
    pub fn finish(self) -> io::Result<()> {
        match self.file.sync_all() {
            // Some file systems cannot sync. Others report only here that the disk is full.
            Err(error) if !matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => {
                Err(error)
            }
            _ => fs::rename(&self.part.0, &self.target),
        }
    }
}

impl Write for PartFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for PartFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// A temporary file, removed on drop unless it was renamed.
struct TemporaryFile(PathBuf);

impl TemporaryFile {
    fn create(path: &Path) -> io::Result<(Self, File)> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        // The lock is held while the file is created, so that a signal comes before that or finds the file in the list.
        let mut unfinished = lock();
        let mut part = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
        // Another thread may be writing a file of the same name.
        for number in 2.. {
            if !unfinished.contains(&part) {
                break;
            }
            part.set_file_name(format!(".{name}.{}-{number}.part", std::process::id()));
        }
        // An earlier process with the same number may have been killed. In a container, numbers repeat.
        let _ = fs::remove_file(&part);
        let file = OpenOptions::new().write(true).create_new(true).open(&part)?;
        unfinished.insert(part.clone());
        Ok((Self(part), file))
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        let mut unfinished = lock();
        let _ = fs::remove_file(&self.0);
        unfinished.remove(&self.0);
    }
}

fn lock() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Held by each test: removing unfinished files removes those of all threads.
    static ALONE: Mutex<()> = Mutex::new(());

    #[test]
    fn unfinished_files_are_removed() {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let directory = tempfile::tempdir().unwrap();
        let target = directory.path().join("picture.png");
        replace(&target, b"old").unwrap();
        let (part, mut file) = TemporaryFile::create(&target).unwrap();
        file.write_all(b"new").unwrap();
        drop(remove_unfinished());
        assert!(!part.0.exists());
        assert_eq!(fs::read(&target).unwrap(), b"old");
        drop(part);
        replace(&target, b"newer").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"newer");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn two_writers_of_one_name_do_not_mix() {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let directory = tempfile::tempdir().unwrap();
        let target = directory.path().join("spin.mp4");
        let mut first = PartFile::create(&target).unwrap();
        first.write_all(b"first").unwrap();
        replace(&target, b"second").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"second");
        let third = PartFile::create(&target).unwrap();
        first.finish().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"first");
        drop(third);
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn the_file_of_a_killed_process_is_replaced() {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let directory = tempfile::tempdir().unwrap();
        let target = directory.path().join("picture.png");
        let left = directory.path().join(format!(".picture.png.{}.part", std::process::id()));
        fs::write(&left, b"half").unwrap();
        replace(&target, b"whole").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"whole");
        assert!(!left.exists());
    }
}
