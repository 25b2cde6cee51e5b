//! The table of linearly transformed cosines, made by scripts/make-ltc: see shaders/lighting/area.glsl.

use std::sync::Arc;

use crate::gpu::{Gpu, GpuError, Image, ImageDesc, vk};

use crate::render::compute;

const SIDE: u32 = 64;
const TABLE: &[u8] = include_bytes!("../../../assets/ltc.bin");
const _: () = assert!(TABLE.len() == (SIDE * SIDE * 8) as usize);

/// The table as an image of half floats.
pub(crate) fn table(gpu: &Arc<Gpu>) -> Result<Arc<Image>, GpuError> {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let image = Image::new(gpu, "ltc", ImageDesc::new(SIDE, SIDE, vk::Format::R16G16B16A16_SFLOAT, usage))?;
    compute::upload(gpu, &[(&image, TABLE)])?;
    Ok(image)
}
