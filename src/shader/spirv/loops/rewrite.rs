//! Counting loops: their headers count, and the ends of the entry point report.

mod declarations;

use foldhash::HashMap;

use super::Bounds;
use super::place::{name, seed};
use super::plan::Plan;
use super::rounds::{self, Loop};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::specialize::control_flow::{Block, Function};
use crate::shader::spirv::specialize::{HEADER, Id, Instruction, first_function, instruction, instructions, opcode};

/// A module in parts.
pub(super) struct Module {
    header: Vec<u32>,
    pub(super) globals: Vec<Instruction>,
    pub(super) functions: Vec<Function>,
    /// The functions' ids to their places in `functions`.
    pub(super) at: HashMap<Id, usize>,
    /// New types and constants.
    more: Vec<Instruction>,
}

/// The ids that every bounded loop uses.
struct Shared {
    uint: Id,
    boolean: Id,
    /// Counter of rounds, and name of the loop that used them up: private variables.
    counter: Id,
    culprit: Id,
    zero: Id,
    budget: Id,
    half: Id,
    /// One more than the budget: the counter's value once it has been used up.
    over: Id,
}

/// The ids of the buffer that names the loop.
#[derive(Clone, Copy)]
struct Buffer {
    variable: Id,
    /// Type of a pointer to one of its words.
    pointer: Id,
    one: Id,
    two: Id,
}

impl Module {
    pub(super) fn parse(words: &[u32]) -> Option<Self> {
        let all = instructions(words)?;
        let (globals, code) = all.split_at(first_function(&all));
        let functions: Vec<Function> =
            code.split_inclusive(|i| opcode(i) == op::FUNCTION_END).map(Function::parse).collect::<Option<_>>()?;
        Some(Self {
            header: words.get(..HEADER)?.to_vec(),
            globals: globals.iter().map(|i| i.to_vec()).collect(),
            at: functions.iter().enumerate().map(|(at, function)| (function.id, at)).collect(),
            functions,
            more: Vec::new(),
        })
    }

    fn id(&mut self) -> Id {
        self.header[3] += 1;
        self.header[3] - 1
    }

    pub(super) fn bound(&mut self, original: &[u32], bounds: &Bounds) -> Option<Vec<u32>> {
        let value = |i: &&Instruction| opcode(i) == op::CONSTANT && i.len() == 4;
        let constants = self.globals.iter().filter(value).map(|i| (i[2], i[3])).collect();
        let extended = self.globals.iter().find(|i| opcode(i) == op::EXT_INST_IMPORT).map(|i| i[1]);
        let loops: Vec<Vec<Loop>> =
            self.functions.iter().map(|function| rounds::find(function, &constants, extended)).collect();
        let bounded = Plan::new(self, &loops).bounded();
        if bounded.iter().all(Vec::is_empty) {
            return None;
        }
        let seed = seed(original);
        let entry = self.globals.iter().find(|i| opcode(i) == op::ENTRY_POINT)?.clone();
        let main = *self.at.get(entry.get(2)?)?;
        let shared = self.declare(bounds);
        let report = bounds.report.map(|place| self.buffer(&shared, place));
        let mark = bounds.mark.and_then(|color| self.output(&entry).map(|to| (to, self.color(to, color))));
        for (function, bounded) in bounded.iter().enumerate().filter(|(_, bounded)| !bounded.is_empty()) {
            for (index, weight) in bounded {
                self.count(function, &loops[function][*index], *weight, &shared, seed);
            }
            self.return_instead(function)?;
        }
        let named = self.constant(shared.uint, name(seed, 0));
        for function in 0..self.functions.len() {
            self.end(function, function == main, &shared, (report, named), mark);
        }
        self.begin(main, &shared, report, bounds);
        self.join_interface(&entry, &shared, report);
        Some(self.write())
    }

