//! Opens dropped files, and restores the last session.

use serde_json::{Value, json};

use super::controls::choose;
use crate::support::window::Viewer;
use crate::support::xdnd::{drop_file, drop_files};
use crate::support::{Tree, glb};

const RECENT: &str = "state/specula/recent.json";
const SESSIONS: &str = "state/specula/sessions.json";

/// Dropped as a file manager does it, by the XDND protocol.
#[test]
fn a_dropped_model_opens_and_any_other_file_changes_nothing() {
    let tree = Tree::new();
    let (model, note) = (tree.beside("dropped.glb"), tree.beside("note.txt"));
    std::fs::write(&model, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    std::fs::write(&note, "no model").unwrap();
    let mut viewer = Viewer::open(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let (display, window) = (viewer.display.name().to_owned(), viewer.window());
    drop_file(&display, window, (300, 200), &note);
    viewer.running.until_stderr("note.txt: expected a model (.gltf, .glb or a .zip with one)");
    assert!(viewer.screenshot() == first, "a text changed the picture");
    drop_file(&display, window, (300, 200), &model);
    viewer.until("the dropped model", |shot| *shot != first);
    let recent: Value = serde_json::from_str(&std::fs::read_to_string(viewer.tree.beside(RECENT)).unwrap()).unwrap();
    assert_eq!(recent["models"][0].as_str(), model.to_str());
    viewer.quit();
}

/// As one drops a model with all its files on other viewers. A buffer alone is taken for a measured BRDF, which it is not.
#[test]
fn a_model_is_dropped_with_its_files_and_a_damaged_one_changes_no_setting() {
    let tree = Tree::new();
    let (model, buffer, note) = (tree.beside("dropped.glb"), tree.beside("dropped.bin"), tree.beside("note.txt"));
    std::fs::write(&model, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    std::fs::write(&buffer, "no measured BRDF").unwrap();
    std::fs::write(&note, "no model").unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let before = viewer.running.done(json!({"command": "get"}));
    let (display, window) = (viewer.display.name().to_owned(), viewer.window());
    drop_file(&display, window, (300, 200), &buffer);
    viewer.running.until_stderr("dropped.bin");
    viewer.until("the picture of before", |shot| *shot == first);
    assert_eq!(viewer.running.done(json!({"command": "get"})), before, "a file that cannot be read has set something");
    drop_files(&display, window, (300, 200), &[&buffer, &note, &model]);
    viewer.until("the dropped model", |shot| *shot != first);
    assert_eq!(viewer.running.done(json!({"command": "get", "path": "mode"})), "final");
    viewer.running.end_input();
    viewer.quit();
}

#[test]
fn a_model_is_added_beside_and_an_undo_takes_it_away() {
    let tree = Tree::new();
    let (model, bad) = (tree.beside("second.glb"), tree.beside("bad.glb"));
    std::fs::write(&model, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    std::fs::write(&bad, "").unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    let added = |viewer: &mut Viewer| viewer.running.done(json!({"command": "get"}))["added"].clone();
    let first = viewer.screenshot();
    viewer.running.done(json!({"command": "open", "beside": model}));
    assert_eq!(added(&mut viewer)[0]["file"].as_str(), model.to_str());
    let both = viewer.screenshot();
    assert!(both != first, "no model beside the first");
    let refused = viewer.running.refused(json!({"command": "open", "beside": bad}));
    assert!(refused.contains("bad.glb: is empty"), "{refused}");
    assert_eq!(added(&mut viewer).as_array().map(Vec::len), Some(1));
    viewer.key("ctrl+z");
    viewer.until("the first model alone", |shot| *shot == first);
    assert!(added(&mut viewer).is_null());
    viewer.key("ctrl+shift+z");
    viewer.until("both models", |shot| *shot == both);
    // Several files that are dropped together.
    let (display, window) = (viewer.display.name().to_owned(), viewer.window());
    drop_files(&display, window, (300, 200), &[&model, &model]);
    viewer.until("two other models", |shot| *shot != both && *shot != first);
    let settings = viewer.running.done(json!({"command": "get"}));
    assert_eq!(settings["added"].as_array().map(Vec::len), Some(1), "{settings}");
    viewer.running.end_input();
    viewer.quit();
}

/// Ends a window, and returns its folder.
fn end(mut viewer: Viewer) -> Tree {
    viewer.key("ctrl+q");
    // What the panels took is told at the end.
    let closed = viewer.running.event("closed");
    let median = |name: &str| closed[name]["median"].as_f64().unwrap();
    assert!(closed["frames"].as_u64() > Some(1) && median("ui_ms") > 0.0, "{closed}");
    // Where the system has a clock for each thread.
    assert!(!cfg!(target_os = "linux") || median("cpu_ms") > 0.0, "{closed}");
    assert!(viewer.running.end().success());
    viewer.tree
}

#[test]
fn a_session_is_restored_where_the_user_wants_it() {
    let plain = |tree| {
        let mut viewer = Viewer::plain(tree, &[]);
        viewer.ready_and_baked();
        viewer
    };
    let mut viewer = plain(Tree::new());
    let first = viewer.screenshot();
    viewer.key("u");
    viewer.until("roughness", |shot| *shot != first);
    let roughness = viewer.screenshot();
    choose(&viewer, "model: sphere-grid");
    viewer.until("another model", |shot| *shot != roughness);
    let last = viewer.screenshot();
    let path = viewer.tree.beside(SESSIONS);
    let tree = end(viewer);
    let stored: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let work = stored["sessions"][0]["work"].clone();
    assert_eq!((work["model"].as_str(), work["settings"]["mode"].as_str()), (Some("sphere-grid"), Some("roughness")));

    // The next window offers it.
    let mut viewer = plain(tree);
    assert!(viewer.screenshot() != last, "a session was restored that nobody asked for");
    choose(&viewer, "restore the last session");
    viewer.until("the last session", |shot| *shot == last);
    let tree = end(viewer);

    // By itself, once the user has chosen that. An option says that something else is wanted.
    let mut stored: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    stored["always"] = true.into();
    std::fs::write(&path, stored.to_string()).unwrap();
    let mut viewer = plain(tree);
    viewer.until("the last session by itself", |shot| *shot == last);
    let tree = end(viewer);
    let mut viewer = Viewer::plain(tree, &["--mode", "metallic"]);
    viewer.running.event("ready");
    assert!(viewer.screenshot() != last, "an option did not keep the last session away");
    viewer.quit();
}
