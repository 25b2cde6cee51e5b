//! Tests on modules that glslang compiles.

use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::{optimize, specialize, validate};

const NAMES: Names<'_> = Names {
    main: "author",
    own: "specula_cost",
    read: "specula_cost_read",
    count: "specula_cost_count_",
    values: "specula_cost_values_",
};

/// Numbers of extended instructions.
const SIN: u32 = 13;
const COS: u32 = 14;
const TAN: u32 = 15;

/// The module of a fragment stage with these functions, whose `author` is its main function.
fn compiled(functions: &str) -> Vec<u32> {
    let all = |name: &str, with: &str| (0..16).map(|at| format!("{name}{at}")).collect::<Vec<_>>().join(with);
    let [counts, counts_sum] = [", ", " + "].map(|with| all(NAMES.count, with));
    let [values, values_sum] = [", ", " + "].map(|with| all(NAMES.values, with));
    let text = format!(
        "#version 460
         layout(location = 0) in vec4 at;
         layout(location = 0) out vec4 color;
         layout(constant_id = 7) const uint KIND = 1u;
         layout(set = 0, binding = 0) buffer Numbers {{ uvec4 numbers[]; }};
         uint {counts};
         uvec4 {values};
         uvec4 specula_cost_read(const in uint index) {{ return numbers[index]; }}
         {functions}
         void main() {{ specula_cost_read(0u); author(); color.a += float({counts_sum} + ({values_sum}).x); }}"
    );
    let source = Source::memory([("m.frag", text.as_str())]);
    Compiler::new().unwrap().compile_with_lines(&Snapshot::new(&source), &"m.frag".into()).unwrap()
}

const FUNCTIONS: &str = "
    struct Pair { float a; ivec2 b; bool c; };
    float seed;
    Pair pair(float x) { return Pair(x, ivec2(x), x > 0.5); }
    mat2 both(in vec2 x, out float y, inout float z) { y = x.x; z += 1.0; return mat2(x, x); }
    float random() { seed = fract(seed * 7.1); return seed; }
    void stop(float x) { if (x < 0.0) discard; }
    void log_it(float x) { numbers[3].x = uint(x); }
    float calls_log(float x) { log_it(x); return x; }
    bool is_second() { return KIND == 2u; }
    float never(float x) { return x * 3.0; }
    void paint(vec3 x) { color.rgb = x; }
    struct Known { int a; int b; mat2 c; };
    void touch(inout Known k, float x) { k.a = int(x * x); k.c[1] = vec2(x); }
    struct Large { ivec4 all[20]; int other; };
    void fill(inout Large large, float x) { large.all[2] = ivec4(x * x); }
    void author() {
        float y, z = 2.0;
        mat2 m = both(at.xy, y, z);
        Pair p = pair(at.z);
        stop(at.w);
        float all = m[0].x + y + z + p.a + float(p.b.x) + float(p.c) + random() + calls_log(at.x);
        if (is_second()) all += never(all);
        Known k = Known(0, 2, mat2(0.0));
        touch(k, at.x);
        if (k.a == 3) all += sin(all);
        if (k.b == 3) all += cos(all);
        Large large;
        large.all[2] = ivec4(0);
        fill(large, at.x);
        if (large.all[2].y == 3) all += tan(all);
        paint(vec3(all));
    }";

fn named(functions: &[StageFunction], name: &str) -> StageFunction {
    functions.iter().find(|of| of.signature.starts_with(name)).unwrap_or_else(|| panic!("{name}")).clone()
}

#[test]
fn functions_are_described() {
    let words = compiled(FUNCTIONS);
    let functions = functions(&words, &NAMES).unwrap();
    let of = |name: &str| named(&functions, name);
    let both = of("both");
    let part = |parameter, member, is_given| WrittenPart { parameter, member, is_given };
    let written = [part(1, None, false), part(2, None, true)];
    assert_eq!(
        (both.signature.as_str(), both.numbers, both.written.as_slice()),
        ("both(vec2, float, float)", 6, &written[..])
    );
    let touch = of("touch");
    assert_eq!((touch.numbers, touch.written), (5, vec![part(0, Some(0), true), part(0, Some(2), true)]));
    let (fill, kept) = (of("fill"), vec![part(0, Some(0), true)]);
    assert_eq!((fill.numbers, fill.written, fill.kept), (1, Vec::new(), kept));
    assert_eq!((of("pair").numbers, of("pair").lack), (4, None));
    assert_eq!(of("random").lack, Some(Lack::WritesVariable("seed".to_owned())));
    assert_eq!(of("paint").lack, Some(Lack::WritesVariable("color".to_owned())));
    assert_eq!(of("stop").lack, Some(Lack::Discards));
    assert_eq!((of("log_it").lack, of("calls_log").lack), (Some(Lack::WritesMemory), Some(Lack::WritesMemory)));
    assert!(!functions.iter().any(|of| of.signature.starts_with("author") || of.signature.contains("specula")));
    let plain = without(&words, None, &NAMES).unwrap();
    let mut known = Known::default();
    known.add(&specialize(&plain, &[]));
    assert_eq!(known.lack(&of("never")), Some(Lack::NotCalled));
    assert_eq!(known.lack(&of("is_second")), Some(Lack::Constant));
    assert_eq!((known.lack(&both), known.lack(&of("stop"))), (None, Some(Lack::Discards)));
}

#[test]
fn modules_are_valid_and_have_lost_one_function() {
    let words = compiled(FUNCTIONS);
    let functions = functions(&words, &NAMES).unwrap();
    let check = |words: Vec<u32>, what: &str| {
        assert_eq!(validate(&words), Ok(()), "{what}");
        let optimized = optimize(specialize(&words, &[(7, 2)]));
        assert_eq!(validate(&optimized), Ok(()), "{what}, optimized");
        optimized.len()
    };
    let whole = check(without(&words, None, &NAMES).unwrap(), "whole");
    assert!(check(recording(&words, &functions, &NAMES).unwrap(), "recording") > whole);
    let (first, count) = groups(&functions);
    assert_eq!(count, functions.iter().map(groups_of).sum::<u32>());
    for (of, first) in functions.iter().zip(first).filter(|(of, _)| of.lack.is_none()) {
        let stub = without(&words, Some((of, first)), &NAMES).unwrap();
        check(stub.clone(), &of.signature);
        // Its body has no operation of the author's any more.
        let module = Module::parse(&stub).unwrap();
        let function = module.functions.iter().find(|function| function.id == of.id).unwrap();
        assert!(function.blocks.len() == 1 && function.calls(&module).count() == of.numbers.div_ceil(4), "{of:?}");
    }
}

/// Without a function that writes to a variable of the caller, the compiler must not compute what depends on that variable.
#[test]
fn values_of_a_caller_do_not_decide_what_follows() {
    let words = compiled(FUNCTIONS);
    let functions = functions(&words, &NAMES).unwrap();
    let (first, _) = groups(&functions);
    for (name, operation, other) in [("touch", SIN, Some(COS)), ("fill", TAN, None)] {
        let (of, first) = functions.iter().zip(&first).find(|(of, _)| of.signature.starts_with(name)).unwrap();
        let stub = optimize(specialize(&without(&words, Some((of, *first)), &NAMES).unwrap(), &[]));
        let module = Module::parse(&stub).unwrap();
        let has = |number: u32| module.code().any(|i| i.op == Op::ExtInst && module[i][4] == number);
        assert!(has(operation), "{name}");
        // Members that the function leaves alone are known.
        assert!(other.is_none_or(|other| !has(other)), "{name}");
    }
}
