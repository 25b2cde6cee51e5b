//! Numbers for values that many events share.

use std::hash::Hash;
use std::sync::Arc;

use foldhash::{HashMap, HashMapExt as _};

/// Numbers different values from 0. Most that are the same are behind the same pointer, so they need not be compared.
pub struct Numbered<'a, T: ?Sized> {
    by_pointer: HashMap<*const u8, usize>,
    by_value: HashMap<&'a T, usize>,
}

impl<T: ?Sized> Default for Numbered<'_, T> {
    fn default() -> Self {
        Self { by_pointer: HashMap::new(), by_value: HashMap::new() }
    }
}

impl<'a, T: ?Sized + Eq + Hash> Numbered<'a, T> {
    /// The number of a value, and whether it is new.
    pub fn of(&mut self, value: &'a Arc<T>) -> (usize, bool) {
        let pointer = Arc::as_ptr(value).cast::<u8>();
        if let Some(number) = self.by_pointer.get(&pointer) {
            return (*number, false);
        }
        let next = self.by_value.len();
        let number = *self.by_value.entry(value).or_insert(next);
        self.by_pointer.insert(pointer, number);
        (number, number == next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_have_one_number() {
        let [a, b, same]: [Arc<str>; 3] = ["a", "b", "a"].map(Arc::from);
        let mut numbered = Numbered::default();
        let numbers: Vec<(usize, bool)> = [&a, &b, &a, &same, &same].map(|value| numbered.of(value)).to_vec();
        assert_eq!(numbers, [(0, true), (1, true), (0, false), (0, false), (0, false)]);
    }
}
