//! "Show over the model": a running window shows the value of an expression.

use lsp_types::{CodeAction, CodeActionKind, CodeActionOrCommand, Command, Range as Span};
use serde_json::json;

use crate::lsp::source_file::SourceFile;
use crate::lsp::view::View;
use crate::shader::Expression;
use crate::shader::glsl::is_word;

/// The command that asks a window.
pub const SHOW: &str = "specula.showOverModel";

/// The action for what is selected, or for the value at the cursor.
pub fn show(view: &View, span: Span) -> Option<CodeActionOrCommand> {
    let file = view.file();
    let bytes = file.source.bytes(span);
    file.symbols.function_at(bytes.start).filter(|function| bytes.start >= function.signature.end)?;
    let text = match file.text().get(bytes.clone())?.trim() {
        "" => chain_at(file, bytes.start)?,
        selected => selected.to_owned(),
    };
    let line = file.source.line_of(bytes.start) + 1;
    let place = format!("{}:{line}:{text}", view.current);
    Expression::parse(&place, 0).ok()?;
    let title = format!("Show `{text}` over the model");
    let arguments = vec![json!(file.uri.as_str()), json!(line), json!(text)];
    Some(CodeActionOrCommand::CodeAction(CodeAction {
        title: title.clone(),
        kind: Some(CodeActionKind::new("source.specula")),
        command: Some(Command::new(title, SHOW.to_owned(), Some(arguments))),
        ..CodeAction::default()
    }))
}

/// The names with dots between them that hold a byte, up to the name there: `s.roughness`.
fn chain_at(file: &SourceFile, byte: usize) -> Option<String> {
    let text = file.text();
    let before = text[..byte].chars().rev().take_while(|c| is_word(*c) || *c == '.').map(char::len_utf8).sum::<usize>();
    let behind = text[byte..].chars().take_while(|c| is_word(*c)).map(char::len_utf8).sum::<usize>();
    let chain = text[byte - before..byte + behind].trim_matches('.');
    let is_name = chain.starts_with(|c: char| is_word(c) && !c.is_ascii_digit());
    let follows = text[byte + behind..].trim_start().starts_with('(');
    (is_name && !follows).then(|| chain.to_owned())
}
