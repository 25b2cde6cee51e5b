//! Materials and textures as plain data: glTF's metallic-roughness material with its extensions, colors linear.

use glam::{Affine2, Vec3, Vec4};

use crate::interface::TEXTURE_COUNT;
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

/// A metallic-roughness material with its extensions, or a specular-glossiness material. All numbers are in the ranges
/// given here, and finite except for [`Volume::attenuation_distance`].
#[derive(Clone, Debug)]
pub struct Material {
    /// Name, or empty.
    pub name: String,
    /// RGBA factor; with specular-glossiness, the diffuse factor.
    pub base_color_factor: Vec4,
    /// 0..1.
    pub metallic_factor: f32,
    /// Perceptual roughness, 0..1; with specular-glossiness, the glossiness.
    pub roughness_factor: f32,
    /// RGB factor times KHR_materials_emissive_strength.
    pub emissive_factor: Vec3,
    /// Scale of the normal texture.
    pub normal_scale: f32,
    /// Strength of the occlusion texture.
    pub occlusion_strength: f32,
    /// Cutoff for [`AlphaMode::Mask`].
    pub alpha_cutoff: f32,
    /// Coverage.
    pub alpha_mode: AlphaMode,
    /// Draw both faces.
    pub double_sided: bool,
    /// KHR_materials_unlit.
    pub unlit: bool,
    /// KHR_materials_pbrSpecularGlossiness. Diffuse color and glossiness replace base color and roughness, the specular factor
    /// is in `specular.color`, and its texture replaces metallic-roughness.
    pub specular_glossiness: bool,
    /// KHR_materials_ior: index of refraction, at least 1; 0 stands for infinity.
    pub ior: f32,
    /// KHR_materials_clearcoat.
    pub clearcoat: Clearcoat,
    /// KHR_materials_anisotropy.
    pub anisotropy: Anisotropy,
    /// KHR_materials_sheen.
    pub sheen: Sheen,
    /// KHR_materials_specular.
    pub specular: Specular,
    /// KHR_materials_iridescence.
    pub iridescence: Iridescence,
    /// KHR_materials_transmission: transmission factor, 0..1.
    pub transmission_factor: f32,
    /// KHR_materials_volume.
    pub volume: Volume,
    /// KHR_materials_dispersion: 20 / Abbe number, at least 0.
    pub dispersion: f32,
    /// KHR_materials_diffuse_transmission.
    pub diffuse_transmission: DiffuseTransmission,
    /// The complex index of refraction of a metal, if the file has it.
    pub conductor: Option<Conductor>,
    /// Channels for which the textures read as 1, so that the factor alone counts: those of the material override.
    pub constant: MaterialChannels,
    /// The textures, indexed by `interface::TEXTURE_*`.
    pub textures: [Option<TextureUse>; TEXTURE_COUNT],
}

/// KHR_materials_clearcoat: a thin dielectric layer over the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearcoat {
    /// 0..1.
    pub factor: f32,
    /// Perceptual roughness, 0..1.
    pub roughness: f32,
    /// Scale of its normal texture.
    pub normal_scale: f32,
}

/// KHR_materials_anisotropy: highlights stretched along the tangent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anisotropy {
    /// 0..1.
    pub strength: f32,
    /// Radians from the tangent towards the bitangent.
    pub rotation: f32,
}

/// KHR_materials_sheen: a layer of fibers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheen {
    /// RGB factor, 0..1.
    pub color: Vec3,
    /// Perceptual roughness, 0..1.
    pub roughness: f32,
}

/// KHR_materials_specular: weight and tint of the dielectric's reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// 0..1.
    pub factor: f32,
    /// RGB factor of F0, at least 0; with specular-glossiness, F0 itself, 0..1.
    pub color: Vec3,
}

/// KHR_materials_iridescence: a thin film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iridescence {
    /// 0..1.
    pub factor: f32,
    /// Index of refraction of the film, at least 1.
    pub ior: f32,
    /// Thickness in nanometers where the thickness texture is 0.
    pub thickness_min_nm: f32,
    /// Thickness in nanometers where the thickness texture is 1 or missing.
    pub thickness_max_nm: f32,
}

/// KHR_materials_volume: the medium beneath the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Thickness in meters, in object space; 0 is a thin wall.
    pub thickness: f32,
    /// Color of white light after `attenuation_distance`, 0..1.
    pub attenuation_color: Vec3,
    /// Meters, above 0; infinite without attenuation.
    pub attenuation_distance: f32,
}

/// KHR_materials_diffuse_transmission: light that passes through and leaves diffusely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// 0..1.
    pub factor: f32,
    /// RGB factor, 0..1.
    pub color: Vec3,
}

/// A metal's complex index of refraction `n - ik` at about 650, 550 and 450 nm. glTF has no extension for it, so the
/// loader reads it from `extras`: `{"specula": {"conductor_n": [r, g, b], "conductor_k": [r, g, b]}}`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Real part, above 0.
    pub n: Vec3,
    /// Extinction, at least 0.
    pub k: Vec3,
}

impl Default for Material {
    /// glTF's default material: a white, rough metal without extensions.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color_factor: Vec4::ONE,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            emissive_factor: Vec3::ZERO,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha_cutoff: 0.5,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            specular_glossiness: false,
            ior: 1.5,
            clearcoat: Clearcoat { factor: 0.0, roughness: 0.0, normal_scale: 1.0 },
            anisotropy: Anisotropy::default(),
            sheen: Sheen::default(),
            specular: Specular { factor: 1.0, color: Vec3::ONE },
            iridescence: Iridescence { factor: 0.0, ior: 1.3, thickness_min_nm: 100.0, thickness_max_nm: 400.0 },
            transmission_factor: 0.0,
            volume: Volume { thickness: 0.0, attenuation_color: Vec3::ONE, attenuation_distance: f32::INFINITY },
            dispersion: 0.0,
            diffuse_transmission: DiffuseTransmission { factor: 0.0, color: Vec3::ONE },
            conductor: None,
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
