//! The memory that the parts of a file take in all: a small file that would become a huge model is a mistake, or made to fill the memory.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::scene::error::Problem;

/// Memory that the parts of any file may take, bytes.
pub const BASE: u64 = 1 << 30;
/// Memory beyond it for each stored byte. Compressed geometry and plain textures become some hundred times as large.
const EACH: u64 = 256;

/// The memory of a file's parts. Each is charged by what it takes while it is read, before it is.
pub struct Memory {
    most: AtomicU64,
    taken: AtomicU64,
}

impl Memory {
    /// For a file of `stored` bytes.
    pub fn new(stored: u64) -> Self {
        let memory = Self { most: AtomicU64::new(BASE), taken: AtomicU64::new(0) };
        memory.add_stored(stored);
        memory
    }

    /// Another file of the model has been opened, of `stored` bytes.
    pub fn add_stored(&self, stored: u64) {
        self.most.fetch_add(stored.saturating_mul(EACH).min(1 << 50), Relaxed);
    }

    /// Takes memory for a part.
    ///
    /// # Errors
    /// There is less than that left. `bytes`: `None` stands for more than a number can say.
    pub fn take(&self, bytes: Option<u64>, place: &str) -> Result<(), Problem> {
        let granted = bytes.map(|bytes| self.take_most(1, bytes));
        if granted == Some(1) {
            return Ok(());
        }
        let expected =
            format!("a file whose parts take at most {} MiB in all when decoded", self.most.load(Relaxed) >> 20);
        let found = bytes.map_or("more".into(), |bytes| format!("{bytes} more bytes"));
        Err(Problem::invalid(place, expected, found))
    }

    /// As [`Memory::take`], for `count` elements of a type.
    ///
    /// # Errors
    /// There is less than that left.
    pub fn take_of<T>(&self, count: usize, place: &str) -> Result<(), Problem> {
        self.take((count as u64).checked_mul(size_of::<T>() as u64), place)
    }

    /// Takes memory for as many of `count` parts of `each` bytes as there is. Returns their number.
    pub fn take_most(&self, count: u64, each: u64) -> u64 {
        let most = self.most.load(Relaxed);
        let mut granted = 0;
        let _ = self.taken.fetch_update(Relaxed, Relaxed, |taken| {
            granted = (most.saturating_sub(taken) / each.max(1)).min(count);
            Some(taken + granted * each)
        });
        granted
    }
}
