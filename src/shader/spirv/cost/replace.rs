//! The module that records, and the module without a function.

use foldhash::HashSet;

use super::parameters::{WrittenPart, parameters, value_type};
use super::{Names, StageFunction, by_id, groups, numbers};
use crate::shader::spirv::fold::drop_results;
use crate::shader::spirv::module::{Block, Id, Instruction, Module};
use crate::shader::spirv::op::Op;

/// The module without lines, in which the functions count their calls and keep what they return. `functions` are those of this module, or
/// of one with the same functions. `None` if the module lacks a name.
pub fn recording(words: &[u32], functions: &[StageFunction], names: &Names<'_>) -> Option<Vec<u32>> {
    let mut module = Module::parse(words)?;
    let (first, count_of_groups) = groups(functions);
    let named = |name: &str, at: u32| module.named(&format!("{name}{at}\0")).next();
    let counts = (0..=functions.len() as u32).map(|at| named(names.count, at)).collect::<Option<Vec<Id>>>()?;
    let values = (0..count_of_groups).map(|at| named(names.values, at)).collect::<Option<Vec<Id>>>()?;
    let known = by_id(functions);
    let mut all = std::mem::take(&mut module.functions);
    for function in &mut all {
        let Some((at, of)) = known.get(&function.id).filter(|(_, of)| of.lack.is_none()) else { continue };
        let parameters: Vec<Id> = parameters(&module, function).collect();
        for block in &mut function.blocks {
            let Some(end) = block.end().filter(|end| matches!(end.op, Op::Return | Op::ReturnValue)) else { continue };
            let mut out: Vec<Instruction> = block.body[..block.body.len() - 1].to_vec();
            let returned = (end.op == Op::ReturnValue).then(|| module[end][1]);
            count(&mut module, &mut out, counts[at + 1]);
            keep(&mut module, &mut out, &values[first[*at] as usize..], (of, &parameters), returned);
            out.push(end);
            block.body = out;
        }
    }
    module.functions = all;
    Some(without_lines(module))
}

/// The module without lines and without the body of one of its functions, which returns the numbers of the buffer from this group on.
/// With `None`, the module as it is. `None` if the module lacks a name.
pub fn without(words: &[u32], function: Option<(&StageFunction, u32)>, names: &Names<'_>) -> Option<Vec<u32>> {
    let mut module = Module::parse(words)?;
    let read = module.named(&format!("{}(", names.read)).next()?;
    if let Some((of, first)) = function {
        let place = module.functions.iter().position(|known| known.id == of.id)?;
        let mut taken = module.functions.remove(place);
        taken.head.retain(|i| !is_line(*i));
        let parameters: Vec<Id> = parameters(&module, &taken).collect();
        let label = taken.blocks.first().map(|block| block.label)?;
        let returned = taken.returns(&module);
        let body = taken.body().filter_map(|i| module.result(i));
        let removed = taken.blocks.iter().skip(1).map(|block| block.label).chain(body).collect();
        let body = stub(&mut module, (read, first), (of, &parameters), returned);
        taken.blocks = vec![Block { label, body }];
        module.functions.insert(place, taken);
        drop_uncalled(&mut module, removed);
    }
    Some(without_lines(module))
}

/// Reads the numbers, stores those of the parameters that the function writes and returns the others.
fn stub(
    module: &mut Module,
    (read, first): (Id, u32),
    (of, parameters): (&StageFunction, &[Id]),
    returned: Id,
) -> Vec<Instruction> {
    let mut out = Vec::new();
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let uvec4 = module.declare(Op::TypeVector, &[uint, 4]);
    let mut bits = Vec::new();
    for group in 0..of.numbers.div_ceil(4) as u32 {
        let index = module.constant(uint, first + group);
        let four = module.emit(&mut out, Op::FunctionCall, uvec4, &[read, index]);
        bits.extend((0..4).map(|at| module.emit(&mut out, Op::CompositeExtract, uint, &[four, at])));
    }
    let mut bits = bits.into_iter();
    for part in &of.written {
        let Some(pointer) = part.pointer(module, &mut out, parameters) else { continue };
        let kind = value_type(module, module.type_of(pointer));
        let value = numbers::join(module, &mut out, kind, &mut bits);
        let store = module.make(Op::Store, &[pointer, value]);
        out.push(store);
    }
    let end = match module.defined(Op::TypeVoid, returned).is_some() {
        true => module.make(Op::Return, &[]),
        false => {
            let value = numbers::join(module, &mut out, returned, &mut bits);
            module.make(Op::ReturnValue, &[value])
        }
    };
    if let Some(zero) = bits.next().filter(|_| !of.kept.is_empty()) {
        of.kept.iter().for_each(|part| hide(module, &mut out, part, parameters, zero));
    }
    out.push(end);
    out
}

