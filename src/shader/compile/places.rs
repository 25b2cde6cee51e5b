//! Errors whose place the compiler does not name, or names after it: a line without a semicolon at the end of an include, and errors
//! of the linker.

use std::collections::BTreeSet;

use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::syntax::{functions, within};
use crate::shader::glsl::{Code, Line, Token, TokenKind, includes, lines};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// How many files are followed from one to the next.
const MOST_FILES: usize = 32;

/// The files of a stage.
#[derive(Clone, Copy)]
pub(super) struct StageFiles<'a> {
    pub(super) snapshot: &'a Snapshot<'a>,
    pub(super) all: &'a BTreeSet<TreePath>,
}

impl StageFiles<'_> {
    /// The error about the last line of another file, if it does not end with a semicolon and the compiler reads `error`, a syntax error
    /// at the first word of a line, right behind it.
    pub(super) fn unended_before(&self, path: &TreePath, error: &Diagnostic) -> Option<Diagnostic> {
        let (other, number) = self.last_code(path, Some(error.line?.checked_sub(1)? as usize), MOST_FILES)?;
        if other == *path {
            return None;
        }
        let text = self.snapshot.read(&other).ok()?;
        let lines = lines(&text);
        let line = lines.get(number as usize - 1).filter(|line| is_unended(line))?;
        let last = line.tokens().last()?.bytes.clone();
        let found = Diagnostic::error(self.snapshot.display_path(&other), "this line does not end with ';'");
        let found = found.on_line(number, Some(line.raw)).under(last);
        Some(
            found.with_note(format!(
                "the compiler notices it on line {} of {}: {}",
                error.line?, error.file, error.message
            )),
        )
    }

    /// The last line of code that the compiler reads before a line of a file: without `before`, in the file and its includes.
    fn last_code(&self, path: &TreePath, before: Option<usize>, most: usize) -> Option<(TreePath, u32)> {
        let text = self.snapshot.read(path).ok()?;
        let lines = lines(&text);
        let most = most.checked_sub(1)?;
        for line in lines[..before.unwrap_or(lines.len()).min(lines.len())].iter().rev() {
            if let Some(found) = self.included(path, line).and_then(|other| self.last_code(&other, None, most)) {
                return Some(found);
            }
            if line.is_code() {
                return Some((path.clone(), line.number));
            }
        }
        before?;
        let includes_it = |other: &&TreePath| *other != path && self.line_of_include(other, path).is_some();
        let other = self.all.iter().find(includes_it)?;
        self.last_code(other, self.line_of_include(other, path), most)
    }

    /// The file that a line includes.
    fn included(&self, path: &TreePath, line: &Line<'_>) -> Option<TreePath> {
        let name = line.keyword.filter(|keyword| *keyword == "include").and_then(|_| includes(line.raw).next())?.name;
        let mut places = path.sibling(name).into_iter().chain(TreePath::parse(name));
        places.find(|place| self.snapshot.read(place).is_ok())
    }

    /// The index of the line of a file that includes another.
    fn line_of_include(&self, path: &TreePath, other: &TreePath) -> Option<usize> {
        let text = self.snapshot.read(path).ok()?;
        lines(&text).iter().position(|line| self.included(path, line).as_ref() == Some(other))
    }

    /// An error of the linker at the line that it is about, if its notes tell: `f(vf3; calling g(f1;` or `g(f1;`.
    pub(super) fn linked(&self, error: Diagnostic) -> Diagnostic {
        let names = error.notes.iter().find_map(|note| {
            let mut names = note.split(" calling ").map(|name| name.split_once('(').map(|(name, _)| name.trim()));
            Some((names.next()??, names.next().flatten()))
        });
        let Some((first, called)) = names else { return error };
        let place = self.all.iter().find_map(|path| {
            let text = self.snapshot.read(path).ok()?;
            let code = Code::new(&text);
            let word = |bytes: &std::ops::Range<usize>, word: &str| {
                within(&code.tokens, bytes).iter().find(|token| token.text == word).map(|token| token.bytes.clone())
            };
            let found = match called {
                Some(called) => functions(&code.tokens)
                    .iter()
                    .filter(|function| word(&function.head, first).is_some())
                    .find_map(|function| word(&function.body.bytes, called)),
                None => word(&(0..text.len()), first),
            }?;
            let number = code.number_at(found.start);
            let line = code.line(number)?;
            let file = self.snapshot.display_path(path);
            let error = Diagnostic { file, ..error.clone() }.on_line(number, Some(line.raw));
            Some(error.under(found.start - line.start..found.end - line.start))
        });
        place.unwrap_or(error)
    }
}

