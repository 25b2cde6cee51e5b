//! Diagnostics: what is wrong, where, and what to do, formatted as one line for editors or as an excerpt for people.

use std::fmt;
use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic as Rendered, Label, Severity as RenderedSeverity};
use codespan_reporting::files::{Error as FilesError, Files};
use codespan_reporting::term;
use serde::Serialize;

use crate::message::{escape, escape_lines};

/// Whether the shader set may be used despite the message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The edit is rejected.
    Error,
    /// The edit is applied.
    Warning,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
        })
    }
}

/// A message about one place in a file.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The file as displayed, see `Source::display_path`.
    pub file: String,
    /// 1-based; `None` if the message is about the whole file.
    pub line: Option<u32>,
    /// 1-based, in characters; `None` if only the line is known.
    pub column: Option<u32>,
    /// Number of characters that the caret spans; 0 without a column.
    pub length: u32,
    /// The fault: expected and found.
    pub message: String,
    /// The source line as written.
    pub excerpt: Option<String>,
    /// Advice to the user.
    pub help: Option<String>,
    /// Additional information, such as the other place of a conflict or the include chain.
    pub notes: Vec<String>,
}

impl Diagnostic {
    /// An error about a whole file. [`Self::on_line`] and [`Self::under`] add a position.
    pub fn error(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            file: file.into(),
            line: None,
            column: None,
            length: 0,
            message: message.into(),
            excerpt: None,
            help: None,
            notes: Vec::new(),
        }
    }

    /// A warning about a whole file.
    pub fn warning(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(file, message) }
    }

    /// Sets the 1-based line and its source text.
    #[must_use]
    pub fn on_line(mut self, line: u32, source: Option<&str>) -> Self {
        self.line = Some(line);
        self.excerpt = source.map(str::to_owned);
        self
    }

    /// Sets the caret to a byte range of the excerpt. Does nothing without an excerpt or outside it.
    #[must_use]
    pub fn under(mut self, bytes: Range<usize>) -> Self {
        let Some(excerpt) = &self.excerpt else { return self };
        let (Some(before), Some(token)) = (excerpt.get(..bytes.start), excerpt.get(bytes)) else { return self };
        let count = |text: &str| u32::try_from(text.chars().count()).unwrap_or(u32::MAX - 1);
        self.column = Some(count(before) + 1);
        self.length = count(token).max(1);
        self
    }

    /// Sets the help text: what to do.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds a note.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// `file:line:column: error: message`, without the parts that are unknown and with control characters escaped. Editors
    /// parse this.
    pub fn one_line(&self) -> String {
        let file = escape(&self.file);
        let place = match (self.line, self.column) {
            (Some(line), Some(column)) => format!("{file}:{line}:{column}"),
            (Some(line), None) => format!("{file}:{line}"),
            _ => file,
        };
        format!("{place}: {}: {}", self.severity, escape_lines(&self.message.replace('\n', " ")))
    }

    /// Several lines of plain text: the message, the place, the line of source with a caret, help and notes. Control characters
    /// except tabs and line breaks are escaped.
    pub fn render(&self) -> String {
        self.escaped().render_escaped()
    }

    /// The same diagnostic with escapes in place of control characters; its column counts the escapes.
    fn escaped(&self) -> Self {
        let count = |text: &str| u32::try_from(escape_lines(text).chars().count()).unwrap_or(u32::MAX - 1);
        let token = self.excerpt.as_deref().zip(self.column).zip(self.caret_bytes());
        let caret = token.map(|((excerpt, _), bytes)| (count(&excerpt[..bytes.start]) + 1, count(&excerpt[bytes])));
        Self {
            severity: self.severity,
            file: escape(&self.file),
            line: self.line,
            column: caret.map_or(self.column, |(column, _)| Some(column)),
            length: caret.map_or(self.length, |(_, length)| length),
            message: escape_lines(&self.message),
            excerpt: self.excerpt.as_deref().map(|excerpt| escape_lines(excerpt.trim_end_matches('\r'))),
            help: self.help.as_deref().map(escape_lines),
            notes: self.notes.iter().map(|note| escape_lines(note)).collect(),
        }
    }

    fn render_escaped(&self) -> String {
        let severity = match self.severity {
            Severity::Error => RenderedSeverity::Error,
            Severity::Warning => RenderedSeverity::Warning,
        };
        let mut rendered = Rendered::new(severity).with_message(&self.message);
        let excerpt = OneLine { file: &self.file, line: self.line.unwrap_or(1), text: self.excerpt.as_deref() };
        match self.caret_bytes() {
            Some(bytes) => rendered.labels.push(Label::primary((), bytes)),
            None => rendered.notes.push(match self.line {
                Some(line) => format!("at {}:{line}", self.file),
                None => format!("in {}", self.file),
            }),
        }
        rendered.notes.extend(self.help.iter().map(|help| format!("help: {help}")));
        rendered.notes.extend(self.notes.iter().map(|note| format!("note: {note}")));
        let config = term::Config { chars: term::Chars::ascii(), ..term::Config::default() };
        match term::emit_into_string(&config, &excerpt, &rendered) {
            Ok(text) => text.trim_end().to_owned() + "\n",
            // Only a range outside of the excerpt could fail, and `under` ignores those.
            Err(_) => self.one_line() + "\n",
        }
    }

    /// For a terminal: the line that editors parse, then the source line with its caret.
    pub fn full(&self) -> String {
        let rendered = self.render();
        let rest = rendered.split_once('\n').map_or("", |(_, rest)| rest.trim_end());
        format!("{}\n{rest}", self.one_line()).trim_end().to_owned()
    }

    /// The same diagnostic with at most `characters` (at least 8) of its source line around the caret.
    #[must_use]
    pub fn within(mut self, characters: usize) -> Self {
        let excerpt: Vec<char> = self.excerpt.iter().flat_map(|excerpt| excerpt.trim_end().chars()).collect();
        let characters = characters.max(8);
        if excerpt.len() <= characters {
            return self;
        }
        let from = self.column.map_or(0, |column| column.saturating_sub(1) as usize).min(excerpt.len());
        let end = (from + self.length as usize + 1).min(excerpt.len());
        // The caret is at the end, unless its token is longer than all.
        let start = end.saturating_sub(characters - 1).min(from.saturating_sub(1));
        let mut cut: String = excerpt[start..(start + characters).min(excerpt.len())].iter().collect();
        if start > 0 {
            cut = cut.chars().enumerate().map(|(at, c)| if at == 0 { '…' } else { c }).collect();
            self.column = self.column.map(|column| column - start as u32);
        }
        if start + characters < excerpt.len() {
            cut.pop();
            cut.push('…');
        }
        self.excerpt = Some(cut);
        self
    }

    /// The bytes that the caret spans: the token, or the line without its indentation.
    fn caret_bytes(&self) -> Option<Range<usize>> {
        let excerpt = self.excerpt.as_deref()?;
        self.line?;
        let byte = |character: u32| excerpt.char_indices().nth(character as usize).map_or(excerpt.len(), |(at, _)| at);
        Some(match self.column {
            Some(column) => byte(column - 1)..byte(column - 1 + self.length),
            None => excerpt.len() - excerpt.trim_start().len()..excerpt.trim_end().len().max(1).min(excerpt.len()),
        })
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.one_line())
    }
}

