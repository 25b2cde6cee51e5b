use std::collections::BTreeSet;

use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::{optimize, specialize, validate};

/// The functions that are called.
const TOLD: &str = "void told(const in uint place, const in uvec4 bits) { last = place + bits.x; }\n\
    uint told_enter(const in uint place, const in uint light) { uint caller = last; last = place + light; return caller; }\n\
    void told_leave(const in uint caller) { last = caller; }\n";

/// A stage with these functions, of which `main` calls `f`; compiled with lines. Also the number of their first line.
fn compiled(body: &str) -> (Vec<u32>, u32) {
    let text = format!(
        "#version 460\nlayout(location = 0) in vec3 n;\nlayout(location = 0) out vec4 color;\n\
         layout(set = 1, binding = 0) uniform sampler2D image;\nlayout(constant_id = 7) const uint KIND = 0u;\n\
         struct S {{ float a; vec2 b, c[2]; mat2 d; int e; }};\nuint last;\n\
         {TOLD}{body}\nvoid main() {{\n color = vec4(float(f(n.x))); told(0u, uvec4(0u)); told_leave(told_enter(0u, 0u)); }}\n"
    );
    let first = text.lines().position(|line| line.starts_with(body.lines().next().unwrap())).unwrap() as u32;
    let source = Source::memory([("m.frag", text.as_str())]);
    let words = Compiler::new().unwrap().compile_with_lines(&Snapshot::new(&source), &"m.frag".into());
    (words.unwrap(), first + 1)
}

/// The lines of places in functions, with their purposes.
fn places(body: &str, logged: Logged) -> Vec<String> {
    let (words, first) = compiled(body);
    let Traced { words, places, points } = trace(&words, "told", logged, None).unwrap();
    for words in [words.clone(), specialize(&words, &[(7, 1)]), optimize(words)] {
        assert_eq!(validate(&words), Ok(()), "{body}");
    }
    assert!(points.iter().all(|point| point.place < places.len()));
    let own = places.iter().filter(|place| place.line < first + body.lines().count() as u32 && place.line > 0);
    own.map(|place| format!("{} {:?}", place.line + 1 - first, place.purpose)).collect()
}

#[test]
fn floats_are_logged_where_they_are_computed() {
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
        ("float f(float x) {\n while (x * x < 1.0) x = n.y;\n return x; }", vec![of(2, "Use"), of(2, "Input(\"n\")")]),
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
        assert_eq!(places(body, Logged::Floats), expected, "{body}");
    }
}

#[test]
fn a_module_without_the_function_is_not_traced() {
    let source = Source::memory([("m.frag", "#version 460\nvoid main() {}\n")]);
    let words = Compiler::new().unwrap().compile_with_lines(&Snapshot::new(&source), &"m.frag".into()).unwrap();
    assert!([Logged::Floats, Logged::Statements].iter().all(|logged| trace(&words, "told", *logged, None).is_none()));
    assert!(trace(&[1, 2], "told", Logged::Statements, None).is_none());
}

#[test]
fn statements_are_logged_with_what_they_do() {
    for (body, expected) in [
        (
            "float f(float x) {\n int i = 3; ++i;\n return x; }",
            &["2 Enter(\"f\", None)", "2 Argument(\"x\")", "2 Store(\"i\")", "2 Store(\"i\")", "3 Return"][..],
        ),
        (
            "void g(out float y, inout S s, const vec2 z) {\n y = z.x;\n s.b.y = y;\n s.c[1] = z; }\n\
             float f(float x) {\n S s; float y;\n g(y, s, vec2(x));\n return y; }",
            // The `out` argument has no value yet, and those of structs are left out.
            &[
                "2 Enter(\"g\", None)",
                "2 Argument(\"z\")",
                "2 Store(\"y\")",
                "3 Store(\"s.b.y\")",
                "4 Store(\"s.c[1]\")",
                "7 Enter(\"f\", None)",
                "7 Argument(\"x\")",
                "7 Store(\"y\")",
                "7 Store(\"s\")",
                "8 Return",
            ],
        ),
        (
            "float f(float x) {\n for (int i = 0; i < 3; ++i)\n  x *= 2.0;\n if (x > 1.0)\n  discard;\n switch (int(x)) {\n \
             case 1:\n  return 2.0;\n }\n return x; }",
            &[
                "2 Enter(\"f\", None)",
                "2 Argument(\"x\")",
                "2 Store(\"i\")",
                "2 Condition",
                "3 Store(\"x\")",
                "2 Store(\"i\")",
                "4 Condition",
                "5 Discard",
                "6 Condition",
                "8 Return",
                "10 Return",
            ],
        ),
        (
            "void g(inout float x) {\n if (x > 1.0)\n  return;\n x = 2.0;\n if (x > 3.0) {\n  x = 1.0;\n  return;\n }\n x += 1.0; }\n\
             float f(float x) {\n g(x);\n return x; }",
            &[
                "2 Enter(\"g\", None)",
                "2 Argument(\"x\")",
                "2 Condition",
                "3 Leave",
                "4 Store(\"x\")",
                "5 Condition",
                "6 Store(\"x\")",
                "7 Leave",
                "9 Store(\"x\")",
                "11 Enter(\"f\", None)",
                "11 Argument(\"x\")",
                "11 Store(\"x\")",
                "12 Return",
            ],
        ),
        // The compiler gives constants no line: that of their branch counts.
        (
            "float f(float x) {\n const bool ON = true;\n x += 1.0;\n if (ON)\n  x += 2.0;\n if (KIND == 1u) {\n  if (ON)\n   x += 3.0;\n \
             }\n switch (KIND) {\n case 1u:\n  x = 2.0;\n }\n return x; }",
            &[
                "3 Enter(\"f\", None)",
                "3 Argument(\"x\")",
                "3 Store(\"x\")",
                "5 Constant { between: 0 }",
                "5 Store(\"x\")",
                "8 Constant { between: 0 }",
                "8 Constant { between: 1 }",
                "8 Store(\"x\")",
                "12 Constant { between: 0 }",
                "12 Store(\"x\")",
                "14 Return",
            ],
        ),
        // Specialization takes branches by it.
        ("bool f(float x) {\n return KIND == 1u; }", &[]),
    ] {
        let mut found = places(body, Logged::Statements);
        found.sort_by_key(|place| (place.split(' ').next().and_then(|line| line.parse::<u32>().ok()), place.clone()));
        let mut expected: Vec<String> = expected.iter().map(|place| (*place).to_owned()).collect();
        expected
            .sort_by_key(|place| (place.split(' ').next().and_then(|line| line.parse::<u32>().ok()), place.clone()));
        assert_eq!(found, expected, "{body}");
    }
}

