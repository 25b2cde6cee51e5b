//! The picture is shown whole or not at all: while anything about it changes, the one before stays.

use image::RgbaImage;

use super::NDF;
use super::controls::{choose, count};
use crate::support::window::Viewer;
use crate::support::{Tree, glb};

/// Colors of the status bar's dot, as `src/app/widgets/theme.rs` has them.
const GOOD: [u8; 3] = [112, 201, 130];
const WARNING: [u8; 3] = [255, 196, 92];

/// The environment's light and the pipelines for it change in one step: each screenshot is one of two pictures.
#[test]
fn an_environment_comes_and_goes_in_one_step() {
    let size = ["sphere-grid", "--size", "640x640"];
    let mut unlit = Viewer::open(Tree::new(), &size);
    unlit.running.event("ready");
    let without = unlit.screenshot();
    unlit.quit();

    // The background is the same with and without an environment.
    let lit = [&size[..], &["--env", "furnace", "--background", "#1b1d21"]].concat();
    let mut viewer = Viewer::with_fault(Tree::new(), &lit, "compile-delay-ms:500");
    viewer.ready_and_baked();
    let with = viewer.screenshot();
    assert!(with != without, "the environment gives no light");
    let original = viewer.tree.read(NDF);
    let choices = [("none", &with, &without), ("furnace", &without, &with), ("none", &with, &without)];
    for (step, (environment, before, after)) in choices.into_iter().enumerate() {
        // The new shaders have pipelines for the environment on screen only.
        // The event that is waited for may be that of the key before, so no text comes twice: each brings one of its own.
        let factors = " * 1.0".repeat(step + 1);
        viewer.tree.write(NDF, &original.replace("alpha * alpha;", &format!("alpha * alpha{factors};")));
        viewer.running.reload(true);
        // While the worker compiles the whole tree, it does not get to the pipelines that the choice needs.
        viewer.key("F5");
        choose(&viewer, &format!("environment {environment}"));
        viewer.until("the chosen environment", |shot| {
            assert!(shot == before || shot == after, "a picture that is neither the one before nor the one after");
            shot == after
        });
    }
    viewer.quit();
}

/// While Space is held, the picture is that before the last edit, from the camera of now.
#[test]
fn space_shows_the_picture_before_the_last_edit() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    viewer.display.xdotool(&["keydown", "space"]);
    assert!(viewer.screenshot() == first, "another picture before any edit");
    viewer.display.xdotool(&["keyup", "space"]);

    let original = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &original.replace("float a2 = alpha * alpha;", "float a2 = alpha;"));
    let reload = viewer.running.reload(true);
    // Until then, tables of the BRDF are those from before the edit.
    viewer.running.settled(&reload);
    let edited = viewer.screenshot();
    assert!(edited != first, "the edit does not show");
    viewer.display.xdotool(&["keydown", "space"]);
    viewer.until("the picture before the edit", |shot| *shot == first);
    viewer.display.xdotool(&["keyup", "space"]);
    viewer.until("the edit again", |shot| *shot == edited);
    // A broken edit is none: it has never been shown.
    viewer.tree.write(NDF, &original.replace("alpha * alpha;", "alpha * alfa;"));
    viewer.running.reload(false);
    viewer.display.xdotool(&["keydown", "space"]);
    viewer.until("the picture before the good edit", |shot| *shot == first);
    // Without the focus, the release of the key is not heard.
    viewer.take_focus_away();
    viewer.give_focus();
    viewer.until("the good edit", |shot| *shot == edited);
    viewer.display.xdotool(&["keyup", "space"]);
    viewer.quit();
}

/// A broken edit compiles while the user asks for another mode, with every key that the modes have.
#[test]
fn a_mode_asked_for_during_a_broken_edit_is_shown() {
    let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], "compile-delay-ms:200");
    viewer.running.event("ready");
    let original = viewer.tree.read(NDF);
    let mut last = viewer.screenshot();
    for (number, key) in "cznwbmudgvfktijxp".chars().enumerate() {
        viewer.tree.write(NDF, &original.replace("alpha * alpha;", &format!("alpha * alfa{number};")));
        viewer.key(&key.to_string());
        viewer.running.reload(false);
        viewer.until(&format!("the mode of the key {key}"), |shot| *shot != last);
        last = viewer.screenshot();
    }
    viewer.quit();
}

