//! A frame slot: one command buffer with its fence and timestamps, and the resources that its commands use.

use std::any::Any;
use std::sync::Arc;
use std::time::Duration;

use ash::vk;

use super::counts::DrawCounts;
use super::encoder::Encoder;
use super::pass_timer::{MAX_TIMESTAMPS, PassTime, PassTimer, TimedPass};
use crate::gpu::error::Context;
use crate::gpu::watchdog::{self, Watched};
use crate::gpu::{Buffer, Gpu, GpuError, Memory, fault};

/// How long a wait may take before the device counts as lost. A frame this long would freeze the desktop.
const FENCE_TIMEOUT: Duration = Duration::from_secs(60);

/// Semaphores of a submission that goes to a window.
#[derive(Clone, Copy, Default)]
pub struct Submission {
    pub(in crate::gpu) wait: Option<vk::Semaphore>,
    pub(in crate::gpu) signal: Option<vk::Semaphore>,
}

/// Device times of one submission.
#[derive(Default)]
pub(in crate::gpu) struct Times {
    /// Milliseconds of all its commands.
    pub(in crate::gpu) ms: f64,
    /// Times of its passes, in the order in which they began.
    pub(in crate::gpu) passes: Vec<PassTime>,
    /// Draw counts of the commands.
    pub(in crate::gpu) counts: DrawCounts,
}

/// One command buffer with its fence and timestamps.
pub(in crate::gpu) struct FrameSlot {
    gpu: Arc<Gpu>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
    queries: vk::QueryPool,
    /// Whether the fence belongs to a submission that nobody has waited for.
    pending: bool,
    /// How long a wait may take.
    timeout: Duration,
    /// The timed passes of the last submission; `None` before the first.
    passes: Option<Vec<TimedPass>>,
    counts: DrawCounts,
    kept: Vec<Arc<dyn Any + Send + Sync>>,
    /// The loop report of the last submission, and whether its stages have loops that may not end.
    loops: (Option<Arc<Buffer>>, bool),
}

