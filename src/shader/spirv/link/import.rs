//! Finds the declarations of one module in another module, and adds the missing ones there.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use super::parts::{BOUND, Parts, result_place};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::{is_id, text};
use crate::shader::spirv::specialize::{Id, Instruction, opcode};

/// Decorations.
const SPEC_ID: u32 = 1;
const BUILT_IN: u32 = 11;

/// Identifies a declaration: its instruction, its names and its decorations, each without the declared id.
type Key = Vec<u32>;

/// Adds to a module the declarations that functions of another module need.
pub struct Importer<'a> {
    from: &'a Parts<'a>,
    /// The place of each global instruction of `from`, by the id that it defines.
    defined: HashMap<Id, usize>,
    /// New ids by ids of `from`. 0 stands for an id that has no new id yet.
    map: Vec<Id>,
    keys: HashMap<Key, Id>,
    /// Pointers that are declared before their targets, by the target's name.
    forward: HashMap<String, Id>,
    /// Targets of the pointers in `forward`, by pointer.
    targets: HashMap<Id, Id>,
    /// Structs of the new module that a struct of `from` was matched with.
    structs: HashSet<Id>,
    next: Id,
    /// Added declarations.
    pub globals: Vec<Instruction>,
    /// Names of added ids.
    pub names: Vec<Instruction>,
    /// Decorations of added ids.
    pub decorations: Vec<Instruction>,
    /// Added variables.
    pub variables: Vec<Id>,
}

impl<'a> Importer<'a> {
    /// Imports from one module into another. `None` if either cannot be read.
    pub fn new(from: &'a Parts<'a>, to: &'a Parts<'a>) -> Option<Self> {
        let mut this = Self {
            from,
            defined: HashMap::with_capacity(from.globals.len()),
            map: vec![0; from.bound],
            keys: HashMap::with_capacity(to.globals.len()),
            forward: HashMap::new(),
            targets: HashMap::new(),
            structs: HashSet::new(),
            next: to.bound as Id,
            globals: Vec::new(),
            names: Vec::new(),
            decorations: Vec::new(),
            variables: Vec::new(),
        };
        for (at, i) in from.globals.iter().enumerate() {
            if opcode(i) != op::TYPE_FORWARD_POINTER {
                this.defined.insert(*i.get(result_place(i))?, at);
            }
        }
        for i in &to.globals {
            if opcode(i) != op::TYPE_FORWARD_POINTER {
                let id = *i.get(result_place(i))?;
                let key = key(to, i, id, Some)?;
                this.keys.entry(key).or_insert(id);
            }
        }
        for (pointer, target) in forward_pointers(to)? {
            if this.forward.insert(name_of(to, target)?, pointer).is_some() {
                return None;
            }
            this.targets.insert(pointer, target);
        }
        let imports = |parts: &Parts<'_>| {
            let imports = parts.head.iter().filter(|i| opcode(i) == op::EXT_INST_IMPORT && i.len() > 2);
            imports.map(|i| (text(&i[2..]), i[1])).collect::<Vec<_>>()
        };
        let known: HashMap<String, Id> = imports(to).into_iter().collect();
        for (name, id) in imports(from) {
            *this.map.get_mut(id as usize)? = *known.get(&name)?;
        }
        for (pointer, target) in forward_pointers(from)? {
            *this.map.get_mut(pointer as usize)? = *this.forward.get(&name_of(from, target)?)?;
        }
        Some(this)
    }

    /// A new id.
    pub fn fresh(&mut self) -> Id {
        self.next += 1;
        self.next - 1
    }

    /// The id that [`Self::fresh`] returns next.
    pub fn next_id(&self) -> Id {
        self.next
    }

    /// Maps an id of `from` to an id of the new module.
    pub fn set(&mut self, from: Id, to: Id) -> Option<()> {
        *self.map.get_mut(from as usize)? = to;
        Some(())
    }

    /// The new module's id for an id of `from`. Adds the declaration if the module lacks it. `None` if the declaration
    /// must not be added.
    pub fn id(&mut self, id: Id) -> Option<Id> {
        match *self.map.get(id as usize)? {
            0 => self.declare(id),
            known => Some(known),
        }
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
        let i = self.from.globals[*self.defined.get(&id)?];
        let key = key(self.from, i, id, |operand| self.id(operand))?;
        let code = opcode(i);
        if let Some(known) = self.keys.get(&key).copied() {
            // Two structs of `from` match the same struct; only their uses differ.
            if code == op::TYPE_STRUCT && !self.structs.insert(known) {
                return None;
            }
            self.set(id, known)?;
            return Some(known);
        }
        let decorations = self.from.decorations.of(id);
        let has = |kind: u32| decorations.iter().any(|i| opcode(i) == op::DECORATE && i.get(2) == Some(&kind));
        // The text declares all other variables and all specialization constants, so the module has them already.
        if (code == op::VARIABLE && !has(BUILT_IN) && !self.has_built_in_members(i[1])) || has(SPEC_ID) {
            return None;
        }
        let new = self.fresh();
        self.set(id, new)?;
        self.keys.insert(key, new);
        if code == op::VARIABLE {
            self.variables.push(new);
        }
        let mut copy = i.to_vec();
        for at in 1..i.len() {
            if is_id(i, at)? {
                copy[at] = self.id(i[at])?;
            }
        }
        self.globals.push(copy);
        self.describe(id, new);
        Some(new)
    }

    /// Whether a pointer of `from` points to a block with built-in members, such as `gl_PerVertex`.
    fn has_built_in_members(&self, pointer: Id) -> bool {
        let target = self.defined.get(&pointer).and_then(|at| self.from.globals[*at].get(3).copied());
        let mut decorations = self.from.decorations.of(target.unwrap_or(0)).iter();
        decorations.any(|i| opcode(i) == op::MEMBER_DECORATE && i.get(3) == Some(&BUILT_IN))
    }

    /// Copies the names and decorations of an id of `from` to a new id.
    pub fn describe(&mut self, from: Id, to: Id) {
        let retarget = |i: &&[u32]| [&[i[0], to], &i[2..]].concat();
        self.names.extend(self.from.names.of(from).iter().map(retarget));
        self.decorations.extend(self.from.decorations.of(from).iter().map(retarget));
    }

    /// Copies the names and decorations of ids in imported functions. `locals`: new ids by id of `from`, 0 for all
    /// others.
    pub fn describe_locals(&mut self, locals: &[Id]) {
        for (about, out) in [(&self.from.names, &mut self.names), (&self.from.decorations, &mut self.decorations)] {
            let retarget = |i: &'a [u32]| match locals.get(i[1] as usize) {
                None | Some(0) => None,
                Some(to) => Some([&[i[0], *to], &i[2..]].concat()),
            };
            out.extend(about.all().filter_map(retarget));
        }
    }
}

