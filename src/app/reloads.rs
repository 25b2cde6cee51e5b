//! What the worker's results do to the document: a new generation of shaders, or why there is none.

use crate::events::{Event, ReloadEvent, emit};
use crate::render::{Outcome, Reload, misfits, unknown_names};

use super::document::{Document, FirstFrame};
use super::worker::WorkerMessage;

impl Document {
    pub(super) fn on_worker(&mut self, message: WorkerMessage) {
        match message {
            WorkerMessage::Built(Ok(())) => {}
            WorkerMessage::Built(Err(message)) => self.say(message),
            WorkerMessage::Reloaded { reload, detect_ms, tree } => {
                self.shader.compiling = false;
                self.shader.tree = tree;
                self.on_reload(*reload, detect_ms);
            }
        }
    }

    fn on_reload(&mut self, reload: Reload, detect_ms: f64) {
        let generation = self.shaders().map_or(0, |s| s.generation);
        match &reload.outcome {
            Outcome::Unchanged { cleared: false } => {}
            Outcome::Unchanged { cleared: true } => {
                self.diagnostics.clear();
                self.emit_reload(reload.event(generation, detect_ms, 0.0));
            }
            Outcome::Failed(diagnostics) => {
                for diagnostic in diagnostics {
                    eprintln!("{}", diagnostic.full());
                    emit(self.events, &Event::Diagnostic(diagnostic));
                }
                self.diagnostics.clone_from(diagnostics);
                self.emit_reload(reload.event(generation, detect_ms, 0.0));
            }
            Outcome::Ready(set) => {
                self.diagnostics.clone_from(&set.shaders.warnings);
                for warning in &self.diagnostics {
                    eprintln!("{}", warning.full());
                }
                let event = reload.event(set.shaders.generation, detect_ms, 0.0);
                self.first_frame = Some(FirstFrame { pipelines: set.clone(), event });
                let is_first = self.pipelines.replace(set.clone()).is_none();
                self.check_names(is_first);
            }
        }
    }

    /// Tells of values and modes that these shaders do not have; they are kept for the next edit. Names from the command line that
    /// never existed are told of once.
    fn check_names(&mut self, is_first: bool) {
        let Some(set) = &self.pipelines else { return };
        let mut problems = misfits(&self.settings.shader, &set.shaders);
        let slug = &self.settings.mode;
        if !set.shaders.modes.iter().any(|m| m.slug == *slug) {
            problems.push(format!("there is no mode '{slug}'; `specula modes` lists them all"));
        }
        if is_first {
            problems.extend(unknown_names(&self.settings.shader, &set.shaders));
        }
        if !problems.is_empty() {
            self.say(problems.join("\n"));
        }
    }

    pub(super) fn emit_reload(&mut self, event: ReloadEvent) {
        emit(self.events, &Event::Reload(event.clone()));
        self.shader.last = Some(event);
    }
}
