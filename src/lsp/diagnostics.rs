//! Diagnostics of the compiler as those of the protocol, for all files that they name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lsp_types::{
    Diagnostic as Shown, DiagnosticRelatedInformation, DiagnosticSeverity, Location, Position, Range as Span,
};

use super::source_text::number;
use super::uri::uri_of;
use crate::shader::{Diagnostic, Severity, is_specula_tree};

/// The diagnostics of each file, by its path.
pub type ByFile = BTreeMap<PathBuf, Vec<Diagnostic>>;

/// Sorts diagnostics by their files.
pub fn by_file(diagnostics: Vec<Diagnostic>) -> ByFile {
    let mut out = ByFile::new();
    for diagnostic in diagnostics {
        out.entry(PathBuf::from(&diagnostic.file)).or_default().push(diagnostic);
    }
    out
}

/// A diagnostic for the client.
pub fn shown(diagnostic: &Diagnostic) -> Shown {
    let severity = match diagnostic.severity {
        Severity::Error => DiagnosticSeverity::ERROR,
        Severity::Warning => DiagnosticSeverity::WARNING,
    };
    let mut message = diagnostic.message.clone();
    if let Some(help) = &diagnostic.help {
        message += &format!("\nhelp: {help}");
    }
    let (places, rest): (Vec<_>, Vec<_>) = diagnostic
        .notes
        .iter()
        .map(|note| (note, places(note, Path::new(&diagnostic.file))))
        .partition(|(_, found)| !found.is_empty());
    for (note, _) in rest {
        message += &format!("\nnote: {note}");
    }
    let related: Vec<DiagnosticRelatedInformation> = places
        .into_iter()
        .flat_map(|(note, found)| found.into_iter().map(move |location| (note, location)))
        .map(|(note, location)| DiagnosticRelatedInformation { location, message: note.clone() })
        .collect();
    Shown {
        range: span(diagnostic),
        severity: Some(severity),
        source: Some("specula".to_owned()),
        message,
        related_information: (!related.is_empty()).then_some(related),
        ..Shown::default()
    }
}

/// Where a diagnostic stands: under its token, its line, or the first line.
pub fn span(diagnostic: &Diagnostic) -> Span {
    let line = diagnostic.line.unwrap_or(1).saturating_sub(1);
    let Some(excerpt) = diagnostic.excerpt.as_deref() else {
        return Span::new(Position::new(line, 0), Position::new(line, 0));
    };
    let excerpt = excerpt.trim_end();
    let units = |text: &str| number(text.encode_utf16().count());
    let (from, to) = match diagnostic.column {
        Some(column) => {
            let byte =
                |character: u32| excerpt.char_indices().nth(character as usize).map_or(excerpt.len(), |(at, _)| at);
            (byte(column.saturating_sub(1)), byte(column.saturating_sub(1).saturating_add(diagnostic.length)))
        }
        None => (excerpt.len() - excerpt.trim_start().len(), excerpt.len()),
    };
    Span::new(Position::new(line, units(&excerpt[..from])), Position::new(line, units(&excerpt[..to])))
}

/// The places of a note about a file, as `FILE:LINE`. A relative path is one in the tree of the file.
fn places(note: &str, about: &Path) -> Vec<Location> {
    let root = about.ancestors().skip(1).find(|folder| is_specula_tree(folder));
    let words = note.split([' ', ',', '(', ')', '`']).filter_map(|word| {
        let (file, line) = word.rsplit_once(':')?;
        let (file, line) = match (file.rsplit_once(':'), line.parse::<u32>()) {
            // FILE:LINE:COLUMN
            (Some((shorter, line)), Ok(_)) if line.parse::<u32>().is_ok() => (shorter, line.parse().ok()?),
            (_, Ok(line)) => (file, line),
            _ => return None,
        };
        let in_tree = root.map(|root| root.join(file)).filter(|path| path.is_file());
        let path = in_tree.unwrap_or_else(|| PathBuf::from(file));
        let place = Position::new(line.saturating_sub(1), 0);
        path.is_absolute().then(|| uri_of(&path)).flatten().map(|uri| Location::new(uri, Span::new(place, place)))
    });
    words.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_count_utf_16() {
        let line = "  x = /* 𝄞 */ foo;\r";
        let at = line.find("foo").unwrap();
        let diagnostic = Diagnostic::error("/a.frag", "m").on_line(3, Some(line)).under(at..at + 3);
        assert_eq!(span(&diagnostic), Span::new(Position::new(2, 15), Position::new(2, 18)));
        let whole = Diagnostic::error("/a.frag", "m").on_line(3, Some(line));
        assert_eq!(span(&whole), Span::new(Position::new(2, 2), Position::new(2, 19)));
        assert_eq!(span(&Diagnostic::error("/a.frag", "m")), Span::default());
    }

    #[test]
    fn places_of_notes_are_related_information() {
        let error = Diagnostic::error("/a.frag", "m")
            .with_note("the other is at /b/c.glsl:7")
            .with_note("plain")
            .with_help("h");
        let shown = shown(&error);
        assert_eq!(shown.message, "m\nhelp: h\nnote: plain");
        let related = shown.related_information.unwrap();
        assert_eq!((related[0].location.uri.as_str(), related[0].location.range.start.line), ("file:///b/c.glsl", 6));
        assert_eq!(places("/a:1:2, x:3 and /b:4 include it, too", Path::new("/a.frag")).len(), 2);
    }
}
