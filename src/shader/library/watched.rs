//! The stage that shows a watched expression, beside the stages of the tree. Its errors cost its mode alone.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::slot::{Broken, Done, Slot};
use super::{Change, Library};
use crate::shader::annotation;
use crate::shader::annotation::pass::MODEL;
use crate::shader::compile::StageKind;
use crate::shader::compile::include::files_of;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::expression::{Expression, Overlay, STAGE, follow};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::{Read, Snapshot};

/// A watched expression, and the current place of its line.
pub(super) struct Watched {
    expression: Expression,
    line: u32,
    /// The file when `line` was found, and its text at that time.
    file: Option<(TreePath, Arc<str>)>,
}

/// A snapshot of the tree with the stage of the watched expression.
pub(super) struct View<'a> {
    pub snapshot: Snapshot<'a>,
    /// Snapshot and overlay for the stage of the watched expression.
    watched: Option<(Snapshot<'a>, Overlay)>,
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

/// Whether a stage is that of the watched expression.
pub(super) fn is_watched(stage: &TreePath) -> bool {
    stage.as_str() == STAGE
}

impl Library {
    /// Watches another expression, or none. Returns the paths that the next update must name, if anything differs.
    pub fn watch(&mut self, expression: Option<Expression>) -> Option<Change> {
        if self.watched.as_ref().map(|watched| &watched.expression) == expression.as_ref() {
            return None;
        }
        // The same expression with the current place of its line.
        if let (Some(watched), Some(new)) = (&mut self.watched, &expression)
            && (Expression { line: watched.line, ..watched.expression.clone() }) == *new
        {
            watched.expression = new.clone();
            return None;
        }
        self.watched = expression.map(|expression| Watched { line: expression.line, expression, file: None });
        Some(Change::Paths(BTreeSet::from([TreePath::from(STAGE)])))
    }

    /// The watched expression and its line, after edits above it.
    pub(super) fn watched(&self) -> Option<(Expression, u32)> {
        self.watched.as_ref().map(|watched| (watched.expression.clone(), watched.line))
    }

    /// The snapshot for a stage. Finds the line of the watched expression in it.
    pub(super) fn view<'a>(&mut self, snapshot: Snapshot<'a>) -> View<'a> {
        self.find_watched();
        let Some(watched) = &mut self.watched else { return View { snapshot, watched: None } };
        if let Some((path, old)) = &watched.file
            && let Ok(new) = snapshot.read(path)
            && new != *old
        {
            watched.line = follow(old, &new, watched.line);
        }
        let host = self.slots.iter().map(|slot| &slot.path).find(|path| {
            StageKind::of(path) == Some(StageKind::Fragment)
                && annotation::passes_of(&snapshot, path).any(|desc| desc.name == MODEL)
        });
        let host = host.cloned().unwrap_or_else(|| TreePath::from("pbr.frag"));
        let overlay = Overlay::new(&watched.expression, watched.line, &host, &snapshot);
        watched.file = overlay.file.clone().and_then(|path| {
            let text = snapshot.read(&path).ok()?;
            Some((path, text))
        });
        let read = |text: &Arc<str>| -> Read { Ok(text.clone()) };
        overlay.files.iter().for_each(|(path, text)| snapshot.put(path, read(text)));
        let edited = overlay.edited.iter().map(|(path, text)| (path.clone(), read(text))).collect();
        let seen = snapshot.over(edited);
        View { snapshot, watched: Some((seen, overlay)) }
    }

    /// Adds the stage of the watched expression, or removes it.
    fn find_watched(&mut self) {
        let place = self.slots.iter().position(|slot| is_watched(&slot.path));
        match (&self.watched, place) {
            (Some(_), None) => self.slots.push(Slot::new(TreePath::from(STAGE))),
            (None, Some(place)) => {
                self.slots.remove(place);
                self.relink = true;
            }
            _ => {}
        }
    }
}
