//! `specula check MODEL`: assertions that fail, and operations whose result GLSL leaves open, with their lines, operands and places.

mod stages;

use std::path::Path;

use serde_json::{Value, json};
use specula::learn::exercises;

use crate::support::process::{Finished, finish, run, specula};
use crate::support::{
    Session, Tree, assert_same, failed, glb, gpu, is_long, line_of, model, open_image, ready, renderer, settings,
};

const VIEW: [&str; 5] = ["--size", "48x32", "--env", "none", "--validate"];
/// `zero`, `izero` and `uzero` are 0, which the compiler does not know. Each line breaks one rule, and has its name and operands.
const BROKEN: [(&str, &str, &[f64]); 36] = [
    ("x += 1.0 / zero;", "division-by-zero", &[1.0, 0.0]),
    ("x += (vec3(3.0) / vec3(1.0, zero, 2.0)).x;", "division-by-zero", &[3.0, 0.0]),
    ("x += float(7 / izero);", "division-by-zero", &[7.0, 0.0]),
    ("x += float(8u % uzero);", "division-by-zero", &[8.0, 0.0]),
    ("x += mod(5.0, zero);", "division-by-zero", &[5.0, 0.0]),
    ("x += pow(zero - 0.25, 2.0);", "pow", &[-0.25, 2.0]),
    ("x += pow(zero, zero);", "pow", &[0.0, 0.0]),
    ("x += pow(vec2(2.0, zero - 2.0), vec2(3.0)).x;", "pow", &[-2.0, 3.0]),
    ("x += normalize(vec2(zero)).x;", "normalize", &[0.0, 0.0]),
    ("x += sqrt(zero - 4.0);", "sqrt", &[-4.0]),
    ("x += inversesqrt(zero);", "inversesqrt", &[0.0]),
    ("x += log(zero - 1.0);", "log", &[-1.0]),
    ("x += log2(zero);", "log", &[0.0]),
    ("x += asin(zero + 1.5);", "asin-acos", &[1.5]),
    ("x += acos(zero - 2.0);", "asin-acos", &[-2.0]),
    ("x += atan(zero, zero);", "atan", &[0.0, 0.0]),
    ("x += acosh(zero + 0.5);", "acosh", &[0.5]),
    ("x += atanh(zero - 1.0);", "atanh", &[-1.0]),
    ("x += clamp(0.5, zero + 1.0, zero);", "clamp", &[1.0, 0.0]),
    ("x += float(clamp(5, izero + 3, izero));", "clamp", &[3.0, 0.0]),
    ("x += float(clamp(5u, uzero + 3u, uzero));", "clamp", &[3.0, 0.0]),
    ("x += smoothstep(zero + 2.0, zero + 1.0, 0.5);", "smoothstep", &[2.0, 1.0]),
    ("x += inverse(mat2(zero))[0][0];", "inverse", &[0.0]),
    ("x += numbers[izero + 9];", "index", &[9.0]),
    ("x += vec3(1.0)[uzero + 3u];", "index", &[3.0]),
    ("x += float(int(zero + 3e9));", "float-to-integer", &[3e9]),
    ("x += float(uint(zero - 2.0));", "float-to-integer", &[-2.0]),
    ("x += float(1 << (izero + 40));", "shift", &[1.0, 40.0]),
    ("x += float(bitfieldExtract(izero, 30, izero + 4));", "bit-field", &[30.0, 4.0]),
    ("float a; if (zero > 0.5) a = 1.0; x += a;", "unset", &[]),
    ("vec3 b; b.xy = vec2(zero); x += b.z;", "unset", &[]),
    ("float c[3]; c[0] = zero; c[1] = zero; x += c[2];", "unset", &[]),
    ("mat2 d; d[0] = vec2(zero); x += d[1].x;", "unset", &[]),
    ("float e; for (int i = 0; i < izero; i++) e = 1.0; x += e;", "unset", &[]),
    ("float k; maybe(zero, k); x += k;", "unset", &[]),
    ("float g; if (zero > 0.5) g = zero; else if (zero < 0.5) x += g;", "unset", &[]),
];
/// None of these is undefined, as the part that would be is not evaluated or not selected.
const DEFINED: [&str; 17] = [
    "if (zero > 0.5) x += 1.0 / zero;",
    "x += zero > 0.5 ? 1.0 / zero : 0.0;",
    "x += zero > 0.5 ? sqrt(zero - 1.0) : zero;",
    "float root = sqrt(max(zero, 0.0)); x += root;",
    "x += pow(zero, 2.0) + pow(zero + 2.0, -1.0);",
    "x += 2.0 / (zero + 1.0) + float(3 / (izero + 1)) + asin(zero + 1.0);",
    "x += clamp(0.5, zero, zero) + smoothstep(zero, zero + 1.0, 0.5);",
    "x += numbers[izero + 3] + float(1 << (izero + 31)) + float(int(zero - 2147483648.0));",
    "x += normalize(vec3(zero, zero, 1e-3)).z + log(zero + 1e-30) + atan(zero, zero - 1.0);",
    "for (int i = 0; i < 4; i++) x += numbers[i];",
    "float a; if (zero > 0.5) a = 1.0; else a = zero; x += a;",
    "float b; if (zero < 0.5) b = zero; if (zero < 0.5) x += b;",
    "vec3 c; c.xy = vec2(zero); c.z = zero; x += c.z + c.x;",
    "vec4 d; d.xw = vec2(zero); x += d.x + d.w;",
    "float e[3]; for (int i = 0; i < 3; i++) e[i] = zero; x += e[2];",
    "float k; maybe(zero + 1.0, k); x += k; float g; maybe(zero, g);",
    "float h; switch (izero) { case 1: h = 1.0; break; default: h = zero; } x += h;",
];

