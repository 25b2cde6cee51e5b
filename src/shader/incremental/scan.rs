//! Splits a GLSL file into function definitions and the rest, without a preprocessor.

use std::sync::{Arc, OnceLock};

use foldhash::HashSet;

use super::header::{Header, Parameter};
use crate::shader::glsl::syntax::{self, within};
use crate::shader::glsl::{Token, TokenKind, tokens};

/// Words through which an edit of one function changes the code of others, so that functions cannot be compiled
/// separately: line numbers shift, and `precise` affects the operands of other assignments.
const FAR_REACHING: [&str; 3] = ["__LINE__", "__FILE__", "precise"];

/// A file's text, which is scanned at the first use of [`File::parts`].
#[derive(Debug)]
pub struct File {
    /// The text.
    pub text: Arc<str>,
    parts: OnceLock<Option<Parts>>,
}

/// The function definitions of a file, and the code between them, without comments. Each run of white space is one
/// space.
#[derive(Debug)]
pub struct Parts {
    /// In the order of the file.
    pub functions: Vec<Function>,
    /// The code outside of functions.
    pub rest: String,
    /// The words in `rest`, including macros and their definitions.
    pub rest_words: HashSet<Box<str>>,
}

/// A function definition.
#[derive(Debug)]
pub struct Function {
    pub name: Box<str>,
    /// The return type in GLSL.
    pub returns: Box<str>,
    /// `None` if a parameter has an unknown form.
    pub parameters: Option<Vec<Parameter>>,
    /// Byte offset of the function in [`Parts::rest`].
    pub place: usize,
    /// From the return type to the closing parenthesis.
    pub head: String,
    /// The body with its braces.
    pub body: String,
    /// The words of the body.
    pub words: HashSet<Box<str>>,
}

impl File {
    /// A file that is not scanned yet.
    pub fn new(text: Arc<str>) -> Self {
        Self { text, parts: OnceLock::new() }
    }

    /// The file's parts. `None` if an edit of one function could change another (`precise`, `__LINE__`), or if only a
    /// preprocessor can tell where a function ends.
    pub fn parts(&self) -> Option<&Parts> {
        self.parts.get_or_init(|| parts(&self.text)).as_ref()
    }
}

fn parts(text: &str) -> Option<Parts> {
    let tokens = separable(text)?;
    let code: Vec<Token<'_>> = tokens.iter().filter(|token| !token.in_directive).cloned().collect();
    let depth = code.iter().try_fold(0_usize, |depth, token| match token.text {
        "{" => Some(depth + 1),
        "}" => depth.checked_sub(1),
        _ => Some(depth),
    });
    // Only a preprocessor knows which braces belong together.
    depth.filter(|depth| *depth == 0)?;
    let (mut functions, mut rest, mut end) = (Vec::new(), Plain::default(), 0);
    for syntax::Function { head, body } in syntax::functions(&code) {
        let has_directive = within(&tokens, &(head.start..body.bytes.end)).iter().any(|token| token.in_directive);
        let (Some(header), false) = (Header::parse(within(&tokens, &head)), has_directive) else { continue };
        rest.extend(within(&tokens, &(end..head.start)));
        rest.end_directive();
        end = body.bytes.end;
        let (mut plain_head, mut plain_body) = (Plain::default(), Plain::default());
        plain_head.extend(within(&tokens, &head));
        plain_body.extend(within(&tokens, &body.bytes));
        functions.push(Function {
            name: header.name.into(),
            returns: header.returns.into(),
            parameters: header.parameters,
            place: rest.text.len(),
            head: plain_head.text,
            body: plain_body.text,
            words: plain_body.words,
        });
    }
    rest.extend(within(&tokens, &(end..text.len())));
    Some(Parts { functions, rest: rest.text, rest_words: rest.words })
}

/// The tokens of a file without comments. `None` if a function's code depends on more than its own text.
fn separable(text: &str) -> Option<Vec<Token<'_>>> {
    let is_plain = |token: &Token<'_>| match token.kind {
        TokenKind::Comment => token.text.starts_with("//") || (token.text.len() > 3 && token.text.ends_with("*/")),
        // Part of a `##`, of a string without an end, or of a line that goes on behind its break.
        TokenKind::Sign => !token.text.starts_with(['#', '"', '\\']),
        _ => !FAR_REACHING.contains(&token.text),
    };
    let all: Vec<_> = tokens(text).collect();
    all.iter().all(is_plain).then(|| all.into_iter().filter(|token| token.kind != TokenKind::Comment).collect())
}

