//! The inputs of a load beside the file.

/// Options of a load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Whether the model may name files by absolute paths or outside its folder (`--allow-outside`).
    pub allow_outside: bool,
}

/// Whether the result of a load is no longer needed.
pub type Canceled<'a> = &'a (dyn Fn() -> bool + Sync);
