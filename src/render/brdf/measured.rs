//! Uploads a measured BRDF, which shaders/brdf/measured.glsl reads.

use std::sync::Arc;

use crate::gpu::{Buffer, Gpu, GpuError, Memory, one_shot, vk};
use crate::interface::{MEASURED_MERL, MEASURED_NONE, MEASURED_UTIA};
use crate::scene::{MeasuredBrdf, MeasuredKind};

/// The buffer of a measured BRDF: its kind, then its values. Without a BRDF, the kind is `MEASURED_NONE`.
///
/// # Errors
/// Out of memory.
pub fn measured_buffer(gpu: &Arc<Gpu>, measured: Option<&MeasuredBrdf>) -> Result<Arc<Buffer>, GpuError> {
    let kind: u32 = match measured.map(|m| m.kind) {
        None => MEASURED_NONE,
        Some(MeasuredKind::Merl) => MEASURED_MERL,
        Some(MeasuredKind::Utia) => MEASURED_UTIA,
    };
    // The block must not be empty.
    let values = measured.map_or(&[0.0][..], |m| &m.values);
    let bytes: &[u8] = bytemuck::cast_slice(values);
    let size = 4 + bytes.len() as u64;
    let staging = Buffer::new(gpu, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload)?;
    staging.write(0, bytemuck::bytes_of(&kind));
    staging.write(4, bytes);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
    let buffer = Buffer::new(gpu, "measured BRDF", size, usage, Memory::Device)?;
    one_shot(gpu, |encoder| {
        encoder.copy_buffer(&staging, 0, &buffer, 0, size);
        encoder.copies_done();
        Ok(())
    })?;
    Ok(buffer)
}
