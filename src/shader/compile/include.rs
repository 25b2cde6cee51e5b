//! Resolves `#include` for glslang, and records every path that the result depends on.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

use super::asserts::numbered;
use super::unbound::unbound;
use crate::message::nearest;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{includes, tokens};
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};

/// Maximum depth of includes. glslang itself has no limit.
pub const MAX_DEPTH: usize = 32;

/// The include state of one compilation.
#[derive(Debug)]
pub struct Includes<'a> {
    snapshot: &'a Snapshot<'a>,
    /// The files being read, outermost first. Its length follows glslang's include depth.
    stack: RefCell<Vec<TreePath>>,
    dependencies: RefCell<BTreeSet<TreePath>>,
    /// The files with `#pragma once` that were read.
    once: RefCell<BTreeSet<TreePath>>,
    /// Errors at lines of files that have no text.
    unreadable: RefCell<Vec<Diagnostic>>,
}

impl<'a> Includes<'a> {
    /// Starts with the outermost file.
    pub fn new(snapshot: &'a Snapshot<'a>, outermost: TreePath) -> Self {
        let dependencies = RefCell::new(BTreeSet::from([outermost.clone()]));
        let (once, unreadable) = <(RefCell<_>, RefCell<_>)>::default();
        Self { snapshot, stack: RefCell::new(vec![outermost]), dependencies, once, unreadable }
    }

    /// Begins a compilation, and returns the text of the outermost file as the compiler gets it.
    pub fn begin(&self, text: &str) -> String {
        let mut stack = self.stack.borrow_mut();
        stack.truncate(1);
        let mut once = self.once.borrow_mut();
        once.clear();
        let pragma = pragma_once(text);
        once.extend(stack.first().filter(|_| pragma.is_some()).cloned());
        blanked(text, pragma)
    }

    /// The files as they were before the compilation.
    pub fn snapshot(&self) -> &'a Snapshot<'a> {
        self.snapshot
    }

    /// Errors at lines of files that have no text, which explain all others.
    pub fn take_unreadable(&self) -> Vec<Diagnostic> {
        self.unreadable.take()
    }

    /// Finds `name`, included at `depth` (1 is an include of the outermost file): relative to the including file, or else to
    /// the root. Returns the file's tree path and text.
    ///
    /// # Errors
    /// The message for the `#include` line, without file and line.
    pub fn resolve(&self, name: &str, depth: usize) -> Result<(TreePath, String), String> {
        let mut stack = self.stack.borrow_mut();
        stack.truncate(depth.max(1));
        let Some(including) = stack.last() else { return Err("include without an including file".to_owned()) };
        if depth > MAX_DEPTH {
            return Err(format!("includes nest deeper than {MAX_DEPTH}: {}", chain(&stack, None)));
        }
        let mut candidates: Vec<TreePath> = including.sibling(name).into_iter().chain(TreePath::parse(name)).collect();
        candidates.dedup();
        if candidates.is_empty() {
            return Err(format!("\"{name}\" leaves the shader tree; includes must stay inside its root"));
        }
        for path in &candidates {
            self.dependencies.borrow_mut().insert(path.clone());
            match self.snapshot.read(path) {
                Ok(text) => {
                    let pragma = pragma_once(&text);
                    if pragma.is_some() && !self.once.borrow_mut().insert(path.clone()) {
                        return Ok((path.clone(), String::new()));
                    }
                    if let Some(first) = stack.iter().position(|including| including == path) {
                        return Err(format!("include cycle: {}", chain(&stack[first..], Some(path))));
                    }
                    stack.push(path.clone());
                    return Ok((path.clone(), blanked(&text, pragma)));
                }
                Err(SourceError::Missing) => {}
                Err(error) => {
                    let error = unreadable(self.snapshot, path, &error);
                    let message = error.message.clone();
                    // glslang asks again for the same name.
                    let mut unreadable = self.unreadable.borrow_mut();
                    if error.line.is_some() && !unreadable.contains(&error) {
                        unreadable.push(error);
                    }
                    return Err(message);
                }
            }
        }
        Err(format!("\"{name}\" not found; looked for {}", self.snapshot.looked_for(&candidates)))
    }

    /// The uniforms and buffers that the files read so far declare without a binding.
    pub fn unbound(&self) -> BTreeSet<String> {
        let files = self.dependencies.borrow();
        files.iter().filter_map(|path| self.snapshot.read(path).ok()).flat_map(|text| unbound(&text)).collect()
    }

