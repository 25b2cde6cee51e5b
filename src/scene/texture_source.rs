//! Determines which textures the materials of a model need on the device, and their pixels.

use std::borrow::Cow;
use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::interface::{TEXTURE_METALLIC_ROUGHNESS, TEXTURE_OCCLUSION, TEXTURES, TextureContent};
use crate::scene::{Image, Material, Model, TexelForm, mips, packs_occlusion};

/// A texture as the materials read it. Indices are into `Model::images`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextureSource {
    /// The default for a missing texture: only the factor counts.
    White,
    /// The default for a missing normal texture.
    FlatNormal,
    /// One of the model's images.
    Image {
        /// The image.
        image: usize,
        /// Whether its colors are sRGB-encoded.
        srgb: bool,
    },
    /// A metallic-roughness image with the red channel of an occlusion image of the same size, so that shaders read one
    /// texture instead of two.
    Packed {
        /// The image of the other channels.
        metallic_roughness: usize,
        /// The image of the red channel.
        occlusion: usize,
    },
}

/// The name of a texture slot of a material, as `metallic roughness`.
pub fn slot_name(slot: usize) -> String {
    let name = TEXTURES.get(slot).map_or("", |texture| texture.name);
    name.trim_start_matches("TEXTURE_").to_lowercase().replace('_', " ")
}

/// Pixels that one task of the merge processes.
const PIXELS_A_TASK: usize = 1 << 16;

impl TextureSource {
    /// The texture of a material in a slot, `interface::TEXTURE_*`.
    pub fn of(model: &Model, material: &Material, slot: usize) -> Self {
        let image_in = |slot: usize| material.textures[slot].map(|used| model.textures[used.texture].image);
        let is = |of: &[u32]| of.iter().any(|texture| *texture as usize == slot);
        let content = TEXTURES[slot].content;
        let Some(image) = image_in(slot) else {
            return if content == TextureContent::Normal { Self::FlatNormal } else { Self::White };
        };
        if is(&[TEXTURE_METALLIC_ROUGHNESS, TEXTURE_OCCLUSION])
            && let Some(metallic_roughness) = image_in(TEXTURE_METALLIC_ROUGHNESS as usize)
            && let Some(occlusion) = image_in(TEXTURE_OCCLUSION as usize)
            && metallic_roughness != occlusion
            && packs_occlusion(model, material)
        {
            return Self::Packed { metallic_roughness, occlusion };
        }
        let is_glossiness = material.specular_glossiness && is(&[TEXTURE_METALLIC_ROUGHNESS]);
        Self::Image { image, srgb: content == TextureContent::Color || is_glossiness }
    }

    /// Whether its colors are sRGB-encoded.
    pub fn is_srgb(self) -> bool {
        matches!(self, Self::Image { srgb: true, .. })
    }

    /// The image that gives the texture its name and size; `None` for a default, which has one pixel.
    pub fn image(self, model: &Model) -> Option<&Image> {
        match self {
            Self::White | Self::FlatNormal => None,
            Self::Image { image, .. } | Self::Packed { metallic_roughness: image, .. } => Some(&model.images[image]),
        }
    }

    /// The images that provide its pixels, as indices into `Model::images`.
    pub fn images(self) -> impl Iterator<Item = usize> {
        let [first, second] = match self {
            Self::White | Self::FlatNormal => [None, None],
            Self::Image { image, .. } => [Some(image), None],
            Self::Packed { metallic_roughness, occlusion } => [Some(metallic_roughness), Some(occlusion)],
        };
        first.into_iter().chain(second)
    }

    /// The form of its texels on the device.
    pub fn form(self, model: &Model) -> TexelForm {
        self.image(model).map_or(TexelForm::Rgba8, |image| image.form)
    }

    /// Width and height in pixels.
    pub fn size(self, model: &Model) -> (u32, u32) {
        self.image(model).map_or((1, 1), |image| (image.width, image.height))
    }

