//! Files that were saved without text: one error for each, in place of those that follow from it.

use super::Library;
use crate::shader::compile::EMPTY;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::is_same_code;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

impl Library {
    /// The errors about files without code that had code in the last good set. Without such a file, the `diagnostics`.
    pub(super) fn with_emptied(&self, diagnostics: Vec<Diagnostic>, snapshot: &Snapshot<'_>) -> Vec<Diagnostic> {
        let known = self.set.iter().flat_map(|set| &set.texts);
        let had_code = known.filter(|(_, text)| !is_same_code(text, "")).map(|(path, _)| path);
        let is_empty = |path: &TreePath| snapshot.read(path).is_ok_and(|text| is_same_code(&text, ""));
        let error = |path: &TreePath| {
            let help = "the picture comes from its last text that compiled; undo, or save it with text";
            Diagnostic::error(self.source.display_path(path), EMPTY).on_line(1, None).with_help(help)
        };
        let mut errors: Vec<Diagnostic> = had_code.filter(|path| is_empty(path)).map(error).collect();
        let shown: Vec<String> = errors.iter().map(|error| error.file.clone()).collect();
        let Some(last) = errors.last_mut() else { return self.with_empty_includes(diagnostics, is_empty) };
        let is_told = |diagnostic: &&Diagnostic| shown.contains(&diagnostic.file);
        let others = diagnostics.iter().filter(|diagnostic| !is_told(diagnostic)).count();
        if others > 0 {
            let hidden = if others == 1 { "1 error is" } else { &format!("{others} errors are") };
            last.notes.push(format!("{hidden} not shown, which can follow from it"));
        }
        errors
    }

    /// The diagnostics, the first with a note about includes that are empty: they may always have been.
    fn with_empty_includes(
        &self,
        mut diagnostics: Vec<Diagnostic>,
        is_empty: impl Fn(&TreePath) -> bool,
    ) -> Vec<Diagnostic> {
        let Some(first) = diagnostics.first_mut() else { return diagnostics };
        let dependencies = self.dependencies();
        let shown = dependencies.iter().filter(|path| is_empty(path)).map(|path| self.source.display_path(path));
        let file = first.file.clone();
        first
            .notes
            .extend(shown.filter(|path| *path != file).map(|path| format!("{} is empty", self.source.in_tree(&path))));
        diagnostics
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Arc;

    use crate::shader::source::Source;
    use crate::shader::{Change, Compiler, Diagnostic, Library, Update};

    const STAGE: &str =
        "#version 460\n#include \"a.glsl\"\nvoid main() { gl_Position = vec4(two(), one(), 0.0, 1.0); }\n";
    const TEXT: &str = "float one() { return 1.0; }\nfloat two() { return 2.0; }\n";

    fn source(stage: &str, text: &str) -> Source {
        Source::memory([("m.vert", stage), ("a.glsl", text)])
    }

    fn errors(library: &mut Library, source: Source) -> Vec<Diagnostic> {
        library.set_source(source);
        let paths = BTreeSet::from(["a.glsl".into(), "m.vert".into()]);
        match library.update(&Change::Paths(paths)) {
            Update::Failed(errors, _) => errors,
            _ => Vec::new(),
        }
    }

    #[test]
    fn a_file_that_is_emptied_is_one_error() {
        let mut library = Library::new(source(STAGE, TEXT), Arc::new(Compiler::new().unwrap()), &["m.vert"]);
        assert!(matches!(library.update(&Change::All), Update::Ready(..)));
        for (stage, text, file) in [(STAGE, "\n", "a.glsl"), (STAGE, "// gone\n", "a.glsl"), ("", TEXT, "m.vert")] {
            let found = errors(&mut library, source(stage, text));
            let [error] = found.as_slice() else { panic!("{found:#?}") };
            assert_eq!((error.file.as_str(), error.message.as_str()), (file, "the file is empty"));
            assert!(error.help.as_ref().unwrap().starts_with("the picture comes from its last text"), "{error:#?}");
        }
        assert_eq!(errors(&mut library, source(STAGE, TEXT)), []);
        // Other errors are told as they are.
        let found = errors(&mut library, source(STAGE, "float one() { return 1.0; }\n"));
        assert!(found.iter().any(|error| error.message.contains("'two'")), "{found:#?}");
    }

    #[test]
    fn a_stage_without_text_is_told_at_the_start() {
        let mut library = Library::new(source(" ", TEXT), Arc::new(Compiler::new().unwrap()), &["m.vert"]);
        let Update::Failed(found, _) = library.update(&Change::All) else { panic!("it has an error") };
        let [error] = found.as_slice() else { panic!("{found:#?}") };
        assert_eq!((error.file.as_str(), error.message.as_str()), ("m.vert", "the file is empty"));
        // A library may be empty: where its names are missing, a note says so.
        let found = errors(&mut library, source(STAGE, ""));
        assert_eq!(found[0].notes, ["a.glsl is empty"], "{found:#?}");
        let stage = "#version 460\n#include \"a.glsl\"\nvoid main() { gl_Position = vec4(1.0); }\n";
        assert_eq!(errors(&mut library, source(stage, "")), []);
    }
}
