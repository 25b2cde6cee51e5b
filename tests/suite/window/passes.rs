//! Passes that the tree declares, edited while the window is open.

use serde_json::{Value, json};

use crate::support::window::Viewer;
use crate::support::{Tree, glb};

const PASS: &str = "passes/swap.frag";
const TEXT: &str = "//@pass swap to=picture\n#version 460\n#include \"pass.glsl\"\nuniform sampler2D picture;\n\
    void main() { color = texture(picture, uv).gbra; }\n";

/// Waits until a good reload is on screen with all of its stages. No stage is left for later, and the reload is still reported before it
/// settles.
#[track_caller]
fn shown(viewer: &mut Viewer) -> Value {
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    reload
}

#[test]
fn a_pass_file_comes_breaks_and_goes() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid", "--set", "material.enabled=true"]);
    // No pass of the tree is on, so none delays the first picture.
    let first = viewer.running.event("reload");
    let is_pass = |stage: &Value| stage.as_str().is_some_and(|stage| stage.starts_with("passes/"));
    assert!(!first["stages"].as_array().unwrap().iter().any(is_pass), "{first}");
    viewer.running.event("ready");
    let plain = viewer.screenshot();

    viewer.tree.write(PASS, TEXT);
    let reload = shown(&mut viewer);
    assert_eq!(reload["stages"], json!([PASS]), "{reload}");
    let swapped = viewer.screenshot();
    assert!(swapped != plain, "the new pass does not show");

    viewer.tree.write(PASS, &TEXT.replace("picture, uv", "picture, uw"));
    let diagnostic = viewer.running.event("diagnostic");
    assert!(diagnostic["message"].as_str().is_some_and(|message| message.contains("uw")), "{diagnostic}");
    assert!(diagnostic["file"].as_str().is_some_and(|file| file.ends_with(PASS)), "{diagnostic}");
    assert_eq!(diagnostic["line"], 5, "{diagnostic}");
    viewer.running.reload(false);
    assert!(viewer.screenshot() == swapped, "a broken edit changed the picture");

    std::fs::remove_file(viewer.tree.path(PASS)).unwrap();
    shown(&mut viewer);
    assert!(viewer.screenshot() == plain, "the deleted pass still shows");
    viewer.quit();
}

/// A pass that is off compiles after the first picture, so its name is not known at once.
#[test]
fn a_pass_that_is_still_compiling_is_no_unknown_name() {
    let on = ["sphere-grid", "--set", "passes.ground=true", "--set", "film_grain=0.5", "--mode", "pass:film"];
    let mut viewer = Viewer::open(Tree::new(), &on);
    viewer.running.event("completed");
    let stderr = viewer.quit();
    assert!(!stderr.contains("named") && !stderr.contains("unknown") && !stderr.contains("no mode"), "{stderr}");

    let viewer = Viewer::open(Tree::new(), &["sphere-grid", "--set", "passes.grund=true"]);
    viewer.running.until_stderr("no pass is named `grund`. Did you mean `ground`?");
    viewer.quit();
}

/// A file of Shadertoy, without a tree: edits, broken edits, and a buffer that comes while the window is open.
#[test]
fn a_single_file_is_a_tree() {
    let tree = Tree::new();
    let (toy, buffer) = (tree.beside("toy.glsl"), tree.beside("buffer_a.glsl"));
    let text = "void mainImage(out vec4 c, in vec2 p) { c = 0.5 * texture(iChannel0, p / 64.0); }\n";
    std::fs::write(&toy, text).unwrap();
    let path = toy.to_str().unwrap().to_owned();
    let mut viewer = Viewer::driven(tree, &["sphere-grid", "--shaders", &path]);
    viewer.running.event("ready");
    let noise = viewer.screenshot();

    std::fs::write(&toy, text.replace("0.5", "0.9")).unwrap();
    viewer.running.reload(true);
    let brighter = viewer.screenshot();
    assert!(brighter != noise, "the edit does not show");

    std::fs::write(&toy, text.replace("c = 0.5", "d = 0.5")).unwrap();
    let diagnostic = viewer.running.event("diagnostic");
    assert!(diagnostic["file"].as_str().is_some_and(|file| file == path), "{diagnostic}");
    assert_eq!(diagnostic["line"], 1, "{diagnostic}");
    viewer.running.reload(false);
    assert!(viewer.screenshot() == brighter, "a broken edit changed the picture");

    std::fs::write(&toy, text).unwrap();
    viewer.running.reload(true);
    std::fs::write(&buffer, "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0, 1.0, 0.0, 1.0); }\n").unwrap();
    viewer.running.reload(true);
    let green = viewer.screenshot();
    assert!(green != noise, "the new buffer does not show");

    // The buffer is followed from now on.
    std::fs::write(&buffer, "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0, 0.0, 1.0, 1.0); }\n").unwrap();
    viewer.running.reload(true);
    let blue = viewer.screenshot();
    assert!(blue != green, "the edit of the buffer does not show");
    // The chart, which the toy covers, shows no names of its spheres.
    let pixels = (blue.width() * blue.height()) as usize;
    viewer.until_screen("a picture without names", |screen| {
        screen.pixels().filter(|pixel| *pixel == blue.get_pixel(0, 0)).count() >= pixels
    });
    // The file of the buffer stands for the whole.
    viewer.running.done(json!({ "command": "open", "tree": path }));
    viewer.shows(&blue, "the toy is opened again");
    viewer.quit();
}

