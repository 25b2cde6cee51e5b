//! Variables of functions that may be read before they are set.
//!
//! A variable has a bit for each of its parts: the components of a vector, the columns of a matrix, the elements of an array, the members of
//! a struct. What is proven to be set on every path needs no check. For all others, the module counts the bits in a variable of its own
//! while it runs, so that only reads on a path that did not set them are told. A copy of a whole struct or array is no read, and a part
//! of a part counts as the part; both keep quiet about what may be right.

use foldhash::{HashMap, HashSet};

use crate::shader::spirv::enums::storage;
use crate::shader::spirv::fold::places;
use crate::shader::spirv::module::{Function, Id, Instruction, Module, Type};
use crate::shader::spirv::op::{Op, text};

/// glslang's name for the copy of an argument.
const ARGUMENT: &str = "param";

/// Effect of an instruction on the parts of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Act {
    /// Sets these parts.
    Sets(Id, u32),
    /// Reads these parts.
    Reads(Id, u32),
    /// Sets all parts that an `out` parameter of a function has got in its last call.
    Takes(Id, (Id, usize)),
}

/// Effects of the instructions of a function on variables that may be read before they are set.
#[derive(Debug, Default)]
pub(super) struct Unset {
    /// By the block and the place there.
    pub(super) acts: HashMap<(usize, usize), Vec<Act>>,
    /// The variables, each with its name.
    pub(super) names: HashMap<Id, String>,
    /// Its `out` parameters that some path does not set, by their ids and places.
    pub(super) outs: Vec<(Id, usize)>,
}

/// Knowledge of the functions of a module.
pub(super) struct OutParameters {
    /// Callees, and the places of parameters that get a value from a caller.
    given: HashSet<(Id, usize)>,
    /// `out` parameters that some path does not set.
    pub(super) open: HashSet<(Id, usize)>,
}

/// Parts of variables that are set, as bits.
type SetParts = HashMap<Id, u32>;

impl OutParameters {
    /// `functions`: those of the module. glslang passes copies, and stores to those of `in` and `inout` arguments before the call.
    pub(super) fn new(module: &Module, functions: &[Function]) -> Self {
        let code = || functions.iter().flat_map(Function::instructions);
        let stored: HashSet<Id> = code().filter(|i| i.op == Op::Store).map(|i| module[i][1]).collect();
        let is_given = |argument: Id| module.defined(Op::Variable, argument).is_none() || stored.contains(&argument);
        let calls = code().filter(|i| i.op == Op::FunctionCall).map(|i| &module[i]);
        let arguments = calls.flat_map(|words| words[4..].iter().enumerate().map(|(at, id)| ((words[3], at), *id)));
        let given = arguments.filter(|(_, id)| is_given(*id)).map(|(parameter, _)| parameter).collect();
        Self { given, open: HashSet::default() }
    }
}

/// The parts of a type as bits; `None` if it has none, or too many.
fn all_parts(module: &Module, kind: Id) -> Option<u32> {
    let count = match module.get_type(kind)? {
        Type::Bool | Type::Int { .. } | Type::Float { .. } => 1,
        Type::Vector { count, .. } | Type::Matrix { count, .. } => count,
        Type::Array { length, .. } => module.number(length)?,
        Type::Struct { members } => members.len() as u32,
        _ => return None,
    };
    (1..=32).contains(&count).then(|| u32::MAX >> (32 - count))
}

/// A function that is being looked at.
struct Reader<'a> {
    module: &'a Module,
    known: &'a OutParameters,
    /// The variables, and all of their parts.
    all: HashMap<Id, u32>,
    uses: HashMap<Id, Vec<Instruction>>,
    /// Copies of arguments, and the `out` parameter that they were passed to last.
    passed: HashMap<Id, (Id, usize)>,
    names: HashMap<Id, String>,
}

