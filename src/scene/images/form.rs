//! The forms in which texels are stored, in files and on devices.

use std::fmt;

use crate::astc;

/// How texels are stored. Whether colors are sRGB-encoded depends on the use of the image, not on its form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TexelForm {
    /// Three channels of 8 bits, in files alone.
    Rgb8,
    /// Four channels of 8 bits.
    Rgba8,
    /// Four channels of 16 bits, little endian. On the device they are always linear.
    Rgba16,
    /// Four half floats, little endian, linear.
    Half,
    /// BC1 without alpha.
    Bc1Rgb,
    /// BC1 with one bit of alpha.
    Bc1Rgba,
    /// BC2.
    Bc2,
    /// BC3.
    Bc3,
    /// BC6H of floats that are not negative.
    Bc6hUnsigned,
    /// BC6H of floats.
    Bc6hSigned,
    /// BC7.
    Bc7,
    /// ETC2 without alpha. ETC1 is a part of it.
    Etc2Rgb,
    /// ETC2 with one bit of alpha.
    Etc2Rgba1,
    /// ETC2 with EAC alpha.
    Etc2Rgba8,
    /// ASTC of 8 bits a channel, with blocks of this width and height.
    Astc(u8, u8),
}

impl TexelForm {
    /// All forms that a device may have.
    pub fn all() -> impl Iterator<Item = Self> {
        const OTHERS: [TexelForm; 13] = [
            TexelForm::Rgba8,
            TexelForm::Rgba16,
            TexelForm::Half,
            TexelForm::Bc1Rgb,
            TexelForm::Bc1Rgba,
            TexelForm::Bc2,
            TexelForm::Bc3,
            TexelForm::Bc6hUnsigned,
            TexelForm::Bc6hSigned,
            TexelForm::Bc7,
            TexelForm::Etc2Rgb,
            TexelForm::Etc2Rgba1,
            TexelForm::Etc2Rgba8,
        ];
        OTHERS.into_iter().chain(astc::BLOCKS.map(|(width, height)| Self::Astc(width, height)))
    }

    /// Width and height of a block in texels, and its bytes. Without compression, a block is a texel.
    pub fn block(self) -> (u32, u32, u64) {
        match self {
            Self::Rgb8 => (1, 1, 3),
            Self::Rgba8 => (1, 1, 4),
            Self::Rgba16 | Self::Half => (1, 1, 8),
            Self::Bc1Rgb | Self::Bc1Rgba | Self::Etc2Rgb | Self::Etc2Rgba1 => (4, 4, 8),
            Self::Bc2 | Self::Bc3 | Self::Bc6hUnsigned | Self::Bc6hSigned | Self::Bc7 | Self::Etc2Rgba8 => (4, 4, 16),
            Self::Astc(width, height) => (width.into(), height.into(), 16),
        }
    }

    /// Whether texels share blocks, so that neither mip levels nor single channels can be computed without decoding.
    pub fn is_compressed(self) -> bool {
        self.block().0 > 1
    }

    /// Whether it holds values above 1.
    pub fn is_hdr(self) -> bool {
        matches!(self, Self::Half | Self::Bc6hUnsigned | Self::Bc6hSigned)
    }

    /// Bytes of a level of this size.
    pub fn bytes(self, width: u32, height: u32) -> u64 {
        let (block_width, block_height, bytes) = self.block();
        u64::from(width.div_ceil(block_width)) * u64::from(height.div_ceil(block_height)) * bytes
    }
}

impl fmt::Display for TexelForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rgb8 => "RGB8",
            Self::Rgba8 => "RGBA8",
            Self::Rgba16 => "RGBA16",
            Self::Half => "RGBA16F",
            Self::Bc1Rgb | Self::Bc1Rgba => "BC1",
            Self::Bc2 => "BC2",
            Self::Bc3 => "BC3",
            Self::Bc6hUnsigned | Self::Bc6hSigned => "BC6H",
            Self::Bc7 => "BC7",
            Self::Etc2Rgb | Self::Etc2Rgba1 | Self::Etc2Rgba8 => "ETC2",
            Self::Astc(width, height) => return write!(f, "ASTC {width}x{height}"),
        })
    }
}

/// The forms that a device samples and filters. Every device has RGBA8 and half floats, so the default is these two.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TexelForms(Vec<TexelForm>);

impl Default for TexelForms {
    fn default() -> Self {
        Self(vec![TexelForm::Rgba8, TexelForm::Half])
    }
}

impl TexelForms {
    /// The forms that `has` names, and the default ones.
    pub fn of(has: impl Fn(TexelForm) -> bool) -> Self {
        let every = Self::default();
        Self(TexelForm::all().filter(|form| every.has(*form) || has(*form)).collect())
    }

    /// Whether the device has a form.
    pub fn has(&self, form: TexelForm) -> bool {
        self.0.contains(&form)
    }
}
