//! The inputs of a load beside the file.

/// Options of a load.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Whether the model may name files by absolute paths or outside its folder (`--allow-outside`).
    pub allow_outside: bool,
    /// The scene of the file to show (`--scene`); without it, or where the file has fewer, its default one.
    pub scene: Option<usize>,
    /// Files or names of models that are shown beside it.
    pub added: Vec<String>,
}

/// Whether the result of a load is no longer needed.
pub type Canceled<'a> = &'a (dyn Fn() -> bool + Sync);
