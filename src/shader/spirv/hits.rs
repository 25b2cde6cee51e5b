//! Copies of the functions that random paths call at a hit, for a place without neighbors.
//!
//! A path runs in a loop that neighboring pixels leave at other times, so its implicit levels of detail and derivatives are undefined
//! (SPIR-V specification, section 2.20), and a `discard` would end the pixel because of what another surface looks like. The author's
//! hook into the material, which the picture calls as well, may do all three. In the copies that hits call, textures are read at
//! level 0, derivatives are 0, and a discard sets a variable and returns.

use foldhash::{HashMap, HashMapExt, HashSet};

use super::opcode as op;
use super::operands::{is_id, text};
use super::specialize::control_flow::{Block, Function};
use super::specialize::{HEADER, Id, Instruction, first_function, instruction, instructions, opcode};

/// glslang's name of the function that hits call begins like this (paths/scene.glsl).
const ROOT: &str = "hooked_surface(";
/// The variable that a discard sets.
const DISCARDED: &str = "is_discarded_at_hit";

/// Bits of image operands: Bias and MinLod go with the implicit level, Lod takes its place.
const BIAS: u32 = 0x1;
const LOD: u32 = 0x2;
const MIN_LOD: u32 = 0x80;

/// OpFunctionParameter, OpImageQueryLod
const PARAMETER: u32 = 55;
const QUERY_LOD: u32 = 105;
/// OpImageSampleImplicitLod, and the same with a comparison, a projection, and both. The opcode after each is that with an explicit level.
const SAMPLES: [u32; 4] = [87, 89, 91, 93];
/// OpDPdx to OpFwidthCoarse
const DERIVATIVES: std::ops::RangeInclusive<u32> = 207..=215;
const DISCARDS: [u32; 3] = [op::KILL, op::TERMINATE_INVOCATION, op::DEMOTE_TO_HELPER_INVOCATION];

/// The module with copies for hits. A module without such functions, or one whose functions need no neighbors, stays as it is.
pub fn separate_hits(words: Vec<u32>) -> Vec<u32> {
    separated(&words).unwrap_or(words)
}

/// `None` if there is nothing to change, or if an instruction is unknown.
fn separated(words: &[u32]) -> Option<Vec<u32>> {
    let all = instructions(words)?;
    let (globals, code) = all.split_at(first_function(&all));
    let named = |is_wanted: &dyn Fn(&str) -> bool| {
        globals.iter().find(|i| opcode(i) == op::NAME && is_wanted(&text(&i[2..]))).map(|i| i[1])
    };
    let root = named(&|name| name.starts_with(ROOT))?;
    let functions: Vec<Function> =
        code.split_inclusive(|i| opcode(i) == op::FUNCTION_END).map(Function::parse).collect::<Option<_>>()?;
    let at: HashMap<Id, usize> = functions.iter().enumerate().map(|(at, function)| (function.id, at)).collect();
    let copied = needing(&functions, &at, root);
    if copied.is_empty() {
        return None;
    }
    let mut copier = Copier {
        globals: globals.iter().map(|i| i.to_vec()).collect(),
        bound: *words.get(3)?,
        discarded: named(&|name| name == DISCARDED),
        nulls: HashMap::new(),
        functions: HashMap::new(),
    };
    // Only hits call the root, so it is changed in its place.
    for function in functions.iter().filter(|f| f.id != root && copied.contains(&f.id)) {
        let fresh = copier.fresh();
        copier.functions.insert(function.id, fresh);
    }
    let mut out = Vec::new();
    for (index, function) in functions.iter().enumerate() {
        if index == at[&root] {
            out.push(copier.copy(function, HashMap::new())?);
            continue;
        }
        if copied.contains(&function.id) {
            let ids = copier.renamed(function);
            out.push(copier.copy(function, ids)?);
        }
        let mut unchanged = Vec::new();
        write(function, &mut unchanged);
        out.push(unchanged);
    }
    let mut result = words[..HEADER].to_vec();
    result[3] = copier.bound;
    result.extend(copier.globals.iter().flatten());
    result.extend(out.iter().flatten().flatten());
    Some(result)
}

