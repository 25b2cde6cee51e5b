//! Makes values of local variables, as in Braun et al. 2013, "Simple and Efficient Construction of Static Single Assignment
//! Form". A struct or an array becomes its leaves: scalars, vectors and matrices that are values of their own.

use foldhash::{HashMap, HashMapExt};

use super::graph::Graph;
use super::module::{Module, Type};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::is_id;
use crate::shader::spirv::specialize::control_flow::Function;
use crate::shader::spirv::specialize::{Id, Instruction, instruction, opcode};

/// A variable with more leaves stays in memory.
const MOST_LEAVES: usize = 128;
/// Leaves times blocks, for the table of values: 64 MiB.
const MOST_VALUES: usize = 1 << 24;
/// Looking for a value goes from block to block on the stack, which threads have little of.
const MOST_BLOCKS: usize = 2000;

/// Makes values of the variables of a function whose pointers only serve loads and stores, with `with_private` also of the private
/// variables of the module.
pub(super) fn promote(module: &mut Module, function: &mut Function, with_private: bool) {
    let variables = Variables::find(module, function, with_private);
    let blocks = function.blocks.len();
    if variables.leaves.is_empty() || blocks > MOST_BLOCKS || variables.leaves.len() * blocks > MOST_VALUES {
        return;
    }
    let graph = Graph::new(&function.blocks);
    let mut promotion = Promotion {
        values: vec![0; variables.leaves.len() * function.blocks.len()],
        is_done: vec![false; function.blocks.len()],
        phis: vec![Vec::new(); function.blocks.len()],
        open: Vec::new(),
        module,
        graph: &graph,
        variables: &variables,
    };
    for &block in &graph.order {
        let body = std::mem::take(&mut function.blocks[block].body);
        let mut out = Vec::with_capacity(body.len());
        for i in body {
            promotion.instruction(block, i, &mut out);
        }
        function.blocks[block].body = out;
        promotion.is_done[block] = true;
    }
    let labels: Vec<Id> = function.blocks.iter().map(|block| block.label).collect();
    let phis = promotion.finish(&labels);
    for (block, phis) in function.blocks.iter_mut().zip(phis) {
        block.body.splice(0..0, phis);
    }
}

/// A part of a variable that is a value of its own.
struct Leaf {
    kind: Id,
    initial: Option<Id>,
}

/// The place that a pointer points to.
#[derive(Clone)]
struct Place {
    /// The first leaf of its variable.
    first: usize,
    /// The type of its variable.
    kind: Id,
    path: Vec<u32>,
}

/// The variables that become values.
struct Variables {
    leaves: Vec<Leaf>,
    pointers: HashMap<Id, Place>,
    /// Leaves of each type.
    counts: HashMap<Id, usize>,
}

impl Variables {
    fn find(module: &mut Module, function: &Function, with_private: bool) -> Self {
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
    fn locate<'a>(&self, module: &Module, place: &'a Place) -> (usize, Id, &'a [u32]) {
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
fn parts(module: &Module, kind: Id) -> Option<Vec<Id>> {
    match module.get_type(kind) {
        Some(Type::Struct(members)) => Some(members.clone()),
        Some(Type::Array(of, length)) => Some(vec![*of; *length as usize]),
        _ => None,
    }
}

/// The operands of a phi: values, and the blocks that they come from.
type Operands = Vec<(Id, usize)>;

struct Promotion<'a> {
    module: &'a mut Module,
    graph: &'a Graph,
    variables: &'a Variables,
    /// The value of each leaf at the end of what is done of each block; 0 if it is not known yet.
    values: Vec<Id>,
    is_done: Vec<bool>,
    /// Phis by block.
    phis: Vec<Vec<(Id, Operands)>>,
    /// Phis of loops whose end was not done: block, leaf, id.
    open: Vec<(usize, usize, Id)>,
}

impl Promotion<'_> {
    fn value(&mut self, block: usize, leaf: usize) -> &mut Id {
        &mut self.values[block * self.variables.leaves.len() + leaf]
    }

    /// The value of a leaf at the end of what is done of a block.
    fn read(&mut self, block: usize, leaf: usize) -> Id {
        let known = *self.value(block, leaf);
        if known != 0 {
            return self.module.resolve(known);
        }
        let graph = self.graph;
        let kind = self.variables.leaves[leaf].kind;
        let value = match *graph.before[block] {
            [] => {
                let initial = self.variables.leaves[leaf].initial;
                initial.unwrap_or_else(|| self.module.undefined(kind))
            }
            [from] => self.read(from, leaf),
            ref all => {
                let phi = self.module.fresh(kind);
                *self.value(block, leaf) = phi;
                if all.iter().all(|from| self.is_done[*from]) {
                    self.fill(block, leaf, phi);
                } else {
                    self.open.push((block, leaf, phi));
                }
                self.module.resolve(phi)
            }
        };
        *self.value(block, leaf) = value;
        value
    }

