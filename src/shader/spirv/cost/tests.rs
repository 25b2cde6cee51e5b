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
    void author() {
        float y, z = 2.0;
        mat2 m = both(at.xy, y, z);
        Pair p = pair(at.z);
        stop(at.w);
        float all = m[0].x + y + z + p.a + float(p.b.x) + float(p.c) + random() + calls_log(at.x);
        if (is_second()) all += never(all);
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
    assert_eq!(
        (both.signature.as_str(), both.numbers, both.outs.as_slice()),
        ("both(vec2, float, float)", 5, &[1][..])
    );
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
