//! Values that are known: members of composites that were just made, copies, and what was computed before.

use foldhash::{HashMap, HashMapExt};

use super::graph::Graph;
use super::module::{Module, Type, typed_result};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::specialize::control_flow::Function;
use crate::shader::spirv::specialize::{Id, Instruction, instruction, opcode};

/// How many earlier instructions are looked at for one whose value is known.
const CANDIDATES: usize = 32;
/// Storage classes that nothing writes while a stage runs: UniformConstant, Input, Uniform, PushConstant.
const READ_ONLY: [u32; 4] = [0, 1, 2, 9];

impl Module {
    /// Remembers what a composite is made of.
    pub(super) fn learn(&mut self, i: &[u32]) {
        if matches!(opcode(i), op::COMPOSITE_CONSTRUCT | op::COMPOSITE_INSERT | op::VECTOR_SHUFFLE) {
            self.composites.insert(i[2], i.to_vec());
        }
    }

    /// Follows a path into composites of known members. Returns the value to extract from, and what is left of the path.
    fn follow(&mut self, id: Id, path: &[u32]) -> (Id, Vec<u32>) {
        let (mut id, mut path) = (self.resolve(id), path.to_vec());
        while let (Some(&index), Some(i)) = (path.first(), self.composites.get(&id)) {
            let member = |from: usize| i.get(from + index as usize).copied();
            let (next, depth) = match opcode(i) {
                op::CONSTANT_COMPOSITE => match member(3) {
                    Some(member) => (member, 1),
                    None => return (id, path),
                },
                // A vector may also be made of vectors.
                op::COMPOSITE_CONSTRUCT => match (self.get_type(i[1]), member(3)) {
                    (Some(Type::Vector(_, count)), _) if i.len() - 3 != *count as usize => return (id, path),
                    (_, Some(member)) => (member, 1),
                    (_, None) => return (id, path),
                },
                op::COMPOSITE_INSERT => {
                    let inserted = &i[5..];
                    if path.starts_with(inserted) {
                        (i[3], inserted.len())
                    } else if inserted.starts_with(&path) {
                        return (id, path);
                    } else {
                        (i[4], 0)
                    }
                }
                op::VECTOR_SHUFFLE => {
                    let vector = self.get_type(self.type_of(i[3]));
                    let (Some(Type::Vector(_, count)), Some(component)) = (vector, member(5)) else {
                        return (id, path);
                    };
                    if component == u32::MAX {
                        return (id, path);
                    }
                    let (from, component) =
                        if component < *count { (i[3], component) } else { (i[4], component - count) };
                    path[0] = component;
                    (from, 0)
                }
                _ => return (id, path),
            };
            path.drain(..depth);
            id = self.resolve(next);
        }
        (id, path)
    }

    /// The member of a composite at a path, if it is known.
    pub(super) fn extracted(&mut self, id: Id, path: &[u32]) -> Option<Id> {
        let (id, rest) = self.follow(id, path);
        rest.is_empty().then_some(id)
    }

    /// The member of a composite at a path, by an instruction of its own if need be.
    pub(super) fn extract(&mut self, id: Id, path: &[u32], out: &mut Vec<Instruction>) -> Id {
        let (id, rest) = self.follow(id, path);
        if rest.is_empty() {
            return id;
        }
        let kind = rest.iter().fold(self.type_of(id), |kind, index| self.member_type(kind, *index).unwrap_or(0));
        let member = self.fresh(kind);
        out.push(instruction(op::COMPOSITE_EXTRACT, &[&[kind, member, id], &*rest].concat()));
        member
    }

    /// Whether an instruction gives the same value wherever its operands are the same.
    fn is_pure(&self, i: &[u32], is_memory_constant: bool) -> bool {
        match opcode(i) {
            // GLSL.std.450: not Modf, Frexp and InterpolateAt, which take pointers
            op::EXT_INST => !matches!(i[4], 35 | 51 | 76..=78),
            op::LOAD => match self.get_type(self.type_of(i[3])) {
                Some(Type::Pointer(storage, _)) => {
                    READ_ONLY.contains(storage) || (is_memory_constant && is_buffer(*storage))
                }
                _ => false,
            },
            op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN | op::ARRAY_LENGTH | 77..=82 | 84 | 400 => true,
            // Sampling and fetching, but no reading of storage images
            87..=97 => is_memory_constant,
            // Queries
            100 | 103..=107 => true,
            // Conversions, arithmetic, logic, bits, derivatives
            109..=124 | 126..=152 | 154..=191 | 194..=205 | 207..=215 => true,
            _ => false,
        }
    }
}

/// StorageBuffer, PhysicalStorageBuffer
fn is_buffer(storage: u32) -> bool {
    matches!(storage, 12 | 5349)
}

/// Whether nothing that a function reads can change while it runs: it writes no buffer and no image, calls nothing, and waits for
/// no one.
fn is_memory_constant(module: &Module, function: &Function) -> bool {
    let mut all = function.blocks.iter().flat_map(|block| &block.body);
    !module.has_shared_memory
        && !all.any(|i| match opcode(i) {
            op::STORE => {
                matches!(module.get_type(module.type_of(i[1])), Some(Type::Pointer(storage, _)) if is_buffer(*storage))
            }
            op::FUNCTION_CALL | 63 | 99 | 224 | 225 | 227..=242 => true,
            _ => false,
        })
}

/// Replaces values that are known, in all blocks.
pub(super) fn simplify(module: &mut Module, function: &mut Function) {
    let graph = Graph::new(&function.blocks);
    let is_memory_constant = is_memory_constant(module, function);
    // Blocks and ids of earlier results, by instruction.
    let mut computed: HashMap<Instruction, Vec<(usize, Id)>> = HashMap::new();
    for &block in &graph.order {
        let body = std::mem::take(&mut function.blocks[block].body);
        let mut out = Vec::with_capacity(body.len());
        for mut i in body {
            module.resolve_operands(&mut i);
            match opcode(&i) {
                op::COPY_OBJECT => {
                    module.replace(i[2], i[3]);
                    continue;
                }
                op::PHI => {
                    let mut others = i[3..].iter().step_by(2).filter(|value| **value != i[2]);
                    if let Some(first) = others.next()
                        && others.all(|other| other == first)
                    {
                        module.replace(i[2], *first);
                        continue;
                    }
                }
                op::COMPOSITE_EXTRACT => {
                    let (id, rest) = module.follow(i[3], &i[4..]);
                    if rest.is_empty() {
                        module.replace(i[2], id);
                        continue;
                    }
                    i = instruction(op::COMPOSITE_EXTRACT, &[&[i[1], i[2], id], &*rest].concat());
                }
                // Integers that are the same value are equal.
                op::IEQUAL if i[3] == i[4] => {
                    module.known.values.insert(i[2], 1);
                }
                op::ALL if module.known.values.get(&i[3]) == Some(&1) => {
                    module.known.values.insert(i[2], 1);
                }
                _ => module.learn(&i),
            }
            if let Some((_, id)) = typed_result(&i)
                && module.is_pure(&i, is_memory_constant)
                && !module.is_decorated(id)
            {
                let mut key = i.clone();
                key[2] = 0;
                let same = computed.entry(key).or_default();
                let mut newest = same.iter().rev().take(CANDIDATES);
                let before = newest.find(|(place, _)| *place == block || graph.dominates(*place, block));
                if let Some((_, value)) = before {
                    module.replace(id, *value);
                    continue;
                }
                same.push((block, id));
            }
            out.push(i);
        }
        function.blocks[block].body = out;
    }
}