/// Removes duplicates (several stages may include the same broken file) and keeps the order.
pub fn unique(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut seen = std::collections::HashSet::new();
    diagnostics.into_iter().filter(|diagnostic| seen.insert(diagnostic.clone())).collect()
}

/// A file of which only one line is known.
struct OneLine<'a> {
    file: &'a str,
    line: u32,
    text: Option<&'a str>,
}

impl<'a> Files<'a> for OneLine<'a> {
    type FileId = ();
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, (): ()) -> Result<&'a str, FilesError> {
        Ok(self.file)
    }

    fn source(&'a self, (): ()) -> Result<&'a str, FilesError> {
        Ok(self.text.unwrap_or_default())
    }

    fn line_index(&'a self, (): (), _byte: usize) -> Result<usize, FilesError> {
        Ok(0)
    }

    fn line_number(&'a self, (): (), _index: usize) -> Result<usize, FilesError> {
        Ok(self.line as usize)
    }

    fn line_range(&'a self, (): (), index: usize) -> Result<Range<usize>, FilesError> {
        match index {
            0 => Ok(0..self.text.unwrap_or_default().len()),
            given => Err(FilesError::LineTooLarge { given, max: 0 }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_window_cuts_a_line_around_its_caret() {
        let line = "    vec3 color = first_function(a) * second_function(b) * thrid_function(c);";
        let at = line.find("thrid").unwrap() as u32 + 1;
        let error = Diagnostic::error("a.frag", "'thrid_function' : no matching overloaded function found");
        let error = Diagnostic { length: 14, column: Some(at), ..error.on_line(7, Some(line)) };
        assert_eq!(error.clone().within(200), error);
        for width in [8, 20, 40, 60, 75] {
            let cut = error.clone().within(width);
            let excerpt: Vec<char> = cut.excerpt.unwrap().chars().collect();
            assert!(excerpt.len() <= width, "{width}: {excerpt:?}");
            let from = cut.column.unwrap() as usize - 1;
            assert!(excerpt[from..].iter().collect::<String>().starts_with("thrid"), "{width}: {excerpt:?}");
        }
        let start = Diagnostic { length: 4, column: Some(5), ..error }.within(30).excerpt.unwrap();
        assert!(start.starts_with("    vec3 color") && start.ends_with('…'), "{start}");
    }

    #[test]
    fn one_line_is_what_editors_parse() {
        let diagnostic = Diagnostic::error("pbr.frag", "'foo' : undeclared identifier");
        assert_eq!(diagnostic.one_line(), "pbr.frag: error: 'foo' : undeclared identifier");
        let diagnostic = diagnostic.on_line(3, Some("  x = foo;"));
        assert_eq!(diagnostic.one_line(), "pbr.frag:3: error: 'foo' : undeclared identifier");
        assert_eq!(diagnostic.under(6..9).one_line(), "pbr.frag:3:7: error: 'foo' : undeclared identifier");
    }

    #[test]
    fn the_caret_stands_under_the_token() {
        for source in ["x = foo;", "\t\tx = foo;", "/* äöü */ x = foo;", "  x = foo; // 日本"] {
            let at = source.find("foo").unwrap();
            let text = Diagnostic::error("a.frag", "m").on_line(12, Some(source)).under(at..at + 3).render();
            let lines: Vec<&str> = text.lines().collect();
            let row = lines.iter().position(|line| line.contains("^^^")).unwrap();
            let column = |line: &str, what: &str| line[..line.find(what).unwrap()].chars().count();
            assert_eq!(column(lines[row], "^^^"), column(lines[row - 1], "foo"), "{text}");
            assert!(text.contains("a.frag:12:"), "{text}");
            assert!(lines[row - 1].starts_with("12 "), "{text}");
        }
    }

    #[test]
    fn a_message_without_a_place_names_its_file() {
        let text = Diagnostic::warning("a.frag", "m").with_help("h").with_note("n").render();
        assert_eq!(text, "warning: m\n = in a.frag\n = help: h\n = note: n\n");
        let text = Diagnostic::error("a.frag", "m").on_line(9, None).render();
        assert_eq!(text, "error: m\n = at a.frag:9\n");
    }

    #[test]
    fn an_empty_line_is_no_trouble() {
        let text = Diagnostic::error("a.frag", "m").on_line(1, Some("")).render();
        assert!(text.starts_with("error: m"), "{text}");
    }
}
