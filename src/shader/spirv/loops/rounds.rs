//! Computes the largest number of rounds that a loop can take, if its own instructions determine it.
//!
//! Expects glslang's unoptimized code: a loop variable lives in memory, the condition is in the block behind the
//! header, and one store per round changes the variable.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::super::opcode as op;
use super::super::specialize::control_flow::Function;
use super::super::specialize::{Id, Instruction, evaluate, opcode};

/// A loop that may take more rounds than this counts as one whose end is unknown.
pub(super) const MOST: u64 = 32_768;
/// How many instructions deep the computation of a value is followed.
const DEPTH: u32 = 16;
const FUNCTION_STORAGE: u32 = 7;

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
}

/// Finds the loops of a function. `constants` are the values of 32-bit constants, `extended` the id of GLSL.std.450.
pub(super) fn find(function: &Function, constants: &HashMap<Id, u32>, extended: Option<Id>) -> Vec<Loop> {
    let blocks = &function.blocks;
    if blocks.iter().all(|block| block.structure().1.is_none()) {
        return Vec::new();
    }
    let at: HashMap<Id, usize> = blocks.iter().enumerate().map(|(index, block)| (block.label, index)).collect();
    let next = |index: usize| blocks[index].targets().into_iter().filter_map(|id| at.get(&id).copied());
    let mut loops = Vec::new();
    for (header, block) in blocks.iter().enumerate() {
        let (Some(merge), Some(continues)) = block.structure() else { continue };
        let (Some(merge), Some(continues)) = (at.get(&merge).copied(), at.get(&continues).copied()) else { continue };
        let (mut members, mut open) = (HashSet::from_iter([header]), vec![header]);
        while let Some(index) = open.pop() {
            open.extend(next(index).filter(|to| *to != merge && members.insert(*to)).collect::<Vec<_>>());
        }
        let mut outside =
            (0..blocks.len()).filter(|from| !members.contains(from) && next(*from).any(|to| to == header));
        let before = outside.next().filter(|_| outside.next().is_none());
        loops.push((Loop { header, merge, before, members, parent: None, rounds: None }, continues));
    }
    for index in 0..loops.len() {
        let header = loops[index].0.header;
        let around = (0..loops.len()).filter(|other| *other != index && loops[*other].0.members.contains(&header));
        loops[index].0.parent = around.min_by_key(|other| loops[*other].0.members.len());
    }
    let values = Values::new(function, constants, extended);
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
    loops.into_iter().zip(rounds).map(|((found, _), rounds)| Loop { rounds, ..found }).collect()
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
    function: &'a Function,
    constants: &'a HashMap<Id, u32>,
    extended: Option<Id>,
    made_by: HashMap<Id, (usize, &'a Instruction)>,
    /// Variables that are only loaded and stored whole.
    stores: HashMap<Id, Vec<Store>>,
}

impl<'a> Values<'a> {
    fn new(function: &'a Function, constants: &'a HashMap<Id, u32>, extended: Option<Id>) -> Self {
        let all = || {
            let of = |(block, b): (usize, &'a super::super::specialize::control_flow::Block)| {
                b.body.iter().enumerate().map(move |(at, i)| (block, at, i))
            };
            function.blocks.iter().enumerate().flat_map(of)
        };
        let mut stores: HashMap<Id, Vec<Store>> = all()
            .filter(|(.., i)| opcode(i) == op::VARIABLE && i.get(3) == Some(&FUNCTION_STORAGE) && i.len() == 4)
            .map(|(.., i)| (i[2], Vec::new()))
            .collect();
        let mut made_by = HashMap::new();
        for (block, at, i) in all() {
            match opcode(i) {
                op::STORE if i.len() >= 3 => {
                    if let Some(to) = stores.get_mut(&i[1]) {
                        to.push(Store { block, at, value: i[2] });
                    }
                }
                op::VARIABLE | op::LOAD => {}
                // Any other use may write the variable. A literal that equals its id only costs precision.
                _ => i[1..].iter().for_each(|word| drop(stores.remove(word))),
            }
            if !op::WITHOUT_RESULT.contains(&opcode(i)) && i.len() > 2 {
                made_by.insert(i[2], (block, i));
            }
        }
        Self { function, constants, extended, made_by, stores }
    }

    /// The largest number of rounds of a loop.
    fn rounds<N: Iterator<Item = usize>>(&self, rounds: &Rounds<'_, impl Fn(usize) -> N>) -> Option<u64> {
        let of = rounds.of;
        // The loop goes on only if the condition in the block behind the header holds.
        let mut test = (rounds.next)(of.header).next()?;
        // `a && b` is a selection around b.
        while let (Some(end), None) = self.function.blocks[test].structure() {
            test = (0..self.function.blocks.len()).find(|at| self.function.blocks[*at].label == end)?;
        }
        let last = self.function.blocks[test].body.last().filter(|i| opcode(i) == op::BRANCH_CONDITIONAL)?;
        let merge = self.function.blocks[of.merge].label;
        let (condition, on) = match (last.get(1)?, last.get(2)? == &merge, last.get(3)? == &merge) {
            (condition, false, true) => (*condition, true),
            (condition, true, false) => (*condition, false),
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
        limits.min().filter(|rounds| *rounds <= MOST)
    }

    /// Adds the conditions that hold if `condition` does: each part of `a && b`.
    fn parts(&self, condition: Id, depth: u32, out: &mut Vec<Id>) {
        let Some((block, i)) = self.made_by.get(&condition).filter(|_| depth > 0) else { return };
        let here = self.function.blocks[*block].label;
        // A branch leads from the block of `a` to here only if `a` is false.
        let is_false = |pair: &[u32]| {
            let from = self.function.blocks.iter().find(|block| pair.get(1) == Some(&block.label));
            let last = from.and_then(|block| block.body.last()).filter(|i| opcode(i) == op::BRANCH_CONDITIONAL);
            last.is_some_and(|i| i.get(1) == pair.first() && i.get(3) == Some(&here) && i.get(2) != Some(&here))
        };
        let parts: Vec<Id> = match opcode(i) {
            op::LOGICAL_AND => i[3..].to_vec(),
            op::PHI if i.len() == 7 && i[3..].chunks(2).any(is_false) => vec![i[3], i[5]],
            _ => return,
        };
        for part in parts {
            out.push(part);
            self.parts(part, depth - 1, out);
        }
    }

    /// Collects the variables that a value is computed of within the loop.
    fn variables(&self, id: Id, of: &Loop, depth: u32, out: &mut HashSet<Id>) {
        let Some((block, i)) = self.made_by.get(&id).filter(|_| depth > 0) else { return };
        if opcode(i) == op::LOAD {
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
            self.constants.get(&last.value).copied()
        });
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
        if let Some(known) = self.constants.get(&id) {
            return Some(*known);
        }
        let (block, i) = self.made_by.get(&id).filter(|_| depth > 0)?;
        if opcode(i) == op::LOAD {
            return (i.get(3) == Some(&variable) && of.members.contains(block)).then_some(is);
        }
        let operand = |at: usize| self.value(*i.get(at)?, variable, is, of, depth - 1);
        let float = |at: usize| operand(at).map(f32::from_bits);
        let int = |at: usize| operand(at).map(u32::cast_signed);
        Some(match opcode(i) {
            129 => (float(3)? + float(4)?).to_bits(),
            131 => (float(3)? - float(4)?).to_bits(),
            133 => (float(3)? * float(4)?).to_bits(),
            136 => (float(3)? / float(4)?).to_bits(),
            134 => operand(3)?.checked_div(operand(4)?)?,
            135 => int(3)?.checked_div(int(4)?)?.cast_unsigned(),
            194 => operand(3)?.checked_shr(operand(4)?)?,
            195 => int(3)?.checked_shr(operand(4)?)?.cast_unsigned(),
            196 => operand(3)?.checked_shl(operand(4)?)?,
            182 => u32::from(float(3)? != float(4)?),
            184 => u32::from(float(3)? < float(4)?),
            186 => u32::from(float(3)? > float(4)?),
            188 => u32::from(float(3)? <= float(4)?),
            190 => u32::from(float(3)? >= float(4)?),
            // All operands of these are ids, and a copy or a conversion keeps the bits.
            124 | 83 => operand(3)?,
            operation => {
                let lookup = |id: Id| self.value(id, variable, is, of, depth - 1);
                evaluate(operation, &i[3..], &lookup)?
            }
        })
    }

    /// The rounds of a loop like `for (uint i = first; i < min(count, 200); ++i)`: the condition compares the variable
    /// with a value of which only a limit is known.
    fn limited(&self, first: Option<u32>, variable: Id, condition: Id, step: Id, of: &Loop) -> Option<u64> {
        let is_variable = |id: &Id| {
            let made = self.made_by.get(id);
            made.is_some_and(|(b, i)| opcode(i) == op::LOAD && i.get(3) == Some(&variable) && of.members.contains(b))
        };
        let (_, i) = self.made_by.get(&condition)?;
        let (left, right) = (i.get(3)?, i.get(4)?);
        // Less and less or equal; greater with the operands exchanged.
        let (limit, signed, equal) = match opcode(i) {
            176 if is_variable(left) => (right, false, 0),
            177 if is_variable(left) => (right, true, 0),
            178 if is_variable(left) => (right, false, 1),
            179 if is_variable(left) => (right, true, 1),
            172 if is_variable(right) => (left, false, 0),
            173 if is_variable(right) => (left, true, 0),
            174 if is_variable(right) => (left, false, 1),
            175 if is_variable(right) => (left, true, 1),
            _ => return None,
        };
        let (_, add) = self.made_by.get(&step).filter(|(_, i)| opcode(i) == op::IADD)?;
        let by = match (add.get(3)?, add.get(4)?) {
            (load, by) if is_variable(load) => self.constants.get(by)?,
            (by, load) if is_variable(load) => self.constants.get(by)?,
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
        (1..=1 << 20).contains(by).then(|| span.div_ceil(u64::from(*by)) + 1)
    }

    /// The largest value of an integer, if it has a limit that is 0 or above.
    fn most(&self, id: Id, signed: bool, depth: u32) -> Option<u32> {
        if let Some(known) = self.constants.get(&id) {
            return Some(if signed { known.cast_signed().max(0).cast_unsigned() } else { *known });
        }
        let (_, i) = self.made_by.get(&id).filter(|_| depth > 0)?;
        let most = |at: usize| self.most(*i.get(at)?, signed, depth - 1);
        let smaller = |a: Option<u32>, b: Option<u32>| a.into_iter().chain(b).min();
        match opcode(i) {
            op::EXT_INST if i.get(3).copied() == self.extended => match (i.get(4)?, signed) {
                // UMin, SMin; UClamp, SClamp.
                (38, false) | (39, true) => smaller(most(5), most(6)),
                (44, false) | (45, true) => most(7),
                _ => None,
            },
            // UMod.
            137 if !signed => most(4)?.checked_sub(1),
            // BitwiseAnd.
            199 if !signed => smaller(most(3), most(4)),
            op::SELECT => Some(most(4)?.max(most(5)?)),
            op::LOAD => {
                let stores = self.stores.get(i.get(3)?).filter(|stores| !stores.is_empty())?;
                let all: Option<Vec<u32>> = stores.iter().map(|s| self.most(s.value, signed, depth / 2)).collect();
                all?.into_iter().max()
            }
            _ => None,
        }
    }
}
