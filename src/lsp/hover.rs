//! Hover: what a name is, the comment that explains it, where it is declared, and what its line computed at the pinned pixel.

use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind, Position};

use super::meaning::meant_by;
use super::name::{NameAt, name_at};
use super::view::{Found, View};
use crate::shader::annotation::options::{ANNOTATIONS, described};
use crate::shader::glsl::{BuiltIn, TokenKind, built_in, tokens};
use crate::shader::symbols::{SymbolKind, comment_of};

/// The explanation of what stands at a place. `values`: of its line.
pub fn hover(view: &View, place: Position, values: Option<String>) -> Option<Hover> {
    let file = view.file();
    if file.is_too_long() {
        return None;
    }
    let byte = file.source.byte(place);
    let name = name_at(file.text(), byte)?;
    let text = of_annotation(file.text(), &name).or_else(|| {
        let meant = meant_by(view, &view.current, &name);
        let own =
            (!meant.is_empty()).then(|| meant.iter().take(4).map(explained).collect::<Vec<_>>().join("\n\n---\n\n"));
        own.or_else(|| built_in(&name.text).filter(|_| !name.is_member).map(of_language))
    });
    let values = values.map(|values| format!("At the pinned pixel: `{values}`"));
    let parts: Vec<String> = text.into_iter().chain(values).collect();
    (!parts.is_empty()).then(|| Hover {
        contents: HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: parts.join("\n\n") }),
        range: Some(file.source.span(name.bytes)),
    })
}

/// The declaration as code, its comment, and its file.
fn explained(found: &Found<'_>) -> String {
    let text = found.file.text();
    let signature = text.get(found.symbol.signature.clone()).unwrap_or_default();
    let signature = match found.symbol.kind {
        // With its members.
        SymbolKind::Struct => {
            text.get(found.symbol.whole.clone()).filter(|whole| whole.lines().count() <= 12).unwrap_or(signature)
        }
        _ => signature,
    };
    let owner = if found.symbol.owner.is_empty() { String::new() } else { format!("// {}\n", found.symbol.owner) };
    let line = found.file.source.line_of(found.symbol.bytes.start) + 1;
    let comment = comment_of(text, found.symbol).map(|comment| format!("\n\n{}", quoted(&comment))).unwrap_or_default();
    format!("```glsl\n{owner}{signature}\n```{comment}\n\n`{}:{line}`", found.path)
}

/// A comment as text that Markdown leaves as it is: formulas need their spaces.
fn quoted(comment: &str) -> String {
    format!("```text\n{}\n```", comment.replace("```", "'''"))
}

fn of_language(known: &BuiltIn) -> String {
    let forms = if known.forms.is_empty() { known.name.to_owned() } else { known.forms.join("\n") };
    format!("```glsl\n{forms}\n```\n\n{} (GLSL)", known.doc)
}

/// The meaning of the keyword or an option of an annotation.
fn of_annotation(text: &str, name: &NameAt) -> Option<String> {
    let holds = |bytes: &std::ops::Range<usize>| bytes.contains(&name.bytes.start);
    let comment = tokens(text).find(|token| token.kind == TokenKind::Comment && holds(&token.bytes))?;
    let before = text.get(comment.bytes.start..name.bytes.start)?.strip_prefix("//@")?;
    if before.is_empty() {
        let known = ANNOTATIONS.iter().find(|known| known.keyword == name.text)?;
        return Some(format!("```glsl\n//@{} {}\n```\n\n{}", known.keyword, known.example, known.doc));
    }
    let known = described(before.split_whitespace().next()?)?;
    let is_text = before.matches('"').count() % 2 == 1 || before.ends_with('=');
    let option = known.options.iter().find(|option| !is_text && option.name.trim_end_matches('=') == name.text)?;
    let values = if option.values.is_empty() { String::new() } else { format!(" {}", option.values.join(" | ")) };
    Some(format!("```glsl\n//@{} {}{values}\n```\n\n{}", known.keyword, option.name, option.doc))
}
