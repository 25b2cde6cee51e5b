//! Recording and submitting commands, and what is known when they are finished.

pub(in crate::gpu) mod blit;
pub(in crate::gpu) mod compute;
pub(in crate::gpu) mod copy;
pub(in crate::gpu) mod counts;
pub(in crate::gpu) mod draws;
pub(in crate::gpu) mod encoder;
pub(in crate::gpu) mod frames;
pub(in crate::gpu) mod image_use;
pub(in crate::gpu) mod pass;
pub(in crate::gpu) mod pass_timer;
pub(in crate::gpu) mod slot;
pub(in crate::gpu) mod upload;