    /// Makes the header of a loop count rounds and leave the loop once the budget is used up. The merge block stores
    /// the loop's name if the loop took half of the budget.
    fn count(&mut self, function: usize, of: &Loop, weight: u32, shared: &Shared, seed: u64) {
        let [before, old, new, is_over, rounds, is_past, spent, is_most, culprit, is_first] =
            std::array::from_fn(|_| self.id());
        let [is_it, both, named, clamped] = std::array::from_fn(|_| self.id());
        let weight = self.constant(shared.uint, weight);
        let Shared { uint, boolean, counter, .. } = *shared;
        let blocks = &self.functions[function].blocks;
        let (header, merge) = (blocks[of.header].label, blocks[of.merge].label);
        let own_name = self.constant(uint, name(seed, header));

        // The loop has taken the rounds that were counted since it was entered.
        let start = match of.before {
            Some(block) => {
                let body = &mut self.functions[function].blocks[block].body;
                let merges = body.iter().rev().nth(1).is_some_and(|i| opcode(i) == op::SELECTION_MERGE);
                let end = body.len() - 1 - usize::from(merges);
                body.insert(end, instruction(op::LOAD, &[uint, before, counter]));
                before
            }
            None => shared.zero,
        };

        let body = &mut self.functions[function].blocks[of.header].body;
        let next = body.pop().map_or(header, |branch| branch[1]);
        let merge_instruction = body.pop();
        body.extend([
            instruction(op::LOAD, &[uint, old, counter]),
            instruction(op::IADD, &[uint, new, old, weight]),
            instruction(op::STORE, &[counter, new]),
            instruction(op::UGREATER_THAN, &[boolean, is_over, new, shared.budget]),
        ]);
        body.extend(merge_instruction);
        body.push(instruction(op::BRANCH_CONDITIONAL, &[is_over, merge, next]));

        // The merge block has the header as another predecessor.
        let phis = self.functions[function].blocks[of.merge].body.iter().take_while(|i| opcode(i) == op::PHI).count();
        for at in 0..phis {
            let undefined = self.id();
            let phi = &mut self.functions[function].blocks[of.merge].body[at];
            self.more.push(instruction(op::UNDEF, &[phi[1], undefined]));
            let operands = [&phi[1..], &[undefined, header]].concat();
            *phi = instruction(op::PHI, &operands);
        }
        let code = [
            instruction(op::LOAD, &[uint, rounds, counter]),
            instruction(op::UGREATER_THAN, &[boolean, is_past, rounds, shared.budget]),
            instruction(op::ISUB, &[uint, spent, rounds, start]),
            instruction(op::UGREATER_THAN_EQUAL, &[boolean, is_most, spent, shared.half]),
            instruction(op::LOAD, &[uint, culprit, shared.culprit]),
            instruction(op::IEQUAL, &[boolean, is_first, culprit, shared.zero]),
            instruction(op::LOGICAL_AND, &[boolean, both, is_past, is_most]),
            instruction(op::LOGICAL_AND, &[boolean, is_it, both, is_first]),
            instruction(op::SELECT, &[uint, named, is_it, own_name, culprit]),
            instruction(op::STORE, &[shared.culprit, named]),
            // The counter must not wrap around, however often a counted loop enters this one.
            instruction(op::SELECT, &[uint, clamped, is_past, shared.over, rounds]),
            instruction(op::STORE, &[counter, clamped]),
        ];
        self.functions[function].blocks[of.merge].body.splice(phis..phis, code);
    }

    /// Returns zero where a function ends with `OpUnreachable`: a loop that could only be left by a return is now left
    /// by its budget too.
    fn return_instead(&mut self, function: usize) -> Option<()> {
        let of = *self.functions[function].head.first()?.get(1)?;
        let is_void = self.globals.iter().any(|i| opcode(i) == op::TYPE_VOID && i.get(1) == Some(&of));
        let is_end = |block: &Block| block.body.last().is_some_and(|i| opcode(i) == op::UNREACHABLE);
        if !self.functions[function].blocks.iter().any(is_end) {
            return Some(());
        }
        let end = if is_void {
            instruction(op::RETURN, &[])
        } else {
            let null = self.id();
            self.more.push(instruction(op::CONSTANT_NULL, &[of, null]));
            instruction(op::RETURN_VALUE, &[null])
        };
        for block in self.functions[function].blocks.iter_mut().filter(|block| is_end(block)) {
            block.body.pop();
            block.body.push(end.clone());
        }
        Some(())
    }

