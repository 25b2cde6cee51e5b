//! The tokens of a GLSL file before preprocessing.

/// Words through which an edit of one function changes the code of others, so that functions cannot be compiled
/// separately: line numbers shift, and `precise` affects the operands of other assignments.
const FAR_REACHING: [&str; 3] = ["__LINE__", "__FILE__", "precise"];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An identifier, a keyword or a number.
    Word,
    /// A `#` line with its continuations, and comments in them.
    Directive,
    /// A string, or a byte of anything else.
    Other,
}

/// A token of a file.
#[derive(Clone, Copy, Debug)]
pub struct Token<'a> {
    pub kind: Kind,
    pub text: &'a str,
    /// Whether white space or a comment precedes it.
    pub is_spaced: bool,
}

/// Splits a file into tokens. `None` if a function's code depends on more than its own text.
pub fn tokens(text: &str) -> Option<Vec<Token<'_>>> {
    let bytes = text.as_bytes();
    let (mut out, mut at, mut is_spaced, mut starts_line) = (Vec::new(), 0, false, true);
    while let Some(byte) = bytes.get(at) {
        let rest = &bytes[at..];
        let (kind, length) = match byte {
            b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c => {
                starts_line |= *byte == b'\n';
                (is_spaced, at) = (true, at + 1);
                continue;
            }
            b'/' if matches!(rest.get(1), Some(b'/' | b'*')) => {
                (is_spaced, at) = (true, at + comment(rest)?);
                continue;
            }
            b'#' if starts_line => (Kind::Directive, directive(rest)?),
            b'"' => (Kind::Other, 2 + rest[1..].iter().position(|byte| matches!(byte, b'"' | b'\n'))?),
            b'\\' => return None,
            byte if is_word(*byte) => {
                let is_number = byte.is_ascii_digit();
                let continues = |byte: &u8| is_word(*byte) || (is_number && *byte == b'.');
                (Kind::Word, rest.iter().take_while(|byte| continues(byte)).count())
            }
            // A character outside ASCII is kept whole.
            _ => (Kind::Other, text[at..].chars().next()?.len_utf8()),
        };
        let token = Token { kind, text: text.get(at..at + length)?, is_spaced };
        let is_open = token.text.starts_with('"') && token.text.ends_with('\n');
        let pastes = kind == Kind::Directive
            && (token.text.contains("##") || FAR_REACHING.iter().any(|word| token.text.contains(word)));
        if is_open || pastes || FAR_REACHING.contains(&token.text) {
            return None;
        }
        out.push(token);
        (at, is_spaced, starts_line) = (at + length, false, false);
    }
    Some(out)
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Length in bytes of the comment at the start of `text`, without the line break that ends it. `None` if the comment
/// does not end, or if a backslash continues it on the next line.
fn comment(text: &[u8]) -> Option<usize> {
    if text[1] == b'*' {
        return text[2..].windows(2).position(|pair| pair == b"*/").map(|end| end + 4);
    }
    let end = text.iter().position(|byte| *byte == b'\n').unwrap_or(text.len());
    (!text[..end].trim_ascii_end().ends_with(b"\\")).then_some(end)
}

/// Length in bytes of the directive at the start of `text`, without the line break that ends it.
fn directive(text: &[u8]) -> Option<usize> {
    let mut at = 0;
    while let Some(byte) = text.get(at) {
        let rest = &text[at..];
        match byte {
            b'\n' => return Some(at),
            b'/' if matches!(rest.get(1), Some(b'/' | b'*')) => at += comment(rest)?,
            b'\\' if rest.starts_with(b"\\\r\n") => at += 3,
            b'\\' if rest.starts_with(b"\\\n") => at += 2,
            b'\\' => return None,
            _ => at += 1,
        }
    }
    Some(at)
}
