//! Texts of the shader tree that programs write: to a file of the tree on disk, or over the built-in shaders, in memory.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

use crate::app::engine::Engine;
use crate::app::state::State;
use crate::shader::{Change, Source, StageKind, TreePath};
use crate::threads::{Message, TextsWritten};
use crate::write_back::{self, TreeFile, Written};

/// Result of writing a text.
pub(in crate::app) enum Outcome {
    /// It is compiled.
    Compiling,
    /// A thread writes it to a file of the tree. Its message has this number.
    Writing(u64),
}

/// The path of a file that a program may write: of shader code, and not of a hidden folder, as those of git.
///
/// # Errors
/// Why it may not.
pub(in crate::app) fn writable(source: &Source, path: &str) -> Result<TreePath, String> {
    let inside =
        TreePath::parse(path).ok_or_else(|| format!("{path} is not in the shader tree; name it from its root"))?;
    let is_hidden = inside.as_str().split('/').any(|part| part.starts_with('.'));
    let is_code = inside.extension() == Some("glsl") || StageKind::of(&inside).is_some();
    let is_of_toy = source.is_toy() && inside.extension() == Some("fs");
    if is_hidden || !(is_code || is_of_toy) {
        return Err(format!("{path} is no file of shader code: its name must end as .glsl, .vert, .frag or .comp do"));
    }
    Ok(inside)
}

/// Writes a text to a file of the tree, on a thread, or puts it over the built-in shaders; `None` takes the text of these again. With `base`,
/// the text from which it was made, it is merged with what other programs have written since.
///
/// # Errors
/// Why it cannot be written.
pub(in crate::app) fn write_text(
    state: &mut State,
    engine: &mut Engine,
    path: TreePath,
    text: Option<Arc<str>>,
    base: Option<String>,
) -> Result<Outcome, String> {
    if let Some(restored) = &state.edits.restored {
        return Err(format!("version {} is shown; show the newest one first", restored.number));
    }
    if let Some((root, path)) = state.source.folder_of_files().zip(state.source.path_of_file(&path)) {
        let file = TreeFile { root: root.to_owned(), path };
        let text = text.ok_or(
            "`text` is missing: the tree is on disk, and its files have only the text that is written to them",
        )?;
        let number = state.text_writes.begin();
        engine.threads.writer.write(move || {
            let written = match base {
                Some(base) => match write_back::write_text(&file, &base, &text) {
                    Ok((_, written)) => Ok(written),
                    Err(refused) => Err(refused.message),
                },
                None => write_back::write_whole(&file, &text),
            };
            let done = |written| TextsWritten {
                files: vec![file.root.join(file.path.as_str())],
                step: Some(written),
                told: None,
            };
            Message::TextWritten(number, written.map(done))
        });
        return Ok(Outcome::Writing(number));
    }
    if let Some(opened) = state.source.opened() {
        return Err(format!("the shader is a single file, {opened}; the files around it are the program's"));
    }
    state.text_writes.put_over(path.clone(), text);
    let source = state.text_writes.over(state.source.clone());
    state.source = source.clone();
    engine.threads.worker.read_from(source, BTreeSet::from([path]));
    Ok(Outcome::Compiling)
}

/// Writes files back as they were before a step that wrote them, or with `again` as they were after it. Returns the number of the message.
pub(in crate::app) fn take_back(state: &mut State, engine: &mut Engine, written: Arc<Written>, again: bool) -> u64 {
    let number = state.text_writes.begin();
    engine.threads.writer.write(move || {
        let done = if again { "Wrote" } else { "Took back the edit of" };
        let taken = written.take_back(again).map(|()| TextsWritten {
            files: written.files(),
            step: None,
            told: Some(format!("{done} {}", written.names())),
        });
        Message::TextWritten(number, taken)
    });
    number
}

/// Takes the result of writing. The worker is told at once, so that the command waits for the picture of this text.
pub(in crate::app) fn on_text_written(
    state: &mut State,
    engine: &mut Engine,
    number: u64,
    written: Result<TextsWritten, String>,
) {
    state.text_writes.end(number);
    match written {
        Ok(TextsWritten { files, step, told }) => {
            step.into_iter().for_each(|step| state.history.record_files(&state.session.shared_settings(), step));
            let changed: BTreeSet<TreePath> = files.iter().flat_map(|file| state.source.changed(file)).collect();
            if !changed.is_empty() {
                engine.threads.worker.change(Change::Paths(changed), Instant::now());
            }
            state.waiting.text_written(number, Ok(()));
            told.into_iter().for_each(|told| state.say(told));
        }
        Err(message) => {
            state.waiting.text_written(number, Err(&message));
            state.say(message);
        }
    }
}
