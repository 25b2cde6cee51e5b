//! Stages between vertices and pixels, and those that bake light.

use std::path::Path;

use serde_json::Value;

use super::check;
use crate::support::{Tree, glb};

/// Tessellation and geometry stages assert, print and are checked as others are. What bakes light is not, which a warning says.
#[test]
fn stages_between_vertices_and_pixels_are_checked() {
    let tree = Tree::new();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples");
    for (example, file) in [
        ("displacement", "pbr.tesc"),
        ("displacement", "pbr.tese"),
        ("displacement", "user/params.glsl"),
        ("displacement", "user/rock.glsl"),
        ("normals", "passes/normals.geom"),
        ("normals", "passes/normals.frag"),
    ] {
        std::fs::copy(examples.join(example).join(file), tree.path(file)).unwrap();
    }
    for (file, before, statements) in [
        (
            "pbr.tesc",
            "divide_edges",
            "assert(gl_InvocationID > 9); print(\"id\", gl_InvocationID); float a = 1.0 / (part_px - part_px);",
        ),
        ("pbr.tese", "float height", "assert(n.x > 9.0); print(\"n\", n); float a = sqrt(-1.0 - abs(n.x));"),
        ("passes/normals.geom", "move_to", "assert(i > 9); print(\"i\", i); float a = sqrt(-1.0 - float(i));"),
    ] {
        tree.write(file, &tree.edited(file, before, &format!("{statements}\n{before}")));
    }
    let baked = "ibl/irradiance.comp";
    tree.write(baked, &tree.edited(baked, "void main() {", "void main() {\n    assert(false);"));
    let quad = tree.beside("quad.glb");
    std::fs::write(&quad, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let checked = check(&tree, &["--json", quad.to_str().unwrap()]);
    checked.expect(1, &["6 errors", "irradiance.comp: warning: the assertions of this file are not checked"]);
    let found: Value = serde_json::from_str(&checked.stdout).unwrap();
    let found = found.as_array().unwrap();
    for (file, fault) in [("pbr.tesc", "division-by-zero"), ("pbr.tese", "sqrt"), ("passes/normals.geom", "sqrt")] {
        for rule in ["assert", "print", fault] {
            let of: Vec<&Value> = found.iter().filter(|of| of["stage"] == file && of["rule"] == rule).collect();
            assert!(of.len() == 1 && of[0]["count"].as_u64() > Some(1), "{file} {rule}: {found:#?}");
        }
    }
}
