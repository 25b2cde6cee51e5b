//! Instruments a module so that it logs the values that its statements compute.
//!
//! Before an instruction that uses a value, the module calls a function of its own text with the number of the log point and the bits of
//! the value. The function decides what to do with them: keep the first that is not finite, or write all to a buffer. For statements, two
//! more functions are called where a function begins and where it ends.
//!
//! `floats.rs` instruments a module to find the first value that is not finite, `statements.rs` to show what every statement does.

mod branches;
mod floats;
mod functions;
mod instances;
mod lights;
mod statements;

use std::collections::BTreeSet;

use foldhash::HashMap;

use super::module::{Id, Instruction, Module, Type};
use super::op::{Op, text};
use branches::Branches;
pub use functions::Logged;
use functions::{Functions, is_line};
pub use instances::instances;
pub use lights::LightList;
use lights::LightParameters;

/// An index in the name of a place that is computed while the stage runs.
pub const INDEX: &str = "[ ]";
/// Longer arrays are not logged.
const MOST_ELEMENTS: u32 = 64;
/// Statements that store or return a value of more vectors than this log nothing: the members of a large struct are stored one by one, and
/// each log point costs compile time.
const MOST_PARTS: usize = 24;

/// How an instruction uses a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Stores it to the variable of this name, or a part of it.
    Store(String),
    /// Returns it from a function.
    Return,
    /// Reads it from the input of this name.
    Input(String),
    /// Passes it to a function, compares, converts or samples with it.
    Use,
    /// A function of this name begins. If one of its parameters numbers a light, that number is the value.
    Enter(String, Option<LightList>),
    /// The argument for the parameter of this name.
    Argument(String),
    /// Decides by it which statement is next.
    Condition,
    /// The same, by a constant. Its line is that of the first code in the first branch, since the compiler gives a constant none. `between`:
    /// how many other constants decide before that code.
    Constant {
        /// See above.
        between: usize,
    },
    /// Discards the pixel. Without a value.
    Discard,
    /// Returns before the end of a function without a value.
    Leave,
}

/// A place whose values are logged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as the compiler knows it.
    pub file: String,
    /// From 1. Of an argument, the first line of the function's body that has code: glslang gives headers in included files no line.
    pub line: u32,
    /// How the value is used.
    pub purpose: Purpose,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberKind {
    /// `float`.
    Float,
    /// `int`.
    Int,
    /// `uint`.
    Uint,
    /// `bool`: 0 or 1.
    Bool,
}

/// A number or a vector that a place logs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogPoint {
    /// Index into [`Traced::places`].
    pub place: usize,
    /// Its place in a larger value, as `.color` or `[2]`; empty for a whole value.
    pub part: String,
    /// The type of its numbers.
    pub kind: NumberKind,
    /// How many numbers it has, 1 to 4; 0 for a place without a value.
    pub count: u32,
    /// How many indices follow the numbers: those that the name of the place has as [`INDEX`], and that only the invocation knows.
    pub indices: u32,
}

/// An instrumented module.
#[derive(Debug)]
pub struct Traced {
    /// The module.
    pub words: Vec<u32>,
    /// The places that log values.
    pub places: Vec<Place>,
    /// The numbers that the function gets, less 1, are indices into this.
    pub points: Vec<LogPoint>,
}

