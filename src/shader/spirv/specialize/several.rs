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

use super::single::{constants, set_constants, take_branches};
use crate::shader::spirv::enums::decoration::{LOCATION, SPEC_ID};
use crate::shader::spirv::enums::{model, storage};
use crate::shader::spirv::fold::{drop_results, drop_unreached};
use crate::shader::spirv::module::{Block, Function, Id, Instruction, Module};
use crate::shader::spirv::op::Op;

/// The first version of SPIR-V whose entry points name private variables.
const NAMES_PRIVATE: u32 = 0x0001_0400;

/// Returns the module with these values for its specialization constants, and with one output for each value in `several` of the
/// constant `open`, at locations 0 and up. `None` if the stage does not depend on the constant in a form that this rewrite knows, or
/// if it has more than one output.
pub fn specialize_several(words: &[u32], values: &[(u32, u32)], open: u32, several: &[u32]) -> Option<Vec<u32>> {
    let module = Module::parse(words)?;
    // An instruction that is not known may use the constant.
    let is_known = module.code().all(|i| i.op.is_known());
    if module.model() != Some(model::FRAGMENT) || !is_known {
        return None;
    }
    let mut opened = Opened::new(module, values, open, several)?;
    let mut functions = std::mem::take(&mut opened.module.functions);
    let mut removed = HashSet::default();
    functions.iter_mut().for_each(|function| opened.drop_cases(function, several, &mut removed));
    opened.module.functions = functions;
    take_branches(&mut opened.module, removed)?;
    let mut functions = std::mem::take(&mut opened.module.functions);
    functions.iter_mut().for_each(|function| opened.load_in(function));
    opened.module.functions = functions;
    let main = opened.main(several)?;
    opened.module.functions.push(main);
    Some(opened.module.write())
}

/// A constant that depends on the open one.
struct Dependent {
    id: Id,
    kind: Id,
    /// The private variable that holds its value.
    variable: Id,
    /// Operation and operands; none for the open constant itself.
    operation: Vec<u32>,
}

/// A module whose open constant is becoming a variable.
struct Opened {
    module: Module,
    /// The open constant.
    open: Id,
    /// The open constant and its dependents, in the order of their declarations.
    dependents: Vec<Dependent>,
}

impl Opened {
    fn new(mut module: Module, values: &[(u32, u32)], open: u32, several: &[u32]) -> Option<Self> {
        let open_id = module.decorated(SPEC_ID).find(|id| module.decoration(*id, SPEC_ID) == Some(open))?;
        let with = |value: u32| {
            let others = values.iter().filter(|(id, _)| *id != open).copied();
            constants(&module, &others.chain([(open, value)]).collect::<Vec<_>>())
        };
        let mut known = with(*several.first()?);
        let others: Vec<HashMap<Id, u32>> = several[1..].iter().map(|value| with(*value)).collect();
        let differs = |id: &Id| others.iter().any(|other| other.get(id) != known.get(id));
        let is_specialized = |i: &&Instruction| matches!(i.op, Op::SpecConstant | Op::SpecConstantOp);
        let specialized = module.globals.iter().filter(is_specialized).map(|i| module[*i][2]);
        let order: Vec<Id> = specialized.filter(differs).collect();
        // Without a value in the first place, an operation is one that is not evaluated.
        let is_evaluated = order.iter().all(|id| known.contains_key(id));
        if !is_evaluated || !order.contains(&open_id) {
            return None;
        }
        known.retain(|id, _| !order.contains(id));
        set_constants(&mut module, &known);
        let mut opened = Self { module, open: open_id, dependents: Vec::new() };
        opened.declare(&order)?;
        Some(opened)
    }

