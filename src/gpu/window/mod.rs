//! Drawing to a window: surface, swapchain and user interface.

pub(in crate::gpu) mod surface;
pub(in crate::gpu) mod swapchain;
pub(in crate::gpu) mod ui;
