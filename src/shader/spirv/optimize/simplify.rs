//! Values that are known: members of composites that were just made, copies, and what was computed before.

use foldhash::{HashMap, HashMapExt};

use super::graph::Graph;
use super::optimizer::Optimizer;
use crate::shader::spirv::enums::{extended, storage};
use crate::shader::spirv::module::{Function, Id, Instruction, Type};
use crate::shader::spirv::op::{Class, Op};

/// How many earlier instructions are looked at for one whose value is known.
const CANDIDATES: usize = 32;
/// Storage classes that nothing writes while a stage runs.
const READ_ONLY: [u32; 4] = [storage::UNIFORM_CONSTANT, storage::INPUT, storage::UNIFORM, storage::PUSH_CONSTANT];
const BUFFERS: [u32; 2] = [storage::STORAGE_BUFFER, storage::PHYSICAL_STORAGE_BUFFER];

impl Optimizer {
    /// Follows a path into composites of known members. Returns the value to extract from, and what is left of the path.
    fn follow(&mut self, id: Id, path: &[u32]) -> (Id, Vec<u32>) {
        let (mut id, mut path) = (self.resolve(id), path.to_vec());
        while let Some((next, depth)) = self.member(id, &mut path) {
            path.drain(..depth);
            id = self.resolve(next);
        }
        (id, path)
    }

    /// The value that holds what is at a path in a composite, and how many steps of the path lead to it. The next step may change.
    /// `None` if the composite itself must be asked.
    fn member(&self, id: Id, path: &mut [u32]) -> Option<(Id, usize)> {
        let index = *path.first()?;
        let i = self.module.definition(id)?;
        let words = &self.module[i];
        let member = |from: usize| words.get(from + index as usize).copied();
        match i.op {
            Op::ConstantComposite => Some((member(3)?, 1)),
            // A vector may also be made of vectors.
            Op::CompositeConstruct => match self.module.get_type(words[1]) {
                Some(Type::Vector { count, .. }) if words.len() - 3 != count as usize => None,
                _ => Some((member(3)?, 1)),
            },
            Op::CompositeInsert => {
                let inserted = &words[5..];
                if path.starts_with(inserted) {
                    return Some((words[3], inserted.len()));
                }
                (!inserted.starts_with(path)).then_some((words[4], 0))
            }
            Op::VectorShuffle => {
                let Some(Type::Vector { count, .. }) = self.module.get_type(self.module.type_of(words[3])) else {
                    return None;
                };
                let component = member(5).filter(|component| *component != u32::MAX)?;
                let (from, component) =
                    if component < count { (words[3], component) } else { (words[4], component - count) };
                path[0] = component;
                Some((from, 0))
            }
            _ => None,
        }
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
        let whole = self.module.type_of(id);
        let kind = rest.iter().fold(whole, |kind, index| self.member_type(kind, *index).unwrap_or(0));
        self.module.emit(out, Op::CompositeExtract, kind, &[&[id], &*rest].concat())
    }

    /// The storage class of the memory that a pointer points to.
    fn storage(&self, pointer: Id) -> Option<u32> {
        self.module.pointer(self.module.type_of(pointer)).map(|(class, _)| class)
    }

    /// Whether an instruction gives the same value wherever its operands are the same.
    fn is_pure(&self, i: Instruction, is_memory_constant: bool) -> bool {
        use extended::{FREXP, INTERPOLATE_AT_CENTROID, INTERPOLATE_AT_OFFSET, MODF};
        let words = &self.module[i];
        match i.op {
            // Not those that take pointers.
            Op::ExtInst => !matches!(words[4], MODF | FREXP | INTERPOLATE_AT_CENTROID..=INTERPOLATE_AT_OFFSET),
            Op::Load => self
                .storage(words[3])
                .is_some_and(|class| READ_ONLY.contains(&class) || (is_memory_constant && BUFFERS.contains(&class))),
            Op::AccessChain | Op::InBoundsAccessChain | Op::ArrayLength => true,
            // But no reading of storage images.
            op if op.class() == Class::Sample => is_memory_constant,
            op => matches!(op.class(), Class::Composite | Class::Query | Class::Value),
        }
    }

    /// Whether nothing that a function reads can change while it runs: it writes no buffer and no image, calls nothing, and waits for
    /// no one.
    fn is_memory_constant(&self, function: &Function) -> bool {
        let changes = |i: Instruction| match i.op {
            Op::Store => self.storage(self.module[i][1]).is_some_and(|class| BUFFERS.contains(&class)),
            Op::FunctionCall | Op::CopyMemory | Op::ImageWrite => true,
            op => op.class() == Class::Synchronization,
        };
        !self.has_shared_memory && !function.body().any(changes)
    }
}

/// Replaces values that are known, in all blocks.
pub(super) fn simplify(optimizer: &mut Optimizer, function: &mut Function) {
    let graph = Graph::new(&optimizer.module, &function.blocks);
    let is_memory_constant = optimizer.is_memory_constant(function);
    // Blocks and ids of earlier results, by the words of the instruction.
    let mut computed: HashMap<Vec<u32>, Vec<(usize, Id)>> = HashMap::new();
    for &block in &graph.order {
        let body = std::mem::take(&mut function.blocks[block].body);
        let mut out = Vec::with_capacity(body.len());
        for mut i in body {
            optimizer.resolve_operands(i);
            let words = &optimizer.module[i];
            match i.op {
                Op::CopyObject => {
                    let (id, value) = (words[2], words[3]);
                    optimizer.replace(id, value);
                    continue;
                }
                Op::Phi => {
                    let id = words[2];
                    let mut others = words[3..].iter().step_by(2).filter(|value| **value != id);
                    if let Some(&first) = others.next()
                        && others.all(|other| *other == first)
                    {
                        optimizer.replace(id, first);
                        continue;
                    }
                }
                Op::CompositeExtract => {
                    let (kind, id, path) = (words[1], words[2], words[4..].to_vec());
                    let (from, rest) = optimizer.follow(words[3], &path);
                    if rest.is_empty() {
                        optimizer.replace(id, from);
                        continue;
                    }
                    i = optimizer.module.make(Op::CompositeExtract, &[&[kind, id, from], &*rest].concat());
                }
                // Integers that are the same value are equal.
                Op::IEqual if words[3] == words[4] => _ = optimizer.known.insert(words[2], 1),
                Op::All if optimizer.known.get(&words[3]) == Some(&1) => _ = optimizer.known.insert(words[2], 1),
                _ => {}
            }
            if let Some(id) = optimizer.module.result(i)
                && optimizer.is_pure(i, is_memory_constant)
                && !optimizer.is_decorated(id)
            {
                let mut key = optimizer.module[i].to_vec();
                key[2] = 0;
                let same = computed.entry(key).or_default();
                let mut newest = same.iter().rev().take(CANDIDATES);
                let before = newest.find(|(place, _)| *place == block || graph.dominates(*place, block));
                if let Some((_, value)) = before {
                    optimizer.replace(id, *value);
                    continue;
                }
                same.push((block, id));
            }
            out.push(i);
        }
        function.blocks[block].body = out;
    }
}
