//! The tokens of GLSL before preprocessing, with their places in the text.

use std::ops::Range;

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// An identifier or a keyword.
    Word,
    /// A number with its suffix: `1.5e-3f`, `.5`, `0x1Fu`.
    Number,
    /// A string with its quotes.
    Text,
    /// The `#` that begins a directive.
    Directive,
    /// Any other character: operators of several characters are several tokens.
    Sign,
    /// A comment: `//` up to the line break, or `/* */`. A block comment without an end lasts to the end of the text.
    Comment,
}

/// A token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    /// Kind of the token.
    pub kind: TokenKind,
    /// Its bytes in the text.
    pub bytes: Range<usize>,
    /// Its text.
    pub text: &'a str,
    /// Whether it is part of a preprocessor directive, which a backslash at the end of a line continues.
    pub in_directive: bool,
}

/// All tokens of a text.
pub fn tokens(text: &str) -> Tokens<'_> {
    Tokens { text, at: 0, context: Context::LineStart }
}

/// The tokens of a text outside of comments and directives.
pub fn code(text: &str) -> Vec<Token<'_>> {
    tokens(text).filter(|token| token.kind != TokenKind::Comment && !token.in_directive).collect()
}

/// Whether a character may be part of an identifier.
pub fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Whether a token with this text is an identifier or a keyword.
pub fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| is_word(c) && !c.is_ascii_digit())
}

/// The code of tokens on one line, without comments: a space stands wherever something separates two of them.
pub fn spelled(tokens: &[Token<'_>]) -> String {
    let mut out = String::new();
    let mut end = None;
    for token in tokens {
        if end.is_some_and(|end| end < token.bytes.start) {
            out.push(' ');
        }
        out.push_str(token.text);
        end = Some(token.bytes.end);
    }
    out
}

/// Whether the token at this index is an `=` that assigns, alone or behind an operator, and not one that compares.
pub fn assigns(tokens: &[Token<'_>], at: usize) -> bool {
    let touches = |first: usize| tokens.get(first + 1).is_some_and(|next| next.bytes.start == tokens[first].bytes.end);
    let before = |count: usize| match at.checked_sub(count) {
        Some(first) if touches(first) => tokens[first].text,
        _ => "",
    };
    // `<` before `=` compares, unless another `<` shifts.
    let shifts = matches!(before(1), "<" | ">") && before(2) == before(1);
    let compares = matches!(before(1), "=" | "<" | ">" | "!") && !shifts;
    let is_doubled = || touches(at) && tokens[at + 1].text == "=";
    tokens[at].text == "=" && !compares && !is_doubled()
}

/// The kind of line that the next token is part of.
#[derive(Clone, Copy, PartialEq)]
enum Context {
    /// A line of which only white space and comments have been read.
    LineStart,
    Code,
    Directive,
}

/// An iterator over [`tokens`].
#[derive(Clone)]
pub struct Tokens<'a> {
    text: &'a str,
    at: usize,
    context: Context,
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        let (kind, length) = loop {
            let rest = &self.text.as_bytes()[self.at..];
            match *rest.first()? {
                b'\n' => (self.context, self.at) = (Context::LineStart, self.at + 1),
                b' ' | b'\t' | b'\r' | 0x0b | 0x0c => self.at += 1,
                b'\\' if line_break(rest) > 0 => match self.context {
                    Context::Directive => self.at += line_break(rest),
                    // Elsewhere it is left to the compiler. The next line begins no directive.
                    _ => break (TokenKind::Sign, line_break(rest)),
                },
                b'/' if matches!(rest.get(1), Some(b'/' | b'*')) => break (TokenKind::Comment, comment(rest)),
                b'#' if self.context == Context::LineStart => break (TokenKind::Directive, 1),
                b'"' => match rest[1..].iter().position(|byte| matches!(byte, b'"' | b'\n')) {
                    Some(length) if rest[length + 1] == b'"' => break (TokenKind::Text, length + 2),
                    _ => break (TokenKind::Sign, 1),
                },
                b'.' if rest.get(1).is_some_and(u8::is_ascii_digit) => break (TokenKind::Number, number(rest)),
                byte if byte.is_ascii_digit() => break (TokenKind::Number, number(rest)),
                byte if is_word(byte.into()) => break (TokenKind::Word, word(rest)),
                // A character outside of ASCII is kept whole.
                _ => break (TokenKind::Sign, self.text[self.at..].chars().next()?.len_utf8()),
            }
        };
        self.context = match (self.context, kind) {
            (context, TokenKind::Comment) => context,
            (Context::LineStart, TokenKind::Directive) => Context::Directive,
            (Context::LineStart, _) => Context::Code,
            (context, _) => context,
        };
        let bytes = self.at..self.at + length;
        self.at = bytes.end;
        Some(Token { kind, text: &self.text[bytes.clone()], bytes, in_directive: self.context == Context::Directive })
    }
}

/// Length of a backslash with the line break behind it; 0 if there is none.
fn line_break(rest: &[u8]) -> usize {
    [b"\\\n".as_slice(), b"\\\r\n"].into_iter().find(|end| rest.starts_with(end)).map_or(0, <[u8]>::len)
}

fn comment(rest: &[u8]) -> usize {
    if rest[1] == b'*' {
        return rest[2..].windows(2).position(|pair| pair == b"*/").map_or(rest.len(), |end| end + 4);
    }
    // A backslash before the line break continues the comment, as the compiler has it.
    let breaks = rest.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at);
    let continues = |at: usize| rest[..at].strip_suffix(b"\r").unwrap_or(&rest[..at]).ends_with(b"\\");
    breaks.into_iter().find(|at| !continues(*at)).unwrap_or(rest.len())
}

