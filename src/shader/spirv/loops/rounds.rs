//! Computes the largest number of rounds that a loop can take, if its own instructions determine it.
//!
//! Expects glslang's unoptimized code: a loop variable lives in memory, the condition is in the block behind the
//! header, and one store per round changes the variable.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use crate::shader::spirv::enums::{extended, storage};
use crate::shader::spirv::evaluate::evaluate;
use crate::shader::spirv::module::{Function, Id, Module};
use crate::shader::spirv::op::Op;

/// A loop that may take more rounds than this counts as one whose end is unknown.
pub(super) const MOST: u64 = 32_768;
/// How many instructions deep the computation of a value is followed.
const DEPTH: u32 = 16;

/// A loop of a function. Blocks are given by their index.
#[derive(Debug)]
pub(super) struct Loop {
    pub(super) header: usize,
    pub(super) merge: usize,
    /// The only block outside of the loop that leads to the header, if there is one.
    pub(super) before: Option<usize>,
    /// The blocks of the loop, with those of the loops inside it.
    pub(super) members: HashSet<usize>,
    /// The innermost loop around it.
    pub(super) parent: Option<usize>,
    /// The largest number of rounds; `None` if it is unknown or above [`MOST`].
    pub(super) rounds: Option<u64>,
    /// Whether the loop ends, though it may take more than [`MOST`] rounds.
    pub(super) is_finite: bool,
}

/// Finds the loops of a function of a module.
pub(super) fn find(module: &Module, function: &Function) -> Vec<Loop> {
    let blocks = &function.blocks;
    if blocks.iter().all(|block| block.structure(module).1.is_none()) {
        return Vec::new();
    }
    let at: HashMap<Id, usize> = blocks.iter().enumerate().map(|(index, block)| (block.label, index)).collect();
    let next = |index: usize| blocks[index].targets(module).filter_map(|id| at.get(&id).copied());
    let mut loops = Vec::new();
    for (header, block) in blocks.iter().enumerate() {
        let (Some(merge), Some(continues)) = block.structure(module) else { continue };
        let (Some(merge), Some(continues)) = (at.get(&merge).copied(), at.get(&continues).copied()) else { continue };
        let (mut members, mut open) = (HashSet::from_iter([header]), vec![header]);
        while let Some(index) = open.pop() {
            open.extend(next(index).filter(|to| *to != merge && members.insert(*to)).collect::<Vec<_>>());
        }
        let mut outside =
            (0..blocks.len()).filter(|from| !members.contains(from) && next(*from).any(|to| to == header));
        let before = outside.next().filter(|_| outside.next().is_none());
        loops.push((Loop { header, merge, before, members, parent: None, rounds: None, is_finite: false }, continues));
    }
    for index in 0..loops.len() {
        let header = loops[index].0.header;
        let around = (0..loops.len()).filter(|other| *other != index && loops[*other].0.members.contains(&header));
        loops[index].0.parent = around.min_by_key(|other| loops[*other].0.members.len());
    }
    let values = Values::new(module, function);
    let rounds: Vec<Option<u64>> = loops
        .iter()
        .map(|(of, continues)| {
            let inner = loops
                .iter()
                .filter(|(other, _)| other.header != of.header && of.members.contains(&other.header))
                .flat_map(|(other, _)| other.members.iter().copied())
                .collect();
            values.rounds(&Rounds { of, continues: *continues, inner, next: &next })
        })
        .collect();
    let known = |((found, _), rounds): ((Loop, usize), Option<u64>)| {
        let (is_finite, rounds) = (rounds.is_some(), rounds.filter(|rounds| *rounds <= MOST));
        Loop { rounds, is_finite, ..found }
    };
    loops.into_iter().zip(rounds).map(known).collect()
}

/// The ways through one round of a loop.
struct Rounds<'a, F> {
    of: &'a Loop,
    /// The block that leads back to the header.
    continues: usize,
    /// The blocks of the loops inside it.
    inner: HashSet<usize>,
    /// The successors of a block.
    next: &'a F,
}

