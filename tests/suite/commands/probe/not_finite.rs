//! The first statement that makes NaN or infinity at a pixel.

use std::path::Path;

use serde_json::{Value, json};

use crate::support::process::{Finished, run};
use crate::support::{glb, line_of};

/// A file with a sphere. Its material has no layers, so a stage that looks at every statement is compiled in a third of the time that the
/// default model's takes.
const BALL: &str = "ball.glb";

fn write_ball(directory: &Path) {
    std::fs::write(directory.join(BALL), glb::model(&glb::sphere(16, 32), &glb::gray())).unwrap();
}

/// Probes a pixel of the sphere with a tree in which `from` is replaced by `to` in a file. Returns the result and the new text.
fn edited(directory: &Path, file: &str, (from, to): (&str, &str), more: &[&str]) -> (Finished, String) {
    let tree = directory.join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    let text = std::fs::read_to_string(tree.join(file)).unwrap();
    assert!(text.contains(from), "{file} has no `{from}`");
    let new = text.replacen(from, to, 1);
    std::fs::write(tree.join(file), &new).unwrap();
    write_ball(directory);
    let args = [&[BALL, "--shaders", "tree", "--at", "50,30"], more].concat();
    (super::probe(directory, &args), new)
}

#[test]
fn a_division_by_zero_in_the_ndf_is_found() {
    let directory = tempfile::tempdir().unwrap();
    let broken = ("return a2 / (PI * spread * spread);", "return (a2 - a2) / (spread - spread);");
    let (found, text) =
        edited(directory.path(), "brdf/ndf.glsl", broken, &["--mode", "final", "--mode", "depth", "--json"]);
    let found = found.expect(0, &[]).json();
    assert_eq!(found["modes"]["final"], "NaN");
    let first = &found["not_finite"];
    let line = line_of(&text, broken.1);
    assert_eq!(
        (&first["line"], &first["code"], &first["value"]),
        (&json!(line), &json!(broken.1), &json!("NaN")),
        "{first}"
    );
    assert_eq!((&first["mode"], &first["nan"]), (&json!("final"), &Value::Null), "{first}");
    assert!(first["file"].as_str().unwrap().ends_with("brdf/ndf.glsl"), "{first}");
    // The same in a debug mode, as text.
    let args = [BALL, "--shaders", "tree", "--at", "50,30", "--mode", "d"];
    let table = super::probe(directory.path(), &args).expect(0, &[]).stdout.clone();
    let last = table.lines().last().unwrap();
    assert!(
        last.starts_with("first NaN in d: ") && last.ends_with(&format!("brdf/ndf.glsl:{line}: {}", broken.1)),
        "{table}"
    );
}

#[test]
fn the_root_of_a_negative_number_in_user_surface_is_found() {
    let directory = tempfile::tempdir().unwrap();
    let broken = ("s.roughness = saturate(s.roughness * roughness_scale);", "s.roughness = sqrt(-1.0 - s.roughness);");
    let (found, text) = edited(directory.path(), "user.glsl", broken, &["--mode", "roughness"]);
    let line = line_of(&text, broken.1);
    let table = found.expect(0, &[]).stdout.clone();
    assert!(table.contains(&format!("user.glsl:{line}: {}", broken.1)), "{table}");
}

/// Infinity comes first, and NaN follows from it.
#[test]
fn infinity_in_a_loop_is_found_before_the_nan_that_follows() {
    let directory = tempfile::tempdir().unwrap();
    let lines = "float large = 2.0 + s.roughness;\n    for (int i = 0; i < 40; ++i)\n        large *= large;\n    \
        float nothing = large - 2.0 * large;\n    s.roughness += nothing;";
    let broken = ("s.roughness = saturate(s.roughness * roughness_scale);", lines);
    let (found, text) = edited(directory.path(), "user.glsl", broken, &["--mode", "roughness", "--json"]);
    let first = found.expect(0, &[]).json()["not_finite"].clone();
    assert_eq!(
        (&first["line"], &first["value"]),
        (&json!(line_of(&text, "large *= large;")), &json!("Inf")),
        "{first}"
    );
    assert_eq!(first["code"], "large *= large;");
    assert_eq!(first["nan"]["line"], line_of(&text, "float nothing"), "{first}");
}

