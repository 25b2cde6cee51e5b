//! Why the cost of a function cannot be measured.

use std::fmt;

/// Why the cost of a function cannot be measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Lack {
    /// It discards fragments, which decides what else is drawn.
    Discards,
    /// It writes to a buffer or an image.
    WritesMemory,
    /// It writes a variable of the whole stage, of this name.
    WritesVariable(String),
    /// It waits for other invocations, or emits vertices or primitives.
    Emits,
    /// It returns more numbers than are kept, or other things than numbers.
    Returns,
    /// It has an instruction that is not known.
    Unknown,
    /// Its result is a constant with the constants of the picture.
    Constant,
    /// Without it, the driver would get a larger stage: the compiler computes its result once for all pixels.
    Decides,
    /// Without it, a loop of the stage does not end.
    Endless,
    /// It is not called in this picture.
    NotCalled,
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Discards => f.write_str("it discards fragments, which decides what else is drawn"),
            Self::WritesMemory => f.write_str("it writes to a buffer or an image"),
            Self::WritesVariable(name) => write!(f, "it writes `{name}`, which the rest of the stage reads"),
            Self::Emits => f.write_str("it waits for other invocations, or emits vertices or primitives"),
            Self::Returns => f.write_str("it returns too much to be replaced by numbers"),
            Self::Unknown => f.write_str("it has an instruction that Specula does not know"),
            Self::Constant => f.write_str("its result is a constant in this picture, so it costs nothing"),
            Self::Decides => f.write_str("the compiler computes its result once for all pixels"),
            Self::Endless => f.write_str("without it, a loop of the stage does not end"),
            Self::NotCalled => f.write_str("this picture does not call it"),
        }
    }
}
