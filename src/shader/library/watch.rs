//! Adds the stages of the watched expression to a library, and finds the expression's line again after edits.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::slot::StageSlot;
use super::watched::{View, Watched};
use super::{Change, Library};
use crate::shader::expression::{Expression, Overlay, STAGE, VERTEX, Watching, follow, hosts, is_watched};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::{Read, Snapshot};

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
        Some(Change::Paths(BTreeSet::from([STAGE, VERTEX].map(TreePath::from))))
    }

    /// The watched expression as the next set tells it.
    pub(super) fn watching(&self) -> Option<Watching> {
        let Watched { expression, line, .. } = self.watched.as_ref()?;
        let slots = self.slots.iter().filter(|slot| is_watched(&slot.path));
        let mut broken = slots.filter_map(|slot| slot.current.as_ref()?.as_ref().err());
        let error = broken.find_map(|broken| broken.diagnostics.first().cloned());
        Some(Watching { expression: expression.clone(), line: *line, error })
    }

    /// The snapshot for a stage. Finds the line of the watched expression in it.
    pub(super) fn view<'a>(&mut self, snapshot: Snapshot<'a>) -> View<'a> {
        let Some(watched) = &mut self.watched else {
            self.set_watched(&[]);
            return View { snapshot, watched: None };
        };
        if let Some((path, old)) = &watched.file
            && let Ok(new) = snapshot.read(path)
            && new != *old
        {
            watched.line = follow(old, &new, watched.line);
        }
        let stages = self.slots.iter().map(|slot| &slot.path).filter(|path| !is_watched(path));
        let hosts = hosts(stages, &snapshot);
        let overlay = Overlay::new(&watched.expression, watched.line, &hosts, &snapshot);
        watched.file = overlay.file.clone().and_then(|path| {
            let text = snapshot.read(&path).ok()?;
            Some((path, text))
        });
        let read = |text: &Arc<str>| -> Read { Ok(text.clone()) };
        overlay.files.iter().for_each(|(path, text)| snapshot.put(path, read(text)));
        let edited = overlay.edited.iter().map(|(path, text)| (path.clone(), read(text))).collect();
        let seen = snapshot.over(edited);
        let has_vertices = overlay.files.contains_key(&TreePath::from(VERTEX));
        self.set_watched(if has_vertices { &[STAGE, VERTEX] } else { &[STAGE] });
        View { snapshot, watched: Some((seen, overlay)) }
    }

    /// Adds and removes stages, so that these are the stages of the watched expression.
    fn set_watched(&mut self, stages: &[&str]) {
        let known = self.slots.len();
        self.slots.retain(|slot| !is_watched(&slot.path) || stages.contains(&slot.path.as_str()));
        self.relink |= self.slots.len() != known;
        for stage in stages {
            if self.slots.iter().all(|slot| slot.path.as_str() != *stage) {
                self.slots.push(StageSlot::new(TreePath::from(*stage)));
            }
        }
    }
}
