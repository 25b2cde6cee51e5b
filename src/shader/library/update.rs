//! Changes that update a library, and the outcomes.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use super::slot::Stage;
use crate::shader::annotation::pass::MODEL;
use crate::shader::annotation::{Constant, Mode, Parameter};
use crate::shader::compile::StageKind;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::expression::{self, Watching};
use crate::shader::graph::{FULL_SCREEN, Graph, GraphPass};
use crate::shader::source::{TreePath, embedded, opened_file};

/// The files that may have changed since the last update.
#[derive(Clone, Debug)]
pub enum Change {
    /// Anything: the first update, which takes modules from disk where it can, and the reload key, which compiles every stage as a
    /// whole. A stage whose module comes out unchanged remains the same object.
    All,
    /// These files.
    Paths(BTreeSet<TreePath>),
}

impl Change {
    /// Combines both changes.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Paths(mut paths), Self::Paths(more)) => {
                paths.extend(more);
                Self::Paths(paths)
            }
            _ => Self::All,
        }
    }
}

/// The result of one successful update. It is immutable; an edit creates a new set.
#[derive(Clone, Debug, Default)]
pub struct ShaderSet {
    /// Increments with every new set, from 1. The trees that a window opens one after the other share one count.
    pub generation: u64,
    /// Number of the tree among those that a window has opened; 0 is the first.
    pub tree: usize,
    /// The stages by path. A stage that an edit does not affect is the same `Arc` in both sets.
    pub stages: BTreeMap<String, Arc<Stage>>,
    /// Stages that are still to be compiled for this edit, or that failed. [`ShaderSet::stages`] holds their last good
    /// versions, which no picture may show together with the others.
    pub pending: BTreeSet<String>,
    /// Debug modes, ordered by id.
    pub modes: Vec<Mode>,
    /// The author's specialization constants, ordered by id.
    pub constants: Vec<Constant>,
    /// The author's parameters, ordered by offset.
    pub parameters: Vec<Parameter>,
    /// The passes that the tree adds, in order.
    pub graph: Graph,
    /// The compiler's warnings, and an error for each file whose text is refused ([`crate::shader::Source::quarantined`]).
    pub warnings: Vec<Diagnostic>,
    /// The texts of all files that the stages depend on, as they are compiled.
    pub texts: BTreeMap<TreePath, Arc<str>>,
    /// The texts of those files whose author wrote another one, with the same lines: see [`crate::shader::Source::author_text`].
    pub author_texts: BTreeMap<TreePath, Arc<str>>,
    /// The watched expression.
    pub watched: Option<Watching>,
}

impl ShaderSet {
    /// The text of a file as its author wrote it.
    pub fn author_text(&self, path: &TreePath) -> Option<&Arc<str>> {
        self.author_texts.get(path).or_else(|| self.texts.get(path))
    }

    /// The name of a file or stage for people: in a tree that is made of a single file ([`crate::shader::Source::is_toy`]), that of
    /// the author's file.
    pub fn name_of<'a>(&'a self, path: &'a str) -> &'a str {
        let is_toy = || self.texts.keys().any(|file| opened_file(file.as_str()).is_some());
        match opened_file(path) {
            Some(file) => file,
            None if embedded::has(path) || !is_toy() => path,
            None => self.graph.passes.iter().find(|pass| pass.desc.stage == path).map_or(path, |pass| &pass.desc.label),
        }
    }

    /// The name of a pass for people: in a tree that is made of a single file, that of the file that draws its image.
    pub fn name_of_pass<'a>(&'a self, pass: &'a GraphPass) -> &'a str {
        let (stage, name) = (&pass.desc.stage, self.name_of(&pass.desc.stage));
        if name == stage { pass.name() } else { name }
    }

    /// Whether a file has an author: all but the stages around a single file.
    pub fn is_authored(&self, path: &str) -> bool {
        opened_file(path).is_some() || self.name_of(path) == path
    }

    /// The path of the stage that a user names, by that or by [`Self::name_of`].
    pub fn stage_named(&self, name: &str) -> Option<&str> {
        let stages = || self.graph.passes.iter().rev().map(|pass| pass.desc.stage.as_str());
        let by_path = self.stages.get_key_value(name).map(|(path, _)| path.as_str());
        by_path.or_else(|| stages().find(|stage| self.name_of(stage) == name))
    }

    /// Whether no stage is still to be compiled.
    pub fn is_complete(&self) -> bool {
        self.pending.is_empty()
    }

    /// Why the watched expression has no mode.
    pub fn expression_error(&self) -> Option<&Diagnostic> {
        self.watched.as_ref()?.error.as_ref()
    }