/// Combines the numbers of a part of a parameter with one that is 0, which no compiler knows.
fn hide(module: &mut Module, out: &mut Vec<Instruction>, part: &WrittenPart, parameters: &[Id], zero: Id) {
    let Some(pointer) = part.pointer(module, out, parameters) else { return };
    let kind = value_type(module, module.type_of(pointer));
    let value = module.emit(out, Op::Load, kind, &[pointer]);
    let mut bits = Vec::new();
    numbers::split(module, out, value, &mut bits);
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let hidden: Vec<Id> = bits.into_iter().map(|bits| module.emit(out, Op::BitwiseXor, uint, &[bits, zero])).collect();
    let value = numbers::join(module, out, kind, &mut hidden.into_iter());
    let store = module.make(Op::Store, &[pointer, value]);
    out.push(store);
}

/// Drops the functions that nothing calls any more, and names and decorations of what is gone.
fn drop_uncalled(module: &mut Module, mut removed: HashSet<Id>) {
    let order = module.entry_function().and_then(|entry| module.callees_first(entry)).unwrap_or_default();
    let mut is_called = vec![false; module.functions.len()];
    order.into_iter().for_each(|place| is_called[place] = true);
    for (function, _) in module.functions.iter().zip(&is_called).filter(|(_, is_called)| !**is_called) {
        removed.extend(function.results(module));
        removed.insert(function.id);
    }
    let mut is_called = is_called.into_iter();
    module.functions.retain(|_| is_called.next().unwrap_or(true));
    drop_results(module, &removed);
}

/// Adds 1 to a variable.
fn count(module: &mut Module, out: &mut Vec<Instruction>, variable: Id) {
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let one = module.constant(uint, 1);
    let before = module.emit(out, Op::Load, uint, &[variable]);
    let now = module.emit(out, Op::IAdd, uint, &[before, one]);
    let store = module.make(Op::Store, &[variable, now]);
    out.push(store);
}

/// Keeps what a function has written to its parameters, and what it returns, in variables of four numbers each.
fn keep(
    module: &mut Module,
    out: &mut Vec<Instruction>,
    variables: &[Id],
    (of, parameters): (&StageFunction, &[Id]),
    returned: Option<Id>,
) {
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let uvec4 = module.declare(Op::TypeVector, &[uint, 4]);
    let zero = module.constant(uint, 0);
    let mut bits = Vec::new();
    for part in &of.written {
        let Some(pointer) = part.pointer(module, out, parameters) else { continue };
        let kind = value_type(module, module.type_of(pointer));
        let value = module.emit(out, Op::Load, kind, &[pointer]);
        numbers::split(module, out, value, &mut bits);
    }
    if let Some(value) = returned {
        numbers::split(module, out, value, &mut bits);
    }
    if !of.kept.is_empty() {
        bits.push(zero);
    }
    for (variable, four) in variables.iter().zip(bits.chunks(4)) {
        let mut four = four.to_vec();
        four.resize(4, zero);
        let value = module.emit(out, Op::CompositeConstruct, uvec4, &four);
        let store = module.make(Op::Store, &[*variable, value]);
        out.push(store);
    }
}

fn is_line(i: Instruction) -> bool {
    matches!(i.op, Op::Line | Op::NoLine)
}

/// The words of a module as the passes that follow expect it.
fn without_lines(mut module: Module) -> Vec<u32> {
    module.globals.retain(|i| !is_line(*i));
    module.debug.retain(|i| matches!(i.op, Op::Name | Op::MemberName));
    for function in &mut module.functions {
        function.head.retain(|i| !is_line(*i));
        function.blocks.iter_mut().for_each(|block| block.body.retain(|i| !is_line(*i)));
    }
    module.write()
}
