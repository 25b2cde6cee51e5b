//! Damages files at random, for tests of what may come from anywhere: some hundred times in each run, 10,000 times with `SPECULA_LONG=1`.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Damaged files by hand.
const MANY: usize = 10_000;

/// Calls `read` with damaged copies of `files`, in turn: `few` in each run. Returns how many.
///
/// # Panics
/// If `read` does. The damaged file is kept, and named.
pub(crate) fn each(few: usize, files: &[&[u8]], read: impl Fn(&[u8])) -> usize {
    let is_long = std::env::var_os("SPECULA_LONG").is_some_and(|value| value == "1");
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let count = if is_long { MANY } else { few };
    for number in 0..count {
        let bytes = random.damaged(files[number % files.len()]);
        if catch_unwind(AssertUnwindSafe(|| read(&bytes))).is_err() {
            let (_, path) = tempfile::NamedTempFile::new().unwrap().keep().unwrap();
            std::fs::write(&path, &bytes).unwrap();
            panic!("the damaged file {number} of {} bytes is kept as {}", bytes.len(), path.display());
        }
    }
    count
}

/// A xorshift generator (Marsaglia 2003), the same in each run.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }

    fn of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    /// A position. Half of them are in the first bytes, where headers are.
    fn position(&mut self, bytes: &[u8]) -> usize {
        let end = if self.below(2) == 0 { bytes.len().min(256) } else { bytes.len() };
        self.below(end)
    }

    fn range(&mut self, bytes: &[u8]) -> std::ops::Range<usize> {
        let start = self.position(bytes);
        let longest = self.of(&[1, 4, 16, 256, bytes.len()]);
        start..(start + 1 + self.below(longest)).min(bytes.len())
    }

    fn damaged(&mut self, file: &[u8]) -> Vec<u8> {
        let mut bytes = file.to_vec();
        for _ in 0..1 + self.below(4) {
            self.damage(&mut bytes);
        }
        bytes
    }

    fn damage(&mut self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        match self.below(9) {
            0 => {
                let at = self.position(bytes);
                bytes[at] ^= 1 << self.below(8);
            }
            1 => {
                let at = self.position(bytes);
                bytes[at] = self.of(&[0, 1, 0x7f, 0x80, 0xff, b'-', b'9', b'"', b'\n', b' ']);
            }
            2 => {
                let at = self.position(bytes);
                let number: u32 = self.of(&[0, 1, 0x7fff_ffff, 0x8000_0000, u32::MAX, 0x7fc0_0000, 0xff80_0000]);
                let end = (at + 4).min(bytes.len());
                bytes[at..end].copy_from_slice(&number.to_le_bytes()[..end - at]);
            }
            3 => {
                let at = self.position(bytes);
                bytes.truncate(at);
            }
            4 => drop(bytes.drain(self.range(bytes))),
            5 => {
                let copied = bytes[self.range(bytes)].to_vec();
                let at = self.position(bytes);
                bytes.splice(at..at, copied);
            }
            6 => {
                let random: Vec<u8> = (0..1 + self.below(16)).map(|_| self.below(256) as u8).collect();
                let at = self.position(bytes);
                bytes.splice(at..at, random);
            }
            7 => self.damage_number(bytes),
            _ => {
                let (a, b) = (self.position(bytes), self.position(bytes));
                bytes.swap(a, b);
            }
        }
    }

    /// Puts an extreme value in place of a number of a text.
    fn damage_number(&mut self, bytes: &mut Vec<u8>) {
        let from = self.position(bytes);
        let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit).map(|offset| from + offset) else { return };
        let length = bytes[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let values = [
            "-1",
            "0",
            "1",
            "3",
            "255",
            "4294967295",
            "18446744073709551616",
            "1e308",
            "NaN",
            "null",
            "\"x\"",
            "[]",
            "{}",
        ];
        let value = self.of(&values);
        bytes.splice(start..start + length, value.bytes());
    }
}