/// Code without comments. Each run of white space is one space, and directives have lines of their own.
#[derive(Default)]
struct Plain {
    text: String,
    words: HashSet<Box<str>>,
    /// The end of the last token in the file.
    end: usize,
    in_directive: bool,
}

impl Plain {
    fn extend(&mut self, tokens: &[Token<'_>]) {
        tokens.iter().for_each(|token| self.push(token));
    }

    fn push(&mut self, token: &Token<'_>) {
        if token.kind == TokenKind::Directive || !token.in_directive {
            self.end_directive();
        }
        if token.kind == TokenKind::Directive {
            self.text.push('\n');
        } else if token.bytes.start > self.end && !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push(' ');
        }
        self.text.push_str(token.text);
        (self.end, self.in_directive) = (token.bytes.end, token.in_directive);
        if token.kind == TokenKind::Word && !self.words.contains(token.text) {
            self.words.insert(token.text.into());
        }
    }

    fn end_directive(&mut self) {
        if std::mem::take(&mut self.in_directive) {
            self.text.push('\n');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        parts(text).unwrap().functions.iter().map(|function| function.name.to_string()).collect()
    }

    #[test]
    fn only_definitions_are_functions() {
        let text = "#define BLOCK(x) { x }\nstruct S { float a; };\nuniform U { vec4 u; };\nfloat declared(float x);\n\
                    const float A[2] = { 1.0, f(2.0) }; // void comment() {}\nfloat[2] f(const in S s, float x[2]) { { } }\n\
                    MACRO(x) { }\n/* void g() { */ void h() { \"}\"; }";
        assert_eq!(names(text), ["f", "h"]);
        let parts = parts(text).unwrap();
        let f = &parts.functions[0];
        assert_eq!((f.head.as_str(), f.body.as_str()), ("float[2] f(const in S s, float x[2])", "{ { } }"));
        assert_eq!(&*f.returns, "float [ 2 ]");
        let parameters = f.parameters.as_ref().unwrap();
        assert_eq!(parameters[0].declaration("p"), "S p");
        assert_eq!(parameters[1].declaration("p"), "float p[2]");
        assert!(parts.rest_words.contains("BLOCK") && !parts.rest_words.contains("comment"));
    }

    #[test]
    fn what_only_a_preprocessor_knows_is_no_function() {
        assert_eq!(names("void f() {\n#if A\n}\n#endif\n"), [""; 0]);
        assert!(parts("#if A\nvoid f() {\n#else\nvoid f(int x) {\n#endif\n}\n").is_none());
        for text in
            ["precise float x;", "int x = __LINE__;", "void f() { a\\\nb; }", "#define A a##b", "/* ", "}", "\"a\n"]
        {
            assert!(parts(text).is_none(), "{text}");
        }
        assert_eq!(names("#define A a\\\n}\nvoid f() {}"), ["f"]);
    }

    #[test]
    fn comments_and_white_space_do_not_count() {
        let of = |text: &str| {
            let parts = parts(text).unwrap();
            let functions: Vec<_> = parts.functions.into_iter().map(|f| (f.place, f.head, f.body)).collect();
            (parts.rest, functions)
        };
        let text = "int a;\nfloat f(int x) { return 1.0; }\nint b;";
        assert_eq!(of(text), of("// x\nint a; /* b\n */ float f(int x)\n{ return\n\n1.0; }int b; //\n"));
        assert_eq!(of(text).0, of("int a; int b;").0);
        for other in ["int a; float f(int x) { return 1.5; }\nint b;", "float f(int x) { return 1.0; } int a; int b;"] {
            assert_eq!(of(text).0, of(other).0);
            assert_ne!(of(text).1, of(other).1);
        }
        assert_ne!(of(text).0, of("int a; float f(int x) { return 1.0; }\nint c;").0);
    }
}