    /// Where an invocation ends, writes the name of the loop that used up the budget, and marks the fragment.
    fn end(
        &mut self,
        function: usize,
        is_main: bool,
        shared: &Shared,
        (report, named): (Option<Buffer>, Id),
        mark: Option<(Id, Id)>,
    ) {
        let ends = |block: &Block| match block.body.last().map(|i| opcode(i)) {
            Some(op::RETURN) => is_main && (report.is_some() || mark.is_some()),
            Some(op::KILL | op::TERMINATE_INVOCATION | op::EMIT_MESH_TASKS) => report.is_some(),
            _ => false,
        };
        let mut index = 0;
        while index < self.functions[function].blocks.len() {
            if ends(&self.functions[function].blocks[index]) {
                let Shared { uint, boolean, counter, .. } = *shared;
                let [rounds, is_over, inside, after] = std::array::from_fn(|_| self.id());
                let mut code = report.map(|report| self.name_culprit(shared, report, named)).unwrap_or_default();
                let block = &mut self.functions[function].blocks[index];
                let last: Vec<Instruction> = block.body.pop().into_iter().collect();
                let returns = last.iter().any(|i| opcode(i) == op::RETURN);
                block.body.extend([
                    instruction(op::LOAD, &[uint, rounds, counter]),
                    instruction(op::UGREATER_THAN, &[boolean, is_over, rounds, shared.budget]),
                    instruction(op::SELECTION_MERGE, &[after, 0]),
                    instruction(op::BRANCH_CONDITIONAL, &[is_over, inside, after]),
                ]);
                code.extend(mark.filter(|_| returns).map(|(to, color)| instruction(op::STORE, &[to, color])));
                code.push(instruction(op::BRANCH, &[after]));
                let new = [Block { label: inside, body: code }, Block { label: after, body: last }];
                self.functions[function].blocks.splice(index + 1..index + 1, new);
                index += 2;
            }
            index += 1;
        }
    }

    /// Writes the culprit's name, or the module's, unless another invocation has named a loop before.
    fn name_culprit(&mut self, shared: &Shared, report: Buffer, named: Id) -> Vec<Instruction> {
        let [culprit, is_one, word, value, place, old, flag] = std::array::from_fn(|_| self.id());
        let Shared { uint, boolean, zero, .. } = *shared;
        let Buffer { variable, pointer, one, two, .. } = report;
        vec![
            instruction(op::LOAD, &[uint, culprit, shared.culprit]),
            instruction(op::INOT_EQUAL, &[boolean, is_one, culprit, zero]),
            instruction(op::SELECT, &[uint, word, is_one, zero, one]),
            instruction(op::SELECT, &[uint, value, is_one, culprit, named]),
            instruction(op::ACCESS_CHAIN, &[pointer, place, variable, zero, word]),
            // Scope: device. No order with other memory.
            instruction(op::ATOMIC_COMPARE_EXCHANGE, &[uint, old, place, one, zero, zero, value, zero]),
            instruction(op::ACCESS_CHAIN, &[pointer, flag, variable, zero, two]),
            instruction(op::STORE, &[flag, zero]),
        ]
    }

    /// Sets the counter where the invocation begins.
    fn begin(&mut self, main: usize, shared: &Shared, report: Option<Buffer>, bounds: &Bounds) {
        let mut first = shared.zero;
        let mut code = Vec::new();
        if let Some(report) = report {
            let late = self.constant(shared.uint, bounds.rounds.saturating_sub(bounds.rounds_after));
            let [place, flag, is_late, chosen] = std::array::from_fn(|_| self.id());
            first = chosen;
            code.extend([
                instruction(op::ACCESS_CHAIN, &[report.pointer, place, report.variable, shared.zero, report.two]),
                instruction(op::LOAD, &[shared.uint, flag, place]),
                instruction(op::IEQUAL, &[shared.boolean, is_late, flag, shared.zero]),
                instruction(op::SELECT, &[shared.uint, chosen, is_late, late, shared.zero]),
            ]);
        }
        code.push(instruction(op::STORE, &[shared.counter, first]));
        code.push(instruction(op::STORE, &[shared.culprit, shared.zero]));
        if let Some(block) = self.functions[main].blocks.first_mut() {
            let variables = block.body.iter().take_while(|i| opcode(i) == op::VARIABLE).count();
            block.body.splice(variables..variables, code);
        }
    }

    fn write(&self) -> Vec<u32> {
        let mut out = self.header.clone();
        out.extend(self.globals.iter().chain(&self.more).flatten());
        self.functions.iter().for_each(|function| function.write(&mut out));
        out
    }
}
