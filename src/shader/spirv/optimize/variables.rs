//! Finds the variables that can become values, and the leaves that pointers into them lead to.

use foldhash::{HashMap, HashMapExt};

use super::module::{Module, Type};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::is_id;
use crate::shader::spirv::specialize::control_flow::Function;
use crate::shader::spirv::specialize::{Id, opcode};

/// A variable with more leaves stays in memory.
const MOST_LEAVES: usize = 128;
/// A part of a variable that is a value of its own.
pub(super) struct Leaf {
    pub(super) kind: Id,
    pub(super) initial: Option<Id>,
}

/// The place that a pointer points to.
#[derive(Clone)]
pub(super) struct Place {
    /// The first leaf of its variable.
    first: usize,
    /// The type of its variable.
    kind: Id,
    path: Vec<u32>,
}

/// The variables that become values.
pub(super) struct Variables {
    pub(super) leaves: Vec<Leaf>,
    pub(super) pointers: HashMap<Id, Place>,
    /// Leaves of each type.
    pub(super) counts: HashMap<Id, usize>,
}

impl Variables {
    pub(super) fn find(module: &mut Module, function: &Function, with_private: bool) -> Self {
        let mut candidates: Vec<(Id, Id, Option<Id>)> =
            if with_private { module.private_variables() } else { Vec::new() };
        let all = || function.blocks.iter().flat_map(|block| &block.body);
        for i in all().filter(|i| opcode(i) == op::VARIABLE) {
            if let Some(Type::Pointer(_, of)) = module.get_type(i[1]) {
                candidates.push((i[2], *of, i.get(4).copied()));
            }
        }
        // Which variable each pointer points into, and which variables are used in other ways.
        let mut owner: HashMap<Id, usize> = HashMap::new();
        let mut paths: HashMap<Id, Vec<u32>> = HashMap::new();
        let mut stays = vec![false; candidates.len()];
        for (index, (id, ..)) in candidates.iter().enumerate() {
            owner.insert(*id, index);
            paths.insert(*id, Vec::new());
        }
        for i in all() {
            let code = opcode(i);
            if code == op::VARIABLE {
                continue;
            }
            let is_chain = matches!(code, op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN);
            for at in (1..i.len()).filter(|at| is_id(i, *at) == Some(true)) {
                let Some(&variable) = owner.get(&i[at]) else { continue };
                let is_plain = match code {
                    op::LOAD => i.len() == 4,
                    op::STORE => at == 1 && i.len() == 3,
                    _ => is_chain && at == 3,
                };
                stays[variable] |= !is_plain;
            }
            if is_chain && let Some(&variable) = owner.get(&i[3]) {
                let indices: Option<Vec<u32>> = i[4..].iter().map(|id| module.known.values.get(id).copied()).collect();
                let path =
                    [paths.get(&i[3]).cloned().unwrap_or_default(), indices.clone().unwrap_or_default()].concat();
                stays[variable] |= indices.is_none() || !exists(module, candidates[variable].1, &path);
                owner.insert(i[2], variable);
                paths.insert(i[2], path);
            }
        }
        let mut this = Self { leaves: Vec::new(), pointers: HashMap::new(), counts: HashMap::new() };
        let mut firsts = vec![None; candidates.len()];
        for (index, (_, kind, initial)) in candidates.iter().enumerate() {
            let is_known = initial.is_none_or(|id| is_split(module, *kind, id));
            if !stays[index] && is_known && this.count(module, *kind).is_some_and(|count| count <= MOST_LEAVES) {
                firsts[index] = Some(this.leaves.len());
                this.add_leaves(module, *kind, *initial);
            }
        }
        for (pointer, variable) in owner {
            if let (Some(first), Some(path)) = (firsts[variable], paths.remove(&pointer)) {
                this.pointers.insert(pointer, Place { first, kind: candidates[variable].1, path });
            }
        }
        this
    }

    /// The number of leaves of a type; `None` if it has an array of unknown length.
    fn count(&mut self, module: &Module, kind: Id) -> Option<usize> {
        if let Some(count) = self.counts.get(&kind) {
            return Some(*count);
        }
        let count = match module.get_type(kind) {
            Some(Type::Struct(members)) => {
                members.clone().into_iter().map(|member| self.count(module, member)).sum::<Option<usize>>()?
            }
            Some(Type::Array(_, 0)) => return None,
            Some(Type::Array(of, length)) => {
                let length = (*length as usize).min(MOST_LEAVES + 1);
                self.count(module, *of)? * length
            }
            _ => 1,
        };
        self.counts.insert(kind, count);
        Some(count)
    }

    fn add_leaves(&mut self, module: &mut Module, kind: Id, initial: Option<Id>) {
        match parts(module, kind) {
            Some(parts) => {
                for (index, part) in parts.into_iter().enumerate() {
                    let initial = initial.and_then(|id| module.extracted(id, &[index as u32]));
                    self.add_leaves(module, part, initial);
                }
            }
            None => self.leaves.push(Leaf { kind, initial }),
        }
    }

    /// The first leaf at a place, the type there, and the part of the path within a leaf.
    pub(super) fn locate<'a>(&self, module: &Module, place: &'a Place) -> (usize, Id, &'a [u32]) {
        let (mut leaf, mut kind) = (place.first, place.kind);
        for (depth, index) in place.path.iter().enumerate() {
            let Some(parts) = parts(module, kind) else { return (leaf, kind, &place.path[depth..]) };
            let index = (*index as usize).min(parts.len().saturating_sub(1));
            leaf += parts[..index].iter().map(|part| self.counts.get(part).copied().unwrap_or(1)).sum::<usize>();
            kind = parts[index];
        }
        (leaf, kind, &[])
    }
}

/// Whether a type has a member at a path.
fn exists(module: &Module, kind: Id, path: &[u32]) -> bool {
    let Some((index, rest)) = path.split_first() else { return true };
    let count = match module.get_type(kind) {
        Some(Type::Struct(members)) => members.len(),
        Some(Type::Array(_, count) | Type::Vector(_, count)) => *count as usize,
        _ => 0,
    };
    let member = module.member_type(kind, *index).filter(|_| (*index as usize) < count);
    member.is_some_and(|member| exists(module, member, rest))
}

/// Whether the values of all leaves of an initial value are known: not of `OpConstantNull`.
fn is_split(module: &mut Module, kind: Id, value: Id) -> bool {
    let Some(parts) = parts(module, kind) else { return true };
    let is_split = |(index, part)| module.extracted(value, &[index]).is_some_and(|value| is_split(module, part, value));
    (0..).zip(parts).all(is_split)
}

/// The types of the members of a struct or an array; `None` for a leaf.
pub(super) fn parts(module: &Module, kind: Id) -> Option<Vec<Id>> {
    match module.get_type(kind) {
        Some(Type::Struct(members)) => Some(members.clone()),
        Some(Type::Array(of, length)) => Some(vec![*of; *length as usize]),
        _ => None,
    }
}
