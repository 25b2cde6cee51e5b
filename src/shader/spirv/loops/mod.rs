//! Bounds the loops of a module: every invocation counts the rounds of all loops whose end is not plain to see, and leaves them
//! when its budget is used up. On a GPU an endless loop would hang the device, and the process with it.
//!
//! The counter is a private variable, so nested loops and loops in functions share the budget. A loop that takes a small
//! constant number of rounds is left as it is, and so is a module that has no other. When the budget runs out, the invocation
//! names the loop in a storage buffer before it ends.

mod rounds;

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};
use std::cell::RefCell;

use xxhash_rust::xxh3::xxh3_64;

use super::opcode as op;
use super::specialize::control_flow::{Block, Function};
use super::specialize::{HEADER, Id, Instruction, first_function, instruction, instructions, opcode};
use rounds::{Loop, MOST};

/// A counted loop inside a bounded one counts its own rounds too, if it takes more than this many.
const MOST_INSIDE: u64 = 64;
/// The largest number of rounds that one round of a loop counts for.
const MOST_WEIGHT: u64 = 1024;

/// How a module's loops are bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Rounds that an invocation may take in all of its bounded loops together.
    pub rounds: u32,
    /// The same once an invocation has used up its budget, so that one endless loop does not cost the whole budget in every
    /// pixel.
    pub rounds_after: u32,
    /// Descriptor set and binding of the buffer that names the loop: see [`Overrun`]. `None` if the stage cannot write buffers.
    pub report: Option<(u32, u32)>,
    /// Color of a fragment whose loops were cut short.
    pub mark: Option<[f32; 4]>,
}

/// The first two of the three words that a bounded module writes to its buffer; both are 0 at first. The third is 1 at first,
/// and 0 once an invocation has used up its budget. (Mesa's lavapipe reads 0 for helper invocations, and would wait for them.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrun {
    /// The loop that took at least half of an invocation's budget, as [`Place::find`] knows it; 0 if there is none.
    pub one: u32,
    /// A module whose loops used up a budget together; 0 if there is none.
    pub together: u32,
}

/// The loop that an [`Overrun`] names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the loop among all loops of the module before specialization; `None` if several loops used up the budget
    /// together.
    pub number: Option<usize>,
    /// Name of its function in GLSL; empty if it is unknown.
    pub function: String,
}

impl Place {
    /// Finds the loop in a module before specialization. `None` if the overrun is of another module.
    pub fn find(overrun: Overrun, words: &[u32]) -> Option<Self> {
        let seed = seed(words);
        let all = instructions(words)?;
        let (mut label, mut function, mut number) = (0, 0, 0);
        for i in &all {
            match opcode(i) {
                op::FUNCTION => function = *i.get(2)?,
                op::LABEL => label = *i.get(1)?,
                op::LOOP_MERGE => {
                    if overrun.one == name(seed, label) {
                        let names = all.iter().find(|i| opcode(i) == op::NAME && i.get(1) == Some(&function));
                        let text = names.map(|i| text(&i[2..])).unwrap_or_default();
                        // glslang's name has the types of the arguments: `f(vf3;`.
                        let function = text.split('(').next().unwrap_or_default().to_owned();
                        return Some(Self { number: Some(number), function });
                    }
                    number += 1;
                }
                _ => {}
            }
        }
        let is_module = overrun.one == 0 && overrun.together == name(seed, 0);
        is_module.then(|| Self { number: None, function: String::new() })
    }
}

/// File and line of the loop with this number, in a module that was compiled with debug information.
pub fn line_of_loop(words: &[u32], number: usize) -> Option<(String, u32)> {
    let all = instructions(words)?;
    let at = all.iter().enumerate().filter(|(_, i)| opcode(i) == op::LOOP_MERGE).nth(number)?.0;
    let line = all[..at].iter().rev().find(|i| opcode(i) == op::LINE)?;
    let file = all.iter().find(|i| opcode(i) == op::STRING && i.get(1) == line.get(1))?;
    Some((text(&file[2..]), *line.get(2)?))
}

fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Identifies a module before specialization.
fn seed(words: &[u32]) -> u64 {
    xxh3_64(bytemuck::cast_slice(words))
}

/// The number by which a buffer names the loop with this header; 0 names the module.
fn name(seed: u64, header: Id) -> u32 {
    let hash = xxh3_64(&(seed ^ u64::from(header)).to_le_bytes());
    (hash as u32).max(1)
}

/// Bounds the loops of `specialized`, a specialization of the module `original`. Returns whether the module has a loop that
/// needs it; otherwise, and for words that are not valid SPIR-V, the module stays as it is.
pub fn bound(specialized: &mut Vec<u32>, original: &[u32], bounds: &Bounds) -> bool {
    // Most specialized modules have no loop at all.
    let has_loops = instructions(specialized).is_some_and(|all| all.iter().any(|i| opcode(i) == op::LOOP_MERGE));
    let module = has_loops.then(|| Module::parse(specialized)).flatten();
    let rewritten = module.and_then(|mut module| module.bound(original, bounds));
    let is_bounded = rewritten.is_some();
    if let Some(words) = rewritten {
        *specialized = words;
    }
    is_bounded
}

/// A module in parts.
struct Module {
    header: Vec<u32>,
    globals: Vec<Instruction>,
    functions: Vec<Function>,
    /// The functions' ids to their places in `functions`.
    at: HashMap<Id, usize>,
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

impl Module {
    fn parse(words: &[u32]) -> Option<Self> {
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

    fn bound(&mut self, original: &[u32], bounds: &Bounds) -> Option<Vec<u32>> {
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

    /// Counts the rounds of a loop in its header, leaves the loop there when the budget is used up, and notes its name behind it.
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

    /// Returns zero where a function ends with `OpUnreachable`: a loop that could only be left by a return is now left by its
    /// budget too.
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

    /// Where an invocation ends, names the loop that used up the budget and marks the fragment.
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
            Some(op::KILL | op::TERMINATE_INVOCATION) => report.is_some(),
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

    /// The id of a global declaration with these operands behind its result; declares it if it is not there.
    fn global(&mut self, opcode_: u32, operands: &[u32]) -> Id {
        let same = |i: &&Instruction| opcode(i) == opcode_ && i.get(2..) == Some(operands);
        if let Some(i) = self.globals.iter().chain(&self.more).find(same) {
            return i[1];
        }
        let id = self.id();
        self.more.push(instruction(opcode_, &[&[id], operands].concat()));
        id
    }

    fn constant(&mut self, of: Id, bits: u32) -> Id {
        let is_same =
            |i: &&Instruction| opcode(i) == op::CONSTANT && i.get(1) == Some(&of) && i.get(3..) == Some(&[bits]);
        if let Some(i) = self.globals.iter().chain(&self.more).find(is_same) {
            return i[2];
        }
        let id = self.id();
        self.more.push(instruction(op::CONSTANT, &[of, id, bits]));
        id
    }

    fn declare(&mut self, bounds: &Bounds) -> Shared {
        const PRIVATE: u32 = 6;
        let uint = self.global(op::TYPE_INT, &[32, 0]);
        let boolean = self.global(op::TYPE_BOOL, &[]);
        let pointer = self.global(op::TYPE_POINTER, &[PRIVATE, uint]);
        let [counter, culprit] = std::array::from_fn(|_| {
            let id = self.id();
            self.more.push(instruction(op::VARIABLE, &[pointer, id, PRIVATE]));
            id
        });
        Shared {
            uint,
            boolean,
            counter,
            culprit,
            zero: self.constant(uint, 0),
            budget: self.constant(uint, bounds.rounds),
            half: self.constant(uint, bounds.rounds / 2),
            over: self.constant(uint, bounds.rounds + 1),
        }
    }

    /// Declares the buffer that names the loop: `buffer { uint words[3]; }`.
    fn buffer(&mut self, shared: &Shared, (set, binding): (u32, u32)) -> Buffer {
        const STORAGE_BUFFER: u32 = 12;
        let (one, two) = (self.constant(shared.uint, 1), self.constant(shared.uint, 2));
        let three = self.constant(shared.uint, 3);
        let [array, block, to_block, variable] = std::array::from_fn(|_| self.id());
        self.more.extend([
            instruction(op::TYPE_ARRAY, &[array, shared.uint, three]),
            instruction(op::TYPE_STRUCT, &[block, array]),
            instruction(op::TYPE_POINTER, &[to_block, STORAGE_BUFFER, block]),
            instruction(op::VARIABLE, &[to_block, variable, STORAGE_BUFFER]),
        ]);
        let pointer = self.global(op::TYPE_POINTER, &[STORAGE_BUFFER, shared.uint]);
        // ArrayStride, Block, Offset, DescriptorSet, Binding.
        let decorations = [
            instruction(op::DECORATE, &[array, 6, 4]),
            instruction(op::DECORATE, &[block, 2]),
            instruction(op::MEMBER_DECORATE, &[block, 0, 35, 0]),
            instruction(op::DECORATE, &[variable, 34, set]),
            instruction(op::DECORATE, &[variable, 33, binding]),
        ];
        // Decorations come before the first type.
        let is_type = |i: &Instruction| {
            (op::TYPE_VOID..=op::TYPE_POINTER).contains(&opcode(i)) || opcode(i) == op::TYPE_FORWARD_POINTER
        };
        let types = self.globals.iter().position(is_type).unwrap_or(self.globals.len());
        self.globals.splice(types..types, decorations);
        Buffer { variable, pointer, one, two }
    }

    /// The output variable at location 0, if it is a `vec4`.
    fn output(&self, entry: &[u32]) -> Option<Id> {
        const LOCATION: u32 = 30;
        const OUTPUT: u32 = 3;
        let is_first = |id: &Id| {
            let decorated = |i: &Instruction| opcode(i) == op::DECORATE && i.get(1..) == Some(&[*id, LOCATION, 0]);
            let declared = |i: &Instruction| opcode(i) == op::VARIABLE && i[2..] == [*id, OUTPUT];
            self.globals.iter().any(decorated) && self.globals.iter().any(declared) && self.vec4(*id).is_some()
        };
        entry.iter().skip(3).copied().find(is_first)
    }

    /// The type that a variable points to, with the type of its components, if it is a `vec4`.
    fn vec4(&self, variable: Id) -> Option<(Id, Id)> {
        let made = |operation: u32, at: usize, id: Id| {
            self.globals.iter().find(|i| opcode(i) == operation && i.get(at) == Some(&id))
        };
        let pointer = made(op::VARIABLE, 2, variable)?[1];
        let vector = *made(op::TYPE_POINTER, 1, pointer)?.get(3)?;
        let component = made(op::TYPE_VECTOR, 1, vector).filter(|i| i.get(3) == Some(&4))?[2];
        made(op::TYPE_FLOAT, 1, component).map(|_| (vector, component))
    }

    fn color(&mut self, to: Id, color: [f32; 4]) -> Id {
        let id = self.id();
        if let Some((vector, component)) = self.vec4(to) {
            let parts = color.map(|x| self.constant(component, x.to_bits()));
            self.more.push(instruction(op::CONSTANT_COMPOSITE, &[&[vector, id], &parts[..]].concat()));
        }
        id
    }

    /// Lists the new variables in the entry point's interface. A fragment stage that writes a buffer would run its depth test
    /// late; without `discard` and own depth, the early test makes no difference but the time.
    fn join_interface(&mut self, entry: &[u32], shared: &Shared, report: Option<Buffer>) {
        const FRAGMENT: u32 = 4;
        const EARLY_FRAGMENT_TESTS: u32 = 9;
        const DEPTH_REPLACING: u32 = 12;
        const BUILT_IN: u32 = 11;
        const SAMPLE_MASK: u32 = 20;
        let Some(at) = self.globals.iter().position(|i| i == entry) else { return };
        let more = [Some(shared.counter), Some(shared.culprit), report.map(|report| report.variable)];
        let operands: Vec<u32> = entry[1..].iter().copied().chain(more.into_iter().flatten()).collect();
        self.globals[at] = instruction(op::ENTRY_POINT, &operands);
        let blocks = self.functions.iter().flat_map(|function| &function.blocks);
        let mut ends = blocks.filter_map(|block| block.body.last());
        let discards = ends.any(|i| matches!(opcode(i), op::KILL | op::TERMINATE_INVOCATION));
        let changes_test = self.globals.iter().any(|i| match opcode(i) {
            op::EXECUTION_MODE => matches!(i.get(2), Some(&(EARLY_FRAGMENT_TESTS | DEPTH_REPLACING))),
            op::DECORATE => i.get(2..) == Some(&[BUILT_IN, SAMPLE_MASK]),
            _ => false,
        });
        if entry.get(1) == Some(&FRAGMENT) && report.is_some() && !discards && !changes_test {
            self.globals.insert(at + 1, instruction(op::EXECUTION_MODE, &[entry[2], EARLY_FRAGMENT_TESTS]));
        }
    }

    fn write(&self) -> Vec<u32> {
        let mut out = self.header.clone();
        out.extend(self.globals.iter().chain(&self.more).flatten());
        self.functions.iter().for_each(|function| function.write(&mut out));
        out
    }
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

/// Decides which loops count their rounds.
struct Plan<'a> {
    module: &'a Module,
    loops: &'a [Vec<Loop>],
    /// The functions that each loop calls, those of the loops inside it excepted.
    calls: Vec<Vec<Vec<usize>>>,
    /// The functions that each function calls outside of loops.
    calls_outside: Vec<Vec<usize>>,
    /// The rounds of each function's loops, once they are known.
    of_calls: RefCell<HashMap<usize, u64>>,
}

impl<'a> Plan<'a> {
    fn new(module: &'a Module, loops: &'a [Vec<Loop>]) -> Self {
        let mut calls = Vec::new();
        let mut calls_outside = Vec::new();
        for (function, loops) in module.functions.iter().zip(loops) {
            let (mut own, mut outside) = (vec![Vec::new(); loops.len()], Vec::new());
            for (index, block) in function.blocks.iter().enumerate() {
                let around = (0..loops.len()).filter(|at| loops[*at].members.contains(&index));
                let innermost = around.min_by_key(|at| loops[*at].members.len());
                let called = block.body.iter().filter(|i| opcode(i) == op::FUNCTION_CALL && i.len() > 3);
                let called = called.filter_map(|i| module.at.get(&i[3]).copied());
                innermost.map_or(&mut outside, |at| &mut own[at]).extend(called);
            }
            calls.push(own);
            calls_outside.push(outside);
        }
        Self { module, loops, calls, calls_outside, of_calls: RefCell::default() }
    }

    /// The loops that count, for each function, with the rounds that one round of theirs counts for: itself and the counted
    /// loops in it.
    fn bounded(&self) -> Vec<Vec<(usize, u32)>> {
        let mut inside: HashSet<usize> = HashSet::new();
        loop {
            let bounded: Vec<HashSet<usize>> =
                (0..self.loops.len()).map(|function| self.of_function(function, inside.contains(&function))).collect();
            let mut called: HashSet<usize> = inside.clone();
            for (function, own) in bounded.iter().enumerate() {
                let is_within = |at: &usize| own.iter().any(|around| self.contains(function, *around, *at));
                let within = (0..self.loops[function].len()).filter(is_within);
                called.extend(within.flat_map(|at| &self.calls[function][at]));
                if inside.contains(&function) {
                    called.extend(self.calls[function].iter().flatten().chain(&self.calls_outside[function]));
                }
            }
            if called.len() == inside.len() {
                return self.weigh(&bounded);
            }
            inside = called;
        }
    }

    /// Whether a loop is `around` or inside of it.
    fn contains(&self, function: usize, around: usize, at: usize) -> bool {
        self.loops[function][around].members.contains(&self.loops[function][at].header)
    }

    /// The loops of a function that count, where the function is called `inside` another loop that counts or not.
    fn of_function(&self, function: usize, inside: bool) -> HashSet<usize> {
        let loops = &self.loops[function];
        // The outer ones first.
        let mut order: Vec<usize> = (0..loops.len()).filter(|at| self.can_count(function, *at)).collect();
        order.sort_by_key(|at| std::cmp::Reverse(loops[*at].members.len()));
        let mut bounded = HashSet::new();
        for at in order {
            let within = inside || bounded.iter().any(|around| self.contains(function, *around, at));
            let most = if within { MOST_INSIDE } else { MOST };
            if loops[at].rounds.is_none() || self.rounds(function, at) > most {
                bounded.insert(at);
            }
        }
        bounded
    }

    /// Whether the loop's header has the form that glslang gives it.
    fn can_count(&self, function: usize, at: usize) -> bool {
        let blocks = &self.module.functions[function].blocks;
        blocks[self.loops[function][at].header].body.last().is_some_and(|i| opcode(i) == op::BRANCH)
    }

    /// The rounds of a loop with those of the counted loops inside it, however deep.
    fn rounds(&self, function: usize, at: usize) -> u64 {
        let own = &self.loops[function];
        let inner = (0..own.len()).filter(|inner| own[*inner].parent == Some(at));
        let inner: u64 = inner.map(|inner| self.rounds(function, inner)).fold(0, u64::saturating_add);
        let called = self.calls[function][at].iter().map(|called| self.of_call(*called));
        let each = called.fold(inner.saturating_add(1), u64::saturating_add);
        own[at].rounds.unwrap_or(1).saturating_mul(each)
    }

    /// The rounds of the loops of a called function.
    fn of_call(&self, function: usize) -> u64 {
        // GLSL has no recursion, but a module that has it must not end this program: 0 stands until the sum is known.
        let known = self.of_calls.borrow_mut().insert(function, 0);
        if let Some(known) = known {
            self.of_calls.borrow_mut().insert(function, known);
            return known;
        }
        let outermost = (0..self.loops[function].len()).filter(|at| self.loops[function][*at].parent.is_none());
        let loops = outermost.map(|at| self.rounds(function, at));
        let called = self.calls_outside[function].iter().map(|called| self.of_call(*called));
        let sum = loops.chain(called).fold(0, u64::saturating_add);
        self.of_calls.borrow_mut().insert(function, sum);
        sum
    }

    /// The weight of each loop that counts.
    fn weigh(&self, bounded: &[HashSet<usize>]) -> Vec<Vec<(usize, u32)>> {
        let mut known = HashMap::new();
        let mut out = Vec::new();
        for (function, own) in bounded.iter().enumerate() {
            let mut weights = Vec::new();
            for at in own.iter().copied() {
                let plain = self.plain(function, bounded).filter(|i| self.loops[function][*i].parent == Some(at));
                let inner = plain.map(|i| self.rounds(function, i)).fold(1, u64::saturating_add);
                let calls = self.calls[function][at].iter();
                let called = calls.map(|called| self.uncounted(*called, bounded, &mut known));
                // A large weight would end a loop after few rounds.
                weights.push((at, called.fold(inner, u64::saturating_add).min(MOST_WEIGHT) as u32));
            }
            weights.sort_unstable();
            out.push(weights);
        }
        out
    }

    /// The loops of a function that do not count.
    fn plain<'b>(&'b self, function: usize, bounded: &'b [HashSet<usize>]) -> impl Iterator<Item = usize> + 'b {
        (0..self.loops[function].len()).filter(move |at| !bounded[function].contains(at))
    }

    /// The rounds of the loops of a called function that do not count themselves.
    fn uncounted(&self, function: usize, bounded: &[HashSet<usize>], known: &mut HashMap<usize, u64>) -> u64 {
        if let Some(sum) = known.get(&function) {
            return *sum;
        }
        known.insert(function, 0);
        let outermost = self.plain(function, bounded).filter(|at| self.loops[function][*at].parent.is_none());
        let mut sum = outermost.map(|at| self.rounds(function, at)).fold(0, u64::saturating_add);
        for called in &self.calls_outside[function] {
            sum = sum.saturating_add(self.uncounted(*called, bounded, known));
        }
        known.insert(function, sum);
        sum
    }
}

#[cfg(test)]
mod tests;
