//! `specula trace`: the values of statements at a pixel.

mod formulas;
mod fragments;
mod long_loops;
mod oracle;
mod pitfalls;
mod planted;
mod samples;
mod stages;
mod statements;

use std::path::Path;

use serde_json::{Value, json};

use crate::support::process::{Finished, run};
use crate::support::{glb, line_of};

/// One sample, so that triangles of a surface do not share pixels: see `samples.rs` for several.
const VIEW: [&str; 7] = ["--size", "96x64", "--env", "none", "--validate", "--set", "view.msaa=1"];
/// A pixel of the default model, and of a unit sphere seen from `EYE`.
const AT: [&str; 2] = ["--at", "50,30"];
const EYE: [&str; 4] = ["--eye", "0,0,4", "--target", "0,0,0"];

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

/// The lines of a file that were not reached.
fn not_reached(trace: &Value, file: &str) -> Vec<u64> {
    let lines = trace["not_reached"][file].as_array();
    lines.into_iter().flatten().map(|line| line.as_u64().unwrap()).collect()
}

/// The numbers that a variable, a parameter or `return` has at a line of the shipped tree, of all calls.
fn numbers(trace: &Value, file: &str, part: &str, name: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders").join(file)).unwrap();
    let found = done(trace, file, line_of(&text, part));
    let is_named = |(act, of, _): &&(String, String, Vec<Value>)| of == name || (act == name && of.is_empty());
    let values = found.iter().find(is_named).unwrap_or_else(|| panic!("{file}: `{part}` has no {name}, but {found:?}"));
    values
        .2
        .iter()
        .flat_map(|value| value.as_array().cloned().unwrap_or_else(|| vec![value.clone()]))
        .map(|n| n.as_f64().unwrap())
        .collect()
}

/// A tree whose `user_surface` has these lines, and the text of its file.
fn tree(directory: &Path, library: &str, body: &str) -> String {
    let tree = directory.join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    let shipped = std::fs::read_to_string(tree.join("user.glsl")).unwrap();
    let text = shipped.replace("void user_surface(", &format!("{library}\nvoid user_surface("));
    let text = text.replace("    s.roughness = saturate", &format!("{body}\n    s.roughness = saturate"));
    assert_ne!(text, shipped);
    std::fs::write(tree.join("user.glsl"), &text).unwrap();
    text
}

/// The text and the trace of `user.glsl` in such a tree, which is proven.
#[track_caller]
fn proven(directory: &Path, library: &str, body: &str) -> (String, Value) {
    let text = tree(directory, library, body);
    let found = trace(directory, &["--shaders", "tree", "--at", "50,30", "--file", "user.glsl", "--json"])
        .expect(0, &[])
        .json();
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    (text, found)
}

fn write_sphere(directory: &Path) {
    let material = json!({ "name": "red", "pbrMetallicRoughness": {
        "baseColorFactor": [0.9, 0.3, 0.2, 1.0], "metallicFactor": 0.25, "roughnessFactor": 0.6 } });
    std::fs::write(directory.join("ball.glb"), glb::model(&glb::sphere(32, 64), &material)).unwrap();
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs().max(1e-3)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|at| a[at] * b[at]).sum()
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| x / dot(a, a).sqrt())
}

fn vector(value: &Value) -> [f64; 3] {
    std::array::from_fn(|at| value[at].as_f64().unwrap())
}

