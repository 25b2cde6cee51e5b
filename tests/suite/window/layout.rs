//! The arrangement of the panels, and the command palette.

use image::RgbaImage;
use serde_json::{Value, json};

use super::controls::choose;
use crate::support::window::Viewer;
use crate::support::{Tree, glb};

const LAYOUT: &str = "state/specula/layout.json";
const RECENT: &str = "state/specula/recent.json";

fn open(layout: Option<&str>) -> Viewer {
    let tree = Tree::new();
    if let Some(text) = layout {
        std::fs::create_dir_all(tree.beside("state/specula")).unwrap();
        std::fs::write(tree.beside(LAYOUT), text).unwrap();
    }
    let mut viewer = Viewer::open(tree, &["sphere-grid", "--size", "1000x480"]);
    viewer.running.event("ready");
    viewer
}

/// The stored arrangement, once it is there and another than `before`.
fn stored(viewer: &mut Viewer, before: &str) -> String {
    let path = viewer.tree.beside(LAYOUT);
    let read = || std::fs::read_to_string(&path).unwrap_or_default();
    viewer.until("the stored arrangement", |_| !read().is_empty() && read() != before);
    read()
}

#[test]
fn the_arrangement_of_the_panels_lasts() {
    let mut viewer = open(None);
    let first = viewer.screenshot().width();
    // Between the picture and the panels on its right.
    let edge = 236 + 3 + first;
    viewer.drag_along(&[(edge, 200), (edge - 80, 200)]);
    viewer.until("a narrower picture", |shot| shot.width().abs_diff(first - 80) < 6);
    let narrow = viewer.screenshot().width();
    let text = stored(&mut viewer, "");
    viewer.quit();

    let mut viewer = open(Some(&text));
    assert_eq!(viewer.screenshot().width(), narrow, "the width of the panels is forgotten");
    choose(&viewer, "layout look");
    viewer.until("a wider picture", |shot| shot.width() > first + 150);
    let wide = viewer.screenshot().width();
    let text = stored(&mut viewer, &text);
    viewer.quit();

    let mut viewer = open(Some(&text));
    assert_eq!(viewer.screenshot().width(), wide, "the arrangement is forgotten");
    // The panels keep their width in another window, and the picture takes the rest.
    viewer.resize(900, 480);
    assert_eq!(viewer.screenshot().width(), wide - 100);
    viewer.quit();
}

#[test]
fn a_panel_is_docked_beside_the_picture() {
    // What is no arrangement counts as none.
    let damaged = "{\"root\": 7}";
    let mut viewer = open(Some(damaged));
    let first = viewer.screenshot().dimensions();
    // The tab Passes, in the upper group of the right column, goes to the lower part of the picture.
    viewer.drag_along(&[(782, 42), (770, 60), (500, 360), (460, 420)]);
    viewer.until("a picture that has made room", |shot| shot.dimensions() != first);
    let docked = viewer.screenshot().dimensions();
    let text = stored(&mut viewer, damaged);
    viewer.quit();
    let mut viewer = open(Some(&text));
    assert_eq!(viewer.screenshot().dimensions(), docked, "the arrangement is forgotten");
    choose(&viewer, "reset arrangement");
    viewer.until("the first arrangement", |shot| shot.dimensions() == first);
    viewer.quit();
}

