//! Names that the last edit has removed from a file while other files still use them.

use std::collections::BTreeSet;

use super::Library;
use crate::shader::compile::names::Names;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{find_word, is_same_code, lines};
use crate::shader::source::snapshot::Snapshot;

/// Messages about a name that is not declared.
const UNKNOWN: [&str; 2] = ["undeclared identifier", "no matching overloaded function found"];

impl Library {
    /// The diagnostics, where the first one about a name that the last edit has removed says where it was. Further ones about it are left out.
    pub(super) fn with_gone(&self, diagnostics: Vec<Diagnostic>, snapshot: &Snapshot<'_>) -> Vec<Diagnostic> {
        let mut told: BTreeSet<String> = BTreeSet::new();
        let explained = diagnostics.into_iter().filter_map(|diagnostic| {
            let gone = unknown(&diagnostic.message).and_then(|name| Some((name, self.place_before(name, snapshot)?)));
            let Some((name, place)) = gone else { return Some(diagnostic) };
            let help = format!("the last edit removed `{name}`, which was at {place}");
            told.insert(name.to_owned()).then(|| diagnostic.with_help(help))
        });
        explained.collect()
    }

    /// The file, as displayed, and the line that declared a name before the last edit of the file removed it.
    fn place_before(&self, name: &str, snapshot: &Snapshot<'_>) -> Option<String> {
        let declares = |path, text: &str| Names::of([(path, text.into())].into_iter()).has_global(name);
        self.set.as_ref()?.texts.iter().find_map(|(path, text)| {
            let now = snapshot.read(path).ok()?;
            let is_gone = !is_same_code(&now, text) && declares(path, text) && !declares(path, &now);
            let line =
                lines(text).into_iter().filter(|_| is_gone).find(|line| find_word(&line.code, name).is_some())?;
            Some(format!("{}:{}", self.source.display_path(path), line.number))
        })
    }
}

/// The name that a message is about, if it is not declared.
fn unknown(message: &str) -> Option<&str> {
    let (name, said) = message.strip_prefix('\'')?.split_once("' : ")?;
    UNKNOWN.contains(&said).then_some(name)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Arc;

    use super::*;
    use crate::shader::source::Source;
    use crate::shader::{Change, Compiler, Update};

    fn source(library: &str) -> Source {
        let stage =
            "#version 460\n#include \"a.glsl\"\nvoid main() { gl_Position = vec4(two(), two() + ONE, 0.0, 1.0); }\n";
        Source::memory([("m.vert", stage), ("a.glsl", library)])
    }

    #[test]
    fn a_name_that_an_edit_removes_is_told_once_with_the_place_where_it_was() {
        let whole = "// two\n#define ONE 1.0\nfloat two() { return 2.0; }\n";
        let mut library = Library::new(source(whole), Arc::new(Compiler::new().unwrap()), &["m.vert"]);
        assert!(matches!(library.update(&Change::All), Update::Ready(..)));
        let mut errors_with = |text: &str| {
            library.set_source(source(text));
            let Update::Failed(errors, _) = library.update(&Change::Paths(BTreeSet::from(["a.glsl".into()]))) else {
                panic!("it has an error")
            };
            errors
        };
        let errors = errors_with("float other;\n");
        let helps: Vec<_> = errors.iter().filter_map(|error| error.help.as_deref()).collect();
        assert!(helps.contains(&"the last edit removed `two`, which was at a.glsl:3"), "{errors:#?}");
        assert_eq!(helps.iter().filter(|help| help.contains("`two`")).count(), 1, "{errors:#?}");
        assert!(errors.iter().all(|error| !error.message.contains("cannot convert")), "{errors:#?}");
        // A name that is still there, or never was, is none that the edit removed.
        let errors = errors_with("#define ONE 1.0\nfloat two() { return tow; }\n");
        assert!(
            errors.iter().all(|error| error.help.as_deref().is_none_or(|help| !help.contains("removed"))),
            "{errors:#?}"
        );
    }
}