/// Instruments a module with line information. `function` is the name of `void function(const in uint point, const in uvec4 bits)`, which
/// gets the number of a log point from 1, and a value of up to four numbers, filled up by zeros. Values of one to three numbers go to
/// `function_1` to `function_3`, if the module has them. [`Logged::Statements`] also needs
/// `uint function_enter(const in uint point, const in uint light)`, whose result goes to `void function_leave(const in uint caller)` where
/// the entered function ends. Functions whose names begin with `function` log nothing; neither does the entry point for
/// [`Logged::Statements`]. `only`: the files whose statements are logged, with the calls that lead there. `None` if the module lacks one of
/// these functions.
pub fn trace(words: &[u32], function: &str, logged: Logged, only: Option<&BTreeSet<String>>) -> Option<Traced> {
    let mut module = Module::parse(words)?;
    let id = module.named(&format!("{function}(")).next()?;
    let calls = match logged {
        Logged::Floats => CallFunctions::default(),
        Logged::Statements => CallFunctions::new(&module, function)?,
    };
    let short = [1, 2, 3].map(|count| module.named(&format!("{function}_{count}(")).next().unwrap_or(id));
    let functions = [short[0], short[1], short[2], id];
    let known = Functions::new(&module, function, logged, only);
    let light_parameters = LightParameters::new(&module);
    let mut all = std::mem::take(&mut module.functions);
    let mut tracer = Tracer::new(&mut module, (functions, calls), only, light_parameters);
    for function in &mut all {
        function.head.retain(|i| !is_line(*i));
        let is_silent = known.is_silent(function.id);
        let entered = match logged {
            Logged::Statements if !is_silent => Some((Branches::new(function), tracer.enter(function, &known))),
            _ => None,
        };
        let last = function.blocks.len().saturating_sub(1);
        for (at, block) in function.blocks.iter_mut().enumerate() {
            match &entered {
                _ if is_silent => block.body.retain(|i| !is_line(*i)),
                None => block.body = tracer.floats(&block.body),
                Some((branches, (_, caller))) => {
                    block.body = tracer.statements(&block.body, branches, (*caller, at == last));
                }
            }
        }
        if let (Some((_, (start, _))), Some(block)) = (entered, function.blocks.first_mut()) {
            let first = block.body.iter().position(|i| i.op != Op::Variable).unwrap_or(block.body.len());
            block.body.splice(first..first, start);
        }
    }
    let Tracer { places, points, .. } = tracer;
    module.functions = all;
    // The passes that follow expect no lines.
    module.globals.retain(|i| !is_line(*i));
    module.debug.retain(|i| matches!(i.op, Op::Name | Op::MemberName));
    Some(Traced { words: module.write(), places, points })
}

/// The module with other values of constants: each that has the first number gets the second.
pub fn with_constants(words: &[u32], changes: &[(u32, u32)]) -> Option<Vec<u32>> {
    let mut module = Module::parse(words)?;
    for place in 0..module.globals.len() {
        let i = module.globals[place];
        if let (Op::Constant, [_, kind, id, number]) = (i.op, &module[i])
            && let Some((_, to)) = changes.iter().find(|(from, _)| from == number)
        {
            let operands = [*kind, *id, *to];
            module.globals[place] = module.make(Op::Constant, &operands);
        }
    }
    Some(module.write())
}

/// The functions that log where others begin and end.
#[derive(Clone, Copy, Debug, Default)]
struct CallFunctions {
    enter: Id,
    leave: Id,
}

impl CallFunctions {
    fn new(module: &Module, function: &str) -> Option<Self> {
        let [enter, leave] = ["enter", "leave"].map(|name| module.named(&format!("{function}_{name}(")).next());
        Some(Self { enter: enter?, leave: leave? })
    }
}

struct Tracer<'a> {
    module: &'a mut Module,
    names: HashMap<Id, String>,
    /// Names of the members of structs.
    members: HashMap<(Id, u32), String>,
    /// The functions that log values of one to four numbers.
    functions: [Id; 4],
    calls: CallFunctions,
    void: Id,
    uint: Id,
    /// The vectors of two, three and four.
    vectors: [Id; 3],
    zero: Id,
    one: Id,
    places: Vec<Place>,
    points: Vec<LogPoint>,
    only: Option<&'a BTreeSet<String>>,
    light_parameters: LightParameters,
    /// The computed indices in the name of the last place.
    indices: Vec<Id>,
}

