//! Where the list of lines is, and where it goes.

use crate::shader::TreePath;

/// The place of the list.
#[derive(Default)]
pub(super) struct Scroll {
    /// The line to bring into sight.
    to: Option<usize>,
    /// The line to bring to the upper end.
    top: Option<usize>,
    /// The line that was asked for last.
    sought: Option<(TreePath, u32)>,
    /// The first line in sight, by its index.
    pub(super) first: usize,
    /// The file whose lines were shown, and whether with values.
    file: String,
    has_values: bool,
}

impl Scroll {
    /// Brings a line, by its index, into sight.
    pub(super) fn to(&mut self, line: usize) {
        self.to = Some(line);
    }

    /// The same, unless another line was asked for.
    pub(super) fn offer(&mut self, line: usize) {
        self.to = self.to.or(Some(line));
    }

    /// Brings the line that was asked for into sight, from 1, unless that was done.
    pub(super) fn seek(&mut self, file: &str, asked: Option<&(TreePath, u32)>) {
        let Some(asked) = asked.filter(|(of, _)| of.as_str() == file) else { return };
        if self.sought.as_ref() != Some(asked) {
            self.sought = Some(asked.clone());
            self.to(asked.1.saturating_sub(1) as usize);
        }
    }

    /// Keeps the lines in sight where they are, while rows come or go.
    pub(super) fn keep(&mut self) {
        self.top = Some(self.first);
    }

    /// The line to bring to the upper end.
    pub(super) fn take_top(&mut self) -> Option<usize> {
        self.top.take()
    }

    /// The line to bring into sight.
    pub(super) fn take(&mut self) -> Option<usize> {
        self.to.take()
    }

    /// Whether a file is not the one whose lines were shown, or has its first values. The next call with the same says no.
    pub(super) fn is_news(&mut self, file: &str, has_values: bool) -> bool {
        let is_other = self.file != file;
        let is_news = is_other || (has_values && !self.has_values);
        if is_other {
            file.clone_into(&mut self.file);
        }
        self.has_values = has_values || (self.has_values && !is_other);
        is_news
    }
}
