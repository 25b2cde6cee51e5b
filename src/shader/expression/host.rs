//! The pass in whose fragment or vertex stage an expression is watched.

use std::collections::BTreeSet;

use crate::message::did_you_mean;
use crate::shader::annotation;
use crate::shader::annotation::pass::{Instances, MODEL, PassDesc, PassTarget};
use crate::shader::compile::StageKind;
use crate::shader::compile::include::files_of;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::graph::stage_beside;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// The file of an expression, and the pass that shows it.
pub(super) struct Found {
    pub(super) path: TreePath,
    pub(super) host: PassDesc,
    /// The files that the stage of the pass includes, with its own.
    pub(super) files: BTreeSet<TreePath>,
    /// The vertex stage to copy, if the copy of the pass cannot have that of the model.
    pub(super) vertex: Option<VertexStage>,
}

/// The vertex stage of a pass.
pub(super) struct VertexStage {
    pub(super) path: TreePath,
    /// The files that it includes, with its own.
    pub(super) files: BTreeSet<TreePath>,
    /// Whether the expression is watched in it. Pixels show the value between those of their vertices.
    pub(super) is_watched: bool,
}

impl VertexStage {
    fn new(path: String, is_watched: bool, snapshot: &Snapshot<'_>) -> Self {
        let path = TreePath::from(path.as_str());
        Self { files: files_of(snapshot, &path), path, is_watched }
    }
}

/// The passes of these stages that can show an expression: a pixel of their picture has one value of it. The picture comes first.
pub fn hosts<'a>(stages: impl Iterator<Item = &'a TreePath>, snapshot: &Snapshot<'_>) -> Vec<PassDesc> {
    let fragments = stages.filter(|path| StageKind::of(path) == Some(StageKind::Fragment));
    let mut hosts: Vec<PassDesc> = fragments.flat_map(|path| annotation::passes_of(snapshot, path)).collect();
    hosts.retain(|desc| can_show(desc, || own(&desc.stage, snapshot).any(|kind| kind != StageKind::Vertex)));
    hosts.sort_by_key(|desc| match desc.to {
        _ if desc.name == MODEL => 0,
        PassTarget::Picture => 1,
        PassTarget::Display => 2,
        _ => 3,
    });
    hosts
}

/// Whether a pass of a fragment stage can show an expression. `has_more_stages`: it has stages of its own before the rasterizer besides a
/// vertex stage.
pub fn can_show(desc: &PassDesc, has_more_stages: impl FnOnce() -> bool) -> bool {
    let is_repeated = desc.to_picture() && desc.model.is_some_and(|instances| instances != Instances::Count(1));
    let is_sampled =
        desc.quads || desc.background || matches!(desc.to, PassTarget::Peel | PassTarget::Resolve | PassTarget::Mean);
    desc.instead.is_none() && !is_sampled && !is_repeated && (desc.name == MODEL || !has_more_stages())
}

/// The kinds of the stages before the rasterizer that lie beside a fragment stage.
fn own<'a>(stage: &'a str, snapshot: &'a Snapshot<'_>) -> impl Iterator<Item = StageKind> + 'a {
    let is_there = |kind: &StageKind| snapshot.read(&stage_beside(stage, *kind).as_str().into()).is_ok();
    StageKind::PRE_RASTERIZATION.into_iter().filter(is_there)
}

/// The vertex stage of a pass, if nothing is between it and the rasterizer: its own, or that of the model which it draws.
fn vertex_of(host: &PassDesc, hosts: &[PassDesc], snapshot: &Snapshot<'_>) -> Option<String> {
    let model = || hosts.iter().find(|other| other.name == MODEL && host.draws_model());
    let stage = [Some(host), model()].into_iter().flatten().find(|desc| own(&desc.stage, snapshot).next().is_some())?;
    own(&stage.stage, snapshot).eq([StageKind::Vertex]).then(|| stage_beside(&stage.stage, StageKind::Vertex))
}

/// Finds the file that the user means, and the first pass whose stage includes it. Fragment stages come before vertex stages.
pub(super) fn find(given: &str, hosts: &[PassDesc], snapshot: &Snapshot<'_>) -> Result<Found, Box<Diagnostic>> {
    let plain = given.trim_start_matches("./");
    let is_own = |host: &&PassDesc| host.stage == plain;
    let mut known = BTreeSet::new();
    for host in hosts.iter().filter(is_own).chain(hosts.iter().filter(|host| !is_own(host))) {
        let files = files_of(snapshot, &TreePath::from(host.stage.as_str()));
        if let Some(path) = file_of(given, plain, &files, snapshot)? {
            let own = vertex_of(host, &[], snapshot).filter(|_| host.name != MODEL);
            let vertex = own.map(|path| VertexStage::new(path, false, snapshot));
            return Ok(Found { path, host: host.clone(), files, vertex });
        }
        known.extend(files);
    }
    for host in hosts {
        let Some(vertex) = vertex_of(host, hosts, snapshot) else { continue };
        let vertex = VertexStage::new(vertex, true, snapshot);
        if let Some(path) = file_of(given, plain, &vertex.files, snapshot)? {
            let files = files_of(snapshot, &TreePath::from(host.stage.as_str()));
            return Ok(Found { path, host: host.clone(), files, vertex: Some(vertex) });
        }
        known.extend(vertex.files);
    }
    let is_there = TreePath::parse(plain).is_some_and(|path| snapshot.read(&path).is_ok());
    let message = if is_there {
        format!(
            "{given} is part of nothing whose values a pixel shows: expressions can be watched in the fragment stages of the \
             model and of passes and in the vertex stages right before these, not in other stages, bakes or debug modes"
        )
    } else {
        let hint = did_you_mean(plain, known.iter().map(TreePath::as_str));
        format!("no stage of the picture includes a file `{given}`.{hint}")
    };
    Err(Box::new(Diagnostic::error(given, message)))
}

/// The one of these files that is meant.
fn file_of(
    given: &str,
    plain: &str,
    files: &BTreeSet<TreePath>,
    snapshot: &Snapshot<'_>,
) -> Result<Option<TreePath>, Box<Diagnostic>> {
    let exact = || files.iter().find(|path| path.as_str() == plain || snapshot.display_path(path) == given).cloned();
    let absolute = std::path::absolute(given).ok();
    let changed = || absolute.iter().flat_map(|file| snapshot.source().changed(file));
    let by_place = || changed().find(|path| files.contains(path) && !path.as_str().starts_with("passes/"));
    // The author's `toy.glsl` comes before the library of that name.
    let found = if snapshot.source().is_toy() { by_place().or_else(exact) } else { exact().or_else(by_place) };
    if found.is_some() {
        return Ok(found);
    }
    let ends = |path: &&TreePath| path.as_str().strip_suffix(plain).is_some_and(|rest| rest.ends_with('/'));
    match files.iter().filter(ends).collect::<Vec<_>>().as_slice() {
        [] => Ok(None),
        [only] => Ok(Some((*only).clone())),
        [first, second, ..] => {
            let message = format!("`{given}` can be {first} or {second}; give more of the path");
            Err(Box::new(Diagnostic::error(given, message)))
        }
    }
}
