//! The texture slots of materials: textures, samplers, images and texture transforms.

use std::collections::HashMap;

use glam::Affine2;
use gltf::json;
use json::extensions::texture::TextureTransform;
use json::texture::{MagFilter, MinFilter, WrappingMode};
use json::validation::Checked;

use super::placeholder;
use crate::scene::error::Problem;
use crate::scene::gltf::left_out::{LeftOut, Part};
use crate::scene::gltf::place::{get, out_of_range, place};
use crate::scene::gltf::values::{self, Extensions, Fields};
use crate::scene::model::{Material, Mip, Sampler, Texture, TextureUse, Wrap};

/// The highest TEXCOORD set of a vertex.
const LAST_UV_SET: u32 = 1;

/// Extensions that name another image for a texture, the best first.
const SOURCES: [&str; 2] = ["KHR_texture_basisu", "EXT_texture_webp"];

/// Collects the textures and images that the materials of a file use, each once.
pub struct Collector<'a> {
    /// Used pairs of image and sampler.
    pub textures: Vec<Texture>,
    /// Where the used images are. `Texture::image` counts these.
    pub images: Vec<Origin>,
    /// Corrected values, one sentence each.
    pub warnings: Vec<String>,
    /// Parts of materials that cannot be used.
    pub left_out: LeftOut,
    root: &'a json::Root,
    /// Indices into `images`.
    image_of: HashMap<Origin, usize>,
    /// Indices into `textures`, by image and sampler.
    texture_of: HashMap<(usize, Sampler), usize>,
}

/// The source of a texture's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// Index of an image of the file; in range.
    Image(usize),
    /// Index of a texture without an image that Specula can decode.
    Texture(usize),
}

/// A textureInfo, which is a material's reference to a texture.
pub struct TextureSlot {
    texture: usize,
    uv_set: u32,
    transform: Option<TextureTransform>,
}

impl TextureSlot {
    /// Reads a textureInfo that the parser knows.
    pub fn new(info: &json::texture::Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.clone());
        Self { texture: info.index.value(), uv_set: info.tex_coord, transform }
    }

    /// Reads a textureInfo of a material extension.
    pub fn of(fields: &Fields<'_>, key: &str) -> Result<Option<Self>, Problem> {
        let Some(info) = fields.open_member(key)? else { return Ok(None) };
        let texture = info.index("index", "textures")?;
        let uv_set = match info.get("texCoord") {
            None => 0,
            Some(value) => values::whole(value).ok_or_else(|| {
                Problem::invalid(info.at("texCoord"), "a TEXCOORD set's number", values::quote(value))
            })?,
        };
        let others = info.get("extensions").and_then(json::Value::as_object);
        Self::raw(texture, uv_set, others, &info.place).map(Some)
    }

    /// Reads a slot whose extensions are raw JSON: that of a normal or occlusion texture, or of a material extension.
    pub fn raw(texture: usize, uv_set: u32, others: Option<&Extensions>, place: &str) -> Result<Self, Problem> {
        let raw = others.and_then(|others| others.get("KHR_texture_transform"));
        let transform = raw.map(|raw| json::deserialize::from_value(raw.clone())).transpose().map_err(|error| {
            let place = format!("{place}.extensions.KHR_texture_transform");
            Problem::invalid(place, "a texture transform", error.to_string())
        })?;
        Ok(Self { texture, uv_set, transform })
    }
}

impl<'a> Collector<'a> {
    /// An empty collector.
    pub fn new(root: &'a json::Root) -> Self {
        let (textures, images, warnings) = (Vec::new(), Vec::new(), Vec::new());
        let (image_of, texture_of) = (HashMap::new(), HashMap::new());
        Self { textures, images, warnings, left_out: LeftOut::default(), root, image_of, texture_of }
    }

    /// Sets the texture of a material's slot, `interface::TEXTURE_*`, or leaves it out.
    pub fn bind(
        &mut self,
        material: &mut Material,
        texture: u32,
        slot: Result<Option<TextureSlot>, Problem>,
        place: &str,
    ) {
        let used = slot.and_then(|slot| slot.map(|slot| self.texture_use(&slot, place)).transpose());
        match self.left_out.unless(Part::TEXTURE, place, used) {
            Some(used) => material.textures[texture as usize] = used,
            None => placeholder::clear(material, texture),
        }
    }

    fn texture_use(&mut self, slot: &TextureSlot, place: &str) -> Result<TextureUse, Problem> {
        let textures = &self.root.textures;
        let Some(texture) = textures.get(slot.texture) else {
            return Err(out_of_range(place, "textures", slot.texture, textures.len()));
        };
        let origin = self.origin(texture, slot.texture)?;
        let sampler = texture.sampler.and_then(|at| {
            let sampler = get(&self.root.samplers, at, place, "samplers");
            let sampler = sampler.and_then(|sampler| read_sampler(sampler, at.value()));
            self.left_out.unless(Part::SAMPLER, place, sampler)
        });
        let sampler = sampler.unwrap_or_default();
        let mut uv_set = slot.transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(slot.uv_set);
        if uv_set > LAST_UV_SET {
            self.warnings
                .push(format!("{place} reads TEXCOORD_{uv_set}: Specula has sets 0 and 1, so TEXCOORD_0 is used."));
            uv_set = 0;
        }
        let uv_from_mesh = slot.transform.as_ref().map_or(Ok(Affine2::IDENTITY), |t| affine(t, place))?;
        let image = *self.image_of.entry(origin).or_insert_with(|| {
            self.images.push(origin);
            self.images.len() - 1
        });
        let texture = *self.texture_of.entry((image, sampler)).or_insert_with(|| {
            self.textures.push(Texture { image, sampler });
            self.textures.len() - 1
        });
        Ok(TextureUse { texture, uv_set, uv_from_mesh })
    }

    /// The source of a texture's image: that of an extension, or of the core texture.
    fn origin(&self, texture: &json::Texture, index: usize) -> Result<Origin, Problem> {
        let place = place("textures", index, texture.name.as_deref());
        let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
        let extended = others.and_then(|others| SOURCES.iter().find_map(|name| others.get(*name)?.get("source")));
        // The parser returns u32::MAX if the source is absent.
        let core = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
        let source = match extended {
            Some(source) => Some(values::index(Some(source), &place, "images")?),
            None => core,
        };
        match source {
            Some(source) if source >= self.root.images.len() => {
                Err(out_of_range(&place, "images", source, self.root.images.len()))
            }
            Some(source) => Ok(Origin::Image(source)),
            None => Ok(Origin::Texture(index)),
        }
    }
}

/// KHR_texture_transform: translation * rotation * scale. The rotation is counter-clockwise while v points down, hence the
/// minus.
fn affine(transform: &TextureTransform, place: &str) -> Result<Affine2, Problem> {
    let (offset, scale, rotation) = (transform.offset.0, transform.scale.0, transform.rotation.0);
    let affine = Affine2::from_scale_angle_translation(scale.into(), -rotation, offset.into());
    if affine.is_finite() {
        return Ok(affine);
    }
    let found = format!("offset {offset:?}, rotation {rotation}, scale {scale:?}");
    Err(Problem::invalid(format!("{place}.extensions.KHR_texture_transform"), "finite numbers", found))
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
