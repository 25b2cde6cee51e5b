//! Parses the compiler's log. glslang reports lines but no columns, so the caret goes under the token that the message names.

use std::cell::LazyCell;
use std::collections::BTreeSet;
use std::ops::Range;

use super::hooks::other_parameters;
use super::include::meant;
use super::names::Names;
use super::places::{StageFiles, is_unended, is_value};
use super::types::with_types;
use super::uniform;
use crate::shader::diagnostic::{Diagnostic, Severity};
use crate::shader::glsl::{Line, Token, TokenKind, assigns, code, find_word, includes, lines};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// Splits a log into errors and warnings. File names in the log are tree paths. `stage` is the outermost file, and
/// `dependencies` are the files that may appear.
pub fn parse(
    log: &str,
    stage: &TreePath,
    snapshot: &Snapshot<'_>,
    dependencies: &BTreeSet<TreePath>,
) -> (Vec<Diagnostic>, Vec<Diagnostic>) {
    let mut out: Vec<Diagnostic> = Vec::new();
    let files = StageFiles { snapshot, all: dependencies };
    let names = LazyCell::new(|| {
        let text = |path| snapshot.read(path).ok();
        Names::of(dependencies.iter().filter_map(|path| Some((path, text(path)?))))
    });
    for row in log.lines() {
        let Some((severity, place, message)) = split(row) else {
            // Linker messages continue on the next lines: "FILE:     f(f1; calling g(f1;".
            let rest = row.strip_prefix(stage.as_str()).and_then(|rest| rest.strip_prefix(": ")).unwrap_or(row).trim();
            match out.last_mut() {
                Some(last) if !rest.is_empty() && !is_summary(rest) => last.notes.push(rest.to_owned()),
                _ => {}
            }
            continue;
        };
        let (file, line) = split_line(place);
        let path = dependencies.iter().find(|path| path.as_str() == file);
        let printed = path.map_or_else(|| file.to_owned(), |path| snapshot.display_path(path));
        let text = path.and_then(|path| snapshot.read(path).ok());
        let diagnostic = diagnose(printed, line, message, text.as_deref(), stage);
        let mut diagnostic = Diagnostic { severity, ..diagnostic };
        let (token, said) = split_token(message);
        if token == "#include" && said.contains(NOT_FOUND) {
            let name = said.trim_start_matches('"').split('"').next().unwrap_or_default();
            let meant = path.and_then(|path| meant(snapshot, path, name));
            diagnostic.help = meant.map(|name| format!("did you mean `{name}`?"));
        }
        if said.starts_with("syntax error") && diagnostic.help.is_none() {
            let unended = path.and_then(|path| files.unended_before(path, &diagnostic));
            diagnostic = unended.unwrap_or(diagnostic);
        }
        let call = diagnostic.excerpt.as_deref().filter(|_| said.starts_with("no matching overloaded function found"));
        if let Some(error) = call.and_then(|call| other_parameters(token, call, snapshot, dependencies)) {
            out.push(error);
            continue;
        }
        let with_pass = message.contains("overlapping use of location 0") && dependencies.iter().any(is_pass_glsl);
        let diagnostic = if with_pass { diagnostic.with_help(OVERLAPPING) } else { diagnostic };
        let suggested =
            path.zip(line).and_then(|(path, line)| nearest_name(message, &diagnostic, path, line, || &names));
        let diagnostic = match suggested {
            Some(name) => diagnostic.with_help(format!("did you mean `{name}`?")),
            None => diagnostic,
        };
        if !out.last().is_some_and(|last| is_consequence(last, &diagnostic)) {
            out.push(diagnostic);
        }
    }
    let placed = out.into_iter().map(|diagnostic| match diagnostic.line {
        Some(_) => diagnostic,
        None => files.linked(diagnostic),
    });
    placed.partition(|diagnostic| diagnostic.severity == Severity::Error)
}

/// The message about an include that was not found, behind its name.
pub const NOT_FOUND: &str = "\" not found; looked for ";

/// Whether a diagnostic is about an include that was not found.
pub(super) fn is_missing_include(diagnostic: &Diagnostic) -> bool {
    diagnostic.message.contains(NOT_FOUND)
}