    /// The number of mip levels on the device.
    pub fn levels(self, model: &Model) -> u32 {
        match self {
            // The levels of the files would have to be merged too.
            Self::Packed { .. } => {
                let (width, height) = self.size(model);
                mips::count(width, height)
            }
            _ => self.image(model).map_or(1, |image| image.levels),
        }
    }

    /// Bytes of all levels on the device.
    pub fn bytes(self, model: &Model) -> u64 {
        let (width, height) = self.size(model);
        match self {
            Self::Image { image, .. } => model.images[image].bytes(),
            _ => mips::bytes(width, height) as u64,
        }
    }

    /// Writes all levels in the form on the device: [`TextureSource::bytes`] bytes. Call this before the upload frees the texels.
    pub fn write(self, model: &Model, out: &mut [u8]) {
        match self {
            Self::Image { image, srgb } => model.images[image].write(srgb, out),
            _ => {
                let (width, height) = self.size(model);
                Image::rgba8(String::new(), width, height, self.pixels(model).into_owned()).write(false, out);
            }
        }
    }

    /// Its pixels as RGBA with 8 bits a channel, rows from the top, of a texture that is RGBA8 on the device. Call this before the upload
    /// frees the texels.
    pub fn pixels(self, model: &Model) -> Cow<'_, [u8]> {
        match self {
            Self::White => Cow::Borrowed(&[255; 4]),
            Self::FlatNormal => Cow::Borrowed(&[128, 128, 255, 255]),
            Self::Image { image, .. } => model.images[image].pixels(),
            Self::Packed { metallic_roughness, occlusion } => {
                let red = model.images[occlusion].red();
                let mut merged = model.images[metallic_roughness].pixels().into_owned();
                let tasks = merged.par_chunks_mut(4 * PIXELS_A_TASK).zip(red.par_chunks(PIXELS_A_TASK));
                tasks.for_each(|(merged, red)| {
                    merged.chunks_exact_mut(4).zip(red).for_each(|(to, red)| to[0] = *red);
                });
                Cow::Owned(merged)
            }
        }
    }
}

