//! Random GLSL programs compute the same with and without what this program does to their modules: specialization, bounded loops,
//! optimization. `SPECULA_LONG=1` tries programs for an hour.

use std::fmt::Write as _;
use std::sync::Arc;
use std::time::{Duration, Instant};

use specula::gpu::{
    Buffer, ComputePipeline, DescriptorSet, Memory, ResourceUsage, SetLayouts, SetWriter, ShaderModule, one_shot, vk,
};
use specula::interface::{BINDING_RESULTS, SET_TASK};
use specula::shader::StageKind;
use specula::shader::spirv::loops::Bounds;
use specula::shader::spirv::{finish, specialize, validate};

use crate::support::{assert_validated, compiler, gpu, is_long};

const PROGRAMS: u64 = 24;
const LONG: Duration = Duration::from_secs(3600);
const INVOCATIONS: u32 = 64;
const FUNCTIONS: usize = 4;

/// A pseudorandom sequence (xorshift64*, Vigna 2016).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % end
    }

    fn choose<'a, T: ?Sized>(&mut self, from: &[&'a T]) -> &'a T {
        from[self.below(from.len())]
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Int,
    Float,
    Vector,
    Struct,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Int, Self::Float, Self::Vector, Self::Struct];

    fn glsl(self) -> &'static str {
        ["int", "float", "vec3", "S"][self as usize]
    }
}

/// A function that later ones may call. Each parameter is a qualifier and a type.
struct Function {
    name: String,
    returns: Kind,
    parameters: Vec<(&'static str, Kind)>,
}

/// Writes one program. All numbers are multiples of 1/4 that floats hold exactly, so that no order of operations matters.
struct Writer {
    random: Random,
    text: String,
    functions: Vec<Function>,
    /// Variables in scope.
    scope: Vec<(String, Kind)>,
    /// Names of counters, which only their loops change.
    counters: Vec<String>,
    names: usize,
    returns: Kind,
    /// The loops and switches around a statement, which it may leave.
    loops: usize,
    breakable: usize,
}

impl Writer {
    fn name(&mut self, kind: &str) -> String {
        self.names += 1;
        format!("{kind}{}", self.names)
    }

    fn variable(&mut self, kind: Kind) -> Option<String> {
        let all: Vec<&str> = self.scope.iter().filter(|(_, of)| *of == kind).map(|(name, _)| name.as_str()).collect();
        (!all.is_empty()).then(|| self.random.choose(&all).to_owned())
    }

    /// A variable or a part of one that holds a float.
    fn part(&mut self) -> Option<String> {
        let index = format!("({} & 1)", self.counters.last().map_or("K", |counter| counter.as_str()));
        match self.random.below(5) {
            0 => self.variable(Kind::Float),
            1 => Some(format!("{}.{}", self.variable(Kind::Vector)?, self.random.choose(&["x", "y", "z"]))),
            2 => Some(format!("{}[{index}]", self.variable(Kind::Vector)?)),
            3 => {
                Some(format!("{}.a[{}]", self.variable(Kind::Struct)?, self.random.choose(&["0", "2", index.as_str()])))
            }
            _ => Some(format!("{}.b.{}", self.variable(Kind::Struct)?, self.random.choose(&["x", "y"]))),
        }
    }

    fn int(&mut self, depth: usize) -> String {
        if depth == 0 {
            let known = if self.random.below(3) > 0 { self.variable(Kind::Int) } else { self.counters.last().cloned() };
            return known.unwrap_or_else(|| ["K", "0", "1", "3", "-2", "7"][self.random.below(6)].to_owned());
        }
        let (a, b) = (self.int(depth - 1), self.int(depth - 1));
        match self.random.below(8) {
            0 => format!("(({a} + {b}) & 255)"),
            1 => format!("(({a} - {b}) & 63)"),
            2 => format!("(({a} * {b}) & 127)"),
            3 => format!("({a} ^ {b})"),
            4 => format!("min({a}, {b})"),
            5 => format!("({} ? {a} : {b})", self.condition(depth - 1)),
            6 => format!("int({})", self.float(depth - 1)),
            _ => self.variable(Kind::Struct).map_or(a, |s| format!("{s}.c")),
        }
    }

