//! The window on its own display (Xvfb): open, resize, edit, break, screenshot, close. xdotool sends keys and sizes through
//! the X server, as a user would.

mod adaptive;
mod attacks;
mod camera;
mod commands;
mod compare;
mod compare_files;
mod controls;
mod costs;
mod endurance;
mod expressions;
mod faults;
mod gallery;
mod grid;
mod inspector;
mod keys;
mod layout;
mod learn;
mod losses;
mod motion;
mod open;
mod panels;
mod passes;
mod pictures;
mod scene;
mod source;

use crate::support::process::finish;
use crate::support::window::{Display, Viewer};
use crate::support::{Tree, glb, hdr};
use image::RgbaImage;

const NDF: &str = "brdf/ndf.glsl";

#[test]
fn open_resize_edit_break_screenshot_close() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    let ready = viewer.running.event("ready");
    assert!(ready["device"].is_string() && ready["ms"].as_f64() > Some(0.0), "{ready}");
    let first = viewer.screenshot();
    assert!(first.pixels().any(|pixel| pixel != first.get_pixel(0, 0)), "an empty picture");

    // Without panels, the picture fills the window.
    viewer.key("h");
    assert_eq!(viewer.screenshot().dimensions(), (640, 480));
    viewer.resize(700, 500);
    assert_eq!(viewer.screenshot().dimensions(), (700, 500));
    viewer.key("h");
    let resized = viewer.screenshot();
    let (width, height) = (resized.width(), resized.height());
    assert!(
        width < 700 && height <= 500 && width > first.width(),
        "{:?}, {:?}",
        first.dimensions(),
        resized.dimensions()
    );

    let original = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &original.replace("float a2 = alpha * alpha;", "float a2 = alpha;"));
    let reload = viewer.running.reload(true);
    assert!(reload["first_frame_ms"].as_f64() > Some(0.0), "{reload}");
    viewer.running.settled(&reload);
    let edited = viewer.screenshot();
    assert_ne!(edited, resized, "the edit shows");

    viewer.tree.write(NDF, &original.replace("alpha * alpha;", "alpha * alfa;"));
    let diagnostic = viewer.running.event("diagnostic");
    assert!(diagnostic["message"].as_str().is_some_and(|message| message.contains("alfa")), "{diagnostic}");
    assert!(diagnostic["line"].is_u64() && diagnostic["column"].is_u64(), "{diagnostic}");
    viewer.running.reload(false);
    assert!(viewer.screenshot() == edited, "a broken edit changed the picture");

    viewer.tree.write(NDF, &original);
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    assert!(viewer.screenshot() == resized, "the first shader again shows the first picture again");
    viewer.quit();
}

#[test]
fn any_size_and_any_number_of_sizes() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    // Smaller than the panels, a single pixel, and extreme shapes.
    for (width, height) in [(90, 60), (1, 1), (1, 400), (400, 1)] {
        viewer.resize(width, height);
        let picture = viewer.screenshot();
        assert!(picture.width() <= width && picture.height() <= height, "{:?}", picture.dimensions());
    }
    for step in 1..20 {
        viewer.resize(400 + 10 * step, 300 + 5 * step);
    }
    viewer.resize(640, 480);
    assert!(viewer.screenshot() == first, "back at the first size");
    viewer.quit();
}

/// While nothing changes, the window draws nothing. Keys wake it.
#[test]
fn a_window_rests_until_keys_choose_modes_and_hide_the_panels() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    // Pipelines may still be built.
    viewer.rests();
    let picture = viewer.screenshot();
    viewer.key("n");
    viewer.until("shading normals", |shot| *shot != picture);
    viewer.key("n");
    viewer.until("the picture, by the same key again", |shot| *shot == picture);
    viewer.key("bracketright");
    viewer.until("the next mode", |shot| *shot != picture);
    viewer.key("Escape");
    viewer.until("the picture, by Escape", |shot| *shot == picture);
    // Escape is the list's while the list of keys is open.
    viewer.key("n");
    viewer.until("shading normals again", |shot| *shot != picture);
    let normals = viewer.screenshot();
    viewer.key("F1");
    viewer.key("Escape");
    assert!(viewer.screenshot() == normals, "Escape behind the list of keys left the mode");
    viewer.key("Escape");
    viewer.until("the picture, by a second Escape", |shot| *shot == picture);
    viewer.key("h");
    viewer.until("the whole window", |shot| shot.dimensions() == (640, 480));
    viewer.quit();
}

#[test]
fn shaders_that_are_broken_from_the_start_are_waited_for() {
    let tree = Tree::new();
    let original = tree.read(NDF);
    tree.write(NDF, &original.replace("alpha * alpha;", "alpha * alfa;"));
    let mut viewer = Viewer::open(tree, &["sphere-grid"]);
    // The first compilation may have failed before or after the window was found.
    viewer.key("F5");
    viewer.running.reload(false);
    viewer.tree.write(NDF, &original);
    viewer.running.event("ready");
    let picture = viewer.screenshot();
    assert!(picture.pixels().any(|pixel| pixel != picture.get_pixel(0, 0)), "an empty picture");
    viewer.quit();
}

