//! Texts that are sent to files of the shader tree, or put over the built-in shaders.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::shader::{Source, TreePath};

/// The texts that a thread is writing, and those over the built-in shaders, which are in memory alone.
#[derive(Default)]
pub(in crate::app) struct TextWrites {
    last: u64,
    under_way: BTreeSet<u64>,
    over_built_in: BTreeMap<TreePath, Arc<str>>,
}

impl TextWrites {
    /// Notes a text that is sent to the thread. Returns its number.
    pub(in crate::app) fn begin(&mut self) -> u64 {
        self.last += 1;
        self.under_way.insert(self.last);
        self.last
    }

    /// Notes that the text with this number is written, or is not.
    pub(in crate::app) fn end(&mut self, number: u64) {
        self.under_way.remove(&number);
    }

    /// Ends all, whose thread has panicked. Returns their numbers.
    pub(in crate::app) fn end_all(&mut self) -> BTreeSet<u64> {
        std::mem::take(&mut self.under_way)
    }

    /// Whether a text is being written, so that its edit is still to come.
    pub(in crate::app) fn are_under_way(&self) -> bool {
        !self.under_way.is_empty()
    }

    /// Puts a text over a built-in shader; `None` takes the shader's own again.
    pub(in crate::app) fn put_over(&mut self, path: TreePath, text: Option<Arc<str>>) {
        match text {
            Some(text) => drop(self.over_built_in.insert(path, text)),
            None => drop(self.over_built_in.remove(&path)),
        }
    }

    /// A tree with the texts over the built-in shaders, if it has these.
    pub(in crate::app) fn over(&self, source: Source) -> Source {
        match source.location() {
            None if source.root().is_none() => source.with_editor(self.over_built_in.clone()),
            _ => source,
        }
    }

    /// Takes the texts that a session before has put over the built-in shaders.
    pub(in crate::app) fn restore(&mut self, texts: BTreeMap<TreePath, Arc<str>>) {
        self.over_built_in = texts;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_over_built_in_shaders_stay_until_they_are_taken_back() {
        let (mut writes, path) = (TextWrites::default(), TreePath::from("user.glsl"));
        let read = |writes: &TextWrites| writes.over(Source::embedded()).read(&"user.glsl".into()).unwrap();
        let own = read(&writes);
        writes.put_over(path.clone(), Some("one".into()));
        writes.put_over("brdf/ndf.glsl".into(), Some("two".into()));
        assert_eq!(read(&writes), "one");
        writes.put_over(path, None);
        assert_eq!(read(&writes), own);
        assert_eq!(writes.over(Source::disk("tree")).location(), Source::disk("tree").location());
    }

    #[test]
    fn a_text_is_under_way_until_its_number_comes_back() {
        let mut writes = TextWrites::default();
        let numbers = [writes.begin(), writes.begin()];
        writes.end(numbers[1]);
        assert!(writes.are_under_way());
        writes.end(numbers[0]);
        assert!(!writes.are_under_way());
    }
}
