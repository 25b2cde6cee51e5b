//! Questions for the values at a pixel, their answers, and the pixels that are pinned in windows.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use lsp_server::RequestId;
use serde_json::Value;

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
    /// The socket of the window in which the pixel is pinned; `None` if it is drawn here.
    pub window: Option<PathBuf>,
}

/// The pinned pixel of a window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pinned {
    /// The socket of the window.
    pub socket: PathBuf,
    /// The folder of its shader tree; `None` for the built-in one.
    pub tree: Option<PathBuf>,
    /// Counted from the upper left corner.
    pub pixel: Option<(u32, u32)>,
    /// Whether it has moved with its surface, without a click.
    pub moved: bool,
}

/// A line that the pixel reaches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TracedLine {
    /// From 1.
    pub line: u32,
    /// The line itself, without the space around it.
    pub code: String,
    /// The values that its statements computed, in short.
    pub text: String,
    /// Each value with the calls that led to it.
    pub calls: String,
}

impl TracedLine {
    /// A line of [`LineOfTrace`] in JSON.
    pub fn parse(json: &Value) -> Option<Self> {
        let text = |json: &Value| json["text"].as_str().unwrap_or_default().to_owned();
        let once = |once: &Value| {
            let value = if once["value"].is_null() { String::new() } else { once["value"].to_string() };
            format!("  {value}  in {}", once["calls"].as_str().unwrap_or_default())
        };
        let done = json["done"].as_array()?.iter().map(|done| {
            let times = ["first", "last"].into_iter().filter_map(|times| done[times].as_array()).flatten().map(once);
            format!("{}\n{}", text(done), times.collect::<Vec<_>>().join("\n"))
        });
        Some(Self {
            line: u32::try_from(json["line"].as_u64()?).ok()?,
            code: json["code"].as_str()?.to_owned(),
            text: text(json),
            calls: done.collect::<Vec<_>>().join("\n"),
        })
    }
}

impl From<&LineOfTrace> for TracedLine {
    fn from(of: &LineOfTrace) -> Self {
        let each = of.done.iter().map(|done| {
            let once = done.first.iter().chain(&done.last).map(|once| {
                let value = once.value.map(|value| value.text()).unwrap_or_default();
                format!("  {value}  in {}", once.calls)
            });
            format!("{}\n{}", done.text(), once.collect::<Vec<_>>().join("\n"))
        });
        let calls = each.collect::<Vec<_>>().join("\n");
        Self { line: of.line, code: of.code.clone(), text: of.text(), calls }
    }
}

/// A file with the values of its lines.
#[derive(Clone, Debug)]
pub struct TracedFile {
    /// Its path in the tree.
    pub path: TreePath,
    /// The text that was traced.
    pub text: Arc<str>,
    /// The lines that the pixel reaches.
    pub lines: Vec<TracedLine>,
}

/// The values at a pixel.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The request.
    pub asked: Asked,
    /// The values by files, and whether the color is the picture's; or why there are none.
    pub result: Result<(Vec<TracedFile>, String), String>,
}