/// The functions that `root` reaches, itself among them, that need neighbors or call one that does.
fn needing(functions: &[Function], at: &HashMap<Id, usize>, root: Id) -> HashSet<Id> {
    let (mut order, mut open, mut seen) = (Vec::new(), vec![(root, false)], HashSet::default());
    while let Some((id, is_done)) = open.pop() {
        if is_done {
            order.push(id);
        } else if seen.insert(id) {
            open.push((id, true));
            let calls = at.get(&id).into_iter().flat_map(|at| functions[*at].calls());
            open.extend(calls.map(|callee| (callee, false)));
        }
    }
    let mut found = HashSet::default();
    // Callees come before their callers.
    for id in order {
        let Some(function) = at.get(&id).map(|at| &functions[*at]) else { continue };
        let mut body = function.blocks.iter().flat_map(|block| &block.body);
        if body.any(|i| needs_neighbors(opcode(i))) || function.calls().any(|callee| found.contains(&callee)) {
            found.insert(id);
        }
    }
    found
}

fn needs_neighbors(opcode: u32) -> bool {
    SAMPLES.contains(&opcode) || opcode == QUERY_LOD || DERIVATIVES.contains(&opcode) || DISCARDS.contains(&opcode)
}

/// The id that an instruction of a function defines.
fn result(i: &[u32]) -> Option<Id> {
    match opcode(i) {
        op::LABEL => i.get(1).copied(),
        opcode if op::WITHOUT_RESULT.contains(&opcode) => None,
        _ => i.get(2).copied(),
    }
}

/// Appends the instructions of a function.
fn write(function: &Function, out: &mut Vec<Instruction>) {
    out.extend(function.head.iter().cloned());
    for block in &function.blocks {
        out.push(instruction(op::LABEL, &[block.label]));
        out.extend(block.body.iter().cloned());
    }
    out.push(instruction(op::FUNCTION_END, &[]));
}

struct Copier {
    globals: Vec<Instruction>,
    /// More than the largest id.
    bound: u32,
    /// The variable that a discard sets.
    discarded: Option<Id>,
    /// Zeros, by their types.
    nulls: HashMap<Id, Id>,
    /// The copies, by the ids of the functions that they copy.
    functions: HashMap<Id, Id>,
}

impl Copier {
    fn fresh(&mut self) -> Id {
        self.bound += 1;
        self.bound - 1
    }

    /// The zero of a type.
    fn null(&mut self, of: Id) -> Id {
        if let Some(known) = self.nulls.get(&of) {
            return *known;
        }
        let id = self.fresh();
        self.globals.push(instruction(op::CONSTANT_NULL, &[of, id]));
        self.nulls.insert(of, id);
        id
    }

    /// The first global with this opcode.
    fn global(&self, wanted: u32) -> Option<&Instruction> {
        self.globals.iter().find(|i| opcode(i) == wanted)
    }

    /// The constant `true`.
    fn truth(&mut self) -> Option<Id> {
        if let Some(known) = self.global(op::CONSTANT_TRUE) {
            return Some(known[2]);
        }
        let boolean = self.global(op::TYPE_BOOL)?[1];
        let id = self.fresh();
        self.globals.push(instruction(op::CONSTANT_TRUE, &[boolean, id]));
        Some(id)
    }

