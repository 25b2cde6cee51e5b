//! Links edited functions into a module.
//!
//! The edited functions come from a thin module, which has all declarations of the new text, but only stubs of the
//! other functions. The new module takes its declarations from the thin module. From the previous module it takes all
//! functions that were not edited, with the types, constants and built-in variables that these functions need. So
//! nothing of the old text remains, however many edits follow.
//!
//! Functions are matched by glslang's names, which contain the types of their parameters. All other declarations are
//! matched by their instruction, names and decorations. If a match is ambiguous, linking fails, and the stage is
//! compiled as a whole.

mod capability;
mod import;
mod parts;

use std::collections::BTreeSet;

use foldhash::{HashSet, HashSetExt};

use super::fold::drop_results;
use super::module::{Block, Function, Id, Module};
use super::op::Op;
use import::Importer;
use parts::{Parts, plain_name};

/// A module that edited functions can be linked into.
pub struct Base(Parts);

impl Base {
    /// Parses a module. `None` if it cannot be linked.
    pub fn parse(words: &[u32]) -> Option<Self> {
        Parts::parse(words).map(Self)
    }

    /// The names of the module's functions in GLSL.
    pub fn function_names(&self) -> BTreeSet<&str> {
        self.0.names.iter().map(|name| plain_name(name)).collect()
    }
}

/// Links the functions `edited` (names in GLSL) of the module `thin` into the module `base`. `caller` is the function
/// of `thin` that calls them. `None` if the result might differ from compiling the whole text.
pub fn link(Base(base): &Base, thin: &[u32], edited: &BTreeSet<Box<str>>, caller: &str) -> Option<Vec<u32>> {
    let thin = Parts::parse(thin)?;
    if !same_head(&base.module, &thin.module) {
        return None;
    }
    let Selection { functions: selected, caller } = Selection::new(base, &thin, edited, caller)?;
    let (kept, replaced): (Vec<&Selected>, Vec<&Selected>) = selected.iter().partition(|function| function.is_edited);
    let dropped = dropped(
        &thin,
        &kept.iter().map(|function| function.name.as_str()).collect(),
        &replaced.iter().map(|function| function.name.as_str()).collect(),
    );
    let mut importer = Importer::new(base, thin)?;
    // A function gets the id that its edited version or its stub has in the thin module, or a new id if there is
    // neither.
    for function in &selected {
        let Some(old) = base.function(&function.name).map(|function| function.id) else { continue };
        match importer.to.function(&function.name).map(|function| function.id) {
            Some(new) => importer.set(old, new)?,
            None => importer.add(old)?,
        }
    }
    let mut functions = Vec::new();
    for function in &selected {
        functions.push(match function.is_edited {
            true => importer.to.take(&function.name, caller)?,
            false => import_function(&mut importer, base.function(&function.name)?)?,
        });
    }
    if !importer.pointers_agree()? {
        return None;
    }
    let Importer { to: Parts { mut module, .. }, variables, .. } = importer;
    module.functions = functions;
    module.join_interface(&variables);
    capability::declare(&mut module, &base.module)?;
    drop_results(&mut module, &dropped);
    Some(module.write())
}

/// Whether two modules have the same extensions, memory model and execution modes.
fn same_head(base: &Module, thin: &Module) -> bool {
    fn words(module: &Module, is_wanted: fn(Op) -> bool, from: usize) -> BTreeSet<&[u32]> {
        module.head.iter().filter(|i| is_wanted(i.op)).map(|i| &module[*i][from..]).collect()
    }
    let same = |is_wanted: fn(Op) -> bool, from| words(base, is_wanted, from) == words(thin, is_wanted, from);
    same(|op| matches!(op, Op::Extension | Op::MemoryModel), 0) && same(|op| op == Op::ExecutionMode, 2)
}

/// A function of the new module.
struct Selected {
    name: String,
    is_edited: bool,
}

/// The functions of the new module.
struct Selection {
    functions: Vec<Selected>,
    /// The function of the thin module that calls the edited functions.
    caller: Option<Id>,
}

impl Selection {
    /// Leaves out functions that nothing calls anymore.
    fn new(base: &Parts, thin: &Parts, edited: &BTreeSet<Box<str>>, caller: &str) -> Option<Self> {
        let is_edited = |name: &str| edited.contains(plain_name(name));
        let caller =
            thin.names.iter().position(|name| plain_name(name) == caller).map(|at| thin.module.functions[at].id);
        let parts_of = |name: &str| if is_edited(name) { thin } else { base };
        let entry = thin.name_of(thin.module.entry_function()?)?;
        // glslang drops functions that nothing calls, so the code that remains calls only functions of the module.
        let mut reached = HashSet::new();
        reach(&entry, &mut reached, &mut Vec::new(), &|name| {
            let is_own = |id: &Id| Some(*id) != caller || !is_edited(name);
            parts_of(name).calls(name, is_own)
        })?;
        let mut reached_before = HashSet::new();
        reach(&entry, &mut reached_before, &mut Vec::new(), &|name| base.calls(name, |_| true))?;
        let is_kept = |name: &&String| reached.contains(*name) || !reached_before.contains(*name);
        let old = base.names.iter().filter(is_kept).filter(|name| parts_of(name).function(name).is_some());
        let is_new = |name: &&String| is_edited(name) && base.function(name).is_none() && reached.contains(*name);
        let all = old.chain(thin.names.iter().filter(is_new));
        let functions = all.map(|name| Selected { name: name.clone(), is_edited: is_edited(name) }).collect();
        Some(Self { functions, caller })
    }
}

/// Adds the functions that `name` reaches. `None` if one is missing, or is recursive, which glslang refuses.
fn reach(
    name: &str,
    reached: &mut HashSet<String>,
    open: &mut Vec<String>,
    calls: &dyn Fn(&str) -> Option<Vec<String>>,
) -> Option<()> {
    if open.iter().any(|open| open == name) {
        return None;
    }
    if !reached.insert(name.to_owned()) {
        return Some(());
    }
    open.push(name.to_owned());
    for called in calls(name)? {
        reach(&called, reached, open, calls)?;
    }
    open.pop();
    Some(())
}

/// The ids of the thin module that stubs define, and functions that nothing calls anymore, by the names of the functions that it keeps
/// and that functions of the previous module replace.
fn dropped(thin: &Parts, kept: &HashSet<&str>, replaced: &HashSet<&str>) -> HashSet<Id> {
    let mut dropped = HashSet::new();
    for (function, name) in
        thin.module.functions.iter().zip(&thin.names).filter(|(_, name)| !kept.contains(name.as_str()))
    {
        dropped.extend(function.results(&thin.module));
        if !replaced.contains(name.as_str()) {
            dropped.insert(function.id);
        }
    }
    dropped
}

/// Copies a function of the previous module. Its results get new ids. `None` if an instruction is unknown.
fn import_function(importer: &mut Importer<'_>, function: &Function) -> Option<Function> {
    let results: Vec<Id> = function.results(&importer.from.module).collect();
    results.into_iter().try_for_each(|id| importer.add(id))?;
    let head = function.head.iter().map(|i| importer.copy(*i)).collect::<Option<_>>()?;
    let mut blocks = Vec::new();
    for block in &function.blocks {
        let body = block.body.iter().map(|i| importer.copy(*i)).collect::<Option<_>>()?;
        blocks.push(Block { label: importer.id(block.label)?, body });
    }
    Some(Function { id: importer.id(function.id)?, head, blocks })
}
