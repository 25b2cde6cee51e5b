//! The CPU time of a thread, which other work on the machine does not lengthen.

use std::time::Duration;

/// Measures the CPU time that the thread which started it uses.
#[derive(Clone, Copy, Debug)]
pub struct CpuClock(Duration);

impl CpuClock {
    /// Starts at 0. `None` where the system has no such clock.
    pub fn start() -> Option<Self> {
        of_thread().map(Self)
    }

    /// CPU time of the thread since the start, milliseconds.
    pub fn ms(self) -> f64 {
        of_thread().unwrap_or_default().saturating_sub(self.0).as_secs_f64() * 1e3
    }
}

#[cfg(target_os = "linux")]
fn of_thread() -> Option<Duration> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
}

#[cfg(not(target_os = "linux"))]
fn of_thread() -> Option<Duration> {
    None
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn work_counts_and_sleep_does_not() {
        let clock = CpuClock::start().unwrap();
        std::thread::sleep(Duration::from_millis(50));
        let asleep = clock.ms();
        let mut sum = 0_u64;
        while clock.ms() < asleep + 5.0 {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
        assert!(asleep < 25.0, "{asleep} ms");
    }
}
