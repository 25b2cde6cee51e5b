//! Instruments a module so that it tells the values that its statements compute.
//!
//! Before each instruction that stores, returns, passes, compares, converts or samples with a value, the module calls a function of its
//! own text with the number of the telling and the bits of the value. The function decides about the values: keep the first that is not
//! finite, or all.
//!
//! To find the first value that is not finite, each value of floats is told once ([`Told::Floats`]): where a variable, a parameter or the
//! result of a call is only copied, the statement that computed it has told it before. What the stage before has written is told where it is read.
//!
//! To show what happens ([`Told::All`]), numbers and conditions of all types are told where they are stored, returned or decided about,
//! copies and constants too, and so are the calls of functions with their arguments, and discards.

use foldhash::{HashMap, HashSet, HashSetExt};

use super::enums::storage;
use super::module::{Block, Function, Id, Instruction, Module, Type};
use super::op::{Class, Op, text};
use super::reach::file_of;

/// Longer arrays are not told.
const MOST_ELEMENTS: u32 = 64;
/// glslang's name for the copy of an argument.
const ARGUMENT: &str = "param";

/// Which values are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// Floats, once each.
    Floats,
    /// All values, and what is done with them.
    All,
}

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
    /// A function of this name begins. Without a value.
    Enter(String),
    /// The argument for the parameter of this name.
    Argument(String),
    /// A function ends. Without a value.
    Leave,
    /// Decides by it which statement is next.
    Condition,
    /// Discards the pixel. Without a value.
    Discard,
}

/// A place that tells values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as the compiler knows it.
    pub file: String,
    /// From 1.
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

/// A number or a vector that a place tells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Telling {
    /// Index into [`Traced::places`].
    pub place: usize,
    /// Its place in a larger value, as `.color` or `[2]`; empty for a whole value.
    pub part: String,
    /// The type of its numbers.
    pub kind: NumberKind,
    /// How many numbers it has, 1 to 4; 0 for a place without a value.
    pub count: u32,
}

/// An instrumented module.
#[derive(Debug)]
pub struct Traced {
    /// The module.
    pub words: Vec<u32>,
    /// The places that tell.
    pub places: Vec<Place>,
    /// The numbers that the function gets, less 1, are indices into this.
    pub tellings: Vec<Telling>,
}

/// Instruments a module with line information. `function` is the name of `void function(const in uint telling, const in uvec4 bits)`,
/// which gets a value of up to four numbers, filled up by zeros, and the number of its telling from 1. Functions whose names begin
/// with that name tell nothing, and neither does the entry point if all is told. `only`: the file whose places alone tell, with the calls that
/// lead there. `None` if the module has no such function.
pub fn trace(words: &[u32], function: &str, told: Told, only: Option<&str>) -> Option<Traced> {
    let mut module = Module::parse(words)?;
    let callers = only.map(|file| callers(&module, file));
    let id = module.named(&format!("{function}(")).next()?;
    let names = module.debug.iter().filter(|i| i.op == Op::Name).map(|i| &module[*i]);
    let names: HashMap<Id, String> = names.map(|words| (words[1], text(&words[2..]))).collect();
    let members = module.debug.iter().filter(|i| i.op == Op::MemberName).map(|i| &module[*i]);
    let members = members.map(|words| ((words[1], words[2]), text(&words[3..]))).collect();
    let void = module.declare(Op::TypeVoid, &[]);
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let vectors = [2, 3, 4].map(|count| module.declare(Op::TypeVector, &[uint, count]));
    let [zero, one] = [0, 1].map(|number| module.constant(uint, number));
    let is_own = |of: &Function| names.get(&of.id).is_some_and(|name| name.starts_with(function));
    let entry = module.entry_function().filter(|_| told == Told::All);
    let own: HashSet<Id> =
        module.functions.iter().filter(|of| is_own(of) || Some(of.id) == entry).map(|of| of.id).collect();
    let mut functions = std::mem::take(&mut module.functions);
    let (places, tellings) = (Vec::new(), Vec::new());
    let of = &mut module;
    let mut tracer = Tracer {
        module: of,
        names,
        members,
        function: id,
        void,
        uint,
        vectors,
        zero,
        one,
        places,
        tellings,
        told,
        only,
        leads: true,
    };
    for function in &mut functions {
        let line = function.head.iter().copied().find(|i| i.op == Op::Line);
        function.head.retain(|i| !is_line(*i));
        let is_own = own.contains(&function.id);
        tracer.leads = callers.as_ref().is_none_or(|callers| callers.contains(&function.id));
        for block in &mut function.blocks {
            match is_own {
                true => block.body.retain(|i| !is_line(*i)),
                false => block.body = tracer.block(&block.body),
            }
        }
        if told == Told::All && !is_own && tracer.leads {
            tracer.enter(function, line);
        }
    }
    let (places, tellings) = (tracer.places, tracer.tellings);
    module.functions = functions;
    // The passes that follow expect no lines.
    module.globals.retain(|i| !is_line(*i));
    module.debug.retain(|i| matches!(i.op, Op::Name | Op::MemberName));
    Some(Traced { words: module.write(), places, tellings })
}