/// The key of a declaration. `map` translates the ids among its operands.
fn key(parts: &Parts<'_>, i: &[u32], result: Id, mut map: impl FnMut(Id) -> Option<Id>) -> Option<Key> {
    let mut key = Vec::with_capacity(i.len() + 16);
    key.push(i[0]);
    for (at, word) in i.iter().enumerate().skip(1) {
        match is_id(i, at)? {
            _ if at == result_place(i) => {}
            true => key.push(map(*word)?),
            false => key.push(*word),
        }
    }
    for list in [&parts.names, &parts.decorations] {
        let mut about = list.of(result).to_vec();
        about.sort_unstable_by(|a, b| (a[0], &a[2..]).cmp(&(b[0], &b[2..])));
        about.iter().for_each(|i| {
            key.push(i[0]);
            key.extend_from_slice(&i[2..]);
        });
    }
    Some(key)
}

/// Pointers that OpTypeForwardPointer declares, with their targets.
fn forward_pointers(parts: &Parts<'_>) -> Option<Vec<(Id, Id)>> {
    let declared = parts.globals.iter().filter(|i| opcode(i) == op::TYPE_FORWARD_POINTER);
    let target = |pointer: Id| {
        let is_it = |i: &&&[u32]| opcode(i) == op::TYPE_POINTER && i.len() > 3 && i[1] == pointer;
        parts.globals.iter().find(is_it).map(|i| (pointer, i[3]))
    };
    declared.map(|i| target(*i.get(1)?)).collect()
}

fn name_of(parts: &Parts<'_>, id: Id) -> Option<String> {
    let is_name = |i: &&&[u32]| opcode(i) == op::NAME;
    parts.names.of(id).iter().find(is_name).map(|i| text(&i[2..]))
}

/// The header of a module, with another bound on ids.
pub fn header(parts: &Parts<'_>, bound: Id) -> Vec<u32> {
    let mut header = parts.header.to_vec();
    header[BOUND] = bound;
    header
}
