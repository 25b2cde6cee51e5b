//! Times that the window measures while it rests: what functions cost, and how much two versions differ.

use serde_json::{Value, json};

use super::NDF;
use crate::support::window::Viewer;
use crate::support::{Tree, line_of};

const FRAG: &str = "pbr.frag";
const MAIN: &str = "void main() {";
/// Takes much longer, and discards nothing.
const SLOW: &str = "void main() {
    float slow = gl_FragCoord.x;
    for (int i = 0; i < 300; i++) slow += sin(slow + float(i));
    if (slow == 12345.678) discard;";

/// Saves a text of the stage of the picture and waits for the final picture.
fn save(viewer: &mut Viewer, text: &str) {
    viewer.tree.write(FRAG, text);
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
}

/// Compares with the version before, and returns what is told about its time.
fn timed(viewer: &mut Viewer, version: u64) -> Value {
    let compared = viewer.running.done(json!({ "command": "compare", "with": "previous" }));
    assert_eq!(compared["version"], version, "{compared}");
    let timed = viewer.running.until("the times", |event| event["event"] == "timed" && event["version"] == version);
    assert!(timed["error"].is_null() && timed["text"].is_string(), "{timed}");
    timed
}

#[test]
fn versions_are_timed_in_turn_while_they_are_compared() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "400x300", "sphere-grid"]);
    viewer.running.event("ready");
    let original = viewer.tree.read(FRAG);
    save(&mut viewer, &original.replace(MAIN, SLOW));
    let slower = timed(&mut viewer, 1);
    let difference = &slower["difference"];
    assert_eq!(difference["verdict"], "faster", "the version before is the faster one: {slower}");
    assert!(
        slower["text"].as_str().unwrap().ends_with(" faster") && difference["confidence"].as_f64() >= Some(0.99),
        "{slower}"
    );
    let part = -difference["change_ms"].as_f64().unwrap() / difference["base_ms"].as_f64().unwrap();
    assert!(part > 0.1, "{slower}");

    // Another number in the same code. One of a hundred such comparisons may find a difference, but then a small one.
    save(&mut viewer, &original.replace(MAIN, &SLOW.replace("12345.678", "54321.25")));
    let same = timed(&mut viewer, 2);
    let [change, margin, base] =
        ["change_ms", "margin_ms", "base_ms"].map(|name| same["difference"][name].as_f64().unwrap());
    assert!(change.abs() <= 3.0 * margin + 0.02 * base, "{same}");

    save(&mut viewer, &original);
    let faster = timed(&mut viewer, 3);
    assert_eq!(faster["difference"]["verdict"], "slower", "{faster}");
    viewer.quit();
}

#[test]
fn functions_are_measured_while_the_window_rests() {
    let tree = Tree::new();
    let text = tree.read(NDF);
    let mut viewer = Viewer::driven(tree, &["--size", "900x700", "shader-ball"]);
    viewer.running.event("ready");
    let refused = viewer.running.refused(json!({ "command": "cost", "stage": "pbr.fra" }));
    assert!(refused.contains("Did you mean `pbr.frag`?"), "{refused}");
    let costs = viewer.running.done(json!({ "command": "cost", "function": "d_ggx" }));
    let of = &costs["functions"][0];
    assert_eq!((&of["file"], &of["line"]), (&NDF.into(), &line_of(&text, "float d_ggx(").into()), "{costs}");
    assert!(of["ms"].is_f64() && of["calls"].as_u64() > Some(0) && costs["stage"] == "pbr.frag", "{costs}");
    let unknown = viewer.running.refused(json!({ "command": "cost", "function": "absent" }));
    assert!(unknown.contains("has no function absent"), "{unknown}");
    viewer.quit();
}