    fn float(&mut self, depth: usize) -> String {
        if depth == 0 {
            let number = format!("{:?}", self.random.below(33) as f32 * 0.25 - 2.0);
            return self.part().unwrap_or(number);
        }
        let (a, b) = (self.float(depth - 1), self.float(depth - 1));
        match self.random.below(7) {
            0 => format!("clamp({a} + {b}, -256.0, 256.0)"),
            1 => format!("clamp({a} - {b}, -256.0, 256.0)"),
            2 => format!("floor(clamp({a} * {b}, -64.0, 64.0))"),
            3 => format!("max({a}, {b})"),
            4 => format!("({} ? {a} : {b})", self.condition(depth - 1)),
            5 => format!("float({} & 63)", self.int(depth - 1)),
            _ => self.call(Kind::Float).unwrap_or(a),
        }
    }

    fn condition(&mut self, depth: usize) -> String {
        match self.random.below(if depth == 0 { 3 } else { 6 }) {
            0 => format!("({} < {})", self.int(depth), self.int(depth)),
            1 => format!("({} >= {})", self.float(depth), self.float(depth)),
            2 => format!("(K == {})", self.random.below(4)),
            3 => format!("({} && {})", self.condition(depth - 1), self.condition(depth - 1)),
            4 => format!("({} || {})", self.condition(depth - 1), self.condition(depth - 1)),
            _ => format!("!{}", self.condition(depth - 1)),
        }
    }

    fn value(&mut self, kind: Kind, depth: usize) -> String {
        let known = if self.random.below(3) == 0 { self.call(kind) } else { None };
        known.unwrap_or_else(|| match kind {
            Kind::Int => self.int(depth),
            Kind::Float => self.float(depth),
            Kind::Vector => match (self.random.below(3), self.variable(kind)) {
                (0, Some(v)) => format!("{v}.{}", self.random.choose(&["zyx", "yyz", "xzy"])),
                (1, Some(v)) => format!("clamp({v} + vec3({}), -256.0, 256.0)", self.float(0)),
                _ => format!("vec3({}, {}, {})", self.float(depth), self.float(0), self.float(0)),
            },
            Kind::Struct => match (self.random.below(2), self.variable(kind)) {
                (0, Some(s)) => s,
                _ => format!(
                    "S(float[3]({}, {}, 0.5), vec2({}), {})",
                    self.float(0),
                    self.float(depth),
                    self.float(0),
                    self.int(0)
                ),
            },
        })
    }

    /// A call of a function that returns such a value. Its `inout` arguments are different variables.
    fn call(&mut self, kind: Kind) -> Option<String> {
        let all: Vec<usize> = (0..self.functions.len()).filter(|at| self.functions[*at].returns == kind).collect();
        // Calls within nested loops would take more rounds than lavapipe allows.
        if all.is_empty() || self.counters.len() > 1 {
            return None;
        }
        let at = all[self.random.below(all.len())];
        let (name, parameters) = (self.functions[at].name.clone(), self.functions[at].parameters.clone());
        let mut given: Vec<String> = Vec::new();
        for (qualifier, kind) in parameters {
            let argument = match qualifier {
                "in" => self.value(kind, 0),
                _ => self.variable(kind).filter(|name| !given.contains(name))?,
            };
            given.push(argument);
        }
        Some(format!("{name}({})", given.join(", ")))
    }

    /// Statements of a block with variables of its own.
    fn block(&mut self, depth: usize) {
        let known = self.scope.len();
        for _ in 0..1 + self.random.below(3) {
            self.statement(depth);
        }
        self.scope.truncate(known);
    }

    fn line(&mut self, text: &str) {
        self.text += text;
        self.text += "\n";
    }

