//! A module with the tables that optimizing needs.

use foldhash::{HashMap, HashMapExt, HashSet};

use crate::shader::spirv::enums::{decoration, storage};
use crate::shader::spirv::module::{Id, Instruction, Module, Type};
use crate::shader::spirv::op::{Class, Op, text};

/// Bits of a memory access.
const MAKE_AVAILABLE: u32 = 8;
const MAKE_VISIBLE: u32 = 16;

/// A module whose instructions are all known.
pub(super) struct Optimizer {
    pub(super) module: Module,
    /// Values of ids besides the constants.
    pub(super) known: HashMap<Id, u32>,
    /// The value that stands for an id; 0 for itself.
    replaced: Vec<Id>,
    /// Decorations of ids that functions define.
    pub(super) decorations: HashMap<Id, Vec<Instruction>>,
    undefined: HashMap<Id, Id>,
    /// Whether a buffer is volatile or coherent: others may write it meanwhile.
    pub(super) has_shared_memory: bool,
}

impl Optimizer {
    /// `None` if the module is not valid, or has instructions that are not known here.
    pub(super) fn new(mut module: Module) -> Option<Self> {
        // Two entry points have two interfaces.
        module.entry()?;
        module.debug.clear();
        module.globals.retain(|i| i.op.class() != Class::Debug);
        let blocks = module.functions.iter_mut().flat_map(|function| &mut function.blocks);
        blocks.for_each(|block| block.body.retain(|i| i.op.class() != Class::Debug));
        let declarations = module.head.iter().chain(&module.decorations).chain(&module.globals).copied();
        if !declarations.chain(module.code()).all(|i| is_known(&module, i)) {
            return None;
        }
        let shared = [decoration::VOLATILE, decoration::COHERENT];
        let is_shared = |i: &Instruction| match (i.op, &module[*i]) {
            (Op::MemberDecorate, [_, _, _, kind, ..]) | (_, [_, _, kind, ..]) => shared.contains(kind),
            _ => false,
        };
        let has_shared_memory = module.decorations.iter().any(is_shared);
        let own: HashSet<Id> = module.functions.iter().flat_map(|function| function.results(&module)).collect();
        let (of_functions, others): (Vec<Instruction>, Vec<Instruction>) = std::mem::take(&mut module.decorations)
            .into_iter()
            .partition(|i| i.op == Op::Decorate && own.contains(&module[*i][1]));
        module.decorations = others;
        Some(Self {
            known: HashMap::new(),
            replaced: vec![0; module.bound() as usize],
            decorations: module.by_target(&of_functions),
            undefined: HashMap::new(),
            has_shared_memory,
            module,
        })
    }

    /// A new id with the type and decorations of another.
    pub(super) fn copy_of(&mut self, id: Id) -> Id {
        let copy = self.module.fresh(self.module.type_of(id));
        if let Some(decorations) = self.decorations.get(&id) {
            let moved = decorations.iter().map(|i| self.module.about(*i, copy)).collect();
            self.decorations.insert(copy, moved);
        }
        copy
    }

    pub(super) fn is_decorated(&self, id: Id) -> bool {
        self.decorations.contains_key(&id)
    }

    /// The undefined value of a type.
    pub(super) fn undefined(&mut self, kind: Id) -> Id {
        *self.undefined.entry(kind).or_insert_with(|| self.module.declare_another(Op::Undef, &[kind]))
    }

    /// The least 32-bit integer constant, which other code most likely uses too. Which one does not depend on the order of declarations.
    pub(super) fn any_integer(&self) -> Option<Id> {
        let constants = self.module.globals.iter().filter(|i| i.op == Op::Constant).map(|i| &self.module[*i]);
        let of_integers = constants.filter_map(|words| match self.module.get_type(words[1]) {
            Some(Type::Int { bits: 32, signed }) => Some((words[3], signed, words[2])),
            _ => None,
        });
        of_integers.min().map(|(.., id)| id)
    }

    /// Private variables: id, type of the value, initial value.
    pub(super) fn private_variables(&self) -> Vec<(Id, Id, Option<Id>)> {
        let variables = self.module.globals.iter().filter(|i| i.op == Op::Variable).map(|i| &self.module[*i]);
        let private = variables.filter(|words| words[3] == storage::PRIVATE);
        private.filter_map(|words| Some((words[2], self.module.pointer(words[1])?.1, words.get(4).copied()))).collect()
    }

    /// The types of the members of a struct or an array; `None` for a leaf.
    pub(super) fn parts(&self, kind: Id) -> Option<Vec<Id>> {
        match self.module.get_type(kind)? {
            Type::Struct { members } => Some(members.to_vec()),
            Type::Array { of, length } => Some(vec![of; self.module.number(length).unwrap_or(0) as usize]),
            _ => None,
        }
    }

    /// The type of a member of a composite.
    pub(super) fn member_type(&self, of: Id, index: u32) -> Option<Id> {
        match self.module.get_type(of)? {
            Type::Struct { members } => members.get(index as usize).copied(),
            Type::Array { of, .. } | Type::Vector { of, .. } | Type::Matrix { column: of, .. } => Some(of),
            _ => None,
        }
    }

    /// Lets a value stand for an id.
    pub(super) fn replace(&mut self, id: Id, value: Id) {
        if id != value {
            if self.replaced.len() <= id as usize {
                self.replaced.resize(self.module.bound() as usize, 0);
            }
            self.replaced[id as usize] = value;
        }
    }

    /// The value that stands for an id.
    pub(super) fn resolve(&mut self, id: Id) -> Id {
        let next = |replaced: &[Id], id: Id| replaced.get(id as usize).copied().filter(|next| *next != 0);
        let mut value = id;
        while let Some(known) = next(&self.replaced, value) {
            value = known;
        }
        let mut at = id;
        while at != value {
            at = std::mem::replace(&mut self.replaced[at as usize], value);
        }
        value
    }

    /// Replaces the operands of an instruction.
    pub(super) fn resolve_operands(&mut self, i: Instruction) {
        for at in 1..self.module[i].len() {
            let words = &self.module[i];
            if i.op.is_id(words, at) && self.replaced.get(words[at] as usize).is_some_and(|value| *value != 0) {
                let value = self.resolve(words[at]);
                self.module[i][at] = value;
            }
        }
    }
}

/// Whether an instruction is one that the optimizer can handle.
fn is_known(module: &Module, i: Instruction) -> bool {
    let words = &module[i];
    let is_fine = match i.op {
        Op::ExtInstImport => text(&words[2..]) == "GLSL.std.450",
        // It must stay in the block that uses it.
        Op::SampledImage => false,
        // The scopes of a memory access are ids.
        Op::Load => words.get(4).is_none_or(|access| access & (MAKE_AVAILABLE | MAKE_VISIBLE) == 0),
        Op::Store => words.get(3).is_none_or(|access| access & (MAKE_AVAILABLE | MAKE_VISIBLE) == 0),
        op => op.is_known(),
    };
    is_fine && module.ids_of(i).all(|id| id != 0 && id < module.bound())
}