impl FrameSlot {
    /// Creates a slot whose objects are called `name`. `timed` asks for timestamps, if the queue has them.
    pub(in crate::gpu) fn new(gpu: &Arc<Gpu>, name: &str, timed: bool) -> Result<Self, GpuError> {
        // A later step that fails leaves null handles, which `Drop` ignores.
        let mut slot = Self {
            gpu: gpu.clone(),
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            queries: vk::QueryPool::null(),
            pending: false,
            // A watchdog ends the process at its limit, before a wait ends.
            timeout: FENCE_TIMEOUT.max(watchdog::limit().unwrap_or_default().saturating_mul(2)),
            passes: None,
            counts: DrawCounts::default(),
            kept: Vec::new(),
            loops: (None, false),
        };
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.queue_family);
        // SAFETY: the device is live.
        slot.pool = unsafe { gpu.device.create_command_pool(&info, None) }.context("creating a command pool")?;
        gpu.name(slot.pool, name);
        let info = vk::CommandBufferAllocateInfo::default().command_pool(slot.pool).command_buffer_count(1);
        // SAFETY: the pool is live and only this slot uses it.
        slot.buffer = unsafe { gpu.device.allocate_command_buffers(&info) }.context("allocating a command buffer")?[0];
        gpu.name(slot.buffer, name);
        // SAFETY: the device is live.
        slot.fence =
            unsafe { gpu.device.create_fence(&vk::FenceCreateInfo::default(), None) }.context("creating a fence")?;
        gpu.name(slot.fence, name);
        if timed && gpu.timestamp_period().is_some() {
            let info =
                vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(MAX_TIMESTAMPS);
            // SAFETY: the device is live.
            slot.queries = unsafe { gpu.device.create_query_pool(&info, None) }.context("creating a query pool")?;
            gpu.name(slot.queries, name);
        }
        Ok(slot)
    }

    /// SYNC: waits until the device has run this slot's last submission, then releases the resources that it used.
    pub(in crate::gpu) fn wait(&mut self) -> Result<(), GpuError> {
        if self.pending {
            // Arm the watchdog only while blocking. Nobody waits for the last frame of an idle window.
            let _watched = watch(self.passes.as_deref());
            fault::delay("frame-hang-ms");
            let timeout_ns = u64::try_from(self.timeout.as_nanos()).unwrap_or(u64::MAX);
            // SAFETY: the fence is live, and a submission signals it.
            match unsafe { self.gpu.device.wait_for_fences(&[self.fence], true, timeout_ns) } {
                Err(vk::Result::TIMEOUT) => {
                    // Whoever asks again, as `Drop` does, gets the answer at once.
                    self.timeout = Duration::ZERO;
                    return Err(GpuError::DeviceLost("waiting a minute for a frame"));
                }
                other => other.context("waiting for a frame")?,
            }
            fault::lose("waiting for a frame")?;
            self.pending = false;
        }
        self.kept.clear();
        Ok(())
    }

    /// Whether the device has run this slot's last submission; true before the first, false on a lost device.
    pub(in crate::gpu) fn is_finished(&self) -> bool {
        // SAFETY: the fence is live.
        !self.pending || unsafe { self.gpu.device.get_fence_status(self.fence) } == Ok(true)
    }

    /// Whether the last submission has stages whose loops might not end.
    pub(in crate::gpu) fn has_loops(&self) -> bool {
        self.loops.1
    }

    /// The words that name a loop of the last submission that did not end; `None` if all ended. The submission must be finished.
    pub(in crate::gpu) fn endless_loop(&self) -> Option<[u32; 2]> {
        let (buffer, _) = (self.loops.0.as_ref()?, self.loops.1.then_some(())?);
        let content = buffer.read();
        let (words, _) = content.as_chunks::<4>();
        let [a, b, ..] = words else { return None };
        Some([a, b].map(|word| u32::from_ne_bytes(*word))).filter(|words| *words != [0; 2])
    }

    /// The buffer that [`FrameSlot::endless_loop`] reads.
    fn loops_buffer(&mut self, size: u64) -> Result<Arc<Buffer>, GpuError> {
        if let Some(buffer) = &self.loops.0 {
            return Ok(buffer.clone());
        }
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(&self.gpu, "loops readback", size, usage, Memory::Readback)?;
        Ok(self.loops.0.insert(buffer).clone())
    }

    /// SYNC: waits for the slot's last submission, whose command buffer and timestamps are then recorded anew.
    pub(in crate::gpu) fn begin(&mut self) -> Result<Encoder, GpuError> {
        self.wait()?;
        let device = &self.gpu.device;
        // SAFETY: no submission is pending, so nothing uses the pool; the buffer belongs to it.
        unsafe {
            device.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).context("resetting commands")?;
            let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            device.begin_command_buffer(self.buffer, &info).context("beginning commands")?;
        }
        if self.queries == vk::QueryPool::null() {
            return Ok(Encoder::new(&self.gpu, self.buffer, None));
        }
        // SAFETY: the buffer is recording, and no pending submission uses the queries.
        unsafe { device.cmd_reset_query_pool(self.buffer, self.queries, 0, MAX_TIMESTAMPS) };
        let mut encoder = Encoder::new(&self.gpu, self.buffer, Some(PassTimer::new(self.queries)));
        encoder.write_timestamp(self.queries, 0);
        Ok(encoder)
    }

    /// Submits the commands of the last [`FrameSlot::begin`]. If that fails, the slot can begin again.
    pub(in crate::gpu) fn submit(&mut self, mut encoder: Encoder, sync: Submission) -> Result<(), GpuError> {
        self.loops.1 = encoder.loops.is_some();
        if let Some(loops) = encoder.loops.take() {
            let buffer = self.loops_buffer(loops.size())?;
            encoder.take_loops(&loops, &buffer);
        }
        let device = &self.gpu.device;
        let passes = encoder.timer.take().map(|timer| timer.passes);
        if passes.is_some() {
            encoder.write_timestamp(self.queries, 1);
        }
        self.counts = encoder.counter.counts;
        self.kept = encoder.kept;
        // SAFETY: the buffer is recording.
        unsafe { device.end_command_buffer(self.buffer) }.context("ending commands")?;
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.buffer)];
        let stage = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT;
        // SYNC: color output writes the swapchain image first, so no other stage waits for its acquisition.
        let wait = sync.wait.map(|s| vk::SemaphoreSubmitInfo::default().semaphore(s).stage_mask(stage));
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let signal = sync.signal.map(|s| vk::SemaphoreSubmitInfo::default().semaphore(s).stage_mask(all));
        let info = vk::SubmitInfo2::default()
            .command_buffer_infos(&buffers)
            .wait_semaphore_infos(wait.as_slice())
            .signal_semaphore_infos(signal.as_slice());
        if sync.signal.is_some() {
            fault::refuse("frame-submit", "submitting a frame")?;
        }
        // A driver may block here on a hung device.
        let _watched = watch(passes.as_deref());
        let queue = self.gpu.lock_queue();
        // SAFETY: no submission is pending on the fence, the queue is locked, and `kept` holds all that the commands use.
        unsafe {
            device.reset_fences(&[self.fence]).context("resetting a fence")?;
            device.queue_submit2(*queue, &[info], self.fence).context("submitting a frame")?;
        }
        // A failed submission never signals the fence, so only a successful one is waited for.
        self.pending = true;
        self.passes = passes;
        Ok(())
    }

    /// Device times of the last submission, which must be finished. `None` without timestamps.
    pub(in crate::gpu) fn times(&self) -> Option<Times> {
        let passes = self.passes.as_ref()?;
        let mut ticks = vec![0u64; 2 + 2 * passes.len()];
        // SAFETY: a finished submission has written these queries, two for itself and two for each pass.
        unsafe { self.gpu.device.get_query_pool_results(self.queries, 0, &mut ticks, vk::QueryResultFlags::TYPE_64) }
            .ok()?;
        let mut ms = ticks.chunks_exact(2).map(|pair| self.gpu.ticks_to_ms(pair[0], pair[1]));
        let whole = ms.next()?;
        let time = |(pass, ms): (&TimedPass, f64)| PassTime {
            name: pass.name.clone(),
            ms: if pass.kept { 0.0 } else { ms },
            kept: pass.kept,
        };
        let passes = passes.iter().zip(ms).map(time).collect();
        Some(Times { ms: whole, passes, counts: self.counts })
    }
}

