//! Reads GLSL without a preprocessor: its tokens, lines, includes, and the functions and statements that can be found without a
//! compiler. Everything in Specula that looks into a shader's text looks through this module.

mod built_in;
mod entry;
mod highlight;
mod include;
mod lines;
mod qualifiers;
pub mod syntax;
mod token;

pub use built_in::{BUILT_IN, BuiltIn, KEYWORDS, built_in, is_reserved};
pub use entry::{color_of, main_of, outputs};
pub use highlight::{Highlight, highlights};
pub use include::includes;
pub use lines::{Code, Line, find_word, is_same_code, lines};
pub use qualifiers::QUALIFIERS;
pub use token::{Token, TokenKind, assigns, code, is_name, is_word, spelled, tokens};