/// Sets its result on one of two paths.
const MAYBE: &str = "void maybe(float on, out float y) { if (on > 0.5) y = on; }";

/// A tree whose `user_surface` has these lines, and the line of the first one.
fn tree(lines: &[&str]) -> (Tree, u32) {
    let tree = Tree::new();
    let shipped = tree.read("user.glsl");
    let start = "    float zero = min(abs(s.metallic), 0.0);\n    int izero = int(zero);\n    uint uzero = uint(zero);\n    \
        float numbers[4] = float[](zero, zero, zero, zero);\n    float x = zero;\n";
    let body = format!("{start}    {}\n    s.occlusion += min(abs(x), 0.0);\n", lines.join("\n    "));
    let text = shipped.replace("    s.roughness = saturate", &format!("{body}    s.roughness = saturate"));
    assert_ne!(text, shipped);
    let text = text.replace("void user_surface(", &format!("{MAYBE}\nvoid user_surface("));
    tree.write("user.glsl", &text);
    let at = text.lines().position(|line| line.trim() == lines[0]).unwrap();
    (tree, at as u32 + 1)
}

fn check(tree: &Tree, args: &[&str]) -> Finished {
    let root = tree.root();
    run(Path::new("."), &[&["check", "--undefined", "--shaders", root.to_str().unwrap()], args, &VIEW].concat())
}

#[test]
fn each_rule_is_found_at_its_line_with_its_operands() {
    let (tree, first) = tree(&BROKEN.map(|(line, ..)| line));
    let checked = check(&tree, &["sphere-grid", "--json"]);
    let found: Value = serde_json::from_str(&checked.stdout).unwrap_or_else(|_| panic!("{}", checked.stderr));
    checked.expect(
        1,
        &["36 errors", "division by 0", "a variable that is read before it is set: k first at", "user.glsl"],
    );
    let found = found.as_array().unwrap();
    for (line, (code, rule, operands)) in (first..).zip(BROKEN) {
        let here: Vec<&Value> = found.iter().filter(|of| of["file"] == "user.glsl" && of["line"] == line).collect();
        assert_eq!(here.len(), 1, "{code}: {here:?}");
        let numbers = here[0]["operands"].as_array().unwrap().iter().flat_map(|operand| match operand.as_array() {
            Some(vector) => vector.clone(),
            None => vec![operand.clone()],
        });
        let numbers: Vec<f64> = numbers.map(|number| number.as_f64().unwrap()).collect();
        assert_eq!((here[0]["rule"].as_str().unwrap(), &numbers[..]), (rule, operands), "{code}: {}", here[0]);
        assert!(here[0]["count"].as_u64().unwrap() > 50, "{code}: {}", here[0]);
        assert_eq!((&here[0]["stage"], &here[0]["modes"]), (&json!("pbr.frag"), &json!(["final"])), "{code}");
    }
    assert_eq!(found.len(), BROKEN.len(), "{found:#?}");
}

