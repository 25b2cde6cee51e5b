//! Which bytes of the block [`Frame`] change from frame to frame.

use std::mem::offset_of;
use std::ops::Range;

use super::blocks::Frame;

/// The bytes of [`Frame`] that change while the time runs.
pub const CLOCK: [Range<usize>; 7] = [
    offset_of!(Frame, time_s)..offset_of!(Frame, time_s) + size_of::<f32>(),
    offset_of!(Frame, delta_s)..offset_of!(Frame, delta_s) + size_of::<f32>(),
    offset_of!(Frame, frame_index)..offset_of!(Frame, frame_index) + size_of::<u32>(),
    offset_of!(Frame, mouse_px)..offset_of!(Frame, mouse_px) + size_of::<[f32; 4]>(),
    offset_of!(Frame, cursor_px)..offset_of!(Frame, cursor_px) + size_of::<[f32; 2]>(),
    offset_of!(Frame, mouse_buttons)..offset_of!(Frame, mouse_buttons) + size_of::<u32>(),
    offset_of!(Frame, date)..offset_of!(Frame, date) + size_of::<[f32; 4]>(),
];

/// The bytes of [`Frame`] that change when a key is pressed or released.
pub const KEYS: Range<usize> = offset_of!(Frame, keys)..offset_of!(Frame, keys) + size_of::<[u32; 24]>();

/// The bytes of [`Frame`] that tell how the camera has moved.
pub const MOTION: Range<usize> =
    offset_of!(Frame, clip_from_world_before)..offset_of!(Frame, clip_from_world_before) + size_of::<[[f32; 4]; 4]>();
