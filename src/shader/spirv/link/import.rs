//! Finds the declarations of one module in another module, and adds the missing ones there.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::parts::Parts;
use crate::shader::spirv::enums::decoration::{BUILT_IN, SPEC_ID};
use crate::shader::spirv::module::{Id, Instruction};
use crate::shader::spirv::op::{Op, text};

/// Identifies a declaration: its instruction, its names and its decorations, each without the declared id.
type Key = Vec<u32>;

/// Adds to a module the declarations that functions of another module need.
pub struct Importer<'a> {
    pub from: &'a Parts,
    pub to: Parts,
    /// New ids by ids of `from`. 0 stands for an id that has no new id yet.
    map: Vec<Id>,
    keys: HashMap<Key, Id>,
    /// Pointers that are declared before their targets, by the target's name.
    forward: HashMap<String, Id>,
    /// Targets of the pointers in `forward`, by pointer.
    targets: HashMap<Id, Id>,
    /// Structs of the new module that a struct of `from` was matched with.
    structs: HashSet<Id>,
    /// Added variables.
    pub variables: Vec<Id>,
}

impl<'a> Importer<'a> {
    /// Imports from one module into another. `None` if either cannot be read.
    pub fn new(from: &'a Parts, to: Parts) -> Option<Self> {
        let mut keys = HashMap::with_capacity(to.module.globals.len());
        for i in to.module.globals.iter().filter(|i| i.op != Op::TypeForwardPointer) {
            let id = to.module.result(*i)?;
            keys.entry(key(&to, *i, id, Some)?).or_insert(id);
        }
        let mut this = Self {
            from,
            to,
            map: vec![0; from.module.bound() as usize],
            keys,
            forward: HashMap::new(),
            targets: HashMap::new(),
            structs: HashSet::new(),
            variables: Vec::new(),
        };
        for (pointer, target) in forward_pointers(&this.to)? {
            if this.forward.insert(this.to.name_of(target)?, pointer).is_some() {
                return None;
            }
            this.targets.insert(pointer, target);
        }
        let known: HashMap<String, Id> = imports(&this.to).collect();
        for (name, id) in imports(from) {
            this.set(id, *known.get(&name)?)?;
        }
        for (pointer, target) in forward_pointers(from)? {
            this.set(pointer, *this.forward.get(&from.name_of(target)?)?)?;
        }
        Some(this)
    }

    /// Maps an id of `from` to an id of the new module.
    pub fn set(&mut self, from: Id, to: Id) -> Option<()> {
        *self.map.get_mut(from as usize)? = to;
        Some(())
    }

    /// Maps an id of `from` to a new id with its names and decorations.
    pub fn add(&mut self, from: Id) -> Option<()> {
        let to = self.to.module.fresh(0);
        let [names, decorations] = self.from.about(from).map(|about| {
            let operands = about.iter().map(|i| (i.op, [&[to], &self.from.module[*i][2..]].concat()));
            operands.map(|(op, operands)| self.to.module.make(op, &operands)).collect::<Vec<_>>()
        });
        self.to.module.debug.extend(names);
        self.to.module.decorations.extend(decorations);
        self.set(from, to)
    }

    /// The new module's id for an id of `from`. Adds the declaration if the module lacks it. `None` if the declaration
    /// must not be added.
    pub fn id(&mut self, id: Id) -> Option<Id> {
        match *self.map.get(id as usize)? {
            0 => self.declare(id),
            known => Some(known),
        }
    }

    /// The instruction of `from` in the new module. `None` if the operation is unknown.
    pub fn copy(&mut self, i: Instruction) -> Option<Instruction> {
        let mut words = self.from.module[i].to_vec();
        for at in 1..words.len() {
            if i.op.is_id(&words, at) {
                words[at] = self.id(words[at])?;
            }
        }
        i.op.is_known().then(|| self.to.module.make(i.op, &words[1..]))
    }

    /// Whether pointers that were matched by the names of their targets have the same targets.
    pub fn pointers_agree(&mut self) -> Option<bool> {
        for (pointer, target) in forward_pointers(self.from)? {
            let pointer = self.id(pointer)?;
            let expected = self.targets.get(&pointer).copied();
            if expected != Some(self.id(target)?) {
                return Some(false);
            }
        }
        Some(true)
    }

    fn declare(&mut self, id: Id) -> Option<Id> {
        let from = self.from;
        let i = from.module.definition(id).filter(|i| from.module.is_global(*i))?;
        let key = key(from, i, id, |operand| self.id(operand))?;
        if let Some(known) = self.keys.get(&key).copied() {
            // Two structs of `from` match the same struct; only their uses differ.
            if i.op == Op::TypeStruct && !self.structs.insert(known) {
                return None;
            }
            self.set(id, known)?;
            return Some(known);
        }
        let [_, decorations] = from.about(id);
        let has = |kind: u32| decorations.iter().any(|i| i.op == Op::Decorate && from.module[*i][2] == kind);
        // The text declares all other variables and all specialization constants, so the module has them already.
        let is_variable = i.op == Op::Variable;
        if (is_variable && !has(BUILT_IN) && !self.has_built_in_members(from.module.type_of(id))) || has(SPEC_ID) {
            return None;
        }
        self.add(id)?;
        let new = self.id(id)?;
        self.keys.insert(key, new);
        if is_variable {
            self.variables.push(new);
        }
        let copy = self.copy(i)?;
        self.to.module.globals.push(copy);
        Some(new)
    }

    /// Whether a pointer of `from` points to a block with built-in members, such as `gl_PerVertex`.
    fn has_built_in_members(&self, pointer: Id) -> bool {
        let Some((_, target)) = self.from.module.pointer(pointer) else { return false };
        let [_, decorations] = self.from.about(target);
        decorations.iter().any(|i| i.op == Op::MemberDecorate && self.from.module[*i][3] == BUILT_IN)
    }
}

/// The key of a declaration. `map` translates the ids among its operands.
fn key(parts: &Parts, i: Instruction, result: Id, mut map: impl FnMut(Id) -> Option<Id>) -> Option<Key> {
    let words = &parts.module[i];
    let mut key = Vec::with_capacity(words.len() + 16);
    key.push(words[0]);
    for at in (1..words.len()).filter(|at| Some(*at) != i.op.result()) {
        key.push(if i.op.is_id(words, at) { map(words[at])? } else { words[at] });
    }
    for list in parts.about(result) {
        let mut about: Vec<&[u32]> = list.iter().map(|i| &parts.module[*i]).collect();
        about.sort_unstable_by(|a, b| (a[0], &a[2..]).cmp(&(b[0], &b[2..])));
        about.iter().for_each(|i| {
            key.push(i[0]);
            key.extend_from_slice(&i[2..]);
        });
    }
    Some(key)
}

/// Pointers that OpTypeForwardPointer declares, with their targets.
fn forward_pointers(parts: &Parts) -> Option<Vec<(Id, Id)>> {
    let declared = parts.module.globals.iter().filter(|i| i.op == Op::TypeForwardPointer).map(|i| parts.module[*i][1]);
    declared.map(|pointer| Some((pointer, parts.module.pointer(pointer)?.1))).collect()
}

/// The names and ids of imported sets of instructions.
fn imports(parts: &Parts) -> impl Iterator<Item = (String, Id)> {
    let imports = parts.module.head.iter().filter(|i| i.op == Op::ExtInstImport).map(|i| &parts.module[*i]);
    imports.map(|words| (text(&words[2..]), words[1]))
}
