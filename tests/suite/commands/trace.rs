//! `specula trace`: the values of statements at a pixel.

use std::path::Path;

use serde_json::{Value, json};

use crate::support::process::{Finished, run};
use crate::support::{glb, line_of};

const VIEW: [&str; 5] = ["--size", "96x64", "--env", "none", "--validate"];

fn trace(directory: &Path, args: &[&str]) -> Finished {
    run(directory, &[&["trace"], args, &VIEW].concat())
}

/// What the JSON of a trace has for a line: the act, the name, and the values that are kept first.
fn done(trace: &Value, file: &str, line: u32) -> Vec<(String, String, Vec<Value>)> {
    let lines = trace["lines"].as_array().unwrap().iter();
    let here = lines.filter(|of| of["file"] == file && of["line"] == line);
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let values = |done: &Value| done["first"].as_array().unwrap().iter().map(|once| once["value"].clone()).collect();
    here.flat_map(|of| of["done"].as_array().unwrap())
        .map(|done| (text(&done["act"]), text(&done["name"]), values(done)))
        .collect()
}

/// A tree whose `user_surface` has these lines, and the text of its file.
fn tree(directory: &Path, library: &str, body: &str) -> String {
    let tree = directory.join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    let shipped = std::fs::read_to_string(tree.join("user.glsl")).unwrap();
    let text = shipped.replace("void user_surface(", &format!("{library}\nvoid user_surface("));
    let text = text.replace("    s.roughness = saturate", &format!("{body}\n    s.roughness = saturate"));
    std::fs::write(tree.join("user.glsl"), &text).unwrap();
    text
}

