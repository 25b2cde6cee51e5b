//! The functions and statements of a GLSL file, found without a preprocessor: enough to know where a call can be inserted.

use std::ops::Range;

use super::token::Token;

/// Kind of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatementKind {
    /// `{ ... }`
    Block,
    /// A declaration, an assignment or a call, up to its `;`.
    Simple,
    /// `return`, `discard`, `break` or `continue`.
    Jump,
    /// `if` or `switch`.
    Branch,
    /// `for` or `while`.
    Loop,
    /// `do ... while`.
    DoLoop,
}

/// A statement.
#[derive(Debug)]
pub struct Statement {
    /// Kind of the statement.
    pub kind: StatementKind,
    /// All of its bytes.
    pub bytes: Range<usize>,
    /// The bytes that belong to none of its substatements: the parentheses of a condition or of a loop.
    pub header: Range<usize>,
    /// The statements in it.
    pub parts: Vec<Statement>,
    /// Whether it is a statement of a block, so that others may be inserted beside it.
    pub is_in_block: bool,
}

/// A function definition.
#[derive(Debug)]
pub struct Function {
    /// From the return type to the closing parenthesis.
    pub head: Range<usize>,
    /// Its body, a block.
    pub body: Statement,
}

/// The function definitions of a file. Parts that do not parse are left out.
pub fn functions(tokens: &[Token<'_>]) -> Vec<Function> {
    let mut out = Vec::new();
    let (mut first, mut at) = (0, 0);
    while let Some(token) = tokens.get(at) {
        match token.text {
            ";" | "}" => {
                at += 1;
                first = at;
            }
            "{" if at > first && tokens[at - 1].text == ")" => {
                let mut parser = Parser { tokens, at };
                match parser.statement(true) {
                    Some(body) => {
                        out.push(Function { head: tokens[first].bytes.start..tokens[at - 1].bytes.end, body });
                        at = parser.at;
                    }
                    None => at = closing(tokens, at).map_or(tokens.len(), |end| end + 1),
                }
                first = at;
            }
            // A struct or a block of the interface; its declaration extends to the `;`.
            "{" => at = closing(tokens, at).map_or(tokens.len(), |end| end + 1),
            _ => at += 1,
        }
    }
    out
}

/// The tokens that stand in no brackets, with their indices.
pub fn outside_brackets<'a, 'b>(tokens: &'a [Token<'b>]) -> impl Iterator<Item = (usize, &'a Token<'b>)> {
    let mut depth = 0_i32;
    tokens.iter().enumerate().filter(move |(_, token)| {
        let inside = depth;
        depth += i32::from(matches!(token.text, "(" | "[" | "{")) - i32::from(matches!(token.text, ")" | "]" | "}"));
        inside == 0 && depth == 0
    })
}

/// The part of tokens that lies in a range of bytes.
pub fn within<'a, 'b>(tokens: &'a [Token<'b>], bytes: &Range<usize>) -> &'a [Token<'b>] {
    let start = tokens.partition_point(|token| token.bytes.start < bytes.start);
    let end = tokens.partition_point(|token| token.bytes.start < bytes.end);
    &tokens[start..end.max(start)]
}

/// The index of the bracket that closes the one at `open`.
pub fn closing(tokens: &[Token<'_>], open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => {}
        }
    }
    None
}

struct Parser<'a, 'b> {
    tokens: &'b [Token<'a>],
    at: usize,
}

impl Parser<'_, '_> {
    fn text(&self) -> &str {
        self.tokens.get(self.at).map_or("", |token| token.text)
    }

    fn start(&self) -> usize {
        self.tokens.get(self.at).map_or(usize::MAX, |token| token.bytes.start)
    }

