//! Fixes that the messages of the compiler suggest.

use lsp_types::{CodeAction, CodeActionKind, CodeActionOrCommand, Range as Span, TextEdit};

use super::edit::edit;
use crate::lsp::diagnostics::{shown, span};
use crate::lsp::view::View;
use crate::shader::Diagnostic;

/// The fixes of the diagnostics that touch a span.
pub fn fixes(view: &View, at: Span, diagnostics: &[Diagnostic]) -> Vec<CodeActionOrCommand> {
    let touches = |diagnostic: &&Diagnostic| {
        let place = span(diagnostic);
        place.start.line <= at.end.line && at.start.line <= place.end.line
    };
    diagnostics
        .iter()
        .filter(touches)
        .filter_map(|diagnostic| fix(view, diagnostic))
        .map(CodeActionOrCommand::CodeAction)
        .collect()
}

fn fix(view: &View, diagnostic: &Diagnostic) -> Option<CodeAction> {
    let help = diagnostic.help.as_deref().unwrap_or_default();
    let (title, edited) = match suggested(help).or_else(|| suggested(&diagnostic.message)) {
        Some(name) if diagnostic.column.is_some() => {
            (format!("Change to `{name}`"), TextEdit::new(span(diagnostic), name.to_owned()))
        }
        _ => {
            let line = unended(help)?;
            let index = (line as usize).checked_sub(1)?;
            let bytes = view.file().source.line(index);
            let code = crate::shader::glsl::lines(view.file().text());
            let end = code.get(index)?.trimmed().end;
            let place = view.file().source.place(bytes.start + end);
            (format!("End line {line} with `;`"), TextEdit::new(Span::new(place, place), ";".to_owned()))
        }
    };
    // The text may have changed since it was compiled.
    let is_same = diagnostic.line.zip(diagnostic.excerpt.as_deref()).is_some_and(|(line, excerpt)| {
        let now = (line as usize).checked_sub(1).map(|index| view.file().source.line(index));
        now.and_then(|now| view.file().text().get(now)).is_some_and(|now| now.trim_end() == excerpt.trim_end())
    });
    is_same.then(|| CodeAction {
        title,
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![shown(diagnostic)]),
        edit: Some(edit([(view.file().uri.clone(), edited)])),
        is_preferred: Some(true),
        ..CodeAction::default()
    })
}

/// The name in "did you mean `NAME`?" or "was it renamed to `NAME`?".
fn suggested(message: &str) -> Option<&str> {
    let rest = ["id you mean `", "was it renamed to `"].iter().find_map(|words| message.split_once(words))?.1;
    rest.split('`').next().filter(|name| !name.is_empty())
}

/// The line in "line 7 does not end with ';'", from 1.
fn unended(help: &str) -> Option<u32> {
    let rest = help.strip_prefix("line ")?;
    let (line, rest) = rest.split_once(' ')?;
    rest.starts_with("does not end with ';'").then(|| line.parse().ok()).flatten().filter(|line| *line > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_read_from_messages() {
        assert_eq!(suggested("did you mean `alpha`?"), Some("alpha"));
        assert_eq!(suggested("found `//@pss`. Did you mean `//@pass`?"), Some("//@pass"));
        assert_eq!(suggested("was it renamed to `lib/a.glsl`?"), Some("lib/a.glsl"));
        assert_eq!(
            (suggested("begin the file"), unended("line 7 does not end with ';'"), unended("line x does")),
            (None, Some(7), None)
        );
    }
}
