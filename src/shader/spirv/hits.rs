//! Copies of the functions that random paths call at a hit, for a place without neighbors.
//!
//! A path runs in a loop that neighboring pixels leave at other times, so its implicit levels of detail and derivatives are undefined
//! (SPIR-V specification, section 2.20), and a `discard` would end the pixel because of what another surface looks like. The author's
//! hook into the material, which the picture calls as well, may do all three. In the copies that hits call, textures are read at
//! level 0, derivatives are 0, and a discard sets a variable and returns.

use foldhash::{HashMap, HashMapExt, HashSet};

use super::module::{Block, Function, Id, Instruction, Module};
use super::op::Op;

/// glslang's name of the function that hits call begins like this (paths/scene.glsl).
const ROOT: &str = "hooked_surface(";
/// The variable that a discard sets.
const DISCARDED: &str = "is_discarded_at_hit\0";

/// Bits of image operands: Bias and MinLod go with the implicit level, Lod takes its place.
const BIAS: u32 = 0x1;
const LOD: u32 = 0x2;
const MIN_LOD: u32 = 0x80;

/// Makes copies for hits. A module without such functions, or one whose functions need no neighbors, stays as it is. So does one
/// with an unknown instruction in them.
pub fn separate_hits(module: &mut Module) {
    let Some(root) = module.named(ROOT).next() else { return };
    let copied = needing(module, root);
    let is_copied = |function: &Function| copied.contains(&function.id);
    if !module.functions.iter().filter(|f| is_copied(f)).flat_map(Function::instructions).all(|i| i.op.is_known()) {
        return;
    }
    let discarded = module.named(DISCARDED).next();
    // Only hits call the root, so it is changed in its place.
    let copies: HashMap<Id, Id> = copied.iter().filter(|id| **id != root).map(|id| (*id, module.fresh(0))).collect();
    let mut copier = Copier { module, discarded, copies };
    for function in std::mem::take(&mut copier.module.functions) {
        let is_root = function.id == root;
        if copied.contains(&function.id) {
            let ids = if is_root { HashMap::new() } else { copier.renamed(&function) };
            let copy = copier.copy(&function, &ids);
            copier.module.functions.push(copy);
        }
        if !(is_root && copied.contains(&root)) {
            copier.module.functions.push(function);
        }
    }
}

/// The functions that `root` reaches, itself among them, that need neighbors or call one that does.
fn needing(module: &Module, root: Id) -> HashSet<Id> {
    let mut found = HashSet::default();
    for place in module.callees_first(root).unwrap_or_default() {
        let function = &module.functions[place];
        let calls = |callee: Id| found.contains(&callee);
        if function.body().any(|i| needs_neighbors(i.op)) || function.calls(module).any(calls) {
            found.insert(function.id);
        }
    }
    found
}

fn needs_neighbors(op: Op) -> bool {
    op == Op::ImageQueryLod || explicit(op).is_some() || is_derivative(op) || is_discard(op)
}

/// The operation that samples as this one does, with an explicit level.
fn explicit(op: Op) -> Option<Op> {
    match op {
        Op::ImageSampleImplicitLod => Some(Op::ImageSampleExplicitLod),
        Op::ImageSampleDrefImplicitLod => Some(Op::ImageSampleDrefExplicitLod),
        Op::ImageSampleProjImplicitLod => Some(Op::ImageSampleProjExplicitLod),
        Op::ImageSampleProjDrefImplicitLod => Some(Op::ImageSampleProjDrefExplicitLod),
        _ => None,
    }
}

fn is_derivative(op: Op) -> bool {
    (Op::DPdx..=Op::FwidthCoarse).contains(&op)
}

fn is_discard(op: Op) -> bool {
    matches!(op, Op::Kill | Op::TerminateInvocation | Op::DemoteToHelperInvocation)
}

struct Copier<'a> {
    module: &'a mut Module,
    /// The variable that a discard sets.
    discarded: Option<Id>,
    /// The copies, by the ids of the functions that they copy.
    copies: HashMap<Id, Id>,
}

impl Copier<'_> {
    /// New ids for all that a function defines. They have the decorations of the old ones.
    fn renamed(&mut self, function: &Function) -> HashMap<Id, Id> {
        let results: Vec<Id> = function.results(self.module).collect();
        let mut ids: HashMap<Id, Id> = results.into_iter().map(|id| (id, self.module.fresh(0))).collect();
        for place in 0..self.module.decorations.len() {
            let i = self.module.decorations[place];
            if let Some(id) = ids.get(&self.module[i][1]).filter(|_| i.op == Op::Decorate) {
                let copy = self.module.about(i, *id);
                self.module.decorations.push(copy);
            }
        }
        ids.insert(function.id, self.copies[&function.id]);
        ids
    }

    /// A function for hits, with other ids.
    fn copy(&mut self, function: &Function, ids: &HashMap<Id, Id>) -> Function {
        let renamed = |id: Id| ids.get(&id).copied().unwrap_or(id);
        let returned = function.returns(self.module);
        let head = function.head.iter().map(|i| self.module.copy(*i, renamed)).collect();
        let mut blocks = Vec::new();
        for block in &function.blocks {
            let mut body = Vec::new();
            for i in &block.body {
                let i = self.module.copy(*i, renamed);
                self.without_neighbors(i, returned, &mut body);
            }
            blocks.push(Block { label: renamed(block.label), body });
        }
        Function { id: renamed(function.id), head, blocks }
    }

    /// Appends what does the same as an instruction where there are no neighbors. `returned`: the type that the function returns.
    fn without_neighbors(&mut self, i: Instruction, returned: Id, out: &mut Vec<Instruction>) {
        let module = &mut *self.module;
        if let Some(explicit) = explicit(i.op) {
            let float = module.declare(Op::TypeFloat, &[32]);
            let zero = module.declare(Op::ConstantNull, &[float]);
            // A reference of a comparison stands before the mask.
            let has_reference = matches!(i.op, Op::ImageSampleDrefImplicitLod | Op::ImageSampleProjDrefImplicitLod);
            let at = if has_reference { 6 } else { 5 };
            let words = &module[i];
            let mask = words.get(at).copied().unwrap_or(0);
            let mut operands = words.get(at + 1..).unwrap_or_default().to_vec();
            if mask & BIAS != 0 {
                operands.remove(0);
            }
            if mask & MIN_LOD != 0 {
                operands.pop();
            }
            let mask = mask & !(BIAS | MIN_LOD) | LOD;
            let operands = [&words[1..at], &[mask, zero], &operands].concat();
            out.push(module.make(explicit, &operands));
        } else if i.op == Op::ImageQueryLod || is_derivative(i.op) {
            let (kind, id) = (module[i][1], module[i][2]);
            let zero = module.declare(Op::ConstantNull, &[kind]);
            out.push(module.make(Op::CopyObject, &[kind, id, zero]));
        } else if is_discard(i.op) {
            if let Some(variable) = self.discarded {
                let boolean = module.declare(Op::TypeBool, &[]);
                let truth = module.declare(Op::ConstantTrue, &[boolean]);
                out.push(module.make(Op::Store, &[variable, truth]));
            }
            if i.op != Op::DemoteToHelperInvocation {
                out.push(module.return_zero(returned));
            }
        } else {
            if i.op == Op::FunctionCall {
                let called = module[i][3];
                module[i][3] = self.copies.get(&called).copied().unwrap_or(called);
            }
            out.push(i);
        }
    }
}

#[cfg(test)]
#[path = "hits_tests.rs"]
mod tests;