fn word(rest: &[u8]) -> usize {
    rest.iter().take_while(|byte| is_word((**byte).into())).count()
}

/// Length of a number. As in the preprocessor, everything that can follow belongs to it, so `1.0.5` is one number, and a wrong one.
fn number(rest: &[u8]) -> usize {
    let is_hexadecimal = rest.starts_with(b"0x") || rest.starts_with(b"0X");
    let mut before = 0;
    let continues = |byte: &&u8| {
        let is_sign = matches!(**byte, b'+' | b'-') && matches!(before, b'e' | b'E') && !is_hexadecimal;
        before = **byte;
        is_word((**byte).into()) || **byte == b'.' || is_sign
    };
    rest.iter().take_while(continues).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(TokenKind, &str)> {
        tokens(text).map(|token| (token.kind, token.text)).collect()
    }

    fn texts(text: &str) -> Vec<&str> {
        tokens(text).map(|token| token.text).collect()
    }

    #[test]
    fn words_numbers_and_signs() {
        assert_eq!(texts("x=1.5f*(y2)"), ["x", "=", "1.5f", "*", "(", "y2", ")"]);
        assert_eq!(
            texts("a.xy+.5-1e-3*2E+4f/0x1e+3u%1.0.5"),
            ["a", ".", "xy", "+", ".5", "-", "1e-3", "*", "2E+4f", "/", "0x1e", "+", "3u", "%", "1.0.5"]
        );
        assert_eq!(texts("a<<=b[1]++"), ["a", "<", "<", "=", "b", "[", "1", "]", "+", "+"]);
        assert_eq!(kinds("a ä 1"), [(TokenKind::Word, "a"), (TokenKind::Sign, "ä"), (TokenKind::Number, "1")]);
        assert_eq!(texts(" \t\r\n\u{b}\u{c}"), [""; 0]);
        let places: Vec<_> = tokens("a  + b").map(|token| token.bytes).collect();
        assert_eq!(places, [0..1, 3..4, 5..6]);
    }

    #[test]
    fn comments() {
        assert_eq!(
            kinds("a/*b*/c//d\ne"),
            [
                (TokenKind::Word, "a"),
                (TokenKind::Comment, "/*b*/"),
                (TokenKind::Word, "c"),
                (TokenKind::Comment, "//d"),
                (TokenKind::Word, "e"),
            ]
        );
        assert_eq!(texts("/*/ a */b"), ["/*/ a */", "b"]);
        assert_eq!(texts("/* // */ a // /* b\nc */"), ["/* // */", "a", "// /* b", "c", "*", "/"]);
        assert_eq!(texts("// a \\\nb\nc"), ["// a \\\nb", "c"]);
        assert_eq!(texts("// a \\\r\nb\r\nc"), ["// a \\\r\nb\r", "c"]);
        assert_eq!(texts("a /* b\nc"), ["a", "/* b\nc"]);
        assert_eq!(texts("//"), ["//"]);
    }

    #[test]
    fn directives() {
        let of = |text| tokens(text).filter(|token| token.in_directive).map(|token| token.text).collect::<Vec<_>>();
        assert_eq!(
            of("a\n # define A(x) #x \\\n  y // z\nb # c"),
            ["#", "define", "A", "(", "x", ")", "#", "x", "y", "// z"]
        );
        assert_eq!(of("#if A /* b\nc */ && D\nE"), ["#", "if", "A", "/* b\nc */", "&", "&", "D"]);
        assert_eq!(of("/* a */ #endif\r\nb"), ["#", "endif"]);
        assert_eq!(of("#\n#"), ["#", "#"]);
        assert_eq!(of("a \\\n#if\n"), [""; 0]);
        assert_eq!(of("#define A \\\r\n#if\n"), ["#", "define", "A", "#", "if"]);
        let starts = |text| tokens(text).filter(|token| token.kind == TokenKind::Directive).count();
        assert_eq!([starts("#define A \\\n#if\n"), starts("#a\n#b"), starts("a #b")], [1, 2, 0]);
        assert_eq!(code("#define A 1\na // b\n#endif\n/* */ c").iter().map(|t| t.text).collect::<Vec<_>>(), ["a", "c"]);
    }

    #[test]
    fn strings() {
        assert_eq!(
            kinds("#include \"a//b.glsl\" // c")[2..],
            [(TokenKind::Text, "\"a//b.glsl\""), (TokenKind::Comment, "// c")]
        );
        assert_eq!(texts("\"a\nb\""), ["\"", "a", "b", "\""]);
    }

    #[test]
    fn assignments_are_no_comparisons() {
        for (text, expected) in [
            ("a = b", true),
            ("a += b", true),
            ("a <<= b", true),
            ("a >>= b", true),
            ("a < b = c", true),
            ("a == b", false),
            ("a <= b", false),
            ("a != b", false),
            ("a >= b", false),
        ] {
            let tokens = code(text);
            assert_eq!((0..tokens.len()).any(|at| assigns(&tokens, at)), expected, "{text}");
        }
    }

    #[test]
    fn code_is_spelled_on_one_line() {
        assert_eq!(spelled(&code("  a+b /* c */ ;\n  d")), "a+b ; d");
    }
}
