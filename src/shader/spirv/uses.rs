//! Finds the parts of a block that the functions of a module read.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::enums::decoration::{ARRAY_STRIDE, BINDING, DESCRIPTOR_SET, OFFSET};
use super::module::{Function, Id, Module, Type};
use super::op::Op;
use super::reach::{reachable, uses};

/// The bytes that functions of the module may read of the block at this set and binding, as far as the entry point calls them. Members
/// that they do not name are left out. The last member ends at `usize::MAX`, unless it is an array: trees may leave out what follows
/// it in the contract.
pub fn used_bytes(module: &Module, set: u32, binding: u32) -> Vec<Range<usize>> {
    let reachable = reachable(module);
    let everything = Range { start: 0, end: usize::MAX };
    // Two variables may share a binding: a linked module can hold that of before as well.
    let is_block = |id: &Id| {
        let has = |kind: u32, value: u32| module.decoration(*id, kind) == Some(value);
        has(BINDING, binding) && has(DESCRIPTOR_SET, set)
    };
    let of_block = |id: Id| {
        let members = members_read(module, id, &reachable);
        members.and_then(|members| ranges(module, id, &members)).unwrap_or_else(|| vec![everything.clone()])
    };
    let blocks = module.decorated(BINDING).filter(is_block);
    let mut ranges: Vec<Range<usize>> = blocks.flat_map(of_block).collect();
    ranges.sort_unstable_by_key(|range| (range.start, range.end));
    ranges.dedup();
    ranges
}

/// The bytes of these members of a block. `None` if its layout is not known.
fn ranges(module: &Module, block: Id, members: &BTreeSet<u32>) -> Option<Vec<Range<usize>>> {
    let (_, of) = module.pointer(module.type_of(block))?;
    let offset = |words: &[u32]| match words {
        [_, target, member, OFFSET, bytes] if *target == of => Some((*member, *bytes as usize)),
        _ => None,
    };
    let all = module.decorations.iter().filter(|i| i.op == Op::MemberDecorate);
    let offsets: BTreeMap<u32, usize> = all.filter_map(|i| offset(&module[*i])).collect();
    let last_end = || {
        let Type::Struct { members } = module.get_type(of)? else { return None };
        let array = *members.last()?;
        let Type::Array { length, .. } = module.get_type(array)? else { return None };
        let bytes = module.number(length)? * module.decoration(array, ARRAY_STRIDE)?;
        Some(offsets.values().max()? + bytes as usize)
    };
    let last_end = last_end().unwrap_or(usize::MAX);
    let end_of = |start: usize| offsets.values().copied().filter(|other| *other > start).min().unwrap_or(last_end);
    members.iter().map(|member| offsets.get(member).map(|start| *start..end_of(*start))).collect()
}

/// The members of a block that functions read. `None` if they may read all of it.
fn members_read(module: &Module, block: Id, functions: &[&Function]) -> Option<BTreeSet<u32>> {
    let mut members = BTreeSet::new();
    for i in functions.iter().flat_map(|function| function.body()) {
        match (i.op, &module[i]) {
            (Op::AccessChain | Op::InBoundsAccessChain, [_, _, _, base, member, ..]) if *base == block => {
                members.insert(module.number(*member)?);
            }
            // The whole block.
            _ if uses(module, i).any(|id| id == block) => return None,
            _ => {}
        }
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
        let bytes = |words: &[u32]| used_bytes(&Module::parse(words).expect("a module"), 0, 0);
        let (before, after) = (bytes(&words), bytes(&optimize(words)));
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
}
