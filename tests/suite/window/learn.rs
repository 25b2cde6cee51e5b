//! The hint of the first start, and an exercise that is solved in an editor.

use image::RgbaImage;
use serde_json::{Value, json};

use super::controls::{ACCENT, count};
use crate::support::Tree;
use crate::support::window::Viewer;

#[test]
fn an_exercise_is_solved_by_an_edit() {
    let tree = Tree::new();
    let folder = specula::learn::prepare(&tree.beside(""), &specula::learn::find("1").unwrap()).unwrap();
    let mut viewer = Viewer::open(tree, &["--shaders", "01-roughness", "--size", "900x600"]);
    let goals = |event: &Value| event["goals"].as_array().unwrap().clone();
    let first = viewer.running.event("exercise");
    assert_eq!((&first["name"], &first["passed"]), (&"01-roughness".into(), &false.into()), "{first}");
    assert!(goals(&first)[0]["found"].as_str().unwrap().contains("was expected"), "{first}");

    let file = folder.join("brdf/ndf.glsl");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("float a2 = alpha;", "float a2 = alpha * alfa;")).unwrap();
    viewer.running.reload(false);
    std::fs::write(&file, text.replace("float a2 = alpha;", "float a2 = alpha * alpha;")).unwrap();
    let solved = viewer.running.event("exercise");
    assert_eq!(solved["passed"], true, "{solved}");
    assert!(goals(&solved).iter().all(|goal| goal["passed"] == true), "{solved}");
    let progress = std::fs::read_to_string(viewer.tree.beside("state/specula/learn.json")).unwrap();
    assert!(progress.contains("01-roughness") && progress.contains("true"), "{progress}");
    // The next window is arranged as before the exercise.
    let layout = viewer.tree.beside("state/specula/layout.json");
    viewer.until("the stored arrangement", |_| layout.is_file());
    assert!(!std::fs::read_to_string(&layout).unwrap().contains("Learn"), "the exercise's arrangement is stored");
    viewer.quit();
}

/// The sliders and the model of a tree are there again after an exercise, which has its own, also for a later window.
#[test]
fn an_exercise_costs_no_setting_of_the_tree_before() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let text = viewer.tree.read("brdf/ndf.glsl");
    let line = 1 + text.lines().position(|line| line.contains("float a2 = alpha * alpha;")).unwrap();
    let watched = json!(format!("brdf/ndf.glsl:{line}:a2"));
    let own = json!({ "roughness_scale": 0.4, "view.ev": 1.5, "expression.at": watched });
    viewer.running.done(json!({ "command": "set", "values": own }));
    let own = viewer.screenshot();
    let learn = json!({ "command": "run", "entry": "Exercise 1: Square the roughness" });
    viewer.running.done(learn.clone());
    viewer.running.event("exercise");
    let ev = |viewer: &mut Viewer| viewer.running.done(json!({ "command": "get", "path": "view.ev" }));
    assert_ne!(ev(&mut viewer), json!(1.5), "the exercise has settings of its own");
    let sessions = viewer.tree.beside("state/specula/sessions.json");
    viewer.until("the stored session of the tree", |_| sessions.is_file());
    let stored = std::fs::read_to_string(&sessions).unwrap();
    assert!(stored.contains("roughness_scale") && !stored.contains("specula-learn"), "{stored}");
    let tree = viewer.tree.beside("shaders");
    viewer.running.done(json!({ "command": "open", "tree": tree }));
    assert_eq!(ev(&mut viewer), json!(1.5));
    viewer.until("the picture of before", |shot| *shot == own);
    let expression = json!({ "command": "get", "path": "expression.at" });
    assert_eq!(viewer.running.done(expression.clone()), watched);
    // A model that is opened over a single file after an exercise is not shown by the exercise.
    viewer.running.done(learn);
    viewer.running.event("exercise");
    let toy = viewer.tree.beside("toy.glsl");
    std::fs::write(&toy, "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0, 1.0, 0.0, 1.0); }\n").unwrap();
    viewer.running.done(json!({ "command": "open", "tree": toy }));
    viewer.running.done(json!({ "command": "open", "model": "sphere-grid" }));
    viewer.until("the model in its own tree", |shot| *shot == own);
    assert_eq!(viewer.running.done(expression), watched);
    viewer.running.end_input();
    viewer.quit();
}

#[test]
fn the_hint_of_the_first_start_is_dismissed_once() {
    let (width, height) = (900, 600);
    // Only the card's edge is a line of this color that is so long.
    let is_edge = |screen: &RgbaImage, y: u32| count(screen, 0..width, y..y + 1, ACCENT) > 150;
    let edge = |screen: &RgbaImage| (height / 2..height - 30).rev().find(|y| is_edge(screen, *y));
    let mut viewer = Viewer::at_first_start(Tree::new(), &["sphere-grid", "--size", "900x600"]);
    viewer.running.event("ready");
    let screen = viewer.until_screen("the hint", |screen| edge(screen).is_some());
    // "Got it" is the last of the buttons above the lower edge.
    let bottom = edge(&screen).unwrap();
    let left = (0..width).find(|x| count(&screen, *x..*x + 1, bottom - 40..bottom, ACCENT) > 20).unwrap();
    viewer.click((left + 220, bottom - 20));
    viewer.until_screen("no hint", |screen| edge(screen).is_none());
    assert!(viewer.tree.beside("state/specula/hint.json").is_file());
    viewer.quit();
}
