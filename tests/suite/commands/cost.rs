//! `specula bench cost`: what each function of a stage costs.

use std::path::Path;

use serde_json::Value;

use crate::support::Tree;
use crate::support::process::run;

/// A file of Shadertoy: the loop of sines is dear, and so is the one whose result nobody uses.
const TOY: &str = "float seed = 0.5;
float cheap(float x) {
    return x * 1.5 + 0.25;
}

float dear(float x) {
    float y = x;
    for (int i = 0; i < 1500; i++) y += sin(y + float(i));
    return y;
}

float unused(float x) {
    return sin(sin(sin(sin(sin(x)))));
}


void split(in float x, out float whole, inout float part) { whole = floor(x); part += fract(x); }
float next() { seed = fract(seed * 7.7); return seed; }
float hole(float x) { if (x < 0.0) discard; return x; }

void mainImage(out vec4 color, in vec2 at) {
    float whole, part = 0.25, ignored = unused(at.x);
    split(at.x * 0.1, whole, part);
    color = vec4(dear(at.x), cheap(at.y) + cheap(at.x), whole + part, next() + hole(at.x));
}
";

const SIZE: [&str; 3] = ["--size", "96x64", "--validate"];

fn function<'a>(costs: &'a Value, name: &str) -> &'a Value {
    let all = costs["functions"].as_array().unwrap();
    let found = all.iter().find(|of| of["name"].as_str().unwrap().starts_with(&format!("{name}(")));
    found.unwrap_or_else(|| panic!("{name}: {costs:#}"))
}

fn ms(of: &Value) -> f64 {
    of["ms"].as_f64().unwrap()
}

#[test]
fn the_dearest_function_is_found_with_its_time() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("toy.glsl"), TOY).unwrap();
    let costs = run(folder.path(), &[&["bench", "cost", "toy.glsl", "--json", "--samples", "64"], &SIZE[..]].concat())
        .expect(0, &[])
        .json();
    let dear = function(&costs, "dear");
    assert_eq!((&dear["file"], &dear["line"]), (&"opened/toy.glsl".into(), &6.into()), "{costs:#}");
    // The picture is little else, so it is significant on a machine that does other work, too.
    assert!(dear["significant"] == true && ms(dear) > 0.0 && dear["share"].as_f64() > Some(0.0), "{costs:#}");
    let others = costs["functions"].as_array().unwrap();
    assert_eq!(&others[0], dear, "the dearest comes first");
    for other in &others[1..] {
        assert!(ms(other) + other["margin_ms"].as_f64().unwrap() < 0.5 * ms(dear), "{other} {dear}");
    }
    // The optimizer drops what nobody uses, so it is the same module with and without it.
    let unused = &function(&costs, "unused")["figures"]["words"];
    assert!(unused["with"].is_u64() || unused["with"].is_f64(), "{costs:#}");
    assert_eq!(unused["with"], unused["without"], "{costs:#}");
    let calls = |name: &str| function(&costs, name)["calls"].as_u64().unwrap();
    assert_eq!(
        (calls("dear"), calls("cheap"), costs["invocations"].as_u64().unwrap()),
        (96 * 64, 2 * 96 * 64, 96 * 64)
    );
    let reason = |name: &str| {
        let all = costs["not_measured"].as_array().unwrap();
        let found =
            all.iter().find(|of| of["name"].as_str().unwrap().starts_with(name)).unwrap_or_else(|| panic!("{name}"));
        found["reason"].as_str().unwrap().to_owned()
    };
    assert!(reason("next(").contains("writes `seed`") && reason("hole(").contains("discards"), "{costs:#}");
    assert_eq!(calls("split"), 96 * 64);
}

#[test]
fn costs_of_a_tree_are_printed_as_a_table() {
    let tree = Tree::new();
    let root = tree.root();
    let args = ["bench", "cost", "sphere-grid", "--env", "none", "--samples", "3", "--shaders", root.to_str().unwrap()];
    let of = |more: &[&str]| run(Path::new("."), &[&args[..], more, &SIZE].concat());
    let printed = of(&["--function", "d_ggx", "--function", "user_surface"]);
    printed.expect(0, &[]);
    let lines: Vec<&str> = printed.stdout.lines().collect();
    assert!(lines[0].starts_with("pbr.frag: ") && lines[0].contains(" ms a frame on "), "{}", printed.stdout);
    let row = lines.iter().position(|line| line.starts_with("d_ggx(float, float, float) ")).unwrap();
    assert_eq!(lines[row + 1].trim(), format!("brdf/ndf.glsl:{}", line_of_ndf(&tree)), "{}", printed.stdout);
    let tone = of(&["--stage", "tonemap.frag", "--json", "--function", "tonemap"]).expect(0, &[]).json();
    assert_eq!((&tone["stage"], ms(function(&tone, "tonemap")) > -10.0), (&"tonemap.frag".into(), true), "{tone:#}");
    of(&["--stage", "absent.frag"]).expect(2, &["the picture has no stage absent.frag; it has", "pbr.frag"]);
    of(&["--function", "absent"]).expect(2, &["pbr.frag has no function absent"]);
}

fn line_of_ndf(tree: &Tree) -> u32 {
    crate::support::line_of(&tree.read("brdf/ndf.glsl"), "float d_ggx(")
}
