//! The parts of GLSL that an editor colors.

use std::ops::Range;

use super::token::{Token, TokenKind, tokens};

/// Kind of a part of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Highlight {
    /// A keyword or a qualifier.
    Keyword,
    /// A built-in type.
    Type,
    /// A name that a parenthesis follows.
    Function,
    /// A number, `true` or `false`.
    Number,
    /// A name in capitals: a constant or a macro.
    Constant,
    /// A string: the name of an included file.
    Text,
    /// A preprocessor directive.
    Directive,
    /// A comment.
    Comment,
    /// An annotation of Specula, `//@`.
    Annotation,
}

const KEYWORDS: &[&str] = &[
    "attribute",
    "break",
    "buffer",
    "case",
    "centroid",
    "coherent",
    "const",
    "continue",
    "default",
    "discard",
    "do",
    "else",
    "flat",
    "for",
    "highp",
    "if",
    "in",
    "inout",
    "invariant",
    "layout",
    "lowp",
    "mediump",
    "noperspective",
    "out",
    "patch",
    "precise",
    "precision",
    "readonly",
    "restrict",
    "return",
    "sample",
    "shared",
    "smooth",
    "struct",
    "subroutine",
    "switch",
    "uniform",
    "varying",
    "volatile",
    "while",
    "writeonly",
];

/// The parts of a text that have a color, in order, none of which spans a line break.
pub fn highlights(text: &str) -> Vec<(Range<usize>, Highlight)> {
    let all: Vec<Token<'_>> = tokens(text).collect();
    let mut found = Vec::new();
    for (at, token) in all.iter().enumerate() {
        let Some(highlight) = highlight(token, all.get(at + 1)) else { continue };
        let mut start = token.bytes.start;
        for line in token.text.split_inclusive('\n') {
            let end = start + line.trim_end_matches(['\n', '\r']).len();
            if end > start {
                found.push((start..end, highlight));
            }
            start += line.len();
        }
    }
    found
}

fn highlight(token: &Token<'_>, next: Option<&Token<'_>>) -> Option<Highlight> {
    let word = token.text;
    match token.kind {
        TokenKind::Comment if word.starts_with("//@") => Some(Highlight::Annotation),
        TokenKind::Comment => Some(Highlight::Comment),
        TokenKind::Text => Some(Highlight::Text),
        TokenKind::Number => Some(Highlight::Number),
        TokenKind::Directive => Some(Highlight::Directive),
        TokenKind::Sign => None,
        TokenKind::Word if token.in_directive && is_directive(word) => Some(Highlight::Directive),
        TokenKind::Word if KEYWORDS.contains(&word) => Some(Highlight::Keyword),
        TokenKind::Word if matches!(word, "true" | "false") => Some(Highlight::Number),
        TokenKind::Word if is_type(word) => Some(Highlight::Type),
        TokenKind::Word if next.is_some_and(|next| next.text == "(") => Some(Highlight::Function),
        TokenKind::Word if is_constant(word) => Some(Highlight::Constant),
        TokenKind::Word => None,
    }
}

fn is_directive(word: &str) -> bool {
    const WORDS: [&str; 14] = [
        "define",
        "defined",
        "elif",
        "else",
        "endif",
        "error",
        "extension",
        "if",
        "ifdef",
        "ifndef",
        "include",
        "line",
        "undef",
        "version",
    ];
    WORDS.contains(&word)
}

/// Whether a word is a built-in type.
fn is_type(word: &str) -> bool {
    let scalar = matches!(word, "void" | "bool" | "int" | "uint" | "float" | "double");
    let numbered = ["vec", "bvec", "ivec", "uvec", "dvec", "mat", "dmat"]
        .iter()
        .any(|of| word.strip_prefix(of).is_some_and(|rest| rest.starts_with(['2', '3', '4']) && rest.len() <= 3));
    // Of integers or not.
    let opaque = |word: &str| {
        let rest = ["sampler", "image", "texture"].iter().find_map(|of| word.strip_prefix(of));
        rest.is_some_and(|rest| matches!(rest.as_bytes().first(), Some(b'1'..=b'3' | b'C' | b'B')))
    };
    scalar || numbered || opaque(word) || word.strip_prefix(['i', 'u']).is_some_and(opaque)
}

fn is_constant(word: &str) -> bool {
    word.len() > 1
        && word.contains(|c: char| c.is_ascii_uppercase())
        && !word.contains(|c: char| c.is_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_their_kinds() {
        use Highlight as H;
        let text = "#include \"a.glsl\" // why\nfloat f(const in vec3 n) {\n    if (N_MAX > 2.0) return dot(n, n);\n}\n//@ui x\n";
        let found: Vec<(&str, Highlight)> =
            highlights(text).into_iter().map(|(bytes, of)| (&text[bytes], of)).collect();
        let expected = [
            ("#", H::Directive),
            ("include", H::Directive),
            ("\"a.glsl\"", H::Text),
            ("// why", H::Comment),
            ("float", H::Type),
            ("f", H::Function),
            ("const", H::Keyword),
            ("in", H::Keyword),
            ("vec3", H::Type),
            ("if", H::Keyword),
            ("N_MAX", H::Constant),
            ("2.0", H::Number),
            ("return", H::Keyword),
            ("dot", H::Function),
            ("//@ui x", H::Annotation),
        ];
        assert_eq!(found, expected);
        for (word, is) in [
            ("sampler2D", true),
            ("usampler2DArray", true),
            ("samplerCube", true),
            ("mat4x3", true),
            ("texture", false),
            ("vector", false),
            ("image2D", true),
            ("imageLoad", false),
        ] {
            assert_eq!(is_type(word), is, "{word}");
        }
    }

    #[test]
    fn a_comment_of_several_lines_has_a_part_on_each() {
        let text = "/* a\r\n\r\n b */ c";
        let found: Vec<&str> = highlights(text).into_iter().map(|(bytes, _)| &text[bytes]).collect();
        assert_eq!(found, ["/* a", " b */"]);
    }
}