impl<'a> Tracer<'a> {
    fn new(
        module: &'a mut Module,
        (functions, calls): ([Id; 4], CallFunctions),
        only: Option<&'a BTreeSet<String>>,
        light_parameters: LightParameters,
    ) -> Self {
        let names = module.debug.iter().filter(|i| i.op == Op::Name).map(|i| &module[*i]);
        let names = names.map(|words| (words[1], text(&words[2..]))).collect();
        let members = module.debug.iter().filter(|i| i.op == Op::MemberName).map(|i| &module[*i]);
        let members = members.map(|words| ((words[1], words[2]), text(&words[3..]))).collect();
        let void = module.declare(Op::TypeVoid, &[]);
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let vectors = [2, 3, 4].map(|count| module.declare(Op::TypeVector, &[uint, count]));
        let [zero, one] = [0, 1].map(|number| module.constant(uint, number));
        let (places, points) = (Vec::new(), Vec::new());
        Self {
            module,
            names,
            members,
            functions,
            calls,
            void,
            uint,
            vectors,
            zero,
            one,
            places,
            points,
            only,
            light_parameters,
            indices: Vec::new(),
        }
    }

    /// The kind of the numbers of a scalar type.
    fn kind(&self, scalar: Id) -> Option<NumberKind> {
        match self.module.get_type(scalar)? {
            Type::Float { bits: 32 } => Some(NumberKind::Float),
            Type::Int { bits: 32, signed: true } => Some(NumberKind::Int),
            Type::Int { bits: 32, signed: false } => Some(NumberKind::Uint),
            Type::Bool => Some(NumberKind::Bool),
            _ => None,
        }
    }

    /// How many numbers and vectors of these kinds a value of a type has.
    fn parts_of(&self, kind: Id, kinds: &[NumberKind]) -> usize {
        match self.module.get_type(kind) {
            Some(Type::Vector { of, .. }) => self.parts_of(of, kinds),
            Some(Type::Matrix { column, count }) => self.parts_of(column, kinds) * count as usize,
            Some(Type::Array { of, length }) => match self.module.number(length) {
                Some(length) if length <= MOST_ELEMENTS => self.parts_of(of, kinds) * length as usize,
                _ => 0,
            },
            Some(Type::Struct { members }) => members.iter().map(|member| self.parts_of(*member, kinds)).sum(),
            _ => self.kind(kind).filter(|kind| kinds.contains(kind)).map_or(0, |_| 1),
        }
    }

    /// The name of the variable that a pointer points into, and where it points there, as `.lights[2].color`.
    fn stored(&self, pointer: Id) -> (String, String) {
        let (name, path, _) = self.stored_at(pointer);
        (name, path)
    }

    /// The same, with the indices that are computed.
    fn stored_at(&self, pointer: Id) -> (String, String, Vec<Id>) {
        let chain = [Op::AccessChain, Op::InBoundsAccessChain].map(|op| self.module.defined(op, pointer));
        let Some(words) = chain.into_iter().flatten().next() else {
            return (self.names.get(&pointer).cloned().unwrap_or_default(), String::new(), Vec::new());
        };
        let (name, mut path, mut indices) = self.stored_at(words[3]);
        let mut kind = self.module.pointer(self.module.type_of(words[3])).map(|(_, to)| to);
        for index in &words[4..] {
            let known = self.module.number(*index);
            let Some(of) = kind else { break };
            path += &known.map_or_else(|| INDEX.to_owned(), |index| self.part(of, index));
            if known.is_none() {
                indices.push(*index);
            }
            kind = match self.module.get_type(of) {
                Some(Type::Struct { members }) => known.and_then(|index| members.get(index as usize)).copied(),
                Some(Type::Array { of, .. } | Type::RuntimeArray { of } | Type::Vector { of, .. }) => Some(of),
                Some(Type::Matrix { column, .. }) => Some(column),
                _ => None,
            };
        }
        (name, path, indices)
    }

    /// A part of a value, as GLSL names it.
    fn part(&self, kind: Id, index: u32) -> String {
        match self.module.get_type(kind) {
            Some(Type::Struct { .. }) => {
                self.members.get(&(kind, index)).map(|name| format!(".{name}")).unwrap_or_default()
            }
            Some(Type::Vector { .. }) => format!(".{}", ["x", "y", "z", "w"].get(index as usize).unwrap_or(&"")),
            _ => format!("[{index}]"),
        }
    }