/// Help text for a location that pass.glsl also declares.
const OVERLAPPING: &str = "pass.glsl declares `in vec2 uv` and `out vec4 color` at location 0, too; a pass with draw=model does \
    not include it";

fn is_pass_glsl(path: &TreePath) -> bool {
    path.as_str() == "pass.glsl"
}

/// The declared name nearest to the unknown one of a message. Reads `names` only if the message has such a name.
fn nearest_name<'a>(
    message: &str,
    diagnostic: &Diagnostic,
    file: &TreePath,
    line: u32,
    names: impl FnOnce() -> &'a Names,
) -> Option<&'a str> {
    let (unknown, said) = split_token(message);
    if said.starts_with("undeclared identifier") || said.starts_with("no matching overloaded function found") {
        return names().nearest(unknown, file, line);
    }
    if !said.starts_with("no such field in structure") {
        return None;
    }
    let excerpt = diagnostic.excerpt.as_deref().unwrap_or_default();
    let tokens = code(excerpt);
    let base = tokens.windows(3).find(|three| three[1].text == "." && three[2].text == unknown);
    names().nearest_member(unknown, base.map_or("", |three| three[0].text))
}

/// `PLACE: error: MESSAGE`
fn split(row: &str) -> Option<(Severity, &str, &str)> {
    let error = row.find(": error: ").map(|at| (at, Severity::Error, ": error: ".len()));
    let warning = row.find(": warning: ").map(|at| (at, Severity::Warning, ": warning: ".len()));
    let (at, severity, length) = [error, warning].into_iter().flatten().min_by_key(|found| found.0)?;
    Some((severity, &row[..at], row[at + length..].trim()))
}

/// `FILE:LINE` or `FILE`
fn split_line(place: &str) -> (&str, Option<u32>) {
    match place.rsplit_once(':') {
        Some((file, line)) => line.trim().parse().map_or((place, None), |line| (file, Some(line))),
        None => (place, None),
    }
}

/// `2 errors generated.`
fn is_summary(row: &str) -> bool {
    row.starts_with(|c: char| c.is_ascii_digit()) && row.ends_with("generated.")
}

/// After an unknown name, glslang assumes a `float` and reports errors about that `float`.
fn is_consequence(first: &Diagnostic, next: &Diagnostic) -> bool {
    let unknown = [
        "undeclared identifier",
        "no matching overloaded function found",
        "no such field",
        "out of range",
        "swizzle selection",
    ];
    let conversion = [
        "cannot convert from",
        "cannot convert return value",
        "type does not match",
        "wrong operand type",
        "can't use function",
        "not enough data provided for construction",
    ];
    first.severity == Severity::Error
        && (&first.file, first.line) == (&next.file, next.line)
        && unknown.iter().any(|text| first.message.contains(text))
        && conversion.iter().any(|text| next.message.contains(text))
}

fn diagnose(file: String, line: Option<u32>, message: &str, text: Option<&str>, stage: &TreePath) -> Diagnostic {
    let lines = text.map(lines).unwrap_or_default();
    let (token, said) = split_token(message);
    let Some(line) = line else { return without_line(file, said, &lines) };
    let index = line as usize - usize::from(line > 0);
    let source = lines.get(index).filter(|_| line > 0);
    if message.ends_with("(followed by invalid UTF-8 characters)") {
        return not_ascii(file, line, source);
    }
    if let Some(rest) = said.strip_prefix("syntax error, unexpected ") {
        return syntax_error(file, line, rest, &lines, index);
    }
    if token == uniform::OUTSIDE
        && let Some(diagnostic) = source.and_then(|line| uniform::outside_a_block(&file, line, stage))
    {
        return diagnostic;
    }
    if token == "#include" {
        let said = said.rsplit_once(" for header name: ").map_or(said, |(said, _)| said);
        let diagnostic = Diagnostic::error(file, said).on_line(line, source.map(|line| line.raw));
        return match source.and_then(|line| includes(line.raw).next()) {
            Some(include) => diagnostic.under(include.bytes),
            None => diagnostic,
        };
    }
    let shown = if token.is_empty() { with_types(said) } else { format!("'{token}' : {}", with_types(said)) };
    let diagnostic = Diagnostic::error(file, shown).on_line(line, source.map(|line| line.raw));
    match source.and_then(|line| locate(line, token, said)) {
        Some(bytes) => diagnostic.under(bytes),
        None => diagnostic,
    }
}

