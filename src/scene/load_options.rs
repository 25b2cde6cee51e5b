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

/// Takes a model while its images are still being decoded ([`super::Model::awaits_textures`]).
pub type TakeEarly<'a> = &'a (dyn Fn(super::Model) + Sync);

/// The questions and news of a load for whoever waits for it.
#[derive(Clone, Copy)]
pub struct Caller<'a> {
    /// Asked before each file and each image.
    pub canceled: Canceled<'a>,
    /// Told of the model if decoding its images takes long. `None` to wait for them.
    pub take_early: Option<TakeEarly<'a>>,
}

impl<'a> Caller<'a> {
    /// One that waits for all of the model, until `canceled` says so.
    pub fn until(canceled: Canceled<'a>) -> Self {
        Self { canceled, take_early: None }
    }
}