#[test]
fn what_is_not_evaluated_is_no_fault() {
    let (tree, _) = tree(&DEFINED);
    let checked = check(&tree, &["sphere-grid"]);
    checked.expect(0, &[]);
    assert!(checked.stdout.contains("none failed or was undefined"), "{}", checked.stdout);
}

#[test]
fn a_fault_of_some_pixels_has_their_number_and_the_first() {
    let condition = "if (gl_FragCoord.x > 10.0 && gl_FragCoord.x < 24.0 && gl_FragCoord.y < 16.0) x += 1.0 / zero;";
    let (tree, line) = tree(&[condition]);
    // It covers the whole picture.
    let quad = tree.beside("quad.glb");
    std::fs::write(&quad, glb::model(&glb::quad(9.0), &glb::gray())).unwrap();
    let checked = check(&tree, &["--eye", "0,0,2", "--target", "0,0,0", "--json", quad.to_str().unwrap()]);
    checked.expect(1, &["1 error"]);
    let found: Value = serde_json::from_str(&checked.stdout).unwrap();
    let of = &found[0];
    assert_eq!((&of["line"], &of["first"], &of["count"]), (&json!(line), &json!([10, 0]), &json!(14 * 16)), "{of}");
}

/// Derivatives that only some pixels of a quad compute, and those that all or no pixels of it do.
const APART: [&str; 3] = [
    "if (fract(gl_FragCoord.x * 0.5) < 0.5) x += dFdx(zero + gl_FragCoord.y);",
    "for (float i = 0.0; i < mod(gl_FragCoord.y - 0.5, 2.0); i++) x += fwidth(i + gl_FragCoord.x);",
    "if (gl_FragCoord.x > 20.0 && gl_FragCoord.x < 23.0) x += dFdy(gl_FragCoord.x);",
];
const TOGETHER: [&str; 5] = [
    "if (zero < 0.5) x += dFdx(gl_FragCoord.y);",
    "for (int j = 0; j < 3; j++) x += fwidth(gl_FragCoord.x);",
    "if (gl_FragCoord.x < 16.0) x += dFdy(gl_FragCoord.x);",
    "if (fract(gl_FragCoord.x * 0.5) < 0.5) x += zero; x += dFdx(x);",
    "if (gl_FragCoord.x > 30.0 && fract(gl_FragCoord.x * 0.5) < 0.5) discard; x += dFdx(gl_FragCoord.x);",
];

#[test]
fn derivatives_are_undefined_where_pixels_of_a_quad_part() {
    let of = |lines: &[&str], fault: &str| {
        let (tree, first) = tree(lines);
        let quad = tree.beside("quad.glb");
        std::fs::write(&quad, glb::model(&glb::quad(9.0), &glb::gray())).unwrap();
        let root = tree.root();
        let mut command = specula(Path::new("."));
        let view = ["--eye", "0,0,2", "--target", "0,0,0", "--json", quad.to_str().unwrap()];
        let args = [&["check", "--undefined", "--shaders", root.to_str().unwrap()], &view[..], &VIEW].concat();
        (finish(command.args(args).env("SPECULA_FAULT", fault)), first)
    };
    let (checked, first) = of(&APART, "");
    checked.expect(1, &["in a branch that only some pixels of a quad take, first at the pixel"]);
    let found: Value = serde_json::from_str(&checked.stdout).unwrap();
    // The quad covers the picture of 48 by 32 pixels. Along the diagonal of its two triangles, a device may leave neighbors out.
    let most = [24 * 32, 48 * 16, 32];
    assert_eq!(found.as_array().unwrap().len(), most.len(), "{found:#}");
    for ((of, line), most) in found.as_array().unwrap().iter().zip(first..).zip(most) {
        assert_eq!((&of["line"], &of["rule"]), (&json!(line), &json!("derivative")), "{of}");
        assert!((most * 9 / 10..=most).contains(&of["count"].as_u64().unwrap()), "{of}");
    }
    let (checked, _) = of(&TOGETHER, "");
    checked.expect(0, &[]);
    // A device that cannot tell says so.
    let (checked, _) = of(&APART[..1], "no-quad-ballots:1");
    checked.expect(0, &["does not tell which pixels run along, so derivatives in branches are not checked"]);
}

