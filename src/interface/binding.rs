//! A descriptor of the contract.

use super::access::Resource;

/// Kind of a descriptor, in GLSL's terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// `uniform` block.
    UniformBuffer,
    /// `buffer` block.
    StorageBuffer,
    /// `sampler2D`.
    Sampler2D,
    /// `sampler2DArray`.
    Sampler2DArray,
    /// `samplerCube`.
    SamplerCube,
    /// `rgba16f image2DArray`: one mip level of an image with all its layers.
    StorageImage,
}

impl BindingKind {
    /// The GLSL spelling, for messages.
    pub fn glsl(self) -> &'static str {
        match self {
            Self::UniformBuffer => "uniform block",
            Self::StorageBuffer => "buffer block",
            Self::Sampler2D => "sampler2D",
            Self::Sampler2DArray => "sampler2DArray",
            Self::SamplerCube => "samplerCube",
            Self::StorageImage => "rgba16f image2DArray",
        }
    }
}

/// One descriptor of the contract. A shader may use any subset.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Descriptor set.
    pub set: u32,
    /// Binding within the set.
    pub binding: u32,
    /// The constant's name in GLSL, `BINDING_...`.
    pub name: &'static str,
    /// The kind of resource bound there.
    pub kind: BindingKind,
    /// For blocks: the largest size in bytes that a shader may declare.
    pub size: u32,
    /// The group of resources that it is bound with; `None` for a descriptor that no shader of a tree reads.
    pub resource: Option<Resource>,
}
