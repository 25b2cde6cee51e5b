//! The stages that show a watched expression, beside the stages of the tree. Their errors cost its mode alone.

use std::sync::Arc;

use super::slot::{Broken, Done};
use crate::shader::compile::include::files_of;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::expression::{Expression, Overlay, is_watched};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// A watched expression, and the current place of its line.
pub(super) struct Watched {
    pub expression: Expression,
    pub line: u32,
    /// The file when `line` was found, and its text at that time.
    pub file: Option<(TreePath, Arc<str>)>,
}

/// A snapshot of the tree with the stages of the watched expression.
pub(super) struct View<'a> {
    pub snapshot: Snapshot<'a>,
    /// Snapshot and overlay for the stages of the watched expression.
    pub watched: Option<(Snapshot<'a>, Overlay)>,
}

impl<'a> View<'a> {
    /// The snapshot that a stage is compiled from.
    pub fn of(&self, stage: &TreePath) -> &Snapshot<'a> {
        match &self.watched {
            Some((snapshot, _)) if is_watched(stage) => snapshot,
            _ => &self.snapshot,
        }
    }

    /// The outcome of a stage that cannot be compiled, since the line of its expression was not found.
    pub fn refused(&self, stage: &TreePath) -> Option<Done> {
        let (snapshot, overlay) = self.watched.as_ref().filter(|_| is_watched(stage))?;
        let diagnostics = vec![overlay.error.clone()?];
        let mut dependencies = files_of(snapshot, stage);
        dependencies.extend(overlay.file.clone());
        let hash = snapshot.closure_hash(&dependencies);
        Some(Done { outcome: Err(Broken { hash, dependencies, diagnostics }), ms: None })
    }

    /// The outcome of a stage, with diagnostics for the author.
    pub fn explained(&self, stage: &TreePath, mut done: Done) -> Done {
        let Some((snapshot, overlay)) = self.watched.as_ref().filter(|_| is_watched(stage)) else { return done };
        let rename = |diagnostic: Diagnostic| overlay.renamed(diagnostic, snapshot);
        match &mut done.outcome {
            Ok(built) => built.warnings = std::mem::take(&mut built.warnings).into_iter().map(rename).collect(),
            Err(broken) => {
                let all: Vec<_> = std::mem::take(&mut broken.diagnostics).into_iter().map(rename).collect();
                broken.diagnostics = overlay.explained(&all);
            }
        }
        done
    }
}