    /// Appends a call for each number and vector of these kinds in a value, to the last place. `path`: where the value is in a larger one.
    fn log_parts(&mut self, out: &mut Vec<Instruction>, value: Id, kinds: &[NumberKind], path: String) {
        let kind = self.module.type_of(value);
        let parts: Vec<Id> = match self.module.get_type(kind) {
            _ if self.parts_of(kind, kinds) == 0 => return,
            Some(Type::Vector { count, of }) => {
                let numbers = self.kind(of).map(|kind| (kind, count));
                return numbers.into_iter().for_each(|numbers| self.log(out, Some(value), numbers, path.clone()));
            }
            Some(Type::Matrix { column, count }) => vec![column; count as usize],
            Some(Type::Array { of, length }) => vec![of; self.module.number(length).unwrap_or(0) as usize],
            Some(Type::Struct { members }) => members.to_vec(),
            _ => {
                let numbers = self.kind(kind).map(|kind| (kind, 1));
                return numbers.into_iter().for_each(|numbers| self.log(out, Some(value), numbers, path.clone()));
            }
        };
        for (at, part) in (0..).zip(parts) {
            if self.parts_of(part, kinds) > 0 {
                let path = path.clone() + &self.part(kind, at);
                let part = self.module.emit(out, Op::CompositeExtract, part, &[value, at]);
                self.log_parts(out, part, kinds, path);
            }
        }
    }

    /// Appends the call with a value of this many numbers, or without a value, to the last place.
    fn log(&mut self, out: &mut Vec<Instruction>, value: Option<Id>, (kind, count): (NumberKind, u32), part: String) {
        let m = &mut *self.module;
        let bits_type = if count > 1 { self.vectors[count as usize - 2] } else { self.uint };
        let mut bits = match (value, kind) {
            (None, _) => self.zero,
            (Some(value), NumberKind::Uint) => value,
            (Some(value), NumberKind::Float | NumberKind::Int) => m.emit(out, Op::Bitcast, bits_type, &[value]),
            (Some(value), NumberKind::Bool) => {
                let [yes, no] = [self.one, self.zero].map(|number| match count {
                    1 => number,
                    _ => m.declare(Op::ConstantComposite, &[&[bits_type][..], &[number; 4][..count as usize]].concat()),
                });
                m.emit(out, Op::Select, bits_type, &[value, yes, no])
            }
        };
        let mut indices = 0;
        if count < 4 {
            let mut rest = vec![self.zero; 4 - count.max(1) as usize];
            // Where there is no room for all of them, the name has none.
            if count > 0 && self.indices.len() <= rest.len() {
                indices = self.indices.len() as u32;
                for (to, index) in rest.iter_mut().zip(&self.indices) {
                    let is_signed = matches!(m.get_type(m.type_of(*index)), Some(Type::Int { signed: true, .. }));
                    *to = if is_signed { m.emit(out, Op::Bitcast, self.uint, &[*index]) } else { *index };
                }
            }
            bits = m.emit(out, Op::CompositeConstruct, self.vectors[2], &[&[bits][..], &rest].concat());
        }
        let point = self.new_point(kind, (count, indices), part);
        let function = self.functions[(count + indices).clamp(1, 4) as usize - 1];
        self.module.emit(out, Op::FunctionCall, self.void, &[function, point, bits]);
    }

    /// A new log point of the last place, with a count of numbers and one of indices. Returns the constant with its number.
    fn new_point(&mut self, kind: NumberKind, (count, indices): (u32, u32), part: String) -> Id {
        self.points.push(LogPoint { place: self.places.len() - 1, part, kind, count, indices });
        self.module.constant(self.uint, self.points.len() as u32)
    }
}

#[cfg(test)]
mod tests;
