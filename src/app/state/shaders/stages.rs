//! The stages of the shaders on screen, with their state and what is known of their code.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::log::ShaderLog;
use crate::frame::PipelineRequest;
use crate::pipeline::{Figure, PipelineSet, StageReport, figures};
use crate::shader::{ShaderSet, StageKind, TreePath};

/// Current state of a shader stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::app) enum StageState {
    /// Its newest text does not compile.
    Failed,
    /// It draws the picture.
    OnScreen,
    /// It is not compiled yet.
    Pending,
    /// It bakes light or tables when they are needed.
    Bakes,
    /// The picture does not use it.
    Off,
}

impl StageState {
    pub(in crate::app) fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Failed => {
                ("failed", "Its newest version does not compile. The last version that compiled stays in use")
            }
            Self::OnScreen => ("on screen", "It draws the picture"),
            Self::Pending => ("pending", "It compiles once the picture with the edit is on screen"),
            Self::Bakes => ("bakes", "It computes light or tables, once for each environment and edit"),
            Self::Off => ("off", "The picture does not use it; another mode or a disabled pass does"),
        }
    }
}

/// A row of the table.
#[derive(Clone, Debug)]
pub(in crate::app) struct StageRow {
    pub(in crate::app) path: String,
    /// Its name for people: [`ShaderSet::name_of`].
    pub(in crate::app) name: String,
    pub(in crate::app) state: StageState,
    /// Its latest compile time, in milliseconds.
    pub(in crate::app) compile_ms: Option<f64>,
    pub(in crate::app) now: StageReport,
    /// Its compile time in the previous version.
    pub(in crate::app) before: Option<StageReport>,
    /// Its statistics in a line.
    pub(in crate::app) figures: Vec<Figure>,
}

/// Cached table; rebuilt only when the shaders, the frame or the statistics change.
#[derive(Default)]
pub(in crate::app) struct StageTable {
    rows: Vec<StageRow>,
    /// Path of the stage that draws the model, or the pass that covers it.
    main: String,
    made_of: Option<(Arc<PipelineSet>, Arc<PipelineRequest>)>,
}

impl StageTable {
    /// All stages: those that failed first, then those on screen.
    pub(in crate::app) fn rows(&self) -> &[StageRow] {
        &self.rows
    }

    /// The stage that draws the model, or the pass that covers it.
    pub(in crate::app) fn main(&self) -> Option<&StageRow> {
        self.rows.iter().find(|row| row.path == self.main)
    }

    /// Whether the table belongs to other shaders or another frame.
    pub(in crate::app) fn is_outdated(&self, set: &Arc<PipelineSet>, request: &Arc<PipelineRequest>) -> bool {
        !self.made_of.as_ref().is_some_and(|(of, known)| Arc::ptr_eq(of, set) && known == request)
    }

    /// Marks the statistics of the stages as changed.
    pub(in crate::app) fn invalidate(&mut self) {
        self.made_of = None;
    }

    /// Builds the table of a set. `before` is the previous version.
    pub(in crate::app) fn update(
        &mut self,
        set: &Arc<PipelineSet>,
        request: &Arc<PipelineRequest>,
        before: Option<&Arc<PipelineSet>>,
        log: &ShaderLog,
    ) {
        let on_screen = request.stages();
        let mut earlier = before.map(|before| before.report(request)).unwrap_or_default();
        let row = |(path, now): (String, StageReport)| {
            let before = earlier.remove(&path);
            let figures = figures(&now, before.as_ref());
            let state = state(&path, &set.shaders, &on_screen, log);
            let name = set.shaders.name_of(&path).to_owned();
            StageRow { state, name, compile_ms: log.compile_ms(&path), path, now, before, figures }
        };
        self.rows = set.report(request).into_iter().map(row).collect();
        let main = main_stage(request);
        let is_main = |row: &StageRow| row.path == main;
        self.rows.sort_by_key(|row| (row.state, !is_main(row)));
        main.clone_into(&mut self.main);
        self.made_of = Some((set.clone(), request.clone()));
    }
}

/// The stage that draws what is seen: that of the model, or of the last pass that covers it, such as a shader without a model.
pub(in crate::app) fn main_stage(request: &PipelineRequest) -> &str {
    let covering = request.passes.iter().rev().filter(|pass| !request.draws_model && pass.covers());
    covering.map(|pass| pass.desc.stage.as_str()).next().unwrap_or(&request.stage)
}

fn state(path: &str, shaders: &ShaderSet, on_screen: &BTreeSet<String>, log: &ShaderLog) -> StageState {
    if log.has_failed(path) {
        StageState::Failed
    } else if shaders.pending.contains(path) {
        StageState::Pending
    } else if on_screen.contains(path) {
        StageState::OnScreen
    } else if StageKind::of(&TreePath::from(path)) == Some(StageKind::Compute) && !is_pass(path, shaders) {
        StageState::Bakes
    } else {
        StageState::Off
    }
}

fn is_pass(path: &str, shaders: &ShaderSet) -> bool {
    shaders.graph.passes.iter().any(|pass| pass.desc.stage == path)
}
