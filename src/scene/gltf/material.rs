//! Materials, and the textures, samplers and images that they use.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use glam::{Affine2, Vec3, Vec4};
use gltf::json;
use json::extensions::texture::TextureTransform;
use json::texture::{MagFilter, MinFilter, WrappingMode};
use json::validation::Checked;

use super::super::error::Problem;
use super::super::model::{AlphaMode, Material, Mip, Sampler, Texture, TextureUse, Wrap};
use super::place;
use crate::interface as contract;

type JsonIndex = json::Index<json::Texture>;

/// The highest TEXCOORD set that a vertex carries.
const LAST_UV_SET: u32 = 1;

/// The materials of a file and what they use.
pub struct Materials {
    /// The default material, then the file's.
    pub materials: Vec<Material>,
    /// Used pairs of image and sampler.
    pub textures: Vec<Texture>,
    /// Used images: index in the file and the first use, for messages. `Texture::image` counts these.
    pub images: Vec<(usize, String)>,
    /// Tolerated values.
    pub warnings: Vec<String>,
}

/// Reads all materials.
pub fn read(root: &json::Root) -> Result<Materials, Problem> {
    let mut collector = Collector { root, textures: Vec::new(), images: Vec::new(), warnings: Vec::new() };
    let mut materials = vec![Material::default()];
    let mut seen = HashMap::new();
    for (index, material) in root.materials.iter().enumerate() {
        let place = place("materials", index, material.name.as_deref());
        materials.push(collector.material(material, &place, &mut seen)?);
    }
    let Collector { textures, images, warnings, .. } = collector;
    Ok(Materials { materials, textures, images, warnings })
}

struct Collector<'a> {
    root: &'a json::Root,
    textures: Vec<Texture>,
    images: Vec<(usize, String)>,
    warnings: Vec<String>,
}

/// Textures by file index of the image and sampler.
type Seen = HashMap<(usize, Sampler), usize>;

/// A textureInfo of any kind.
struct Slot {
    texture: JsonIndex,
    uv_set: u32,
    transform: Option<TextureTransform>,
}

impl Slot {
    fn new(info: &json::texture::Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.clone());
        Self { texture: info.index, uv_set: info.tex_coord, transform }
    }

    /// Normal and occlusion textures keep their extensions as raw JSON.
    fn raw(texture: JsonIndex, uv_set: u32, others: Option<&Extensions>, place: &str) -> Result<Self, Problem> {
        let raw = others.and_then(|others| others.get("KHR_texture_transform"));
        let transform = raw.map(|raw| json::deserialize::from_value(raw.clone())).transpose().map_err(|error| {
            Problem::invalid(
                format!("{place}.extensions.KHR_texture_transform"),
                "a texture transform",
                error.to_string(),
            )
        })?;
        Ok(Self { texture, uv_set, transform })
    }
}

/// Extensions that the parser does not know.
type Extensions = serde_json::Map<String, json::Value>;

