//! Includes that are not found: one error for each, which names all lines that include it, and the file that it may be now.

use std::collections::BTreeMap;

use super::Library;
use crate::shader::compile::log::NOT_FOUND;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::is_same_code;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{Source, TreePath};

/// Most lines that a note lists.
const LISTED: usize = 6;
/// Ends the note that lists them.
const TOO: &str = "include it, too";

/// The diagnostics with one for each include that was not found, instead of one for each line that includes it.
pub(super) fn folded(diagnostics: Vec<Diagnostic>, source: &Source) -> Vec<Diagnostic> {
    let mut out: Vec<Diagnostic> = Vec::new();
    let mut first: BTreeMap<String, (usize, Vec<String>)> = BTreeMap::new();
    for diagnostic in diagnostics {
        let name = diagnostic.message.split_once(NOT_FOUND).map(|(name, _)| name.to_owned());
        match name.map(|name| first.entry(name)) {
            Some(std::collections::btree_map::Entry::Occupied(mut known)) => {
                let place = format!("{}:{}", source.in_tree(&diagnostic.file), diagnostic.line.unwrap_or(1));
                let (index, others) = known.get_mut();
                let is_new = out[*index].file != diagnostic.file && !others.contains(&place);
                others.extend(is_new.then_some(place));
            }
            Some(std::collections::btree_map::Entry::Vacant(new)) => {
                new.insert((out.len(), Vec::new()));
                out.push(diagnostic);
            }
            None => out.push(diagnostic),
        }
    }
    // `check` folds the errors of an update again, with those of the files that no stage includes.
    let is_listed = |index: usize| out[index].notes.iter().any(|note| note.ends_with(TOO));
    let new: Vec<_> = first.into_values().filter(|(index, others)| !others.is_empty() && !is_listed(*index)).collect();
    for (index, others) in new {
        let more = others.len().saturating_sub(LISTED);
        let listed = others[..others.len() - more].join(", ");
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        out[index].notes.push(format!("{listed}{more} {TOO}"));
    }
    out
}

impl Library {
    /// The diagnostics as [`folded`] gives them. An include whose text is in a new file asks whether it was renamed.
    pub(super) fn with_renamed(&self, diagnostics: Vec<Diagnostic>, snapshot: &Snapshot<'_>) -> Vec<Diagnostic> {
        let renamed = |diagnostic: Diagnostic| match self.renamed(&diagnostic, snapshot) {
            Some(path) => diagnostic.with_help(format!("was it renamed to `{path}`?")),
            None => diagnostic,
        };
        folded(diagnostics, &self.source).into_iter().map(renamed).collect()
    }

    /// The new file with the text that an include had that is not found.
    fn renamed(&self, diagnostic: &Diagnostic, snapshot: &Snapshot<'_>) -> Option<TreePath> {
        let (_, looked) = diagnostic.message.split_once(NOT_FOUND)?;
        let texts = &self.set.as_ref()?.texts;
        let is_it = |path: &&TreePath| {
            looked.split(" and ").any(|shown| shown == self.source.in_tree(&self.source.display_path(path)))
        };
        let text = texts.iter().find(|(path, _)| is_it(path)).map(|(_, text)| text)?;
        let is_same = |path: &TreePath| snapshot.read(path).is_ok_and(|now| is_same_code(&now, text));
        let is_new = |path: &TreePath| path.extension() == Some("glsl") && !texts.contains_key(path);
        self.source.list().into_iter().find(|path| is_new(path) && is_same(path))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Arc;

    use crate::shader::{Change, Compiler, Library, Source, Update};

    const STAGE: &str =
        "#version 460\n#include \"a.glsl\"\n#include \"b.glsl\"\nvoid main() { gl_Position = vec4(two()); }\n";

    fn source(name: &str) -> Source {
        Source::memory([
            ("m.vert", STAGE),
            ("n.vert", STAGE),
            ("a.glsl", "#include \"lib/one.glsl\"\nfloat half_of() { return 0.5 * one(); }\n"),
            ("b.glsl", "#include \"lib/one.glsl\"\nfloat two() { return one() + one(); }\n"),
            (name, "#ifndef ONE\n#define ONE\nfloat one() { return 1.0; }\n#endif\n"),
        ])
    }

    #[test]
    fn a_renamed_include_is_one_error_that_names_the_new_file() {
        let mut library =
            Library::new(source("lib/one.glsl"), Arc::new(Compiler::new().unwrap()), &["m.vert", "n.vert"]);
        assert!(matches!(library.update(&Change::All), Update::Ready(..)));
        library.set_source(source("lib/first.glsl"));
        let paths = BTreeSet::from(["lib/one.glsl".into(), "lib/first.glsl".into()]);
        let Update::Failed(errors, _) = library.update(&Change::Paths(paths)) else { panic!("it has an error") };
        let [error] = errors.as_slice() else { panic!("{errors:#?}") };
        assert_eq!(error.one_line(), "a.glsl:1:11: error: \"lib/one.glsl\" not found; looked for lib/one.glsl");
        assert_eq!(error.help.as_deref(), Some("was it renamed to `lib/first.glsl`?"));
        assert_eq!(error.notes, ["b.glsl:1 include it, too"]);
    }

    #[test]
    fn paths_of_a_missing_include_are_those_in_the_tree() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in
            [("m.vert", STAGE), ("a.glsl", "#include \"lib/one.glsl\"\n"), ("b.glsl", "#include \"lib/one.glsl\"\n")]
        {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let mut library = Library::new(Source::disk(folder.path()), Arc::new(Compiler::new().unwrap()), &["m.vert"]);
        let found = crate::shader::check::check(&mut library);
        let [error] = found.as_slice() else { panic!("{found:#?}") };
        assert_eq!(error.message, "\"lib/one.glsl\" not found; looked for lib/one.glsl");
        assert_eq!(error.file, folder.path().join("a.glsl").display().to_string(), "an editor opens it");
        assert_eq!(error.notes, ["b.glsl:1 include it, too"]);
    }
}
