//! Specializes a fragment stage for several values of one constant at once. The module computes its color for one value after
//! the other, and writes each color to a target of its own.
//!
//! One draw then shows several debug modes: vertices are processed once, the code that the modes share is compiled once, and code
//! that none of them needs is dropped.
//!
//! The constant, and the constants that depend on it, become private variables. A new entry point sets them in a loop, calls the old
//! one, and keeps its color:
//!
//! ```text
//! for (uint i = 0; i < count; ++i) { MODE = i == 0 ? first : ...; main(); colors[i] = color; }
//! color = colors[0]; color1 = colors[1]; ...
//! ```

use foldhash::{HashMap, HashMapExt, HashSet};

use super::super::operands::is_id;
use super::control_flow::{Block, Function};
use super::{HEADER, Id, Instruction, Known, SPEC_ID, first_function, fold, instruction, instructions, op, opcode};

const SPEC_CONSTANT_COMPOSITE: u32 = 51;
const FRAGMENT: u32 = 4;
const LOCATION: u32 = 30;
const STORAGE_OUTPUT: u32 = 3;
const STORAGE_PRIVATE: u32 = 6;
const STORAGE_FUNCTION: u32 = 7;
/// The first version of SPIR-V whose entry points name private variables.
const NAMES_PRIVATE: u32 = 0x0001_0400;

/// Returns the module with these values for its specialization constants, and with one output for each value in `several` of the
/// constant `open`, at locations 0 and up. `None` if the stage does not depend on the constant in a form that this rewrite knows, or
/// if it has more than one output.
pub fn specialize_several(words: &[u32], values: &[(u32, u32)], open: u32, several: &[u32]) -> Option<Vec<u32>> {
    let all = instructions(words)?;
    let (globals, code) = all.split_at(first_function(&all));
    let mut module = Module::new(words, globals, values, open, several)?;
    let mut functions: Vec<Function> =
        code.split_inclusive(|i| opcode(i) == op::FUNCTION_END).map(Function::parse).collect::<Option<_>>()?;
    let mut removed = HashSet::default();
    functions.iter_mut().for_each(|function| module.drop_cases(function, several, &mut removed));
    fold(&mut functions, &mut module.known, &mut module.globals, removed)?;
    functions.iter_mut().try_for_each(|function| module.load_in(function))?;
    let main = module.main(&functions, several)?;
    let mut out = words[..HEADER].to_vec();
    out[3] = module.bound;
    out.extend(module.globals.iter().flatten());
    functions.iter().for_each(|f| f.write(&mut out));
    out.extend(main.iter().flatten());
    Some(out)
}

/// A constant that depends on the open one.
struct Dependent {
    kind: Id,
    /// The private variable that holds its value.
    variable: Id,
    /// Operation and operands; none for the open constant itself.
    operation: Vec<u32>,
}

/// A module whose open constant is becoming a variable.
struct Module {
    globals: Vec<Instruction>,
    known: Known,
    bound: u32,
    /// The open constant.
    open: Id,
    /// The open constant and its dependents, by their ids as constants.
    dependents: HashMap<Id, Dependent>,
    /// The same ids, in the order of their declarations.
    order: Vec<Id>,
}

impl Module {
    fn new(words: &[u32], all: &[&[u32]], values: &[(u32, u32)], open: u32, several: &[u32]) -> Option<Self> {
        let is_open = |i: &&&[u32]| opcode(i) == op::DECORATE && i.get(2) == Some(&SPEC_ID) && i.get(3) == Some(&open);
        let open_id = *all.iter().find(is_open)?.get(1)?;
        let with = |value: u32| -> Option<(Known, Vec<Instruction>)> {
            let others = values.iter().filter(|(id, _)| *id != open).copied();
            let values: Vec<(u32, u32)> = others.chain([(open, value)]).collect();
            let mut known = Known::default();
            let globals = known.globals(all, &values)?;
            Some((known, globals))
        };
        let (mut known, globals) = with(*several.first()?)?;
        let others = several[1..].iter().map(|value| Some(with(*value)?.0)).collect::<Option<Vec<Known>>>()?;
        let differs = |id: &Id| others.iter().any(|other| other.values.get(id) != known.values.get(id));
        let order: Vec<Id> =
            all.iter().filter(|i| is_specialized(i)).filter_map(|i| i.get(2).copied()).filter(differs).collect();
        // Without a value in the first place, an operation is one that is not evaluated.
        let is_evaluated = order.iter().all(|id| known.values.contains_key(id));
        if !is_evaluated || !order.contains(&open_id) {
            return None;
        }
        known.values.retain(|id, _| !order.contains(id));
        let mut module =
            Self { globals, known, bound: *words.get(3)?, open: open_id, dependents: HashMap::new(), order };
        module.declare(all)?;
        module.add_interface(words, all)?;
        Some(module)
    }

