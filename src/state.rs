//! Files between two runs: `specula` in the user's folder for state.

use std::path::PathBuf;

/// `$XDG_STATE_HOME/specula/NAME`, or the same in `~/.local/state`. `None` without a home folder.
fn file(name: &str) -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = set("XDG_STATE_HOME").or_else(|| set("HOME").map(|home| home.join(".local/state")))?;
    Some(base.join("specula").join(name))
}

/// The text of a file, if it exists and can be read.
pub(crate) fn load(name: &str) -> Option<String> {
    std::fs::read_to_string(file(name)?).ok()
}

/// Writes a file. A failure costs only what the file stores, so it is logged and not reported.
pub(crate) fn save(name: &str, text: &str) {
    let Some(path) = file(name) else { return };
    let written = || -> std::io::Result<()> {
        std::fs::create_dir_all(path.parent().unwrap_or(&path))?;
        // Another window may read the file.
        let new = path.with_extension(format!("{}.new", std::process::id()));
        std::fs::write(&new, text)?;
        std::fs::rename(&new, &path)
    };
    if let Err(error) = written() {
        tracing::debug!("{} was not stored: {error}", path.display());
    }
}