/// The functions with places of a file, and all that lead to them by calls.
fn callers(module: &Module, file: &str) -> HashSet<Id> {
    let has_line = |i: Instruction| i.op == Op::Line && file_of(module, &module[i]).is_some_and(|(of, _)| of == file);
    let with_places = module.functions.iter().filter(|function| function.instructions().any(has_line));
    let mut found: HashSet<Id> = with_places.map(|function| function.id).collect();
    loop {
        let calls = |function: &&Function| {
            !found.contains(&function.id) && function.calls(module).any(|id| found.contains(&id))
        };
        let more: Vec<Id> = module.functions.iter().filter(calls).map(|function| function.id).collect();
        if more.is_empty() {
            return found;
        }
        found.extend(more);
    }
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

fn is_line(i: Instruction) -> bool {
    matches!(i.op, Op::Line | Op::NoLine)
}

/// Whether the values that an instruction uses are told.
fn is_told(op: Op) -> bool {
    let compares = (Op::FOrdEqual..=Op::FUnordGreaterThanEqual).contains(&op);
    let is_use = matches!(op, Op::Store | Op::ReturnValue | Op::FunctionCall | Op::ConvertFToU | Op::ConvertFToS);
    is_use || compares || op.class() == Class::Sample
}

struct Tracer<'a> {
    module: &'a mut Module,
    names: HashMap<Id, String>,
    /// Names of the members of structs.
    members: HashMap<(Id, u32), String>,
    function: Id,
    void: Id,
    uint: Id,
    /// The vectors of two, three and four.
    vectors: [Id; 3],
    zero: Id,
    one: Id,
    places: Vec<Place>,
    tellings: Vec<Telling>,
    told: Told,
    only: Option<&'a str>,
    /// Whether the function at hand leads to places that tell.
    leads: bool,
}

