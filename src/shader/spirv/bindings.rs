//! Gives the descriptors that a pass declares by name alone a set of their own.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::opcode as op;

const BINDING: u32 = 33;
const DESCRIPTOR_SET: u32 = 34;

/// Words before the first instruction.
const HEADER: usize = 5;

/// Moves the descriptors with these names to `set`. The binding of each is the place of its name in `names`, so it does not depend
/// on which of them the module uses. The name of a block is that of its type.
pub fn assign_set(words: &mut [u32], set: u32, names: &BTreeSet<String>) {
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
                    moved.insert(*id, place as u32);
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

/// The bindings in `set` that functions of the module use.
pub fn used_bindings(words: &[u32], set: u32) -> BTreeSet<u32> {
    let (mut in_set, mut bindings) = (BTreeSet::new(), HashMap::new());
    let mut at = HEADER;
    while let Some((opcode, length)) = instruction(words, at) {
        match (opcode, &words[at + 1..at + length]) {
            (op::DECORATE, [id, DESCRIPTOR_SET, number]) if *number == set => {
                in_set.insert(*id);
            }
            (op::DECORATE, [id, BINDING, binding]) => {
                bindings.insert(*id, *binding);
            }
            _ => {}
        }
        at += length;
    }
    bindings.retain(|id, _| in_set.contains(id));
    // A word of a function that is no id may look like one. That costs a descriptor that nobody reads.
    let words: HashSet<u32> = if bindings.is_empty() { HashSet::new() } else { words[at..].iter().copied().collect() };
    bindings.into_iter().filter(|(id, _)| words.contains(id)).map(|(_, binding)| binding).collect()
}

/// Opcode and length of the declaration at `at`; `None` at the first function and at the end.
fn instruction(words: &[u32], at: usize) -> Option<(u32, usize)> {
    let first = *words.get(at)?;
    let (opcode, length) = (first & 0xffff, (first >> 16) as usize);
    (length > 0 && at + length <= words.len() && opcode != op::FUNCTION).then_some((opcode, length))
}

fn string(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
