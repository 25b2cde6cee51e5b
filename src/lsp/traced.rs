//! Questions for the values at a pixel, and their answers.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use lsp_server::RequestId;

use crate::shader::TreePath;
use crate::shader::trace::LineOfTrace;

/// A pixel of a tree, and the files whose values are asked for.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// The folder of the tree.
    pub root: PathBuf,
    /// Counted from the upper left corner.
    pub at: (u32, u32),
    /// The files.
    pub files: BTreeSet<TreePath>,
    /// Files that have changed on disk.
    pub changed: BTreeSet<TreePath>,
    /// The requests that this answers.
    pub requests: Vec<RequestId>,
}

/// A file with the values of its lines.
#[derive(Clone, Debug)]
pub struct TracedFile {
    /// Its path in the tree.
    pub path: TreePath,
    /// The text that was traced.
    pub text: Arc<str>,
    /// The lines that the pixel reaches.
    pub lines: Vec<LineOfTrace>,
}

/// The values at a pixel.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The request.
    pub asked: Asked,
    /// The values by files, and whether the color is the picture's; or why there are none.
    pub result: Result<(Vec<TracedFile>, String), String>,
}