impl Unset {
    /// Looks at a function. Its callees were looked at before.
    pub(super) fn of(module: &Module, function: &Function, known: &mut OutParameters) -> Self {
        let names = module.debug.iter().filter(|i| i.op == Op::Name).map(|i| &module[*i]);
        let names: HashMap<Id, String> = names.map(|words| (words[1], text(&words[2..]))).collect();
        let reader = Reader::new(module, function, known, names);
        let parameters = function.head.iter().filter(|i| i.op == Op::FunctionParameter).map(|i| module[*i][2]);
        let outs: Vec<(Id, usize)> = parameters.zip(0..).filter(|(id, _)| reader.all.contains_key(id)).collect();
        let mut acts: HashMap<(usize, usize), Vec<Act>> = HashMap::default();
        for (block, body) in function.blocks.iter().map(|block| &block.body).enumerate() {
            for (place, i) in body.iter().enumerate() {
                let of = reader.acts(*i);
                if !of.is_empty() {
                    acts.insert((block, place), of);
                }
            }
        }
        let (entries, leaves) = reader.certain(function, &acts);
        let outs: Vec<(Id, usize)> = outs.into_iter().filter(|(id, _)| leaves.get(id) != reader.all.get(id)).collect();
        // The variables with a read that is not certain.
        let mut wanted: HashSet<Id> = outs.iter().map(|(id, _)| *id).collect();
        for (block, entry) in entries.iter().enumerate() {
            let Some(mut certain) = entry.clone() else { continue };
            for place in 0..function.blocks[block].body.len() {
                let mut kept = Vec::new();
                for act in acts.remove(&(block, place)).into_iter().flatten() {
                    match act {
                        Act::Reads(id, parts) if certain.get(&id).copied().unwrap_or(0) & parts == parts => continue,
                        Act::Reads(id, _) => _ = wanted.insert(id),
                        _ => reader.set(act, &mut certain),
                    }
                    kept.push(act);
                }
                if !kept.is_empty() {
                    acts.insert((block, place), kept);
                }
            }
        }
        let (of, all, names) = (function.id, reader.all, reader.names);
        let is_wanted = |act: &Act| match act {
            Act::Sets(id, _) | Act::Reads(id, _) | Act::Takes(id, _) => wanted.contains(id),
        };
        acts.values_mut().for_each(|acts| acts.retain(is_wanted));
        acts.retain(|_, acts| !acts.is_empty());
        known.open.extend(outs.iter().map(|(_, at)| (of, *at)));
        let names = all
            .into_keys()
            .filter(|id| wanted.contains(id))
            .map(|id| (id, names.get(&id).cloned().unwrap_or_default()));
        Self { acts, names: names.collect(), outs }
    }
}

impl<'a> Reader<'a> {
    fn new(module: &'a Module, function: &Function, known: &'a OutParameters, names: HashMap<Id, String>) -> Self {
        let mut uses: HashMap<Id, Vec<Instruction>> = HashMap::default();
        for i in function.body() {
            let result = module.result(i);
            module.ids_of(i).filter(|id| Some(*id) != result).for_each(|id| uses.entry(id).or_default().push(i));
        }
        let mut all: HashMap<Id, u32> = HashMap::default();
        let parts = |pointer: Id| all_parts(module, module.pointer(module.type_of(pointer))?.1);
        for i in function.body().filter(|i| i.op == Op::Variable && module[*i].len() == 4) {
            let id = module[i][2];
            let is_authors = names.get(&id).is_some_and(|name| !name.is_empty() && name != ARGUMENT);
            all.extend(parts(id).filter(|_| is_authors).map(|parts| (id, parts)));
        }
        let parameters = function.head.iter().filter(|i| i.op == Op::FunctionParameter).map(|i| module[*i][2]);
        for (id, at) in parameters.zip(0..) {
            let is_out = module.pointer(module.type_of(id)).is_some_and(|(class, _)| class == storage::FUNCTION);
            // Functions that nobody calls, or only the entry point itself, are not known.
            if is_out && !known.given.contains(&(function.id, at)) {
                all.extend(parts(id).map(|parts| (id, parts)));
            }
        }
        let mut passed = HashMap::default();
        for words in function.body().filter(|i| i.op == Op::FunctionCall).map(|i| &module[i]) {
            let arguments = words[4..].iter().enumerate();
            passed.extend(arguments.map(|(at, id)| (*id, (words[3], at))));
        }
        Self { module, known, all, uses, passed, names }
    }