    /// Reads the operands of a phi. If they are all the same, they stand for the phi.
    fn fill(&mut self, block: usize, leaf: usize, phi: Id) {
        let graph = self.graph;
        let operands: Operands = graph.before[block].iter().map(|from| (self.read(*from, leaf), *from)).collect();
        let mut others = operands.iter().map(|(value, _)| *value).filter(|value| *value != phi);
        let first = others.next();
        match first {
            Some(value) if others.all(|other| other == value) => self.module.replace(phi, value),
            _ => self.phis[block].push((phi, operands)),
        }
    }

    fn instruction(&mut self, block: usize, mut i: Instruction, out: &mut Vec<Instruction>) {
        let pointer = match opcode(&i) {
            op::LOAD => i[3],
            op::STORE => i[1],
            op::VARIABLE | op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN => i[2],
            _ => 0,
        };
        let variables = self.variables;
        let Some(place) = variables.pointers.get(&pointer) else {
            self.module.resolve_operands(&mut i);
            self.module.learn(&i);
            out.push(i);
            return;
        };
        let (leaf, kind, rest) = variables.locate(self.module, place);
        match opcode(&i) {
            op::LOAD => {
                let value = match rest {
                    [] => self.load(block, leaf, kind, out),
                    rest => {
                        let whole = self.read(block, leaf);
                        self.module.extract(whole, rest, out)
                    }
                };
                self.module.replace(i[2], value);
            }
            op::STORE => {
                let value = self.module.resolve(i[2]);
                match rest {
                    [] => self.store(block, leaf, kind, value, out),
                    rest => {
                        let whole = self.read(block, leaf);
                        let kind = variables.leaves[leaf].kind;
                        let id = self.module.fresh(kind);
                        let inserted = instruction(op::COMPOSITE_INSERT, &[&[kind, id, value, whole], rest].concat());
                        self.module.learn(&inserted);
                        out.push(inserted);
                        *self.value(block, leaf) = id;
                    }
                }
            }
            // Variables and pointers into them are gone.
            _ => {}
        }
    }

    /// The value of all leaves of a type, from the given one on.
    fn load(&mut self, block: usize, leaf: usize, kind: Id, out: &mut Vec<Instruction>) -> Id {
        let Some(parts) = parts(self.module, kind) else { return self.read(block, leaf) };
        let (mut members, mut leaf) = (Vec::new(), leaf);
        for part in parts {
            members.push(self.load(block, leaf, part, out));
            leaf += self.variables.counts.get(&part).copied().unwrap_or(1);
        }
        let id = self.module.fresh(kind);
        let made = instruction(op::COMPOSITE_CONSTRUCT, &[&[kind, id], &*members].concat());
        self.module.learn(&made);
        out.push(made);
        id
    }

    fn store(&mut self, block: usize, leaf: usize, kind: Id, value: Id, out: &mut Vec<Instruction>) {
        let Some(parts) = parts(self.module, kind) else {
            *self.value(block, leaf) = value;
            return;
        };
        let mut leaf = leaf;
        for (index, part) in parts.into_iter().enumerate() {
            let member = self.module.extract(value, &[index as u32], out);
            self.store(block, leaf, part, member, out);
            leaf += self.variables.counts.get(&part).copied().unwrap_or(1);
        }
    }

    /// Fills the phis of loops, and returns the phis of each block.
    fn finish(mut self, labels: &[Id]) -> Vec<Vec<Instruction>> {
        while let Some((block, leaf, phi)) = self.open.pop() {
            self.fill(block, leaf, phi);
        }
        // A phi that another value replaced may leave others with one operand.
        let mut is_changed = true;
        while is_changed {
            is_changed = false;
            for phis in &mut self.phis {
                let module = &mut *self.module;
                phis.retain_mut(|(phi, operands)| {
                    let mut others =
                        operands.iter().map(|(value, _)| module.resolve(*value)).filter(|value| value != phi);
                    let first = others.next();
                    match first {
                        Some(value) if others.all(|other| other == value) => {
                            drop(others);
                            module.replace(*phi, value);
                            is_changed = true;
                            false
                        }
                        _ => true,
                    }
                });
            }
        }
        let module = self.module;
        let mut write = |(phi, operands): (Id, Operands)| {
            let pairs = operands.into_iter().flat_map(|(value, from)| [module.resolve(value), labels[from]]);
            let pairs: Vec<u32> = pairs.collect();
            instruction(op::PHI, &[&[module.type_of(phi), phi], &*pairs].concat())
        };
        self.phis.into_iter().map(|phis| phis.into_iter().map(&mut write).collect()).collect()
    }
}