/// `'token' : message`; the token may be empty.
fn split_token(message: &str) -> (&str, &str) {
    let split = message.strip_prefix('\'').and_then(|rest| rest.split_once("' :"));
    split.map_or(("", message), |(token, said)| (token.trim(), said.trim()))
}

/// The position of a message's token in its line.
fn locate(line: &Line<'_>, token: &str, said: &str) -> Option<Range<usize>> {
    match token {
        "assign" | "=" => {
            let tokens = line.tokens();
            (0..tokens.len()).find(|at| assigns(&tokens, *at)).map(|at| tokens[at].bytes.clone())
        }
        // "function does not return a value: f"
        "" => find_word(&line.code, said.rsplit_once(": ")?.1),
        token => find_word(&line.code, token),
    }
}

fn not_ascii(file: String, line: u32, source: Option<&Line<'_>>) -> Diagnostic {
    let found = source.and_then(|line| line.code.char_indices().find(|(_, c)| !c.is_ascii()));
    let diagnostic = |message| Diagnostic::error(file, message).on_line(line, source.map(|line| line.raw));
    match found {
        Some((at, c)) => diagnostic(format!("'{c}' : GLSL allows only ASCII characters outside comments"))
            .under(at..at + c.len_utf8()),
        None => diagnostic("GLSL allows only ASCII characters outside comments".to_owned()),
    }
}

