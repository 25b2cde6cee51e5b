//! The comment that explains a declaration.

use super::symbol::Symbol;

/// The comment behind a declaration on its line, or else the lines of comment just above it, without their slashes.
pub fn comment_of(text: &str, symbol: &Symbol) -> Option<String> {
    behind(text, symbol).or_else(|| above(text, symbol.whole.start))
}

fn behind(text: &str, symbol: &Symbol) -> Option<String> {
    let rest = text.get(symbol.bytes.end..)?.lines().next()?;
    let at = rest.find("//")?;
    // The comment may be that of the first statement of a body.
    let is_own = !rest[..at].contains('{');
    let comment = rest[at..].trim_start_matches('/').trim();
    (is_own && !comment.is_empty()).then(|| comment.to_owned())
}

fn above(text: &str, start: usize) -> Option<String> {
    let before = text.get(..start)?;
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    if !before[line_start..].trim().is_empty() {
        return None;
    }
    let lines: Vec<&str> =
        before[..line_start].lines().rev().take_while(|line| line.trim_start().starts_with("//")).collect();
    let own = lines.iter().rev().filter(|line| !line.trim_start().starts_with("//@"));
    let plain: Vec<&str> = own.map(|line| unmarked(line)).collect();
    let joined = plain.join("\n").trim().to_owned();
    if joined.is_empty() { block_above(before[..line_start].trim_end_matches([' ', '\t'])) } else { Some(joined) }
}

/// The text of a line of comment, with its indentation behind the slashes.
fn unmarked(line: &str) -> &str {
    let rest = line.trim().trim_start_matches('/');
    rest.strip_prefix(' ').unwrap_or(rest)
}

/// The block comment that ends at the end of a text.
fn block_above(before: &str) -> Option<String> {
    let body = before.strip_suffix('\n').unwrap_or(before).trim_end_matches('\r').strip_suffix("*/")?;
    let body = &body[body.rfind("/*")? + 2..];
    let lines = body.lines().map(|line| line.trim().trim_start_matches('*').trim());
    let joined = lines.collect::<Vec<_>>().join("\n").trim().to_owned();
    (!joined.is_empty()).then_some(joined)
}
