//! Where an annotation stands, and errors with the caret under the word that is wrong.

use std::ops::Range;

use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::find_word;

/// The location of an annotation. All locations compare as equal, so that moving a line does not count as a change.
#[derive(Clone, Debug, Default)]
pub struct AnnotationPlace {
    /// Path of the file for messages.
    pub file: String,
    /// Line number, from 1.
    pub line: u32,
    /// The whole line.
    pub(super) raw: String,
    /// Byte range of the annotation in `raw`.
    pub(super) bytes: Range<usize>,
}

impl PartialEq for AnnotationPlace {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for AnnotationPlace {}

impl std::hash::Hash for AnnotationPlace {
    fn hash<H: std::hash::Hasher>(&self, _: &mut H) {}
}

impl AnnotationPlace {
    /// An error about the whole annotation, with the caret under its keyword, as `//@pass`.
    pub fn error(&self, message: impl Into<String>) -> Diagnostic {
        self.under(self.keyword(), message)
    }

    /// An error with the caret under `word`: a word of the annotation or of the declaration before it, or with a `=` at its end
    /// the value of an option. Under the keyword if the line does not have it.
    pub fn error_at(&self, word: &str, message: impl Into<String>) -> Diagnostic {
        self.under(self.find(word).unwrap_or_else(|| self.keyword()), message)
    }

    /// An error with the caret under a byte range of the line.
    pub(super) fn under(&self, bytes: Range<usize>, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(&self.file, message).on_line(self.line, Some(&self.raw)).under(bytes)
    }

    /// The end of the annotation, where a word is missing.
    pub(super) fn end(&self) -> Range<usize> {
        self.bytes.end..self.bytes.end
    }

    fn keyword(&self) -> Range<usize> {
        let text = &self.raw[self.bytes.clone()];
        let length = text.find(char::is_whitespace).unwrap_or(text.len());
        self.bytes.start..self.bytes.start + length
    }

    fn find(&self, word: &str) -> Option<Range<usize>> {
        let start = self.keyword().end;
        let text = &self.raw[start..self.bytes.end];
        let in_text = |range: Range<usize>| start + range.start..start + range.end;
        if word.ends_with('=') {
            let follows_space = |at: &usize| text[..*at].ends_with(char::is_whitespace);
            let at = text.match_indices(word).map(|(at, _)| at).find(follows_space)? + word.len();
            let value = &text[at..];
            let length = match value.strip_prefix('"') {
                Some(rest) => rest.find('"').map(|length| length + 2),
                None => value.find(char::is_whitespace),
            };
            return Some(in_text(at..at + length.unwrap_or(value.len())));
        }
        find_word(&self.raw[..self.bytes.start], word).or_else(|| find_word(text, word).map(in_text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_stands_under_the_word() {
        let raw = "vec3 tint; //@pass pass \"A pass\" after=other doc=\"to = x\" off  ";
        let place =
            AnnotationPlace { raw: raw.to_owned(), bytes: 11..raw.trim_end().len(), ..AnnotationPlace::default() };
        let marked = |error: Diagnostic| {
            let from = error.column.unwrap() as usize - 1;
            raw[from..from + error.length as usize].to_owned()
        };
        assert_eq!(marked(place.error("m")), "//@pass");
        let at = |word: &str| (marked(place.error_at(word, "m")), place.error_at(word, "m").column.unwrap());
        assert_eq!(at("pass"), ("pass".to_owned(), 20));
        assert_eq!(at("after="), ("other".to_owned(), 40));
        assert_eq!(at("doc="), ("\"to = x\"".to_owned(), 50));
        assert_eq!(at("tint"), ("tint".to_owned(), 6));
        assert_eq!(at("off"), ("off".to_owned(), 59));
        assert_eq!(at("size=").0, "//@pass");
        // Where a word is missing, the caret follows the last one.
        assert_eq!(place.under(place.end(), "m").column, Some(62));
    }
}
