//! Finds the declarations in the body of a function, statement by statement. A statement without its `;` ends where a line begins with
//! another one.

use super::scanner::{Place, Scanner};

/// Most statements in one another that are read. Deeper ones declare nothing.
const DEPTH: usize = 100;

/// Reads the body between the braces at `open` and `close`.
pub(super) fn body(scanner: &mut Scanner<'_>, open: usize, close: usize) {
    block(scanner, open + 1, close, scanner.end(close), 0);
}

/// Reads statements up to the index `end`. Their names are known up to the byte `until`.
fn block(scanner: &mut Scanner<'_>, first: usize, end: usize, until: usize, depth: usize) {
    let mut at = first;
    while at < end {
        at = statement(scanner, at, end, until, depth).max(at + 1);
    }
}

/// Reads a statement. Returns the index behind it.
fn statement(scanner: &mut Scanner<'_>, at: usize, end: usize, until: usize, depth: usize) -> usize {
    if depth > DEPTH {
        return end;
    }
    let inside = |scanner: &mut Scanner<'_>, from: usize| statement(scanner, from, end, until, depth + 1);
    match scanner.word(at) {
        "{" => {
            let close = scanner.closing_brace(at).min(end);
            let until = scanner.end(close).min(until);
            block(scanner, at + 1, close, until, depth + 1);
            close + 1
        }
        "for" if scanner.word(at + 1) == "(" => {
            let (header, known) = (scanner.behind_bracket(at + 1).min(end), scanner.out.len());
            let semicolon = (at + 2..header).find(|at| scanner.word(*at) == ";").unwrap_or(header);
            scanner.declaration(at + 2, semicolon, &Place::Block(until));
            let declared = scanner.out.len();
            let behind = inside(scanner, header);
            let last = scanner.end(behind.saturating_sub(1)).min(until);
            for symbol in &mut scanner.out[known..declared] {
                symbol.scope = symbol.scope.take().map(|scope| scope.start..last.max(scope.start));
            }
            behind
        }
        "if" | "while" | "switch" if scanner.word(at + 1) == "(" => {
            let header = scanner.behind_bracket(at + 1).min(end);
            let behind = inside(scanner, header);
            if scanner.word(behind) == "else" && behind < end { inside(scanner, behind + 1) } else { behind }
        }
        "do" | "else" => inside(scanner, at + 1),
        "case" | "default" => (at..end).find(|at| scanner.word(*at) == ":").map_or(end, |colon| colon + 1),
        "[" => scanner.behind_bracket(at).max(at + 1),
        ";" | "}" => at + 1,
        _ => {
            let behind = end_of(scanner, at, end);
            if !matches!(scanner.word(at), "return" | "discard" | "break" | "continue") {
                scanner.declaration(at, behind, &Place::Block(until));
            }
            if scanner.word(behind) == ";" { behind + 1 } else { behind }
        }
    }
}

/// The index of the `;` of a statement, or of the next statement if there is none.
fn end_of(scanner: &Scanner<'_>, first: usize, end: usize) -> usize {
    let mut braces = 0_usize;
    for at in first..end {
        match scanner.word(at) {
            ";" if braces == 0 => return at,
            "{" => braces += 1,
            "}" if braces == 0 => return at,
            "}" => braces -= 1,
            word if at > first && scanner.begins_line(at) => {
                let is_keyword = matches!(word, "if" | "for" | "while" | "return" | "switch" | "do" | "const");
                if is_keyword || scanner.is_pair(at) {
                    return at;
                }
            }
            _ => {}
        }
    }
    end
}