impl<N: Iterator<Item = usize>, F: Fn(usize) -> N> Rounds<'_, F> {
    /// Whether every round passes a block: without it, the continue block cannot be reached.
    fn pass(&self, block: usize) -> bool {
        let (mut seen, mut open) = (HashSet::from_iter([self.of.header]), vec![self.of.header]);
        while let Some(index) = open.pop().filter(|_| block != self.continues) {
            let ways = (self.next)(index).filter(|to| *to != block && *to != self.of.merge && seen.insert(*to));
            open.extend(ways.collect::<Vec<_>>());
        }
        !seen.contains(&self.continues)
    }
}

/// A store to a variable: its block, its place there, and the stored value.
#[derive(Clone, Copy)]
struct Store {
    block: usize,
    at: usize,
    value: Id,
}

/// The instructions of a function by result, and the stores to its variables.
struct Values<'a> {
    module: &'a Module,
    function: &'a Function,
    /// The operation and the words of each result, and the block.
    made_by: HashMap<Id, (usize, Op, &'a [u32])>,
    /// Variables that are only loaded and stored whole.
    stores: HashMap<Id, Vec<Store>>,
    /// Their initial values.
    initial: HashMap<Id, Id>,
}

impl<'a> Values<'a> {
    fn new(module: &'a Module, function: &'a Function) -> Self {
        let all = || {
            let blocks = function.blocks.iter().enumerate();
            blocks.flat_map(|(block, b)| b.body.iter().enumerate().map(move |(at, i)| (block, at, i.op, &module[*i])))
        };
        let is_local = |(.., op, i): &(usize, usize, Op, &[u32])| *op == Op::Variable && i[3] == storage::FUNCTION;
        let initial = all().filter(is_local).filter_map(|(.., i)| Some((i[2], *i.get(4)?))).collect();
        let mut stores: HashMap<Id, Vec<Store>> = all().filter(is_local).map(|(.., i)| (i[2], Vec::new())).collect();
        let mut made_by = HashMap::new();
        for (block, at, op, i) in all() {
            match op {
                Op::Store => {
                    if let Some(to) = stores.get_mut(&i[1]) {
                        to.push(Store { block, at, value: i[2] });
                    }
                }
                Op::Variable | Op::Load => {}
                // Any other use may write the variable. A literal that equals its id only costs precision.
                _ => i[1..].iter().for_each(|word| drop(stores.remove(word))),
            }
            if op.has_type() && i.len() > 2 {
                made_by.insert(i[2], (block, op, i));
            }
        }
        Self { module, function, made_by, stores, initial }
    }

    /// The largest number of rounds of a loop.
    fn rounds<N: Iterator<Item = usize>>(&self, rounds: &Rounds<'_, impl Fn(usize) -> N>) -> Option<u64> {
        let of = rounds.of;
        // The loop goes on only if the condition in the block behind the header holds.
        let mut test = (rounds.next)(of.header).next()?;
        // `a && b` is a selection around b.
        while let (Some(end), None) = self.function.blocks[test].structure(self.module) {
            test = (0..self.function.blocks.len()).find(|at| self.function.blocks[*at].label == end)?;
        }
        let last = self.function.blocks[test].end().filter(|i| i.op == Op::BranchConditional)?;
        let (last, merge) = (&self.module[last], self.function.blocks[of.merge].label);
        let (condition, on) = match (last[1], last[2] == merge, last[3] == merge) {
            (condition, false, true) => (condition, true),
            (condition, true, false) => (condition, false),
            _ => return None,
        };
        let mut conditions = vec![condition];
        if on {
            self.parts(condition, DEPTH, &mut conditions);
        }
        let limits = conditions.into_iter().filter_map(|condition| {
            let mut variables = HashSet::new();
            self.variables(condition, of, DEPTH, &mut variables);
            variables.into_iter().filter_map(|v| self.counted(v, condition, on, rounds)).min()
        });
        limits.min()
    }

    /// Adds the conditions that hold if `condition` does: each part of `a && b`.
    fn parts(&self, condition: Id, depth: u32, out: &mut Vec<Id>) {
        let Some((block, op, i)) = self.made_by.get(&condition).filter(|_| depth > 0) else { return };
        let here = self.function.blocks[*block].label;
        // A branch leads from the block of `a` to here only if `a` is false.
        let is_false = |pair: &[u32]| {
            let from = self.function.blocks.iter().find(|block| pair.get(1) == Some(&block.label));
            let last = from.and_then(|block| block.end()).filter(|i| i.op == Op::BranchConditional);
            let last = last.map(|i| &self.module[i]);
            last.is_some_and(|i| Some(&i[1]) == pair.first() && i[3] == here && i[2] != here)
        };
        let parts: Vec<Id> = match op {
            Op::LogicalAnd => i[3..].to_vec(),
            Op::Phi if i.len() == 7 && i[3..].chunks(2).any(is_false) => vec![i[3], i[5]],
            _ => return,
        };
        for part in parts {
            out.push(part);
            self.parts(part, depth - 1, out);
        }
    }

