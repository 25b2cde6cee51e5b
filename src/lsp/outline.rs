//! Symbols of a file and of the trees, and what can be folded.

use lsp_types::{DocumentSymbol, FoldingRange, FoldingRangeKind, OneOf, SymbolKind as Kind, WorkspaceSymbol};

use super::source_file::SourceFile;
use super::source_text::number;
use super::view::View;
use crate::shader::glsl::{TokenKind, tokens};
use crate::shader::symbols::{Symbol, SymbolKind};

/// Most symbols that a search gives.
const MOST: usize = 500;

fn kind(symbol: &Symbol) -> Kind {
    match symbol.kind {
        SymbolKind::Function => Kind::FUNCTION,
        SymbolKind::Struct => Kind::STRUCT,
        SymbolKind::Block => Kind::INTERFACE,
        SymbolKind::Constant | SymbolKind::Macro => Kind::CONSTANT,
        SymbolKind::Variable | SymbolKind::Parameter => Kind::VARIABLE,
        SymbolKind::Member => Kind::FIELD,
        SymbolKind::Pass | SymbolKind::Texture | SymbolKind::Mode => Kind::EVENT,
    }
}

/// The declarations of a file, with the members of its structs and blocks below them.
pub fn document_symbols(file: &SourceFile) -> Vec<DocumentSymbol> {
    let members = |owner: &str| {
        let all = file.symbols.members(owner).map(|member| shown(file, member, None));
        Some(all.collect::<Vec<_>>()).filter(|all| !all.is_empty())
    };
    let top = file.symbols.all.iter().filter(|symbol| symbol.scope.is_none() && symbol.kind != SymbolKind::Member);
    top.map(|symbol| match symbol.kind {
        SymbolKind::Struct | SymbolKind::Block => shown(file, symbol, members(&symbol.name)),
        _ => shown(file, symbol, None),
    })
    .collect()
}

#[allow(deprecated, reason = "the type has a field that the protocol has replaced by tags")]
fn shown(file: &SourceFile, symbol: &Symbol, children: Option<Vec<DocumentSymbol>>) -> DocumentSymbol {
    DocumentSymbol {
        name: symbol.name.clone(),
        detail: Some(symbol.type_name.clone()).filter(|name| !name.is_empty()),
        kind: kind(symbol),
        tags: None,
        deprecated: None,
        range: file.source.span(symbol.whole.start.min(symbol.bytes.start)..symbol.whole.end.max(symbol.bytes.end)),
        selection_range: file.source.span(symbol.bytes.clone()),
        children,
    }
}

/// The declarations of a tree whose names have the letters of a query in their order.
pub fn workspace_symbols(view: &View, query: &str) -> Vec<WorkspaceSymbol> {
    let query = query.to_lowercase();
    let all =
        view.files.iter().flat_map(|(path, file)| file.symbols.all.iter().map(move |symbol| (path, file, symbol)));
    let found = all.filter(|(_, _, symbol)| symbol.scope.is_none() && has_letters(&symbol.name.to_lowercase(), &query));
    found
        .take(MOST)
        .map(|(path, file, symbol)| WorkspaceSymbol {
            name: symbol.name.clone(),
            kind: kind(symbol),
            tags: None,
            container_name: Some(if symbol.owner.is_empty() { path.to_string() } else { symbol.owner.clone() }),
            location: OneOf::Left(file.location(symbol)),
            data: None,
        })
        .collect()
}

fn has_letters(name: &str, query: &str) -> bool {
    let mut letters = name.chars();
    query.chars().filter(|c| !c.is_whitespace()).all(|wanted| letters.any(|letter| letter == wanted))
}

/// Bodies, comments of several lines, and what stands between `#if` and `#endif`.
pub fn folding(file: &SourceFile) -> Vec<FoldingRange> {
    let mut out = Vec::new();
    if file.is_too_long() {
        return out;
    }
    let (mut braces, mut ifs) = (Vec::new(), Vec::new());
    let mut comment: Option<(usize, usize)> = None;
    let mut is_directive = false;
    for token in tokens(file.text()) {
        let (first, last) = (file.source.line_of(token.bytes.start), file.source.line_of(token.bytes.end.max(1) - 1));
        if token.kind == TokenKind::Comment {
            let is_next = comment.is_some_and(|(_, end)| end + 1 == first);
            if !is_next {
                out.extend(range(comment.take(), Some(FoldingRangeKind::Comment)));
            }
            comment = Some((comment.map_or(first, |(start, _)| start), last));
        }
        match token.text {
            "{" if !token.in_directive => braces.push(first),
            "}" if !token.in_directive => {
                // The line of the closing brace stays.
                let body = braces.pop().map(|start| (start, first.saturating_sub(1)));
                out.extend(range(body, None));
            }
            "if" | "ifdef" | "ifndef" if is_directive => ifs.push(first),
            "endif" if is_directive => {
                out.extend(range(
                    ifs.pop().map(|start| (start, first.saturating_sub(1))),
                    Some(FoldingRangeKind::Region),
                ));
            }
            _ => {}
        }
        is_directive = token.kind == TokenKind::Directive;
    }
    out.extend(range(comment, Some(FoldingRangeKind::Comment)));
    out
}

fn range(lines: Option<(usize, usize)>, kind: Option<FoldingRangeKind>) -> Option<FoldingRange> {
    let (first, last) = lines.filter(|(first, last)| last > first)?;
    Some(FoldingRange { start_line: number(first), end_line: number(last), kind, ..FoldingRange::default() })
}
