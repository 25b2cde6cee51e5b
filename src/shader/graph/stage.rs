//! The stages of passes.

use std::collections::BTreeSet;

use crate::shader::compile::StageKind;
use crate::shader::contract::Texts;
use crate::shader::spirv::reflect::Reflection;

/// The vertex stage of stages that cover an image.
pub const FULL_SCREEN: &str = "fullscreen.vert";

/// A stage that declares a pass.
pub struct PassStage<'a> {
    /// The kind of stage.
    pub kind: StageKind,
    /// The declarations of its module.
    pub reflection: &'a Reflection,
    /// Its source text.
    pub texts: Texts<'a>,
    /// Returns the bindings of `interface::SET_PASS` that its outputs depend on.
    pub live: Box<dyn Fn() -> &'a BTreeSet<u32> + 'a>,
}