    fn statement(&mut self, depth: usize) {
        let kind = Kind::ALL[self.random.below(4)];
        match self.random.below(if depth == 0 { 5 } else { 10 }) {
            0 => {
                let (name, value) = (self.name("v"), self.value(kind, 1));
                self.line(&format!("{} {name} = {value};", kind.glsl()));
                self.scope.push((name, kind));
            }
            1 | 2 => {
                if let Some(name) = self.variable(kind) {
                    let value = self.value(kind, 2);
                    self.line(&format!("{name} = {value};"));
                }
            }
            3 => {
                if let Some(part) = self.part() {
                    let value = self.float(1);
                    self.line(&format!("{part} = {value};"));
                }
            }
            4 => {
                if let Some(name) = self.variable(Kind::Vector) {
                    let value = self.value(Kind::Vector, 0);
                    self.line(&format!("{name}.zx = ({value}).xy;"));
                }
            }
            5 | 6 => {
                let condition = self.condition(1);
                self.line(&format!("if ({condition}) {{"));
                self.block(depth - 1);
                self.leave();
                if self.random.below(2) == 0 {
                    self.line("} else {");
                    self.block(depth - 1);
                    self.leave();
                }
                self.line("}");
            }
            7 => self.counted_loop(depth),
            8 => {
                let counter = self.name("n");
                let condition = self.condition(0);
                self.line(&format!("int {counter} = 0;\ndo {{"));
                self.within_loop(&counter, depth);
                self.line(&format!("}} while (++{counter} < 3 && {condition});"));
            }
            _ => self.switch(depth),
        }
    }

    fn counted_loop(&mut self, depth: usize) {
        let (counter, end) = (self.name("i"), self.int(1));
        let most = if self.functions.len() == FUNCTIONS { 3 } else { 1 };
        self.line(&format!("int {counter}_end = ({end} & {most}) + 1;"));
        self.line(&format!("for (int {counter} = 0; {counter} < {counter}_end; ++{counter}) {{"));
        self.within_loop(&counter, depth);
        self.line("}");
    }

    fn within_loop(&mut self, counter: &str, depth: usize) {
        self.counters.push(counter.to_owned());
        (self.loops, self.breakable) = (self.loops + 1, self.breakable + 1);
        self.block(depth - 1);
        (self.loops, self.breakable) = (self.loops - 1, self.breakable - 1);
        self.counters.pop();
    }

    fn switch(&mut self, depth: usize) {
        let selector = self.int(1);
        self.line(&format!("switch ({selector} & 3) {{"));
        self.breakable += 1;
        for case in ["case 0:", "case 2:", "default:"] {
            self.line(&format!("{case} {{"));
            self.block(depth - 1);
            self.line("}");
            if self.random.below(2) == 0 {
                self.line("break;");
            }
        }
        self.breakable -= 1;
        self.line("break; }");
    }

    /// Leaves a loop, a switch or the function, now and then.
    fn leave(&mut self) {
        match self.random.below(6) {
            0 if self.breakable > 0 => self.line("break;"),
            1 if self.loops > 0 => self.line("continue;"),
            2 => {
                let value = self.value(self.returns, 1);
                self.line(&format!("return {value};"));
            }
            _ => {}
        }
    }