    /// Collects the variables that a value is computed of within the loop.
    fn variables(&self, id: Id, of: &Loop, depth: u32, out: &mut HashSet<Id>) {
        let Some((block, op, i)) = self.made_by.get(&id).filter(|_| depth > 0) else { return };
        if *op == Op::Load {
            out.extend(i.get(3).filter(|v| of.members.contains(block) && self.stores.contains_key(*v)));
        } else {
            i[3..].iter().for_each(|operand| self.variables(*operand, of, depth - 1, out));
        }
    }

    /// The number of rounds of a loop whose condition depends on `variable`, if one store per round changes it.
    fn counted<N: Iterator<Item = usize>>(
        &self,
        variable: Id,
        condition: Id,
        on: bool,
        rounds: &Rounds<'_, impl Fn(usize) -> N>,
    ) -> Option<u64> {
        let of = rounds.of;
        let stores = self.stores.get(&variable)?;
        let mut within = stores.iter().filter(|store| of.members.contains(&store.block));
        let step = within.next().filter(|store| !rounds.inner.contains(&store.block))?;
        if within.next().is_some() || !rounds.pass(step.block) {
            return None;
        }
        let first = of.before.and_then(|before| {
            let last = stores.iter().filter(|store| store.block == before).max_by_key(|store| store.at)?;
            self.module.number(last.value)
        });
        // A loop that runs once and alone changes the variable begins with the initial value.
        let is_alone = || of.parent.is_none() && stores.len() == 1;
        let first = first.or_else(|| self.module.number(*self.initial.get(&variable).filter(|_| is_alone())?));
        let limited = self.limited(first, variable, condition, step.value, of).filter(|_| on);
        limited.or_else(|| self.run(first?, variable, condition, on, step.value, of))
    }

    /// Runs the loop's condition and step from a known first value.
    fn run(&self, first: u32, variable: Id, condition: Id, on: bool, step: Id, of: &Loop) -> Option<u64> {
        let mut value = first;
        for round in 0..=MOST {
            if (self.value(condition, variable, value, of, DEPTH)? != 0) != on {
                return Some(round + 1);
            }
            value = self.value(step, variable, value, of, DEPTH)?;
        }
        None
    }

    /// The bits of a value, given that of the loop's variable.
    fn value(&self, id: Id, variable: Id, is: u32, of: &Loop, depth: u32) -> Option<u32> {
        if let Some(known) = self.number(id) {
            return Some(known);
        }
        let (block, op, i) = self.made_by.get(&id).filter(|_| depth > 0)?;
        if *op == Op::Load {
            return (i.get(3) == Some(&variable) && of.members.contains(block)).then_some(is);
        }
        let operand = |at: usize| self.value(*i.get(at)?, variable, is, of, depth - 1);
        let float = |at: usize| operand(at).map(f32::from_bits);
        let int = |at: usize| operand(at).map(u32::cast_signed);
        Some(match op {
            Op::FAdd => (float(3)? + float(4)?).to_bits(),
            Op::FSub => (float(3)? - float(4)?).to_bits(),
            Op::FMul => (float(3)? * float(4)?).to_bits(),
            Op::FDiv => (float(3)? / float(4)?).to_bits(),
            Op::UDiv => operand(3)?.checked_div(operand(4)?)?,
            Op::SDiv => int(3)?.checked_div(int(4)?)?.cast_unsigned(),
            Op::ShiftRightLogical => operand(3)?.checked_shr(operand(4)?)?,
            Op::ShiftRightArithmetic => int(3)?.checked_shr(operand(4)?)?.cast_unsigned(),
            Op::ShiftLeftLogical => operand(3)?.checked_shl(operand(4)?)?,
            Op::FOrdNotEqual => u32::from(float(3)? != float(4)?),
            Op::FOrdLessThan => u32::from(float(3)? < float(4)?),
            Op::FOrdGreaterThan => u32::from(float(3)? > float(4)?),
            Op::FOrdLessThanEqual => u32::from(float(3)? <= float(4)?),
            Op::FOrdGreaterThanEqual => u32::from(float(3)? >= float(4)?),
            // A copy or a conversion keeps the bits.
            Op::Bitcast | Op::CopyObject => operand(3)?,
            op => {
                let lookup = |id: Id| self.value(id, variable, is, of, depth - 1);
                evaluate(*op, &i[3..], &lookup)?
            }
        })
    }

