//! The tokens of a text, and what they declare.

use std::ops::Range;

use super::symbol::{Symbol, SymbolKind};
use crate::shader::glsl::{QUALIFIERS, Token, TokenKind, is_name};

/// Words that can precede a name and are no type.
const NO_TYPES: [&str; 13] = [
    "return",
    "else",
    "case",
    "do",
    "struct",
    "layout",
    "precision",
    "if",
    "for",
    "while",
    "switch",
    "discard",
    "default",
];

/// Reads declarations from tokens.
pub(super) struct Scanner<'a> {
    pub text: &'a str,
    pub tokens: Vec<Token<'a>>,
    pub out: Vec<Symbol>,
}

impl<'a> Scanner<'a> {
    /// The text of a token; empty behind the last.
    pub fn word(&self, at: usize) -> &'a str {
        self.tokens.get(at).map_or("", |token| token.text)
    }

    pub fn start(&self, at: usize) -> usize {
        self.tokens.get(at).map_or(self.text.len(), |token| token.bytes.start)
    }

    /// The end of a token; that of the text behind the last.
    pub fn end(&self, at: usize) -> usize {
        self.tokens.get(at).map_or(self.text.len(), |token| token.bytes.end)
    }

    pub fn is_name(&self, at: usize) -> bool {
        self.tokens.get(at).is_some_and(|token| token.kind == TokenKind::Word && is_name(token.text))
    }

    /// Whether a type and a name stand here.
    pub fn is_pair(&self, at: usize) -> bool {
        let is_type = |word: &str| !NO_TYPES.contains(&word) && !QUALIFIERS.contains(&word);
        self.is_name(at) && is_type(self.word(at)) && self.is_name(at + 1)
    }

    /// Whether a token is the first on its line.
    pub fn begins_line(&self, at: usize) -> bool {
        let before = at.checked_sub(1).map_or(0, |before| self.end(before));
        at == 0 || self.text[before..self.start(at)].contains('\n')
    }

    /// The index behind the bracket that closes the one at `open`, or of a `;`, `{` or `}` that comes before it where a bracket is missing.
    pub fn behind_bracket(&self, open: usize) -> usize {
        let mut depth = 0_usize;
        for at in open..self.tokens.len() {
            match self.word(at) {
                "(" | "[" => depth += 1,
                ")" | "]" => {
                    depth = depth.saturating_sub(1);
                    if depth == 0 {
                        return at + 1;
                    }
                }
                "{" | "}" => return at,
                ";" if self.word(open) == "[" => return at,
                _ => {}
            }
        }
        self.tokens.len()
    }

    /// The index of the brace that closes the one at `open`; the end if there is none. A body ends before the head of the next function.
    pub fn closing_brace(&self, open: usize) -> usize {
        let mut depth = 0_usize;
        for at in open..self.tokens.len() {
            match self.word(at) {
                "{" if at > open && self.word(at - 1) == ")" => match self.head_before(at) {
                    Some(head) => return head,
                    None => depth += 1,
                },
                "{" => depth += 1,
                "}" => {
                    depth -= 1;
                    if depth == 0 {
                        return at;
                    }
                }
                _ => {}
            }
        }
        self.tokens.len()
    }

    /// The first token of the head of a function whose body begins at `brace`.
    fn head_before(&self, brace: usize) -> Option<usize> {
        let mut depth = 0_usize;
        let mut at = brace.checked_sub(1)?;
        loop {
            match self.word(at) {
                ")" => depth += 1,
                "(" if depth == 1 => break,
                "(" => depth -= 1,
                ";" | "{" | "}" => return None,
                _ => {}
            }
            at = at.checked_sub(1)?;
        }
        let head = at.checked_sub(2)?;
        self.is_pair(head).then_some(head)
    }

    /// Declares the variables of the tokens from `first` to `end`, if they begin with a type and a name. Returns whether they do.
    pub fn declaration(&mut self, first: usize, end: usize, place: &Place) -> bool {
        let mut at = first;
        let mut is_constant = false;
        while at < end && (QUALIFIERS.contains(&self.word(at)) || self.word(at) == "layout") {
            is_constant |= self.word(at) == "const";
            at = if self.word(at + 1) == "(" { self.behind_bracket(at + 1) } else { at + 1 };
        }
        if at >= end || !self.is_name(at) || NO_TYPES.contains(&self.word(at)) {
            return false;
        }
        let type_name = self.word(at).to_owned();
        at += 1;
        let mut of_type = 0;
        while at < end && self.word(at) == "[" {
            (of_type, at) = (of_type + 1, self.behind_bracket(at).max(at + 1));
        }
        let mut is_first = true;
        while at < end && self.is_name(at) && (is_first || matches!(self.word(at + 1), "," | "=" | "[" | ";" | ")")) {
            is_first = false;
            let name = at;
            at += 1;
            let mut dimensions = of_type;
            while at < end && self.word(at) == "[" {
                (dimensions, at) = (dimensions + 1, self.behind_bracket(at).max(at + 1));
            }
            let without_value = at;
            at = self.behind_initializer(at, end);
            let shown = if is_constant && at - without_value < 24 { at } else { without_value };
            let mut symbol = self.symbol(name, place.kind(is_constant), first, shown);
            (symbol.type_name, symbol.dimensions) = (type_name.clone(), dimensions);
            symbol.whole = self.start(first)..self.end(at.min(end).saturating_sub(1)).max(self.end(name));
            match place {
                Place::File => {}
                Place::Members(owner) => symbol.owner.clone_from(owner),
                Place::Parameters(scope) => symbol.scope = Some(scope.clone()),
                // A name is known behind its initializer.
                Place::Block(until) => symbol.scope = Some(self.end(at.saturating_sub(1)).min(*until)..*until),
            }
            self.out.push(symbol);
            if self.word(at) != "," {
                break;
            }
            at += 1;
        }
        !is_first
    }

    /// The index of the `,` or `;` behind an initializer that may stand here.
    fn behind_initializer(&self, from: usize, end: usize) -> usize {
        let mut depth = 0_i32;
        for at in from..end {
            match self.word(at) {
                "," if depth == 0 => return at,
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
        }
        end
    }

    /// A declaration of a name, whose signature goes from one token to before another.
    pub fn symbol(&self, name: usize, kind: SymbolKind, first: usize, behind: usize) -> Symbol {
        let signature = self.start(first)..self.end(behind.saturating_sub(1)).max(self.end(name));
        Symbol::new(self.word(name), kind, self.start(name)..self.end(name), signature)
    }
}

/// Where variables are declared.
pub(super) enum Place {
    File,
    /// In the struct or block of this name.
    Members(String),
    /// In the head of a function with this scope.
    Parameters(Range<usize>),
    /// In a block that ends at this byte.
    Block(usize),
}

impl Place {
    fn kind(&self, is_constant: bool) -> SymbolKind {
        match self {
            Self::Members(_) => SymbolKind::Member,
            Self::Parameters(_) => SymbolKind::Parameter,
            _ if is_constant => SymbolKind::Constant,
            _ => SymbolKind::Variable,
        }
    }
}