#[test]
fn passes_and_vertices_are_checked() {
    let tree = Tree::new();
    let far = "void main() {\n    float far = 1.0 / (gl_FragCoord.w - 1.0);";
    tree.write("tonemap.frag", &tree.edited("tonemap.frag", "void main() {", far));
    let root = "void main() {\n    float root = sqrt(-1.0 - float(gl_VertexIndex));";
    tree.write("pbr.vert", &tree.edited("pbr.vert", "void main() {", root));
    let checked = check(&tree, &["sphere-grid", "--json"]);
    checked.expect(1, &["2 errors", "of the vertex 0", "of tonemap.frag", "at the pixel 0,0"]);
    let found: Value = serde_json::from_str(&checked.stdout).unwrap();
    let faults =
        found.as_array().unwrap().iter().map(|of| (of["file"].as_str().unwrap(), of["rule"].as_str().unwrap()));
    assert_eq!(faults.collect::<Vec<_>>(), [("pbr.vert", "sqrt"), ("tonemap.frag", "division-by-zero")]);
}

/// The modes of the pictures that show most of the tree, on the model that has most of its materials. All of them with SPECULA_LONG.
const MODES: &str = "final,clay,d,direct-specular";

#[test]
fn the_shipped_tree_is_clean() {
    let modes = |few| if is_long() { "all" } else { few };
    for (model, modes) in [("shader-ball", modes(MODES)), ("sphere-grid", modes("final"))] {
        let checked = run(Path::new("."), &["check", "--undefined", "--mode", modes, "--size", "64x48", model]);
        checked.expect(0, &[]);
        assert!(checked.stdout.contains("none failed or was undefined"), "{}", checked.stdout);
    }
}

/// Each choice of the parameters, each example and the solution of each exercise. With SPECULA_LONG all; otherwise the first of each.
#[test]
fn choices_examples_and_exercises_are_clean() {
    let most = if is_long() { usize::MAX } else { 1 };
    let clean = |what: &str, args: &[&str]| {
        let checked =
            run(Path::new("."), &[&["check", "--undefined", "--size", "64x48", "sphere-grid"], args].concat());
        assert_eq!(checked.code, Some(0), "{what}: {}{}", checked.stdout, checked.stderr);
    };
    let renderer = renderer(model("sphere-grid"), settings(&[]), (64, 48));
    let constants = renderer.shaders().constants.clone();
    drop(renderer);
    let choices = constants.iter().filter(|constant| constant.choices.len() > 1).take(most);
    for (name, (choice, _)) in
        choices.flat_map(|of| of.choices.iter().skip(1).take(most).map(|choice| (&of.name, choice)))
    {
        let setting = format!("{name}={choice}");
        clean(&setting, &["--mode", "final,clay", "--set", &setting]);
    }
    let examples = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples")).unwrap();
    let mut examples: Vec<String> = examples.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    examples.sort();
    for example in examples.iter().take(most) {
        if example == "meshlets" && gpu().optional_stages().mesh.is_none() {
            println!("the example `meshlets` is skipped: the device lacks VK_EXT_mesh_shader");
            continue;
        }
        clean(example, &["--shaders", &format!("examples:{example}")]);
    }
    // Solved, an exercise is the shipped tree with settings of its own and files that it adds.
    for exercise in exercises().iter().take(most) {
        let tree = Tree::new();
        exercise.solution().for_each(|(path, text)| tree.write(path.as_str(), text));
        let settings = exercise.settings().iter().flat_map(|set| ["--set", set.as_str()]).collect::<Vec<_>>();
        clean(exercise.slug(), &[&["--shaders", tree.root().to_str().unwrap()][..], &settings].concat());
    }
}

