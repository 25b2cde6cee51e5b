//! Placeholders for descriptors that a set leaves unwritten.

use std::sync::Arc;

use ash::vk;

use super::buffer::{Buffer, Memory};
use super::image::{Image, ImageDesc};
use super::sampler::{Sampler, SamplerDesc};
use crate::gpu::{Gpu, GpuError};

/// Bytes of [`Blank::loops`]: two words that name a loop, and one that is 0 once an iteration limit was exceeded.
pub(in crate::gpu) const LOOP_WORDS_BYTES: u64 = 12;

/// One placeholder of each kind of descriptor. lavapipe reads every descriptor of a bound set, used or not, and crashes on
/// one that was never written.
pub(in crate::gpu) struct Blank {
    pub(in crate::gpu) image: Arc<Image>,
    pub(in crate::gpu) array: Arc<Image>,
    pub(in crate::gpu) cube: Arc<Image>,
    pub(in crate::gpu) sampler: Arc<Sampler>,
    pub(in crate::gpu) buffer: Arc<Buffer>,
    /// The loop report buffer, which stages write when one of their loops does not end. Every submission leaves it cleared.
    pub(in crate::gpu) loops: Arc<Buffer>,
}

impl Blank {
    /// Creates the objects; [`super::set_layouts`] makes them ready for use.
    pub(in crate::gpu) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::STORAGE;
        let format = vk::Format::R16G16B16A16_SFLOAT;
        let image = Image::new(gpu, "blank", ImageDesc::new(1, 1, format, usage))?;
        let array = Image::new(gpu, "blank array", ImageDesc::new(1, 1, format, usage).array(1))?;
        let cube = Image::new(gpu, "blank cube", ImageDesc::cube(1, 1, format, usage))?;
        let words = Usage::STORAGE_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let loops = Buffer::new(gpu, "loops", LOOP_WORDS_BYTES, words, Memory::Device)?;
        let sampler = Sampler::new(gpu, &SamplerDesc::NEAREST)?;
        let buffer = Buffer::new(gpu, "blank", 16, Usage::UNIFORM_BUFFER | Usage::STORAGE_BUFFER, Memory::Device)?;
        Ok(Self { image, array, cube, sampler, buffer, loops })
    }
}
