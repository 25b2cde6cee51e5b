//! Finds the descriptors that the functions of a module use, and the parts of a block that they read.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::ops::Range;

use super::bindings::{BINDING, DESCRIPTOR_SET, HEADER, instruction};
use super::opcode as op;
use super::reach::{ids, reachable_functions};

const OFFSET: u32 = 35;
const ARRAY_STRIDE: u32 = 6;

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

/// The bytes that functions of the module may read of the block at this set and binding, as far as an entry point calls them. Members
/// that they do not name are left out. The last member ends at `usize::MAX`, unless it is an array: trees may leave out what follows
/// it in the contract.
pub fn used_bytes(words: &[u32], set: u32, binding: u32) -> Vec<Range<usize>> {
    let (mut in_set, mut at_binding) = (HashSet::new(), HashSet::new());
    let (mut layouts, mut pointers, mut blocks) = (Layouts::default(), HashMap::new(), Vec::new());
    let mut at = HEADER;
    while let Some((opcode, length)) = instruction(words, at) {
        match (opcode, &words[at + 1..at + length]) {
            (op::DECORATE, [id, DESCRIPTOR_SET, number]) if *number == set => {
                in_set.insert(*id);
            }
            (op::DECORATE, [id, BINDING, number]) if *number == binding => {
                at_binding.insert(*id);
            }
            (op::MEMBER_DECORATE, [id, member, OFFSET, bytes]) => {
                layouts.offsets.entry(*id).or_default().insert(*member, *bytes as usize);
            }
            (op::DECORATE, [id, ARRAY_STRIDE, bytes]) => {
                layouts.strides.insert(*id, *bytes as usize);
            }
            (op::TYPE_STRUCT, [id, types @ ..]) => {
                layouts.members.insert(*id, types);
            }
            (op::TYPE_ARRAY, [id, _, length]) => {
                layouts.lengths.insert(*id, *length);
            }
            (op::CONSTANT, [_, id, value]) => {
                layouts.constants.insert(*id, *value);
            }
            (op::TYPE_POINTER, [id, _, to]) => {
                pointers.insert(*id, *to);
            }
            // Two variables may share a binding: a linked module can hold that of before as well.
            (op::VARIABLE, [pointer, id, ..]) if in_set.contains(id) && at_binding.contains(id) => {
                blocks.push((*id, pointers.get(pointer).copied()));
            }
            _ => {}
        }
        at += length;
    }
    let reachable = if blocks.is_empty() { BTreeSet::new() } else { reachable_functions(words) };
    let everything = Range { start: 0, end: usize::MAX };
    let of_block = |(id, of): (u32, Option<u32>)| {
        let members = members_read(&words[at..], id, &layouts.constants, &reachable);
        members
            .zip(of)
            .and_then(|(members, of)| layouts.ranges(of, &members))
            .unwrap_or_else(|| vec![everything.clone()])
    };
    let mut ranges: Vec<Range<usize>> = blocks.into_iter().flat_map(of_block).collect();
    ranges.sort_unstable_by_key(|range| (range.start, range.end));
    ranges.dedup();
    ranges
}

/// The layouts of structs, as far as [`used_bytes`] needs them.
#[derive(Default)]
struct Layouts<'a> {
    /// Offsets of members, by struct.
    offsets: HashMap<u32, BTreeMap<u32, usize>>,
    /// Types of members, by struct.
    members: HashMap<u32, &'a [u32]>,
    /// Constants with the lengths of arrays, by their types.
    lengths: HashMap<u32, u32>,
    /// Distances of their elements.
    strides: HashMap<u32, usize>,
    constants: HashMap<u32, u32>,
}

impl Layouts<'_> {
    /// The bytes of these members of a struct. `None` if its layout is not known.
    fn ranges(&self, of: u32, members: &BTreeSet<u32>) -> Option<Vec<Range<usize>>> {
        let offsets = self.offsets.get(&of)?;
        let last_end = self.members.get(&of).and_then(|types| types.last()).and_then(|array| {
            let length = *self.constants.get(self.lengths.get(array)?)? as usize;
            Some(offsets.values().max()? + length * self.strides.get(array)?)
        });
        let end_of = |start: usize| {
            offsets.values().copied().filter(|other| *other > start).min().or(last_end).unwrap_or(usize::MAX)
        };
        members.iter().map(|member| offsets.get(member).map(|start| *start..end_of(*start))).collect()
    }
}

/// The members of the block `block` that the reachable functions in `code` read. `None` if they may read all of it.
fn members_read(
    code: &[u32],
    block: u32,
    constants: &HashMap<u32, u32>,
    reachable: &BTreeSet<u32>,
) -> Option<BTreeSet<u32>> {
    let (mut members, mut is_reachable, mut at) = (BTreeSet::new(), false, 0);
    while let Some(first) = code.get(at) {
        let (opcode, length) = (first & 0xffff, (first >> 16) as usize);
        let instruction = code.get(at..at + length).filter(|_| length > 0)?;
        match (opcode, &instruction[1..]) {
            (op::FUNCTION, [_, function, ..]) => is_reachable = reachable.contains(function),
            _ if !is_reachable => {}
            (op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN, [_, _, base, member, ..]) if *base == block => {
                members.insert(*constants.get(member)?);
            }
            // The whole block.
            _ if ids(instruction).any(|id| id == block) => return None,
            _ => {}
        }
        at += length;
    }
    Some(members)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::optimize;

    /// The bytes that a stage with these functions uses of a block with members at 0, 64, 76 and 80.
    #[track_caller]
    fn used(functions: &str) -> Vec<(usize, usize)> {
        let text = format!(
            "#version 460\n#extension GL_EXT_scalar_block_layout : require\n
             layout(set = 0, binding = 1, scalar) uniform Other {{ vec4 other; }};
             layout(set = 0, binding = 0, scalar) uniform Block {{ mat4 a; vec3 b; float c; vec2 d[2]; }} block;
             layout(location = 0) in flat int n;
             layout(location = 0) out vec4 color;\n{functions}"
        );
        let source = Source::memory([("m.frag", text.as_str())]);
        let words = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap();
        let before = used_bytes(&words, 0, 0);
        let after = used_bytes(&optimize(words), 0, 0);
        assert_eq!(before, after, "the optimizer reads no more");
        after.into_iter().map(|bytes| (bytes.start, bytes.end)).collect()
    }

    #[test]
    fn members_that_a_function_reads_count() {
        assert_eq!(used("void main() { color = other; }"), []);
        assert_eq!(used("void main() { color = vec4(block.c); }"), [(76, 80)]);
        assert_eq!(used("void main() { color = block.a[n]; }"), [(0, 64)]);
        assert_eq!(
            used("float f() { return block.d[n].y; } void main() { color = vec4(block.b, f()); }"),
            [(64, 76), (80, 96)]
        );
    }

    #[test]
    fn bytes_of_no_block_are_none() {
        assert!(used_bytes(&[], 0, 0).is_empty());
        assert!(used_bytes(&[0; 40], 0, 0).is_empty());
    }
}
