//! An expression of the shaders is shown over the model, and follows edits.

use image::RgbaImage;
use serde_json::json;

use super::NDF;
use super::controls::choose;
use crate::support::window::Viewer;
use crate::support::{Tree, glb, line_of};

const USER: &str = "user.glsl";

fn is_color(shot: &RgbaImage, color: [u8; 3]) -> bool {
    let at = (shot.width() / 2, shot.height() / 2);
    shot.get_pixel(at.0, at.1).0[..3].iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 1)
}

#[test]
fn an_expression_is_watched_by_the_palette() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::driven(tree, &["model.glb", "--set", "view.range=mode"]);
    viewer.running.event("ready");
    let picture = viewer.screenshot();
    let original = viewer.tree.read(USER);
    let head = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    let line = line_of(&original, head);

    choose(&viewer, &format!("{USER}:{line}:vec3(0.25, 0.5, 1.0) * 0.8"));
    viewer.until("the value of the expression", |shot| is_color(shot, [51, 102, 204]));
    // The line is found again below another one.
    let edited = original.replace(head, &format!("float half_of(float x) {{ return 0.5 * x; }}\n\n{head}"));
    viewer.tree.write(USER, &edited);
    let is_edit = |event: &serde_json::Value| event["event"] == "reload" && event["changed"] != serde_json::json!([]);
    let reload = viewer.running.until("the reload of the edit", is_edit);
    viewer.running.settled(&reload);
    viewer.until("the value after an edit", |shot| is_color(shot, [51, 102, 204]));

    // An expression that does not compile is no error of the tree: the picture goes on.
    choose(&viewer, &format!("{USER}:{}:nothing", line + 2));
    let diagnostic = viewer.running.event("diagnostic");
    let message = diagnostic["message"].as_str().unwrap_or_default();
    assert!(message.contains("cannot watch `nothing`"), "{diagnostic}");
    assert_eq!(diagnostic["line"].as_u64(), Some(u64::from(line) + 2));
    viewer.until("the picture", |shot| *shot == picture);
    viewer.running.done(json!({ "command": "reload" }));
    viewer.quit();
}

/// The panel Source is closed, so nothing else asks for a trace.
#[test]
fn evaluations_are_traced_while_the_panel_expression_lists_them() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "900x700", "shader-ball"]);
    viewer.running.event("ready");
    viewer.running.done(json!({ "command": "run", "entry": "Panel: Expression" }));
    let line = line_of(&viewer.tree.read(NDF), "float a2 = alpha * alpha;");
    let watched = json!({ "expression.at": format!("{NDF}:{line}:a2"), "mode": "expression" });
    viewer.running.done(json!({ "command": "set", "values": watched }));
    let picture = viewer.screenshot();
    viewer.running.done(json!({ "command": "pick", "at": [picture.width() / 2, picture.height() / 2] }));
    let is_of_file = |event: &serde_json::Value| event["event"] == "traced" && event["file"] == NDF;
    viewer.running.until("the trace of the file of the expression", is_of_file);
    viewer.quit();
}