impl Collector<'_> {
    fn material(&mut self, source: &json::Material, place: &str, seen: &mut Seen) -> Result<Material, Problem> {
        let pbr = &source.pbr_metallic_roughness;
        let extensions = source.extensions.as_ref();
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
        let strength = self.clamp(strength, 0.0..=f32::MAX, place, "emissiveStrength")?;
        let mut factor = |value, name| self.clamp(value, 0.0..=1.0, place, name);
        let mut base = [0.0; 4];
        for (to, from) in base.iter_mut().zip(pbr.base_color_factor.0) {
            *to = factor(from, "baseColorFactor")?;
        }
        let mut emissive = [0.0; 3];
        for (to, from) in emissive.iter_mut().zip(source.emissive_factor.0) {
            *to = factor(from, "emissiveFactor")?;
        }
        let occlusion = source.occlusion_texture.as_ref();
        let normal = source.normal_texture.as_ref();
        let mut material = Material {
            name: source.name.clone().unwrap_or_default(),
            base_color_factor: Vec4::from(base),
            metallic_factor: factor(pbr.metallic_factor.0, "metallicFactor")?,
            roughness_factor: factor(pbr.roughness_factor.0, "roughnessFactor")?,
            emissive_factor: finite(Vec3::from(emissive) * strength, place)?,
            occlusion_strength: factor(
                occlusion.map_or(1.0, |texture| texture.strength.0),
                "occlusionTexture.strength",
            )?,
            normal_scale: self.clamp(
                normal.map_or(1.0, |texture| texture.scale),
                f32::MIN..=f32::MAX,
                place,
                "scale",
            )?,
            alpha_cutoff: self.clamp(source.alpha_cutoff.map_or(0.5, |c| c.0), 0.0..=f32::MAX, place, "alphaCutoff")?,
            alpha_mode: alpha_mode(source, place)?,
            double_sided: source.double_sided,
            unlit: extensions.is_some_and(|extensions| extensions.unlit.is_some()),
            ..Material::default()
        };
        let slots = [
            (contract::TEXTURE_BASE_COLOR, "baseColorTexture", pbr.base_color_texture.as_ref().map(Slot::new)),
            (
                contract::TEXTURE_METALLIC_ROUGHNESS,
                "metallicRoughnessTexture",
                pbr.metallic_roughness_texture.as_ref().map(Slot::new),
            ),
            (contract::TEXTURE_NORMAL, "normalTexture", normal_slot(source, place)?),
            (contract::TEXTURE_OCCLUSION, "occlusionTexture", occlusion_slot(source, place)?),
            (contract::TEXTURE_EMISSIVE, "emissiveTexture", source.emissive_texture.as_ref().map(Slot::new)),
        ];
        for (slot, name, used) in slots {
            let place = format!("{place}.{name}");
            material.textures[slot as usize] = used.map(|used| self.texture_use(&used, &place, seen)).transpose()?;
        }
        Ok(material)
    }

    /// A number inside of its range; one outside is moved there and told of.
    fn clamp(&mut self, value: f32, range: RangeInclusive<f32>, place: &str, name: &str) -> Result<f32, Problem> {
        if !value.is_finite() {
            return Err(Problem::invalid(format!("{place}.{name}"), "a finite number", value.to_string()));
        }
        let clamped = value.clamp(*range.start(), *range.end());
        if clamped != value {
            self.warnings.push(format!("{place}.{name} is {value}, outside of its range: {clamped} is used."));
        }
        Ok(clamped)
    }

    fn texture_use(&mut self, slot: &Slot, place: &str, seen: &mut Seen) -> Result<TextureUse, Problem> {
        let textures = &self.root.textures;
        let index = slot.texture.value();
        let Some(texture) = textures.get(index) else {
            return Err(super::out_of_range(place, "textures", index, textures.len()));
        };
        let image = self.image_of(texture, index)?;
        let sampler = match texture.sampler {
            None => Sampler::default(),
            Some(at) => match self.root.samplers.get(at.value()) {
                Some(sampler) => read_sampler(sampler, at.value())?,
                None => return Err(super::out_of_range(place, "samplers", at.value(), self.root.samplers.len())),
            },
        };
        let mut uv_set = slot.transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(slot.uv_set);
        if uv_set > LAST_UV_SET {
            self.warnings
                .push(format!("{place} reads TEXCOORD_{uv_set}: Specula has sets 0 and 1, so TEXCOORD_0 is used."));
            uv_set = 0;
        }
        let uv_from_mesh = slot.transform.as_ref().map_or(Affine2::IDENTITY, affine);
        if !uv_from_mesh.is_finite() {
            return Err(Problem::invalid(
                format!("{place}.extensions.KHR_texture_transform"),
                "finite numbers",
                "others",
            ));
        }
        let texture = *seen.entry((image, sampler)).or_insert_with(|| {
            let known = self.images.iter().position(|(index, _)| *index == image);
            let image = known.unwrap_or_else(|| {
                self.images.push((image, place.to_owned()));
                self.images.len() - 1
            });
            self.textures.push(Texture { image, sampler });
            self.textures.len() - 1
        });
        Ok(TextureUse { texture, uv_set, uv_from_mesh })
    }

    /// Index of the image of a texture: the WebP one of EXT_texture_webp, or the core one.
    fn image_of(&self, texture: &json::Texture, index: usize) -> Result<usize, Problem> {
        let place = place("textures", index, texture.name.as_deref());
        let webp =
            texture.extensions.as_ref().and_then(|e| e.others.get("EXT_texture_webp")).and_then(|e| e.get("source"));
        // The parser says u32::MAX for "absent".
        let core = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
        let source = match webp {
            Some(source) => source.as_u64().and_then(|source| usize::try_from(source).ok()),
            None => core,
        };
        let Some(source) = source else {
            let expected = "a source that is a PNG, JPEG or WebP image";
            let only: Vec<&str> = texture.extensions.iter().flat_map(|e| e.others.keys()).map(String::as_str).collect();
            let found = if only.is_empty() { "none".into() } else { format!("only the extension {}", only.join(", ")) };
            return Err(Problem::invalid(place, expected, found));
        };
        if source >= self.root.images.len() {
            return Err(super::out_of_range(&place, "images", source, self.root.images.len()));
        }
        Ok(source)
    }
}