/// Asserts and prints of a tree, each on a line of its own.
const STATEMENTS: [&str; 6] = [
    "assert(s.roughness >= 0.0, \"roughness is not negative\");",
    "assert(s.metallic > 2.0 + zero, \"metallic is large\");",
    "if (gl_FragCoord.x < 20.0) assert(x != 0.0);",
    "print(\"albedo\", vec4(0.25, 0.5, izero, 1.0));",
    "print(\"is lit\", zero < 1.0);",
    "print(\"count\", uzero + 7u);",
];

#[test]
fn assertions_that_fail_and_values_that_are_printed_are_told() {
    let (tree, first) = tree(&STATEMENTS);
    let quad = tree.beside("quad.glb");
    std::fs::write(&quad, glb::model(&glb::quad(9.0), &glb::gray())).unwrap();
    let root = tree.root();
    let view = ["--eye", "0,0,2", "--target", "0,0,0", "--shaders", root.to_str().unwrap()];
    let command = |name: &str, more: &[&str]| {
        run(Path::new("."), &[&[name, quad.to_str().unwrap()], more, &view, &VIEW].concat())
    };
    let checked = command("check", &["--json"]);
    checked.expect(
        1,
        &["2 errors", "assertion failed: metallic is large: ", "assertion failed: 0 and 0, first at the pixel 0,0"],
    );
    checked.expect(
        1,
        &["albedo = (0.25, 0.5, 0, 1) first at the pixel 0,0, in 1,536 fragments", "is lit = true", "count = 7"],
    );
    let found: Value = serde_json::from_str(&checked.stdout).unwrap();
    let lines = found
        .as_array()
        .unwrap()
        .iter()
        .map(|of| (of["line"].as_u64().unwrap() as u32, of["text"].clone(), of["count"].clone()));
    let expected = [
        (first + 1, json!("metallic is large"), json!(1536)),
        (first + 2, json!(null), json!(20 * 32)),
        (first + 3, json!("albedo"), json!(1536)),
        (first + 4, json!("is lit"), json!(1536)),
        (first + 5, json!("count"), json!(1536)),
    ];
    assert_eq!(lines.collect::<Vec<_>>(), expected, "{found:#}");

    // A trace of a pixel tells those of the whole picture.
    let traced = command("trace", &["--at", "30,20", "--file", "user.glsl", "--json"]);
    traced
        .expect(1, &["2 assertions failed", "metallic is large", "albedo = (0.25, 0.5, 0, 1) first at the pixel 0,0"]);
    let (mut listed, trace) = (found.clone(), traced.json());
    listed.as_array_mut().unwrap().iter_mut().for_each(|of| drop(of.as_object_mut().unwrap().remove("modes")));
    assert_eq!((&trace["checks"], &trace["proof"]["equal"]), (&listed, &json!(true)));

    // A picture is written, and its assertions decide about the exit code.
    let out = tree.beside("asserted.png");
    let rendered = command("render", &["--out", out.to_str().unwrap()]);
    rendered.expect(1, &["2 assertions failed", "metallic is large"]);
    let (same, _) = self::tree(&["x += 0.0;"]);
    let plain = tree.beside("plain.png");
    let arguments = [
        "render",
        quad.to_str().unwrap(),
        "--out",
        plain.to_str().unwrap(),
        "--eye",
        "0,0,2",
        "--target",
        "0,0,0",
        "--shaders",
    ];
    run(Path::new("."), &[&arguments[..], &[same.root().to_str().unwrap()], &VIEW].concat()).expect(0, &[]);
    assert!(open_image(&out).into_rgba8() == open_image(&plain).into_rgba8(), "an assertion changes the picture");
}

