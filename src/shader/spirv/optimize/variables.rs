//! Finds the variables that can become values, and the leaves that pointers into them lead to.

use foldhash::{HashMap, HashMapExt};

use super::optimizer::Optimizer;
use crate::shader::spirv::module::{Function, Id, Type};
use crate::shader::spirv::op::Op;

/// A variable with more leaves stays in memory.
const MOST_LEAVES: usize = 128;
/// A part of a variable that is a value of its own.
pub(super) struct Leaf {
    pub(super) kind: Id,
    pub(super) initial: Option<Id>,
}

/// The place that a pointer points to.
#[derive(Clone)]
pub(super) struct VariablePart {
    /// The first leaf of its variable.
    first: usize,
    /// The type of its variable.
    kind: Id,
    path: Vec<u32>,
}

/// The variables that become values.
pub(super) struct Variables {
    pub(super) leaves: Vec<Leaf>,
    pub(super) pointers: HashMap<Id, VariablePart>,
    /// Leaves of each type.
    counts: HashMap<Id, usize>,
}

impl Variables {
    pub(super) fn find(optimizer: &mut Optimizer, function: &Function, with_private: bool) -> Self {
        let mut candidates: Vec<(Id, Id, Option<Id>)> =
            if with_private { optimizer.private_variables() } else { Vec::new() };
        let module = &optimizer.module;
        for i in function.body().filter(|i| i.op == Op::Variable) {
            let words = &module[i];
            candidates.extend(module.pointer(words[1]).map(|(_, of)| (words[2], of, words.get(4).copied())));
        }
        // Which variable each pointer points into, and which variables are used in other ways.
        let mut owner: HashMap<Id, usize> = HashMap::new();
        let mut paths: HashMap<Id, Vec<u32>> = HashMap::new();
        let mut stays = vec![false; candidates.len()];
        for (index, (id, ..)) in candidates.iter().enumerate() {
            owner.insert(*id, index);
            paths.insert(*id, Vec::new());
        }
        for i in function.body().filter(|i| i.op != Op::Variable) {
            let words = &module[i];
            let is_chain = matches!(i.op, Op::AccessChain | Op::InBoundsAccessChain);
            for at in (1..words.len()).filter(|at| i.op.is_id(words, *at)) {
                let Some(&variable) = owner.get(&words[at]) else { continue };
                let is_plain = match i.op {
                    Op::Load => words.len() == 4,
                    Op::Store => at == 1 && words.len() == 3,
                    _ => is_chain && at == 3,
                };
                stays[variable] |= !is_plain;
            }
            if is_chain && let Some(&variable) = owner.get(&words[3]) {
                let known = |id: &Id| module.number(*id).or_else(|| optimizer.known.get(id).copied());
                let indices: Option<Vec<u32>> = words[4..].iter().map(known).collect();
                let path =
                    [paths.get(&words[3]).cloned().unwrap_or_default(), indices.clone().unwrap_or_default()].concat();
                stays[variable] |= indices.is_none() || !exists(optimizer, candidates[variable].1, &path);
                owner.insert(words[2], variable);
                paths.insert(words[2], path);
            }
        }
        let mut this = Self { leaves: Vec::new(), pointers: HashMap::new(), counts: HashMap::new() };
        let mut firsts = vec![None; candidates.len()];
        for (index, (_, kind, initial)) in candidates.iter().enumerate() {
            let is_known = initial.is_none_or(|id| is_split(optimizer, *kind, id));
            if !stays[index] && is_known && this.count(optimizer, *kind).is_some_and(|count| count <= MOST_LEAVES) {
                firsts[index] = Some(this.leaves.len());
                this.add_leaves(optimizer, *kind, *initial);
            }
        }
        for (pointer, variable) in owner {
            if let (Some(first), Some(path)) = (firsts[variable], paths.remove(&pointer)) {
                this.pointers.insert(pointer, VariablePart { first, kind: candidates[variable].1, path });
            }
        }
        this
    }

    /// The number of leaves of a type; `None` if it has an array of unknown length.
    fn count(&mut self, optimizer: &Optimizer, kind: Id) -> Option<usize> {
        if let Some(count) = self.counts.get(&kind) {
            return Some(*count);
        }
        let count = match optimizer.module.get_type(kind) {
            Some(Type::Struct { members }) => {
                members.iter().map(|member| self.count(optimizer, *member)).sum::<Option<usize>>()?
            }
            Some(Type::Array { of, length }) => {
                let length = optimizer.module.number(length).filter(|length| *length != 0)?;
                self.count(optimizer, of)? * (length as usize).min(MOST_LEAVES + 1)
            }
            _ => 1,
        };
        self.counts.insert(kind, count);
        Some(count)
    }

    /// The number of leaves of a type that a variable consists of.
    pub(super) fn count_of(&self, kind: Id) -> usize {
        self.counts.get(&kind).copied().unwrap_or(1)
    }

    fn add_leaves(&mut self, optimizer: &mut Optimizer, kind: Id, initial: Option<Id>) {
        match optimizer.parts(kind) {
            Some(parts) => {
                for (index, part) in (0..).zip(parts) {
                    let initial = initial.and_then(|id| optimizer.extracted(id, &[index]));
                    self.add_leaves(optimizer, part, initial);
                }
            }
            None => self.leaves.push(Leaf { kind, initial }),
        }
    }

    /// The first leaf at a place, the type there, and the part of the path within a leaf.
    pub(super) fn locate<'a>(&self, optimizer: &Optimizer, place: &'a VariablePart) -> (usize, Id, &'a [u32]) {
        let (mut leaf, mut kind) = (place.first, place.kind);
        for (depth, index) in place.path.iter().enumerate() {
            let Some(parts) = optimizer.parts(kind) else { return (leaf, kind, &place.path[depth..]) };
            let index = (*index as usize).min(parts.len().saturating_sub(1));
            leaf += parts[..index].iter().map(|part| self.count_of(*part)).sum::<usize>();
            kind = parts[index];
        }
        (leaf, kind, &[])
    }
}

/// Whether a type has a member at a path.
fn exists(optimizer: &Optimizer, kind: Id, path: &[u32]) -> bool {
    let Some((index, rest)) = path.split_first() else { return true };
    let count = match optimizer.module.get_type(kind) {
        Some(Type::Struct { members }) => members.len() as u32,
        Some(Type::Array { length, .. }) => optimizer.module.number(length).unwrap_or(0),
        Some(Type::Vector { count, .. } | Type::Matrix { count, .. }) => count,
        _ => 0,
    };
    let member = optimizer.member_type(kind, *index).filter(|_| *index < count);
    member.is_some_and(|member| exists(optimizer, member, rest))
}

/// Whether the values of all leaves of an initial value are known: not of `OpConstantNull`.
fn is_split(optimizer: &mut Optimizer, kind: Id, value: Id) -> bool {
    let Some(parts) = optimizer.parts(kind) else { return true };
    let is_split =
        |(index, part)| optimizer.extracted(value, &[index]).is_some_and(|value| is_split(optimizer, part, value));
    (0..).zip(parts).all(is_split)
}