/// Builds an error of the whole stage. Linker messages write functions as `f(f1;`.
fn without_line(file: String, said: &str, lines: &[Line<'_>]) -> Diagnostic {
    let said =
        said.strip_prefix("Linking ").and_then(|rest| rest.split_once(" stage: ")).map_or(said, |(_, said)| said);
    let diagnostic = Diagnostic::error(file, said.trim_end_matches(':'));
    if said.starts_with("Missing entry point") {
        let diagnostic = diagnostic.on_line(1, Some(lines.first().map_or("", |line| line.raw)));
        return diagnostic.with_help("a stage needs `void main() { ... }`; files meant to be included end in .glsl");
    }
    if said.starts_with("#version") || said.starts_with("version") {
        let version = lines.iter().find(|line| line.keyword == Some("version"));
        let diagnostic = diagnostic.with_help("begin the file with `#version 460`");
        return match version {
            Some(line) => diagnostic.on_line(line.number, Some(line.raw)),
            None => diagnostic.on_line(1, Some(lines.first().map_or("", |line| line.raw))),
        };
    }
    diagnostic
}

/// Builds a syntax error from "unexpected X, expecting Y or Z", where X, Y and Z are the parser's token names.
fn syntax_error(file: String, line: u32, rest: &str, lines: &[Line<'_>], index: usize) -> Diagnostic {
    let (unexpected, expecting) = rest.split_once(", expecting ").unwrap_or((rest, ""));
    let mut message = format!("syntax error, unexpected {}", spelled(unexpected));
    if !expecting.is_empty() {
        let expected: Vec<String> = expecting.split(" or ").map(spelled).collect();
        message += &format!(", expecting {}", expected.join(" or "));
    }
    let source = lines.get(index);
    let mut diagnostic = Diagnostic::error(file, message).on_line(line, source.map(|line| line.raw));
    let Some(source) = source else { return diagnostic };
    let open = unterminated_before(lines, index);
    let tokens = source.tokens();
    let token = match tokens.first().filter(|first| open.is_some() && is_a(unexpected, first)) {
        Some(first) => {
            diagnostic.help = open.map(|line| format!("line {line} does not end with ';'"));
            Some(first)
        }
        None => suspect(&tokens, unexpected),
    };
    match token {
        Some(token) => diagnostic.under(token.bytes.clone()),
        None => diagnostic,
    }
}

/// The last line of code before `index`, if it looks like a statement without `;`. Skips blank lines and directives.
fn unterminated_before(lines: &[Line<'_>], index: usize) -> Option<u32> {
    let before = lines.get(..index)?.iter().rev().find(|line| line.is_code())?;
    is_unended(before).then_some(before.number)
}

/// The kind of the token that the parser calls `name`; `None` if it has a name for this token alone.
fn kind_of(name: &str) -> Option<TokenKind> {
    match name {
        "IDENTIFIER" | "TYPE_NAME" => Some(TokenKind::Word),
        "FLOATCONSTANT" | "INTCONSTANT" | "UINTCONSTANT" | "DOUBLECONSTANT" => Some(TokenKind::Number),
        _ => None,
    }
}

/// Whether a token can be the one that the parser calls `name`.
fn is_a(name: &str, token: &Token<'_>) -> bool {
    let is_spelled = || spelled(name).trim_matches('\'').starts_with(token.text);
    kind_of(name).map_or_else(is_spelled, |kind| token.kind == kind)
}

/// The likely cause in the line: a value that follows a value, or the last occurrence of the named sign.
fn suspect<'a, 'b>(tokens: &'a [Token<'b>], name: &str) -> Option<&'a Token<'b>> {
    let fits = |at: &usize| is_a(name, &tokens[*at]);
    let is_word = |token: &Token<'_>| matches!(token.kind, TokenKind::Word | TokenKind::Number);
    let mut all = 0..tokens.len();
    if kind_of(name).is_none() {
        return all.rfind(fits).map(|at| &tokens[at]);
    }
    let follows = |at: &usize| {
        // `type name` is not a pair of values: the first of a pair must be part of an expression.
        let inside = *at >= 2 && !is_word(&tokens[at - 2]) && !matches!(tokens[at - 2].text, ";" | "{" | "}");
        *at >= 1 && is_value(&tokens[at - 1]) && (inside || tokens[at - 1].kind == TokenKind::Number)
    };
    let at = all.clone().filter(fits).find(follows).or_else(|| all.next().filter(fits))?;
    Some(&tokens[at])
}

/// The spelling of a token that the parser calls `name`.
fn spelled(name: &str) -> String {
    let name = name.trim();
    if let Some((_, sign)) = SIGNS.iter().find(|(known, _)| *known == name) {
        return format!("'{sign}'");
    }
    match name {
        "IDENTIFIER" => "a name".to_owned(),
        "TYPE_NAME" => "a type name".to_owned(),
        "FLOATCONSTANT" | "INTCONSTANT" | "UINTCONSTANT" | "DOUBLECONSTANT" => "a number".to_owned(),
        "BOOLCONSTANT" => "true or false".to_owned(),
        keyword if keyword.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_') => {
            format!("'{}'", keyword.to_ascii_lowercase())
        }
        other => other.to_owned(),
    }
}

const SIGNS: &[(&str, &str)] = &[
    ("COMMA", ","),
    ("SEMICOLON", ";"),
    ("LEFT_PAREN", "("),
    ("RIGHT_PAREN", ")"),
    ("LEFT_BRACE", "{"),
    ("RIGHT_BRACE", "}"),
    ("LEFT_BRACKET", "["),
    ("RIGHT_BRACKET", "]"),
    ("LEFT_ANGLE", "<"),
    ("RIGHT_ANGLE", ">"),
    ("EQUAL", "="),
    ("COLON", ":"),
    ("DOT", "."),
    ("PLUS", "+"),
    ("DASH", "-"),
    ("STAR", "*"),
    ("SLASH", "/"),
    ("PERCENT", "%"),
    ("BANG", "!"),
    ("TILDE", "~"),
    ("QUESTION", "?"),
    ("VERTICAL_BAR", "|"),
    ("CARET", "^"),
    ("AMPERSAND", "&"),
    ("LEFT_OP", "<<"),
    ("RIGHT_OP", ">>"),
    ("INC_OP", "++"),
    ("DEC_OP", "--"),
    ("LE_OP", "<="),
    ("GE_OP", ">="),
    ("EQ_OP", "=="),
    ("NE_OP", "!="),
    ("AND_OP", "&&"),
    ("OR_OP", "||"),
    ("XOR_OP", "^^"),
    ("MUL_ASSIGN", "*="),
    ("DIV_ASSIGN", "/="),
    ("MOD_ASSIGN", "%="),
    ("ADD_ASSIGN", "+="),
    ("SUB_ASSIGN", "-="),
];

// These tests run the compiler, so they see its real messages.
#[cfg(test)]
#[path = "log_tests.rs"]
mod tests;
