//! The devices of the tests of a process.

use std::sync::{Arc, Mutex, OnceLock};

use specula::gpu::{Gpu, GpuOptions};

/// How many devices there are. Mesa's software device compiles machine code and runs commands on one thread, its queue's, so tests that run
/// at the same time have different devices.
pub const DEVICES: usize = 2;

static OPEN: [OnceLock<Arc<Gpu>>; DEVICES] = [const { OnceLock::new() }; DEVICES];
/// How many threads hold each device.
static HOLDERS: Mutex<[usize; DEVICES]> = Mutex::new([0; DEVICES]);

/// The number of the device that a thread holds. The harness runs each test on a thread of its own, which gives the device back at its end.
struct Held(usize);

impl Held {
    fn take() -> Self {
        let mut holders = HOLDERS.lock().unwrap();
        let number = (0..DEVICES).min_by_key(|number| holders[*number]).unwrap();
        holders[number] += 1;
        Self(number)
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        HOLDERS.lock().unwrap()[self.0] -= 1;
    }
}

thread_local! {
    static HELD: Held = Held::take();
}

/// The number of the device of this thread's test.
pub fn number() -> usize {
    HELD.with(|held| held.0)
}

/// The device of this thread's test, with validation and synchronization validation on.
pub fn gpu() -> &'static Arc<Gpu> {
    OPEN[number()].get_or_init(|| {
        let options = GpuOptions { validation: true, ..GpuOptions::default() };
        Gpu::new(&options).unwrap_or_else(|error| {
            panic!("no device with validation layers: {error}\nscripts/test installs what is needed")
        })
    })
}
