//! The dialogs that let the user choose a file or a folder.

/// The dialog to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Dialog {
    /// A model, an environment, a measured BRDF, or a single shader.
    File,
    /// A model to show beside those on screen.
    Beside,
    /// A look file, or a picture with a look.
    Look,
    /// A folder with a shader tree.
    Tree,
    /// A folder to write the shaders to.
    New,
    /// A picture to compare with.
    Picture,
    /// A folder with a shader tree to compare with.
    SecondTree,
}
