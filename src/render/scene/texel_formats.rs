//! The Vulkan formats of textures. Which of them a model's images take on a device is decided here alone.

use crate::astc;
use crate::gpu::{Gpu, GpuError, fault, texture_formats, vk};
use crate::scene::{TexelForm, TexelForms};

/// The format of texels. `srgb`: whether colors are sRGB-encoded. Forms of more than 8 bits a channel are always linear.
pub(super) fn format_of(form: TexelForm, srgb: bool) -> vk::Format {
    use vk::Format as F;
    let (linear, encoded) = match form {
        TexelForm::Rgb8 | TexelForm::Rgba8 => (F::R8G8B8A8_UNORM, F::R8G8B8A8_SRGB),
        TexelForm::Rgba16 => (F::R16G16B16A16_UNORM, F::R16G16B16A16_UNORM),
        TexelForm::Half => (F::R16G16B16A16_SFLOAT, F::R16G16B16A16_SFLOAT),
        TexelForm::Bc1Rgb => (F::BC1_RGB_UNORM_BLOCK, F::BC1_RGB_SRGB_BLOCK),
        TexelForm::Bc1Rgba => (F::BC1_RGBA_UNORM_BLOCK, F::BC1_RGBA_SRGB_BLOCK),
        TexelForm::Bc2 => (F::BC2_UNORM_BLOCK, F::BC2_SRGB_BLOCK),
        TexelForm::Bc3 => (F::BC3_UNORM_BLOCK, F::BC3_SRGB_BLOCK),
        TexelForm::Bc6hUnsigned => (F::BC6H_UFLOAT_BLOCK, F::BC6H_UFLOAT_BLOCK),
        TexelForm::Bc6hSigned => (F::BC6H_SFLOAT_BLOCK, F::BC6H_SFLOAT_BLOCK),
        TexelForm::Bc7 => (F::BC7_UNORM_BLOCK, F::BC7_SRGB_BLOCK),
        TexelForm::Etc2Rgb => (F::ETC2_R8G8B8_UNORM_BLOCK, F::ETC2_R8G8B8_SRGB_BLOCK),
        TexelForm::Etc2Rgba1 => (F::ETC2_R8G8B8A1_UNORM_BLOCK, F::ETC2_R8G8B8A1_SRGB_BLOCK),
        TexelForm::Etc2Rgba8 => (F::ETC2_R8G8B8A8_UNORM_BLOCK, F::ETC2_R8G8B8A8_SRGB_BLOCK),
        TexelForm::Astc(width, height) => {
            // Each size is there as UNORM and as SRGB.
            let size = astc::BLOCKS.iter().position(|block| *block == (width, height)).unwrap_or(0);
            let first = F::ASTC_4X4_UNORM_BLOCK.as_raw() + 2 * size as i32;
            (F::from_raw(first), F::from_raw(first + 1))
        }
    };
    if srgb { encoded } else { linear }
}

/// The forms that the device has for all uses.
pub(super) fn forms_of(gpu: &Gpu) -> TexelForms {
    forms(|form| [false, true].into_iter().all(|srgb| gpu.has_texture_format(format_of(form, srgb))))
}

/// The forms that `has` names. The fault `plain-textures:1` leaves those that every device has.
fn forms(has: impl Fn(TexelForm) -> bool) -> TexelForms {
    let is_plain = fault::value("plain-textures").is_some();
    TexelForms::of(|form| !is_plain && has(form))
}

/// The forms that the device with `part` in its name, or the fastest kind of device, has for textures, without opening it.
///
/// # Errors
/// There is no such device.
pub fn texel_forms(part: Option<&str>) -> Result<TexelForms, GpuError> {
    let all: Vec<TexelForm> = TexelForm::all().collect();
    let formats: Vec<vk::Format> =
        all.iter().flat_map(|form| [format_of(*form, false), format_of(*form, true)]).collect();
    let has = texture_formats(part, &formats)?;
    let number = |form: TexelForm| all.iter().position(|other| *other == form).unwrap_or(0);
    Ok(forms(|form| has[2 * number(form)] && has[2 * number(form) + 1]))
}
