//! Resolves `#include` for glslang, and records every path that the result depends on.

use std::cell::RefCell;
use std::collections::BTreeSet;

use super::unbound::unbound;
use crate::shader::glsl::includes;
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
}

impl<'a> Includes<'a> {
    /// Starts with the outermost file.
    pub fn new(snapshot: &'a Snapshot<'a>, outermost: TreePath) -> Self {
        let dependencies = BTreeSet::from([outermost.clone()]);
        Self { snapshot, stack: RefCell::new(vec![outermost]), dependencies: RefCell::new(dependencies) }
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
                    if let Some(first) = stack.iter().position(|including| including == path) {
                        return Err(format!("include cycle: {}", chain(&stack[first..], Some(path))));
                    }
                    stack.push(path.clone());
                    return Ok((path.clone(), text.to_string()));
                }
                Err(SourceError::Missing) => {}
                Err(error) => return Err(format!("{} {error}", self.snapshot.display_path(path))),
            }
        }
        let looked: Vec<String> = candidates.iter().map(|path| self.snapshot.display_path(path)).collect();
        Err(format!("\"{name}\" not found; looked for {}", looked.join(" and ")))
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
}
