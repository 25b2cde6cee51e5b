use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::enums::storage;
use crate::shader::spirv::module::{Function, Instruction};
use crate::shader::spirv::op::Op;

/// A fragment stage with these functions, optimized.
#[track_caller]
fn optimized_stage(functions: &str) -> Vec<u32> {
    let text = format!(
        "#version 460\nstruct Part {{ vec3 a; float b[3]; }};\nstruct Whole {{ Part part; float c; }};\n\
         layout(location = 0) in vec4 x;\nlayout(location = 1) in flat ivec4 n;\nlayout(location = 0) out vec4 color;\n{functions}\n"
    );
    let source = Source::memory([("m.frag", text.as_str())]);
    let words = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap();
    optimized(Module::parse(&words).unwrap()).expect("all instructions are known").write()
}

/// The instructions of all functions with an operation.
fn all(module: &Module, op: Op) -> Vec<Instruction> {
    module.functions.iter().flat_map(Function::instructions).filter(|i| i.op == op).collect()
}

fn count(words: &[u32], op: Op) -> usize {
    all(&Module::parse(words).expect("a module"), op).len()
}

/// Variables of functions.
fn locals(words: &[u32]) -> usize {
    let module = Module::parse(words).expect("a module");
    all(&module, Op::Variable).into_iter().filter(|i| module[*i][3] == storage::FUNCTION).count()
}

#[test]
fn calls_and_variables_become_values() {
    for body in [
        "float f(float a) { return a * 2.0; } void main() { color = vec4(f(x.x), f(x.y), 0.0, 1.0); }",
        "void f(inout vec4 a) { a.y += 1.0; } void main() { vec4 v = x; f(v); color = v; }",
        "Whole f(Whole w) { w.part.b[1] = w.c; return w; }
         void main() { Whole w; w.c = x.x; w.part.a = x.xyz; w = f(w); color = vec4(w.part.a.xy, w.part.b[1], w.c); }",
        // Early returns, from nested selections
        "float f(float a) { if (a > 1.0) { if (a > 2.0) return 3.0; a += 1.0; } else return a; return a * a; }
         void main() { color = vec4(f(x.x)); }",
        // A loop with an exit, and a value that changes in it
        "void main() { float sum = 0.0; for (int i = 0; i < n.x; ++i) { if (sum > 9.0) break; sum += x.x; } color = vec4(sum); }",
        "float f(int i) { float a = 0.0; switch (i) { case 0: a = 1.0; break; case 1: a = 2.0; default: a += 5.0; } return a; }
         void main() { color = vec4(f(n.x)); }",
        "float state = 1.0; void f() { state += x.x; } void main() { f(); f(); color = vec4(state); }",
    ] {
        let words = optimized_stage(body);
        assert_eq!((count(&words, Op::FunctionCall), locals(&words)), (0, 0), "{body}");
    }
}

#[test]
fn what_stays_is_called_and_stored() {
    // An array that an unknown index reads, and a return from within a loop
    let words = optimized_stage("void main() { float a[3] = float[](x.x, x.y, x.z); color = vec4(a[n.x]); }");
    assert_eq!(locals(&words), 1);
    let words = optimized_stage(
        "float f(float a) { for (int i = 0; i < n.x; ++i) { if (a > 2.0) return a; a += x.x; } return 0.0; }
         void main() { color = vec4(f(x.x)); }",
    );
    assert_eq!(count(&words, Op::FunctionCall), 1);
}

#[test]
fn what_is_computed_twice_or_not_used_goes() {
    const SIN: u32 = 13;
    let words = optimized_stage(
        "float f(float a) { return sin(a); }
         void main() { float unused = cos(x.y); Part p; p.a = vec3(x.x, x.yz); p.b[0] = f(p.a.x); color = vec4(f(x.x), p.b[0], 0.0, 1.0); }",
    );
    let module = Module::parse(&words).expect("a module");
    let functions: Vec<u32> = all(&module, Op::ExtInst).into_iter().map(|i| module[i][4]).collect();
    assert_eq!(functions, [SIN]);
    // A parameter decides a branch.
    let words = optimized_stage(
        "float f(bool is_sine) { if (is_sine) return sin(x.x); return cos(x.x); } void main() { color = vec4(f(true)); }",
    );
    assert_eq!((count(&words, Op::ExtInst), count(&words, Op::BranchConditional)), (1, 0));
}