    /// The variable that a pointer points into, and its part; no part for all of it, and a part that is not known for a computed index.
    fn root(&self, pointer: Id) -> Option<(Id, Option<Option<u32>>)> {
        if self.all.contains_key(&pointer) {
            return Some((pointer, None));
        }
        let chain =
            [Op::AccessChain, Op::InBoundsAccessChain].into_iter().find_map(|op| self.module.defined(op, pointer))?;
        let (root, part) = self.root(chain[3])?;
        // A part of a part counts as the part.
        Some((root, Some(part.unwrap_or_else(|| self.module.number(chain[4])))))
    }

    fn acts(&self, i: Instruction) -> Vec<Act> {
        let words = &self.module[i];
        match (i.op, words) {
            (Op::Variable | Op::AccessChain | Op::InBoundsAccessChain, _) => Vec::new(),
            (Op::Store, [_, pointer, value, ..]) => self.store(*pointer, *value).into_iter().collect(),
            (Op::Load, [_, kind, result, pointer, ..]) => self.load(*kind, *result, *pointer).into_iter().collect(),
            // Everything else that gets the pointer may set it.
            _ => {
                let others = words[1..].iter().filter_map(|id| self.root(*id).filter(|_| i.op.is_known()));
                others.map(|(id, _)| Act::Sets(id, self.all[&id])).collect()
            }
        }
    }

    fn store(&self, pointer: Id, value: Id) -> Option<Act> {
        let (id, part) = self.root(pointer)?;
        let all = self.all[&id];
        match part {
            Some(Some(part)) => Some(Act::Sets(id, 1_u32.checked_shl(part).unwrap_or(0) & all)),
            Some(None) => Some(Act::Sets(id, all)),
            None => {
                // The result of a call comes back from the copy of the argument.
                let source = self.module.defined(Op::Load, value).and_then(|words| self.passed.get(&words[3]));
                Some(match source.filter(|parameter| self.known.open.contains(parameter)) {
                    Some(parameter) => Act::Takes(id, *parameter),
                    None => Act::Sets(id, all & !self.kept(id, value)),
                })
            }
        }
    }

    /// The parts that a value which is stored to a variable has from that variable: `v.xy = a` stores all of `v`.
    fn kept(&self, id: Id, value: Id) -> u32 {
        let is_own = |of: Id| self.module.defined(Op::Load, of).is_some_and(|words| words[3] == id);
        if let Some([_, _, _, a, b, literals @ ..]) = self.module.defined(Op::VectorShuffle, value) {
            let count = self.components(*a);
            let from = |literal: u32| if literal < count { (*a, literal) } else { (*b, literal.wrapping_sub(count)) };
            let kept = (0..).zip(literals).filter(|(at, literal)| {
                let (of, component) = from(**literal);
                is_own(of) && component == *at
            });
            return kept.fold(0, |bits, (at, _)| bits | 1 << at);
        }
        match self.module.defined(Op::CompositeInsert, value) {
            Some([_, _, _, _, composite, first, ..]) if is_own(*composite) => {
                self.all[&id] & !1_u32.checked_shl(*first).unwrap_or(0)
            }
            _ => 0,
        }
    }

    fn components(&self, value: Id) -> u32 {
        match self.module.get_type(self.module.type_of(value)) {
            Some(Type::Vector { count, .. }) => count,
            _ => 1,
        }
    }

    fn load(&self, kind: Id, result: Id, pointer: Id) -> Option<Act> {
        let (id, part) = self.root(pointer)?;
        let is_copy = matches!(self.module.get_type(kind), Some(Type::Struct { .. } | Type::Array { .. }));
        if is_copy || self.goes_to_inout(result) {
            return None;
        }
        let parts = match part {
            Some(Some(part)) => 1_u32.checked_shl(part).unwrap_or(0),
            Some(None) => 0,
            None => self.used(id, result),
        };
        Some(parts & self.all[&id]).filter(|parts| *parts != 0).map(|parts| Act::Reads(id, parts))
    }

    /// Whether a value is only the argument of an `inout` parameter, which may set it before it reads it.
    fn goes_to_inout(&self, value: Id) -> bool {
        let uses = self.uses.get(&value).map(Vec::as_slice).unwrap_or_default();
        let is_read = |variable: Id| self.uses.get(&variable).is_some_and(|uses| uses.iter().any(|i| i.op == Op::Load));
        !uses.is_empty()
            && uses.iter().all(|i| {
                let words = &self.module[*i];
                let is_argument = |id: &Id| self.names.get(id).is_some_and(|name| name == ARGUMENT);
                i.op == Op::Store && words[2] == value && is_argument(&words[1]) && is_read(words[1])
            })
    }

