//! Brings the texels of a file into the form on the device.

use std::borrow::Cow;
use std::sync::LazyLock;

use half::f16;
use rayon::prelude::*;

use super::decode;
use super::form::TexelForm;
use super::texels::Texels;
use crate::scene::mips;
use crate::settings::linear_from_srgb;

/// Bytes that one task copies. The first write to a page of staging memory costs as much as the copy itself.
const BYTES_A_TASK: usize = 1 << 20;
/// Texels that one task converts.
const TEXELS_A_TASK: usize = 1 << 14;

/// An image on a device.
#[derive(Clone, Copy)]
pub struct OnDevice {
    pub width: u32,
    pub height: u32,
    pub form: TexelForm,
    pub levels: u32,
}

impl OnDevice {
    /// Writes all levels. Those that the file does not have are computed.
    pub fn write(self, texels: &Texels, srgb: bool, out: &mut [u8]) {
        let mut rest = out;
        for number in 0..self.levels {
            let (width, height) = mips::size(self.width, self.height, number);
            let bytes = self.form.bytes(width, height) as usize;
            let (target, later) = std::mem::take(&mut rest).split_at_mut(bytes);
            let level = self.level(texels, number, srgb);
            copy(&level, target);
            if number == 0 && texels.levels() == 1 && self.levels > 1 {
                copy(&self.below(&level, srgb), later);
                return;
            }
            rest = later;
        }
    }

    /// The levels below the first, which is in the form on the device.
    fn below(self, texels: &[u8], srgb: bool) -> Vec<u8> {
        let (width, height) = (self.width, self.height);
        match self.form {
            TexelForm::Rgba16 => mips::below_words(&words(texels), width, height, |taps| {
                ((taps.iter().map(|tap| u32::from(*tap)).sum::<u32>() + 2) / 4) as u16
            }),
            TexelForm::Half => mips::below_words(&words(texels), width, height, |taps| {
                f16::from_f32(taps.iter().map(|tap| f16::from_bits(*tap).to_f32()).sum::<f32>() / 4.0).to_bits()
            }),
            _ => mips::below(texels, width, height, srgb),
        }
    }

    /// A level of the file in the form on the device. If it cannot be had, which the loader has excluded, it is black.
    pub fn level(self, texels: &Texels, number: u32, srgb: bool) -> Cow<'_, [u8]> {
        let size = mips::size(self.width, self.height, number);
        let (form, bytes) = match texels {
            Texels::Basis(basis) => {
                let level = basis.level(number, self.form).unwrap_or_else(|reason| {
                    tracing::warn!("a texture is black: {reason}");
                    vec![0; self.form.bytes(size.0, size.1) as usize]
                });
                return Cow::Owned(level);
            }
            Texels::Stored { form, bytes, .. } => (*form, bytes),
        };
        let bytes_of = |level| {
            let (width, height) = mips::size(self.width, self.height, level);
            form.bytes(width, height) as usize
        };
        let start: usize = (0..number).map(bytes_of).sum();
        let texels = &bytes[start..][..bytes_of(number)];
        match (form, self.form) {
            (TexelForm::Rgba16, TexelForm::Rgba16) if srgb => Cow::Owned(linear(texels)),
            (from, to) if from == to => Cow::Borrowed(texels),
            (TexelForm::Rgb8, _) => Cow::Owned(opaque(texels)),
            // As the image crate rounds.
            (TexelForm::Rgba16, _) => {
                let narrow = |word: u16| ((u32::from(word) + 128) / 257) as u8;
                Cow::Owned(words(texels).into_iter().map(narrow).collect())
            }
            _ => Cow::Owned(decode::blocks(form, texels, size)),
        }
    }
}

/// RGB with an alpha of 1.
fn opaque(rgb: &[u8]) -> Vec<u8> {
    let mut out = vec![255; rgb.len() / 3 * 4];
    let texels = out.par_chunks_exact_mut(4).zip(rgb.par_chunks_exact(3)).with_min_len(TEXELS_A_TASK);
    texels.for_each(|(to, from)| to[..3].copy_from_slice(from));
    out
}

/// Copies bytes to the beginning of `to`, on all cores.
fn copy(from: &[u8], to: &mut [u8]) {
    let length = from.len().min(to.len());
    let tasks = from[..length].par_chunks(BYTES_A_TASK).zip(to[..length].par_chunks_mut(BYTES_A_TASK));
    tasks.for_each(|(from, to)| to.copy_from_slice(from));
}

fn words(bytes: &[u8]) -> Vec<u16> {
    bytes.as_chunks().0.iter().map(|word| u16::from_le_bytes(*word)).collect()
}

/// Colors of 16 bits in linear light, since no device has an sRGB format of 16 bits. Alpha is linear.
fn linear(texels: &[u8]) -> Vec<u8> {
    static CURVE: LazyLock<Vec<u16>> = LazyLock::new(|| {
        let light = |code: u32| (linear_from_srgb(code as f32 / 65535.0) * 65535.0).round() as u16;
        (0..=65535).map(light).collect()
    });
    let mut out = texels.to_vec();
    out.par_chunks_exact_mut(8).with_min_len(TEXELS_A_TASK).for_each(|texel| {
        for channel in texel[..6].as_chunks_mut().0 {
            *channel = CURVE[usize::from(u16::from_le_bytes(*channel))].to_le_bytes();
        }
    });
    out
}
