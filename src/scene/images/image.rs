//! An image of a model.

use std::borrow::Cow;

use super::convert::OnDevice;
use super::form::{TexelForm, TexelForms};
use super::texels::Texels;
use crate::scene::mips;

/// An image. Rows begin at the top. The color space depends on the use, so it is not converted.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name or URI, for messages.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The texels of the file. The upload frees them, so they are empty afterwards.
    pub texels: Texels,
    /// The form of its texels on the device.
    pub form: TexelForm,
    /// The number of its mip levels on the device.
    pub levels: u32,
}

impl Image {
    /// An image of these texels, in the form that it takes on a device which has no forms but the ones that every device has.
    pub fn new(name: String, width: u32, height: u32, texels: Texels) -> Self {
        let mut image = Self { name, width, height, texels, form: TexelForm::Rgba8, levels: 1 };
        image.settle(&TexelForms::default());
        image
    }

    /// An image of RGBA with 8 bits a channel: `width * height * 4` bytes.
    pub fn rgba8(name: String, width: u32, height: u32, bytes: Vec<u8>) -> Self {
        Self::new(name, width, height, Texels::Stored { form: TexelForm::Rgba8, levels: 1, bytes })
    }

    /// Chooses the form on a device that samples `forms`. Compressed texels whose file has no mip levels are decoded, since the levels
    /// must be computed.
    pub fn settle(&mut self, forms: &TexelForms) {
        let (own, all) = (self.texels.levels(), mips::count(self.width, self.height));
        let is_whole = own > 1 || all == 1;
        let fits = |form: &&TexelForm| forms.has(**form) && (is_whole || !form.is_compressed());
        let fallback = if self.texels.is_hdr() { TexelForm::Half } else { TexelForm::Rgba8 };
        self.form = self.texels.forms().iter().find(fits).copied().unwrap_or(fallback);
        self.levels = if is_whole { own } else { all };
    }

    /// Bytes of all levels on the device.
    pub fn bytes(&self) -> u64 {
        let level = |level| {
            let (width, height) = mips::size(self.width, self.height, level);
            self.form.bytes(width, height)
        };
        (0..self.levels).map(level).sum()
    }