    /// Whether expressions of a file can be watched: a pass that can show one includes it, or its vertex stage does.
    pub fn can_watch(&self, path: &TreePath) -> bool {
        let model = self.graph.pass(MODEL).map(|model| &model.pre_rasterization);
        let includes = |stage: &str| self.stages.get(stage).is_some_and(|stage| stage.dependencies.contains(path));
        self.graph.passes.iter().filter(|pass| !pass.is_compute).any(|pass| {
            let before = &pass.pre_rasterization;
            let vertex = before.vertex.as_str();
            let is_vertex_alone = before.stages().eq([vertex]);
            let shows_vertices = || vertex != FULL_SCREEN && is_vertex_alone && includes(vertex);
            expression::can_show(&pass.desc, || !is_vertex_alone && Some(before) != model)
                && (includes(&pass.desc.stage) || shows_vertices())
        })
    }

    /// `FEATURE_*` bits of the extensions that the author's `user_surface` brings into the picture. Every lit material has them.
    pub fn hook_features(&self) -> u32 {
        let current = self.stages.iter().filter(|(path, _)| !self.pending.contains(*path));
        current.fold(0, |all, (_, stage)| all | stage.hooks.features)
    }

    /// Whether the author's `user_light` changes which points a light reaches.
    pub fn moves_lights(&self) -> bool {
        let current = self.stages.iter().filter(|(path, _)| !self.pending.contains(*path));
        current.into_iter().any(|(_, stage)| stage.hooks.moves_lights)
    }

    /// Whether the pre-rasterization stages of the fragment stage `fragment` move the vertices of the model.
    pub fn moves_vertices(&self, fragment: &str) -> bool {
        let pass = self.graph.passes.iter().find(|pass| pass.desc.stage == fragment && pass.desc.draws_model());
        let stages = pass.into_iter().flat_map(|pass| pass.pre_rasterization.stages());
        let displaces = |kind| matches!(kind, StageKind::TessellationEvaluation | StageKind::Geometry);
        stages.filter_map(|path| self.stages.get(path)).any(|stage| stage.hooks.moves_vertices || displaces(stage.kind))
    }
}

/// The folder of the author's own files in a tree.
const OWN: &str = "user/";

impl ShaderSet {
    /// Whether the pre-rasterization stages of the fragment stage `fragment` leave the model's vertices where it has them: they are the
    /// model's own vertex stage, which is as it was shipped, and its hook moves none.
    pub fn keeps_vertices(&self, fragment: &str) -> bool {
        let Some(model) = self.graph.pass(MODEL) else { return false };
        let Some(pass) = self.graph.passes.iter().find(|pass| pass.desc.stage == fragment && pass.desc.draws_model())
        else {
            return false;
        };
        let vertex = pass.pre_rasterization.vertex.as_str();
        let is_own =
            vertex.strip_suffix(".vert").is_some_and(|name| model.desc.stage.strip_suffix(".frag") == Some(name));
        is_own
            && pass.pre_rasterization.stages().eq([vertex])
            && !self.moves_vertices(fragment)
            && self.is_as_shipped(vertex)
    }

    /// Whether a stage and what it includes are as they were shipped, up to the author's own files.
    pub fn is_as_shipped(&self, stage: &str) -> bool {
        let is_shipped = |path: &TreePath| {
            // A file that could not be included has no text.
            let text = self.texts.get(path).map(|text| text.as_bytes());
            path.as_str().starts_with(OWN) || text.is_none_or(|text| embedded::read(None, path) == Some(text))
        };
        self.stages.get(stage).is_some_and(|stage| stage.dependencies.iter().all(is_shipped))
    }
}

/// The stages that an update compiled, and how long it took.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Changed files that a stage depends on, as displayed.
    pub changed: Vec<String>,
    /// Compiled stages and the time that each took, in milliseconds. An edit of comments compiles none.
    pub stages: Vec<(String, f64)>,
    /// Stages among these that do not compile, or contradict the contract.
    pub failed: Vec<String>,
    /// After a failed update: edited files, as displayed, that no diagnostic is about. They wait for the repair of the others.
    pub waiting: Vec<String>,
    /// Wall time of the whole update, in milliseconds. Stages compile in parallel.
    pub compile_ms: f64,
}

/// The outcome of an update.
#[derive(Clone, Debug)]
pub enum Update {
    /// The last set is still current. `cleared`: a failed edit was reverted, so its diagnostics no longer apply.
    Unchanged {
        /// Whether to clear the displayed diagnostics.
        cleared: bool,
    },
    /// There is a new set.
    Ready(Arc<ShaderSet>, Report),
    /// The update failed; the last good set remains.
    Failed(Vec<Diagnostic>, Report),
}
