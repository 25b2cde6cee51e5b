//! A module with the tables that the linker needs.

use foldhash::HashMap;

use crate::shader::spirv::module::{Function, Id, Instruction, Module};
use crate::shader::spirv::op::{Class, Op, text};

/// A module with one entry point.
pub struct Parts {
    pub module: Module,
    /// Names and decorations by target.
    about: [HashMap<Id, Vec<Instruction>>; 2],
    /// The functions' names, which have the types of the parameters: `f(vf3;`.
    pub names: Vec<String>,
    /// The functions' places by name.
    pub places: HashMap<String, usize>,
}

impl Parts {
    /// Reads a module. `None` if it is not valid, has instructions that glslang does not emit for Specula's stages, or two functions
    /// with the same name.
    pub fn parse(words: &[u32]) -> Option<Self> {
        let module = Module::parse(words)?;
        module.entry()?;
        let is_known = |i: &Instruction| match i.op {
            Op::Extension | Op::ExtInstImport | Op::MemoryModel | Op::EntryPoint => true,
            Op::ExecutionMode | Op::Capability | Op::Decorate | Op::MemberDecorate | Op::Variable => true,
            op => matches!(op.class(), Class::Type | Class::Constant),
        };
        let declarations = [&module.head, &module.decorations, &module.globals].into_iter().flatten();
        let is_usual = declarations.into_iter().all(is_known) && module.debug.iter().all(|i| i.op != Op::String);
        if !is_usual {
            return None;
        }
        let about = [module.by_target(&module.debug), module.by_target(&module.decorations)];
        let name = |function: &Function| name_of(&module, &about[0], function.id);
        let names: Vec<String> = module.functions.iter().map(name).collect::<Option<_>>()?;
        let places: HashMap<String, usize> = names.iter().cloned().zip(0..).collect();
        (places.len() == names.len()).then_some(Self { module, about, names, places })
    }

    /// The function with this name.
    pub fn function(&self, name: &str) -> Option<&Function> {
        self.places.get(name).map(|place| &self.module.functions[*place])
    }

    /// The names and the decorations of an id, in the order of the module.
    pub fn about(&self, id: Id) -> [&[Instruction]; 2] {
        self.about.each_ref().map(|about| about.get(&id).map_or(&[][..], |all| all))
    }

    /// The names of the functions that a function calls, as far as a condition holds. `None` if there is no such function, or one of
    /// those that it calls is missing.
    pub fn calls(&self, name: &str, is_wanted: impl Fn(&Id) -> bool) -> Option<Vec<String>> {
        self.function(name)?.calls(&self.module).filter(is_wanted).map(|id| self.name_of(id)).collect()
    }

    /// Takes a function out of the module, without its calls of `caller`.
    pub fn take(&mut self, name: &str, caller: Option<Id>) -> Option<Function> {
        let module = &mut self.module;
        let function = &mut module.functions[*self.places.get(name)?];
        let mut function = Function {
            id: function.id,
            head: std::mem::take(&mut function.head),
            blocks: std::mem::take(&mut function.blocks),
        };
        for block in &mut function.blocks {
            block.body.retain(|i| i.op != Op::FunctionCall || Some(module[*i][3]) != caller);
        }
        Some(function)
    }

    /// The first name of an id.
    pub fn name_of(&self, id: Id) -> Option<String> {
        name_of(&self.module, &self.about[0], id)
    }
}

fn name_of(module: &Module, names: &HashMap<Id, Vec<Instruction>>, id: Id) -> Option<String> {
    let name = names.get(&id)?.iter().find(|i| i.op == Op::Name)?;
    Some(text(&module[*name][2..]))
}

/// The name in GLSL of a function that glslang names `f(vf3;`.
pub fn plain_name(name: &str) -> &str {
    name.split('(').next().unwrap_or_default()
}
