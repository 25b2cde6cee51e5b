//! A trace with what it is of.

use std::sync::Arc;

use super::rows::Side;
use super::subject::Subject;
use crate::shader::TreePath;
use crate::shader::trace::{Trace, TraceableStage};

/// A trace, and what it is of.
pub(in crate::app) struct PixelTrace {
    pub(in crate::app) of: Subject,
    /// The stage; empty if there is none.
    pub(in crate::app) stage: String,
    /// The stages of the picture that can be traced.
    pub(in crate::app) stages: Vec<TraceableStage>,
    /// The files whose statements it has at the pixel.
    pub(in crate::app) files: Vec<String>,
    /// The file whose statements were traced.
    pub(in crate::app) file: TreePath,
    /// The trace, or the reason why there is none.
    pub(in crate::app) trace: Result<Trace, String>,
}

impl PixelTrace {
    /// The text of the traced file.
    pub(in crate::app) fn text(&self) -> Arc<str> {
        self.of.picture.shaders.author_text(&self.file).cloned().unwrap_or_default()
    }

    pub(super) fn side(&self) -> Option<Side<'_>> {
        Some(Side { trace: self.trace.as_ref().ok()?, text: self.text() })
    }
}
