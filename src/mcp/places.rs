//! Where an agent may write: files of the shader tree, and the output folder.

use std::fs::{self, DirBuilder};
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Endings of files that a shader tree consists of; the last one is that of a single file of another playground.
const SHADERS: [&str; 10] = ["glsl", "vert", "frag", "comp", "geom", "tesc", "tese", "mesh", "task", "fs"];

/// The path of a file below a folder.
///
/// # Errors
/// A message: the name is absolute, leads out of the folder by `..` or by a link, or is hidden.
pub fn below(root: &Path, name: &str) -> Result<PathBuf, String> {
    let refused = |why: &str| Err(format!("`{name}` {why}: name a file below {}, such as a/b.png", root.display()));
    if name.is_empty() || name.contains(['\0', '\\']) {
        return refused("is no name");
    }
    for part in Path::new(name).components() {
        match part {
            Component::Normal(part) if part.as_encoded_bytes().starts_with(b".") => return refused("is hidden"),
            Component::Normal(_) => {}
            _ => return refused("is absolute, or leads out of its folder"),
        }
    }
    let file = root.join(name);
    // A link to a file that is not there yet would be followed, too.
    let inside =
        |part: &Path| part.canonicalize().and_then(|part| Ok(part.starts_with(root.canonicalize()?))).unwrap_or(false);
    let mut parts = file.ancestors().take_while(|part| *part != root);
    match parts.any(|part| part.is_symlink() && !inside(part)) {
        true => refused("leads out of its folder by a link"),
        false => Ok(file),
    }
}

/// The path of a file of a shader tree.
///
/// # Errors
/// As [`below`]; its ending is not that of a shader.
pub fn of_tree(root: &Path, name: &str) -> Result<PathBuf, String> {
    let file = below(root, name)?;
    let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    match SHADERS.contains(&ending) {
        true => Ok(file),
        false => Err(format!("`{name}` is no shader: its ending is one of {}", SHADERS.join(", "))),
    }
}

/// The output folder, and a private one for pictures on their way to the client.
pub struct Places {
    /// The output folder, if there is one.
    pub out: Option<PathBuf>,
    temporary: PathBuf,
    pictures: AtomicU64,
    passing: AtomicU64,
}

/// Pictures that are kept for comparisons.
const KEPT: u64 = 32;

/// The private folder of this process, for a signal that ends it.
static TEMPORARY: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Removes the private folder of this process, which is about to end.
pub fn remove_temporary() {
    if let Some(folder) = TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).take() {
        let _ = fs::remove_dir_all(folder);
    }
}

impl Places {
    /// Makes the private folder, and the output folder if it is not there.
    ///
    /// # Errors
    /// One of them cannot be made.
    pub fn new(out: Option<PathBuf>) -> io::Result<Self> {
        let out = out.map(|out| fs::create_dir_all(&out).and_then(|()| out.canonicalize())).transpose()?;
        let in_memory = [std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from), Some(PathBuf::from("/dev/shm"))];
        let parent = in_memory.into_iter().flatten().find(|path| path.is_dir()).unwrap_or_else(std::env::temp_dir);
        remove_abandoned(&parent);
        let temporary = make_private(&parent)?;
        *TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner) = Some(temporary.clone());
        Ok(Self { out, temporary, pictures: AtomicU64::new(1), passing: AtomicU64::new(1) })
    }

    /// A number and a path for a new picture. An old one goes.
    pub fn new_picture(&self) -> (u64, PathBuf) {
        let number = self.pictures.fetch_add(1, Ordering::SeqCst);
        if let Some(old) = number.checked_sub(KEPT) {
            let _ = fs::remove_file(self.picture(old));
        }
        (number, self.picture(number))
    }

    /// The path of a picture that was drawn.
    pub fn picture(&self, number: u64) -> PathBuf {
        self.temporary.join(format!("{number}.png"))
    }

    /// A path for a file that the caller removes.
    pub fn passing(&self, ending: &str) -> PathBuf {
        self.temporary.join(format!("p{}.{ending}", self.passing.fetch_add(1, Ordering::SeqCst)))
    }

    /// The path of a file in the output folder, which need not be there.
    ///
    /// # Errors
    /// There is no output folder; as [`below`].
    pub fn output(&self, name: &str) -> Result<PathBuf, String> {
        let none = "files cannot be written: specula mcp was started without --out-folder DIR";
        below(self.out.as_deref().ok_or(none)?, name)
    }
}

impl Drop for Places {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.temporary);
        TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner).take_if(|folder| *folder == self.temporary);
    }
}

/// A new folder that only the user can enter.
fn make_private(parent: &Path) -> io::Result<PathBuf> {
    let mut builder = DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    // A folder of an earlier process with this number belongs to somebody else, or its removal failed.
    let names = (0..100).map(|attempt| parent.join(format!("specula-mcp-{}-{attempt}", std::process::id())));
    let mut result = Err(io::ErrorKind::AlreadyExists.into());
    for path in names {
        result = builder.create(&path).map(|()| path);
        if !matches!(&result, Err(error) if error.kind() == io::ErrorKind::AlreadyExists) {
            break;
        }
    }
    result
}

/// Removes the folders of processes that were killed.
fn remove_abandoned(parent: &Path) {
    let has_ended = |folder: &Path| {
        let name = folder.file_name()?.to_str()?.strip_prefix("specula-mcp-")?;
        let process: u32 = name.split_once('-')?.0.parse().ok()?;
        Some(Path::new("/proc/self").exists() && !Path::new(&format!("/proc/{process}")).exists())
    };
    let folders = fs::read_dir(parent).into_iter().flatten().flatten().map(|entry| entry.path());
    folders.filter(|folder| !folder.is_symlink() && has_ended(folder) == Some(true)).for_each(|folder| {
        let _ = fs::remove_dir_all(folder);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_below_their_folder() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        fs::create_dir(root.join("a")).unwrap();
        assert_eq!(below(root, "a/b.png"), Ok(root.join("a/b.png")));
        for name in
            ["", "/etc/passwd", "../b.png", "a/../../b.png", "a/./../../b", ".git/hooks/x", "a\\..\\b", "a\0b", "./b"]
        {
            assert!(below(root, name).is_err(), "{name}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_out() {
        use std::os::unix::fs::symlink;
        let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let root = folder.path();
        fs::create_dir(root.join("inner")).unwrap();
        symlink(root.join("inner"), root.join("in")).unwrap();
        symlink(other.path(), root.join("out")).unwrap();
        symlink(other.path().join("new.png"), root.join("dangling.png")).unwrap();
        assert!(below(root, "in/a.png").is_ok());
        assert!(below(root, "out/a.png").is_err() && below(root, "dangling.png").is_err());
    }

    #[test]
    fn only_shaders_are_files_of_a_tree() {
        let folder = tempfile::tempdir().unwrap();
        assert!(of_tree(folder.path(), "brdf/ndf.glsl").is_ok() && of_tree(folder.path(), "passes/a.frag").is_ok());
        assert!(of_tree(folder.path(), "Makefile").is_err() && of_tree(folder.path(), "a.sh").is_err());
    }

    #[test]
    fn the_private_folder_ends_with_its_value() {
        let places = Places::new(None).unwrap();
        let (number, path) = places.new_picture();
        fs::write(&path, "").unwrap();
        assert_eq!(path, places.picture(number));
        assert!(places.output("a.png").is_err());
        drop(places);
        assert!(!path.parent().unwrap().exists());
    }
}