#[test]
fn the_palette_reaches_modes_switches_commands_and_numbers() {
    let mut viewer = open(None);
    let picture = viewer.screenshot();
    viewer.key("n");
    viewer.until("shading normals, by their key", |shot| *shot != picture);
    let normals = viewer.screenshot();
    viewer.key("n");
    viewer.until("the picture", |shot| *shot == picture);
    // The letters are the search's, from the moment that it opens: none of them chooses a mode or hides the panels.
    choose(&viewer, "shading normal");
    viewer.until("shading normals, by their name", |shot| *shot == normals);
    choose(&viewer, "final");
    viewer.until("the picture, by its name", |shot| *shot == picture);
    choose(&viewer, "film turn on");
    viewer.until("a pass that is switched on", |shot| shot.dimensions() == picture.dimensions() && *shot != picture);
    choose(&viewer, "undo");
    viewer.until("the picture, undone", |shot| *shot == picture);
    choose(&viewer, "hide panels");
    viewer.until("the whole window", |shot| shot.dimensions() == (1000, 480));
    viewer.key("h");
    // Nothing is chosen by words that no entry has. The key that opens the palette closes it, and so does Escape, alone.
    viewer.key("n");
    viewer.until("shading normals again", |shot| *shot == normals);
    choose(&viewer, "no such entry");
    viewer.key("ctrl+p");
    viewer.key("ctrl+p");
    viewer.key("Escape");
    viewer.until("shading normals still, which Escape behind the palette would leave", |shot| *shot == normals);
    viewer.key("n");
    viewer.until("the picture, by a letter that no palette takes", |shot| *shot == picture);

    // Numbers.
    choose(&viewer, "expsoure -4 EV");
    viewer.until("a darker picture", |shot| brightness(shot) < 0.6 * brightness(&picture));
    let dark = viewer.screenshot();
    choose(&viewer, "undo");
    viewer.until("the picture, undone", |shot| *shot == picture);
    // The number of a parameter of the shaders, in a second step. A value out of range is not taken.
    choose(&viewer, "roughness scale");
    assert!(viewer.screenshot() == picture, "a number without a value changed the picture");
    viewer.display.xdotool(&["type", "7"]);
    viewer.key("Return");
    assert!(viewer.screenshot() == picture, "a value out of range was taken");
    viewer.key("BackSpace");
    viewer.display.xdotool(&["type", "0.1"]);
    viewer.key("Return");
    viewer.until("a smoother model", |shot| *shot != picture && *shot != dark);
    viewer.quit();
}

/// A program that does not run gets all keys at once when it goes on.
#[test]
fn keys_of_one_frame_act_in_their_order() {
    let mut viewer = open(None);
    let picture = viewer.screenshot();
    viewer.paused(|| {
        viewer.key("n");
        choose(&viewer, "no such entry");
        ["ctrl+p", "ctrl+p", "Escape", "F12"].iter().for_each(|key| viewer.key(key));
    });
    viewer.running.event("screenshot");
    viewer.until("shading normals, which no key behind theirs left", |shot| *shot != picture);
    let normals = viewer.screenshot();
    viewer.paused(|| {
        choose(&viewer, "roughness");
        ["n", "n", "n"].iter().for_each(|key| viewer.key(key));
        choose(&viewer, "final");
        viewer.key("n");
    });
    viewer.until("shading normals, by a letter behind the palette", |shot| *shot == normals);
    viewer.paused(|| {
        viewer.key("n");
        choose(&viewer, "exposure -2");
        ["u", "u", "ctrl+z"].iter().for_each(|key| viewer.key(key));
    });
    viewer.until("the picture, undone", |shot| *shot == picture);
    viewer.quit();
}

/// Sum of all channels.
fn brightness(shot: &RgbaImage) -> f64 {
    shot.pixels().flat_map(|pixel| pixel.0[..3].to_vec()).map(f64::from).sum()
}

/// The files of earlier runs are in the palette, apart from those that are gone. An opened one comes first.
#[test]
fn files_that_were_open_are_offered() {
    let tree = Tree::new();
    let [model, other] = ["model.glb", "other.glb"].map(|name| tree.beside(name));
    std::fs::write(&model, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    std::fs::write(&other, glb::model(&glb::sphere(8, 16), &glb::gray())).unwrap();
    std::fs::create_dir_all(tree.beside("state/specula")).unwrap();
    let recent = tree.beside(RECENT);
    let stored = json!({ "models": [tree.beside("vanished.glb"), other, model] });
    std::fs::write(&recent, stored.to_string()).unwrap();
    let mut viewer = Viewer::open(tree, &["sphere-grid", "--size", "1000x480"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    choose(&viewer, "model vanished");
    assert!(viewer.screenshot() == first, "a file that is gone was offered");
    viewer.key("ctrl+p");
    viewer.screenshot();
    choose(&viewer, "model: model.glb");
    viewer.until("the model", |shot| *shot != first);
    let models = || {
        let stored: Value = serde_json::from_str(&std::fs::read_to_string(&recent).unwrap()).unwrap();
        stored["models"].clone()
    };
    viewer.until("the list of models", |_| models() == json!([model, other]));
    viewer.quit();
}

#[test]
fn an_edit_while_the_window_is_hidden_shows_once_it_is_back() {
    let mut viewer = open(None);
    let picture = viewer.screenshot();
    viewer.hide();
    let text = viewer.tree.read("brdf/ndf.glsl");
    viewer.tree.write("brdf/ndf.glsl", &text.replace("alpha * alpha;", "alpha;"));
    viewer.unhide();
    viewer.until("the edit", |shot| *shot != picture);
    viewer.quit();
}