    /// All files that were read, and all paths where no file was found.
    pub fn into_dependencies(self) -> BTreeSet<TreePath> {
        self.dependencies.into_inner()
    }
}

/// The error about a file that has no text, at the line that is wrong if there is one.
pub fn unreadable(snapshot: &Snapshot<'_>, path: &TreePath, error: &SourceError) -> Diagnostic {
    let file = snapshot.display_path(path);
    let diagnostic = Diagnostic::error(file.clone(), format!("{file} {error}"));
    match error.line() {
        Some(line) => diagnostic.on_line(line, None),
        None => diagnostic,
    }
}

/// The bytes of a `#pragma once`, which glslang does not know.
fn pragma_once(text: &str) -> Option<Range<usize>> {
    if !text.contains("pragma") {
        return None;
    }
    let directives: Vec<_> = tokens(text).filter(|token| token.in_directive).collect();
    let pragma =
        directives.windows(3).find(|three| three.iter().map(|token| token.text).eq(["#", "pragma", "once"]))?;
    Some(pragma[0].bytes.start..pragma[2].bytes.end)
}

fn blanked(text: &str, bytes: Option<Range<usize>>) -> String {
    let mut text = numbered(text).into_owned();
    if let Some(bytes) = bytes {
        text.replace_range(bytes.clone(), &" ".repeat(bytes.len()));
    }
    text
}

/// The name that the author of a line `#include "name"` in `including` may mean, as it would stand there.
pub fn meant(snapshot: &Snapshot<'_>, including: &TreePath, name: &str) -> Option<String> {
    let source = snapshot.source();
    let (inside, own) = name.rsplit_once('/').map_or(("", name), |(inside, own)| (inside, own));
    let folder = including.sibling(name).map(|path| path.as_str().to_owned()).unwrap_or_default();
    let folder = folder.rsplit_once('/').map_or("", |(folder, _)| folder);
    let beside = source.folder(folder).into_iter().map(|own| match inside {
        "" => own,
        inside => format!("{inside}/{own}"),
    });
    let all = source.list().into_iter().map(|path| path.as_str().to_owned());
    let is_library = |path: &String| path.ends_with(".glsl") && *path != including.as_str();
    let names: Vec<String> = beside.chain(all).filter(is_library).collect();
    // The right name in another folder comes first.
    let same = names.iter().find(|path| path.rsplit('/').next() == Some(own));
    let stem = |path: &str| path.rsplit_once('.').map_or(path, |(stem, _)| stem).to_owned();
    let stems: Vec<String> = names.iter().map(|path| stem(path)).collect();
    let like = || {
        let best = nearest(&stem(name), stems.iter().map(String::as_str))?;
        stems.iter().position(|stem| stem == best).map(|at| &names[at])
    };
    same.or_else(like).cloned()
}

/// The files that `path` includes, directly or not, and the file itself, found without compiling: conditions are not
/// evaluated, and includes that do not resolve are left out.
pub fn files_of(snapshot: &Snapshot<'_>, path: &TreePath) -> BTreeSet<TreePath> {
    let mut files = BTreeSet::new();
    let mut open = vec![path.clone()];
    while let Some(path) = open.pop() {
        let Ok(text) = snapshot.read(&path) else { continue };
        if files.insert(path.clone()) {
            let found = includes(&text).filter_map(|include| {
                let mut candidates = path.sibling(include.name).into_iter().chain(TreePath::parse(include.name));
                candidates.find(|candidate| snapshot.read(candidate).is_ok())
            });
            open.extend(found);
        }
    }
    files
}