/// D, V and F of each light, from position, normal, eye and lights alone, as the CPU computes them.
#[test]
fn terms_of_the_brdf_are_those_of_the_cpu() {
    let directory = tempfile::tempdir().unwrap();
    write_sphere(directory.path());
    let files = ["ndf", "visibility", "fresnel", "evaluate"].map(|name| format!("brdf/{name}.glsl"));
    let files: Vec<&str> = files.iter().flat_map(|file| ["--file", file]).collect();
    let place = [&["ball.glb", "--at", "64,26"][..], &EYE].concat();
    let found = trace(directory.path(), &[&place[..], &files, &["--json"]].concat()).expect(0, &[]).json();
    assert_eq!((&found["proof"]["equal"], &found["proof"]["ulp"]), (&json!(true), &json!(0)), "{}", found["proof"]);
    let modes = ["final", "position", "shading-normal"].iter().flat_map(|mode| ["--mode", mode]).collect::<Vec<_>>();
    let probe = run(directory.path(), &[&["probe", "--json"], &place[..], &modes, &VIEW].concat()).json();
    // Bit by bit: JSON has all digits of a float.
    assert_eq!(found["proof"]["picture"], probe["modes"]["final"]);
    let position = vector(&probe["modes"]["position"]);
    let n = unit(vector(&probe["modes"]["shading-normal"]));
    let eye = vector(&probe["camera"]["eye"]);
    let v = unit(std::array::from_fn(|at| eye[at] - position[at]));
    let mut expected: Vec<[f64; 6]> = Vec::new();
    let mut shining = Vec::new();
    for (number, light) in (1..).zip(probe["lights"].as_array().unwrap()) {
        let l = match light["position"].as_array() {
            Some(_) => std::array::from_fn(|at| vector(&light["position"])[at] - position[at]),
            None => vector(&light["direction"]).map(|x| -x),
        };
        let l = unit(l);
        let h = unit(std::array::from_fn(|at| l[at] + v[at]));
        let [n_dot_l, n_dot_v, n_dot_h, v_dot_h] = [(n, l), (n, v), (n, h), (v, h)].map(|(a, b)| dot(a, b));
        if n_dot_l <= 0.0 {
            continue;
        }
        shining.push(format!("shade > add_light [light {number}] > evaluate_brdf > d_specular > d_ggx"));
        let a2 = 0.6_f64.powi(4);
        let spread = n_dot_h * n_dot_h * a2 + (1.0 - n_dot_h * n_dot_h);
        let root = |c: f64| (c * c * (1.0 - a2) + a2).sqrt();
        let visibility = 0.5 / (n_dot_v * root(n_dot_l) + n_dot_l * root(n_dot_v));
        let fresnel = 0.04 + 0.96 * (1.0 - v_dot_h).powi(5);
        let d = a2 / (std::f64::consts::PI * spread * spread);
        expected.push([n_dot_l, n_dot_h, d, visibility, fresnel, spread]);
    }
    assert!(expected.len() >= 2, "{probe}");
    let column = |at: usize| expected.iter().map(|terms| terms[at]).collect::<Vec<f64>>();
    let member = |part: &str, name: &str| numbers(&found, "brdf/evaluate.glsl", part, name);
    let fresnel = member("brdf.f_dielectric = dielectric_fresnel", "brdf.f_dielectric");
    for (what, traced, cpu) in [
        ("n_dot_l", member("brdf.n_dot_l = saturate(cos_l)", "brdf.n_dot_l"), column(0)),
        ("n_dot_h", numbers(&found, "brdf/ndf.glsl", "float d_ggx(float", "n_dot_h"), column(1)),
        ("d", numbers(&found, "brdf/ndf.glsl", "return a2 / (PI * spread", "return"), column(2)),
        ("spread", numbers(&found, "brdf/ndf.glsl", "float spread = n_dot_h", "spread"), column(5)),
        ("v", numbers(&found, "brdf/visibility.glsl", "return 0.5 / (n_dot_v", "return"), column(3)),
        ("D of the struct", member("brdf.distribution *= above", "brdf.distribution"), column(2)),
        ("f", fresnel.chunks(3).map(|color| color[0]).collect(), column(4)),
    ] {
        let same = traced.len() == cpu.len() && traced.iter().zip(&cpu).all(|(a, b)| near(*a, *b, 1e-3));
        assert!(same, "{what}: {traced:?}, but the CPU computes {cpu:?}");
    }
    // The calls name their lights.
    let calls = |of: &Value| of["calls"].as_str().unwrap().to_owned();
    let of_ggx = found["lines"]
        .as_array()
        .unwrap()
        .iter()
        .find(|line| line["file"] == "brdf/ndf.glsl" && line["code"].as_str().unwrap().starts_with("float spread"));
    let times = of_ggx.unwrap()["done"][0]["first"].as_array().unwrap();
    assert_eq!(times.iter().map(calls).collect::<Vec<_>>(), shining);
    let named: Vec<&Value> = found["lights"].as_array().unwrap().iter().map(|light| &light["name"]).collect();
    assert_eq!(named, ["lights.orbit.0", "lights.orbit.1", "lights.orbit.2"]);
    assert_eq!(found["lights"][1]["intensity"], probe["lights"][1]["intensity"]);
    // Beckmann's lines are in the stage and not reached.
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/brdf/ndf.glsl")).unwrap();
    let missed = not_reached(&found, "brdf/ndf.glsl");
    assert!(missed.contains(&u64::from(line_of(&text, "vec2 slope = h_ts.xy"))), "{missed:?}");
    assert!(!missed.contains(&u64::from(line_of(&text, "float spread = n_dot_h"))), "{missed:?}");
}

