//! A module in parts, as the linker needs them.

use foldhash::HashMap;

use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::{is_id, text};
use crate::shader::spirv::specialize::{HEADER, Id, first_function, instructions, opcode};

/// Place of the bound on ids in a module's header.
pub const BOUND: usize = 3;

/// OpExtension
const EXTENSION: u32 = 10;
const MEMORY_MODEL: u32 = 14;

/// A function's instructions.
pub struct Function<'a> {
    /// glslang's name, which has the types of the parameters: `f(vf3;`.
    pub name: String,
    pub id: Id,
    pub code: Vec<&'a [u32]>,
}

impl Function<'_> {
    /// The name in GLSL.
    pub fn plain_name(&self) -> &str {
        plain_name(&self.name)
    }

    /// The functions that it calls.
    pub fn calls(&self) -> impl Iterator<Item = Id> {
        self.code.iter().filter(|i| opcode(i) == op::FUNCTION_CALL).filter_map(|i| i.get(3).copied())
    }
}

/// The name in GLSL of a function that glslang names `f(vf3;`.
pub fn plain_name(name: &str) -> &str {
    name.split('(').next().unwrap_or_default()
}

/// Instructions about ids, such as names and decorations, sorted by id.
#[derive(Default)]
pub struct ByTarget<'a>(Vec<&'a [u32]>);

impl<'a> ByTarget<'a> {
    fn sort(&mut self) -> Option<()> {
        let is_sound = self.0.iter().all(|i| i.len() > 2);
        is_sound.then(|| self.0.sort_by_key(|i| i[1]))
    }

    /// The instructions about an id, in the order of the module.
    pub fn of(&self, id: Id) -> &[&'a [u32]] {
        let start = self.0.partition_point(|i| i[1] < id);
        let count = self.0[start..].iter().take_while(|i| i[1] == id).count();
        &self.0[start..start + count]
    }

    /// All instructions, by id.
    pub fn all(&self) -> impl Iterator<Item = &'a [u32]> {
        self.0.iter().copied()
    }
}

/// A module with one entry point.
pub struct Parts<'a> {
    pub header: &'a [u32],
    pub bound: usize,
    pub capabilities: Vec<u32>,
    /// Extensions, imports, the memory model.
    pub head: Vec<&'a [u32]>,
    pub entry: &'a [u32],
    pub modes: Vec<&'a [u32]>,
    /// Sources, their extensions, and the tools that processed them.
    pub sources: Vec<&'a [u32]>,
    /// OpName and OpMemberName.
    pub names: ByTarget<'a>,
    pub decorations: ByTarget<'a>,
    /// Types, constants and variables.
    pub globals: Vec<&'a [u32]>,
    pub functions: Vec<Function<'a>>,
}

impl<'a> Parts<'a> {
    /// Splits a module. `None` if it is not valid, or has instructions that glslang does not emit for Specula's stages.
    pub fn parse(words: &'a [u32]) -> Option<Self> {
        let all = instructions(words)?;
        let (globals, code) = all.split_at(first_function(&all));
        let mut parts = Self {
            header: words.get(..HEADER)?,
            bound: words[BOUND] as usize,
            capabilities: Vec::new(),
            head: Vec::new(),
            entry: &[],
            modes: Vec::new(),
            sources: Vec::new(),
            names: ByTarget::default(),
            decorations: ByTarget::default(),
            globals: Vec::new(),
            functions: Vec::new(),
        };
        for &i in globals {
            match opcode(i) {
                op::CAPABILITY => parts.capabilities.push(*i.get(1)?),
                EXTENSION | op::EXT_INST_IMPORT | MEMORY_MODEL => parts.head.push(i),
                op::ENTRY_POINT if parts.entry.is_empty() && i.len() > 3 => parts.entry = i,
                op::EXECUTION_MODE => parts.modes.push(i),
                // OpSourceContinued, OpSource, OpSourceExtension, OpModuleProcessed
                2..=4 | 330 => parts.sources.push(i),
                op::NAME | op::MEMBER_NAME => parts.names.0.push(i),
                op::DECORATE | op::MEMBER_DECORATE => parts.decorations.0.push(i),
                op::TYPE_FORWARD_POINTER => parts.globals.push(i),
                op::UNDEF | 19..=33 | 41..=52 | op::VARIABLE => {
                    is_id(i, 1)?;
                    parts.globals.push(i);
                }
                _ => return None,
            }
        }
        parts.names.sort()?;
        parts.decorations.sort()?;
        for function in code.split(|i| opcode(i) == op::FUNCTION_END) {
            let Some(first) = function.first() else { continue };
            let id = *first.get(2)?;
            let name = parts.names.of(id).first().map(|i| text(&i[2..]))?;
            parts.functions.push(Function { name, id, code: function.to_vec() });
        }
        // The linker allocates tables of this many ids, so a bound far beyond the module's size is refused.
        (!parts.entry.is_empty() && parts.bound <= words.len() * 8).then_some(parts)
    }

    /// The entry point's function.
    pub fn entry_id(&self) -> Id {
        self.entry[2]
    }

    /// The functions by name. `None` if two functions have the same name.
    pub fn by_name(&self) -> Option<HashMap<&str, &Function<'a>>> {
        let map: HashMap<&str, &Function<'a>> = self.functions.iter().map(|f| (f.name.as_str(), f)).collect();
        (map.len() == self.functions.len()).then_some(map)
    }
}

/// Place of the id that a global instruction defines.
pub fn result_place(i: &[u32]) -> usize {
    if matches!(opcode(i), 19..=39) { 1 } else { 2 }
}
