//! The stages that lie beside the stages of passes: all those before the rasterizer. Their files declare them.

use std::collections::BTreeSet;

use super::Library;
use super::slot::StageSlot;
use crate::shader::compile::StageKind;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::expression::is_watched;
use crate::shader::graph::stage_beside;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};

/// Whether the file is a stage that needs a pass beside it. A vertex stage may also belong to the stages that Specula itself
/// draws with.
pub(super) fn may_be_beside(path: &TreePath) -> bool {
    let kind = StageKind::of(path).filter(|kind| *kind != StageKind::Vertex);
    kind.is_some_and(StageKind::is_pre_rasterization)
}

/// The stage that declares the pass of a stage: itself, or the fragment stage beside a pre-rasterization stage.
pub(super) fn fragment_of(path: &TreePath) -> TreePath {
    match StageKind::of(path) {
        Some(kind) if kind.is_pre_rasterization() => beside(path, StageKind::Fragment),
        _ => path.clone(),
    }
}

fn beside(path: &TreePath, kind: StageKind) -> TreePath {
    TreePath::from(stage_beside(path.as_str(), kind).as_str())
}

impl Library {
    /// Adds the stages beside the stages of passes, and removes those whose pass is gone.
    pub(super) fn find_stages_beside(&mut self, snapshot: &Snapshot<'_>) {
        let passes = self.slots.iter().skip(self.fixed);
        let passes = passes.filter(|slot| StageKind::of(&slot.path) == Some(StageKind::Fragment));
        let found: BTreeSet<TreePath> = passes
            .flat_map(|slot| StageKind::PRE_RASTERIZATION.map(|kind| beside(&slot.path, kind)))
            .filter(|path| snapshot.read(path) != Err(SourceError::Missing))
            .collect();
        let known = self.slots.len();
        let fixed: BTreeSet<TreePath> = self.slots.iter().take(self.fixed).map(|slot| slot.path.clone()).collect();
        self.slots.retain(|slot| {
            let is_own = StageKind::of(&slot.path).is_some_and(StageKind::is_pre_rasterization);
            !is_own || is_watched(&slot.path) || fixed.contains(&slot.path) || found.contains(&slot.path)
        });
        self.relink |= self.slots.len() != known;
        for path in found {
            if self.slots.iter().all(|slot| slot.path != path) {
                self.slots.push(StageSlot::new(path));
                self.relink = true;
            }
        }
    }

    /// A warning for each tessellation, geometry, task or mesh stage in `passes/` that has no pass beside it.
    pub(super) fn stray_warnings(&self, snapshot: &Snapshot<'_>) -> impl Iterator<Item = Diagnostic> {
        let is_pass = |path: &TreePath| self.slots.iter().any(|slot| slot.path == *path);
        let has_pass = move |path: &TreePath| {
            [StageKind::Fragment, StageKind::Compute].iter().any(|kind| is_pass(&beside(path, *kind)))
        };
        let stray = self.beside.iter().filter(|path| path.as_str().starts_with("passes/"));
        stray.filter(move |path| !has_pass(path)).map(|path| {
            let fragment = beside(path, StageKind::Fragment);
            let message = format!("nothing draws with this file: {fragment} declares no pass");
            let name = path.stem().rsplit('/').next().unwrap_or_default();
            let help = format!("begin {fragment} with `//@pass {name} draw=model to=picture`");
            Diagnostic::warning(snapshot.display_path(path), message).with_help(help)
        })
    }
}