#[test]
fn the_picture_is_traced_and_its_color_is_proven() {
    let directory = tempfile::tempdir().unwrap();
    let at = ["--at", "50,30"];
    let found = trace(directory.path(), &[&at[..], &["--json"]].concat()).expect(0, &[]).json();
    assert_eq!((&found["proof"]["equal"], &found["fragments"][0]["visible"]), (&json!(true), &json!(true)), "{found}");
    // The normal that the stage computes is that of the mode.
    let probe =
        run(directory.path(), &[&["probe", "--mode", "f", "--mode", "final", "--json"], &at[..], &VIEW].concat())
            .json();
    let color: Vec<f64> = found["proof"]["traced"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
    let shown: Vec<f64> = probe["modes"]["final"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
    assert!(color.iter().zip(&shown).all(|(a, b)| (a - b).abs() <= 1e-5 * b.abs().max(1e-3)), "{color:?} {shown:?}");
    // Three lights are added: the calls tell them apart.
    let files: Vec<&str> =
        found["lines"].as_array().unwrap().iter().map(|line| line["file"].as_str().unwrap()).collect();
    assert!(files.contains(&"brdf/ndf.glsl") && files.contains(&"pbr.frag"), "{files:?}");
    let calls = found.to_string();
    assert!(["[2] > ", "[3] > "].iter().all(|call| calls.contains(call)), "no calls of the second and third light");
    let mode = trace(directory.path(), &[&at[..], &["--mode", "d", "--json"]].concat()).expect(0, &[]).json();
    assert_eq!(mode["proof"]["equal"], json!(true), "{}", mode["proof"]);
    let text = trace(directory.path(), &at);
    text.expect(0, &[]);
    assert!(text.stdout.contains("pixel 50 30, fragment 0 of 1: equal to the picture\n"), "{}", text.stdout);
    assert!(text.stdout.contains("\nbrdf/ndf.glsl\n"), "{}", text.stdout);
}

/// What must not be guessed: macros, conditions, loops, components, arrays, structs, `out` arguments, overloads, shadowed names.
#[test]
fn each_statement_has_its_own_value() {
    let directory = tempfile::tempdir().unwrap();
    let library = "struct Pair { float a; vec2 b; };\n#define TWICE(x) ((x) * 2.0)\n\
        float pick(float x) { return x + 1.0; }\nint pick(int x) { return x - 1; }\n\
        void split(float x, out float whole, inout vec2 rest) { whole = floor(x); rest.y += x - whole; }\n\
        bool early(int n) {\n    if (n < 0)\n        return true;\n    return false;\n}";
    let body = "    float zero = min(s.roughness, 0.0);\n\
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
        \x20   if (is_late && s.roughness < 0.0) s.roughness = one + whole + rest.x + m[0].x + float(bits + less) + pair.a + list[0] + color.x;";
    let text = tree(directory.path(), library, body);
    let found = trace(directory.path(), &["--shaders", "tree", "--at", "50,30", "--json"]).expect(0, &[]).json();
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
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
        ("list[sum - 2] = ", vec![store("list[ ]", vec![json!(9.0)])]),
        ("Pair pair = ", vec![store("pair.a", vec![json!(6.0)]), store("pair.b", vec![json!([1.0, 3.0])])]),
        ("pair.b.x = ", vec![store("pair.b.x", vec![json!(4.0)])]),
        ("int less = ", vec![store("less", vec![json!(2)])]),
        ("{ float three = 30.0", vec![store("three", vec![json!(30.0)]), store("six", vec![json!(30.0)])]),
        ("mat2 m = ", vec![store("m[0]", vec![json!([1.0, 3.0])]), store("m[1]", vec![json!([30.0, 4.0])])]),
        ("uint bits = ", vec![store("bits", vec![json!(12)])]),
        ("case 3: ", vec![store("one", vec![json!(4.0)])]),
        ("case 4: ", vec![store("one", vec![json!(14.0)])]),
        ("default: ", vec![]),
        ("    if (n < 0)", vec![condition(vec![json!(false)])]),
        ("        return true;", vec![]),
        ("    return false;", vec![("return".to_owned(), String::new(), vec![json!(false)])]),
    ] {
        assert_eq!(done(&found, "user.glsl", line_of(&text, part)), expected, "{part}");
    }
    // The arguments stand at the function, and what it changes at the call, too.
    let of = |part: &str| done(&found, "user.glsl", line_of(&text, part));
    let split = of("void split(");
    assert!(split.contains(&("argument".to_owned(), "x".to_owned(), vec![json!(3.25)])), "{split:?}");
    assert!(split.contains(&store("whole", vec![json!(3.0)])), "{split:?}");
    assert!(split.contains(&store("rest.y", vec![json!(1.25)])), "{split:?}");
    let call = of("split(three + 0.25");
    assert!(call.contains(&store("rest", vec![json!([1.0, 1.25])])), "{call:?}");
    let overloads = [of("float pick("), of("int pick(")];
    assert_eq!(overloads[0].last(), Some(&("return".to_owned(), String::new(), vec![json!(4.0)])));
    assert_eq!(overloads[1].last(), Some(&("return".to_owned(), String::new(), vec![json!(2)])));
}

#[test]
fn assertions_are_exit_codes() {
    let directory = tempfile::tempdir().unwrap();
    let text =
        tree(directory.path(), "", "    float half_rough = s.roughness * 0.5;\n    s.roughness += 0.0 * half_rough;");
    let place = format!("user.glsl:{}", line_of(&text, "float half_rough"));
    let args = ["--shaders", "tree", "--at", "50,30", "--set", "materials.#0.roughness=0.8"];
    let with = |assertions: &[&str]| {
        let all: Vec<String> =
            assertions.iter().flat_map(|a| ["--assert".to_owned(), format!("{place} {a}")]).collect();
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        trace(directory.path(), &[&args[..], &all].concat())
    };
    with(&["half_rough > 0", "half_rough <= 1"]).expect(0, &[]);
    with(&["half_rough > 0", "half_rough > 5"]).expect(1, &["half_rough > 5", "failed for 1 of 1 values"]);
    with(&["nothing > 0"]).expect(1, &["no value of `nothing`", "half_rough ="]);
    trace(directory.path(), &["--at", "50,30", "--assert", "a b"]).expect(2, &["expected FILE:LINE NAME > NUMBER"]);
    trace(directory.path(), &["--at", "96,0"]).expect(2, &["--at 96,0 is outside of the picture"]);
    trace(directory.path(), &["--at", "50,30", "--mode", "monte-carlo"]).expect(2, &[]);
    let line = trace(directory.path(), &[&args[..], &["--line", &place]].concat());
    line.expect(0, &[]);
    assert_eq!(line.stdout.lines().filter(|line| line.contains("half_rough")).count(), 1, "{}", line.stdout);
    trace(directory.path(), &[&args[..], &["--line", "common/keys.glsl"]].concat())
        .expect(1, &["no statement of common/keys.glsl"]);
}

/// A quad behind another, a mask with a hole, and the background.
#[test]
fn each_fragment_of_a_pixel_is_traced() {
    let directory = tempfile::tempdir().unwrap();
    let material = |name: &str, color: [f32; 4], mode: &str| json!({ "name": name, "alphaMode": mode, "pbrMetallicRoughness": { "baseColorFactor": color } });
    let at = |depth: f32| glb::cuboid([-1.0, -1.0, depth - 0.1], [1.0, 1.0, depth], true);
    let write = |front: Value| {
        let scene = glb::scene(&[(at(0.0), material("back", [1.0, 0.0, 0.0, 1.0], "OPAQUE")), (at(1.0), front)]);
        std::fs::write(directory.path().join("two.glb"), scene).unwrap();
        let view = ["two.glb", "--at", "48,32", "--eye", "0,0,6", "--target", "0,0,0", "--json"];
        trace(directory.path(), &view).expect(0, &[]).json()
    };
    let found = write(material("front", [0.0, 1.0, 0.0, 1.0], "OPAQUE"));
    let visible = |found: &Value| found["fragment"].as_u64().unwrap() as usize;
    let depth = |found: &Value, at: usize| found["fragments"][at]["depth"].as_f64().unwrap();
    let fragments = found["fragments"].as_array().unwrap();
    assert!(fragments.iter().enumerate().all(|(at, _)| depth(&found, at) <= depth(&found, visible(&found))), "{found}");
    assert_eq!(found["proof"]["equal"], json!(true));
    // The mask lets the quad behind through.
    let found = write(material("front", [0.0, 1.0, 0.0, 0.2], "MASK"));
    let fragments = found["fragments"].as_array().unwrap();
    assert_eq!(fragments.len(), 2, "{found}");
    let discarded = fragments.iter().position(|fragment| fragment["discarded"] == true).unwrap();
    assert!(visible(&found) == 1 - discarded && found["proof"]["equal"] == true, "{found}");
    let view =
        ["two.glb", "--at", "48,32", "--eye", "0,0,6", "--target", "0,0,0", "--fragment", &discarded.to_string()];
    let text = trace(directory.path(), &view);
    text.expect(0, &[]);
    assert!(text.stdout.contains("it was discarded") && text.stdout.contains("discard"), "{}", text.stdout);
    let empty = trace(directory.path(), &["two.glb", "--at", "1,1", "--eye", "0,0,6", "--target", "0,0,0"]);
    empty.expect(0, &[]);
    assert!(empty.stdout.contains("no fragment of the model is seen there"), "{}", empty.stdout);
}
