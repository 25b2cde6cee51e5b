//! Paths of includes.

use lsp_types::{CompletionItem, CompletionItemKind, CompletionTextEdit, Position, Range as Span, TextEdit};

use crate::lsp::source_text::number;
use crate::lsp::view::View;

/// The path that is being typed, if a line up to the cursor is an `#include` with an open quote.
pub fn being_typed(before: &str) -> Option<&str> {
    let rest = before.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?.trim_start();
    let path = rest.strip_prefix(['"', '<'])?;
    (!path.contains(['"', '>'])).then_some(path)
}

/// The files of the tree, in place of what is typed.
pub fn items(view: &View, typed: &str, place: Position) -> Vec<CompletionItem> {
    let start = Position::new(place.line, place.character - number(typed.encode_utf16().count()).min(place.character));
    let own = &view.current;
    let libraries = view.files.keys().filter(|path| path.extension() == Some("glsl") && *path != own);
    let item = |path: &crate::shader::TreePath| CompletionItem {
        label: path.to_string(),
        kind: Some(CompletionItemKind::FILE),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(Span::new(start, place), path.to_string()))),
        filter_text: Some(path.to_string()),
        ..CompletionItem::default()
    };
    libraries.map(item).collect()
}
