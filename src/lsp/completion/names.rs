//! Names that code can use.

use std::collections::BTreeSet;

use lsp_types::{CompletionItem, CompletionItemKind, Documentation, MarkupContent, MarkupKind};

use crate::lsp::view::{Found, View};
use crate::shader::glsl::{BUILT_IN, KEYWORDS};
use crate::shader::symbols::{SymbolKind, comment_of};

/// Words that begin statements and declarations. The others of the language are reserved.
const USED: usize = 39;

/// The names that code at a byte of the current file can use: the nearest first.
pub fn items(view: &View, byte: usize) -> Vec<CompletionItem> {
    let mut seen: BTreeSet<&str> = BTreeSet::new();
    let mut out = Vec::new();
    let file = view.file();
    let locals = file.symbols.locals(byte).filter_map(|symbol| view.found(&view.current, symbol));
    for found in locals {
        if seen.insert(&found.symbol.name) {
            out.push(item(found, '0'));
        }
    }
    let own = view.closure(&view.current);
    for path in view.visible(&view.current) {
        let order = match path {
            path if *path == view.current => '1',
            path if own.contains(&path) => '2',
            _ => '3',
        };
        let Some(file) = view.files.get(path) else { continue };
        for symbol in file.symbols.globals().filter(|symbol| !is_guard(&symbol.name)) {
            if seen.insert(&symbol.name) {
                out.push(item(Found { path, file, symbol }, order));
            }
        }
    }
    for known in BUILT_IN.iter().filter(|known| seen.insert(known.name)) {
        out.push(CompletionItem {
            label: known.name.to_owned(),
            kind: Some(match known.forms {
                [] => CompletionItemKind::KEYWORD,
                _ if known.is_function() => CompletionItemKind::FUNCTION,
                _ => CompletionItemKind::VARIABLE,
            }),
            detail: known.forms.first().map(|form| (*form).to_owned()),
            documentation: documentation(Some(known.doc.to_owned())),
            sort_text: Some(format!("4{}", known.name)),
            ..CompletionItem::default()
        });
    }
    let keywords = KEYWORDS.iter().take(USED).filter(|word| seen.insert(word));
    out.extend(keywords.map(|word| CompletionItem {
        label: (*word).to_owned(),
        kind: Some(CompletionItemKind::KEYWORD),
        sort_text: Some(format!("5{word}")),
        ..CompletionItem::default()
    }));
    out
}

/// Whether a name is that of a file's guard against a second include.
fn is_guard(name: &str) -> bool {
    name.ends_with("_GLSL")
}

fn item(found: Found<'_>, order: char) -> CompletionItem {
    let (symbol, text) = (found.symbol, found.file.text());
    let kind = match symbol.kind {
        SymbolKind::Function => CompletionItemKind::FUNCTION,
        SymbolKind::Struct => CompletionItemKind::STRUCT,
        SymbolKind::Block => CompletionItemKind::INTERFACE,
        SymbolKind::Constant | SymbolKind::Macro => CompletionItemKind::CONSTANT,
        _ => CompletionItemKind::VARIABLE,
    };
    let signature = text.get(symbol.signature.clone()).unwrap_or_default();
    CompletionItem {
        label: symbol.name.clone(),
        kind: Some(kind),
        detail: Some(signature.split_whitespace().collect::<Vec<_>>().join(" ")),
        documentation: documentation(comment_of(text, symbol)),
        sort_text: Some(format!("{order}{}", symbol.name)),
        ..CompletionItem::default()
    }
}

/// A comment beside an item.
pub fn documentation(comment: Option<String>) -> Option<Documentation> {
    let plain = |value| Documentation::MarkupContent(MarkupContent { kind: MarkupKind::PlainText, value });
    comment.map(plain)
}