/// Whether a line looks like a statement without `;`.
pub(super) fn is_unended(line: &Line<'_>) -> bool {
    let tokens = line.tokens();
    let opens_block =
        tokens.first().is_some_and(|first| matches!(first.text, "if" | "for" | "while" | "else" | "switch" | "do"));
    tokens.last().is_some_and(is_value) && !opens_block
}

/// Whether a token can end a value.
pub(super) fn is_value(token: &Token<'_>) -> bool {
    matches!(token.kind, TokenKind::Word | TokenKind::Number) || matches!(token.text, ")" | "]")
}

// These tests run the compiler.
#[cfg(test)]
mod tests {
    use crate::shader::compile::Compiler;
    use crate::shader::diagnostic::Diagnostic;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;

    fn errors(files: &[(&str, &str)]) -> Vec<Diagnostic> {
        let source = Source::memory(files.iter().copied());
        let compiled = Compiler::new().unwrap().compile(&Snapshot::new(&source), &files[0].0.into());
        compiled.result.unwrap_err()
    }

    #[test]
    fn a_missing_semicolon_at_the_end_of_an_include_names_the_include() {
        let guarded = "#ifndef A\n#define A\nconst float ONE = 1.0\n#endif\n";
        for files in [
            vec![("m.frag", "#version 460\n#include \"a.glsl\"\nvoid main() {}\n"), ("a.glsl", guarded)],
            vec![
                ("m.frag", "#version 460\n#include \"a.glsl\"\n\n#include \"b.glsl\"\nvoid main() {}\n"),
                ("a.glsl", guarded),
                ("b.glsl", "// B\nvoid f() {}\n"),
            ],
            vec![
                ("m.frag", "#version 460\n#include \"c.glsl\"\nvoid main() {}\n"),
                ("c.glsl", "#include \"a.glsl\"\n"),
                ("a.glsl", guarded),
            ],
        ] {
            let errors = errors(&files);
            assert_eq!(errors[0].one_line(), "a.glsl:3:19: error: this line does not end with ';'", "{errors:#?}");
            assert!(errors[0].notes[0].contains("syntax error, unexpected 'void'"), "{errors:#?}");
        }
        // An error of the file itself stays there.
        let own =
            [("m.frag", "#version 460\n#include \"a.glsl\"\nvoid main() { float x = ; }\n"), ("a.glsl", "float x;\n")];
        assert!(errors(&own)[0].one_line().starts_with("m.frag:3:"));
    }

    #[test]
    fn errors_of_the_linker_have_a_line() {
        let library =
            "float g(float x);\n\nfloat f(float x) {\n    return g(x);\n}\nfloat g(float x) { return f(x); }\n";
        let stage = "#version 460\n#include \"lib.glsl\"\nvoid main() { f(1.0); }\n";
        let found = errors(&[("m.frag", stage), ("lib.glsl", library)]);
        assert!(found[0].one_line().starts_with("lib.glsl:") && found[0].message.contains("Recursion"), "{found:#?}");
        assert!(found[0].column.is_some(), "{found:#?}");
        for text in ["", "#version 460\nfloat x;\n"] {
            assert!(errors(&[("m.frag", text)])[0].one_line().starts_with("m.frag:1"), "{text}");
        }
        let found = errors(&[("m.frag", "#version 460\nfloat f(float x);\nvoid main() { f(1.0); }\n")]);
        assert!(found[0].one_line().starts_with("m.frag:2:7: error: No function definition"), "{found:#?}");
    }
}
