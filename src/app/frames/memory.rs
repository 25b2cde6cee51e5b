//! Memory of the device and of the process, looked up now and then.

use std::time::{Duration, Instant};

use crate::gpu::{Gpu, MemoryUse};

/// Shortest interval between two queries of the memory.
const INTERVAL: Duration = Duration::from_millis(500);

/// The memory in use, and when it was looked up.
#[derive(Default)]
pub(super) struct MemoryClock {
    known: Option<(Instant, MemoryUse, Option<u64>)>,
}

impl MemoryClock {
    /// Memory of the device, and resident memory of the process in bytes where the system reports it. The latter is a file of the
    /// kernel, which no disk can delay.
    pub(super) fn read(&mut self, gpu: &Gpu) -> (&MemoryUse, Option<u64>) {
        let old = self.known.take().filter(|(at, ..)| at.elapsed() < INTERVAL);
        let (_, device, process) = self.known.insert(match old {
            Some(known) => known,
            None => (Instant::now(), gpu.memory(), resident()),
        });
        (device, *process)
    }
}

/// Resident memory of this process, bytes (proc(5)).
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kib = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    kib.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok().map(|kib| kib << 10)
}
