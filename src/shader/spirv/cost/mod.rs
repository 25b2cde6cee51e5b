//! Replaces functions of a module by the values that they have returned, to measure what they cost.
//!
//! Two modules of a stage belong together. The first records: each function counts its calls in a variable of the module's own text, and keeps
//! the numbers that it returned last in others. The second has one function less: in place of its body, it reads these numbers from a buffer. A
//! plain constant would not do, since the optimizer and the driver would compute all that depends on it once and for all.

mod effects;
mod lack;
mod numbers;
mod parameters;
mod replace;

use std::collections::{BTreeMap, BTreeSet};

use foldhash::HashMap;

use super::module::{Function, Id, Module, Type};
use super::op::{Class, Op, text};
use super::reach::file_of;
use effects::Effects;
pub use lack::Lack;
use parameters::{WrittenPart, parameters, value_type};
pub use replace::{recording, without};

/// Most numbers that a function may return, with what it writes to its parameters.
const MOST_NUMBERS: usize = 64;
/// Words of SPIR-V that read four numbers and make values of them, at most.
const READING: usize = 48;

/// Names of what the module gets from its own text.
pub struct Names<'a> {
    /// The author's `main`, which is the whole stage.
    pub main: &'a str,
    /// Functions and variables whose names begin with this are not the author's.
    pub own: &'a str,
    /// `uvec4 function(const in uint index)`: reads the numbers of the buffer.
    pub read: &'a str,
    /// The names of variables of the numbers of calls begin with this and end with the place of the function in the list, from 1.
    pub count: &'a str,
    /// The names of variables of four numbers each begin with this: see [`groups`].
    pub values: &'a str,
}

/// A function of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageFunction {
    /// Its id in the module.
    id: Id,
    /// Its name with the types of its parameters, as in GLSL.
    pub signature: String,
    /// The file, as the compiler knows it; empty if it has no lines.
    pub file: String,
    /// The first line of its body that has code, from 1.
    pub line: u32,
    /// Why it cannot be replaced.
    pub lack: Option<Lack>,
    /// How many numbers it returns.
    pub numbers: usize,
    /// The parts of its parameters that it writes.
    written: Vec<WrittenPart>,
    /// The parts that are too large to be recorded. Without the function they keep the values of the caller, combined with a number of the
    /// buffer that is 0, so that no compiler knows them.
    kept: Vec<WrittenPart>,
}

impl StageFunction {
    /// The function, which can be replaced, or not for this reason.
    pub fn with_lack(&self, lack: Option<Lack>) -> Self {
        Self { lack, ..self.clone() }
    }
}

/// The functions of a module with line information that are the author's, except for `main`. `None` if the words are no module.
pub fn functions(words: &[u32], names: &Names<'_>) -> Option<Vec<StageFunction>> {
    let module = Module::parse(words)?;
    let entry = module.entry_function()?;
    let order = module.callees_first(entry)?;
    let effects = Effects::of(&module, &order);
    let all = debug_names(&module);
    let is_authors = |function: &&Function| {
        let name = all.get(&function.id).map(String::as_str).unwrap_or_default();
        function.id != entry && !name.starts_with(names.own) && name.split('(').next() != Some(names.main)
    };
    let functions = order.iter().map(|place| &module.functions[*place]).filter(is_authors);
    Some(functions.map(|function| describe(&module, function, &effects, &all)).collect())
}

/// The functions that return a constant or are never called in every or any of these specializations of a module.
#[derive(Debug, Default)]
pub struct Known {
    /// In at least one of them, they return a constant.
    constant: BTreeSet<Id>,
    /// How often they stand in one of them once all calls are inlined, at most.
    copies: BTreeMap<Id, usize>,
}

impl Known {
    /// Adds a specialization, whose ids are those of the module.
    pub fn add(&mut self, words: &[u32]) {
        let Some(module) = Module::parse(words) else { return };
        let Some(entry) = module.entry_function() else { return };
        let mut copies: BTreeMap<Id, usize> = BTreeMap::from([(entry, 1)]);
        // Callers first: their copies decide about those of their callees.
        let order = module.callees_first(entry).unwrap_or_default();
        for function in order.into_iter().rev().map(|place| &module.functions[place]) {
            let of_caller = copies.get(&function.id).copied().unwrap_or(0);
            for callee in function.calls(&module) {
                let of_callee = copies.entry(callee).or_default();
                *of_callee = of_callee.saturating_add(of_caller);
            }
            let mut body = function.body().filter(|i| !matches!(i.op, Op::Line | Op::NoLine));
            let first = body.next().filter(|i| i.op == Op::ReturnValue);
            let constant = first.and_then(|i| module.definition(module[i][1]));
            if constant.is_some_and(|i| i.op.class() == Class::Constant) {
                self.constant.insert(function.id);
            }
        }
        for (function, count) in copies {
            let most = self.copies.entry(function).or_default();
            *most = count.max(*most);
        }
    }