/// An index that a constant sets beyond the end means nothing, but must not end the program.
#[test]
fn an_index_beyond_the_end_stays_in_memory() {
    for body in [
        "void main() { vec4 v = vec4(x.x, x.y, x.z, 1.0); v[K] += 1.0; color = vec4(v[K]); }",
        "void main() { mat2 m = mat2(x.x); m[K].y = 2.0; color = m[K].xyxy; }",
        "void main() { const vec4 v = vec4(1.0, 2.0, 3.0, 4.0); color = vec4(v[K]); }",
        "void main() { vec2 v = x.zy; color = vec4(v[K]); }",
    ] {
        let words = optimized_stage(&format!("layout(constant_id = 0) const int K = 7;\n{body}"));
        let module = Module::parse(&words).expect("a module");
        let mut extracts = all(&module, Op::CompositeExtract).into_iter();
        assert!(extracts.all(|i| module[i][4..].iter().all(|index| *index < 4)), "{body}");
    }
}

#[test]
fn modules_with_what_is_not_known_come_back() {
    let stage = |text: &str| {
        let source = Source::memory([("m.frag", text)]);
        Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap()
    };
    for text in [
        "#extension GL_EXT_debug_printf : enable\nvoid main() { debugPrintfEXT(\"seen\"); }",
        "layout(set = 0, binding = 0) uniform texture2D t; layout(set = 0, binding = 1) uniform sampler s;
         layout(location = 0) out vec4 color; void main() { color = texture(sampler2D(t, s), vec2(0.5)); }",
    ] {
        let words = stage(&format!("#version 460\n{text}"));
        assert_eq!(optimize(words.clone()), words, "{text}");
    }
    // A flag that others write is read each time.
    let volatile =
        "layout(set = 0, binding = 0) volatile buffer Flags { uint flag; }; layout(location = 0) out vec4 color;
        void main() { uint before = flag; uint after = flag; color = vec4(before, after, 0.0, 1.0); }";
    let words = optimize(stage(&format!("#version 460\n{volatile}")));
    assert_eq!(count(&words, Op::Load), 2);
}

#[test]
fn words_that_are_no_module_come_back() {
    for words in [vec![], vec![1, 2, 3], vec![0x0723_0203, 0, 0, 9, 0, 0], vec![0x0723_0203, 0, 0, 9, 0, 0xffff_0036]] {
        assert_eq!(optimize(words.clone()), words);
    }
}

#[test]
fn what_nothing_has_changed_is_equal_to_what_it_was() {
    let functions = |hook: &str| {
        format!(
            "bool is_same(float a, float b) {{ return floatBitsToUint(a) == floatBitsToUint(b); }}
             bool is_same(vec3 a, vec3 b) {{ return all(equal(floatBitsToUint(a), floatBitsToUint(b))); }}
             void hook(inout Whole w) {{ {hook} }}
             void main() {{
                 Whole w; w.c = x.x; w.part.a = x.xyz; Whole before = w; hook(w);
                 bool is_tilted = !is_same(w.part.a, before.part.a); bool is_other = !is_same(w.c, before.c);
                 if (is_tilted) w.c = sin(w.c);
                 if (is_other) w.c = sin(w.c);
                 color = vec4(w.part.a, w.c);
             }}"
        )
    };
    let of = |hook: &str| {
        let words = optimized_stage(&functions(hook));
        (count(&words, Op::ExtInst), count(&words, Op::BranchConditional))
    };
    assert_eq!(of(""), (0, 0));
    assert_eq!(of("w.part.b[1] = 2.0;"), (0, 0));
    // The first of the two sines is gone.
    assert_eq!(of("w.c *= 2.0;"), (1, 1));
}