    /// The rounds of a loop like `for (uint i = first; i < min(count, 200); ++i)`: the condition compares the variable
    /// with a value of which only a limit is known.
    fn limited(&self, first: Option<u32>, variable: Id, condition: Id, step: Id, of: &Loop) -> Option<u64> {
        let is_variable = |id: &Id| {
            let made = self.made_by.get(id);
            made.is_some_and(|(b, op, i)| *op == Op::Load && i[3] == variable && of.members.contains(b))
        };
        let (_, op, i) = self.made_by.get(&condition)?;
        let (left, right) = (i.get(3)?, i.get(4)?);
        // Less and less or equal; greater with the operands exchanged.
        let (limit, signed, equal) = match op {
            Op::ULessThan if is_variable(left) => (right, false, 0),
            Op::SLessThan if is_variable(left) => (right, true, 0),
            Op::ULessThanEqual if is_variable(left) => (right, false, 1),
            Op::SLessThanEqual if is_variable(left) => (right, true, 1),
            Op::UGreaterThan if is_variable(right) => (left, false, 0),
            Op::SGreaterThan if is_variable(right) => (left, true, 0),
            Op::UGreaterThanEqual if is_variable(right) => (left, false, 1),
            Op::SGreaterThanEqual if is_variable(right) => (left, true, 1),
            _ => return None,
        };
        let (.., add) = self.made_by.get(&step).filter(|(_, op, _)| *op == Op::IAdd)?;
        let by = match (&add[3], &add[4]) {
            (load, by) if is_variable(load) => self.number(*by)?,
            (by, load) if is_variable(load) => self.number(*by)?,
            _ => return None,
        };
        let limit = u64::from(self.most(*limit, signed, DEPTH).filter(|most| *most <= 1 << 30)?);
        let first = match (signed, first) {
            (true, first) => i64::from(first?.cast_signed()),
            // An unsigned variable starts at 0 or above.
            (false, first) => i64::from(first.unwrap_or(0)),
        };
        let span = (limit.cast_signed() + equal - first).max(0).cast_unsigned();
        // The header runs once more than the body.
        (1..=1 << 20).contains(&by).then(|| span.div_ceil(u64::from(by)) + 1)
    }

    /// The largest value of an integer, if it has a limit that is 0 or above.
    fn most(&self, id: Id, signed: bool, depth: u32) -> Option<u32> {
        if let Some(known) = self.number(id) {
            return Some(if signed { known.cast_signed().max(0).cast_unsigned() } else { known });
        }
        let (_, op, i) = self.made_by.get(&id).filter(|_| depth > 0)?;
        let most = |at: usize| self.most(*i.get(at)?, signed, depth - 1);
        let smaller = |a: Option<u32>, b: Option<u32>| a.into_iter().chain(b).min();
        match op {
            Op::ExtInst => match (i[4], signed) {
                (extended::UMIN, false) | (extended::SMIN, true) => smaller(most(5), most(6)),
                (extended::UCLAMP, false) | (extended::SCLAMP, true) => most(7),
                _ => None,
            },
            Op::UMod if !signed => most(4)?.checked_sub(1),
            Op::BitwiseAnd if !signed => smaller(most(3), most(4)),
            Op::Select => Some(most(4)?.max(most(5)?)),
            Op::Load => {
                let stores = self.stores.get(i.get(3)?).filter(|stores| !stores.is_empty())?;
                let all: Option<Vec<u32>> = stores.iter().map(|s| self.most(s.value, signed, depth / 2)).collect();
                all?.into_iter().max()
            }
            _ => None,
        }
    }

    /// The bits of a constant number.
    fn number(&self, id: Id) -> Option<u32> {
        self.module.defined(Op::Constant, id).filter(|words| words.len() == 4).map(|words| words[3])
    }
}
