//! Compiled stages of earlier processes on disk, so that a start compiles only what has changed since.
//!
//! A stage has two entries. The first, named by the stage's path and text, lists the paths that its compilation read or looked for.
//! The second, the module, is named by these paths and their texts, so it is never stale. A stage with an error or a warning has none:
//! each start reports it again.

use std::collections::BTreeSet;

use super::Compiled;
use crate::disk_cache;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};

const FOLDER: &str = "stages";
/// The two kinds of entries. Their names differ also for a stage that includes nothing.
const LIST: &str = "list";
const MODULE: &str = "module";
/// A hash of the sources that make a module of a text, and of the versions of all libraries. The build script computes it.
const COMPILER: &str = env!("SPECULA_COMPILER");

/// The stage as an earlier process compiled it, if its text and all that it includes are the same.
pub fn load(snapshot: &Snapshot<'_>, stage: &TreePath) -> Option<Compiled> {
    let list = disk_cache::read(FOLDER, &key(LIST, snapshot, stage, [stage])?)?;
    let dependencies: BTreeSet<TreePath> = String::from_utf8(list).ok()?.lines().map(TreePath::from).collect();
    let module = disk_cache::read(FOLDER, &key(MODULE, snapshot, stage, &dependencies)?)?;
    let spirv = bytemuck::pod_collect_to_vec(&module);
    Some(Compiled { result: Ok(spirv), warnings: Vec::new(), dependencies })
}

/// Stores a stage that compiled without a warning.
pub fn store(snapshot: &Snapshot<'_>, stage: &TreePath, compiled: &Compiled) {
    let Ok(spirv) = compiled.result.as_ref() else { return };
    let keys = key(LIST, snapshot, stage, [stage]).zip(key(MODULE, snapshot, stage, &compiled.dependencies));
    if let Some((list, module)) = keys.filter(|_| compiled.warnings.is_empty()) {
        let paths: Vec<&str> = compiled.dependencies.iter().map(TreePath::as_str).collect();
        disk_cache::store_in(FOLDER, &list, paths.join("\n").as_bytes());
        disk_cache::store_in(FOLDER, &module, bytemuck::cast_slice(spirv));
    }
}

/// The name of an entry of a kind that depends on the texts of these files. `None` if one of them cannot be read.
fn key<'p>(
    kind: &str,
    snapshot: &Snapshot<'_>,
    stage: &TreePath,
    paths: impl IntoIterator<Item = &'p TreePath>,
) -> Option<String> {
    let mut parts: Vec<Vec<u8>> = [COMPILER, kind, stage.as_str()].map(|part| part.as_bytes().to_vec()).into();
    for path in paths {
        parts.push(path.as_str().into());
        match snapshot.read(path) {
            // A file that is absent differs from one that is empty.
            Ok(text) => parts.push([b"+", text.as_bytes()].concat()),
            Err(SourceError::Missing) => parts.push(Vec::new()),
            Err(_) => return None,
        }
    }
    let parts: Vec<&[u8]> = parts.iter().map(Vec::as_slice).collect();
    Some(disk_cache::key(&parts))
}
