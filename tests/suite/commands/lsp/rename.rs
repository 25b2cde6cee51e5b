//! Rename over all files of a tree, and what is refused.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::client::{Opened, at, place};
use crate::support::process::run;

/// Applies a change of the workspace to the files on disk. Returns how many edits each file has.
fn apply(opened: &Opened, change: &Value) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for (uri, edits) in change["changes"].as_object().unwrap() {
        let path = std::path::Path::new(uri.strip_prefix("file://").unwrap());
        let text = std::fs::read_to_string(path).unwrap();
        let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
        let mut edits: Vec<&Value> = edits.as_array().unwrap().iter().collect();
        let number = |value: &Value| value.as_u64().unwrap() as usize;
        edits.sort_by_key(|edit| {
            (number(&edit["range"]["start"]["line"]), number(&edit["range"]["start"]["character"]))
        });
        for edit in edits.iter().rev() {
            let (start, end) = (&edit["range"]["start"], &edit["range"]["end"]);
            assert_eq!(start["line"], end["line"]);
            let line = &mut lines[number(&start["line"])];
            line.replace_range(
                number(&start["character"])..number(&end["character"]),
                edit["newText"].as_str().unwrap(),
            );
        }
        std::fs::write(path, lines.join("\n")).unwrap();
        let relative = path.strip_prefix(opened.tree.root()).unwrap().display().to_string();
        counts.insert(relative, edits.len());
    }
    counts
}

fn rename(opened: &mut Opened, what: &str, plus: usize, new: &str) -> Value {
    let mut params = at(&opened.path, &opened.text, what, plus);
    params["newName"] = json!(new);
    opened.client.ask("textDocument/rename", params)
}

#[track_caller]
fn refuses(opened: &mut Opened, what: &str, plus: usize, new: &str, why: &str) {
    let mut params = at(&opened.path, &opened.text, what, plus);
    params["newName"] = json!(new);
    let message = opened.client.refused("textDocument/rename", params);
    assert!(message.contains(why), "{what} -> {new}: {message}");
}

#[test]
fn a_tree_compiles_after_functions_members_and_constants_were_renamed() {
    let mut opened = Opened::new("brdf/surface.glsl");
    let change = rename(&mut opened, "clearcoat_roughness; //", 0, "coat_roughness");
    let counts = apply(&opened, &change);
    assert!(counts.len() > 2 && counts["brdf/surface.glsl"] == 2, "{counts:?}");
    let change = rename(&mut opened, "alpha_from_roughness(", 2, "alpha_of_roughness");
    assert!(apply(&opened, &change).len() > 1);
    let mut opened =
        Opened { text: opened.tree.read("brdf/models.glsl"), path: opened.tree.path("brdf/models.glsl"), ..opened };
    opened.client.open(&opened.path, &opened.text);
    let change = rename(&mut opened, "uint BECKMANN", 6, "BECKMANN_SPIZZICHINO");
    assert!(apply(&opened, &change).contains_key("brdf/ndf.glsl"));
    let root = opened.tree.root();
    run(root.parent().unwrap(), &["modes", "--shaders", root.to_str().unwrap()]).expect(0, &[]);
    opened.client.quit();
}

#[test]
fn a_local_name_changes_in_its_function_alone() {
    let mut opened = Opened::new("brdf/ndf.glsl");
    let range = opened.ask("prepareRename", "float alpha) {", 8);
    assert_eq!(range["start"], place(&opened.text, "float alpha) {", 6));
    let change = rename(&mut opened, "float alpha) {", 6, "squared_roughness");
    assert_eq!(apply(&opened, &change), BTreeMap::from([("brdf/ndf.glsl".to_owned(), 3)]));
    let text = opened.tree.read("brdf/ndf.glsl");
    assert!(text.contains("float d_ggx(float n_dot_h, float sin2_h, float squared_roughness) {\n    float a2 = squared_roughness * squared_roughness;"));
    assert!(text.contains("vec2(alpha)"));
    opened.client.quit();
}

#[test]
fn clashes_and_names_of_others_are_refused_with_the_reason() {
    let mut opened = Opened::new("brdf/ndf.glsl");
    let alpha = ("float alpha) {", 6);
    refuses(&mut opened, alpha.0, alpha.1, "spread", "`spread` is used already, at brdf/ndf.glsl:");
    refuses(&mut opened, alpha.0, alpha.1, "vec3", "reserved");
    refuses(&mut opened, alpha.0, alpha.1, "2x", "no name");
    refuses(&mut opened, alpha.0, alpha.1, "gl_alpha", "reserved");
    refuses(&mut opened, "d_ggx_anisotropic(", 1, "luminance", "used already");
    refuses(&mut opened, "dot(stretched", 1, "product", "built into GLSL");
    refuses(&mut opened, "return a2 /", 2, "back", "built into GLSL");
    opened.edit("float spread = n_dot_h", "float lit = frame.exposure; float spread = n_dot_h");
    opened.edit("#include \"common/math.glsl\"", "#include \"common/math.glsl\"\n#include \"interface.glsl\"");
    refuses(&mut opened, "frame.exposure", 1, "picture_of_now", "part of the contract");
    refuses(&mut opened, "frame.exposure", 8, "brightness", "part of the contract");
    opened.client.quit();
    let mut opened = Opened::new("user.glsl");
    refuses(&mut opened, "void user_light(", 6, "own_light", "Specula calls `user_light`");
    opened.client.quit();
    let mut opened = Opened::new("passes/bloom/bloom.frag");
    refuses(&mut opened, "sampler2D bloom_wide", 11, "wide", "is the image that passes/bloom/bloom_wide.frag declares");
    opened.client.quit();
}