#[test]
fn a_tree_may_have_functions_of_these_names() {
    let tree = Tree::new();
    let own = "float assert(float x) { return x; }\nfloat print(vec2 x) { return x.y; }\nvoid user_surface(";
    let text = tree.edited("user.glsl", "void user_surface(", own);
    let text = text.replace(
        "    s.roughness = saturate",
        "    s.roughness += assert(0.0) + print(vec2(0.0));\n    s.roughness = saturate",
    );
    tree.write("user.glsl", &text);
    let checked = run(
        Path::new("."),
        &[&["check", "sphere-grid", "--shaders", tree.root().to_str().unwrap()][..], &VIEW].concat(),
    );
    checked.expect(0, &[]);
    assert!(checked.stdout.contains("with 0 assertions: none failed"), "{}", checked.stdout);
}

#[test]
fn edits_with_assertions_are_reloads_like_others() {
    let mut session = Session::new(model("sphere-grid"), settings(&["environment.name=none"]));
    let before = session.render();
    let (user, frag) = (session.tree.read("user.glsl"), session.tree.read("pbr.frag"));
    let line = "    s.roughness = saturate";
    let with = |statement: &str| user.replace(line, &format!("    {statement}\n{line}"));
    for statement in
        ["assert(s.roughness > 0.25, \"is rough\");", "assert(s.roughness > 0.5);", "print(\"metallic\", s.metallic);"]
    {
        ready(&session.save("user.glsl", &with(statement)));
        assert_same(&session.render(), &before, statement);
    }
    // A stage that includes the calls and has some of its own. Errors have the lines of the author.
    let own =
        frag.replace("void main() {", "void main() {\n    assert(true, \"always\");\n    float unknown = missing;");
    let reload = session.save("pbr.frag", &own);
    let errors = failed(&reload);
    let expected = line_of(&own, "float unknown = missing;");
    assert!(
        errors.len() == 1 && errors[0].line == Some(expected) && errors[0].message.contains("missing"),
        "{errors:?}"
    );
    ready(&session.save("pbr.frag", &own.replace("float unknown = missing;", "")));
    // A wrong use is an error at its line.
    let wrong = with("assert(s.roughness, \"no condition\");");
    let reload = session.save("user.glsl", &wrong);
    let errors = failed(&reload);
    assert!(errors.iter().any(|error| error.line == Some(line_of(&wrong, "no condition"))), "{errors:?}");
    session.save("pbr.frag", &frag);
    ready(&session.save("user.glsl", &user));
    assert_same(&session.render(), &before, "restored");
}

#[test]
fn files_of_shadertoy_are_checked() {
    let folder = tempfile::tempdir().unwrap();
    // 64 x 48 pixels, of which three rows are below 3.
    let toy = "void mainImage(out vec4 color, in vec2 at) {\n    assert(at.y > 3.0, \"low\");\n    \
        color = vec4(1.0 / floor(at.x / 10.0));\n}\n";
    std::fs::write(folder.path().join("toy.glsl"), toy).unwrap();
    let size = ["--size", "64x48", "--validate"];
    let checked = run(folder.path(), &[&["check", "--undefined", "toy.glsl", "--json"], &size[..]].concat());
    checked.expect(
        1,
        &["2 errors", "assertion failed: low: 2.5 and 3, first at the pixel 0,45", "division by 0: 1 and 0"],
    );
    let found: Value = serde_json::from_str(&checked.stdout).unwrap();
    let lines =
        found.as_array().unwrap().iter().map(|of| (of["line"].as_u64().unwrap(), of["count"].as_u64().unwrap()));
    assert_eq!(lines.collect::<Vec<_>>(), [(2, 64 * 3), (3, 10 * 48)], "{found:#}");
    // The line is shown as its author wrote it.
    let own = "void mainImage(out vec4 color, in vec2 at) { color = vec4(sqrt(at.x - 1e3)); }";
    std::fs::write(folder.path().join("short.glsl"), own).unwrap();
    let checked = run(folder.path(), &[&["check", "--undefined", "short.glsl"], &size[..]].concat());
    checked.expect(1, &["sqrt() of a negative number", &format!("1 | {own}")]);
    let rendered = run(folder.path(), &[&["render", "toy.glsl", "--out", "toy.png"], &size[..]].concat());
    rendered.expect(1, &["1 assertion failed", "low"]);
    assert!(folder.path().join("toy.png").exists());
}
