//! A module in parts, with the tables that optimizing needs.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::is_id;
use crate::shader::spirv::specialize::control_flow::Function;
use crate::shader::spirv::specialize::{
    HEADER, Id, Instruction, Known, first_function, instruction, instructions, opcode,
};

/// Place of the bound on ids in a module's header.
pub(super) const BOUND: usize = 3;
/// The storage class of private variables.
pub(super) const PRIVATE: u32 = 6;

/// Bits of a memory access.
const MAKE_AVAILABLE: u32 = 8;
const MAKE_VISIBLE: u32 = 16;
/// Decorations.
pub(super) const BUILT_IN: u32 = 11;
const VOLATILE: u32 = 21;
const COHERENT: u32 = 23;
/// A constant that counts even if nothing uses it.
pub(super) const WORKGROUP_SIZE: u32 = 25;
/// The name of the only set of extended instructions that is known here.
const EXTENDED: &[u8] = b"GLSL.std.450\0";

/// A type, as far as values are concerned.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Type {
    Struct(Vec<Id>),
    /// Element and length; 0 if the length is not known.
    Array(Id, u32),
    /// Component, or column, and their number.
    Vector(Id, u32),
    /// Storage class.
    Pointer(u32, Id),
}

/// A module whose instructions are all known.
pub(super) struct Module {
    pub(super) header: Vec<u32>,
    pub(super) globals: Vec<Instruction>,
    /// New constants.
    pub(super) more: Vec<Instruction>,
    pub(super) functions: Vec<Function>,
    pub(super) entry: Id,
    types: HashMap<Id, Type>,
    /// Values of 32-bit constants and of booleans.
    pub(super) known: Known,
    /// Instructions that make composites of other values.
    pub(super) composites: HashMap<Id, Instruction>,
    /// The type of each id.
    pub(super) result_types: Vec<Id>,
    /// The value that stands for an id; 0 for itself.
    replaced: Vec<Id>,
    /// Decorations of ids that functions define.
    pub(super) decorations: HashMap<Id, Vec<Instruction>>,
    undefined: HashMap<Id, Id>,
    /// Whether a buffer is volatile or coherent: others may write it meanwhile.
    pub(super) has_shared_memory: bool,
}

impl Module {
    /// `None` if the module is not valid, or has instructions that are not known here.
    pub(super) fn parse(words: &[u32]) -> Option<Self> {
        let all = instructions(words)?;
        let (globals, code) = all.split_at(first_function(&all));
        let bound = *words.get(BOUND)? as usize;
        if bound > words.len() * 8 {
            return None;
        }
        let mut this = Self {
            header: words[..HEADER].to_vec(),
            globals: Vec::new(),
            more: Vec::new(),
            functions: Vec::new(),
            entry: 0,
            types: HashMap::new(),
            known: Known::default(),
            composites: HashMap::new(),
            result_types: vec![0; bound],
            replaced: vec![0; bound],
            decorations: HashMap::new(),
            undefined: HashMap::new(),
            has_shared_memory: false,
        };
        let is_sound = |i: &&[u32]| {
            let is_target = matches!(opcode(i), op::DECORATE | op::MEMBER_DECORATE | op::TYPE_FORWARD_POINTER);
            let mut ids = (1..i.len()).filter(|at| is_id(i, *at).unwrap_or(is_target && *at == 1)).map(|at| i[at]);
            i.len() >= least_length(opcode(i)) && ids.all(|id| id != 0 && (id as usize) < bound)
        };
        if !all.iter().all(is_sound) {
            return None;
        }
        for i in globals {
            this.global(i)?;
        }
        let code: Vec<&[u32]> = code.iter().copied().filter(|i| !matches!(opcode(i), op::LINE | op::NO_LINE)).collect();
        for i in &code {
            is_id(i, 1)?;
            // An OpSampledImage must stay in the block that uses it. The scopes of a memory access are ids.
            let access = match opcode(i) {
                op::SAMPLED_IMAGE => return None,
                op::LOAD => i.get(4),
                op::STORE => i.get(3),
                _ => None,
            };
            if access.is_some_and(|access| access & (MAKE_AVAILABLE | MAKE_VISIBLE) != 0) {
                return None;
            }
            if let Some((kind, id)) = typed_result(i) {
                *this.result_types.get_mut(id as usize)? = kind;
            }
        }
        for function in code.split_inclusive(|i| opcode(i) == op::FUNCTION_END) {
            this.functions.push(Function::parse(function)?);
        }
        let mut own: HashSet<Id> = HashSet::new();
        this.functions.iter().for_each(|function| function.results(&mut own));
        for i in this.globals.extract_if(.., |i| opcode(i) == op::DECORATE && own.contains(&i[1])) {
            this.decorations.entry(i[1]).or_default().push(i);
        }
        (this.entry != 0).then_some(this)
    }