/// A model that is opened while a single file is on screen is shown by the shaders of before, or by the built-in ones.
#[test]
fn a_model_leaves_a_single_file_for_the_tree_of_before() {
    let tree = Tree::new();
    tree.write("user.glsl", &tree.edited("user.glsl", "    return radiance;\n}", "    return radiance.bgr;\n}"));
    let (toy, model) = (tree.beside("toy.glsl"), tree.beside("quad.glb"));
    std::fs::write(&toy, "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0, 1.0, 0.0, 1.0); }\n").unwrap();
    std::fs::write(&model, glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    viewer.running.done(json!({ "command": "open", "model": model }));
    let of_tree = viewer.screenshot();
    viewer.running.done(json!({ "command": "open", "tree": toy }));
    viewer.until("the toy", |shot| shot.pixels().all(|pixel| pixel.0[..3] == [0, 255, 0]));
    viewer.running.done(json!({ "command": "open", "model": model }));
    viewer.shows(&of_tree, "the model in the tree of before");
    viewer.running.done(json!({ "command": "run", "entry": "Open the built-in shaders" }));
    viewer.until("the built-in shaders", |shot| *shot != of_tree);
    let of_program = viewer.screenshot();
    viewer.running.done(json!({ "command": "open", "tree": toy }));
    viewer.until("the toy", |shot| shot.pixels().all(|pixel| pixel.0[..3] == [0, 255, 0]));
    viewer.running.done(json!({ "command": "open", "model": model }));
    viewer.shows(&of_program, "the model in the built-in shaders, which were the tree of before");
    assert!(viewer.quit().contains("toy.glsl draws no model. Back to the shaders of"));
}

/// Files that belong to a toy, opened in the window.
#[test]
fn a_buffer_opens_the_toy_that_it_belongs_to() {
    let tree = Tree::new();
    let (image, buffer) = (tree.beside("image.glsl"), tree.beside("buffer_a.glsl"));
    std::fs::write(&image, "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0).bgra; }\n")
        .unwrap();
    std::fs::write(&buffer, "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0, 0.0, 0.0, 1.0); }\n").unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    viewer.running.done(json!({ "command": "open", "file": buffer }));
    viewer.until("the image", |shot| shot.pixels().all(|pixel| pixel.0[..3] == [0, 0, 255]));
    viewer.quit();
}

/// The pause and the speed were those of the toy before.
#[test]
fn a_toy_that_is_opened_after_a_pause_runs() {
    let tree = Tree::new();
    let (first, second) = (tree.beside("first.glsl"), tree.beside("second.glsl"));
    std::fs::write(&first, "void mainImage(out vec4 c, in vec2 p) { c = vec4(fract(iTime), 0.0, 0.0, 1.0); }\n")
        .unwrap();
    std::fs::write(&second, "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0, step(0.001, iTime), 0.0, 1.0); }\n")
        .unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid", "--shaders", first.to_str().unwrap()]);
    viewer.running.event("ready");
    viewer.running.done(json!({ "command": "playback", "paused": true, "speed": 0 }));
    viewer.running.done(json!({ "command": "open", "tree": second }));
    viewer.until("the second toy at a later time", |shot| shot.get_pixel(0, 0).0[..3] == [0, 255, 0]);
    let clock = viewer.running.done(json!({ "command": "playback" }));
    assert_eq!((&clock["paused"], &clock["speed"]), (&json!(false), &json!(1.0)), "{clock}");
    viewer.quit();
}