    /// Replaces the constants that depend on the open one by private variables. `None` if another declaration needs one.
    fn declare(&mut self, order: &[Id]) -> Option<()> {
        let module = &mut self.module;
        let mut globals = std::mem::take(&mut module.globals);
        let is_dependent = |i: &mut Instruction| module.result(*i).is_some_and(|id| order.contains(&id));
        let replaced: Vec<Instruction> = globals.extract_if(.., is_dependent).collect();
        let is_used = |i: &Instruction| module.ids_of(*i).any(|id| order.contains(&id));
        if globals.iter().any(is_used) {
            return None;
        }
        module.globals = globals;
        drop_results(module, &order.iter().copied().collect());
        for i in replaced {
            let (kind, id) = (module[i][1], module[i][2]);
            let operation = if id == self.open { Vec::new() } else { module[i][3..].to_vec() };
            let pointer = module.declare(Op::TypePointer, &[storage::PRIVATE, kind]);
            let variable = module.variable(pointer, storage::PRIVATE);
            self.dependents.push(Dependent { id, kind, variable, operation });
        }
        if module.version() >= NAMES_PRIVATE {
            let variables: Vec<Id> = self.dependents.iter().map(|dependent| dependent.variable).collect();
            module.join_interface(&variables);
        }
        Some(())
    }

    /// Drops the cases of switches on the open constant that it never takes.
    fn drop_cases(&mut self, function: &mut Function, several: &[u32], removed: &mut HashSet<Id>) {
        for last in function.blocks.iter_mut().filter_map(|block| block.body.last_mut()) {
            let words = &self.module[*last];
            if last.op == Op::Switch && words[1] == self.open {
                let cases = words[3..].chunks_exact(2).filter(|case| several.contains(&case[0])).flatten();
                let operands: Vec<u32> = words[1..3].iter().chain(cases).copied().collect();
                *last = self.module.make(Op::Switch, &operands);
            }
        }
        drop_unreached(&mut self.module, function, removed);
    }

    /// Loads the variables that a function uses at its beginning, and uses the loaded values.
    fn load_in(&mut self, function: &mut Function) {
        let mut loads = Vec::new();
        for Dependent { id: constant, kind, variable, .. } in &self.dependents {
            let mut loaded = None;
            for i in function.body() {
                for at in 1..self.module[i].len() {
                    if self.module[i][at] == *constant && i.op.is_id(&self.module[i], at) {
                        let loaded = *loaded.get_or_insert_with(|| self.module.fresh(*kind));
                        self.module[i][at] = loaded;
                    }
                }
            }
            loads.extend(loaded.map(|loaded| self.module.make(Op::Load, &[*kind, loaded, *variable])));
        }
        if let Some(entry) = function.blocks.first_mut() {
            let at = entry.body.iter().rposition(|i| i.op == Op::Variable).map_or(0, |last| last + 1);
            entry.body.splice(at..at, loads);
        }
    }

