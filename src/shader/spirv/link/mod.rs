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

use foldhash::{HashMap, HashSet, HashSetExt};

use super::opcode as op;
use super::operands::is_id;
use super::specialize::{Id, Instruction, instruction, opcode};
use import::{Importer, header};
use parts::{Function, Parts, plain_name};

/// A module that edited functions can be linked into.
pub struct Base<'a>(Parts<'a>);

impl<'a> Base<'a> {
    /// Parses a module. `None` if it cannot be linked.
    pub fn parse(words: &'a [u32]) -> Option<Self> {
        Parts::parse(words).map(Self)
    }

    /// The names of the module's functions in GLSL.
    pub fn function_names(&self) -> BTreeSet<&str> {
        self.0.functions.iter().map(Function::plain_name).collect()
    }
}

/// Links the functions `edited` (names in GLSL) of the module `thin` into the module `base`. `caller` is the function
/// of `thin` that calls them. `None` if the result might differ from compiling the whole text.
pub fn link(Base(base): &Base<'_>, thin: &[u32], edited: &BTreeSet<Box<str>>, caller: &str) -> Option<Vec<u32>> {
    let thin = Parts::parse(thin)?;
    if !same_head(base, &thin) {
        return None;
    }
    let functions = select(base, &thin, edited, caller)?;
    let mut importer = Importer::new(base, &thin)?;
    // A function gets the id that its edited version or its stub has in the thin module, or a new id if there is
    // neither.
    let (base_names, thin_names) = (base.by_name()?, thin.by_name()?);
    for (function, _) in &functions {
        let Some(old) = base_names.get(function.name.as_str()) else { continue };
        match thin_names.get(function.name.as_str()) {
            Some(new) => importer.set(old.id, new.id)?,
            None => {
                let id = importer.fresh();
                importer.set(old.id, id)?;
                importer.describe(old.id, id);
            }
        }
    }
    let (mut code, mut locals) = (Vec::new(), vec![0; base.bound]);
    for (function, is_edited) in &functions {
        match is_edited {
            true => function.code.iter().for_each(|i| code.extend_from_slice(i)),
            false => import_function(&mut importer, function, &mut locals, &mut code)?,
        }
        code.extend(instruction(op::FUNCTION_END, &[]));
    }
    importer.describe_locals(&locals);
    if !importer.pointers_agree()? {
        return None;
    }
    let decorations = thin.decorations.all().chain(importer.decorations.iter().map(Vec::as_slice));
    let instructions = functions.iter().flat_map(|(function, _)| function.code.iter().copied());
    let capabilities = capability::capabilities(
        thin.entry[1],
        &base.capabilities,
        &thin.capabilities,
        decorations.chain(instructions),
    )?;
    write(&thin, &functions, importer, capabilities, code)
}

/// Whether two modules have the same extensions, memory model and execution modes.
fn same_head(base: &Parts<'_>, thin: &Parts<'_>) -> bool {
    fn head<'a>(parts: &Parts<'a>) -> BTreeSet<&'a [u32]> {
        parts.head.iter().copied().filter(|i| opcode(i) != op::EXT_INST_IMPORT).collect()
    }
    fn modes<'a>(parts: &Parts<'a>) -> BTreeSet<&'a [u32]> {
        parts.modes.iter().filter_map(|i| i.get(2..)).collect()
    }
    head(base) == head(thin) && modes(base) == modes(thin)
}

/// The functions of the new module, and whether each was edited. Leaves out functions that nothing calls anymore.
fn select<'a>(
    base: &'a Parts<'a>,
    thin: &'a Parts<'a>,
    edited: &BTreeSet<Box<str>>,
    caller: &str,
) -> Option<Vec<(Function<'a>, bool)>> {
    let is_edited = |name: &str| edited.contains(plain_name(name));
    let (base_names, thin_names) = (base.by_name()?, thin.by_name()?);
    let caller = thin.functions.iter().find(|f| f.plain_name() == caller).map(|f| f.id);
    let (base_ids, thin_ids) = (ids(base), ids(thin));
    // glslang drops functions that nothing calls, so the code that remains calls only functions of the module.
    let code_of = |name: &str| if is_edited(name) { thin_names.get(name) } else { base_names.get(name) };
    let calls = |name: &str, id: Id| {
        let ids = if is_edited(name) { &thin_ids } else { &base_ids };
        ids.get(&id).copied()
    };
    let entry = thin_ids.get(&thin.entry_id())?;
    let mut reached = HashSet::new();
    reach(entry, &mut reached, &mut Vec::new(), &|name| {
        let function = code_of(name)?;
        function.calls().filter(|id| Some(*id) != caller || !is_edited(name)).map(|id| calls(name, id)).collect()
    })?;
    let mut reached_before = HashSet::new();
    reach(entry, &mut reached_before, &mut Vec::new(), &|name| {
        base_names.get(name)?.calls().map(|id| base_ids.get(&id).copied()).collect()
    })?;
    let mut out = Vec::new();
    let is_kept = |name: &str| reached.contains(name) || !reached_before.contains(name);
    for function in base.functions.iter().filter(|function| is_kept(&function.name)) {
        if let Some(found) = code_of(&function.name) {
            out.push(copy(found, is_edited(&function.name), caller));
        }
    }
    let is_new = |f: &&Function<'_>| is_edited(&f.name) && !base_names.contains_key(f.name.as_str());
    let new = thin.functions.iter().filter(is_new).filter(|function| reached.contains(function.name.as_str()));
    out.extend(new.map(|function| copy(function, true, caller)));
    Some(out)
}

