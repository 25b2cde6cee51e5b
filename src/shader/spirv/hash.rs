//! A hash of what a module does: equal for modules that differ only in the numbers of their ids, in names, in declarations
//! that nothing uses, or in types and constants that are declared more than once. An edit elsewhere in the source moves all ids
//! behind it, so a hash of the words would tell most edits from each other that the driver cannot.

use foldhash::{HashMap, HashMapExt};
use xxhash_rust::xxh3::Xxh3;

use super::module::{Id, Instruction, Module};
use super::op::{Class, Op};

/// Hashes a module with one entry point. Words that are not valid SPIR-V are hashed as they are.
pub fn behavior_hash(words: &[u32]) -> u64 {
    let hashed = Module::parse(words).map(|module| Hasher::new(&module).run());
    hashed.unwrap_or_else(|| {
        let mut hasher = Xxh3::new();
        words.iter().for_each(|word| hasher.update(&word.to_le_bytes()));
        hasher.digest()
    })
}

/// Hashes a module from its entry point on. Ids are numbered in the order in which they are met.
struct Hasher<'a> {
    module: &'a Module,
    /// Decorations by target, in the order of the module.
    decorations: HashMap<Id, Vec<Instruction>>,
    /// The first type or constant that is equal to one, by id. glslang declares arrays once per block.
    first: HashMap<Id, Id>,
    numbers: HashMap<Id, u32>,
    /// Functions that were met and are still to be hashed.
    open: Vec<Id>,
    hasher: Xxh3,
}

impl<'a> Hasher<'a> {
    fn new(module: &'a Module) -> Self {
        let decorations = module.by_target(&module.decorations);
        let (numbers, open, hasher) = (HashMap::new(), Vec::new(), Xxh3::new());
        let mut hasher = Self { module, decorations, first: HashMap::new(), numbers, open, hasher };
        hasher.find_equal();
        hasher
    }

    /// Fills `first`. All operands of a declaration precede it, but for the target of a pointer that is declared before, whose number
    /// then tells two pointers apart.
    fn find_equal(&mut self) {
        let is_value = |i: &&Instruction| matches!(i.op.class(), Class::Type | Class::Constant);
        let mut seen: HashMap<Vec<u32>, Id> = HashMap::with_capacity(self.module.globals.len());
        for i in self.module.globals.iter().filter(is_value) {
            let (words, Some(place)) = (&self.module[*i], i.op.result()) else { continue };
            let id = words[place];
            let mut key = vec![words[0]];
            for at in (1..words.len()).filter(|at| *at != place) {
                let first = self.first.get(&words[at]).filter(|_| i.op.is_id(words, at));
                key.push(first.copied().unwrap_or(words[at]));
            }
            for decoration in self.decorations.get(&id).into_iter().flatten().map(|i| &self.module[*i]) {
                key.push(decoration[0]);
                key.extend_from_slice(&decoration[2..]);
            }
            let first = *seen.entry(key).or_insert(id);
            if first != id {
                self.first.insert(id, first);
            }
        }
    }

    fn run(mut self) -> u64 {
        let module = self.module;
        let head = module.head.iter().filter(|i| i.op != Op::ExtInstImport);
        let unknown = module.globals.iter().chain(&module.decorations).filter(|i| !i.op.is_known());
        head.chain(unknown).for_each(|i| self.instruction(*i));
        let functions: HashMap<Id, usize> = module.functions.iter().enumerate().map(|(at, f)| (f.id, at)).collect();
        while let Some(id) = self.open.pop() {
            let function = &module.functions[functions[&id]];
            function.head.iter().for_each(|i| self.instruction(*i));
            for block in &function.blocks {
                self.word(Op::Label as u32);
                self.id(block.label);
                block.body.iter().for_each(|i| self.instruction(*i));
            }
            self.word(Op::FunctionEnd as u32);
        }
        self.hasher.digest()
    }

    fn word(&mut self, word: u32) {
        self.hasher.update(&word.to_le_bytes());
    }

    fn instruction(&mut self, i: Instruction) {
        let words = &self.module[i];
        self.word(words[0] & 0xffff);
        // The entry point also lists the variables of functions that nothing calls.
        let count = if i.op == Op::EntryPoint { 3 } else { words.len() };
        for (at, word) in words.iter().enumerate().take(count).skip(1) {
            // The literals of an unknown instruction cannot be told from its ids. As literals, they make hashes differ too
            // often, never too rarely.
            match i.op.is_id(words, at) {
                true => self.id(*word),
                false => self.word(*word),
            }
        }
    }

    /// Hashes the number of an id, and at its first occurrence what defines it.
    fn id(&mut self, id: Id) {
        let id = self.first.get(&id).copied().unwrap_or(id);
        let next = self.numbers.len() as u32;
        let number = *self.numbers.entry(id).or_insert(next);
        self.word(number);
        if number != next {
            return;
        }
        for i in self.decorations.get(&id).cloned().unwrap_or_default() {
            let decoration = &self.module[i];
            self.word(decoration[0]);
            decoration[2..].iter().for_each(|word| self.word(*word));
        }
        match self.module.definition(id) {
            Some(i) if i.op == Op::Function => self.open.push(id),
            Some(i) if self.module.is_global(i) => self.instruction(i),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::specialize;

    fn hash(text: &str, kind: u32) -> u64 {
        let source = Source::memory([("m.frag", text)]);
        let words = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap();
        behavior_hash(&specialize(&words, &[(7, kind)]))
    }

    const TEXT: &str = "#version 460
        layout(constant_id = 7) const uint KIND = 0u;
        layout(location = 0) in vec4 x;
        layout(location = 0) out vec4 color;
        vec4 first() { vec4 y = x; for (int i = 0; i < 4; ++i) { if (y.x > 2.0) break; y.zw = cos(y).xy; } return y; }
        vec4 second(vec4 z) { return exp(z) * 3.0; }
        void main() { color = KIND == 0u ? vec4(1.0) : vec4(0.5); if (KIND == 0u) color += first(); else color = second(x); }";

    #[test]
    fn only_what_is_called_counts() {
        let edits = [
            // Code that no constant selects, with new types and constants in front of all others
            ("exp(z) * 3.0", "mat2(z.x) * z.xy == vec2(7.0) ? exp2(z) : sin(z) * 5.0", false),
            ("vec4 second(vec4 z)", "/* a comment */ vec4 second(vec4 renamed)", false),
            ("y.x > 2.0", "y.y > 2.0", true),
            ("y.x > 2.0", "y.x > 2.5", true),
            ("i < 4", "i < 5", true),
            (".xy;", ".yx;", true),
            ("cos(y)", "sin(y)", true),
            ("location = 0) in", "location = 1) in", true),
            ("color += first()", "color -= first()", true),
        ];
        for (from, to, differs) in edits {
            let to = to.replace("renamed)", "z)");
            let edited = TEXT.replacen(from, &to, 1);
            assert_ne!(edited, TEXT);
            assert_eq!(hash(&edited, 0) != hash(TEXT, 0), differs, "{from} -> {to}");
        }
        assert_ne!(hash(TEXT, 0), hash(TEXT, 1));
    }

    #[test]
    fn garbage_has_a_hash() {
        assert_ne!(behavior_hash(&[]), behavior_hash(&[1, 2, 3]));
        behavior_hash(&[0x0723_0203, 0, 0, 9, 0, 0xffff_0036]);
        behavior_hash(&[0x0723_0203, 0, 0, 9, 0, 0x0001_000f]);
    }
}
