//! Completion: names in scope, members by their type, annotations with their options, and paths of includes.

mod annotations;
mod includes;
mod members;
mod names;

use lsp_types::{CompletionItem, Position};

use super::name::is_behind_dot;
use super::view::View;
use crate::shader::glsl::{Token, TokenKind, tokens};

/// The names that can stand at a place.
pub fn completion(view: &View, place: Position) -> Vec<CompletionItem> {
    let file = view.file();
    if file.is_too_long() {
        return Vec::new();
    }
    let byte = file.source.byte(place);
    let text = file.text();
    let line = text[..byte].rfind('\n').map_or(0, |at| at + 1);
    if let Some(path) = includes::being_typed(&text[line..byte]) {
        return includes::items(view, path, place);
    }
    match token_at(text, byte) {
        Some(comment) if comment.kind == TokenKind::Comment => match comment.text.starts_with("//@") {
            true => annotations::items(view, &text[comment.bytes.start..byte]),
            false => Vec::new(),
        },
        Some(number) if number.kind == TokenKind::Number => Vec::new(),
        Some(directive) if directive.in_directive && is_keyword(&text[line..byte]) => annotations::directives(),
        word => {
            let start = word.filter(|word| word.kind == TokenKind::Word).map_or(byte, |word| word.bytes.start);
            if is_behind_dot(text, start) { members::items(view, start) } else { names::items(view, start) }
        }
    }
}

/// The token that a byte is in, or that ends there.
fn token_at(text: &str, byte: usize) -> Option<Token<'_>> {
    let before = tokens(text).take_while(|token| token.bytes.start < byte);
    before.filter(|token| byte <= token.bytes.end).last()
}

/// Whether the text of a line up to the cursor is the keyword of a directive.
fn is_keyword(before: &str) -> bool {
    let rest = before.trim_start().strip_prefix('#').map(str::trim_start);
    rest.is_some_and(|rest| rest.chars().all(|c| c.is_ascii_alphabetic()))
}