#[test]
fn copies_of_log_points_are_counted_as_a_driver_inlines_them() {
    let body = "float g(float x) {\n float y = x * 2.0;\n return y; }\n\
        float h(float x) {\n return g(x) + g(-x); }\nfloat unused(float x) {\n return x; }\n\
        float f(float x) {\n if (KIND == 1u) return g(x);\n return h(x) + g(0.5); }";
    let (words, _) = compiled(body);
    let Traced { words, places, points } = trace(&words, "told", Logged::Statements, None).unwrap();
    let count = |kind: u32| instances(&specialize(&words, &[(7, kind)]), "told", &places, &points)["m.frag"];
    // g begins, gets x, stores y and returns: 4. h begins, gets x and returns: 3. f begins, gets x, decides and returns.
    assert_eq!([count(0), count(1)], [4 + 3 + 3 * 4, 4 + 4]);
    // Only a call leads to another file.
    let only = BTreeSet::from(["other.glsl".to_owned()]);
    let other = trace(&compiled(body).0, "told", Logged::Statements, Some(&only)).unwrap();
    assert_eq!(other.points, []);
}

/// Functions that read lights by a number, by a copy of it or by way of others; suns; and functions whose numbers are of other things.
#[test]
fn functions_tell_the_light_that_they_are_about() {
    let text = ["#version 460\n#extension GL_EXT_scalar_block_layout : require\nlayout(location = 0) out vec4 color;\n\
        layout(set = 0, binding = 0, scalar) uniform Constants { uint other; uint light_count; uint sun; } frame;\n\
        struct Light { vec4 position; vec3 intensity; };\n\
        layout(set = 0, binding = 21, scalar) readonly buffer Many { Light lights[]; };\n\
        layout(set = 0, binding = 1, scalar) uniform Few { Light few[8]; };\n\
        uint last;\n", TOLD, "Light given(uint i) { if (frame.other == 0u) return few[i]; return lights[i]; }\n\
        vec3 constant(const vec3 n, const uint number) { return n * lights[number].intensity; }\n\
        vec3 copied(float x, int at) { uint i = uint(at); return given(i).intensity * x; }\n\
        vec3 of_sun(uint i) { return given(frame.light_count + i).intensity; }\n\
        vec3 all_suns(uint k) { return of_sun(k); }\n\
        vec3 shifted(uint i) { return given(frame.other + i).intensity; }\n\
        vec3 plain(uint i) { return vec3(float(i)); }\n\
        void main() {\n color = vec4(constant(vec3(1.0), 1u) + copied(1.0, 2) + all_suns(0u) + shifted(1u) + plain(3u), 1.0);\n \
        told(0u, uvec4(0u)); told_leave(told_enter(0u, 0u)); }\n"].concat();
    let source = Source::memory([("m.frag", text.as_str())]);
    let words = Compiler::new().unwrap().compile_with_lines(&Snapshot::new(&source), &"m.frag".into()).unwrap();
    let Traced { words, places, points } = trace(&words, "told", Logged::Statements, None).unwrap();
    assert_eq!(validate(&words), Ok(()));
    let entered = points.iter().filter_map(|point| match &places[point.place].purpose {
        Purpose::Enter(name, list) => Some((name.as_str(), *list, point.kind, point.count)),
        _ => None,
    });
    let (none, uint) = (NumberKind::Bool, NumberKind::Uint);
    let [lights, suns] = [LightList::Lights, LightList::Suns].map(Some);
    let mut entered: Vec<_> = entered.collect();
    entered.sort_by_key(|(name, ..)| *name);
    let expected = [
        ("all_suns", suns, uint, 1),
        ("constant", lights, uint, 1),
        ("copied", lights, NumberKind::Int, 1),
        ("given", lights, uint, 1),
        ("of_sun", suns, uint, 1),
        ("plain", None, none, 0),
        ("shifted", None, none, 0),
    ];
    assert_eq!(entered, expected);
}
