//! The state that a library keeps between updates.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::slot::StageSlot;
use super::update::ShaderSet;
use super::watched::Watched;
use crate::shader::compile::Compiler;
use crate::shader::incremental::FileCache;
use crate::shader::source::{Source, TreePath};

/// The stages of one tree, the last good set, and the failures since.
pub struct Library {
    pub(super) source: Arc<Source>,
    pub(super) compiler: Arc<Compiler>,
    pub(super) cache: FileCache,
    /// The entry points that a library is made with, then the stages that declare a pass.
    pub(super) slots: Vec<StageSlot>,
    /// Number of entry points that a library is made with.
    pub(super) fixed: usize,
    /// Stages in `passes/` that declare no pass, so that nothing draws them.
    pub(super) idle: BTreeSet<TreePath>,
    /// Files of tessellation, geometry, task and mesh stages.
    pub(super) beside: BTreeSet<TreePath>,
    pub(super) set: Option<Arc<ShaderSet>>,
    /// See [`Library::follow`].
    pub(super) tree: usize,
    /// The generation before the first set.
    pub(super) before: u64,
    pub(super) failed: bool,
    /// Whether the next update links, even if no stage has changed: the source may refuse other texts.
    pub(super) relink: bool,
    /// The expression that is shown over the model.
    pub(super) watched: Option<Watched>,
    /// Whether the source holds a part of a tree, so that annotations may name what is in other files.
    pub(super) is_part: bool,
    /// See [`Library::compile_whole`].
    pub(super) is_whole: bool,
}
