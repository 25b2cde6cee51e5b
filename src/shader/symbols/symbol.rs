//! A declaration in a file.

use std::ops::Range;

/// Kind of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SymbolKind {
    /// A function, with or without its body.
    Function,
    /// A struct, or a block that is a type (`buffer_reference`).
    Struct,
    /// A uniform, buffer or interface block.
    Block,
    /// A `const`.
    Constant,
    /// A variable.
    Variable,
    /// A parameter of a function.
    Parameter,
    /// A member of a struct or block.
    Member,
    /// A `#define`.
    Macro,
    /// The name behind `//@pass`: that of its image, too.
    Pass,
    /// The name behind `//@texture`.
    Texture,
    /// The name behind `//@mode`.
    Mode,
}

/// A declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// Kind of the declaration.
    pub kind: SymbolKind,
    /// The bytes of the name.
    pub bytes: Range<usize>,
    /// The bytes of the whole declaration, with the body of a function and the members of a struct.
    pub whole: Range<usize>,
    /// The bytes that say what it is: the head of a function, a declaration without its initializer unless that is a constant's.
    pub signature: Range<usize>,
    /// The type of a value, or that of what a function returns; else empty.
    pub type_name: String,
    /// Number of pairs of brackets behind the type or the name.
    pub dimensions: usize,
    /// The struct or block of a member; else empty.
    pub owner: String,
    /// The bytes in which a local name can be used.
    pub scope: Option<Range<usize>>,
    /// The bytes of each parameter of a function.
    pub parameters: Vec<Range<usize>>,
    /// Whether it is a function with a body.
    pub has_body: bool,
}

impl Symbol {
    /// A declaration with a signature. What else it has is set later.
    pub fn new(name: &str, kind: SymbolKind, bytes: Range<usize>, signature: Range<usize>) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            bytes,
            whole: signature.clone(),
            signature,
            type_name: String::new(),
            dimensions: 0,
            owner: String::new(),
            scope: None,
            parameters: Vec::new(),
            has_body: false,
        }
    }

    /// Whether files that include this one can use the name.
    pub fn is_global(&self) -> bool {
        let is_annotated = matches!(self.kind, SymbolKind::Pass | SymbolKind::Texture | SymbolKind::Mode);
        self.scope.is_none() && self.kind != SymbolKind::Member && !is_annotated
    }

    /// Whether it is a value of a type.
    pub fn is_value(&self) -> bool {
        matches!(self.kind, SymbolKind::Constant | SymbolKind::Variable | SymbolKind::Parameter | SymbolKind::Member)
    }
}
