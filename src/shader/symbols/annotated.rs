//! The names that `//@pass`, `//@texture` and `//@mode` declare.

use super::symbol::{Symbol, SymbolKind};
use crate::shader::glsl::{TokenKind, tokens};

/// The names in the annotations of a text.
pub(super) fn annotated(text: &str) -> impl Iterator<Item = Symbol> {
    let comments = tokens(text).filter(|token| token.kind == TokenKind::Comment);
    comments.filter_map(|comment| {
        let rest = comment.text.strip_prefix("//@")?;
        let (keyword, after) = rest.split_once(char::is_whitespace)?;
        let kind = match keyword {
            "pass" => SymbolKind::Pass,
            "texture" => SymbolKind::Texture,
            "mode" => SymbolKind::Mode,
            _ => return None,
        };
        let name = after.split_whitespace().next()?;
        let start = comment.bytes.start + comment.text.len() - after.trim_start().len();
        let whole = comment.bytes.start..comment.bytes.start + comment.text.trim_end().len();
        Some(Symbol::new(name, kind, start..start + name.len(), whole))
    })
}