/// A small stage of an own tree.
const NORMALS: &str = "//@pass model \"Model\" draw=model to=picture doc=\"Normals\"\n#version 460\n#include \"interface.glsl\"\n\
    #include \"common/fragment.glsl\"\n#include \"common/math.glsl\"\n#include \"common/pixel.glsl\"\n\
    layout(location = 0) in Fragment fragment;\nlayout(location = 0) out vec4 out_color;\n\
    void main() {\n    vec3 n = safe_normalize(fragment.normal_ws, vec3(1.0, 0.0, 0.0));\n    if (n.z < -2.0)\n        n = -n;\n    \
    out_color = hdr_pixel(abs(n), 1.0, false);\n}\n";

/// Without --file, all files of the stage are traced.
#[test]
fn all_files_are_traced_and_the_color_is_the_pictures() {
    let directory = tempfile::tempdir().unwrap();
    let tree = directory.path().join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    std::fs::write(tree.join("pbr.frag"), NORMALS).unwrap();
    std::fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let text = trace(directory.path(), &[&["quad.glb", "--shaders", "tree"][..], &AT, &EYE].concat());
    text.expect(0, &[]);
    assert!(text.stdout.contains("fragment 0 of 1: equal to the picture\n"), "{}", text.stdout);
    let parts = [
        "\npbr.frag\n",
        "\ncommon/math.glsl\n",
        "\ncommon/pixel.glsl\n",
        "n = (0, 0, 1)",
        "? false",
        "not reached: 12\n",
    ];
    for part in parts {
        assert!(text.stdout.contains(part), "no `{part}` in {}", text.stdout);
    }
}

/// The stage of the debug modes, of a built-in model.
#[test]
fn a_debug_mode_is_traced() {
    let directory = tempfile::tempdir().unwrap();
    let args = ["sphere-grid", "--mode", "d", "--file", "brdf/ndf.glsl", "--json"];
    let found = trace(directory.path(), &[&args[..], &AT].concat()).expect(0, &[]).json();
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    let d = numbers(&found, "brdf/ndf.glsl", "return a2 / (PI * spread", "return");
    let shown = found["proof"]["picture"][0].as_f64().unwrap();
    assert!(d.iter().any(|d| near(*d, shown, 1e-3)), "{d:?} {shown}");
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
    let lines = text.lines().count();
    trace(directory.path(), &[&args[..], &["--assert", "user.glsl:9999 x > 0"]].concat())
        .expect(2, &[&format!("user.glsl:9999 x > 0: user.glsl has {lines} lines")]);
    with(&["nothing > 0"]).expect(1, &["no value of `nothing`", "the line has half_rough"]);
    trace(directory.path(), &["--at", "50,30", "--assert", "a b"]).expect(2, &["expected FILE:LINE NAME > NUMBER"]);
    trace(directory.path(), &["--at", "96,0"]).expect(2, &["--at 96,0 is outside of the picture"]);
    for form in ["user.glsl:1 x>0", "user.glsl x > 0", "user.glsl:1 x ~ 0", ""] {
        trace(directory.path(), &["--at", "50,30", "--assert", form]).expect(2, &["expected FILE:LINE NAME > NUMBER"]);
    }
    // A check that fails has the values in JSON, too.
    let assertion = format!("{place} half_rough > 5");
    let found = trace(directory.path(), &[&args[..], &["--json", "--assert", &assertion]].concat());
    let failed = found.expect(1, &["half_rough > 5"]).json()["failed"].to_string();
    assert!(failed.contains("failed for 1 of 1 values"), "{failed}");
}

