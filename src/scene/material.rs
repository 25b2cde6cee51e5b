//! Materials and textures as plain data: glTF's metallic-roughness material with its extensions, colors linear.

use glam::Affine2;

use crate::interface::{self, TEXTURE_COUNT};
use crate::settings::MaterialChannels;

/// glTF's `alphaMode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Fragments below the cutoff are discarded.
    Mask,
    /// Fragments are blended over what lies behind them.
    Blend,
}

/// A use of a texture by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index into `Model::textures`.
    pub texture: usize,
    /// TEXCOORD set, 0 or 1.
    pub uv_set: u32,
    /// KHR_texture_transform: texture coordinates from mesh coordinates.
    pub uv_from_mesh: Affine2,
}

/// A metallic-roughness material with its extensions, or a specular-glossiness material.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name, or empty.
    pub name: String,
    /// Its numbers, each in its range, and finite except for the attenuation distance. `pack_material` adds what follows from the
    /// textures. With specular-glossiness, the base color is the diffuse color, the roughness the glossiness, and the specular color F0.
    pub numbers: interface::Material,
    /// Coverage.
    pub alpha_mode: AlphaMode,
    /// Draw both faces.
    pub double_sided: bool,
    /// KHR_materials_unlit.
    pub unlit: bool,
    /// KHR_materials_pbrSpecularGlossiness. Its texture replaces metallic-roughness.
    pub specular_glossiness: bool,
    /// Whether the file has the complex index of refraction of a metal.
    pub conductor: bool,
    /// Channels for which the textures read as 1, so that the factor alone counts: those of the material override.
    pub constant: MaterialChannels,
    /// The textures, indexed by `interface::TEXTURE_*`.
    pub textures: [Option<TextureUse>; TEXTURE_COUNT],
}

impl Material {
    /// Whether it has a texture, `interface::TEXTURE_*`.
    pub fn has(&self, texture: u32) -> bool {
        self.textures[texture as usize].is_some()
    }
}

impl Default for Material {
    /// glTF's default material: a white, rough metal without extensions.
    fn default() -> Self {
        Self {
            name: String::new(),
            numbers: interface::default_material(),
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            specular_glossiness: false,
            conductor: false,
            constant: MaterialChannels::default(),
            textures: [None; TEXTURE_COUNT],
        }
    }
}

/// An image and its sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture {
    /// Index into `Model::images`.
    pub image: usize,
    /// Filtering and wrapping.
    pub sampler: Sampler,
}

/// A glTF sampler. The default is trilinear and repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Whether magnification is linear instead of nearest.
    pub mag_linear: bool,
    /// Whether minification is linear instead of nearest.
    pub min_linear: bool,
    /// Mip levels: none, nearest or linear.
    pub mip: Mip,
    /// Horizontal wrap.
    pub wrap_u: Wrap,
    /// Vertical wrap.
    pub wrap_v: Wrap,
}

impl Default for Sampler {
    fn default() -> Self {
        Self { mag_linear: true, min_linear: true, mip: Mip::Linear, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat }
    }
}

/// Use of mip levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mip {
    /// Level 0 only.
    None,
    /// The nearest level.
    Nearest,
    /// Interpolates between two levels.
    Linear,
}

/// Handling of texture coordinates outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Repeat.
    Repeat,
    /// Mirrored repeat.
    Mirror,
    /// Clamp to edge.
    Clamp,
}