/// Watches the device while it runs a submission with these passes.
fn watch(passes: Option<&[TimedPass]>) -> Option<Watched> {
    Watched::begin(|| match passes {
        Some(passes @ [_, ..]) => {
            let names: Vec<&str> = passes.iter().filter(|pass| !pass.kept).map(|pass| pass.name.as_str()).collect();
            format!("drawing a frame (passes: {})", names.join(", "))
        }
        _ => "running compute shaders or copies".to_owned(),
    })
}

impl Drop for FrameSlot {
    fn drop(&mut self) {
        // SYNC: the device may still run the commands. An error means a lost device, which runs nothing, or that the wait has timed out.
        // SAFETY: the fence is live.
        if self.wait().is_err() && unsafe { self.gpu.device.get_fence_status(self.fence) } == Ok(false) {
            // The device may use everything at any later time, so nothing is freed, and the device is never destroyed.
            std::mem::forget((std::mem::take(&mut self.kept), self.loops.0.take(), self.gpu.clone()));
            return;
        }
        // SAFETY: the device has run the commands, or is lost. Vulkan ignores null handles.
        unsafe {
            self.gpu.device.destroy_query_pool(self.queries, None);
            self.gpu.device.destroy_fence(self.fence, None);
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuOptions;

    #[test]
    fn what_the_device_still_uses_outlives_a_slot_whose_wait_has_timed_out() {
        let gpu = Gpu::new(&GpuOptions::default()).unwrap();
        let device = &gpu.device;
        let buffer = Buffer::new(&gpu, "kept", 4, vk::BufferUsageFlags::STORAGE_BUFFER, Memory::Device).unwrap();
        let mut slot = FrameSlot::new(&gpu, "hangs", false).unwrap();
        slot.timeout = Duration::ZERO;
        let mut encoder = slot.begin().unwrap();
        encoder.keep(&buffer);
        // SAFETY: the device is live, and the slot's command buffer is being recorded.
        let event = unsafe {
            let event = device.create_event(&vk::EventCreateInfo::default(), None).unwrap();
            let (from, to) = (vk::PipelineStageFlags::HOST, vk::PipelineStageFlags::ALL_COMMANDS);
            device.cmd_wait_events(encoder.raw, &[event], from, to, &[], &[], &[]);
            event
        };
        slot.submit(encoder, Submission::default()).unwrap();
        let kept = Arc::downgrade(&buffer);
        drop((buffer, slot));
        let is_kept = kept.strong_count() > 0;
        // SAFETY: the event is live, and once the device is idle, nothing uses it.
        unsafe {
            device.set_event(event).unwrap();
            gpu.wait_idle();
            device.destroy_event(event, None);
        }
        assert!(is_kept, "a buffer that the device uses was freed");
    }
}
