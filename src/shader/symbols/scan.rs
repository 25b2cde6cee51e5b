//! Finds the declarations at file level, and those of structs, blocks and macros.

use super::scanner::{Place, Scanner};
use super::statements;
use super::symbol::{Symbol, SymbolKind};
use crate::shader::glsl::{Token, TokenKind, code, is_name, tokens};

/// All declarations of a text.
pub(super) fn scan(text: &str) -> Vec<Symbol> {
    let mut scanner = Scanner { text, tokens: code(text), out: macros(text) };
    let mut at = 0;
    while at < scanner.tokens.len() {
        at = scanner.top(at).max(at + 1);
    }
    scanner.out
}

impl Scanner<'_> {
    /// Reads what begins at file level. Returns the index behind it.
    fn top(&mut self, first: usize) -> usize {
        let mut at = first;
        while at < self.tokens.len() {
            match self.word(at) {
                ";" => {
                    self.plain(first, at);
                    return at + 1;
                }
                "{" if at > first && self.word(at - 1) == ")" => return self.function(first, at),
                "{" => return self.braces(first, at),
                "}" => return at + 1,
                // The line before has no end yet.
                _ if at > first && self.begins_line(at) && self.is_pair(at) && self.word(at + 2) == "(" => {
                    self.plain(first, at);
                    return at;
                }
                "(" | "[" => at = self.behind_bracket(at).max(at + 1),
                _ => at += 1,
            }
        }
        self.plain(first, at);
        at
    }

    /// A statement at file level without braces: variables, or a function without a body.
    fn plain(&mut self, first: usize, end: usize) {
        match self.name_of_function(first, end) {
            Some(name) => self.head(first, name, end, end),
            None => {
                self.declaration(first, end, &Place::File);
            }
        }
    }

    /// The index of the name in the head of a function.
    fn name_of_function(&self, first: usize, end: usize) -> Option<usize> {
        let open = (first..end).find(|at| self.word(*at) == "(" && *at > first && self.word(*at - 1) != "layout")?;
        let name = open.checked_sub(1)?;
        let follows_type = name > first && (self.is_pair(name - 1) || self.word(name - 1) == "]");
        (follows_type && (first..open).all(|at| self.word(at) != "=")).then_some(name)
    }

    fn function(&mut self, first: usize, open: usize) -> usize {
        let close = self.closing_brace(open);
        if let Some(name) = self.name_of_function(first, open) {
            self.head(first, name, open, close);
            statements::body(self, open, close);
        }
        if self.word(close) == "}" { close + 1 } else { close }
    }

    /// Declares a function and its parameters. `open`: the index behind its head.
    fn head(&mut self, first: usize, name: usize, open: usize, close: usize) {
        let has_body = self.word(open) == "{";
        let end = self.behind_bracket(name + 1).min(open);
        let type_at = (first..name).rev().find(|at| self.is_name(*at));
        let whole = self.start(first)..if has_body { self.end(close) } else { self.end(open.saturating_sub(1)) };
        let mut function = self.symbol(name, SymbolKind::Function, first, end);
        function.type_name = type_at.map(|at| self.word(at).to_owned()).unwrap_or_default();
        (function.has_body, function.whole) = (has_body, whole);
        let scope = self.start(name + 1)..self.end(close);
        let mut from = name + 2;
        let mut parameters = Vec::new();
        while from < end {
            let comma = (from..end).find(|at| self.word(*at) == ",").unwrap_or(end - 1);
            if comma > from {
                parameters.push((from, comma));
            }
            from = comma + 1;
        }
        function.parameters = parameters.iter().map(|(from, to)| self.start(*from)..self.end(to - 1)).collect();
        self.out.push(function);
        for (from, to) in parameters {
            self.declaration(from, to, &Place::Parameters(scope.clone()));
        }
    }

    /// A struct, a block, or something else with braces.
    fn braces(&mut self, first: usize, open: usize) -> usize {
        let close = self.closing_brace(open);
        let behind = (close..self.tokens.len()).find(|at| self.word(*at) == ";").map_or(close, |at| at + 1);
        let name = open.checked_sub(1).filter(|at| *at >= first && self.is_name(*at));
        let Some(name) = name else { return close + 1 };
        let has = |word: &str| (first..open).any(|at| self.word(at) == word);
        let is_struct = has("struct") || has("buffer_reference");
        let kind = if is_struct { SymbolKind::Struct } else { SymbolKind::Block };
        let mut symbol = self.symbol(name, kind, first, open);
        symbol.whole = self.start(first)..self.end(behind.saturating_sub(1));
        let owner = symbol.name.clone();
        self.out.push(symbol);
        let instance = Some(close + 1).filter(|at| *at < behind && self.is_name(*at));
        let place = if is_struct || instance.is_some() { Place::Members(owner.clone()) } else { Place::File };
        let mut from = open + 1;
        while from < close {
            let end = (from..close).find(|at| self.word(*at) == ";").unwrap_or(close);
            self.declaration(from, end, &place);
            from = end + 1;
        }
        if let Some(instance) = instance {
            let mut variable = self.symbol(instance, SymbolKind::Variable, first, open);
            variable.type_name = owner;
            variable.dimensions = usize::from(self.word(instance + 1) == "[");
            variable.whole = self.start(first)..self.end(behind - 1);
            self.out.push(variable);
        }
        behind.max(close + 1)
    }
}

/// The names that lines `#define NAME` declare.
fn macros(text: &str) -> Vec<Symbol> {
    let all: Vec<Token<'_>> =
        tokens(text).filter(|token| token.in_directive && token.kind != TokenKind::Comment).collect();
    let defines = (0..all.len()).filter(|at| {
        let word = |index: usize| all.get(index).map_or("", |token| token.text);
        all[*at].kind == TokenKind::Directive && word(at + 1) == "define" && is_name(word(at + 2))
    });
    defines
        .map(|at| {
            let behind = all[at + 1..].iter().position(|token| token.kind == TokenKind::Directive);
            let last = behind.map_or(all.len(), |count| at + 1 + count) - 1;
            let name = &all[at + 2];
            let whole = all[at].bytes.start..all[last].bytes.end;
            Symbol::new(name.text, SymbolKind::Macro, name.bytes.clone(), whole)
        })
        .collect()
}