    /// The pixels of the largest level as RGBA with 8 bits a channel, of an image that is RGBA8 on the device.
    pub fn pixels(&self) -> Cow<'_, [u8]> {
        self.on_device().level(&self.texels, 0, false)
    }

    /// The first channel of the pixels of [`Image::pixels`].
    pub fn red(&self) -> Vec<u8> {
        match &self.texels {
            Texels::Stored { form: TexelForm::Rgb8, levels: 1, bytes } => bytes.iter().step_by(3).copied().collect(),
            _ => self.pixels().iter().step_by(4).copied().collect(),
        }
    }

    /// Writes all levels in the form on the device: [`Image::bytes`] bytes. `srgb`: whether colors are sRGB-encoded.
    pub fn write(&self, srgb: bool, out: &mut [u8]) {
        self.on_device().write(&self.texels, srgb, out);
    }

    /// Frees the texels.
    pub fn free(&mut self) {
        let (form, levels) = (self.form, self.levels);
        self.texels = Texels::Stored { form, levels, bytes: Vec::new() };
    }

    fn on_device(&self) -> OnDevice {
        OnDevice { width: self.width, height: self.height, form: self.form, levels: self.levels }
    }
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;

    fn words(bytes: &[u8]) -> Vec<u16> {
        bytes.as_chunks().0.iter().map(|word| u16::from_le_bytes(*word)).collect()
    }

    #[test]
    fn the_device_decides_the_form() {
        let image = |levels, form| Image::new(String::new(), 8, 8, Texels::Stored { form, levels, bytes: Vec::new() });
        let settled = |mut image: Image, forms: &TexelForms| {
            image.settle(forms);
            (image.form, image.levels, image.bytes())
        };
        let (few, all) = (TexelForms::default(), TexelForms::of(|_| true));
        // 64 + 16 + 4 + 1 texels, or 4 + 1 + 1 + 1 blocks.
        assert_eq!(settled(image(4, TexelForm::Bc7), &all), (TexelForm::Bc7, 4, 7 * 16));
        assert_eq!(settled(image(2, TexelForm::Bc7), &all), (TexelForm::Bc7, 2, 5 * 16));
        assert_eq!(settled(image(4, TexelForm::Bc7), &few), (TexelForm::Rgba8, 4, 85 * 4));
        assert_eq!(settled(image(1, TexelForm::Bc1Rgb), &all), (TexelForm::Rgba8, 4, 85 * 4));
        assert_eq!(settled(image(1, TexelForm::Rgb8), &all), (TexelForm::Rgba8, 4, 85 * 4));
        assert_eq!(settled(image(1, TexelForm::Rgba16), &all), (TexelForm::Rgba16, 4, 85 * 8));
        assert_eq!(settled(image(1, TexelForm::Rgba16), &few), (TexelForm::Rgba8, 4, 85 * 4));
        assert_eq!(settled(image(4, TexelForm::Bc6hSigned), &few), (TexelForm::Half, 4, 85 * 8));
        assert_eq!(settled(image(4, TexelForm::Astc(5, 4)), &all), (TexelForm::Astc(5, 4), 4, (4 + 1 + 1 + 1) * 16));
    }

    fn written(mut image: Image, forms: &TexelForms, srgb: bool) -> Vec<u8> {
        image.settle(forms);
        let mut out = vec![0xee; image.bytes() as usize];
        image.write(srgb, &mut out);
        out
    }

    fn stored(form: TexelForm, levels: u32, size: (u32, u32), bytes: &[u8]) -> Image {
        Image::new(String::new(), size.0, size.1, Texels::Stored { form, levels, bytes: bytes.to_vec() })
    }

    #[test]
    fn sixteen_bits_stay_or_are_rounded() {
        let codes = [0_u16, 1, 32768, 65535, 257, 300, 12345, 65534];
        let bytes: Vec<u8> = codes.iter().flat_map(|code| code.to_le_bytes()).collect();
        let image = || stored(TexelForm::Rgba16, 1, (2, 1), &bytes);
        let (few, all) = (TexelForms::default(), TexelForms::of(|_| true));
        let wide = written(image(), &all, false);
        assert_eq!(wide[..16], bytes);
        assert_eq!(words(&wide[16..]), [129, 151, 22557, 65535]);
        assert_eq!(written(image(), &few, false)[..8], [0, 0, 128, 255, 1, 1, 48, 255]);
        // sRGB 32768 is 21.4 % of the light (IEC 61966-2-1); alpha stays.
        let light = words(&written(image(), &all, true));
        assert_eq!((light[2], light[3]), (14028, 65535));
    }

    #[test]
    fn halves_are_averaged_as_numbers() {
        let halves: Vec<u8> = [4.0, 0.0, 1.0, 1.0, 2.0, 1.0, 1.0, 0.0]
            .iter()
            .flat_map(|value| f16::from_f32(*value).to_le_bytes())
            .collect();
        let out = written(stored(TexelForm::Half, 1, (2, 1), &halves), &TexelForms::default(), false);
        let mean: Vec<f32> = words(&out[16..]).into_iter().map(|half| f16::from_bits(half).to_f32()).collect();
        assert_eq!(mean, [3.0, 0.5, 1.0, 0.5]);
    }

    #[test]
    fn own_levels_are_kept_in_blocks_and_when_decoded() {
        // 8x4, 4x2 and 2x1: a red and a blue block, a green one, and a white one. BC1: two equal 565 colors.
        let block = |color: u16| [color.to_le_bytes(), color.to_le_bytes(), [0; 2], [0; 2]].concat();
        let bytes = [block(0xf800), block(0x001f), block(0x07e0), block(0xffff)].concat();
        let image = || stored(TexelForm::Bc1Rgba, 3, (8, 4), &bytes);
        assert_eq!(written(image(), &TexelForms::of(|_| true), true), bytes);
        let decoded = written(image(), &TexelForms::default(), true);
        assert_eq!(decoded.len(), 4 * (32 + 8 + 2));
        assert_eq!((&decoded[..4], &decoded[28..32]), (&[255, 0, 0, 255][..], &[0, 0, 255, 255][..]));
        assert_eq!(decoded[128..160], [0, 255, 0, 255].repeat(8));
        assert_eq!(decoded[160..], [255; 8]);
    }

    #[test]
    fn etc2_of_one_color() {
        // Individual mode, the same 4-bit color in both halves, modifiers of table 0 with index 0: 2 above the color.
        let block = [0x11, 0x88, 0xff, 0, 0, 0, 0, 0];
        let rgb = crate::scene::images::decode::blocks(TexelForm::Etc2Rgb, &block, (4, 4));
        assert_eq!(rgb, [0x13, 0x8a, 0xff, 255].repeat(16));
        // EAC alpha of 77, whose multiplier is 0.
        let rgba = crate::scene::images::decode::blocks(
            TexelForm::Etc2Rgba8,
            &[[77, 0, 0, 0, 0, 0, 0, 0], block].concat(),
            (3, 2),
        );
        assert_eq!(rgba, [0x13, 0x8a, 0xff, 77].repeat(6));
    }

    #[test]
    fn bc6h_of_one_color() {
        // Mode 11 (code 3): endpoints of 10 bits, and no deltas. Both are 0 but for red, which is the largest half.
        let block = (0x03_u128 | 0x3ff << 5 | 0x3ff << 35).to_le_bytes();
        let halves = words(&crate::scene::images::decode::blocks(TexelForm::Bc6hUnsigned, &block, (4, 4)));
        let first: Vec<f32> = halves[..4].iter().map(|half| f16::from_bits(*half).to_f32()).collect();
        assert_eq!(first, [65504.0, 0.0, 0.0, 1.0]);
        assert!(halves.chunks_exact(4).all(|texel| texel == &halves[..4]));
    }

    /// The files of `tests/textures` are written by Binomial's encoder, and all their levels transcoded by Binomial's transcoder.
    #[test]
    fn transcoded_texels_are_those_of_the_transcoder_of_basis_universal() {
        macro_rules! all {
            ($name:literal) => {
                [
                    &include_bytes!(concat!("../../../tests/textures/", $name, ".ktx2"))[..],
                    include_bytes!(concat!("../../../tests/textures/", $name, ".rgba8")),
                    include_bytes!(concat!("../../../tests/textures/", $name, ".bc7")),
                    include_bytes!(concat!("../../../tests/textures/", $name, ".astc")),
                    include_bytes!(concat!("../../../tests/textures/", $name, ".etc2")),
                ]
            };
        }
        let forms = [TexelForm::Rgba8, TexelForm::Bc7, TexelForm::Astc(4, 4), TexelForm::Etc2Rgba8];
        // The largest and the mean difference of a channel that BC7 and ETC2 add, of 255.
        let limits = [("uastc", all!("uastc"), [(5, 0.8), (60, 8.0)]), ("etc1s", all!("etc1s"), [(64, 9.0), (4, 0.5)])];
        for (name, [file, expected @ ..], most) in limits {
            let on = |form: TexelForm| {
                let basis = Texels::Basis(crate::scene::Basis::read(file, 6).unwrap());
                let mut image = Image::new(String::new(), 32, 32, basis);
                image.settle(&TexelForms::of(|had| had == form));
                let mut out = vec![0; image.bytes() as usize];
                image.write(true, &mut out);
                (image.form, out)
            };
            for (form, expected) in forms.into_iter().zip(expected) {
                let (settled, found) = on(form);
                assert_eq!(settled, form, "{name}");
                assert!(found == expected, "{name} as {form} is not what the transcoder of Basis Universal gives");
            }
            let plain = &expected[0][..32 * 32 * 4];
            for (form, blocks, most) in [(forms[1], expected[1], most[0]), (forms[3], expected[3], most[1])] {
                let decoded = crate::scene::images::decode::blocks(form, &blocks[..64 * 16], (32, 32));
                let errors: Vec<u8> = plain.iter().zip(&decoded).map(|(a, b)| a.abs_diff(*b)).collect();
                let largest = errors.iter().copied().max().unwrap();
                let mean = errors.iter().map(|error| f64::from(*error)).sum::<f64>() / errors.len() as f64;
                let is_close = largest <= most.0 && mean <= most.1;
                assert!(is_close, "{name} as {form} differs by up to {largest} of 255, {mean} in the mean");
            }
        }
    }
}
