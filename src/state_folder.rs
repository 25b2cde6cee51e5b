//! Files between two runs: `specula` in the user's folder for state. They name the user's paths, so only the user can read them.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::regular_file;

/// `$XDG_STATE_HOME/specula/NAME`, or the same in `~/.local/state`. `None` without a home folder.
fn file(name: &str) -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = set("XDG_STATE_HOME").or_else(|| set("HOME").map(|home| home.join(".local/state")))?;
    Some(base.join("specula").join(name))
}

/// The folder of texts that were typed and not saved when a session ended for good. `None` without a home folder.
pub(crate) fn unsaved_texts() -> Option<PathBuf> {
    file("unsaved")
}

/// The text of a file, if it exists and can be read.
pub(crate) fn load(name: &str) -> Option<String> {
    regular_file::read_text(&file(name)?).ok()
}

/// Writes a file. A failure costs only what the file stores, so it is logged and not reported.
pub(crate) fn save(name: &str, text: &str) {
    store(name, |_| Ok(text.to_owned()));
}

/// Changes a JSON file to which other windows write, too: applies `change` to the stored value. A file that cannot be read counts as the
/// default. Failures as in [`save`].
pub(crate) fn change<T: Default + Serialize + DeserializeOwned>(name: &str, change: impl FnOnce(&mut T)) {
    store(name, |text| {
        let mut value = text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        change(&mut value);
        // A path that is not UTF-8 cannot be stored.
        Ok(serde_json::to_string(&value)?)
    });
}

fn store(name: &str, new_text: impl FnOnce(Option<String>) -> io::Result<String>) {
    let Some(path) = file(name) else { return };
    if let Err(error) = rewrite(&path, new_text) {
        tracing::debug!("{} was not stored: {error}", path.display());
    }
}

/// Replaces the text of a file. Other processes wait between the reading and the writing, so no change is lost, and they never read half
/// a file.
fn rewrite(path: &Path, new_text: impl FnOnce(Option<String>) -> io::Result<String>) -> io::Result<()> {
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    let lock = fs::File::create(path.with_extension("lock"))?;
    // Some file systems have no locks. The file is still replaced as a whole.
    if let Err(error) = lock.lock() {
        tracing::debug!("{} is not locked: {error}", path.display());
    }
    let new = path.with_extension("new");
    regular_file::create_private(&new)?.write_all(new_text(regular_file::read_text(path).ok())?.as_bytes())?;
    fs::rename(&new, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_change_of_many_writers_is_lost() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("specula/count.json");
        let add_one = |text: Option<String>| {
            let count = text.map_or(0, |text| text.parse::<u32>().unwrap());
            Ok((count + 1).to_string())
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..50).for_each(|_| rewrite(&path, add_one).unwrap()));
            }
        });
        assert_eq!(fs::read_to_string(&path).unwrap(), "200");
        #[cfg(unix)]
        assert_eq!(std::os::unix::fs::PermissionsExt::mode(&path.metadata().unwrap().permissions()) & 0o777, 0o600);
    }
}