    /// The end of the token before the current one.
    fn end(&self) -> usize {
        self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).map_or(0, |token| token.bytes.end)
    }

    /// Skips brackets. Returns their bytes.
    fn brackets(&mut self) -> Option<Range<usize>> {
        let start = self.start();
        self.at = closing(self.tokens, self.at)? + 1;
        Some(start..self.end())
    }

    /// Skips everything up to and including a `;`.
    fn skip_statement(&mut self) -> Option<()> {
        loop {
            match self.text() {
                ";" => {
                    self.at += 1;
                    return Some(());
                }
                "(" | "[" | "{" => {
                    self.brackets()?;
                }
                "" | ")" | "]" | "}" => return None,
                _ => self.at += 1,
            }
        }
    }

    fn statement(&mut self, is_in_block: bool) -> Option<Statement> {
        let start = self.start();
        // Labels of a switch and attributes of a loop.
        while matches!(self.text(), "case" | "default") {
            while self.text() != ":" {
                (self.at < self.tokens.len()).then_some(())?;
                self.at += 1;
            }
            self.at += 1;
        }
        let start = if self.text() == "}" { start } else { self.start() };
        while self.text() == "[" {
            self.brackets()?;
        }
        let mut parts = Vec::new();
        let mut header = start..start;
        let kind = match self.text() {
            "{" => {
                self.at += 1;
                while self.text() != "}" {
                    (self.at < self.tokens.len()).then_some(())?;
                    parts.extend(self.part_of_block()?);
                }
                self.at += 1;
                StatementKind::Block
            }
            word @ ("if" | "switch") => {
                let is_if = word == "if";
                self.at += 1;
                header = self.brackets()?;
                parts.push(self.statement(false)?);
                if is_if && self.text() == "else" {
                    self.at += 1;
                    parts.push(self.statement(false)?);
                }
                StatementKind::Branch
            }
            "for" | "while" => {
                self.at += 1;
                header = self.brackets()?;
                parts.push(self.statement(false)?);
                StatementKind::Loop
            }
            "do" => {
                self.at += 1;
                parts.push(self.statement(false)?);
                let from = self.start();
                self.skip_statement()?;
                header = from..self.end();
                StatementKind::DoLoop
            }
            "return" | "discard" | "break" | "continue" => {
                self.skip_statement()?;
                StatementKind::Jump
            }
            _ => {
                self.skip_statement()?;
                StatementKind::Simple
            }
        };
        Some(Statement { kind, bytes: start..self.end(), header, parts, is_in_block })
    }

    /// The next statement of a block; empty where only labels are left.
    fn part_of_block(&mut self) -> Option<Option<Statement>> {
        let mut ahead = self.at;
        while matches!(self.tokens.get(ahead).map(|token| token.text), Some("case" | "default")) {
            ahead += self.tokens[ahead..].iter().position(|token| token.text == ":")? + 1;
        }
        if self.tokens.get(ahead)?.text == "}" {
            self.at = ahead;
            return Some(None);
        }
        self.statement(true).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::super::code;
    use super::*;

    #[test]
    fn functions_and_statements_are_found() {
        let text = "#define F(x) {\nstruct S { float a; };\nfloat f(float x) {\n  for (int i = 0; i < 2; ++i) x += 1.0;\n  \
            if (x > 0.0) { return x; } else return 0.0;\n  switch (1) { case 1: x = 2.0; break; default: }\n  return x;\n}\n\
            const float c = 1.0; vec2 g() { return vec2(0.0); }\n";
        let tokens = code(text);
        let found = functions(&tokens);
        let heads: Vec<&str> = found.iter().map(|function| &text[function.head.clone()]).collect();
        assert_eq!(heads, ["float f(float x)", "vec2 g()"]);
        let kinds: Vec<StatementKind> = found[0].body.parts.iter().map(|part| part.kind).collect();
        assert_eq!(kinds, [StatementKind::Loop, StatementKind::Branch, StatementKind::Branch, StatementKind::Jump]);
        let inner = &found[0].body.parts[0].parts[0];
        assert_eq!((&text[inner.bytes.clone()], inner.is_in_block), ("x += 1.0;", false));
        let of_switch = &found[0].body.parts[2].parts[0].parts;
        let texts: Vec<&str> = of_switch.iter().map(|part| &text[part.bytes.clone()]).collect();
        assert_eq!(texts, ["x = 2.0;", "break;"]);
    }
}
