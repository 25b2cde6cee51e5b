//! Gives the descriptors that a pass declares by name alone a set of their own.

use std::collections::{BTreeSet, HashMap};

use super::opcode as op;

pub(super) const BINDING: u32 = 33;
pub(super) const DESCRIPTOR_SET: u32 = 34;

/// Words before the first instruction.
pub(super) const HEADER: usize = 5;

/// Moves the descriptors with these names to `set`. The binding of each is `first` and the place of its name in `names`, so it does
/// not depend on which of them the module uses. The name of a block is that of its type.
pub fn assign_set(words: &mut [u32], set: u32, first: u32, names: &BTreeSet<String>) {
    let (mut named, mut pointers, mut bound) = (HashMap::new(), HashMap::new(), BTreeSet::new());
    let mut moved: HashMap<u32, u32> = HashMap::new();
    let mut at = HEADER;
    while let Some((opcode, length)) = instruction(words, at) {
        let operands = &words[at + 1..at + length];
        match (opcode, operands) {
            (op::NAME, [id, name @ ..]) => {
                named.insert(*id, string(name));
            }
            // glslang gives no binding to what no function uses.
            (op::DECORATE, [id, BINDING, _]) => {
                bound.insert(*id);
            }
            (op::TYPE_POINTER, [id, _, to]) => {
                pointers.insert(*id, *to);
            }
            (op::VARIABLE, [pointer, id, ..]) if bound.contains(id) => {
                let place = |id: &u32| {
                    let name = named.get(id)?;
                    names.iter().position(|known| known == name)
                };
                if let Some(place) = place(id).or_else(|| place(pointers.get(pointer)?)) {
                    moved.insert(*id, first + place as u32);
                }
            }
            _ => {}
        }
        at += length;
    }
    let mut at = HEADER;
    while let Some((opcode, length)) = instruction(words, at) {
        if opcode == op::DECORATE && length == 4 {
            let place = moved.get(&words[at + 1]);
            match (words[at + 2], place) {
                (BINDING, Some(place)) => words[at + 3] = *place,
                (DESCRIPTOR_SET, Some(_)) => words[at + 3] = set,
                _ => {}
            }
        }
        at += length;
    }
}

/// Opcode and length of the declaration at `at`; `None` at the first function and at the end.
pub(super) fn instruction(words: &[u32], at: usize) -> Option<(u32, usize)> {
    let first = *words.get(at)?;
    let (opcode, length) = (first & 0xffff, (first >> 16) as usize);
    (length > 0 && at + length <= words.len() && opcode != op::FUNCTION).then_some((opcode, length))
}

fn string(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
