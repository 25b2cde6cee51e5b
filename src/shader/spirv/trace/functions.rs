//! The functions of a module before they are instrumented: which of them log, and where they begin.

use std::collections::BTreeSet;

use foldhash::{HashMap, HashSet};

use crate::shader::spirv::module::{Function, Id, Instruction, Module};
use crate::shader::spirv::op::{Class, Op, text};
use crate::shader::spirv::reach::file_of;

/// Which values are logged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Logged {
    /// Floats, once each.
    Floats,
    /// All values, and what is done with them.
    Statements,
}

/// The functions of a module before they are instrumented.
pub(super) struct Functions {
    /// They log nothing.
    silent: HashSet<Id>,
    /// The first lines of their bodies.
    pub(super) first: HashMap<Id, Instruction>,
    /// Callees, and the places of parameters that get a value from a caller: an `out` parameter gets none.
    pub(super) given: HashSet<(Id, usize)>,
}

impl Functions {
    /// `function`: the one that gets the values. Without a file in `only`, and no call that leads to one, a function logs nothing.
    pub(super) fn new(module: &Module, function: &str, logged: Logged, only: Option<&BTreeSet<String>>) -> Self {
        let names = module.debug.iter().filter(|i| i.op == Op::Name).map(|i| &module[*i]);
        let own = names.filter(|words| text(&words[2..]).starts_with(function)).map(|words| words[1]);
        let mut silent: HashSet<Id> = own.collect();
        if logged == Logged::Statements {
            // Specialization takes branches by functions that only return a constant, and drops what they exclude.
            silent.extend(module.functions.iter().filter(|of| returns_constant(module, of)).map(|of| of.id));
            silent.extend(module.entry_function());
            let leading = only.map(|files| leading_to(module, files));
            let leads = |of: &&Function| leading.as_ref().is_none_or(|leading| leading.contains(&of.id));
            silent.extend(module.functions.iter().filter(|of| !leads(of)).map(|of| of.id));
        }
        let first = |of: &Function| Some((of.id, of.body().find(|i| i.op == Op::Line)?));
        Self { silent, first: module.functions.iter().filter_map(first).collect(), given: given(module) }
    }

    pub(super) fn is_silent(&self, function: Id) -> bool {
        self.silent.contains(&function)
    }
}

fn returns_constant(module: &Module, function: &Function) -> bool {
    let mut body = function.body().filter(|i| !is_line(*i));
    let constant = body.next().filter(|i| i.op == Op::ReturnValue).and_then(|i| module.definition(module[i][1]));
    constant.is_some_and(|i| i.op.class() == Class::Constant)
}

/// The functions with lines of these files, and all that lead to them by calls.
fn leading_to(module: &Module, files: &BTreeSet<String>) -> HashSet<Id> {
    let is_there = |i: Instruction| file_of(module, &module[i]).is_some_and(|(file, _)| files.contains(&file));
    let has_line = |function: &&Function| function.instructions().any(|i| i.op == Op::Line && is_there(i));
    let mut found: HashSet<Id> = module.functions.iter().filter(has_line).map(|function| function.id).collect();
    loop {
        let calls = |function: &&Function| {
            !found.contains(&function.id) && function.calls(module).any(|id| found.contains(&id))
        };
        let more: Vec<Id> = module.functions.iter().filter(calls).map(|function| function.id).collect();
        if more.is_empty() {
            return found;
        }
        found.extend(more);
    }
}

/// See [`Functions::given`]. glslang passes copies, and stores to those of `in` and `inout` arguments before the call.
fn given(module: &Module) -> HashSet<(Id, usize)> {
    let stored: HashSet<Id> = module.code().filter(|i| i.op == Op::Store).map(|i| module[i][1]).collect();
    let is_given = |argument: Id| module.defined(Op::Variable, argument).is_none() || stored.contains(&argument);
    let calls = module.code().filter(|i| i.op == Op::FunctionCall).map(|i| &module[i]);
    let arguments = calls.flat_map(|words| words[4..].iter().enumerate().map(|(at, id)| ((words[3], at), *id)));
    arguments.filter(|(_, id)| is_given(*id)).map(|(parameter, _)| parameter).collect()
}

pub(super) fn is_line(i: Instruction) -> bool {
    matches!(i.op, Op::Line | Op::NoLine)
}
