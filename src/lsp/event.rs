//! The events that the threads of the server send.

use std::collections::BTreeSet;
use std::path::PathBuf;

use lsp_server::RequestId;

use super::diagnostics::ByFile;
use super::traced::{Pinned, Traced};

/// A message to the server's thread.
#[derive(Debug)]
pub enum Event {
    /// A tree was compiled.
    Diagnosed(PathBuf, ByFile),
    /// Files of a tree have changed on disk.
    Changed(PathBuf, BTreeSet<PathBuf>),
    /// A window has answered a request.
    Answered(RequestId, Result<(), String>),
    /// A window tells of its pinned pixel, and of its shader tree.
    Pinned(Pinned),
    /// A window has closed.
    WindowClosed(PathBuf),
    /// A pixel was traced.
    Traced(Traced),
}
