//! Frames in flight: a ring of frame slots, and submissions outside of it.

use std::sync::Arc;

use super::counts::DrawCounts;
use super::encoder::Encoder;
use super::pass_timer::PassTime;
use super::slot::{FrameSlot, Submission, Times};
use crate::gpu::{Gpu, GpuError};

/// A ring of frame slots.
pub struct Frames {
    slots: Vec<FrameSlot>,
    /// Serial number of each slot's last submission; 0 is none.
    serials: Vec<u64>,
    current: usize,
    submitted: u64,
    /// Serial number of the frame that `times` belongs to.
    timed: u64,
    times: Option<Times>,
}

impl Frames {
    /// Creates a ring of `count` slots, at least one.
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn new(gpu: &Arc<Gpu>, count: usize) -> Result<Self, GpuError> {
        let slots = (0..count.max(1)).map(|slot| FrameSlot::new(gpu, &format!("frame slot {slot}"), true));
        let slots = slots.collect::<Result<Vec<_>, _>>()?;
        Ok(Self { serials: vec![0; slots.len()], slots, current: 0, submitted: 0, timed: 0, times: None })
    }

    /// Number of slots.
    pub fn slots(&self) -> usize {
        self.slots.len()
    }

    /// Index of the slot that the last [`Frames::begin`] used.
    pub fn current(&self) -> usize {
        self.current
    }

    /// Whether the device has finished the last frame submitted to `slot`, without waiting for it. The CPU may then read what
    /// that frame copied to a [`crate::gpu::Memory::Readback`] buffer, if [`Encoder::copies_done`] followed the copy. True for a slot
    /// that was never used, false on a lost device.
    pub fn is_finished(&self, slot: usize) -> bool {
        self.slots.get(slot).is_none_or(FrameSlot::is_finished)
    }

    /// Whether the last frame of `slot` has stages whose loops might not end.
    pub fn has_loops(&self, slot: usize) -> bool {
        self.slots.get(slot).is_some_and(FrameSlot::has_loops)
    }

    /// The words that name a loop that did not end in the last frame of `slot`; `None` if all ended. SYNC: after that frame's
    /// fence.
    pub fn endless_loop(&self, slot: usize) -> Option<[u32; 2]> {
        self.slots.get(slot).and_then(FrameSlot::endless_loop)
    }

    /// Device time, in milliseconds, of the newest frame known to have finished. `None` before the first, or without timestamps.
    pub fn last_device_ms(&self) -> Option<f64> {
        self.times.as_ref().map(|times| times.ms)
    }

    /// Device times of the passes of the frame of [`Frames::last_device_ms`], in the order in which they began. The time of a
    /// nested pass is part of the time of the pass around it.
    pub fn pass_times(&self) -> &[PassTime] {
        self.times.as_ref().map_or(&[], |times| &times.passes)
    }

    /// Draw counts of the frame of [`Frames::last_device_ms`], without the user interface.
    pub fn draw_counts(&self) -> DrawCounts {
        self.times.as_ref().map(|times| times.counts).unwrap_or_default()
    }

    /// Serial number of the frame of [`Frames::last_device_ms`]; 0 before the first.
    pub fn timed(&self) -> u64 {
        self.timed
    }

    /// Serial number of the last submitted frame: the frames count from 1.
    pub fn submitted(&self) -> u64 {
        self.submitted
    }

    /// SYNC: waits for the frame that last used the oldest slot, then begins recording into that slot.
    ///
    /// # Errors
    /// The device is lost or out of memory.
    pub fn begin(&mut self) -> Result<Encoder, GpuError> {
        self.current = (self.current + 1) % self.slots.len();
        self.wait_for(self.current)?;
        self.slots[self.current].begin()
    }

    /// Submits the commands that `encoder` recorded since the last [`Frames::begin`].
    ///
    /// # Errors
    /// The device is lost or out of memory. The next [`Frames::begin`] is valid in either case.
    pub fn submit(&mut self, encoder: Encoder, sync: Submission) -> Result<(), GpuError> {
        self.slots[self.current].submit(encoder, sync)?;
        self.submitted += 1;
        self.serials[self.current] = self.submitted;
        Ok(())
    }

    /// SYNC: waits until the device has finished the last submitted frame, whose results the caller reads next.
    ///
    /// # Errors
    /// The device is lost.
    pub fn wait(&mut self) -> Result<(), GpuError> {
        self.wait_for(self.current)
    }

    /// SYNC: waits until the device has finished every frame, before the caller replaces what they share.
    ///
    /// # Errors
    /// The device is lost.
    pub fn wait_all(&mut self) -> Result<(), GpuError> {
        (0..self.slots.len()).try_for_each(|slot| self.wait_for(slot))
    }

    /// SYNC: waits for a slot, then takes its times if no newer frame's are there.
    fn wait_for(&mut self, slot: usize) -> Result<(), GpuError> {
        self.slots[slot].wait()?;
        if self.serials[slot] > self.timed {
            self.timed = self.serials[slot];
            self.times = self.slots[slot].times().or(self.times.take());
        }
        Ok(())
    }
}

/// Records and submits `commands` once, on any thread, and waits until the device has run them. Passes have labels but no
/// times.
///
/// # Errors
/// `commands` fails, a loop of a stage does not end, or the device is lost or out of memory.
pub fn one_shot<T>(gpu: &Arc<Gpu>, commands: impl FnOnce(&mut Encoder) -> Result<T, GpuError>) -> Result<T, GpuError> {
    let mut slot = FrameSlot::new(gpu, "one-shot commands", false)?;
    let mut encoder = slot.begin()?;
    let result = commands(&mut encoder)?;
    slot.submit(encoder, Submission::default())?;
    // SYNC: callers read results on the CPU and drop resources next, and the slot frees its command buffer.
    slot.wait()?;
    slot.endless_loop().map_or(Ok(result), |words| Err(GpuError::EndlessLoop(words)))
}