    fn id(&mut self) -> Id {
        self.bound += 1;
        self.bound - 1
    }

    fn add(&mut self, opcode: u32, operands: &[u32]) {
        self.globals.push(instruction(opcode, operands));
    }

    /// Replaces the constants that depend on the open one by private variables.
    fn declare(&mut self, all: &[&[u32]]) -> Option<()> {
        let is_dependent = |id: Option<&Id>| id.is_some_and(|id| self.order.contains(id));
        let declares = |i: &[u32]| matches!(opcode(i), op::CONSTANT | op::CONSTANT_TRUE | op::CONSTANT_FALSE);
        let is_kept = |i: &Instruction| !(declares(i) && is_dependent(i.get(2)));
        let mut globals = std::mem::take(&mut self.globals);
        globals.retain(|i| match opcode(i) {
            op::NAME | op::DECORATE => !is_dependent(i.get(1)),
            _ => is_kept(i),
        });
        if globals.iter().any(|i| opcode(i) == op::VARIABLE && is_dependent(i.get(4))) {
            return None;
        }
        // This may also match a literal; the rewrite is then refused without need.
        let composes = |i: &Instruction| {
            matches!(
                opcode(i),
                op::CONSTANT_COMPOSITE | op::TYPE_ARRAY | op::SPEC_CONSTANT_OP | SPEC_CONSTANT_COMPOSITE
            )
        };
        if globals.iter().any(|i| composes(i) && i[2..].iter().any(|id| self.order.contains(id))) {
            return None;
        }
        self.globals = globals;
        for id in self.order.clone() {
            let declared = all.iter().find(|i| is_specialized(i) && i.get(2) == Some(&id))?;
            let kind = declared[1];
            let (pointer, variable) = (self.id(), self.id());
            self.add(op::TYPE_POINTER, &[pointer, STORAGE_PRIVATE, kind]);
            self.add(op::VARIABLE, &[pointer, variable, STORAGE_PRIVATE]);
            let operation = if id == self.open { Vec::new() } else { declared.get(3..)?.to_vec() };
            self.dependents.insert(id, Dependent { kind, variable, operation });
        }
        Some(())
    }

    /// Adds the private variables to the interface of the entry point, from SPIR-V 1.4 on.
    fn add_interface(&mut self, words: &[u32], all: &[&[u32]]) -> Option<()> {
        let entry = all.iter().find(|i| opcode(i) == op::ENTRY_POINT)?;
        if entry.get(1) != Some(&FRAGMENT) {
            return None;
        }
        if *words.get(1)? >= NAMES_PRIVATE {
            let variables: Vec<Id> = self.order.iter().map(|id| self.dependents[id].variable).collect();
            self.extend_entry(&variables);
        }
        Some(())
    }

    fn extend_entry(&mut self, variables: &[Id]) {
        for i in self.globals.iter_mut().filter(|i| opcode(i) == op::ENTRY_POINT) {
            *i = instruction(op::ENTRY_POINT, &[&i[1..], variables].concat());
        }
    }

    /// Drops the cases of switches on the open constant that it never takes.
    fn drop_cases(&self, function: &mut Function, several: &[u32], removed: &mut HashSet<Id>) {
        for last in function.blocks.iter_mut().filter_map(|block| block.body.last_mut()) {
            if opcode(last) == op::SWITCH && last[1] == self.open {
                let cases = last[3..].chunks_exact(2).filter(|case| several.contains(&case[0])).flatten();
                let operands: Vec<u32> = last[1..3].iter().chain(cases).copied().collect();
                *last = instruction(op::SWITCH, &operands);
            }
        }
        function.drop_unreached(removed);
    }

