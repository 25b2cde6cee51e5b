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
    /// Whether the panel has moved the list in this frame.
    moves: bool,
    /// Whether the user has gone to a place in this file.
    is_chosen: bool,
    /// The file whose lines were shown, and whether with values.
    file: String,
    has_values: bool,
}

impl Scroll {
    /// Brings a line, by its index, into sight.
    pub(super) fn to(&mut self, line: usize) {
        self.to = Some(line);
        self.is_chosen = true;
    }

    /// Brings the same line into sight in the next frame, too.
    pub(super) fn again(&mut self, line: usize) {
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
        let top = self.top.take();
        self.moves |= top.is_some();
        top
    }

    /// The line to bring into sight.
    pub(super) fn take(&mut self) -> Option<usize> {
        let to = self.to.take();
        self.moves |= to.is_some();
        to
    }

    /// Notes the first line in sight. If the panel has not moved the list, the user has.
    pub(super) fn saw(&mut self, first: usize) {
        self.is_chosen |= !self.moves && first != self.first;
        (self.first, self.moves) = (first, false);
    }

    /// Whether a file is not the one whose lines were shown, or has its first values before the user went to a place in it. The next call with
    /// the same says no.
    pub(super) fn is_news(&mut self, file: &str, has_values: bool) -> bool {
        let is_other = self.file != file;
        let is_news = is_other || (has_values && !self.has_values && !self.is_chosen);
        if is_other {
            self.is_chosen = false;
            file.clone_into(&mut self.file);
        }
        self.has_values = has_values || (self.has_values && !is_other);
        is_news
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame that shows a file from `first` on, unless the panel goes elsewhere. Returns the line to which it goes.
    fn frame(scroll: &mut Scroll, has_values: bool, asked: Option<&(TreePath, u32)>, first: usize) -> Option<usize> {
        if scroll.is_news("a.glsl", has_values) {
            scroll.offer(7);
        }
        scroll.seek("a.glsl", asked);
        let to = scroll.take();
        scroll.saw(to.unwrap_or(first));
        to
    }

    #[test]
    fn values_that_arrive_do_not_move_what_is_read() {
        let mut opened = Scroll::default();
        assert_eq!((frame(&mut opened, false, None, 0), frame(&mut opened, false, None, 7)), (Some(7), None));
        assert_eq!(frame(&mut opened, true, None, 7), Some(7), "the user went nowhere");
        let mut scrolled = Scroll::default();
        frame(&mut scrolled, false, None, 0);
        assert_eq!((frame(&mut scrolled, false, None, 30), frame(&mut scrolled, true, None, 30)), (None, None));
        let asked = ("a.glsl".into(), 41);
        let mut sought = Scroll::default();
        assert_eq!(frame(&mut sought, false, Some(&asked), 0), Some(40));
        assert_eq!(frame(&mut sought, true, Some(&asked), 40), None);
    }
}
