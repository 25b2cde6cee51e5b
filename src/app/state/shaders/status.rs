//! The state of the shader tree.

use std::path::PathBuf;
use std::sync::Arc;

use super::log::ShaderLog;
use crate::events::ReloadEvent;
use crate::frame::PipelineRequest;

/// The state of the shader tree.
#[derive(Default)]
pub(in crate::app) struct ShaderStatus {
    /// Name of the tree: its folder, or that of the built-in tree.
    pub(in crate::app) tree: String,
    /// Folder or file of a tree on disk.
    pub(in crate::app) location: Option<PathBuf>,
    /// Folder or file of the tree whose shaders are in use. A tree that was opened since may still be compiled, or not compile.
    pub(in crate::app) in_use: Option<PathBuf>,
    /// Folder of the last tree that was no single file and no exercise; `None` is a built-in one.
    pub(in crate::app) last_tree: Option<PathBuf>,
    /// Whether the tree is a single file of another playground.
    pub(in crate::app) is_single_file: bool,
    /// Whether a compile is under way.
    pub(in crate::app) compiling: bool,
    /// Whether an error of the shaders was told, and no repair since.
    pub(in crate::app) is_broken: bool,
    /// The last finished reload.
    pub(in crate::app) last: Option<ReloadEvent>,
    /// Log of the last edits.
    pub(in crate::app) log: ShaderLog,
    /// Whether to query the driver's statistics of each frame.
    pub(in crate::app) asks_driver: bool,
    /// The frame that the driver was last queried about.
    pub(in crate::app) told: Option<Arc<PipelineRequest>>,
}