impl Tracer<'_> {
    /// The instructions of a block with calls between them, without lines.
    fn block(&mut self, body: &[Instruction]) -> Vec<Instruction> {
        let (mut out, mut line, mut told) = (Vec::with_capacity(body.len()), None, HashSet::new());
        for (at, &i) in body.iter().enumerate() {
            if is_line(i) {
                line = (i.op == Op::Line).then_some(i);
                continue;
            }
            if self.told == Told::All {
                // A merge instruction and the branch behind it stay together.
                let is_merge = matches!(i.op, Op::SelectionMerge | Op::LoopMerge);
                let follows_merge =
                    out.last().is_some_and(|i: &Instruction| matches!(i.op, Op::SelectionMerge | Op::LoopMerge));
                let told = body[at..]
                    .iter()
                    .copied()
                    .find(|i| !is_line(*i) && !matches!(i.op, Op::SelectionMerge | Op::LoopMerge));
                match told {
                    Some(next) if is_merge => self.tell_all(&mut out, next, line),
                    _ if follows_merge => {}
                    _ => self.tell_all(&mut out, i, line),
                }
                out.push(i);
                continue;
            }
            let values = if is_told(i.op) { self.computed(i) } else { Vec::new() };
            let values: Vec<Id> = values.into_iter().filter(|value| told.insert(*value)).collect();
            self.tell(&mut out, i, line, &values);
            out.push(i);
            if i.op == Op::Load && self.class(self.module[i][3]) == Some(storage::INPUT) {
                let value = self.module[i][2];
                self.tell(&mut out, i, line, &[value]);
            }
        }
        out
    }

    /// Appends what an instruction does, if all is told.
    fn tell_all(&mut self, out: &mut Vec<Instruction>, i: Instruction, line: Option<Instruction>) {
        let (purpose, value) = match (i.op, &self.module[i][1..]) {
            (Op::Store, [pointer, value, ..]) => {
                let (name, path) = self.stored(*pointer);
                if name == ARGUMENT || name.is_empty() {
                    return;
                }
                (Purpose::Store(name + &path), Some(*value))
            }
            (Op::ReturnValue, [value]) if self.has_told(self.module.type_of(*value)) => (Purpose::Return, Some(*value)),
            (Op::ReturnValue, _) => (Purpose::Leave, None),
            (Op::Return, _) => (Purpose::Leave, None),
            (Op::BranchConditional | Op::Switch, [condition, ..]) => (Purpose::Condition, Some(*condition)),
            (Op::Kill | Op::TerminateInvocation, _) => (Purpose::Discard, None),
            _ => return,
        };
        let file = line.and_then(|line| file_of(self.module, &self.module[line]));
        // The end of a function without a value has no line.
        let ends = matches!(i.op, Op::Return | Op::ReturnValue);
        match file.filter(|(file, _)| self.is_wanted(file)) {
            Some((file, line)) => self.tell_at(out, Place { file, line, purpose }, value),
            // The calls that lead elsewhere are told, too.
            None if ends && self.leads => {
                self.tell_at(out, Place { file: String::new(), line: 0, purpose: Purpose::Leave }, None);
            }
            None => {}
        }
    }

    /// Whether the places of a file tell.
    fn is_wanted(&self, file: &str) -> bool {
        self.only.is_none_or(|only| only == file)
    }

    /// Tells at the start of a function that it begins, and its arguments.
    fn enter(&mut self, function: &mut Function, line: Option<Instruction>) {
        let name = self.names.get(&function.id).map(|name| name.split('(').next().unwrap_or_default().to_owned());
        let file = line.and_then(|line| file_of(self.module, &self.module[line]));
        let ((Some(name), Some((file, line))), Some(Block { body, .. })) = ((name, file), function.blocks.first_mut())
        else {
            return;
        };
        let mut out = Vec::new();
        let place = |purpose| Place { file: file.clone(), line, purpose };
        self.tell_at(&mut out, place(Purpose::Enter(name)), None);
        let is_wanted = self.is_wanted(&file);
        let parameters: Vec<Id> =
            function.head.iter().filter(|i| i.op == Op::FunctionParameter).map(|i| self.module[*i][2]).collect();
        for parameter in parameters.into_iter().filter(|_| is_wanted) {
            let name = self.names.get(&parameter).cloned().unwrap_or_default();
            let value = match self.module.pointer(self.module.type_of(parameter)) {
                Some((_, to)) if self.has_told(to) => self.module.emit(&mut out, Op::Load, to, &[parameter]),
                Some(_) => continue,
                None => parameter,
            };
            self.tell_at(&mut out, place(Purpose::Argument(name)), Some(value));
        }
        let first = body.iter().position(|i| i.op != Op::Variable).unwrap_or(body.len());
        body.splice(first..first, out);
    }

    /// Appends calls for a place, which has a value of a type that is told, or none.
    fn tell_at(&mut self, out: &mut Vec<Instruction>, place: Place, value: Option<Id>) {
        if value.is_some_and(|value| !self.has_told(self.module.type_of(value))) {
            return;
        }
        self.places.push(place);
        match value {
            Some(value) => self.tell_parts(out, value, String::new()),
            None => self.call(out, NumberKind::Bool, None, 0, String::new()),
        }
    }

    /// The storage class that a pointer points to.
    fn class(&self, pointer: Id) -> Option<u32> {
        self.module.pointer(self.module.type_of(pointer)).map(|(class, _)| class)
    }

    /// The values of floats among the operands that no other place tells.
    fn computed(&self, i: Instruction) -> Vec<Id> {
        let result = self.module.result(i);
        let operands = self.module.ids_of(i).filter(|id| Some(*id) != result);
        operands.filter(|id| self.has_told(self.module.type_of(*id)) && self.is_computed(*id)).collect()
    }

    fn is_computed(&self, value: Id) -> bool {
        let Some(i) = self.module.definition(value) else { return false };
        match i.op {
            Op::Load => {
                let own = [storage::FUNCTION, storage::PRIVATE, storage::INPUT, storage::OUTPUT];
                self.class(self.module[i][3]).is_none_or(|class| !own.contains(&class))
            }
            Op::Function | Op::FunctionCall | Op::FunctionParameter | Op::Undef => false,
            op if op.class() == Class::Constant => !self.is_finite(value),
            _ => true,
        }
    }

    /// Whether a constant is finite, as far as it is known.
    fn is_finite(&self, constant: Id) -> bool {
        match self.module.defined(Op::ConstantComposite, constant) {
            Some(words) => words[3..].iter().all(|part| self.is_finite(*part)),
            None => {
                let is_float = matches!(self.module.get_type(self.module.type_of(constant)), Some(Type::Float { .. }));
                !is_float || self.module.number(constant).is_none_or(|bits| f32::from_bits(bits).is_finite())
            }
        }
    }

    /// The kind of the numbers of a scalar type that is told.
    fn kind(&self, scalar: Id) -> Option<NumberKind> {
        match self.module.get_type(scalar)? {
            Type::Float { bits: 32 } => Some(NumberKind::Float),
            Type::Int { bits: 32, signed } if self.told == Told::All => {
                Some(if signed { NumberKind::Int } else { NumberKind::Uint })
            }
            Type::Bool if self.told == Told::All => Some(NumberKind::Bool),
            _ => None,
        }
    }

    /// Whether values of a type have numbers that are told.
    fn has_told(&self, kind: Id) -> bool {
        match self.module.get_type(kind) {
            Some(Type::Vector { of, .. } | Type::Matrix { column: of, .. }) => self.has_told(of),
            Some(Type::Array { of, length }) => {
                self.module.number(length).is_some_and(|length| length <= MOST_ELEMENTS) && self.has_told(of)
            }
            Some(Type::Struct { members }) => members.iter().any(|member| self.has_told(*member)),
            _ => self.kind(kind).is_some(),
        }
    }

    /// Appends calls with these values, which an instruction uses. Without a line nobody could find the place.
    fn tell(&mut self, out: &mut Vec<Instruction>, i: Instruction, line: Option<Instruction>, values: &[Id]) {
        let line = line.filter(|_| !values.is_empty()).and_then(|line| file_of(self.module, &self.module[line]));
        let Some((file, line)) = line else { return };
        let purpose = match i.op {
            Op::Store => Purpose::Store(self.stored(self.module[i][1]).0),
            Op::ReturnValue => Purpose::Return,
            Op::Load => Purpose::Input(self.stored(self.module[i][3]).0),
            _ => Purpose::Use,
        };
        self.places.push(Place { file, line, purpose });
        for value in values {
            self.tell_parts(out, *value, String::new());
        }
    }

    /// The name of the variable that a pointer points into, and where it points there, as `.lights[2].color`.
    fn stored(&self, pointer: Id) -> (String, String) {
        let chain = [Op::AccessChain, Op::InBoundsAccessChain].map(|op| self.module.defined(op, pointer));
        let Some(words) = chain.into_iter().flatten().next() else {
            return (self.names.get(&pointer).cloned().unwrap_or_default(), String::new());
        };
        let (name, mut path) = self.stored(words[3]);
        let mut kind = self.module.pointer(self.module.type_of(words[3])).map(|(_, to)| to);
        for index in &words[4..] {
            let known = self.module.number(*index);
            let Some(of) = kind else { break };
            path += &known.map_or_else(|| "[ ]".to_owned(), |index| self.part(of, index));
            kind = match self.module.get_type(of) {
                Some(Type::Struct { members }) => known.and_then(|index| members.get(index as usize)).copied(),
                Some(Type::Array { of, .. } | Type::RuntimeArray { of } | Type::Vector { of, .. }) => Some(of),
                Some(Type::Matrix { column, .. }) => Some(column),
                _ => None,
            };
        }
        (name, path)
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

    /// Appends a call for each vector of a value.
    fn tell_parts(&mut self, out: &mut Vec<Instruction>, value: Id, path: String) {
        let kind = self.module.type_of(value);
        let parts: Vec<Id> = match self.module.get_type(kind) {
            _ if !self.has_told(kind) => return,
            Some(Type::Vector { count, of }) => {
                return self
                    .kind(of)
                    .into_iter()
                    .for_each(|kind| self.call(out, kind, Some(value), count, path.clone()));
            }
            Some(Type::Matrix { column: of, count }) => vec![of; count as usize],
            Some(Type::Array { of, length }) => vec![of; self.module.number(length).unwrap_or(0) as usize],
            Some(Type::Struct { members }) => members.to_vec(),
            _ => {
                return self.kind(kind).into_iter().for_each(|kind| self.call(out, kind, Some(value), 1, path.clone()));
            }
        };
        for (place, part) in (0..).zip(parts) {
            if self.has_told(part) {
                let path = path.clone() + &self.part(kind, place);
                let part = self.module.emit(out, Op::CompositeExtract, part, &[value, place]);
                self.tell_parts(out, part, path);
            }
        }
    }

    /// Appends the call with a value of this many numbers.
    fn call(&mut self, out: &mut Vec<Instruction>, kind: NumberKind, value: Option<Id>, count: u32, part: String) {
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
        if count < 4 {
            let parts = [&[bits][..], &[self.zero; 3][count.max(1) as usize - 1..]].concat();
            bits = m.emit(out, Op::CompositeConstruct, self.vectors[2], &parts);
        }
        self.tellings.push(Telling { place: self.places.len() - 1, part, kind, count });
        let telling = m.constant(self.uint, self.tellings.len() as u32);
        m.emit(out, Op::FunctionCall, self.void, &[self.function, telling, bits]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::{specialize, validate};

    /// The lines of places in a function, with their purposes.
    fn places(body: &str) -> Vec<String> {
        let text = format!(
            "#version 460\nlayout(location = 0) in vec3 n;\nlayout(location = 0) out vec4 color;\n\
             layout(set = 1, binding = 0) uniform sampler2D image;\nlayout(constant_id = 7) const uint KIND = 0u;\n\
             struct S {{ float a; vec2 b, c[2]; mat2 d; int e; }};\nuint last;\n\
             void told(const in uint place, const in uvec4 bits) {{ last = place + bits.x; }}\n\
             {body}\nvoid main() {{\n color = vec4(float(f(n.x))); told(0u, uvec4(0u)); }}\n"
        );
        let first = text.lines().position(|line| line.starts_with(body.lines().next().unwrap())).unwrap() as u32;
        let source = Source::memory([("m.frag", text.as_str())]);
        let words = Compiler::new().unwrap().compile_with_lines(&Snapshot::new(&source), &"m.frag".into()).unwrap();
        let Traced { words, places, .. } = trace(&words, "told", Told::Floats, None).unwrap();
        assert_eq!(validate(&words), Ok(()), "{body}");
        assert_eq!(validate(&specialize(&words, &[(7, 1)])), Ok(()), "{body}");
        let own = places.iter().filter(|place| place.line < first + 1 + body.lines().count() as u32);
        own.map(|place| format!("{} {:?}", place.line - first, place.purpose)).collect()
    }

    #[test]
    fn values_are_told_where_they_are_computed() {
        let store = |line: u32, name: &str| format!("{line} Store(\"{name}\")");
        let of = |line: u32, purpose: &str| format!("{line} {purpose}");
        for (body, expected) in [
            ("float f(float x) { return x; }", vec![]),
            ("float f(float x) { return x / 0.0; }", vec![of(1, "Return")]),
            ("float f(float x) {\n float y = x + 1.0;\n return y; }", vec![store(2, "y")]),
            ("float f(float x) {\n int i = 3; ++i; return 2.0; }", vec![]),
            ("float f(float x) {\n const float inf = 1.0 / 0.0;\n x = inf;\n return x; }", vec![store(3, "x")]),
            ("float f(float x) {\n x++;\n return x; }", vec![store(2, "x")]),
            ("float f(float x) {\n if (sqrt(x) > 1.0)\n  return 2.0;\n return 1.0; }", vec![of(2, "Use")]),
            (
                "float f(float x) {\n for (float t = 0.0; t < sqrt(x); t += x)\n  x *= 2.0;\n return x; }",
                vec![of(2, "Use"), store(3, "x"), store(2, "t")],
            ),
            (
                "float f(float x) {\n while (x * x < 1.0) x = n.y;\n return x; }",
                vec![of(2, "Use"), of(2, "Input(\"n\")")],
            ),
            ("float f(float x) {\n float a[2] = float[](x, 1.0 / x);\n return a[1]; }", vec![store(2, "a")]),
            (
                "float f(float x) {\n S s;\n s.b.y = x * x; s.d = mat2(x);\n return s.b.y + s.d[0].x; }",
                vec![store(3, "s"), store(3, "s"), of(4, "Return")],
            ),
            (
                "S g(float x) { return S(x, vec2(x), vec2[](vec2(x), vec2(x)), mat2(x), 1); }\n\
              float f(float x) {\n S s = g(x);\n return s.a; }",
                vec![of(1, "Return")],
            ),
            ("int f(float x) {\n return int(1.0 / x); }", vec![of(2, "Use")]),
            ("float f(float x) {\n return texture(image, vec2(1.0 / x)).r; }", vec![of(2, "Use"), of(2, "Return")]),
            (
                "float g(out float y, const float x) { y = x * x; return y; }\nfloat f(float x) {\n float y;\n return g(y, x * 2.0) + y; }",
                vec![store(1, "y"), of(4, "Use"), of(4, "Return")],
            ),
            ("float f(float x) {\n if (KIND == 1u) x = n.z; return x; }", vec![of(2, "Input(\"n\")")]),
        ] {
            assert_eq!(places(body), expected, "{body}");
        }
    }

    #[test]
    fn a_module_without_the_function_is_not_traced() {
        let source = Source::memory([("m.frag", "#version 460\nvoid main() {}\n")]);
        let words = Compiler::new().unwrap().compile_with_lines(&Snapshot::new(&source), &"m.frag".into()).unwrap();
        assert!([Told::Floats, Told::All].iter().all(|told| trace(&words, "told", *told, None).is_none()));
        assert!(trace(&[1, 2], "told", Told::All, None).is_none());
    }
}