    fn global(&mut self, i: &[u32]) -> Option<()> {
        let code = opcode(i);
        match (code, i) {
            // Source, strings and names
            (2..=8 | 317 | 330, _) => return Some(()),
            (op::DECORATE, [_, _, kind, ..]) | (op::MEMBER_DECORATE, [_, _, _, kind, ..]) => {
                self.has_shared_memory |= matches!(*kind, VOLATILE | COHERENT);
            }
            (op::EXT_INST_IMPORT, [_, _, name @ ..]) => {
                let name: Vec<u8> = name.iter().flat_map(|word| word.to_le_bytes()).collect();
                if !name.starts_with(EXTENDED) {
                    return None;
                }
            }
            // OpExtension, OpMemoryModel
            (op::CAPABILITY | 10 | 14, _) => {}
            // OpDecorateId, OpDecorateString, OpMemberDecorateString
            (332 | 5632 | 5633, _) => return None,
            // Two entry points have two interfaces.
            (op::ENTRY_POINT, [_, _, id, ..]) if self.entry == 0 => self.entry = *id,
            (op::ENTRY_POINT, _) => return None,
            (op::TYPE_STRUCT, [_, id, members @ ..]) => _ = self.types.insert(*id, Type::Struct(members.to_vec())),
            (op::TYPE_VECTOR | op::TYPE_MATRIX, [_, id, of, count]) => {
                self.types.insert(*id, Type::Vector(*of, *count));
            }
            (op::TYPE_ARRAY, [_, id, of, length]) => {
                let length = self.known.values.get(length).copied().unwrap_or(0);
                self.types.insert(*id, Type::Array(*of, length));
            }
            (op::TYPE_POINTER, [_, id, storage, of]) => _ = self.types.insert(*id, Type::Pointer(*storage, *of)),
            (op::CONSTANT_TRUE, [_, _, id]) => _ = self.known.values.insert(*id, 1),
            (op::CONSTANT_FALSE, [_, _, id]) => _ = self.known.values.insert(*id, 0),
            (op::CONSTANT, [_, _, id, value]) => _ = self.known.values.insert(*id, *value),
            (op::CONSTANT_COMPOSITE, [_, _, id, ..]) => _ = self.composites.insert(*id, i.to_vec()),
            (op::SPEC_CONSTANT_TRUE..=op::SPEC_CONSTANT_OP, _) => {}
            // Forward pointers name a storage class.
            (op::TYPE_FORWARD_POINTER, _) => {}
            _ => _ = is_id(i, 1)?,
        }
        if let (op::CONSTANT_TRUE..=op::SPEC_CONSTANT_OP | op::UNDEF | op::VARIABLE, Some(&[kind, id])) =
            (code, i.get(1..3))
        {
            *self.result_types.get_mut(id as usize)? = kind;
        }
        self.globals.push(i.to_vec());
        Some(())
    }

    pub(super) fn type_of(&self, id: Id) -> Id {
        self.result_types[id as usize]
    }

    pub(super) fn get_type(&self, id: Id) -> Option<&Type> {
        self.types.get(&id)
    }

    /// The type of a member of a composite.
    pub(super) fn member_type(&self, of: Id, index: u32) -> Option<Id> {
        match self.types.get(&of)? {
            Type::Struct(members) => members.get(index as usize).copied(),
            Type::Array(of, _) | Type::Vector(of, _) => Some(*of),
            Type::Pointer(..) => None,
        }
    }

    /// A new id for a value of this type; 0 for a label.
    pub(super) fn fresh(&mut self, kind: Id) -> Id {
        let id = self.result_types.len() as Id;
        self.result_types.push(kind);
        self.replaced.push(0);
        id
    }

    /// The id that is given next.
    pub(super) fn next_id(&self) -> Id {
        self.result_types.len() as Id
    }