    /// Words by which a module without the function may be larger than with it: those that read its results.
    pub fn allowance(&self, function: &StageFunction) -> usize {
        let copies = self.copies.get(&function.id).copied().unwrap_or(0);
        copies.saturating_mul(READING * function.numbers.div_ceil(4).max(1))
    }

    /// Why the cost of a function cannot be measured in these specializations.
    pub fn lack(&self, function: &StageFunction) -> Option<Lack> {
        match function {
            StageFunction { id, .. } if !self.copies.contains_key(id) => Some(Lack::NotCalled),
            StageFunction { id, .. } if self.constant.contains(id) => Some(Lack::Constant),
            StageFunction { lack, .. } => lack.clone(),
        }
    }
}

fn debug_names(module: &Module) -> HashMap<Id, String> {
    let names = module.debug.iter().filter(|i| i.op == Op::Name).map(|i| &module[*i]);
    names.map(|words| (words[1], text(&words[2..]))).collect()
}

fn describe(module: &Module, function: &Function, effects: &Effects, names: &HashMap<Id, String>) -> StageFunction {
    let first = function.body().find(|i| i.op == Op::Line).and_then(|line| file_of(module, &module[line]));
    let (file, line) = first.unwrap_or_default();
    let name = names.get(&function.id).map(|name| name.split('(').next().unwrap_or_default()).unwrap_or_default();
    let parameters: Vec<Id> = parameters(module, function).map(|id| value_type(module, module.type_of(id))).collect();
    let types: Vec<String> = parameters.iter().map(|kind| type_name(module, *kind, names)).collect();
    let returned = Some(function.returns(module)).filter(|kind| module.defined(Op::TypeVoid, *kind).is_none());
    let count_of = |part: &WrittenPart| numbers::count(module, part.kind(module, &parameters)?);
    let count = |parts: &[WrittenPart]| {
        let returned = returned.map(|kind| numbers::count(module, kind));
        parts.iter().map(count_of).chain(returned).sum::<Option<usize>>()
    };
    let (mut written, mut kept) = (effects.written(function.id), Vec::new());
    // Without the function, other types keep the values of the caller.
    written.retain(|part| !part.is_given || count_of(part).is_some());
    let mut numbers = count(&written);
    if numbers.is_some_and(|numbers| numbers > MOST_NUMBERS) {
        (kept, written) = written.into_iter().partition(|part| part.is_given);
        numbers = count(&written).map(|numbers| numbers + usize::from(!kept.is_empty()));
    }
    let is_small = numbers.is_some_and(|numbers| numbers <= MOST_NUMBERS);
    let lack = effects.lack(function.id, names).or_else(|| (!is_small).then_some(Lack::Returns));
    let signature = format!("{name}({})", types.join(", "));
    StageFunction { id: function.id, signature, file, line, lack, numbers: numbers.unwrap_or(0), written, kept }
}

/// A type as GLSL names it.
fn type_name(module: &Module, kind: Id, names: &HashMap<Id, String>) -> String {
    let vector = |of: Id| match module.get_type(of) {
        Some(Type::Int { signed: true, .. }) => "ivec",
        Some(Type::Int { .. }) => "uvec",
        Some(Type::Bool) => "bvec",
        _ => "vec",
    };
    match module.get_type(kind) {
        Some(Type::Bool) => "bool".to_owned(),
        Some(Type::Int { signed: true, .. }) => "int".to_owned(),
        Some(Type::Int { .. }) => "uint".to_owned(),
        Some(Type::Float { bits: 64 }) => "double".to_owned(),
        Some(Type::Float { .. }) => "float".to_owned(),
        Some(Type::Vector { of, count }) => format!("{}{count}", vector(of)),
        Some(Type::Matrix { column, count }) => match module.get_type(column) {
            Some(Type::Vector { count: rows, .. }) if rows != count => format!("mat{count}x{rows}"),
            _ => format!("mat{count}"),
        },
        Some(Type::Array { of, length }) => {
            let length = module.number(length).map(|length| length.to_string()).unwrap_or_default();
            format!("{}[{length}]", type_name(module, of, names))
        }
        Some(Type::Image { .. } | Type::Sampler | Type::SampledImage { .. }) => "sampler".to_owned(),
        _ => names.get(&kind).cloned().unwrap_or_else(|| "?".to_owned()),
    }
}

/// Where the numbers of each function are in the buffer and among the variables: the first group of four of each, by its place in the list, and how
/// many groups there are.
pub fn groups(functions: &[StageFunction]) -> (Vec<u32>, u32) {
    let mut next = 0;
    let first = functions.iter().map(|function| {
        let first = next;
        next += groups_of(function);
        first
    });
    (first.collect(), next)
}

/// How many groups of four numbers a function has.
pub fn groups_of(function: &StageFunction) -> u32 {
    if function.lack.is_some() { 0 } else { function.numbers.div_ceil(4) as u32 }
}

/// The ids of functions, to find them in a module.
fn by_id(functions: &[StageFunction]) -> BTreeMap<Id, (usize, &StageFunction)> {
    functions.iter().enumerate().map(|(at, function)| (function.id, (at, function))).collect()
}

#[cfg(test)]
mod tests;
