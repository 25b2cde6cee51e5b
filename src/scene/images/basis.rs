//! Textures of Basis Universal, and ASTC: the file is kept, and transcoded for the device.

use basisu::{DecodeFlags, SourceFormat, TargetFormat, Transcoder};

use super::form::TexelForm;

/// A KTX2 file that the transcoder reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// The forms into which the file can be transcoded, the best first.
    pub(super) targets: Vec<TexelForm>,
    /// Whether its fallback is half floats.
    pub(super) is_hdr: bool,
    /// The number of its mip levels.
    pub(super) levels: u32,
    file: Vec<u8>,
}

impl Basis {
    /// Transcodes all levels once, since a damaged file must be found out while the model is read. `levels`: the number of levels to use.
    ///
    /// # Errors
    /// The reason, as a part of a sentence.
    pub fn read(file: &[u8], levels: u32) -> Result<Self, String> {
        let transcoder = Transcoder::new(file).map_err(damaged)?;
        let source = transcoder.source_format();
        let is_hdr = matches!(source, SourceFormat::UastcHdr4x4 | SourceFormat::AstcHdr6x6 | SourceFormat::UastcHdr6x6);
        // glTF does not have XUASTC, and a small file of it may take 2 GiB.
        if matches!(source, SourceFormat::XuastcLdr(_)) || !transcoder.supports(fallback(is_hdr)) {
            return Err(format!("KTX2 with {source:?} is not supported"));
        }
        let targets: &[TexelForm] = match source {
            // Another form would lose what these blocks have.
            SourceFormat::AstcLdr(block) => {
                let (width, height) = block.dims();
                &[TexelForm::Astc(width as u8, height as u8)]
            }
            _ if is_hdr => &[TexelForm::Bc6hUnsigned],
            _ => &[TexelForm::Bc7, TexelForm::Astc(4, 4), TexelForm::Etc2Rgba8],
        };
        let is_possible = |form: &TexelForm| target(*form, source).is_some_and(|target| transcoder.supports(target));
        let targets = targets.iter().copied().filter(is_possible).collect();
        // The cheapest target that looks at all of the file.
        let cheap = match source {
            SourceFormat::Etc1s => TargetFormat::Etc1Rgb,
            SourceFormat::UastcLdr => TargetFormat::Astc4x4Rgba,
            _ => fallback(is_hdr),
        };
        for level in 0..levels.max(1) {
            transcoder.transcode(level, cheap, DecodeFlags::NONE).map_err(damaged)?;
        }
        Ok(Self { targets, is_hdr, levels: levels.max(1), file: file.to_vec() })
    }

    /// A level in one of the targets, or in the fallback: RGBA8, or half floats for HDR.
    ///
    /// # Errors
    /// The reason, as a part of a sentence.
    pub(super) fn level(&self, level: u32, form: TexelForm) -> Result<Vec<u8>, String> {
        let transcoder = Transcoder::new(&self.file).map_err(damaged)?;
        let target = target(form, transcoder.source_format()).unwrap_or(fallback(self.is_hdr));
        transcoder.transcode(level, target, DecodeFlags::NONE).map_err(damaged)
    }
}

fn damaged(error: basisu::Error) -> String {
    format!("damaged KTX2: {error:?}")
}

fn fallback(is_hdr: bool) -> TargetFormat {
    if is_hdr { TargetFormat::RgbaHalf } else { TargetFormat::Rgba32 }
}

fn target(form: TexelForm, source: SourceFormat) -> Option<TargetFormat> {
    match (form, source) {
        (TexelForm::Astc(..), SourceFormat::AstcLdr(block)) => Some(block.passthrough_target()),
        (TexelForm::Astc(4, 4), _) => Some(TargetFormat::Astc4x4Rgba),
        (TexelForm::Bc7, _) => Some(TargetFormat::Bc7Rgba),
        (TexelForm::Etc2Rgba8, _) => Some(TargetFormat::Etc2Rgba),
        (TexelForm::Bc6hUnsigned, _) => Some(TargetFormat::Bc6h),
        _ => None,
    }
}
