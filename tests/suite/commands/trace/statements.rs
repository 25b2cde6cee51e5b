//! Values of statements of many kinds.

use serde_json::{Value, json};

use super::{done, not_reached, proven};
use crate::support::line_of;

const LIBRARY: &str = "struct Pair { float a; vec2 b; };\n#define TWICE(x) ((x) * 2.0)\n\
    float pick(float x) { return x + 1.0; }\nint pick(int x) { return x - 1; }\n\
    void split(float x, out float whole, inout vec2 rest) { whole = floor(x); rest.y += x - whole; }\n\
    const bool ON = true;\nconst bool OPAQUE = (FEATURES & FEATURE_TRANSMISSION) == 0u;\n\
    bool early(int n) {\n    if (n < 0)\n        return true;\n    return false;\n}";

const BODY: &str = "    float zero = min(s.roughness, 0.0);\n\
    \x20   float three = zero + 3.0; // a comment\n\
    \x20   float six = TWICE(three);\n\
    \x20   vec3 color = vec3(three, six, 1.0);\n\
    \x20   color.y = 0.5;\n\
    \x20   float list[3] = float[](1.0, three, 2.0);\n\
    \x20   int sum = int(zero);\n\
    \x20   for (int i = 0; i < 3; ++i) sum += i;\n\
    \x20   list[sum - 2] = 9.0;\n\
    \x20   Pair pair = Pair(six, vec2(1.0, three));\n\
    \x20   pair.b.x = pick(three);\n\
    \x20   int less = pick(sum);\n\
    \x20   float whole; vec2 rest = vec2(1.0);\n\
    \x20   split(three + 0.25, whole, rest);\n\
    \x20   bool is_early = early(sum), is_late = !is_early;\n\
    \x20   { float three = 30.0 + zero; six = three; }\n\
    \x20   mat2 m = mat2(1.0, three, six, 4.0);\n\
    \x20   uint bits = uint(three) << 2u;\n\
    \x20   float one = sum == 3 ? three : six;\n\
    \x20   switch (sum) {\n\
    \x20   case 3: one += 1.0;\n\
    \x20   case 4: one += 10.0; break;\n\
    \x20   default: one = 0.0;\n\
    \x20   }\n\
    \x20   if (sum > 3 || three > 2.0)\n\
    \x20       one += 0.5;\n\
    \x20   if (ON)\n\
    \x20       one += 1.0;\n\
    \x20   if (!OPAQUE)\n\
    \x20       one += 2.0;\n\
    \x20   if (OPAQUE) {\n\
    \x20       one += 4.0;\n\
    \x20   }\n\
    \x20   if (is_late && s.roughness < 0.0) s.roughness = one + whole + rest.x + m[0].x + float(bits + less) + pair.a + list[0] + color.x;";

/// What must not be guessed: macros, conditions, loops, components, arrays, structs, `out` arguments, overloads, shadowed names.
#[test]
fn each_statement_has_its_own_value() {
    let directory = tempfile::tempdir().unwrap();
    let (text, found) = proven(directory.path(), LIBRARY, BODY);
    let store = |name: &str, values: Vec<Value>| ("store".to_owned(), name.to_owned(), values);
    let condition = |values: Vec<Value>| ("condition".to_owned(), String::new(), values);
    for (part, expected) in [
        ("float three = zero", vec![store("three", vec![json!(3.0)])]),
        ("float six = ", vec![store("six", vec![json!(6.0)])]),
        ("vec3 color = ", vec![store("color", vec![json!([3.0, 6.0, 1.0])])]),
        ("color.y = ", vec![store("color.y", vec![json!(0.5)])]),
        (
            "float list[3]",
            vec![
                store("list[0]", vec![json!(1.0)]),
                store("list[1]", vec![json!(3.0)]),
                store("list[2]", vec![json!(2.0)]),
            ],
        ),
        (
            "for (int i = 0",
            vec![
                store("i", vec![json!(0), json!(1), json!(2), json!(3)]),
                condition(vec![json!(true), json!(true), json!(true), json!(false)]),
                store("sum", vec![json!(0), json!(1), json!(3)]),
            ],
        ),
        ("list[sum - 2] = ", vec![store("list[1]", vec![json!(9.0)])]),
        ("Pair pair = ", vec![store("pair.a", vec![json!(6.0)]), store("pair.b", vec![json!([1.0, 3.0])])]),
        ("pair.b.x = ", vec![store("pair.b.x", vec![json!(4.0)])]),
        ("int less = ", vec![store("less", vec![json!(2)])]),
        ("{ float three = 30.0", vec![store("three", vec![json!(30.0)]), store("six", vec![json!(30.0)])]),
        ("mat2 m = ", vec![store("m[0]", vec![json!([1.0, 3.0])]), store("m[1]", vec![json!([30.0, 4.0])])]),
        ("uint bits = ", vec![store("bits", vec![json!(12)])]),
        ("case 3: ", vec![store("one", vec![json!(4.0)])]),
        ("case 4: ", vec![store("one", vec![json!(14.0)])]),
        ("default: ", vec![]),
        ("if (sum > 3 || three", vec![condition(vec![json!(true)])]),
        ("    if (ON)", vec![condition(vec![json!(true)])]),
        ("    if (!OPAQUE)", vec![condition(vec![json!(false)])]),
        ("    if (OPAQUE) {", vec![condition(vec![json!(true)])]),
        ("const bool OPAQUE =", vec![]),
        ("    if (n < 0)", vec![condition(vec![json!(false)])]),
        ("        return true;", vec![]),
        ("    return false;", vec![("return".to_owned(), String::new(), vec![json!(false)])]),
    ] {
        assert_eq!(done(&found, "user.glsl", line_of(&text, part)), expected, "{part}");
    }
    let missed = not_reached(&found, "user.glsl");
    let lines = ["        return true;", "default: ", "one += 2.0;"].map(|part| u64::from(line_of(&text, part)));
    assert!(lines.iter().all(|line| missed.contains(line)), "{missed:?}");
    check_functions(&found, &text);
}

/// The arguments stand at the function, and what it changes at the call, too.
fn check_functions(found: &Value, text: &str) {
    let store = |name: &str, value: Value| ("store".to_owned(), name.to_owned(), vec![value]);
    let of = |part: &str| done(found, "user.glsl", line_of(text, part));
    let split = of("void split(");
    assert!(split.contains(&("argument".to_owned(), "x".to_owned(), vec![json!(3.25)])), "{split:?}");
    assert!(split.contains(&store("whole", json!(3.0))), "{split:?}");
    assert!(split.contains(&store("rest.y", json!(1.25))), "{split:?}");
    let call = of("split(three + 0.25");
    assert!(call.contains(&store("rest", json!([1.0, 1.25]))), "{call:?}");
    let overloads = [of("float pick("), of("int pick(")];
    assert_eq!(overloads[0].last(), Some(&("return".to_owned(), String::new(), vec![json!(4.0)])));
    assert_eq!(overloads[1].last(), Some(&("return".to_owned(), String::new(), vec![json!(2)])));
    // An `out` parameter has no value when the function begins.
    assert!(!split.iter().any(|(act, name, _)| act == "argument" && name == "whole"), "{split:?}");
}