/// A measured BRDF of one value for all directions, in UTIA's format.
fn measured(value: f32) -> Vec<u8> {
    f64::from(value).to_le_bytes().repeat(3 * 288 * 288)
}

#[test]
fn the_measured_brdf_is_watched_and_a_damaged_one_costs_nothing() {
    let tree = Tree::new();
    let path = tree.beside("matte.bin");
    std::fs::write(&path, measured(0.1)).unwrap();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::sphere(16, 32), &glb::gray())).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb", "--measured", "matte.bin", "--mode", "measured"]);
    viewer.running.event("ready");
    let dark = viewer.screenshot();
    std::fs::write(&path, measured(0.2)).unwrap();
    viewer.until("the new file", |shot| *shot != dark);
    let bright = viewer.screenshot();
    assert!(
        bright.as_raw().iter().zip(dark.as_raw()).all(|(bright, dark)| bright >= dark),
        "twice the reflectance is darker"
    );
    std::fs::write(&path, b"damaged").unwrap();
    viewer.running.until_stderr("matte.bin");
    assert!(viewer.screenshot() == bright, "a damaged file changed the picture");
    std::fs::write(&path, measured(0.1)).unwrap();
    viewer.until("the first file", |shot| *shot == dark);
    viewer.quit();
}

/// The built-in sky has a sun. Its code is compiled when the light with suns is there, and neither a picture without the sun's light
/// nor one with twice its light is shown.
#[test]
fn the_suns_of_an_environment_go_and_come() {
    let size = ["sphere-grid", "--size", "640x640", "--background", "#1b1d21", "--env"];
    let mut viewer = Viewer::open(Tree::new(), &[&size[..], &["studio"]].concat());
    viewer.ready_and_baked();
    let studio = viewer.screenshot();
    choose(&viewer, "environment sky");
    viewer.until("the sky", |shot| *shot != studio);
    let with = viewer.screenshot();
    choose(&viewer, "suns of the map turn off");
    viewer.until("a sun in the prefiltered levels", |shot| *shot != with);
    let without = viewer.screenshot();
    let choices = [("suns of the map turn on", &with), ("environment studio", &studio), ("environment sky", &with)];
    let known = [&studio, &with, &without];
    for (words, after) in choices {
        choose(&viewer, words);
        viewer.until(words, |shot| {
            assert!(known.contains(&shot), "{words}: a picture that is none of the three");
            shot == after
        });
    }
    viewer.quit();
}

/// A slider in the BRDF bakes the light again. Until then the picture has the old light, and the status bar says why.
#[test]
fn the_window_says_that_light_is_baked() {
    let tree = Tree::new();
    let params = tree.read("user/params.glsl");
    let gain = "float bloom_strength;";
    tree.write(
        "user/params.glsl",
        &params.replace(gain, &format!("float gain; //@ui \"Gain\" 0..2 = 1.0\n    {gain}")),
    );
    let ndf = tree.read(NDF).replace("float a2 = alpha * alpha;", "float a2 = gain * alpha * alpha;");
    let include = "#include \"brdf/models.glsl\"";
    tree.write(NDF, &ndf.replace(include, &format!("{include}\n#include \"user/params.glsl\"")));
    let size = ["sphere-grid", "--size", "1000x480", "--env", "studio"];
    let mut viewer = Viewer::with_fault(tree, &size, "bake-delay-ms:2000");
    viewer.ready_and_baked();
    let first = viewer.screenshot();
    // The dot of the status bar, at the lower edge of the window.
    let dot = |screen: &RgbaImage, color: [u8; 3]| count(screen, 0..300, 456..480, color) > 10;
    viewer.until_screen("a tree that is watched", |screen| dot(screen, GOOD));
    choose(&viewer, "gain 0.5");
    viewer.until_screen("light that is baked", |screen| dot(screen, WARNING));
    viewer.until_screen("the end of the bake", |screen| dot(screen, GOOD));
    assert!(viewer.screenshot() != first, "the slider changes nothing");
    viewer.quit();
}
