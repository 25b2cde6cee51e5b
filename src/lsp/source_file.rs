//! A file as the editor has it, or as it is on disk, with its declarations.

use lsp_types::{Location, Uri};

use super::source_text::SourceText;
use crate::shader::symbols::{Symbol, Symbols};

/// Files that are longer have no declarations: no compiler takes them.
const LONGEST: usize = 4 << 20;

/// A file.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Its name for the client.
    pub uri: Uri,
    /// Its text.
    pub source: SourceText,
    /// Its declarations.
    pub symbols: Symbols,
}

impl SourceFile {
    /// Reads a text.
    pub fn new(uri: Uri, source: SourceText) -> Self {
        let symbols = if source.text.len() <= LONGEST { Symbols::of(&source.text) } else { Symbols::default() };
        Self { uri, source, symbols }
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// Whether the text is so long that nothing is looked up in it.
    pub fn is_too_long(&self) -> bool {
        self.text().len() > LONGEST
    }

    /// Where the name of a declaration stands.
    pub fn location(&self, symbol: &Symbol) -> Location {
        Location::new(self.uri.clone(), self.source.span(symbol.bytes.clone()))
    }
}