#[test]
fn the_model_is_watched_and_a_damaged_one_costs_nothing() {
    let tree = Tree::new();
    let path = tree.beside("model.glb");
    std::fs::write(&path, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb"]);
    viewer.running.event("ready");
    let quad = viewer.screenshot();
    std::fs::write(&path, glb::model(&glb::sphere(8, 16), &glb::gray())).unwrap();
    viewer.until("the new model", |shot| *shot != quad);
    std::fs::write(&path, b"glTF").unwrap();
    std::fs::write(&path, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    viewer.until("the first model", |shot| *shot == quad);
    viewer.quit();
}

#[test]
fn a_model_saved_while_it_loads_is_shown_as_saved() {
    let [quad, sphere] = [glb::quad(1.0), glb::sphere(8, 16)].map(|mesh| glb::model(&mesh, &glb::gray()));
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), &sphere).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb"]);
    viewer.running.event("ready");
    let saved = viewer.screenshot();
    viewer.quit();

    let tree = Tree::new();
    let path = tree.beside("model.glb");
    std::fs::write(&path, &quad).unwrap();
    let mut viewer = Viewer::with_fault(tree, &["model.glb"], "load-delay-ms:3000");
    std::fs::write(&path, &sphere).unwrap();
    viewer.until("the saved model", |shot| *shot == saved);
    viewer.quit();
}

#[test]
fn names_that_do_not_exist_are_told() {
    let wrong = ["--mode", "metal-ness", "--set", "no_such_name=1", "--set", "TOON_BANDS=Nine"];
    let mut viewer = Viewer::open(Tree::new(), &[&["sphere-grid"][..], &wrong].concat());
    viewer.running.event("ready");
    let stderr = viewer.quit();
    for name in ["metal-ness", "no_such_name", "TOON_BANDS"] {
        assert!(stderr.contains(name), "no word of {name} in: {stderr}");
    }
}

#[test]
fn a_window_too_large_is_refused() {
    let (tree, display) = (Tree::new(), Display::new());
    finish(display.view(&tree).args(["--size", "99999x99999"])).expect(2, &["99999x99999"]);
}

#[test]
fn the_environment_is_baked_and_a_damaged_one_costs_nothing() {
    let tree = Tree::new();
    let path = tree.beside("sky.hdr");
    std::fs::write(&path, hdr::uniform([128, 0, 0, 129])).unwrap();
    let mut viewer = Viewer::open(tree, &["sphere-grid", "--env", "sky.hdr", "--lights", "none"]);
    // Without the model, the red environment alone would look like a red model.
    let bake = viewer.ready_and_baked();
    assert_eq!(bake["environment"], "sky", "{bake}");
    viewer.until("a red model", |shot| brightest(shot).is_some_and(|[r, g, _]| r > 60 && g < r / 2));
    let red = viewer.screenshot();
    std::fs::write(&path, b"#?RADIANCE\n").unwrap();
    // A later edit that changes no pixel. Once it is reported, the bad file has been handled.
    let user = viewer.tree.edited("user.glsl", "    return radiance;", "    return radiance * 1.0;");
    viewer.tree.write("user.glsl", &user);
    viewer.running.reload(true);
    assert!(viewer.screenshot() == red, "a damaged file changed the picture");
    std::fs::write(&path, hdr::uniform([0, 128, 0, 129])).unwrap();
    viewer.running.event("bake");
    viewer.until("a green model", |shot| brightest(shot).is_some_and(|[r, g, _]| g > 60 && r < g / 2));
    assert!(viewer.quit().contains("sky.hdr"), "no word of the damaged file");
}

#[test]
fn an_environment_in_a_linked_folder_is_baked_again() {
    let tree = Tree::new();
    std::fs::create_dir(tree.beside("skies")).unwrap();
    std::os::unix::fs::symlink("skies", tree.beside("linked")).unwrap();
    std::fs::write(tree.beside("skies/sky.hdr"), hdr::uniform([128, 0, 0, 129])).unwrap();
    let mut viewer = Viewer::open(tree, &["sphere-grid", "--env", "linked/sky.hdr", "--lights", "none"]);
    viewer.running.event("bake");
    std::fs::write(viewer.tree.beside("skies/sky.hdr"), hdr::uniform([0, 128, 0, 129])).unwrap();
    viewer.running.event("bake");
    viewer.until("a green model", |shot| brightest(shot).is_some_and(|[r, g, _]| g > 60 && r < g / 2));
    viewer.quit();
}

/// The brightest pixel of the model. The background is darker.
fn brightest(shot: &RgbaImage) -> Option<[u8; 3]> {
    shot.pixels().map(|pixel| [pixel[0], pixel[1], pixel[2]]).max_by_key(|rgb| rgb.iter().max().copied())
}
