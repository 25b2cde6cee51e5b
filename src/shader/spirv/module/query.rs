//! Questions to a module: its entry point, names, decorations, functions.

use foldhash::{HashMap, HashMapExt};

use super::instruction::{Function, Id, Instruction};
use super::words::Module;
use crate::shader::spirv::op::{Op, text};

impl Module {
    /// The module's only entry point. `None` if it has none, or several, which have an interface each.
    pub fn entry(&self) -> Option<Instruction> {
        let mut entries = self.head.iter().filter(|i| i.op == Op::EntryPoint);
        entries.next().filter(|_| entries.next().is_none()).copied()
    }

    /// The function that the entry point names.
    pub fn entry_function(&self) -> Option<Id> {
        self.entry().map(|entry| self[entry][2])
    }

    /// The execution model of the entry point.
    pub fn model(&self) -> Option<u32> {
        self.entry().map(|entry| self[entry][1])
    }

    /// glslang's name of an id. That of a function has the types of the parameters: `f(vf3;`.
    pub fn name(&self, id: Id) -> Option<String> {
        let name = self.debug.iter().find(|i| i.op == Op::Name && self[**i][1] == id)?;
        Some(text(&self[*name][2..]))
    }

    /// The ids whose names begin with this text. A name ends in NUL.
    pub fn named(&self, start: &str) -> impl Iterator<Item = Id> {
        let names = self.debug.iter().filter(|i| i.op == Op::Name).map(|i| &self[*i]);
        let bytes =
            |words: &[u32]| words[2..].iter().flat_map(|word| word.to_le_bytes()).take(start.len()).eq(start.bytes());
        names.filter(move |words| bytes(words)).map(|words| words[1])
    }

    /// The first literal of a decoration of an id; 0 if it has none.
    pub fn decoration(&self, id: Id, kind: u32) -> Option<u32> {
        let decorations = self.decorations.iter().filter(|i| i.op == Op::Decorate).map(|i| &self[*i]);
        let mut found = decorations.filter(|words| words[1..3] == [id, kind]);
        found.next().map(|words| words.get(3).copied().unwrap_or(0))
    }

    /// The ids that have a decoration.
    pub fn decorated(&self, kind: u32) -> impl Iterator<Item = Id> {
        let all = self.decorations.iter().filter(|i| i.op == Op::Decorate).map(|i| &self[*i]);
        all.filter(move |words| words[2] == kind).map(|words| words[1])
    }

    /// Names or decorations by the ids that they are about.
    pub fn by_target(&self, list: &[Instruction]) -> HashMap<Id, Vec<Instruction>> {
        let mut all: HashMap<Id, Vec<Instruction>> = HashMap::new();
        list.iter().filter(|i| self[**i].len() > 2).for_each(|i| all.entry(self[*i][1]).or_default().push(*i));
        all
    }

    /// Whether an instruction stood before the first function when the module was read.
    pub fn is_global(&self, i: Instruction) -> bool {
        self.functions.first().is_none_or(|first| i.start < first.head[0].start)
    }

    /// The instructions of all functions.
    pub fn code(&self) -> impl Iterator<Item = Instruction> {
        self.functions.iter().flat_map(Function::instructions)
    }

    /// glslang's names of the functions that are called, in the order of the calls.
    pub fn called_functions(&self) -> impl Iterator<Item = String> {
        let calls = self.code().filter(|i| i.op == Op::FunctionCall);
        calls.filter_map(|i| self.name(self[i][3]))
    }

    /// The functions that one reaches by calls, itself included, by their places; callees come before their callers. `None` if it
    /// calls a function that the module lacks.
    pub fn callees_first(&self, root: Id) -> Option<Vec<usize>> {
        let mut places = vec![None; self.bound() as usize];
        self.functions.iter().enumerate().for_each(|(place, function)| places[function.id as usize] = Some(place));
        let (mut order, mut open, mut seen) = (Vec::new(), vec![(root, false)], vec![false; self.functions.len()]);
        while let Some((id, is_done)) = open.pop() {
            let place = (*places.get(id as usize)?)?;
            if is_done {
                order.push(place);
            } else if !std::mem::replace(&mut seen[place], true) {
                open.push((id, true));
                open.extend(self.functions[place].calls(self).map(|callee| (callee, false)));
            }
        }
        Some(order)
    }
}
