//! Effects of functions besides returning a value.

use std::collections::{BTreeMap, BTreeSet};

use foldhash::{HashMap, HashSet};

use super::lack::Lack;
use super::parameters::{WrittenPart, parameters};
use crate::shader::spirv::enums::storage;
use crate::shader::spirv::module::{Function, Id, Instruction, Module, Type};
use crate::shader::spirv::op::{Class, Op};

/// Effects of a function, its callees included.
#[derive(Clone, Debug, Default)]
struct Effect {
    discards: bool,
    writes_memory: bool,
    emits: bool,
    is_unknown: bool,
    /// Variables of the whole stage that it writes.
    variables: Vec<Id>,
    /// Its parameters that it writes, by their places.
    written: BTreeMap<usize, Members>,
}

/// The written part of a parameter.
#[derive(Clone, Debug)]
enum Members {
    All,
    /// Members of the struct.
    Some(BTreeSet<u32>),
}

/// The effects of all functions that the entry point reaches.
pub(super) struct Effects {
    of: HashMap<Id, Effect>,
    /// Callees, and the places of parameters that get a value from a caller.
    given: HashSet<(Id, usize)>,
}

impl Effects {
    /// `order`: the functions, callees before their callers.
    pub(super) fn of(module: &Module, order: &[usize]) -> Self {
        let mut all = Self { of: HashMap::default(), given: given(module) };
        for function in order.iter().map(|place| &module.functions[*place]) {
            let effect = all.effect(module, function);
            all.of.insert(function.id, effect);
        }
        all
    }

    /// The parts of its parameters that a function writes. One that no caller gives a value is written as a whole.
    pub(super) fn written(&self, function: Id) -> Vec<WrittenPart> {
        let written = self.of.get(&function).map(|effect| &effect.written);
        let parts = written.into_iter().flatten().flat_map(|(parameter, members)| {
            let (parameter, is_given) = (*parameter, self.given.contains(&(function, *parameter)));
            let part = |member| WrittenPart { parameter, member, is_given };
            match members {
                Members::Some(members) if is_given => members.iter().map(|member| part(Some(*member))).collect(),
                _ => vec![part(None)],
            }
        });
        parts.collect()
    }

    /// Why a function cannot be replaced.
    pub(super) fn lack(&self, function: Id, names: &HashMap<Id, String>) -> Option<Lack> {
        let effect = self.of.get(&function)?;
        let name = |id: &Id| names.get(id).cloned().filter(|name| !name.is_empty());
        match effect {
            Effect { is_unknown: true, .. } => Some(Lack::Unknown),
            Effect { discards: true, .. } => Some(Lack::Discards),
            Effect { emits: true, .. } => Some(Lack::Emits),
            Effect { writes_memory: true, .. } => Some(Lack::WritesMemory),
            Effect { variables, .. } => {
                let first = variables.first()?;
                Some(Lack::WritesVariable(name(first).unwrap_or_else(|| "an output".to_owned())))
            }
        }
    }

    fn effect(&self, module: &Module, function: &Function) -> Effect {
        let mut effect = Effect::default();
        let places: HashMap<Id, usize> = parameters(module, function).zip(0..).collect();
        for i in function.body() {
            self.add(module, i, &places, &mut effect);
        }
        effect
    }

    fn add(&self, module: &Module, i: Instruction, places: &HashMap<Id, usize>, effect: &mut Effect) {
        match (i.op, &module[i]) {
            (Op::Kill | Op::TerminateInvocation | Op::DemoteToHelperInvocation, _) => effect.discards = true,
            (Op::EmitVertex | Op::EndPrimitive | Op::SetMeshOutputsEXT | Op::EmitMeshTasksEXT, _) => {
                effect.emits = true
            }
            (Op::ImageWrite, _) => effect.writes_memory = true,
            (Op::AtomicLoad, _) => {}
            (op, _) if op.class() == Class::Synchronization => match op {
                Op::ControlBarrier | Op::MemoryBarrier => effect.emits = true,
                _ => effect.writes_memory = true,
            },
            (Op::Store | Op::CopyMemory, [_, pointer, ..]) => writes(module, *pointer, places, effect),
            (Op::FunctionCall, [_, _, _, callee, arguments @ ..]) => {
                let Some(of) = self.of.get(callee) else { return };
                effect.discards |= of.discards;
                effect.writes_memory |= of.writes_memory;
                effect.emits |= of.emits;
                effect.is_unknown |= of.is_unknown;
                let more = of.variables.iter().filter(|id| !effect.variables.contains(id)).copied();
                let more: Vec<Id> = more.collect();
                effect.variables.extend(more);
                let written = of.written.keys().filter_map(|at| arguments.get(*at).copied());
                written.for_each(|pointer| writes(module, pointer, places, effect));
            }
            // `modf` and `frexp` write by a pointer, which glslang does not use: it takes their variants that return a struct.
            (Op::Unknown, _) => effect.is_unknown = true,
            _ => {}
        }
    }
}

/// Notes a write by a pointer.
fn writes(module: &Module, pointer: Id, places: &HashMap<Id, usize>, effect: &mut Effect) {
    let (mut root, mut member) = (pointer, None);
    while let Some(i) = module.definition(root).filter(|i| matches!(i.op, Op::AccessChain | Op::InBoundsAccessChain)) {
        root = module[i][3];
        let kind = module.pointer(module.type_of(root)).and_then(|(_, to)| module.get_type(to));
        member =
            module[i].get(4).filter(|_| matches!(kind, Some(Type::Struct { .. }))).and_then(|at| module.number(*at));
    }
    if let Some(at) = places.get(&root) {
        let members = effect.written.entry(*at).or_insert_with(|| Members::Some(BTreeSet::new()));
        match (&mut *members, member) {
            (Members::Some(all), Some(member)) => _ = all.insert(member),
            _ => *members = Members::All,
        }
        return;
    }
    match module.pointer(module.type_of(root)).map(|(class, _)| class) {
        Some(storage::FUNCTION) => {}
        Some(storage::PRIVATE | storage::OUTPUT | storage::TASK_PAYLOAD) => {
            if !effect.variables.contains(&root) {
                effect.variables.push(root);
            }
        }
        _ => effect.writes_memory = true,
    }
}

/// See [`Effects::given`]. glslang passes copies, and stores to those of `in` and `inout` arguments before the call.
fn given(module: &Module) -> HashSet<(Id, usize)> {
    let stored: HashSet<Id> = module.code().filter(|i| i.op == Op::Store).map(|i| module[i][1]).collect();
    let is_given = |argument: Id| module.defined(Op::Variable, argument).is_none() || stored.contains(&argument);
    let calls = module.code().filter(|i| i.op == Op::FunctionCall).map(|i| &module[i]);
    let arguments = calls.flat_map(|words| words[4..].iter().enumerate().map(|(at, id)| ((words[3], at), *id)));
    arguments.filter(|(_, id)| is_given(*id)).map(|(parameter, _)| parameter).collect()
}
