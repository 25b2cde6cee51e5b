//! Submissions between frames, of thumbnails and values of pixels. Each waits until the device has run the one before. So no
//! frame waits for more than one of them, and the window's thread for none.
//!
//! A window shows a frame when the device has drawn it, so anything in the frame delays it, and the thread that waits
//! for it. One submission follows a frame, the next one when the device has run it, and none between a save and its
//! first frame. So the frame of an edit waits for one of them at most, which a software device runs while the edit is
//! compiled. Such a device also continues for 200 ms without a frame, because showing a thumbnail takes it longer than
//! drawing one.

use std::sync::Arc;

use crate::gpu::{Encoder, Frames, Gpu, GpuError};

/// The submissions between frames, of which the device has one at a time.
pub(super) struct Background {
    gpu: Arc<Gpu>,
    pub(super) frames: Frames,
    /// The commands of the next one, if there are any.
    pub(super) encoder: Option<Encoder>,
    /// Whether the results of the last submission have not been collected.
    pub(super) is_unread: bool,
    /// Whether collected results have not been shown in a frame.
    pub(super) is_unseen: bool,
}

impl Background {
    pub(super) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        Ok(Self { gpu: gpu.clone(), frames: Frames::new(gpu, 1)?, encoder: None, is_unread: false, is_unseen: false })
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// Whether the device is faster than the display.
    pub(super) fn is_fast(&self) -> bool {
        self.gpu.info().kind != "cpu"
    }

    /// Whether the device has run the last submission. Its results can be read then.
    pub(super) fn is_finished(&self) -> bool {
        self.frames.is_finished(0)
    }

    /// SYNC: waits for the last submission, before the caller drops what it uses.
    ///
    /// # Errors
    /// The device is lost.
    pub(super) fn wait(&mut self) -> Result<(), GpuError> {
        self.frames.wait_all()
    }

    /// The commands of the next submission. The last one is finished.
    ///
    /// # Errors
    /// The device is lost or out of memory.
    pub(super) fn encoder(&mut self) -> Result<&mut Encoder, GpuError> {
        match &mut self.encoder {
            Some(encoder) => Ok(encoder),
            none => Ok(none.insert(self.frames.begin()?)),
        }
    }

    /// Submits the commands, if there are any.
    pub(super) fn submit(&mut self) -> Result<(), GpuError> {
        let Some(encoder) = self.encoder.take() else { return Ok(()) };
        self.frames.submit(encoder, Default::default())?;
        self.is_unread = true;
        Ok(())
    }
}
