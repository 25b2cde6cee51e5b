//! Undo and redo of settings, and of files that the window wrote.

use std::sync::Arc;

use crate::settings::Settings;
use crate::write_back::Written;

/// Most undo steps that are kept.
const STEPS: usize = 100;

/// A step that can be undone or redone.
struct Step {
    /// The settings on its other side.
    settings: Arc<Settings>,
    /// The files that it wrote.
    files: Option<Arc<Written>>,
}

/// The settings before and after each change, except the camera, the mode, the watched expression and the orbiting lights, and the files that
/// were written.
#[derive(Default)]
pub(in crate::app) struct History {
    past: Vec<Step>,
    future: Vec<Step>,
    /// The settings when they were last recorded.
    last: Option<Arc<Settings>>,
}

/// The changes of a step besides the settings.
pub(in crate::app) type Files = Option<Arc<Written>>;

impl History {
    /// Records the settings of a frame as an undo step if they have changed. `is_held`: a control is being dragged, so the
    /// current step is extended.
    pub(in crate::app) fn record(&mut self, now: &Arc<Settings>, is_held: bool) {
        let Some(last) = &self.last else {
            self.last = Some(now.clone());
            return;
        };
        if is_held || Arc::ptr_eq(last, now) || last.is_other_view(now) {
            return;
        }
        self.push(now, None);
    }

    /// Records that files were written, as a step of its own.
    pub(in crate::app) fn record_files(&mut self, now: &Arc<Settings>, written: Written) {
        self.record(now, false);
        self.push(now, Some(Arc::new(written)));
    }

    /// Takes changed settings as a part of the last step.
    pub(in crate::app) fn extend(&mut self, now: &Arc<Settings>) {
        self.last = Some(now.clone());
    }

    fn push(&mut self, now: &Arc<Settings>, files: Files) {
        let settings = self.last.replace(now.clone());
        self.past.extend(settings.map(|settings| Step { settings, files }));
        self.past.drain(..self.past.len().saturating_sub(STEPS));
        self.future.clear();
    }

    /// Undoes the last step. Returns the files to take back, or `None` if there is no step.
    pub(in crate::app) fn undo(&mut self, now: &mut Settings) -> Option<Files> {
        self.record(&Arc::new(now.clone()), false);
        Self::step(&mut self.past, &mut self.future, &mut self.last, now)
    }

    /// Redoes the last undone step. Returns the files to write again, or `None` if there is no step.
    pub(in crate::app) fn redo(&mut self, now: &mut Settings) -> Option<Files> {
        self.record(&Arc::new(now.clone()), false);
        Self::step(&mut self.future, &mut self.past, &mut self.last, now)
    }

    fn step(
        from: &mut Vec<Step>,
        to: &mut Vec<Step>,
        last: &mut Option<Arc<Settings>>,
        now: &mut Settings,
    ) -> Option<Files> {
        let Step { settings, files } = from.pop()?;
        to.push(Step { settings: Arc::new(now.clone()), files: files.clone() });
        *now = with_view_of(&settings, now);
        *last = Some(Arc::new(now.clone()));
        Some(files)
    }
}

/// `settings` with the camera, the mode, the watched expression and the orbiting lights of `view`.
fn with_view_of(settings: &Settings, view: &Settings) -> Settings {
    let turns = view.lights.spin != 0.0;
    let lights = if turns { settings.lights.turned_as(&view.lights) } else { settings.lights.clone() };
    let (camera, mode, expression) = (view.camera.clone(), view.mode.clone(), view.expression.clone());
    Settings { camera, mode, expression, lights, ..settings.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_ev(ev: f32) -> Settings {
        let mut settings = Settings::default();
        settings.view.ev = ev;
        settings
    }

    fn record(history: &mut History, now: &Settings, is_held: bool) {
        history.record(&Arc::new(now.clone()), is_held);
    }

    #[test]
    fn steps_go_back_and_forth() {
        let (mut history, mut now) = (History::default(), with_ev(0.0));
        record(&mut history, &now, false);
        for ev in [1.0, 2.0] {
            now.view.ev = ev;
            record(&mut history, &now, false);
        }
        assert!(history.undo(&mut now).is_some() && now.view.ev == 1.0);
        assert!(history.undo(&mut now).is_some() && now.view.ev == 0.0);
        assert!(history.undo(&mut now).is_none() && now.view.ev == 0.0, "nothing is left");
        assert!(history.redo(&mut now).is_some() && history.redo(&mut now).is_some() && now.view.ev == 2.0);
        assert!(history.redo(&mut now).is_none());
        // A change after an undo discards the undone steps.
        assert!(history.undo(&mut now).is_some());
        now.view.ev = 5.0;
        record(&mut history, &now, false);
        assert!(history.redo(&mut now).is_none() && now.view.ev == 5.0);
    }

    #[test]
    fn a_drag_is_one_step() {
        let (mut history, mut now) = (History::default(), with_ev(0.0));
        record(&mut history, &now, false);
        for ev in [1.0, 2.0, 3.0] {
            now.view.ev = ev;
            record(&mut history, &now, true);
        }
        record(&mut history, &now, false);
        assert!(history.undo(&mut now).is_some() && now.view.ev == 0.0);
    }

    #[test]
    fn the_view_is_no_step_and_stays() {
        let (mut history, mut now) = (History::default(), with_ev(0.0));
        record(&mut history, &now, false);
        now.camera.azimuth = 70.0;
        (now.mode, now.expression.at) = ("expression".into(), "brdf/ndf.glsl:21 a2".into());
        now.lights.spin = 30.0;
        record(&mut history, &now, false);
        now.lights.orbit[0].azimuth += 10.0;
        record(&mut history, &now, false);
        let azimuth = now.lights.orbit[0].azimuth;
        now.view.ev = 1.0;
        record(&mut history, &now, false);
        assert!(history.undo(&mut now).is_some());
        assert_eq!((now.view.ev, now.camera.azimuth, now.mode.as_str()), (0.0, 70.0, "expression"));
        assert_eq!(now.expression.at, "brdf/ndf.glsl:21 a2");
        assert_eq!(now.lights.orbit[0].azimuth, azimuth);
        // The previous step is that the lights began to orbit.
        assert!(history.undo(&mut now).is_some() && now.lights.spin == 0.0);
        assert!(history.undo(&mut now).is_none());
    }

    #[test]
    fn only_the_newest_steps_are_kept() {
        let (mut history, mut now) = (History::default(), with_ev(0.0));
        for ev in 0..300 {
            now.view.ev = ev as f32 * 0.01;
            record(&mut history, &now, false);
        }
        let mut steps = 0;
        while history.undo(&mut now).is_some() {
            steps += 1;
        }
        assert_eq!(steps, STEPS);
    }
}
