//! Which file of a tree includes which, in both directions.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::TreePath;
use super::glsl::includes;

/// The includes of a set of files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IncludeGraph {
    /// Include names of each file as written, in the order of its lines.
    names: BTreeMap<TreePath, (Arc<str>, Vec<String>)>,
    includes: BTreeMap<TreePath, Vec<TreePath>>,
    included_by: BTreeMap<TreePath, BTreeSet<TreePath>>,
}

impl IncludeGraph {
    /// The graph of these texts. Texts that `before` has are not read again. An include of a file that is not among them is left out.
    pub fn new(texts: &BTreeMap<TreePath, Arc<str>>, before: Self) -> Self {
        let mut known = before.names;
        let names_of = |(path, text): (&TreePath, &Arc<str>)| {
            let names = match known.remove(path).filter(|(old, _)| old == text) {
                Some((_, names)) => names,
                None => includes(text).map(|include| include.name.to_owned()).collect(),
            };
            (path.clone(), (text.clone(), names))
        };
        let names: BTreeMap<TreePath, (Arc<str>, Vec<String>)> = texts.iter().map(names_of).collect();
        let mut graph = Self::default();
        for (path, (_, included)) in &names {
            let mut found: Vec<TreePath> = Vec::new();
            for name in included {
                // Beside the file first, then from the root, as the compiler looks.
                let mut places = path.sibling(name).into_iter().chain(TreePath::parse(name));
                let place = places.find(|place| texts.contains_key(place));
                found.extend(place.filter(|place| !found.contains(place)));
            }
            for other in &found {
                graph.included_by.entry(other.clone()).or_default().insert(path.clone());
            }
            graph.includes.insert(path.clone(), found);
        }
        Self { names, ..graph }
    }

    /// The files, sorted.
    pub fn files(&self) -> impl Iterator<Item = &TreePath> {
        self.includes.keys()
    }

    /// The files that this file includes itself, in the order of its lines.
    pub fn includes(&self, path: &TreePath) -> &[TreePath] {
        self.includes.get(path).map(Vec::as_slice).unwrap_or_default()
    }

    /// The files that include this file themselves, sorted.
    pub fn included_by(&self, path: &TreePath) -> impl Iterator<Item = &TreePath> {
        self.included_by.get(path).into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(files: &[(&str, &str)]) -> BTreeMap<TreePath, Arc<str>> {
        files.iter().map(|(path, text)| (TreePath::from(*path), Arc::from(*text))).collect()
    }

    fn names<'a>(paths: impl IntoIterator<Item = &'a TreePath>) -> Vec<&'a str> {
        paths.into_iter().map(TreePath::as_str).collect()
    }

    #[test]
    fn both_directions_follow_the_places_where_the_compiler_looks() {
        let mut texts = texts(&[
            ("a.frag", "#include \"x.glsl\"\n  # include \"lib/y.glsl\"\n#include \"x.glsl\"\n"),
            ("lib/y.glsl", "#include \"x.glsl\" // beside\n// #include \"a.frag\"\n#include \"none.glsl\"\n"),
            ("lib/x.glsl", ""),
            ("x.glsl", "/*\n#include \"lib/y.glsl\"\n*/"),
        ]);
        let graph = IncludeGraph::new(&texts, IncludeGraph::default());
        assert_eq!(names(graph.files()), ["a.frag", "lib/x.glsl", "lib/y.glsl", "x.glsl"]);
        assert_eq!(names(graph.includes(&"a.frag".into())), ["x.glsl", "lib/y.glsl"]);
        assert_eq!(names(graph.includes(&"lib/y.glsl".into())), ["lib/x.glsl"]);
        assert_eq!(names(graph.included_by(&"lib/y.glsl".into())), ["a.frag"]);
        assert_eq!(names(graph.included_by(&"x.glsl".into())), ["a.frag"]);
        assert!(names(graph.included_by(&"a.frag".into())).is_empty());

        // An edit changes what its file includes, and nothing else. A file that is gone is looked for at the next place.
        texts.insert("a.frag".into(), Arc::from("#include \"lib/x.glsl\"\n"));
        texts.remove(&"lib/x.glsl".into());
        let edited = IncludeGraph::new(&texts, graph);
        assert!(names(edited.includes(&"a.frag".into())).is_empty());
        assert_eq!(names(edited.includes(&"lib/y.glsl".into())), ["x.glsl"]);
        assert_eq!(edited, IncludeGraph::new(&texts, IncludeGraph::default()));
    }
}