    /// Loads the variables that a function uses at its beginning, and uses the loaded values.
    fn load_in(&mut self, function: &mut Function) -> Option<()> {
        let mut loads = Vec::new();
        for constant in self.order.clone() {
            let loaded = self.bound;
            let mut is_used = false;
            for i in function.blocks.iter_mut().flat_map(|block| &mut block.body) {
                is_used |= replace(i, constant, loaded)?;
            }
            if is_used {
                self.bound += 1;
                let Dependent { kind, variable, .. } = &self.dependents[&constant];
                loads.push(instruction(op::LOAD, &[*kind, loaded, *variable]));
            }
        }
        let entry = function.blocks.first_mut()?;
        let at = entry.body.iter().rposition(|i| opcode(i) == op::VARIABLE).map_or(0, |last| last + 1);
        entry.body.splice(at..at, loads);
        Some(())
    }

    /// The new entry point. `functions` have the old one.
    fn main(&mut self, functions: &[Function], several: &[u32]) -> Option<Vec<Instruction>> {
        let entry = self.globals.iter().find(|i| opcode(i) == op::ENTRY_POINT)?.clone();
        let old = functions.iter().find(|f| f.id == entry[2])?;
        let head = old.head.first().filter(|i| i.len() == 5)?;
        let (void, signature) = (head[1], head[4]);
        let (output, pointer) = self.only_output()?;
        let color = self.globals.iter().find(|i| opcode(i) == op::TYPE_POINTER && i[1] == pointer)?[3];
        let boolean = *self.globals.iter().find(|i| opcode(i) == op::TYPE_BOOL)?.get(1)?;
        let uint = self.dependents[&self.open].kind;
        let outputs: Vec<Id> = std::iter::once(output).chain((1..several.len()).map(|_| self.id())).collect();
        for (location, output) in outputs.iter().enumerate().skip(1) {
            let decoration = instruction(op::DECORATE, &[*output, LOCATION, location as u32]);
            let first = self.globals.iter().position(|i| opcode(i) == op::DECORATE)?;
            self.globals.insert(first, decoration);
            self.add(op::VARIABLE, &[pointer, *output, STORAGE_OUTPUT]);
        }
        self.extend_entry(&outputs[1..]);
        let main = self.id();
        for i in &mut self.globals {
            match opcode(i) {
                op::ENTRY_POINT => i[2] = main,
                op::EXECUTION_MODE => i[1] = main,
                _ => {}
            }
        }
        let numbers: Vec<Id> = (0..=several.len() as u32).map(|number| self.constant(uint, number)).collect();
        let choices: Vec<Id> = several.iter().map(|value| self.constant(uint, *value)).collect();
        let [array, of_array, of_uint, of_color] = std::array::from_fn(|_| self.id());
        self.add(op::TYPE_ARRAY, &[array, color, *numbers.last()?]);
        self.add(op::TYPE_POINTER, &[of_array, STORAGE_FUNCTION, array]);
        self.add(op::TYPE_POINTER, &[of_uint, STORAGE_FUNCTION, uint]);
        self.add(op::TYPE_POINTER, &[of_color, STORAGE_FUNCTION, color]);

        let [index, colors, begin, header, test, body, next, end] = std::array::from_fn(|_| self.id());
        let block = |label, body| Block { label, body };
        let first = vec![
            instruction(op::VARIABLE, &[of_uint, index, STORAGE_FUNCTION]),
            instruction(op::VARIABLE, &[of_array, colors, STORAGE_FUNCTION]),
            instruction(op::STORE, &[index, numbers[0]]),
            instruction(op::BRANCH, &[header]),
        ];
        let looping = vec![instruction(op::LOOP_MERGE, &[end, next, 0]), instruction(op::BRANCH, &[test])];
        let [tested, goes_on] = [self.id(), self.id()];
        let testing = vec![
            instruction(op::LOAD, &[uint, tested, index]),
            instruction(op::ULESS_THAN, &[boolean, goes_on, tested, *numbers.last()?]),
            instruction(op::BRANCH_CONDITIONAL, &[goes_on, body, end]),
        ];
        let [at, unused, shaded, kept] = std::array::from_fn(|_| self.id());
        let mut round = vec![instruction(op::LOAD, &[uint, at, index])];
        self.choose(&mut round, at, (boolean, uint), (&numbers, &choices))?;
        self.reset(&mut round);
        round.extend([
            instruction(op::FUNCTION_CALL, &[void, unused, entry[2]]),
            instruction(op::LOAD, &[color, shaded, output]),
            instruction(op::ACCESS_CHAIN, &[of_color, kept, colors, at]),
            instruction(op::STORE, &[kept, shaded]),
            instruction(op::BRANCH, &[next]),
        ]);
        let [last, following] = [self.id(), self.id()];
        let advancing = vec![
            instruction(op::LOAD, &[uint, last, index]),
            instruction(op::IADD, &[uint, following, last, numbers[1]]),
            instruction(op::STORE, &[index, following]),
            instruction(op::BRANCH, &[header]),
        ];
        let mut writing = Vec::new();
        for (number, output) in numbers.iter().zip(&outputs) {
            let [from, value] = [self.id(), self.id()];
            writing.push(instruction(op::ACCESS_CHAIN, &[of_color, from, colors, *number]));
            writing.push(instruction(op::LOAD, &[color, value, from]));
            writing.push(instruction(op::STORE, &[*output, value]));
        }
        writing.push(instruction(op::RETURN, &[]));
        let blocks = vec![
            block(begin, first),
            block(header, looping),
            block(test, testing),
            block(body, round),
            block(next, advancing),
            block(end, writing),
        ];
        let function =
            Function { id: main, head: vec![instruction(op::FUNCTION, &[void, main, 0, signature])], blocks };
        let mut words = Vec::new();
        function.write(&mut words);
        Some(vec![words])
    }

