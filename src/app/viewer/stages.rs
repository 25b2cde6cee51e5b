//! Keeps the table of stages up to date, and lets the worker ask the driver about their code.

use super::Viewer;
use crate::shader::expression::is_about_expression;
use crate::shader::{Diagnostic, Severity};

impl Viewer {
    /// Updates the table of stages, if the shaders or the picture have changed.
    pub(in crate::app) fn update_stages(&mut self) {
        let Some(state) = self.shown.as_ref().map(|shown| shown.frame.state.clone()) else { return };
        let is_settled = self.is_settled();
        let Some(set) = self.resources.pipelines() else { return };
        // Until the newest shaders are on screen, the table describes the current ones.
        if set.shaders.generation != state.shaders.generation {
            return;
        }
        if self.stages.is_outdated(set, &state.pipelines) {
            let before = self.versions.last_before(state.shaders.generation);
            let before = before.and_then(|version| self.generations.set(version.number));
            self.stages.update(set, &state.pipelines, before, &self.shader.log);
        }
        if self.shader.asks_driver && is_settled && self.shader.told.as_ref() != Some(&state.pipelines) {
            self.shader.told = Some(state.pipelines.clone());
            self.threads.worker.ask_driver(set, &state.pipelines);
        }
    }

    /// Whether the last frame is final, so that the same inputs draw the same picture again: no edit and no model is on its way, the
    /// light of the settings is baked, and every stage is compiled. After an error, a stage that is missing stays so until the next edit.
    pub(in crate::app) fn is_settled(&self) -> bool {
        let is_complete = self.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
        let awaits = self.awaits_edit() || self.model.loading;
        self.shows_settings && !awaits && (is_complete || self.has_errors())
    }

    /// Whether the shaders have errors.
    pub(in crate::app) fn has_errors(&self) -> bool {
        self.errors().next().is_some()
    }

    /// The errors of the shaders. A watched expression that does not compile does not count.
    pub(in crate::app) fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        let is_error = |found: &&Diagnostic| found.severity == Severity::Error && !is_about_expression(found);
        self.session.diagnostics.iter().filter(is_error)
    }

    /// Marks the statistics of the stages as changed.
    pub(super) fn stages_changed(&mut self) {
        self.stages.invalidate();
    }
}