fn chain(stack: &[TreePath], last: Option<&TreePath>) -> String {
    let names: Vec<&str> = stack.iter().chain(last).map(TreePath::as_str).collect();
    match names.as_slice() {
        [first @ .., a, b] if first.len() > 6 => format!("{} -> ... -> {a} -> {b}", first[..4].join(" -> ")),
        names => names.join(" -> "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;

    #[test]
    fn beside_the_file_first_then_from_the_root() {
        let source = Source::memory([("a/x.glsl", "beside"), ("x.glsl", "root"), ("y.glsl", "root y")]);
        let snapshot = Snapshot::new(&source);
        let includes = Includes::new(&snapshot, "a/main.frag".into());
        assert_eq!(includes.resolve("x.glsl", 1), Ok(("a/x.glsl".into(), "beside".to_owned())));
        assert_eq!(includes.resolve("y.glsl", 1), Ok(("y.glsl".into(), "root y".to_owned())));
        let dependencies: Vec<String> = includes.into_dependencies().iter().map(TreePath::to_string).collect();
        assert_eq!(dependencies, ["a/main.frag", "a/x.glsl", "a/y.glsl", "y.glsl"]);
    }

    #[test]
    fn missing_names_both_places() {
        let source = Source::memory([]);
        let snapshot = Snapshot::new(&source);
        let includes = Includes::new(&snapshot, "a/main.frag".into());
        let error = includes.resolve("x.glsl", 1).unwrap_err();
        assert_eq!(error, "\"x.glsl\" not found; looked for a/x.glsl and x.glsl");
        assert!(includes.resolve("../../x.glsl", 1).unwrap_err().contains("leaves the shader tree"));
    }

    #[test]
    fn cycles_and_depth_name_the_chain() {
        let source = Source::memory([("a.glsl", ""), ("b.glsl", "")]);
        let snapshot = Snapshot::new(&source);
        let includes = Includes::new(&snapshot, "m.frag".into());
        includes.resolve("a.glsl", 1).unwrap();
        includes.resolve("b.glsl", 2).unwrap();
        let error = includes.resolve("a.glsl", 3).unwrap_err();
        assert_eq!(error, "include cycle: a.glsl -> b.glsl -> a.glsl");
        // Back in the outermost file, the same file may be included again.
        assert!(includes.resolve("a.glsl", 1).is_ok());
    }

    #[test]
    fn a_file_with_pragma_once_is_read_once() {
        let library = "// A\n# pragma once // why\nfloat one() { return 1.0; }\n";
        let stage = "#version 460\n#pragma once\n#include \"a.glsl\"\n#include \"b.glsl\"\n#include \"a.glsl\"\nvoid main() { one(); }\n";
        let both = "#include \"a.glsl\"\n#pragma once\n#include \"b.glsl\"\n";
        let source = Source::memory([("m.frag", stage), ("a.glsl", library), ("b.glsl", both)]);
        let compiled = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into());
        assert_eq!((compiled.result.err(), compiled.warnings), (None, Vec::new()));
    }

    #[test]
    fn a_misspelled_include_has_a_suggestion() {
        let files = [("brdf/fresnel.glsl", ""), ("a/noise.glsl", ""), ("a/m.frag", ""), ("lib.txt", "")];
        let source = Source::memory(files);
        let snapshot = Snapshot::new(&source);
        for (name, expected) in [
            ("brdf/fresnell.glsl", Some("brdf/fresnel.glsl")),
            ("fresnel.glsl", Some("brdf/fresnel.glsl")),
            ("nois.glsl", Some("noise.glsl")),
            ("qqqqqqqqq.glsl", None),
        ] {
            assert_eq!(meant(&snapshot, &"a/m.frag".into(), name).as_deref(), expected, "{name}");
        }
    }

    #[test]
    fn a_file_without_text_has_its_own_line() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
        write("nul.glsl", b"// a\n\0");
        write("latin.frag", b"#version 460\n\n// \xe4\nvoid main() {}\n");
        write("m.frag", b"#version 460\n#include \"nul.glsl\"\nvoid main() { f(); }\n");
        write("mac.frag", b"#version 460\r// x\rvoid main() {}\r");
        let source = Source::disk(folder.path());
        let first = |name: &str| {
            let compiled = Compiler::new().unwrap().compile(&Snapshot::new(&source), &name.into());
            compiled.result.map_err(|errors| errors.iter().map(Diagnostic::one_line).collect::<Vec<_>>())
        };
        let at = |name: &str| folder.path().join(name).display().to_string();
        let found = first("m.frag").unwrap_err();
        assert!(found.len() == 1 && found[0].starts_with(&format!("{}:2: error: ", at("nul.glsl"))), "{found:?}");
        let found = first("latin.frag").unwrap_err();
        assert!(found[0].starts_with(&format!("{}:3: error: ", at("latin.frag"))), "{found:?}");
        assert!(first("mac.frag").is_ok());
    }
}
