//! Frames in flight: command buffers, their fences, and what they keep alive.

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use super::device::Gpu;
use super::encoder::Encoder;
use super::error::{Context, GpuError};

/// Nanoseconds to wait for a frame before the device is called lost: a frame that takes longer hangs every desktop.
const FENCE_TIMEOUT_NS: u64 = 60_000_000_000;

/// One command buffer with its fence, and the timestamps around its commands.
struct Slot {
    gpu: Arc<Gpu>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
    queries: vk::QueryPool,
    timed: bool,
    kept: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Slot {
    fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        let mut slot = Self {
            gpu: gpu.clone(),
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            queries: vk::QueryPool::null(),
            timed: false,
            kept: Vec::new(),
        };
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.queue_family);
        // SAFETY: the device is live; a partly made slot frees in `Drop` what it has.
        slot.pool = unsafe { gpu.device.create_command_pool(&info, None) }.context("creating a command pool")?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(slot.pool).command_buffer_count(1);
        // SAFETY: the pool is live and only this slot uses it.
        slot.buffer = unsafe { gpu.device.allocate_command_buffers(&info) }.context("allocating a command buffer")?[0];
        let info = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        // SAFETY: the device is live.
        slot.fence = unsafe { gpu.device.create_fence(&info, None) }.context("creating a fence")?;
        if gpu.timestamp_period().is_some() {
            let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
            // SAFETY: the device is live.
            slot.queries = unsafe { gpu.device.create_query_pool(&info, None) }.context("creating a query pool")?;
        }
        Ok(slot)
    }

    /// SYNC: waits until the device has run this slot's last commands, then lets go of what they used.
    fn wait(&mut self) -> Result<(), GpuError> {
        // SAFETY: the fence is live and was created signaled or submitted.
        unsafe { self.gpu.device.wait_for_fences(&[self.fence], true, FENCE_TIMEOUT_NS) }.map_err(|r| match r {
            vk::Result::TIMEOUT => GpuError::DeviceLost("waiting a minute for a frame"),
            other => match Err::<(), _>(other).context("waiting for a frame") {
                Err(e) => e,
                Ok(()) => GpuError::DeviceLost("waiting for a frame"),
            },
        })?;
        self.kept.clear();
        Ok(())
    }

    fn begin(&mut self) -> Result<Encoder, GpuError> {
        self.wait()?;
        let device = &self.gpu.device;
        // SAFETY: the fence has signaled, so nothing uses the pool; the buffer belongs to it.
        unsafe {
            device.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).context("resetting commands")?;
            let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            device.begin_command_buffer(self.buffer, &info).context("beginning commands")?;
            if self.queries != vk::QueryPool::null() {
                device.cmd_reset_query_pool(self.buffer, self.queries, 0, 2);
                device.cmd_write_timestamp2(self.buffer, vk::PipelineStageFlags2::ALL_COMMANDS, self.queries, 0);
            }
        }
        Ok(Encoder::new(&self.gpu, self.buffer))
    }

    fn submit(&mut self, encoder: Encoder, sync: Submission) -> Result<(), GpuError> {
        let device = &self.gpu.device;
        self.kept = encoder.kept;
        // SAFETY: the buffer is recording.
        unsafe {
            if self.queries != vk::QueryPool::null() {
                device.cmd_write_timestamp2(self.buffer, vk::PipelineStageFlags2::ALL_COMMANDS, self.queries, 1);
                self.timed = true;
            }
            device.end_command_buffer(self.buffer).context("ending commands")?;
        }
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.buffer)];
        let stage = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT;
        // SYNC: the swapchain image is first written as a color target, so only that stage waits for it.
        let wait = sync.wait.map(|s| vk::SemaphoreSubmitInfo::default().semaphore(s).stage_mask(stage));
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let signal = sync.signal.map(|s| vk::SemaphoreSubmitInfo::default().semaphore(s).stage_mask(all));
        let info = vk::SubmitInfo2::default()
            .command_buffer_infos(&buffers)
            .wait_semaphore_infos(wait.as_slice())
            .signal_semaphore_infos(signal.as_slice());
        let queue = self.gpu.lock_queue();
        // SAFETY: the fence has signaled; the queue is locked; everything the commands use is in `kept`.
        unsafe {
            device.reset_fences(&[self.fence]).context("resetting a fence")?;
            device.queue_submit2(*queue, &[info], self.fence).context("submitting a frame")
        }
    }

    /// Milliseconds the device spent on the last finished submission. Only after [`Slot::wait`].
    fn device_ms(&self) -> Option<f64> {
        let period = self.gpu.timestamp_period().filter(|_| self.timed)?;
        let mut ticks = [0u64; 2];
        // SAFETY: both queries were written by a submission whose fence has signaled.
        let read = unsafe {
            self.gpu.device.get_query_pool_results(self.queries, 0, &mut ticks, vk::QueryResultFlags::TYPE_64)
        };
        read.ok().map(|()| ticks[1].saturating_sub(ticks[0]) as f64 * f64::from(period) * 1e-6)
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        let _ = self.wait();
        // SAFETY: the commands have run (or the device is lost); null handles may be destroyed.
        unsafe {
            self.gpu.device.destroy_query_pool(self.queries, None);
            self.gpu.device.destroy_fence(self.fence, None);
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}

/// Semaphores of a submission that goes to a window.
#[derive(Clone, Copy, Default)]
pub struct Submission {
    pub(super) wait: Option<vk::Semaphore>,
    pub(super) signal: Option<vk::Semaphore>,
}

/// A ring of frame slots.
pub struct Frames {
    slots: Vec<Slot>,
    current: usize,
    last_device_ms: Option<f64>,
}

impl Frames {
    /// Makes `count` slots.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, count: usize) -> Result<Self, GpuError> {
        let slots = (0..count.max(1)).map(|_| Slot::new(gpu)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { slots, current: 0, last_device_ms: None })
    }

    /// Number of the slot that [`Frames::begin`] used last.
    pub fn current(&self) -> usize {
        self.current
    }

    /// Device time of the newest frame that is known to be finished, in milliseconds.
    pub fn last_device_ms(&self) -> Option<f64> {
        self.last_device_ms
    }

    /// SYNC: waits for the oldest slot and begins recording into it.
    ///
    /// # Errors
    /// The device is lost.
    pub fn begin(&mut self) -> Result<Encoder, GpuError> {
        self.current = (self.current + 1) % self.slots.len();
        let slot = &mut self.slots[self.current];
        slot.wait()?;
        self.last_device_ms = slot.device_ms().or(self.last_device_ms);
        slot.begin()
    }

    /// Submits what `encoder` recorded since the last [`Frames::begin`].
    ///
    /// # Errors
    /// The device is lost.
    pub fn submit(&mut self, encoder: Encoder, sync: Submission) -> Result<(), GpuError> {
        self.slots[self.current].submit(encoder, sync)
    }

    /// SYNC: waits until the last submitted frame is done, to read back what it wrote.
    ///
    /// # Errors
    /// The device is lost.
    pub fn wait(&mut self) -> Result<(), GpuError> {
        let slot = &mut self.slots[self.current];
        slot.wait()?;
        self.last_device_ms = slot.device_ms().or(self.last_device_ms);
        Ok(())
    }

    /// SYNC: waits until every slot is done, before what they all share is replaced.
    ///
    /// # Errors
    /// The device is lost.
    pub fn wait_all(&mut self) -> Result<(), GpuError> {
        self.slots.iter_mut().try_for_each(Slot::wait)
    }
}

/// Records and submits `commands` once, and waits for them. For uploads, on any thread.
///
/// # Errors
/// What `commands` returns, or a lost device.
pub fn one_shot<T>(gpu: &Arc<Gpu>, commands: impl FnOnce(&mut Encoder) -> Result<T, GpuError>) -> Result<T, GpuError> {
    let mut slot = Slot::new(gpu)?;
    let mut encoder = slot.begin()?;
    let result = commands(&mut encoder)?;
    slot.submit(encoder, Submission::default())?;
    // SYNC: the caller may use what was written, from any queue submission that follows.
    slot.wait()?;
    Ok(result)
}