/// What has no such values says so.
#[test]
fn what_cannot_be_traced_is_said() {
    let directory = tempfile::tempdir().unwrap();
    write_sphere(directory.path());
    let ball = |more: &[&str]| trace(directory.path(), &[&["ball.glb"][..], &EYE, more].concat());
    ball(&["--at", "1,1", "--file", "user.glsl"]).expect(2, &["the model does not cover the pixel 1,1"]);
    ball(&["--at", "50,30", "--file", "common/absent.glsl"]).expect(2, &["no stage has a file common/absent.glsl"]);
    ball(&["--at", "50,30", "--file", "ndff.glsl"])
        .expect(2, &["no stage has a file ndff.glsl. Did you mean `ndf.glsl`?"]);
    ball(&["--at", "50,30", "--file", "brdf/nfd.glsl"]).expect(2, &["Did you mean `brdf/ndf.glsl`?"]);
    ball(&["--at", "50,30", "--file", "tonemap.frag", "--stage", "pbr.frag"])
        .expect(2, &["no statement of tonemap.frag is in the stage", "brdf/ndf.glsl"]);
    ball(&["--at", "50,30", "--fragment", "7", "--file", "user.glsl"])
        .expect(2, &["the pixel has 1 fragment; the first is 0"]);
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
        let view = ["two.glb", "--at", "48,32", "--eye", "0,0,6", "--target", "0,0,0", "--file", "pbr.frag", "--json"];
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
    let number = discarded.to_string();
    let view = ["two.glb", "--at", "48,32", "--eye", "0,0,6", "--target", "0,0,0", "--file", "pbr.frag"];
    let text = trace(directory.path(), &[&view[..], &["--fragment", &number]].concat());
    text.expect(0, &[]);
    assert!(text.stdout.contains("of 2: discarded\n") && text.stdout.contains("   discard\n"), "{}", text.stdout);
}

/// The pixels around one have the values that a trace of each has, and none where the model is not.
#[test]
fn the_values_around_a_pixel_are_those_of_its_neighbors() {
    let directory = tempfile::tempdir().unwrap();
    write_sphere(directory.path());
    let traced = |at: &str, more: &[&str]| {
        let place = [&["ball.glb", "--at", at, "--file", "brdf/ndf.glsl", "--json"], &EYE[..], more].concat();
        trace(directory.path(), &place).expect(0, &[]).json()
    };
    // At the silhouette, so that a part of the square is beside the sphere.
    let found = traced("73,32", &["--around"]);
    let around = &found["around"];
    assert_eq!((&around["first"], &around["size"]), (&json!([69, 28]), &json!([8, 8])));
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/brdf/ndf.glsl")).unwrap();
    let line = line_of(&text, "float a2 = alpha * alpha");
    let values = |name: &str, line: u32| -> Vec<Value> {
        let statements = around["statements"].as_array().unwrap();
        let found = statements.iter().find(|of| of["name"] == name && of["line"] == line);
        found.unwrap_or_else(|| panic!("no {name}: {statements:#?}"))["values"].as_array().unwrap().clone()
    };
    let spread = values("spread", line + 1);
    assert_eq!(spread.len(), 64);
    let missing = spread.iter().filter(|value| value.is_null()).count();
    assert!((1..60).contains(&missing), "{missing} of 64 pixels are beside the sphere");
    for (x, y) in [(71_usize, 30_usize), (70, 34)] {
        let own = traced(&format!("{x},{y}"), &[]);
        let last = done(&own, "brdf/ndf.glsl", line + 1).last().unwrap().2.last().unwrap().clone();
        assert_eq!(spread[(y - 28) * 8 + (x - 69)], last, "{x}, {y}");
    }
    trace(directory.path(), &["ball.glb", "--at", "73,32", "--around"]).expect(2, &["--json"]);
}
