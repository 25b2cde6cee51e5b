//! "Make a slider of this number": a member of `Params` with an annotation takes the place of a number in code.

use lsp_types::{CodeAction, CodeActionKind, CodeActionOrCommand, Range as Span, TextEdit};

use super::edit::edit;
use crate::lsp::navigation::names;
use crate::lsp::source_file::SourceFile;
use crate::lsp::view::View;
use crate::shader::TreePath;
use crate::shader::glsl::{Token, TokenKind, assigns, code, is_name};
use crate::shader::rewrite::{Literal, literals};
use crate::shader::symbols::SymbolKind;

/// The file with the sliders.
const PARAMS: &str = "user/params.glsl";

/// The action for the number at a span.
pub fn slider(view: &View, span: Span) -> Option<CodeActionOrCommand> {
    let file = view.file();
    let (path, params) = view.files.get_key_value(&TreePath::from(PARAMS))?;
    // Files that the file of the sliders includes cannot read them.
    if view.closure(path).contains(&&view.current) {
        return None;
    }
    let byte = file.source.byte(span.start);
    let line = file.source.line_of(byte);
    let start = file.source.line(line).start;
    let holds = |literal: &Literal| start + literal.bytes.start <= byte && byte <= start + literal.bytes.end;
    let literal = literals(file.text(), u32::try_from(line + 1).ok()?).into_iter().find(holds)?;
    let bytes = start + literal.bytes.start..start + literal.bytes.end;
    let name = free_name(view, &base_name(file, bytes.start)?);
    let (kind, range, default) = declared(&literal);
    let label = label(&name);
    let annotation = format!("    {kind} {name}; //@ui \"{label}\" {range} = {default}");
    let block = params.symbols.all.iter().find(|symbol| symbol.kind == SymbolKind::Block && symbol.name == "Params")?;
    let brace = block.whole.start + params.text().get(block.whole.clone())?.rfind('}')?;
    let line_break = if params.text().contains("\r\n") { "\r\n" } else { "\n" };
    let at = params.source.place(params.source.line(params.source.line_of(brace)).start);
    let mut edits = vec![
        (file.uri.clone(), TextEdit::new(file.source.span(bytes), name.clone())),
        (params.uri.clone(), TextEdit::new(Span::new(at, at), format!("{annotation}{line_break}"))),
    ];
    if !view.closure(&view.current).contains(&path) {
        edits.push((file.uri.clone(), include(file)));
    }
    Some(CodeActionOrCommand::CodeAction(CodeAction {
        title: format!("Make a slider of this number: {name}"),
        kind: Some(CodeActionKind::REFACTOR_EXTRACT),
        edit: Some(edit(edits)),
        ..CodeAction::default()
    }))
}

/// The use of a number: the variable that it is part of, or its function. `None` where GLSL needs a constant.
fn base_name(file: &SourceFile, byte: usize) -> Option<String> {
    let function = file.symbols.function_at(byte).filter(|function| byte >= function.signature.end)?;
    let tokens = code(file.text());
    let at = tokens.iter().position(|token| token.bytes.start == byte)?;
    let first = (0..at).rev().find(|at| matches!(tokens[*at].text, ";" | "{" | "}")).map_or(0, |before| before + 1);
    let statement: &[Token<'_>] = &tokens[first..at];
    let is_constant = statement.iter().any(|token| matches!(token.text, "const" | "case" | "layout"));
    if is_constant || is_in_declared_brackets(statement) {
        return None;
    }
    let assigned = (0..statement.len()).find(|at| assigns(statement, *at));
    let target = assigned.and_then(|at| {
        let names = statement[..at].iter().rev().filter(|token| token.kind == TokenKind::Word && is_name(token.text));
        names.map(|token| token.text).next()
    });
    Some(target.unwrap_or(&function.name).to_lowercase())
}

/// Whether the end of a statement's begin is inside the brackets of a declaration, `float a[`.
fn is_in_declared_brackets(statement: &[Token<'_>]) -> bool {
    let open = statement.iter().rposition(|token| matches!(token.text, "[" | "]"));
    let is_open = open.filter(|at| statement[*at].text == "[");
    is_open.is_some_and(|at| at >= 2 && statement[..at].iter().all(|token| token.kind == TokenKind::Word))
}

/// A name that no file of the tree has.
fn free_name(view: &View, base: &str) -> String {
    let base = base.trim_matches('_');
    let base = if base.is_empty() { "number" } else { base };
    let is_free = |name: &String| {
        view.files.values().all(|file| !file.text().contains(name.as_str()) || names(file.text(), name).is_empty())
    };
    let first = std::iter::once(format!("{base}_amount"));
    let mut all = first.chain((2..).map(|number| format!("{base}_amount_{number}")));
    all.find(is_free).unwrap_or_else(|| format!("{base}_amount"))
}

/// Type, range and default of a slider for a number.
fn declared(literal: &Literal) -> (&'static str, String, String) {
    let value = literal.value;
    if literal.is_whole {
        let most = if value > 0.0 { 2.0 * value } else { 8.0 };
        let kind = if literal.text.to_ascii_lowercase().ends_with('u') { "uint" } else { "int" };
        return (kind, format!("0..{most}"), format!("{value}"));
    }
    let most = if value <= 1.0 { 1.0 } else { 2.0 * value };
    ("float", format!("0..{}", most as f32), format!("{}", value as f32))
}

fn label(name: &str) -> String {
    let words = name.replace('_', " ");
    let mut chars = words.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// The line that includes the sliders: behind the last include, or at the first line of code.
fn include(file: &SourceFile) -> TextEdit {
    let text = file.text();
    let line_break = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let line = match file.symbols.includes.last() {
        Some((_, bytes)) => file.source.line_of(bytes.start) + 1,
        None => {
            let all = crate::shader::glsl::lines(text);
            let is_head =
                |keyword: Option<&str>| matches!(keyword, Some("version" | "ifndef" | "define" | "extension"));
            let last = all.iter().take_while(|line| !line.is_code()).filter(|line| is_head(line.keyword)).last();
            last.map_or(0, |line| line.number as usize)
        }
    };
    let at = file.source.place(file.source.line(line).start);
    TextEdit::new(Span::new(at, at), format!("#include \"{PARAMS}\"{line_break}"))
}
