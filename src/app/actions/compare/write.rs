//! Writes texts over files of a shader tree, and keeps what would be lost.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::actions::restored::show_newest;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::picture;
use crate::shader::{SourceError, TreePath, leads_out};
use crate::threads::Message;
use crate::write_back::Written;

/// Writes the texts of a version over the files that differ from it, on a thread of its own. A text on disk that was never shown, such
/// as an edit with an error, is kept beside its file.
pub(in crate::app) fn write_version(state: &mut State, engine: &mut Engine, number: u64) {
    let (files, known) = (state.files_of_version(number), state.texts_of_files());
    let Some((known, root)) = known.zip(state.source.root().map(Path::to_owned)) else { return };
    engine.threads.wait(move || {
        let shown = |path: &Path| {
            let path = path.strip_prefix(&root).ok()?.to_str()?;
            known.get(&TreePath::from(path)).cloned()
        };
        let files: Vec<_> = files.into_iter().map(|(path, text)| (shown(&path), path, text)).collect();
        let names: Vec<&str> = files.iter().filter_map(|(_, path, _)| path.file_name()?.to_str()).collect();
        let done = format!("Wrote version {number} of {}", names.join(", "));
        Some(Message::VersionWritten(number, write_files(&root, &files).map(|written| (done, written))))
    });
}

/// Tells that a version has been written, or why not.
pub(in crate::app) fn on_version_written(
    state: &mut State,
    engine: &mut Engine,
    number: u64,
    written: Result<(String, Written), String>,
) {
    state.waiting.answer_written(number, written.as_ref().err().map(String::as_str));
    if written.is_ok() {
        // The files have its texts now, so nothing is compiled.
        show_newest(state, engine);
    }
    on_files_written(state, written);
}

/// Tells that files have been written, which an undo takes back, or why not.
pub(in crate::app) fn on_files_written(state: &mut State, written: Result<(String, Written), String>) {
    let told = match written {
        Ok((told, written)) => {
            state.history.record_files(&state.session.shared_settings(), written);
            told
        }
        Err(message) => message,
    };
    state.say(told);
}

/// A file to write: the text that is shown, its path, and the new text.
pub(in crate::app) type Write = (Option<Arc<str>>, PathBuf, Arc<str>);

/// Writes files below `root` whole, all or none as far as reading them tells. A file keeps its byte order mark.
pub(in crate::app) fn write_files(root: &Path, files: &[Write]) -> Result<Written, String> {
    let mark: &[u8] = b"\xef\xbb\xbf";
    let mut writes = Vec::new();
    for (shown, path, text) in files {
        if path.strip_prefix(root).is_ok_and(|path| path.to_str().is_none_or(|path| leads_out(root, path))) {
            return Err(format!("cannot write {}: {}. Nothing was written", path.display(), SourceError::Outside));
        }
        let error = |error: std::io::Error| format!("cannot write {}: {error}. Nothing was written", path.display());
        let before = match std::fs::read(path) {
            Err(missing) if missing.kind() == std::io::ErrorKind::NotFound => None,
            read => Some(read.map_err(error)?),
        };
        let old = before.as_deref().unwrap_or_default();
        let (has_mark, old_text) = (old.starts_with(mark), old.strip_prefix(mark).unwrap_or(old));
        let is_known = old.is_empty() || old_text == text.as_bytes();
        if !is_known && shown.as_ref().is_none_or(|shown| old_text != shown.as_bytes()) {
            keep_beside(path, old).map_err(error)?;
        }
        let after = [if has_mark { mark } else { b"" }, text.as_bytes()].concat();
        writes.push((path.clone(), [before, Some(after)]));
    }
    writes.iter().try_for_each(|(path, [_, after])| {
        let written = picture::replace_file(path, after.as_deref().unwrap_or_default());
        written.map_err(|error| format!("cannot write {}: {error}", path.display()))
    })?;
    Ok(Written::new(writes))
}

/// Writes a copy beside `path`, as `NAME.bak`, or as `NAME.1.bak`, `NAME.2.bak`, ... if there are copies already.
fn keep_beside(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let names = std::iter::once(format!("{name}.bak")).chain((1..).map(|number| format!("{name}.{number}.bak")));
    for name in names {
        match OpenOptions::new().write(true).create_new(true).open(path.with_file_name(name)) {
            Err(taken) if taken.kind() == ErrorKind::AlreadyExists => {}
            opened => return opened?.write_all(bytes),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_never_replaces_an_older_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ndf.glsl");
        let texts: [Arc<str>; 2] = ["shown".into(), "new".into()];
        for never_shown in ["first", "second", "third"] {
            std::fs::write(&path, never_shown).unwrap();
            write_files(folder.path(), &[(Some(texts[0].clone()), path.clone(), texts[1].clone())]).unwrap();
        }
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(
            ["ndf.glsl", "ndf.glsl.bak", "ndf.glsl.1.bak", "ndf.glsl.2.bak"].map(read),
            ["new", "first", "second", "third"]
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_link_out_of_the_tree_is_not_written() {
        let (tree, outside) = (tempfile::tempdir().unwrap(), tempfile::NamedTempFile::new().unwrap());
        std::fs::write(outside.path(), "mine").unwrap();
        std::os::unix::fs::symlink(outside.path(), tree.path().join("a.glsl")).unwrap();
        let write = (None, tree.path().join("a.glsl"), "new".into());
        let error = write_files(tree.path(), &[write]).unwrap_err();
        assert!(error.contains("a link that leads out of the shader tree"), "{error}");
        assert_eq!(std::fs::read(outside.path()).unwrap(), b"mine");
        assert_eq!(std::fs::read_dir(tree.path()).unwrap().count(), 1, "a copy of the text was made");
    }
}
