//! Splits a GLSL file into function definitions and the rest, without a preprocessor.

use std::sync::{Arc, OnceLock};

use foldhash::HashSet;

use super::header::{Header, Parameter};
use super::token::{Kind, Token, tokens};

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
    Scanner::default().run(&tokens(text)?)
}

/// Code without comments. Each run of white space is one space.
#[derive(Default)]
struct Code {
    text: String,
    words: HashSet<Box<str>>,
}

impl Code {
    fn push(&mut self, token: &Token<'_>) {
        if token.kind == Kind::Directive {
            let words = token.text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
            self.words.extend(words.filter(|word| !word.is_empty()).map(Box::from));
            self.text.extend(["\n", token.text, "\n"]);
            return;
        }
        if token.is_spaced && !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push(' ');
        }
        self.text.push_str(token.text);
        if token.kind == Kind::Word && !self.words.contains(token.text) {
            self.words.insert(token.text.into());
        }
    }
}

#[derive(Default)]
struct Scanner {
    rest: Code,
    functions: Vec<Function>,
    /// Whether a function precedes the next token of the rest.
    is_behind_function: bool,
}

impl Scanner {
    fn run(mut self, tokens: &[Token<'_>]) -> Option<Parts> {
        // The first token of the current declaration.
        let (mut first, mut at) = (0, 0);
        while let Some(token) = tokens.get(at) {
            match (token.kind, token.text) {
                (Kind::Directive, _) | (_, ";") => {
                    at += 1;
                    self.rest(&tokens[first..at]);
                    first = at;
                }
                (_, "{") => {
                    let end = at + block(&tokens[at..])?;
                    if !self.function(&tokens[first..at], &tokens[at..end]) {
                        self.rest(&tokens[first..end]);
                    }
                    (first, at) = (end, end);
                }
                (_, "}") => return None,
                _ => at += 1,
            }
        }
        self.rest(&tokens[first..]);
        Some(Parts { functions: self.functions, rest: self.rest.text, rest_words: self.rest.words })
    }

    fn rest(&mut self, tokens: &[Token<'_>]) {
        for token in tokens {
            // A space stands for a function, so that the rest is the same with and without the function.
            let is_spaced = std::mem::take(&mut self.is_behind_function) || token.is_spaced;
            self.rest.push(&Token { is_spaced, ..*token });
        }
    }

    /// Adds a function. Returns false if `before` is not the header of a function, or if the function contains
    /// directives, so that only a preprocessor knows its code.
    fn function(&mut self, before: &[Token<'_>], block: &[Token<'_>]) -> bool {
        let has_directive = block.iter().any(|token| token.kind == Kind::Directive);
        let (Some(header), false) = (Header::parse(before), has_directive) else { return false };
        let (mut head, mut body) = (Code::default(), Code::default());
        before.iter().for_each(|token| head.push(token));
        block.iter().for_each(|token| body.push(token));
        self.is_behind_function = true;
        self.functions.push(Function {
            name: header.name.into(),
            returns: header.returns.into(),
            parameters: header.parameters,
            place: self.rest.text.len(),
            head: head.text,
            body: body.text,
            words: body.words,
        });
        true
    }
}

/// The number of tokens from the opening brace to the matching closing brace, both included. `None` if there is none.
fn block(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate() {
        match token.text {
            "{" => depth += 1,
            "}" if depth == 1 => return Some(at + 1),
            "}" => depth -= 1,
            _ => {}
        }
    }
    None
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