    /// The parts of a loaded variable that are used.
    fn used(&self, id: Id, value: Id) -> u32 {
        let uses = self.uses.get(&value).map(Vec::as_slice).unwrap_or_default();
        uses.iter().fold(0, |parts, i| parts | self.used_by(id, value, *i))
    }

    fn used_by(&self, id: Id, value: Id, i: Instruction) -> u32 {
        let stores_back = |result: Id| {
            let uses = self.uses.get(&result).map(Vec::as_slice).unwrap_or_default();
            !uses.is_empty() && uses.iter().all(|i| i.op == Op::Store && self.module[*i][1] == id)
        };
        match (i.op, &self.module[i]) {
            (Op::CompositeExtract, [_, _, _, _, first, ..]) => 1_u32.checked_shl(*first).unwrap_or(0),
            (Op::CompositeInsert, [_, _, result, object, ..]) if *object != value && stores_back(*result) => 0,
            (Op::VectorShuffle, [_, _, result, a, b, literals @ ..]) => {
                let (count, back) = (self.components(*a), stores_back(*result));
                let component = |literal: u32| match literal {
                    literal if literal < count => (*a == value).then_some(literal),
                    literal => (*b == value).then(|| literal.wrapping_sub(count)),
                };
                let read = (0..).zip(literals).filter_map(|(at, literal)| Some((at, component(*literal)?)));
                read.filter(|(at, of)| !(back && at == of))
                    .fold(0, |bits, (_, of)| bits | 1_u32.checked_shl(of).unwrap_or(0))
            }
            _ => u32::MAX,
        }
    }

    fn set(&self, act: Act, certain: &mut HashMap<Id, u32>) {
        match act {
            Act::Sets(id, parts) => *certain.entry(id).or_default() |= parts,
            // The part that is taken may be less than what was there.
            Act::Takes(id, _) => _ = certain.insert(id, 0),
            Act::Reads(..) => {}
        }
    }

    /// The parts of variables that are set on every path to each block, `None` for blocks that nothing reaches, and to every return.
    fn certain(
        &self,
        function: &Function,
        acts: &HashMap<(usize, usize), Vec<Act>>,
    ) -> (Vec<Option<SetParts>>, SetParts) {
        let at = places(&function.blocks);
        let mut entries: Vec<Option<HashMap<Id, u32>>> = vec![None; function.blocks.len()];
        let mut leaves: Option<HashMap<Id, u32>> = None;
        if let Some(first) = entries.first_mut() {
            *first = Some(HashMap::default());
        }
        let mut open: Vec<usize> = vec![0];
        while let Some(block) = open.pop() {
            let Some(mut now) = entries.get(block).cloned().flatten() else { continue };
            for place in 0..function.blocks[block].body.len() {
                acts.get(&(block, place)).into_iter().flatten().for_each(|act| self.set(*act, &mut now));
            }
            let of = &function.blocks[block];
            if of
                .body
                .iter()
                .rev()
                .find(|i| !is_line(**i))
                .is_some_and(|i| matches!(i.op, Op::Return | Op::ReturnValue))
            {
                leaves = Some(leaves.map_or_else(|| now.clone(), |leaves| both(&leaves, &now)));
            }
            for to in of.targets(self.module).filter_map(|label| at.get(&label).copied()) {
                let merged = entries[to].as_ref().map_or_else(|| now.clone(), |known| both(known, &now));
                if entries[to].as_ref() != Some(&merged) {
                    entries[to] = Some(merged);
                    open.push(to);
                }
            }
        }
        // Without a return, nothing leaves it.
        (entries, leaves.unwrap_or_else(|| self.all.clone()))
    }
}

fn is_line(i: Instruction) -> bool {
    matches!(i.op, Op::Line | Op::NoLine)
}

/// The parts that are set on two paths.
fn both(a: &HashMap<Id, u32>, b: &HashMap<Id, u32>) -> HashMap<Id, u32> {
    let common = a.iter().filter_map(|(id, parts)| Some((*id, parts & b.get(id)?)));
    common.filter(|(_, parts)| *parts != 0).collect()
}
