//! Commands that read and write the texts of the shader tree.

use serde_json::json;

use super::fields;
use super::spec::{Outcome, Spec, Until};
use crate::app::actions::texts::{self, writable, write_text};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::waiting::Work;
use crate::message::did_you_mean;
use crate::shader::TreePath;

/// Fields of `edit`.
#[derive(Clone, Debug)]
pub(in crate::app) struct Edit {
    file: String,
    text: Option<String>,
    /// Text from which `text` was made.
    base: Option<String>,
}

pub(in crate::app) static EDIT: Spec<Edit> = Spec::new("edit", edit).parsed(
    r#""file": "brdf/ndf.glsl", "text": "..." | null, "base"?: "...""#,
    "Writes a file of the shader tree, or one that is new. With base, the text that was edited, changes that other programs have made since \
     are kept, or the edit is refused where both changed a line. Over the built-in shaders it changes no file, and null takes their own text \
     again. Done when the picture with it is final. Result: generation; an error lists the diagnostics, and the last good picture stays",
    |about, mut fields| {
        let file = fields::text(&mut fields, "file")?.ok_or_else(|| fields::needs(about))?;
        if !fields.contains_key("text") {
            return Err(fields::needs(about));
        }
        let text = fields::text(&mut fields, "text")?;
        let base = fields::text(&mut fields, "base")?;
        fields::end(about, Edit { file, text, base }, fields)
    },
);

pub(in crate::app) static FILE: Spec<String> = Spec::new("file", read).parsed(
    r#""file": "brdf/ndf.glsl""#,
    "The text of a file of the shader tree, as it is now. Result: file, text",
    |about, mut fields| {
        let file = fields::text(&mut fields, "file")?.ok_or_else(|| fields::needs(about))?;
        fields::end(about, file, fields)
    },
);

pub(in crate::app) static FILES: Spec<()> = Spec::fallible("files", list)
    .line("The files of the shader tree. Result: tree (its folder or file; null for the built-in one), files, folder (of the files that edit \
        writes; null for the built-in tree), below (where that folder is in the tree: opened for a single file, else empty)");

fn edit(state: &mut State, engine: &mut Engine, Edit { file, text, base }: Edit) -> Outcome {
    let path = writable(&state.source, &file)?;
    Ok(match write_text(state, engine, path, text.map(Into::into), base)? {
        texts::Outcome::Compiling => Until::Reloaded,
        texts::Outcome::Writing(number) => Until::TextWritten(number),
    })
}

fn read(state: &mut State, _: &mut Engine, file: String) -> Outcome {
    let source = state.source.clone();
    let run = move || {
        let path = TreePath::parse(&file).ok_or_else(|| format!("{file} is not in the shader tree"))?;
        let text = source.author_text(&path).map_err(|error| {
            let files = source.list();
            let hint = did_you_mean(&file, files.iter().map(TreePath::as_str));
            format!("cannot read {}: {error}.{hint}", source.display_path(&path))
        })?;
        Ok(json!({ "file": path.as_str(), "text": text }))
    };
    Ok(Until::Work(Work { uses_device: false, run: Box::new(run) }))
}

fn list(state: &mut State, _: &mut Engine, (): ()) -> Outcome {
    let source = state.source.clone();
    let run = move || {
        let files: Vec<TreePath> = source.own_files().into_iter().chain(source.list()).collect();
        Ok(
            json!({ "tree": source.location(), "files": files, "folder": source.folder_of_files(), "below": source.path_of_folder() }),
        )
    };
    Ok(Until::Work(Work { uses_device: false, run: Box::new(run) }))
}
