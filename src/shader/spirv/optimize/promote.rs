//! Makes values of local variables, as in Braun et al. 2013, "Simple and Efficient Construction of Static Single Assignment
//! Form". A struct or an array becomes its leaves: scalars, vectors and matrices that are values of their own.

use super::graph::Graph;
use super::optimizer::Optimizer;
use super::variables::Variables;
use crate::shader::spirv::module::{Function, Id, Instruction};
use crate::shader::spirv::op::Op;

/// Leaves times blocks, for the table of values: 64 MiB.
const MOST_VALUES: usize = 1 << 24;
/// Looking for a value goes from block to block on the stack, which threads have little of.
const MOST_BLOCKS: usize = 2000;

/// Makes values of the variables of a function whose pointers only serve loads and stores, with `with_private` also of the private
/// variables of the module.
pub(super) fn promote(optimizer: &mut Optimizer, function: &mut Function, with_private: bool) {
    let variables = Variables::find(optimizer, function, with_private);
    let blocks = function.blocks.len();
    if variables.leaves.is_empty() || blocks > MOST_BLOCKS || variables.leaves.len() * blocks > MOST_VALUES {
        return;
    }
    let graph = Graph::new(&optimizer.module, &function.blocks);
    let mut promotion = Promotion {
        values: vec![0; variables.leaves.len() * function.blocks.len()],
        is_done: vec![false; function.blocks.len()],
        phis: vec![Vec::new(); function.blocks.len()],
        open: Vec::new(),
        optimizer,
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

/// The operands of a phi: values, and the blocks that they come from.
type Operands = Vec<(Id, usize)>;

struct Promotion<'a> {
    optimizer: &'a mut Optimizer,
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
            return self.optimizer.resolve(known);
        }
        let graph = self.graph;
        let kind = self.variables.leaves[leaf].kind;
        let value = match *graph.before[block] {
            [] => {
                let initial = self.variables.leaves[leaf].initial;
                initial.unwrap_or_else(|| self.optimizer.undefined(kind))
            }
            [from] => self.read(from, leaf),
            ref all => {
                let phi = self.optimizer.module.fresh(kind);
                *self.value(block, leaf) = phi;
                if all.iter().all(|from| self.is_done[*from]) {
                    self.fill(block, leaf, phi);
                } else {
                    self.open.push((block, leaf, phi));
                }
                self.optimizer.resolve(phi)
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
            Some(value) if others.all(|other| other == value) => self.optimizer.replace(phi, value),
            _ => self.phis[block].push((phi, operands)),
        }
    }

    fn instruction(&mut self, block: usize, i: Instruction, out: &mut Vec<Instruction>) {
        let words = &self.optimizer.module[i];
        let (pointer, last) = match i.op {
            Op::Load => (words[3], words[2]),
            Op::Store => (words[1], words[2]),
            Op::Variable | Op::AccessChain | Op::InBoundsAccessChain => (words[2], 0),
            _ => (0, 0),
        };
        let variables = self.variables;
        let Some(place) = variables.pointers.get(&pointer) else {
            self.optimizer.resolve_operands(i);
            out.push(i);
            return;
        };
        let (leaf, kind, rest) = variables.locate(self.optimizer, place);
        match i.op {
            Op::Load => {
                let value = match rest {
                    [] => self.load(block, leaf, kind, out),
                    rest => {
                        let whole = self.read(block, leaf);
                        self.optimizer.extract(whole, rest, out)
                    }
                };
                self.optimizer.replace(last, value);
            }
            Op::Store => {
                let value = self.optimizer.resolve(last);
                match rest {
                    [] => self.store(block, leaf, kind, value, out),
                    rest => {
                        let whole = self.read(block, leaf);
                        let operands = [&[value, whole], rest].concat();
                        let kind = variables.leaves[leaf].kind;
                        *self.value(block, leaf) =
                            self.optimizer.module.emit(out, Op::CompositeInsert, kind, &operands);
                    }
                }
            }
            // Variables and pointers into them are gone.
            _ => {}
        }
    }

    /// The value of all leaves of a type, from the given one on.
    fn load(&mut self, block: usize, leaf: usize, kind: Id, out: &mut Vec<Instruction>) -> Id {
        let Some(parts) = self.optimizer.parts(kind) else { return self.read(block, leaf) };
        let (mut members, mut leaf) = (Vec::new(), leaf);
        for part in parts {
            members.push(self.load(block, leaf, part, out));
            leaf += self.variables.count_of(part);
        }
        self.optimizer.module.emit(out, Op::CompositeConstruct, kind, &members)
    }

    fn store(&mut self, block: usize, leaf: usize, kind: Id, value: Id, out: &mut Vec<Instruction>) {
        let Some(parts) = self.optimizer.parts(kind) else {
            *self.value(block, leaf) = value;
            return;
        };
        let mut leaf = leaf;
        for (index, part) in (0..).zip(parts) {
            let member = self.optimizer.extract(value, &[index], out);
            self.store(block, leaf, part, member, out);
            leaf += self.variables.count_of(part);
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
                let optimizer = &mut *self.optimizer;
                phis.retain_mut(|(phi, operands)| {
                    let mut others =
                        operands.iter().map(|(value, _)| optimizer.resolve(*value)).filter(|value| value != phi);
                    let first = others.next();
                    match first {
                        Some(value) if others.all(|other| other == value) => {
                            drop(others);
                            optimizer.replace(*phi, value);
                            is_changed = true;
                            false
                        }
                        _ => true,
                    }
                });
            }
        }
        let optimizer = self.optimizer;
        let mut write = |(phi, operands): (Id, Operands)| {
            let pairs = operands.into_iter().flat_map(|(value, from)| [optimizer.resolve(value), labels[from]]);
            let pairs: Vec<u32> = pairs.collect();
            let head = [optimizer.module.type_of(phi), phi];
            optimizer.module.make(Op::Phi, &[&head, &*pairs].concat())
        };
        self.phis.into_iter().map(|phis| phis.into_iter().map(&mut write).collect()).collect()
    }
}