    /// A new id with the type and decorations of another.
    pub(super) fn copy_of(&mut self, id: Id) -> Id {
        let copy = self.fresh(self.type_of(id));
        if let Some(decorations) = self.decorations.get(&id) {
            let moved = |i: &Instruction| [&[i[0], copy], &i[2..]].concat();
            let decorations = decorations.iter().map(moved).collect();
            self.decorations.insert(copy, decorations);
        }
        copy
    }

    pub(super) fn is_decorated(&self, id: Id) -> bool {
        self.decorations.contains_key(&id)
    }

    /// The undefined value of a type.
    pub(super) fn undefined(&mut self, kind: Id) -> Id {
        if let Some(id) = self.undefined.get(&kind) {
            return *id;
        }
        let id = self.fresh(kind);
        self.more.push(instruction(op::UNDEF, &[kind, id]));
        self.undefined.insert(kind, id);
        id
    }

    /// The least 32-bit integer constant, which other code most likely uses too. Which one does not depend on the order of declarations.
    pub(super) fn any_integer(&self) -> Option<Id> {
        let integers = self.globals.iter().filter(|i| opcode(i) == op::TYPE_INT && i[2] == 32);
        let is_signed: Vec<(Id, u32)> = integers.map(|i| (i[1], i[3])).collect();
        let constants = self.globals.iter().filter(|i| opcode(i) == op::CONSTANT && i.len() == 4);
        let of_integers = constants.filter_map(|i| {
            let (_, is_signed) = is_signed.iter().find(|(kind, _)| *kind == i[1])?;
            Some((i[3], *is_signed, i[2]))
        });
        of_integers.min().map(|(.., id)| id)
    }

    /// Private variables: id, type of the value, initial value.
    pub(super) fn private_variables(&self) -> Vec<(Id, Id, Option<Id>)> {
        let variables = self.globals.iter().filter(|i| opcode(i) == op::VARIABLE && i[3] == PRIVATE);
        let pointee = |kind: Id| match self.types.get(&kind) {
            Some(Type::Pointer(_, of)) => Some(*of),
            _ => None,
        };
        variables.filter_map(|i| Some((i[2], pointee(i[1])?, i.get(4).copied()))).collect()
    }

    /// Lets a value stand for an id.
    pub(super) fn replace(&mut self, id: Id, value: Id) {
        if id != value {
            self.replaced[id as usize] = value;
        }
    }

    /// The value that stands for an id.
    pub(super) fn resolve(&mut self, id: Id) -> Id {
        let mut value = id;
        while self.replaced[value as usize] != 0 {
            value = self.replaced[value as usize];
        }
        let mut at = id;
        while at != value {
            at = std::mem::replace(&mut self.replaced[at as usize], value);
        }
        value
    }

    /// Replaces the operands of an instruction.
    pub(super) fn resolve_operands(&mut self, i: &mut [u32]) {
        for at in 1..i.len() {
            if is_id(i, at) == Some(true) && self.replaced[i[at] as usize] != 0 {
                i[at] = self.resolve(i[at]);
            }
        }
    }
}

/// The words that an instruction has at least, where they are read by their place.
fn least_length(code: u32) -> usize {
    match code {
        op::FUNCTION | op::EXT_INST | op::VECTOR_SHUFFLE => 5,
        op::COMPOSITE_INSERT => 6,
        op::COMPOSITE_EXTRACT => 5,
        op::VARIABLE | op::LOAD | op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN | op::COPY_OBJECT => 4,
        op::FUNCTION_CALL | op::BRANCH_CONDITIONAL | op::LOOP_MERGE => 4,
        op::STORE | op::SELECTION_MERGE | op::SWITCH | op::DECORATE | op::TYPE_INT => 3,
        op::LABEL | op::BRANCH | op::RETURN_VALUE => 2,
        op::TYPE_FORWARD_POINTER | op::ENTRY_POINT => 3,
        code if op::WITHOUT_RESULT.contains(&code) || code == op::FUNCTION_END => 1,
        109..=124 | 126..=152 | 154..=191 | 194..=205 | op::PHI => 3,
        _ => 1,
    }
}

/// Type and id of an instruction's result.
pub(super) fn typed_result(i: &[u32]) -> Option<(Id, Id)> {
    let code = opcode(i);
    let is_untyped = matches!(code, op::LABEL | op::FUNCTION_END) || op::WITHOUT_RESULT.contains(&code);
    if is_untyped { None } else { Some((*i.get(1)?, *i.get(2)?)) }
}