    fn constant(&mut self, kind: Id, value: u32) -> Id {
        let id = self.id();
        self.add(op::CONSTANT, &[kind, id, value]);
        id
    }

    /// The variable at location 0 and its type, if the stage has no other.
    fn only_output(&self) -> Option<(Id, Id)> {
        let located: Vec<Id> = self
            .globals
            .iter()
            .filter(|i| opcode(i) == op::DECORATE && i.get(2) == Some(&LOCATION))
            .filter_map(|i| i.get(1).copied())
            .collect();
        let is_output =
            |i: &&Instruction| opcode(i) == op::VARIABLE && i[3] == STORAGE_OUTPUT && located.contains(&i[2]);
        let mut outputs = self.globals.iter().filter(is_output);
        let only = outputs.next()?;
        outputs.next().is_none().then(|| (only[2], only[1]))
    }

    /// Stores the values of the open constant and its dependents in round `at`.
    fn choose(
        &mut self,
        round: &mut Vec<Instruction>,
        at: Id,
        (boolean, uint): (Id, Id),
        (numbers, choices): (&[Id], &[Id]),
    ) -> Option<()> {
        let mut chosen = *choices.last()?;
        for (number, choice) in numbers.iter().zip(&choices[..choices.len() - 1]).rev() {
            let [is_it, value] = [self.id(), self.id()];
            round.push(instruction(op::IEQUAL, &[boolean, is_it, at, *number]));
            round.push(instruction(op::SELECT, &[uint, value, is_it, *choice, chosen]));
            chosen = value;
        }
        let mut values: HashMap<Id, Id> = HashMap::new();
        for id in self.order.clone() {
            let Dependent { kind, variable, operation } = &self.dependents[&id];
            let (kind, variable, operation) = (*kind, *variable, operation.clone());
            let value = match operation.split_first() {
                None => chosen,
                Some((operation, operands)) => {
                    let operands = operands.iter().map(|id| values.get(id).copied().unwrap_or(*id));
                    let result = self.id();
                    let words: Vec<u32> = [kind, result].into_iter().chain(operands).collect();
                    round.push(instruction(*operation, &words));
                    result
                }
            };
            values.insert(id, value);
            round.push(instruction(op::STORE, &[variable, value]));
        }
        Some(())
    }

    /// Gives private variables with an initializer that value again: no round sees what another has written.
    fn reset(&self, round: &mut Vec<Instruction>) {
        let is_initialized = |i: &&Instruction| opcode(i) == op::VARIABLE && i[3] == STORAGE_PRIVATE && i.len() == 5;
        let initialized = self.globals.iter().filter(is_initialized);
        round.extend(initialized.map(|i| instruction(op::STORE, &[i[2], i[4]])));
    }
}

/// Whether an instruction declares a number or boolean that depends on specialization constants.
fn is_specialized(i: &[u32]) -> bool {
    matches!(opcode(i), op::SPEC_CONSTANT | op::SPEC_CONSTANT_OP)
}

/// Replaces an operand of an instruction in a function. Returns whether there was one; `None` if the instruction is unknown.
fn replace(i: &mut Instruction, from: Id, to: Id) -> Option<bool> {
    let mut any = false;
    for at in (1..i.len()).filter(|at| i[*at] == from).collect::<Vec<_>>() {
        if is_id(i, at)? {
            i[at] = to;
            any = true;
        }
    }
    Some(any)
}
