//! Opens dropped files, and restores the last session.

use std::io::Cursor;

use serde_json::{Value, json};

use super::controls::{WARNING, choose, count};
use crate::support::window::Viewer;
use crate::support::xdnd::{drop_file, drop_file_and_answer_late, drop_files};
use crate::support::{Tree, glb, open_image};

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

/// While frames are slow, a file manager answers twice what it drags, and once after the drop. That answer is none of the next drag.
#[test]
fn a_second_drop_opens_its_own_file_whatever_the_first_said_late() {
    let tree = Tree::new();
    let (first, second) = (tree.beside("first.glb"), tree.beside("second.glb"));
    std::fs::write(&first, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    std::fs::write(&second, glb::model(&glb::sphere(8, 16), &glb::gray())).unwrap();
    let mut viewer = Viewer::open(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    let grid = viewer.screenshot();
    let (display, window) = (viewer.display.name().to_owned(), viewer.window());
    drop_file_and_answer_late(&display, window, (300, 200), &first);
    viewer.until("the first model", |shot| *shot != grid);
    let quad = viewer.screenshot();
    drop_file(&display, window, (300, 200), &second);
    viewer.until("the second model", |shot| *shot != grid && *shot != quad);
    let recent: Value = serde_json::from_str(&std::fs::read_to_string(viewer.tree.beside(RECENT)).unwrap()).unwrap();
    assert_eq!(recent["models"][0].as_str(), second.to_str());
    viewer.quit();
}

#[test]
fn the_scenes_of_a_file_are_shown_by_command_and_palette() {
    let tree = Tree::new();
    let model = tree.beside("scenes.glb");
    let (mut json, bin) = glb::document(&glb::quad(1.0), &glb::gray());
    json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "translation": [9, 0, 0], "rotation": [0, 0.3, 0, 0.954] }, {}]);
    json["scenes"] = json!([{ "nodes": [0] }, { "name": "turned", "nodes": [1] }, { "name": "empty", "nodes": [2] }]);
    std::fs::write(&model, glb::container(&json, &bin)).unwrap();
    let mut viewer = Viewer::driven(tree, &["scenes.glb"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    viewer.running.done(json!({"command": "scene", "number": 1}));
    let turned = viewer.screenshot();
    assert!(turned != first, "the scene is the same");
    // It is framed, wherever it is.
    assert!(turned.pixels().any(|pixel| pixel != turned.get_pixel(0, 0)), "an empty picture");
    let refused = viewer.running.refused(json!({"command": "scene", "number": 3}));
    assert!(refused.contains("there is no scene 3: the model's file has 3"), "{refused}");
    // One that cannot be shown leaves the one on screen, which is also shown when the file is read again.
    let refused = viewer.running.refused(json!({"command": "scene", "number": 2}));
    assert!(refused.contains("nothing to draw"), "{refused}");
    assert!(viewer.screenshot() == turned, "a scene without meshes changed the picture");
    json["nodes"][1]["scale"] = json!([1.0, 0.5, 1.0]);
    std::fs::write(&model, glb::container(&json, &bin)).unwrap();
    viewer.until("the scene of the file as it was saved", |shot| *shot != turned);
    json["nodes"][1].as_object_mut().unwrap().remove("scale");
    std::fs::write(&model, glb::container(&json, &bin)).unwrap();
    viewer.until("the scene as before", |shot| *shot == turned);
    viewer.running.done(json!({"command": "open", "model": "sphere-grid"}));
    viewer.running.done(json!({"command": "open", "model": model}));
    assert!(viewer.screenshot() == first, "another file has not ended the choice of a scene");
    viewer.running.done(json!({"command": "run", "entry": "Scene: turned"}));
    viewer.until("the scene that the palette shows", |shot| *shot == turned);
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

/// A model whose textures take ten minutes is shown without them, and says so. A screenshot waits for them. Another model that is bad ends
/// their load, and costs nothing: they are loaded again.
#[test]
fn a_model_is_on_screen_before_its_textures_and_gets_them_whatever_comes() {
    let tree = Tree::new();
    let bad = tree.beside("bad.glb");
    std::fs::write(&bad, "").unwrap();
    let (mut document, mut bin) = glb::document(&glb::quad(1.0), &glb::gray());
    let red = image::RgbImage::from_pixel(2, 2, image::Rgb([255, 0, 0]));
    let mut png = Cursor::new(Vec::new());
    red.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let mut png = png.into_inner();
    // Bytes that no decoder reads make it large.
    png.resize(2 << 20, 0);
    bin.resize(bin.len().next_multiple_of(4), 0);
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": png.len() }));
    document["images"] = json!([{ "bufferView": views.len() - 1, "mimeType": "image/png" }]);
    bin.extend(png);
    document["buffers"][0]["byteLength"] = json!(bin.len());
    document["textures"] = json!([{ "source": 0 }]);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    document["materials"][0]["extensions"] = json!({ "KHR_materials_unlit": {} });
    std::fs::write(tree.beside("model.glb"), glb::container(&document, &bin)).unwrap();

    let mut viewer = Viewer::driven_with_fault(tree, &["model.glb"], "textures-delay-ms:600000");
    let mut early = Vec::new();
    viewer.running.until("ready", |event| {
        early.push(event["event"].clone());
        event["event"] == "ready"
    });
    assert!(!early.contains(&json!("settled")), "the picture was final without textures: {early:?}");
    let is_red = |pixel: &image::Rgba<u8>| pixel[0] > 80 && pixel[1] < 30 && pixel[2] < 30;
    let reds = |shot: &image::RgbaImage| shot.pixels().filter(|pixel| is_red(pixel)).count();
    let screen = viewer.until_screen("words about the textures", |screen| count(screen, 0..640, 0..480, WARNING) > 0);
    assert_eq!(reds(&screen), 0, "the textures were there before they were decoded");
    viewer.key("F12");
    let refused = viewer.running.refused(json!({"command": "open", "model": bad}));
    assert!(refused.contains("bad.glb"), "{refused}");
    let event = viewer.running.event("screenshot");
    let shot = open_image(&viewer.tree.beside(event["file"].as_str().unwrap())).into_rgba8();
    assert!(reds(&shot) > 10_000, "the screenshot has {} red pixels", reds(&shot));
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
