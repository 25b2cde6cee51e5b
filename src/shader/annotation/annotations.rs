//! The annotations of a whole tree.

use super::pass::PassDesc;
use super::texture::TextureDesc;
use super::{Constant, Mode, Parameter};
use crate::message::did_you_mean;

/// All annotations of a tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Annotations {
    /// Ordered by id.
    pub modes: Vec<Mode>,
    /// Ordered by id.
    pub constants: Vec<Constant>,
    /// Ordered by offset in `Params`, then those of passes by file and line.
    pub parameters: Vec<Parameter>,
    /// Ordered by name.
    pub passes: Vec<PassDesc>,
    /// Ordered by name.
    pub textures: Vec<TextureDesc>,
}

impl Annotations {
    /// A message if no constant has the `name` that follows `when=`.
    pub fn unknown_constant(&self, name: &str) -> Option<String> {
        let mut known = self.constants.iter().map(|constant| constant.name.as_str());
        if known.clone().any(|constant| constant == name) {
            return None;
        }
        Some(format!("no constant with //@ui is named `{name}`.{}", did_you_mean(name, known.by_ref())))
    }
}