    /// New ids for all that a function defines. They have the decorations of the old ones.
    fn renamed(&mut self, function: &Function) -> HashMap<Id, Id> {
        let labels = function.blocks.iter().map(|block| block.label);
        let body = function.blocks.iter().flat_map(|block| &block.body).filter_map(|i| result(i));
        let parameters = function.head.iter().filter(|i| opcode(i) == PARAMETER).map(|i| i[2]);
        let mut ids: HashMap<Id, Id> = HashMap::new();
        for id in parameters.chain(labels).chain(body) {
            let fresh = self.fresh();
            ids.insert(id, fresh);
        }
        let is_copied = |i: &&Instruction| opcode(i) == op::DECORATE && ids.contains_key(&i[1]);
        let copies: Vec<Instruction> = self.globals.iter().filter(is_copied).cloned().collect();
        let place = self.globals.iter().position(|i| opcode(i) == op::DECORATE).unwrap_or_default();
        for mut copy in copies {
            copy[1] = ids[&copy[1]];
            self.globals.insert(place, copy);
        }
        ids.insert(function.id, self.functions[&function.id]);
        ids
    }

    /// The instructions of a function for hits, with other ids. `None` if an instruction is unknown.
    fn copy(&mut self, function: &Function, ids: HashMap<Id, Id>) -> Option<Vec<Instruction>> {
        let mut copied = Function { id: function.id, head: Vec::new(), blocks: Vec::new() };
        let renamed = |i: &Instruction| {
            let mut i = i.clone();
            for at in 1..i.len() {
                if is_id(&i, at)? {
                    i[at] = *ids.get(&i[at]).unwrap_or(&i[at]);
                }
            }
            Some(i)
        };
        for i in &function.head {
            copied.head.push(renamed(i)?);
        }
        let returned = *function.head.first()?.get(1)?;
        for block in &function.blocks {
            let label = *ids.get(&block.label).unwrap_or(&block.label);
            let mut body = Vec::new();
            for i in &block.body {
                self.without_neighbors(renamed(i)?, returned, &mut body)?;
            }
            copied.blocks.push(Block { label, body });
        }
        let mut out = Vec::new();
        write(&copied, &mut out);
        Some(out)
    }

    /// Appends what does the same as an instruction where there are no neighbors. `returned`: the type that the function returns.
    fn without_neighbors(&mut self, mut i: Instruction, returned: Id, out: &mut Vec<Instruction>) -> Option<()> {
        match opcode(&i) {
            op::FUNCTION_CALL => {
                i[3] = *self.functions.get(&i[3]).unwrap_or(&i[3]);
                out.push(i);
            }
            sample if SAMPLES.contains(&sample) => {
                let float = self.globals.iter().find(|i| opcode(i) == op::TYPE_FLOAT && i.get(2) == Some(&32))?[1];
                let zero = self.null(float);
                // A reference of a comparison stands before the mask.
                let at = if matches!(sample, 89 | 93) { 6 } else { 5 };
                let mask = i.get(at).copied().unwrap_or(0);
                let mut operands = i.get(at + 1..).unwrap_or_default().to_vec();
                if mask & BIAS != 0 {
                    operands.remove(0);
                }
                if mask & MIN_LOD != 0 {
                    operands.pop();
                }
                let mask = mask & !(BIAS | MIN_LOD) | LOD;
                out.push(instruction(sample + 1, &[&i[1..at], &[mask, zero], &operands].concat()));
            }
            opcode if opcode == QUERY_LOD || DERIVATIVES.contains(&opcode) => {
                let zero = self.null(i[1]);
                out.push(instruction(op::COPY_OBJECT, &[i[1], i[2], zero]));
            }
            discard if DISCARDS.contains(&discard) => {
                if let (Some(variable), Some(truth)) = (self.discarded, self.truth()) {
                    out.push(instruction(op::STORE, &[variable, truth]));
                }
                if discard == op::DEMOTE_TO_HELPER_INVOCATION {
                    return Some(());
                }
                let is_void = self.global(op::TYPE_VOID).is_some_and(|i| i[1] == returned);
                let value = if is_void { None } else { Some(self.null(returned)) };
                out.push(
                    value.map_or_else(|| instruction(op::RETURN, &[]), |value| instruction(op::RETURN_VALUE, &[value])),
                );
            }
            _ => out.push(i),
        }
        Some(())
    }
}

#[cfg(test)]
#[path = "hits_tests.rs"]
mod tests;