fn normal_slot(material: &json::Material, place: &str) -> Result<Option<Slot>, Problem> {
    let place = format!("{place}.normalTexture");
    let slot = material.normal_texture.as_ref().map(|texture| {
        Slot::raw(texture.index, texture.tex_coord, texture.extensions.as_ref().map(|e| &e.others), &place)
    });
    slot.transpose()
}

fn occlusion_slot(material: &json::Material, place: &str) -> Result<Option<Slot>, Problem> {
    let place = format!("{place}.occlusionTexture");
    let slot = material.occlusion_texture.as_ref().map(|texture| {
        Slot::raw(texture.index, texture.tex_coord, texture.extensions.as_ref().map(|e| &e.others), &place)
    });
    slot.transpose()
}

fn alpha_mode(material: &json::Material, place: &str) -> Result<AlphaMode, Problem> {
    match material.alpha_mode {
        Checked::Valid(json::material::AlphaMode::Opaque) => Ok(AlphaMode::Opaque),
        Checked::Valid(json::material::AlphaMode::Mask) => Ok(AlphaMode::Mask),
        Checked::Valid(json::material::AlphaMode::Blend) => Ok(AlphaMode::Blend),
        Checked::Invalid => {
            Err(Problem::invalid(format!("{place}.alphaMode"), "OPAQUE, MASK or BLEND", "another word"))
        }
    }
}

fn finite(value: Vec3, place: &str) -> Result<Vec3, Problem> {
    if value.is_finite() { Ok(value) } else { Err(Problem::invalid(place, "a finite emission", value.to_string())) }
}

/// KHR_texture_transform: translation * rotation * scale. Its rotation is counter-clockwise as seen with v pointing
/// down, hence the minus.
fn affine(transform: &TextureTransform) -> Affine2 {
    Affine2::from_scale_angle_translation(transform.scale.0.into(), -transform.rotation.0, transform.offset.0.into())
}

fn read_sampler(sampler: &json::texture::Sampler, index: usize) -> Result<Sampler, Problem> {
    let invalid = |name: &str, values: &[u32]| {
        Problem::invalid(format!("samplers[{index}].{name}"), format!("one of {values:?}"), "another number")
    };
    let mag_linear = match sampler.mag_filter {
        None | Some(Checked::Valid(MagFilter::Linear)) => true,
        Some(Checked::Valid(MagFilter::Nearest)) => false,
        Some(Checked::Invalid) => return Err(invalid("magFilter", json::texture::VALID_MAG_FILTERS)),
    };
    let (min_linear, mip) = match sampler.min_filter {
        None | Some(Checked::Valid(MinFilter::LinearMipmapLinear)) => (true, Mip::Linear),
        Some(Checked::Valid(MinFilter::Linear)) => (true, Mip::None),
        Some(Checked::Valid(MinFilter::Nearest)) => (false, Mip::None),
        Some(Checked::Valid(MinFilter::LinearMipmapNearest)) => (true, Mip::Nearest),
        Some(Checked::Valid(MinFilter::NearestMipmapNearest)) => (false, Mip::Nearest),
        Some(Checked::Valid(MinFilter::NearestMipmapLinear)) => (false, Mip::Linear),
        Some(Checked::Invalid) => return Err(invalid("minFilter", json::texture::VALID_MIN_FILTERS)),
    };
    let wrap = |mode: Checked<WrappingMode>, name| match mode {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
        Checked::Invalid => Err(invalid(name, json::texture::VALID_WRAPPING_MODES)),
    };
    Ok(Sampler {
        mag_linear,
        min_linear,
        mip,
        wrap_u: wrap(sampler.wrap_s, "wrapS")?,
        wrap_v: wrap(sampler.wrap_t, "wrapT")?,
    })
}
