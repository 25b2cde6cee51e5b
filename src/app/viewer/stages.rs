//! Keeps the table of stages up to date, and lets the worker ask the driver about their code.

use super::Viewer;

impl Viewer {
    /// Updates the table of stages, if the shaders or the picture have changed.
    pub(in crate::app) fn update_stages(&mut self) {
        let Some(state) = self.shown.as_ref().map(|shown| shown.frame.state.clone()) else { return };
        let is_settled = self.is_settled();
        let Some(set) = self.resources.pipelines() else { return };
        // Until the newest shaders are on screen, the table tells of those that are.
        if set.shaders.generation != state.shaders.generation {
            return;
        }
        if self.stages.is_outdated(set, &state.pipelines) {
            let before = self.versions.set_before(state.shaders.generation);
            self.stages.update(set, &state.pipelines, before, &self.shader.log);
        }
        if self.shader.asks_driver && is_settled && self.shader.told.as_ref() != Some(&state.pipelines) {
            self.shader.told = Some(state.pipelines.clone());
            self.threads.worker.ask_driver(set, &state.pipelines);
        }
    }

    /// Whether the newest shaders are on screen with all of their stages and light.
    pub(in crate::app) fn is_settled(&self) -> bool {
        let newest = self.session.shaders.as_ref().map(|shaders| shaders.generation);
        self.is_complete && newest.is_some() && self.settled == newest
    }

    /// Takes note that what is known of the stages has changed.
    pub(super) fn stages_changed(&mut self) {
        self.stages.invalidate();
    }
}