#[test]
fn a_pixel_whose_values_are_finite_has_no_such_line() {
    let directory = tempfile::tempdir().unwrap();
    let same = ("s.roughness = saturate(", "s.roughness = saturate(");
    let (found, _) = edited(directory.path(), "user.glsl", same, &["--mode", "final", "--mode", "roughness", "--json"]);
    let found = found.expect(0, &[]).json();
    assert!(found["modes"]["final"].is_array() && found.get("not_finite").is_none(), "{found}");
}

/// A pass after the model is no part of the stage.
#[test]
fn a_value_of_a_pass_is_told_to_be_made_elsewhere() {
    let directory = tempfile::tempdir().unwrap();
    let tree = directory.path().join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    let pass = "//@pass broken \"Broken\" to=picture\n#version 460\n#include \"pass.glsl\"\nuniform sampler2D picture;\n\
        void main() { color = texture(picture, uv); color.r = sqrt(-1.0 - color.a); }\n";
    std::fs::write(tree.join("passes/broken.frag"), pass).unwrap();
    write_ball(directory.path());
    let args = [BALL, "--shaders", "tree", "--at", "50,30", "--mode", "final", "--json"];
    let found = super::probe(directory.path(), &args);
    let first = found.expect(0, &[]).json()["not_finite"].clone();
    assert!(first["message"].as_str().unwrap().contains("passes after the model"), "{first}");
}

/// `render` warns of such pixels, and names one that `probe` takes.
#[test]
fn render_warns_of_pixels_that_are_not_finite() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let view = ["--size", "96x64", "--env", "none"];
    let render = |more: &[&str]| run(here, &[&["render", "sphere-grid", "--out", "a.png"], &view[..], more].concat());
    let warning = "NaN or infinite";
    let good = render(&[]);
    assert!(!good.expect(0, &[]).stderr.contains(warning), "{good:#?}");
    let broken =
        ("s.roughness = saturate(s.roughness * roughness_scale);", "s.base_color.r = sqrt(-1.0 - s.roughness);");
    edited(here, "user.glsl", broken, &["--mode", "final"]);
    let bad = render(&["--shaders", "tree"]);
    bad.expect(0, &["pixels are NaN or infinite, such as"]);
    assert_eq!((bad.stdout.as_str(), bad.stderr.matches(warning).count()), ("", 1), "{bad:#?}");
    let at = bad.stderr.split("specula probe --at ").nth(1).unwrap().split('`').next().unwrap();
    let probe = [&["probe", "sphere-grid", "--shaders", "tree", "--mode", "final", "--at", at], &view[..]].concat();
    let found = run(here, &probe);
    assert!(found.expect(0, &[]).stdout.contains("first NaN in final: "), "{found:#?}");
    // Several pictures are told of at once, and a light that is nowhere, too.
    let modes = render(&["--shaders", "tree", "--mode", "final,base-color,depth"]);
    modes.expect(0, &["2 of 3 pictures have pixels that are NaN or infinite. The first, of the mode final, has"]);
    assert_eq!(modes.stderr.matches(warning).count(), 1, "{modes:#?}");
    let sheet =
        ["render", "sphere-grid", "--out", "a.png", "--env", "none", "--shaders", "tree", "--sheet", "depth,final"];
    let sheet = run(here, &[&sheet[..], &["--tile", "40x30"]].concat());
    sheet.expect(
        0,
        &["1 of 2 pictures have pixels that are NaN or infinite. The first, of the mode final", "--size 40x30`"],
    );
}