/// A function of the new module, without the call of `caller` that the thin text contains.
fn copy<'a>(function: &Function<'a>, is_edited: bool, caller: Option<Id>) -> (Function<'a>, bool) {
    let is_own = |i: &&[u32]| !is_edited || opcode(i) != op::FUNCTION_CALL || i.get(3).copied() != caller;
    let code = function.code.iter().copied().filter(is_own).collect();
    (Function { name: function.name.clone(), id: function.id, code }, is_edited)
}

fn ids<'a>(parts: &'a Parts<'_>) -> HashMap<Id, &'a str> {
    parts.functions.iter().map(|function| (function.id, function.name.as_str())).collect()
}

/// Adds the functions that `name` reaches. `None` if one is missing, or is recursive, which glslang refuses.
fn reach<'a>(
    name: &'a str,
    reached: &mut HashSet<&'a str>,
    open: &mut Vec<&'a str>,
    calls: &dyn Fn(&str) -> Option<Vec<&'a str>>,
) -> Option<()> {
    if open.contains(&name) {
        return None;
    }
    if !reached.insert(name) {
        return Some(());
    }
    open.push(name);
    for called in calls(name)? {
        reach(called, reached, open, calls)?;
    }
    open.pop();
    Some(())
}

/// Copies a function of the previous module. Its results get new ids, which are written to `locals`.
fn import_function(
    importer: &mut Importer<'_>,
    function: &Function<'_>,
    locals: &mut [Id],
    out: &mut Vec<u32>,
) -> Option<()> {
    for i in &function.code[1..] {
        if let Some(id) = result(i)? {
            let new = importer.fresh();
            importer.set(id, new)?;
            *locals.get_mut(id as usize)? = new;
        }
    }
    for i in &function.code {
        let start = out.len();
        out.extend_from_slice(i);
        for at in 1..i.len() {
            if is_id(i, at)? {
                out[start + at] = importer.id(i[at])?;
            }
        }
    }
    Some(())
}

/// The result of an instruction in a function. The outer `None` stands for an unknown instruction.
fn result(i: &[u32]) -> Option<Option<Id>> {
    is_id(i, 1)?;
    match opcode(i) {
        op::LABEL => Some(Some(*i.get(1)?)),
        code if op::WITHOUT_RESULT.contains(&code) => Some(None),
        _ => Some(Some(*i.get(2)?)),
    }
}

/// Writes the module: the declarations of `thin`, the imported declarations, and the code.
fn write(
    thin: &Parts<'_>,
    functions: &[(Function<'_>, bool)],
    importer: Importer<'_>,
    capabilities: Vec<u32>,
    code: Vec<u32>,
) -> Option<Vec<u32>> {
    // Names and decorations in stubs, and of functions that nothing calls anymore, are dropped.
    let kept: HashSet<Id> = functions.iter().filter(|(_, is_edited)| *is_edited).map(|(f, _)| f.id).collect();
    let replaced: HashSet<&str> = functions.iter().filter(|(_, is_edited)| !is_edited).map(|(f, _)| &*f.name).collect();
    let mut dropped = HashSet::new();
    for function in thin.functions.iter().filter(|function| !kept.contains(&function.id)) {
        if !replaced.contains(function.name.as_str()) {
            dropped.insert(function.id);
        }
        for i in &function.code[1..] {
            dropped.extend(result(i)?);
        }
    }
    let mut out = header(thin, importer.next_id());
    capabilities.into_iter().for_each(|capability| out.extend(instruction(op::CAPABILITY, &[capability])));
    thin.head.iter().for_each(|i| out.extend_from_slice(i));
    let variables: Vec<Id> = [&thin.entry[1..], &importer.variables].concat();
    out.extend(instruction(op::ENTRY_POINT, &variables));
    thin.modes.iter().chain(&thin.sources).for_each(|i| out.extend_from_slice(i));
    for (about, imported) in [(&thin.names, &importer.names), (&thin.decorations, &importer.decorations)] {
        about.all().filter(|i| !dropped.contains(&i[1])).for_each(|i| out.extend_from_slice(i));
        imported.iter().for_each(|i: &Instruction| out.extend_from_slice(i));
    }
    thin.globals.iter().for_each(|i| out.extend_from_slice(i));
    importer.globals.iter().for_each(|i| out.extend_from_slice(i));
    out.extend(code);
    Some(out)
}
