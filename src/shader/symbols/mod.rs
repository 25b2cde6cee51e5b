//! The names that a file declares, with their places, types and scopes, for editors. They are found without a preprocessor and in
//! text that does not parse, since an editor asks while a line is being typed.

mod annotated;
mod comment;
mod scan;
mod scanner;
mod statements;
mod symbol;

use crate::shader::glsl::includes;

pub use comment::comment_of;
pub use symbol::{Symbol, SymbolKind};

use std::ops::Range;

/// The declarations and the includes of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Symbols {
    /// In the order of the text.
    pub all: Vec<Symbol>,
    /// Names of includes as written, with their bytes.
    pub includes: Vec<(String, Range<usize>)>,
}

impl Symbols {
    /// Reads a text.
    pub fn of(text: &str) -> Self {
        let mut all = scan::scan(text);
        all.extend(annotated::annotated(text));
        all.sort_by_key(|symbol| symbol.bytes.start);
        let includes = includes(text).map(|include| (include.name.to_owned(), include.bytes)).collect();
        Self { all, includes }
    }

    /// The declaration whose name holds a byte or ends there.
    pub fn at(&self, byte: usize) -> Option<&Symbol> {
        self.all.iter().find(|symbol| symbol.bytes.start <= byte && byte <= symbol.bytes.end)
    }

    /// The local variables and parameters that code at a byte can use, the nearest first.
    pub fn locals(&self, byte: usize) -> impl Iterator<Item = &Symbol> {
        let is_here =
            move |symbol: &&Symbol| symbol.scope.as_ref().is_some_and(|scope| scope.start <= byte && byte <= scope.end);
        self.all.iter().rev().filter(is_here)
    }

    /// The declarations that the whole file and those that include it can use.
    pub fn globals(&self) -> impl Iterator<Item = &Symbol> {
        self.all.iter().filter(|symbol| symbol.is_global())
    }

    /// The members of a struct or block.
    pub fn members<'a>(&'a self, owner: &'a str) -> impl Iterator<Item = &'a Symbol> {
        self.all.iter().filter(move |symbol| symbol.kind == SymbolKind::Member && symbol.owner == owner)
    }

    /// The function whose head or body holds a byte.
    pub fn function_at(&self, byte: usize) -> Option<&Symbol> {
        let holds = |symbol: &&Symbol| symbol.kind == SymbolKind::Function && symbol.whole.contains(&byte);
        self.all.iter().find(holds)
    }
}

#[cfg(test)]
mod tests;
