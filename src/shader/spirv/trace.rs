//! Instruments a module so that it tells the values that its statements compute.
//!
//! Before each instruction that stores, returns, passes, compares, converts or samples with a value of floats, the module calls a
//! function of its own text with the number of the place and the bits of the value. Each place has a file, a line and a purpose. The
//! function decides about the values: keep the first that is not finite, or all.
//!
//! A value is told once: where a variable, a parameter or the result of a call is only copied, the statement that computed it has told
//! it before. What the stage before has written is told where it is read.

use foldhash::{HashMap, HashSet, HashSetExt};

use super::enums::storage;
use super::module::{Id, Instruction, Module, Type};
use super::op::{Class, Op, text};
use super::reach::file_of;

/// Longer arrays are not told.
const MOST_ELEMENTS: u32 = 64;

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

/// Instruments a module with line information. `function` is the name of `void function(const in uint place, const in uvec4 bits)`,
/// which gets a value of up to four floats, filled up by zeros. `place` is the number of the place from 1, times 4, and the number of
/// floats but one. `None` if the module has no such function.
pub fn trace(words: &[u32], function: &str) -> Option<(Vec<u32>, Vec<Place>)> {
    let mut module = Module::parse(words)?;
    let function = module.named(&format!("{function}(")).next()?;
    let names = module.debug.iter().filter(|i| i.op == Op::Name).map(|i| &module[*i]);
    let names = names.map(|words| (words[1], text(&words[2..]))).collect();
    let void = module.declare(Op::TypeVoid, &[]);
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let vectors = [2, 3, 4].map(|count| module.declare(Op::TypeVector, &[uint, count]));
    let zero = module.constant(uint, 0);
    let mut functions = std::mem::take(&mut module.functions);
    let mut tracer = Tracer { module: &mut module, names, function, void, uint, vectors, zero, places: Vec::new() };
    for function in &mut functions {
        function.head.retain(|i| !is_line(*i));
        for block in &mut function.blocks {
            block.body = tracer.block(&block.body);
        }
    }
    let places = tracer.places;
    module.functions = functions;
    // The passes that follow expect no lines.
    module.globals.retain(|i| !is_line(*i));
    module.debug.retain(|i| matches!(i.op, Op::Name | Op::MemberName));
    Some((module.write(), places))
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
    function: Id,
    void: Id,
    uint: Id,
    /// The vectors of two, three and four.
    vectors: [Id; 3],
    zero: Id,
    places: Vec<Place>,
}

impl Tracer<'_> {
    /// The instructions of a block with calls between them, without lines.
    fn block(&mut self, body: &[Instruction]) -> Vec<Instruction> {
        let (mut out, mut line, mut told) = (Vec::with_capacity(body.len()), None, HashSet::new());
        for &i in body {
            if is_line(i) {
                line = (i.op == Op::Line).then_some(i);
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

    /// The storage class that a pointer points to.
    fn class(&self, pointer: Id) -> Option<u32> {
        self.module.pointer(self.module.type_of(pointer)).map(|(class, _)| class)
    }

    /// The values of floats among the operands that no other place tells.
    fn computed(&self, i: Instruction) -> Vec<Id> {
        let result = self.module.result(i);
        let operands = self.module.ids_of(i).filter(|id| Some(*id) != result);
        operands.filter(|id| self.has_floats(self.module.type_of(*id)) && self.is_computed(*id)).collect()
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

    /// Whether values of a type have floats that are told.
    fn has_floats(&self, kind: Id) -> bool {
        match self.module.get_type(kind) {
            Some(Type::Float { bits }) => bits == 32,
            Some(Type::Vector { of, .. } | Type::Matrix { column: of, .. }) => self.has_floats(of),
            Some(Type::Array { of, length }) => {
                self.module.number(length).is_some_and(|length| length <= MOST_ELEMENTS) && self.has_floats(of)
            }
            Some(Type::Struct { members }) => members.iter().any(|member| self.has_floats(*member)),
            _ => false,
        }
    }

    /// Appends calls with these values, which an instruction uses. Without a line nobody could find the place.
    fn tell(&mut self, out: &mut Vec<Instruction>, i: Instruction, line: Option<Instruction>, values: &[Id]) {
        let line = line.filter(|_| !values.is_empty()).and_then(|line| file_of(self.module, &self.module[line]));
        let Some((file, line)) = line else { return };
        let purpose = match i.op {
            Op::Store => Purpose::Store(self.variable(self.module[i][1])),
            Op::ReturnValue => Purpose::Return,
            Op::Load => Purpose::Input(self.variable(self.module[i][3])),
            _ => Purpose::Use,
        };
        self.places.push(Place { file, line, purpose });
        for value in values {
            self.tell_parts(out, *value);
        }
    }

    /// The name of the variable that a pointer points into.
    fn variable(&self, pointer: Id) -> String {
        let chain = [Op::AccessChain, Op::InBoundsAccessChain].map(|op| self.module.defined(op, pointer));
        match chain.into_iter().flatten().next() {
            Some(words) => self.variable(words[3]),
            None => self.names.get(&pointer).cloned().unwrap_or_default(),
        }
    }

    /// Appends a call for each vector of a value.
    fn tell_parts(&mut self, out: &mut Vec<Instruction>, value: Id) {
        let kind = self.module.type_of(value);
        let (uint, zero) = (self.uint, self.zero);
        let parts: Vec<Id> = match self.module.get_type(kind) {
            _ if !self.has_floats(kind) => return,
            Some(Type::Float { .. }) => return self.call(out, value, uint, 1),
            Some(Type::Vector { count, .. }) => {
                return self.call(out, value, self.vectors[count as usize - 2], count);
            }
            Some(Type::Matrix { column: of, count }) => vec![of; count as usize],
            Some(Type::Array { of, length }) => vec![of; self.module.number(length).unwrap_or(zero) as usize],
            Some(Type::Struct { members }) => members.to_vec(),
            _ => return,
        };
        for (place, part) in (0..).zip(parts) {
            if self.has_floats(part) {
                let part = self.module.emit(out, Op::CompositeExtract, part, &[value, place]);
                self.tell_parts(out, part);
            }
        }
    }

    /// Appends the call with a value of this many floats. `kind`: the type of as many words.
    fn call(&mut self, out: &mut Vec<Instruction>, value: Id, kind: Id, count: u32) {
        let m = &mut *self.module;
        let mut bits = m.emit(out, Op::Bitcast, kind, &[value]);
        if count < 4 {
            let parts = [&[bits][..], &[self.zero; 3][count as usize - 1..]].concat();
            bits = m.emit(out, Op::CompositeConstruct, self.vectors[2], &parts);
        }
        let place = m.constant(self.uint, self.places.len() as u32 * 4 + count - 1);
        m.emit(out, Op::FunctionCall, self.void, &[self.function, place, bits]);
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
        let (words, places) = trace(&words, "told").unwrap();
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
        assert!(trace(&words, "told").is_none() && trace(&[1, 2], "told").is_none());
    }
}
