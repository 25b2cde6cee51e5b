//! `specula check`: finds all errors in a tree that can be found without a device.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::missing::folded;
use super::{Change, Library, Update};
use crate::shader::compile::StageKind;
use crate::shader::compile::include::files_of;
use crate::shader::contract::{self, Texts};
use crate::shader::diagnostic::{Diagnostic, unique};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::reflect::Reflection;

/// Updates the library, then compiles everything that its entry points do not reach: unknown stages, and every `.glsl`
/// on its own (a library must include what it uses). Returns errors first, then warnings. Specialization constants do
/// not affect compilation, so their values are not checked here.
pub fn check(library: &mut Library) -> Vec<Diagnostic> {
    let mut out = match library.update(&Change::All) {
        Update::Failed(diagnostics, _) => diagnostics,
        Update::Ready(..) | Update::Unchanged { .. } => {
            library.set().map(|set| set.warnings.clone()).unwrap_or_default()
        }
    };
    let known: BTreeSet<&TreePath> = library.stages().collect();
    let rest: Vec<TreePath> = library.source().list().into_iter().filter(|path| !known.contains(path)).collect();
    let found = check_alone(library, &rest);
    out.extend(found);
    out.sort_by_key(|diagnostic| diagnostic.severity);
    folded(unique(out), library.source())
}

/// Compiles files that are no entry points of the library, each on its own. Files of other kinds, and libraries of mesh stages that no
/// stage includes, have no diagnostics.
pub fn check_alone(library: &Library, files: &[TreePath]) -> Vec<Diagnostic> {
    let snapshot = Snapshot::new(library.source());
    let is_ours = |path: &TreePath| path.extension() == Some("glsl") || StageKind::of(path).is_some();
    let compiler = library.compiler();
    // A file that only stages of one kind include may use what only that kind has, as gl_VertexIndex or barrier(). The includes
    // are read from the texts, since a stage with an error has not compiled.
    let mut kinds: BTreeMap<TreePath, Vec<StageKind>> = BTreeMap::new();
    for stage in library.stages() {
        for file in files_of(&snapshot, stage) {
            kinds.entry(file).or_default().extend(StageKind::of(stage));
        }
    }
    let kind_of = |path: &TreePath| match (StageKind::of(&path.stem().into()), kinds.get(path).map(Vec::as_slice)) {
        // The name gives the kind, as model.geom.glsl.
        (Some(named), _) => named,
        (None, Some([first, others @ ..])) if others.iter().all(|kind| kind == first) => *first,
        _ => StageKind::Fragment,
    };
    // A library of mesh stages that no stage includes is skipped: it calls `user_vertex`, which may use what only vertex stages
    // have.
    let is_unused = |path: &TreePath| {
        StageKind::of(&path.stem().into()).is_some_and(StageKind::is_of_mesh_pipeline) && !kinds.contains_key(path)
    };
    files
        .par_iter()
        .filter(|path| is_ours(path) && !is_unused(path))
        .flat_map_iter(|path| {
            let compiled = match StageKind::of(path) {
                Some(_) => compiler.compile(&snapshot, path),
                None => compiler.compile_library(&snapshot, path, kind_of(path)),
            };
            let texts = Texts { snapshot: &snapshot, stage: path, dependencies: &compiled.dependencies };
            let judged = match compiled.result {
                Ok(spirv) => contract::check(&Reflection::of(&spirv), texts),
                Err(errors) => errors,
            };
            judged.into_iter().chain(compiled.warnings)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::shader::{Compiler, Source};

    #[test]
    fn an_error_elsewhere_does_not_hide_the_kind_of_a_library() {
        let source = Source::memory([
            ("a.vert", "#version 460\n#include \"vertex.glsl\"\nvoid main() { gl_Position = place(); }\n"),
            ("vertex.glsl", "vec4 place() { return vec4(gl_VertexIndex); }\n"),
            ("b.frag", "#version 460\nvoid main() { nope; }\n"),
        ]);
        let mut library = Library::new(source, Arc::new(Compiler::new().unwrap()), &["a.vert", "b.frag"]);
        let lines: Vec<String> = check(&mut library).iter().map(Diagnostic::one_line).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("b.frag:2:15: error: 'nope'"), "{lines:#?}");
    }

    #[test]
    fn libraries_must_stand_alone() {
        let source = Source::memory([
            ("a.vert", "#version 460\n#include \"types.glsl\"\n#include \"use.glsl\"\nvoid main() {}\n"),
            ("types.glsl", "struct S { float x; };\n"),
            ("use.glsl", "float f(S s) { return s.x; }\n"),
            ("other.frag", "#version 460\nvoid main() { nope; }\n"),
        ]);
        let mut library = Library::new(source, Arc::new(Compiler::new().unwrap()), &["a.vert"]);
        let lines: Vec<String> = check(&mut library).iter().map(Diagnostic::one_line).collect();
        assert!(lines.iter().any(|line| line.starts_with("use.glsl:1:")), "{lines:#?}");
        assert!(lines.iter().any(|line| line.starts_with("other.frag:2:15: error: 'nope'")), "{lines:#?}");
        assert!(!lines.iter().any(|line| line.contains("types.glsl")), "{lines:#?}");
    }
}
