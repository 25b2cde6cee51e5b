//! A hash of what a module does: equal for modules that differ only in the numbers of their ids, in names, in declarations
//! that nothing uses, or in types and constants that are declared more than once. An edit elsewhere in the source moves all ids
//! behind it, so a hash of the words would tell most edits from each other that the driver cannot.

use foldhash::{HashMap, HashMapExt};

use xxhash_rust::xxh3::Xxh3;

use super::opcode as op;
use super::operands::is_id;

const HEADER: usize = 5;

/// Hashes a module with one entry point. Words that are not valid SPIR-V are hashed as they are.
pub fn behavior_hash(words: &[u32]) -> u64 {
    let hashed = Module::parse(words).map(|module| Hasher::new(&module).run());
    hashed.unwrap_or_else(|| {
        let mut hasher = Xxh3::new();
        words.iter().for_each(|word| hasher.update(&word.to_le_bytes()));
        hasher.digest()
    })
}

/// The instructions of a module by what they define.
#[derive(Default)]
struct Module<'a> {
    /// Capabilities, memory model, entry point, execution modes.
    head: Vec<&'a [u32]>,
    /// Types, constants and variables by id.
    globals: HashMap<u32, &'a [u32]>,
    /// `OpDecorate` and `OpMemberDecorate` by target, in the order of the module.
    decorations: HashMap<u32, Vec<&'a [u32]>>,
    functions: HashMap<u32, Vec<&'a [u32]>>,
    /// The first type or constant that is equal to one, by id, if it is another. glslang declares arrays once per block.
    first: HashMap<u32, u32>,
}

impl<'a> Module<'a> {
    fn parse(words: &'a [u32]) -> Option<Self> {
        let mut module = Self::default();
        let mut rest = words.get(HEADER..)?;
        let mut function = None;
        // Types and constants, in the order of the module
        let mut values = Vec::new();
        while let Some(first) = rest.first() {
            let length = (first >> 16) as usize;
            let i = rest.get(..length).filter(|i| !i.is_empty())?;
            rest = &rest[length..];
            let code = i[0] & 0xffff;
            if code == op::FUNCTION {
                function = Some(*i.get(2)?);
            }
            if let Some(id) = function {
                module.functions.entry(id).or_default().push(i);
                if code == op::FUNCTION_END {
                    function = None;
                }
                continue;
            }
            match code {
                // OpSource, its extensions, strings, names and lines say nothing to a driver.
                2..=8 | 317 | 330 => {}
                op::DECORATE | op::MEMBER_DECORATE => module.decorations.entry(*i.get(1)?).or_default().push(i),
                // OpExtInstImport, and types: the result is the first operand.
                11 | op::TYPE_FORWARD_POINTER => _ = module.globals.insert(*i.get(1)?, i),
                op::VARIABLE => _ = module.globals.insert(*i.get(2)?, i),
                1 | 19..=33 | 41..=52 => {
                    let place = if code < op::TYPE_FORWARD_POINTER && code != op::UNDEF { 1 } else { 2 };
                    module.globals.insert(*i.get(place)?, i);
                    values.push((i[place], place, i));
                }
                _ => module.head.push(i),
            }
        }
        module.find_equal(&values);
        Some(module)
    }

    /// Fills `first` from types and constants: id, its place in the instruction, the instruction. All operands of an instruction
    /// precede it, but for the target of a pointer that is declared before, whose number then tells two pointers apart.
    fn find_equal(&mut self, values: &[(u32, usize, &[u32])]) {
        let mut seen: HashMap<Vec<u32>, u32> = HashMap::with_capacity(values.len());
        for (id, place, i) in values {
            let operand = |at: usize| match is_id(i, at) {
                Some(true) => self.first.get(&i[at]).copied().unwrap_or(i[at]),
                _ => i[at],
            };
            let mut key = vec![i[0]];
            key.extend((1..i.len()).filter(|at| at != place).map(operand));
            for decoration in self.decorations.get(id).into_iter().flatten() {
                key.push(decoration[0]);
                key.extend_from_slice(&decoration[2..]);
            }
            let first = *seen.entry(key).or_insert(*id);
            if first != *id {
                self.first.insert(*id, first);
            }
        }
    }
}

/// Hashes a module from its entry point on. Ids are numbered in the order in which they are met.
struct Hasher<'a> {
    module: &'a Module<'a>,
    numbers: HashMap<u32, u32>,
    /// Functions that were met and are still to be hashed.
    open: Vec<u32>,
    hasher: Xxh3,
}

impl<'a> Hasher<'a> {
    fn new(module: &'a Module<'a>) -> Self {
        Self { module, numbers: HashMap::new(), open: Vec::new(), hasher: Xxh3::new() }
    }

    fn run(mut self) -> u64 {
        for i in &self.module.head {
            self.instruction(i);
        }
        while let Some(id) = self.open.pop() {
            for i in self.module.functions.get(&id).into_iter().flatten() {
                self.instruction(i);
            }
        }
        self.hasher.digest()
    }

    fn word(&mut self, word: u32) {
        self.hasher.update(&word.to_le_bytes());
    }

    fn instruction(&mut self, i: &[u32]) {
        self.word(i[0] & 0xffff);
        // The entry point also lists the variables of functions that nothing calls.
        let operands = if i[0] & 0xffff == op::ENTRY_POINT { i.len().min(3) } else { i.len() };
        for (at, word) in i.iter().enumerate().take(operands).skip(1) {
            // The literals of an unknown instruction cannot be told from its ids. As literals, they make hashes differ too
            // often, never too rarely.
            match is_id(i, at).unwrap_or(false) {
                true => self.id(*word),
                false => self.word(*word),
            }
        }
    }

    /// Hashes the number of an id, and at its first occurrence what defines it.
    fn id(&mut self, id: u32) {
        let id = self.module.first.get(&id).copied().unwrap_or(id);
        let next = self.numbers.len() as u32;
        let number = *self.numbers.entry(id).or_insert(next);
        self.word(number);
        if number != next {
            return;
        }
        for decoration in self.module.decorations.get(&id).into_iter().flatten() {
            self.word(decoration[0]);
            decoration[2..].iter().for_each(|word| self.word(*word));
        }
        if let Some(global) = self.module.globals.get(&id) {
            self.instruction(global);
        } else if self.module.functions.contains_key(&id) {
            self.open.push(id);
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
