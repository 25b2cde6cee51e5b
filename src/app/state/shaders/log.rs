//! Log of the last shader edits: the stages that they reached, the time of each step, and failures.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use chrono::{DateTime, Local};

use crate::events::{CompletedEvent, ReloadEvent, in_short};
use crate::shader::Report;

/// Number of edits that are kept.
const MOST: usize = 64;

/// An edit, and the time of each of its steps.
#[derive(Clone, Debug)]
pub(in crate::app) struct Edit {
    pub(in crate::app) at: DateTime<Local>,
    pub(in crate::app) reload: ReloadEvent,
    /// The stages that were compiled after the picture was on screen.
    pub(in crate::app) rest: Option<CompletedEvent>,
}

impl Edit {
    /// The times of the steps: `4 + 9 + 16 ms` to compile, for the pipelines, and for the first frame.
    pub(in crate::app) fn times(&self) -> String {
        let ReloadEvent { compile_ms, pipeline_ms, first_frame_ms, ok, .. } = &self.reload;
        match ok {
            true => format!("{compile_ms:.0} + {pipeline_ms:.0} + {first_frame_ms:.0} ms"),
            false => format!("failed after {compile_ms:.0} ms"),
        }
    }
}

/// The changed files without folders, and the stages that a reload has compiled: `ndf.glsl -> pbr.frag`.
pub(in crate::app) fn reached(reload: &ReloadEvent) -> String {
    let name = |path: &String| path.rsplit('/').next().unwrap_or(path).to_owned();
    let changed: Vec<String> = reload.changed.iter().map(name).collect();
    match (changed.as_slice(), reload.stages.as_slice()) {
        // A save that restores the last good text compiles nothing, nor does the end of a watched expression.
        ([], []) => "back to the shaders of before".to_owned(),
        ([], stages) => format!("start -> {}", in_short(stages)),
        (changed, stages) => format!("{} -> {}", changed.join(" "), in_short(stages)),
    }
}

/// Three texts: the changed files with the compiled stages, the time of each step, and a hover text with the details.
pub(in crate::app) fn lines(last: &ReloadEvent) -> (String, String, String) {
    let stages = if last.stages.is_empty() { "nothing to do".to_owned() } else { last.stages.join(" ") };
    let times = match last.ok {
        true => format!(
            "{:.0} ms compile + {:.0} ms pipeline + {:.0} ms frame",
            last.compile_ms, last.pipeline_ms, last.first_frame_ms
        ),
        false => format!("failed after {:.0} ms", last.compile_ms),
    };
    let hover = format!(
        "{}\n-> {stages}\n{times}\nDetected {:.1} ms after the first file event. The frame is the first one with the new shaders.",
        if last.changed.is_empty() { "start".to_owned() } else { last.changed.join("\n") },
        last.detect_ms
    );
    (reached(last), times, hover)
}

/// The last edits, the newest first.
#[derive(Default)]
pub(in crate::app) struct ShaderLog {
    edits: VecDeque<Edit>,
    /// Latest compile time of each stage, in milliseconds.
    compile_ms: BTreeMap<String, f64>,
    /// Stages whose last text does not compile.
    failed: BTreeSet<String>,
    /// Edited files, as displayed, that wait for the repair of others.
    waiting: Vec<String>,
}

impl ShaderLog {
    /// Records what a reload has compiled. `is_good`: the edit has no errors.
    pub(in crate::app) fn compiled(&mut self, report: &Report, is_good: bool) {
        self.compile_ms.extend(report.stages.iter().cloned());
        let is_again = |stage: &String| report.stages.iter().any(|(compiled, _)| compiled == stage);
        self.failed.retain(|stage| !is_good && !is_again(stage));
        self.failed.extend(report.failed.iter().cloned());
        self.waiting.clone_from(&report.waiting);
    }

    /// Records a finished reload.
    pub(in crate::app) fn finished(&mut self, reload: &ReloadEvent) {
        self.edits.push_front(Edit { at: Local::now(), reload: reload.clone(), rest: None });
        self.edits.truncate(MOST);
    }

    /// Forgets the edits, since another tree was opened.
    pub(in crate::app) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Records the stages that were compiled after the picture was on screen.
    pub(in crate::app) fn completed(&mut self, event: &CompletedEvent) {
        let of = self.edits.iter_mut().find(|edit| edit.reload.ok && edit.reload.generation == event.generation);
        if let Some(edit) = of {
            edit.rest = Some(event.clone());
        }
    }

    pub(in crate::app) fn edits(&self) -> impl ExactSizeIterator<Item = &Edit> {
        self.edits.iter()
    }

    pub(in crate::app) fn compile_ms(&self, stage: &str) -> Option<f64> {
        self.compile_ms.get(stage).copied()
    }

    pub(in crate::app) fn has_failed(&self, stage: &str) -> bool {
        self.failed.contains(stage)
    }

    /// Whether a file, as displayed, waits for the repair of others.
    pub(in crate::app) fn is_waiting(&self, file: &str) -> bool {
        self.waiting.iter().any(|waiting| waiting == file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(stages: &[&str], failed: &[&str], waiting: &[&str]) -> Report {
        Report {
            stages: stages.iter().map(|stage| ((*stage).to_owned(), 2.0)).collect(),
            failed: failed.iter().map(|stage| (*stage).to_owned()).collect(),
            waiting: waiting.iter().map(|file| (*file).to_owned()).collect(),
            ..Report::default()
        }
    }

    #[test]
    fn a_stage_has_failed_until_it_compiles_again() {
        let mut log = ShaderLog::default();
        log.compiled(&report(&["a.frag", "b.frag"], &["a.frag"], &["x.glsl"]), false);
        assert!(log.has_failed("a.frag") && !log.has_failed("b.frag") && log.is_waiting("x.glsl"));
        // An edit of another stage does not repair it.
        log.compiled(&report(&["b.frag"], &["b.frag"], &[]), false);
        assert!(log.has_failed("a.frag") && log.has_failed("b.frag") && !log.is_waiting("x.glsl"));
        log.compiled(&report(&["a.frag"], &[], &[]), false);
        assert!(!log.has_failed("a.frag") && log.has_failed("b.frag"));
        // Restoring the last good text compiles nothing.
        log.compiled(&report(&[], &[], &[]), true);
        assert!(!log.has_failed("b.frag"));
        assert_eq!((log.compile_ms("a.frag"), log.compile_ms("c.frag")), (Some(2.0), None));
    }

    #[test]
    fn edits_of_another_tree_are_forgotten() {
        let mut log = ShaderLog::default();
        let of = |generation| ReloadEvent { generation, ok: true, ..ReloadEvent::default() };
        (1..=3).for_each(|generation| log.finished(&of(generation)));
        log.completed(&CompletedEvent { generation: 2, compile_ms: 5.0, ..CompletedEvent::default() });
        let generations = |log: &ShaderLog| log.edits().map(|edit| edit.reload.generation).collect::<Vec<_>>();
        assert_eq!(generations(&log), [3, 2, 1]);
        assert_eq!(log.edits().map(|edit| edit.rest.is_some()).collect::<Vec<_>>(), [false, true, false]);
        log.forget();
        log.finished(&of(1));
        assert_eq!(generations(&log), [1]);
    }
}