    fn function(&mut self) {
        let (name, returns) = (self.name("f"), Kind::ALL[self.random.below(4)]);
        let parameters: Vec<(&str, Kind)> = (0..1 + self.random.below(3))
            .map(|_| (self.random.choose(&["in", "inout", "in", "out"]), Kind::ALL[self.random.below(4)]))
            .collect();
        let (mut declared, mut outputs) = (Vec::new(), Vec::new());
        self.scope = vec![("state".to_owned(), Kind::Float), ("store".to_owned(), Kind::Struct)];
        for (qualifier, kind) in &parameters {
            let name = self.name("p");
            declared.push(format!("{qualifier} {} {name}", kind.glsl()));
            if *qualifier == "out" {
                outputs.push((name.clone(), *kind));
            } else {
                self.scope.push((name, *kind));
            }
        }
        self.line(&format!("{} {name}({}) {{", returns.glsl(), declared.join(", ")));
        for (name, kind) in outputs {
            let value = self.value(kind, 0);
            self.line(&format!("{name} = {value};"));
            self.scope.push((name, kind));
        }
        self.returns = returns;
        for _ in 0..3 {
            self.statement(2);
        }
        let value = self.value(returns, 1);
        self.line(&format!("return {value};\n}}"));
        self.functions.push(Function { name, returns, parameters });
    }
}

/// A compute stage with the default `constant` of the specialization constant 0.
fn program(seed: u64, constant: usize) -> String {
    let random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut writer = Writer {
        random,
        text: String::new(),
        functions: Vec::new(),
        scope: Vec::new(),
        counters: Vec::new(),
        names: 0,
        returns: Kind::Int,
        loops: 0,
        breakable: 0,
    };
    for _ in 0..FUNCTIONS {
        writer.function();
    }
    let given = [("k", Kind::Int), ("x", Kind::Float), ("v", Kind::Vector), ("s", Kind::Struct)];
    writer.scope = given.map(|(name, kind)| (name.to_owned(), kind)).to_vec();
    writer.returns = Kind::Float;
    writer.line("float program(int k, float x) {\nvec3 v = vec3(x, 1.0, float(k));\nS s = store;");
    for _ in 0..6 {
        writer.statement(3);
    }
    for kind in Kind::ALL {
        let (name, value) = (["k", "x", "v", "s"][kind as usize], writer.value(kind, 2));
        writer.line(&format!("{name} = {value};"));
    }
    writer.line("return x + v.x + v.y * 2.0 + v.z * 4.0 + s.a[0] + s.a[1] * 2.0 + s.a[2] + s.b.x + s.b.y + float((k ^ s.c) & 255) + state;\n}");
    let mut text = format!(
        "#version 460\nlayout(local_size_x = {INVOCATIONS}) in;\nlayout(constant_id = 0) const int K = {constant};\n\
         layout(set = {SET_TASK}, binding = {BINDING_RESULTS}) buffer Results {{ int results[]; }};\n\
         struct S {{ float a[3]; vec2 b; int c; }};\nfloat state = 0.5;\n\
         S store = S(float[3](1.0, 2.0, 3.0), vec2(0.25, -1.0), 5);\n{}",
        writer.text
    );
    let call = "int id = int(gl_GlobalInvocationID.x);\nresults[id] = int(floor(program(id & 7, float(id >> 3) * 0.5) * 16.0));";
    write!(text, "void main() {{\n{call}\n}}\n").unwrap();
    text
}

/// What a compute module writes.
fn run(layouts: &Arc<SetLayouts>, words: &[u32]) -> Vec<i32> {
    let module = ShaderModule::new(gpu(), "random.comp", words, false, ResourceUsage::default()).unwrap();
    let pipeline = ComputePipeline::new(gpu(), layouts, &module, None).unwrap();
    let bytes = u64::from(INVOCATIONS) * 4;
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let results = Buffer::new(gpu(), "results", bytes, usage, Memory::Readback).unwrap();
    let set = DescriptorSet::new(layouts, SET_TASK, SetWriter::default().buffer(BINDING_RESULTS, &results)).unwrap();
    one_shot(gpu(), |encoder| {
        encoder.keep(&set);
        encoder.dispatch(&pipeline, &[&set], [1, 1, 1]);
        encoder.computed();
        Ok(())
    })
    .unwrap();
    results.read().chunks_exact(4).map(|bytes| i32::from_le_bytes(bytes.try_into().unwrap())).collect()
}

#[test]
fn random_programs_compute_the_same_when_they_are_optimized() {
    let layouts = SetLayouts::new(gpu()).unwrap();
    let start = Instant::now();
    let is_long = is_long();
    let (mut optimized, mut results) = (0, std::collections::HashSet::new());
    for seed in (0..).take_while(|seed| *seed < PROGRAMS || (is_long && start.elapsed() < LONG)) {
        let constant = seed as usize % 4;
        let compile = |constant: usize| {
            let text = program(seed, constant);
            compiler()
                .compile_alone("random.comp", &text, StageKind::Compute)
                .unwrap_or_else(|log| panic!("{log}\n{text}"))
        };
        let plain = compile(constant);
        let specialized = specialize(&compile(9), &[(0, constant as u32)]);
        let bounds = Bounds { rounds: 1 << 18, rounds_after: 256, report: None, mark: None };
        let finished = finish(specialized, &plain, &bounds, false);
        for words in [&plain, &finished.words] {
            validate(words).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{}", program(seed, constant)));
        }
        let (expected, found) = (run(&layouts, &plain), run(&layouts, &finished.words));
        assert_eq!(found, expected, "seed {seed}:\n{}", program(seed, constant));
        optimized += u64::from(finished.words.len() != finished.unoptimized);
        results.insert(expected);
    }
    assert!(optimized >= PROGRAMS && results.len() > 20, "{optimized} optimized, {} different results", results.len());
    assert_validated();
}