/// All textures that the materials of a model read, the defaults first.
pub fn texture_sources(model: &Model) -> BTreeSet<TextureSource> {
    let used = model
        .materials
        .iter()
        .flat_map(|material| (0..material.textures.len()).map(move |slot| TextureSource::of(model, material, slot)));
    used.chain([TextureSource::White, TextureSource::FlatNormal]).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::interface::{TEXTURE_BASE_COLOR, TEXTURE_CLEARCOAT_NORMAL, TEXTURE_NORMAL};
    use crate::scene::{Sampler, Texture, TextureUse};

    /// Images of these sizes, each with a texture. All pixels are different.
    fn model(sizes: &[(u32, u32)]) -> Model {
        let image = |(index, &(width, height)): (usize, &(u32, u32))| {
            let rgba8 = (0..width * height * 4).map(|byte| (byte as usize * 7 + index * 101) as u8).collect();
            Image::rgba8(format!("image {index}"), width, height, rgba8)
        };
        let texture = |image| Texture { image, sampler: Sampler::default() };
        Model {
            images: Arc::new(sizes.iter().enumerate().map(image).collect()),
            textures: Arc::new((0..sizes.len()).map(texture).collect()),
            ..Model::default()
        }
    }

    fn material(slots: &[(u32, usize)]) -> Material {
        let mut material = Material::default();
        for &(slot, texture) in slots {
            let used = TextureUse { texture, uv_set: 0, uv_from_mesh: glam::Affine2::IDENTITY };
            material.textures[slot as usize] = Some(used);
        }
        material
    }

    #[test]
    fn occlusion_goes_into_the_red_channel_of_a_copy() {
        // More pixels than a task processes, and not a multiple.
        let size = (411, 333);
        let mut model = model(&[size, size]);
        let material = material(&[(TEXTURE_METALLIC_ROUGHNESS, 0), (TEXTURE_OCCLUSION, 1)]);
        model.materials = vec![material.clone(), self::material(&[(TEXTURE_BASE_COLOR, 0)])].into();
        let packed = TextureSource::Packed { metallic_roughness: 0, occlusion: 1 };
        let of = |slot: u32| TextureSource::of(&model, &material, slot as usize);
        assert_eq!([of(TEXTURE_METALLIC_ROUGHNESS), of(TEXTURE_OCCLUSION)], [packed; 2]);
        let pixels = packed.pixels(&model);
        let images = [0, 1].map(|image| model.images[image].pixels());
        let [roughness, occlusion] = images.each_ref().map(|image| image.chunks_exact(4));
        assert_eq!(pixels.len(), 411 * 333 * 4);
        for (merged, (roughness, occlusion)) in pixels.chunks_exact(4).zip(roughness.zip(occlusion)) {
            assert_eq!(merged, [occlusion[0], roughness[1], roughness[2], roughness[3]]);
        }
        // The occlusion image alone is not uploaded. The other image also has another user.
        let image = TextureSource::Image { image: 0, srgb: true };
        assert_eq!(
            Vec::from_iter(texture_sources(&model)),
            [TextureSource::White, TextureSource::FlatNormal, image, packed]
        );
    }

    #[test]
    fn slots_have_names() {
        assert_eq!([slot_name(0), slot_name(1)], ["base color", "metallic roughness"]);
        assert!((0..TEXTURES.len()).all(|slot| !slot_name(slot).is_empty()));
    }

    #[test]
    fn images_that_differ_stay_apart() {
        let apart = |model: &Model, material: &Material| {
            let of = |slot: u32| TextureSource::of(model, material, slot as usize);
            [of(TEXTURE_METALLIC_ROUGHNESS), of(TEXTURE_OCCLUSION)]
        };
        let material = material(&[(TEXTURE_METALLIC_ROUGHNESS, 0), (TEXTURE_OCCLUSION, 1)]);
        let both = |srgb| [TextureSource::Image { image: 0, srgb }, TextureSource::Image { image: 1, srgb: false }];
        assert_eq!(apart(&model(&[(4, 4), (4, 2)]), &material), both(false));
        let glossy = Material { specular_glossiness: true, ..material.clone() };
        assert_eq!(apart(&model(&[(4, 4), (4, 4)]), &glossy), both(true));
        let mut nearest = model(&[(4, 4), (4, 4)]);
        Arc::make_mut(&mut nearest.textures)[1].sampler.mag_linear = false;
        assert_eq!(apart(&nearest, &material), both(false));
        let mut second = material.clone();
        second.textures[TEXTURE_OCCLUSION as usize].as_mut().unwrap().uv_set = 1;
        assert_eq!(apart(&model(&[(4, 4), (4, 4)]), &second), both(false));
        // One image for both needs no merge.
        let one = self::material(&[(TEXTURE_METALLIC_ROUGHNESS, 0), (TEXTURE_OCCLUSION, 0)]);
        assert_eq!(apart(&model(&[(4, 4)]), &one), [TextureSource::Image { image: 0, srgb: false }; 2]);
    }

    #[test]
    fn colors_are_srgb_and_numbers_are_not() {
        let model = model(&[(1, 1)]);
        let all: Vec<(u32, usize)> = (0..crate::interface::TEXTURE_COUNT as u32).map(|slot| (slot, 0)).collect();
        let srgb = |glossy| {
            let material = Material { specular_glossiness: glossy, ..material(&all) };
            (0..all.len()).filter(|&slot| TextureSource::of(&model, &material, slot).is_srgb()).collect::<Vec<_>>()
        };
        assert_eq!(srgb(false), [0, 4, 9, 12, 18]);
        assert_eq!(srgb(true), [0, 1, 4, 9, 12, 18]);
        let bare = Material::default();
        let flat: Vec<usize> = (0..all.len())
            .filter(|&slot| TextureSource::of(&model, &bare, slot) == TextureSource::FlatNormal)
            .collect();
        assert_eq!(flat, [TEXTURE_NORMAL as usize, TEXTURE_CLEARCOAT_NORMAL as usize]);
    }
}