    /// The new entry point, which calls the old one.
    fn main(&mut self, several: &[u32]) -> Option<Function> {
        let (output, pointer) = self.only_output()?;
        let m = &mut self.module;
        let called = m.entry_function()?;
        let old = m.functions.iter().find(|function| function.id == called)?.head[0];
        let (void, signature) = (m[old][1], m[old][4]);
        let (_, color) = m.pointer(pointer)?;
        let boolean = m.declare(Op::TypeBool, &[]);
        let uint = self.dependents.iter().find(|dependent| dependent.id == self.open)?.kind;
        let mut outputs = vec![output];
        for location in 1..several.len() as u32 {
            let output = m.variable(pointer, storage::OUTPUT);
            m.decorate(&[output, LOCATION, location]);
            outputs.push(output);
        }
        m.join_interface(&outputs[1..]);
        let [main, begin, header, test, round, next, end] = m.ids();
        for i in m.head.clone() {
            match i.op {
                Op::EntryPoint => m[i][2] = main,
                Op::ExecutionMode => m[i][1] = main,
                _ => {}
            }
        }
        let numbers: Vec<Id> = (0..=several.len() as u32).map(|number| m.constant(uint, number)).collect();
        let choices: Vec<Id> = several.iter().map(|value| m.constant(uint, *value)).collect();
        let count = *numbers.last()?;
        let array = m.declare(Op::TypeArray, &[color, count]);
        let [of_array, of_uint, of_color] =
            [array, uint, color].map(|kind| m.declare(Op::TypePointer, &[storage::FUNCTION, kind]));

        let mut body = Vec::new();
        let index = m.emit(&mut body, Op::Variable, of_uint, &[storage::FUNCTION]);
        let colors = m.emit(&mut body, Op::Variable, of_array, &[storage::FUNCTION]);
        body.push(m.make(Op::Store, &[index, numbers[0]]));
        body.push(m.make(Op::Branch, &[header]));
        let mut blocks = vec![Block { label: begin, body }];

        let body = vec![m.make(Op::LoopMerge, &[end, next, 0]), m.make(Op::Branch, &[test])];
        blocks.push(Block { label: header, body });

        let mut body = Vec::new();
        let tested = m.emit(&mut body, Op::Load, uint, &[index]);
        let goes_on = m.emit(&mut body, Op::ULessThan, boolean, &[tested, count]);
        body.push(m.make(Op::BranchConditional, &[goes_on, round, end]));
        blocks.push(Block { label: test, body });

        let mut body = Vec::new();
        let at = m.emit(&mut body, Op::Load, uint, &[index]);
        choose(m, &mut body, at, &self.dependents, (boolean, uint), (&numbers, &choices))?;
        reset(m, &mut body);
        m.emit(&mut body, Op::FunctionCall, void, &[called]);
        let shaded = m.emit(&mut body, Op::Load, color, &[output]);
        let kept = m.emit(&mut body, Op::AccessChain, of_color, &[colors, at]);
        body.push(m.make(Op::Store, &[kept, shaded]));
        body.push(m.make(Op::Branch, &[next]));
        blocks.push(Block { label: round, body });

        let mut body = Vec::new();
        let last = m.emit(&mut body, Op::Load, uint, &[index]);
        let following = m.emit(&mut body, Op::IAdd, uint, &[last, numbers[1]]);
        body.push(m.make(Op::Store, &[index, following]));
        body.push(m.make(Op::Branch, &[header]));
        blocks.push(Block { label: next, body });

        let mut body = Vec::new();
        for (number, output) in numbers.iter().zip(&outputs) {
            let from = m.emit(&mut body, Op::AccessChain, of_color, &[colors, *number]);
            let value = m.emit(&mut body, Op::Load, color, &[from]);
            body.push(m.make(Op::Store, &[*output, value]));
        }
        body.push(m.make(Op::Return, &[]));
        blocks.push(Block { label: end, body });
        Some(Function { id: main, head: vec![m.make(Op::Function, &[void, main, 0, signature])], blocks })
    }

    /// The variable at location 0 and its type, if the stage has no other.
    fn only_output(&self) -> Option<(Id, Id)> {
        let module = &self.module;
        let is_output = |i: &&[u32]| i[3] == storage::OUTPUT && module.decoration(i[2], LOCATION).is_some();
        let variables = module.globals.iter().filter(|i| i.op == Op::Variable).map(|i| &module[*i]);
        let mut outputs = variables.filter(is_output);
        let only = outputs.next()?;
        outputs.next().is_none().then(|| (only[2], only[1]))
    }
}

/// Stores the values of the open constant and its dependents in round `at`.
fn choose(
    module: &mut Module,
    round: &mut Vec<Instruction>,
    at: Id,
    dependents: &[Dependent],
    (boolean, uint): (Id, Id),
    (numbers, choices): (&[Id], &[Id]),
) -> Option<()> {
    let mut chosen = *choices.last()?;
    for (number, choice) in numbers.iter().zip(&choices[..choices.len() - 1]).rev() {
        let is_it = module.emit(round, Op::IEqual, boolean, &[at, *number]);
        chosen = module.emit(round, Op::Select, uint, &[is_it, *choice, chosen]);
    }
    let mut values: HashMap<Id, Id> = HashMap::new();
    for Dependent { id, kind, variable, operation } in dependents {
        let value = match operation.split_first() {
            None => chosen,
            Some((operation, operands)) => {
                let operands: Vec<u32> = operands.iter().map(|id| values.get(id).copied().unwrap_or(*id)).collect();
                module.emit(round, Op::of(*operation), *kind, &operands)
            }
        };
        values.insert(*id, value);
        round.push(module.make(Op::Store, &[*variable, value]));
    }
    Some(())
}

/// Gives private variables with an initializer that value again: no round sees what another has written.
fn reset(module: &mut Module, round: &mut Vec<Instruction>) {
    for place in 0..module.globals.len() {
        let i = module.globals[place];
        if let (Op::Variable, &[_, _, variable, storage::PRIVATE, value]) = (i.op, &module[i]) {
            round.push(module.make(Op::Store, &[variable, value]));
        }
    }
}
