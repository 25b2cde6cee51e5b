//! Keys that shaders read, while the window is open.

use image::{Rgba, RgbaImage};

use crate::support::Tree;
use crate::support::window::Viewer;

/// The picture is red while A is down, or green after an odd number of spaces, and blue in a frame in which N goes down.
const PASS: &str = "//@pass keys to=picture after=tonemap\n#version 460\n#include \"pass.glsl\"\n\
    void main() { color = vec4(key_down(KEY_A), key_toggled(KEY_SPACE), key_pressed(KEY_N), 1.0); }\n";

fn is(r: u8, g: u8, b: u8) -> impl Fn(&RgbaImage) -> bool {
    move |screen| *screen.get_pixel(20, 400) == Rgba([r, g, b, 255])
}

fn open(pass: &str) -> Viewer {
    let tree = Tree::new();
    tree.write("passes/keys.frag", pass);
    let mut viewer = Viewer::open(tree, &["sphere-grid"]);
    viewer.running.event("ready");
    viewer
}

/// Only the screen is looked at, so nothing but the key itself makes the window draw.
#[test]
fn keys_reach_the_shaders_and_the_window_rests() {
    let viewer = open(PASS);
    viewer.until_screen("black", is(0, 0, 0));
    viewer.display.xdotool(&["keydown", "a"]);
    viewer.until_screen("red, while A is down", is(255, 0, 0));
    viewer.display.xdotool(&["keyup", "a"]);
    viewer.until_screen("black again", is(0, 0, 0));
    viewer.key("space");
    viewer.until_screen("green after a space", is(0, 255, 0));
    viewer.key("space");
    viewer.until_screen("black after two", is(0, 0, 0));
    // A press lasts one frame, after which the window draws once more.
    viewer.key("n");
    viewer.key("space");
    viewer.until_screen("green without blue", is(0, 255, 0));
    viewer.rests();
    viewer.until_screen("green", is(0, 255, 0));
    viewer.quit();
}

/// The letters are the picture's. With Ctrl they are Specula's, as are Escape and the function keys.
#[test]
fn shortcuts_are_told_from_keys_of_the_picture() {
    let mut viewer = open(PASS);
    let black = viewer.screenshot();
    viewer.key("n");
    viewer.key("h");
    // The presses last one frame, which may be that of the first screenshot.
    viewer.screenshot();
    assert!(viewer.screenshot() == black, "n chose a mode, or h hid the panels");
    viewer.key("ctrl+n");
    viewer.until("shading normals", |shot| *shot != black);
    // A debug mode reads no keys, so its letters are Specula's.
    viewer.key("n");
    viewer.until("the picture", |shot| *shot == black);
    viewer.key("ctrl+n");
    viewer.until("shading normals again", |shot| *shot != black);
    viewer.key("Escape");
    viewer.until("the picture again", |shot| *shot == black);
    viewer.quit();
}

#[test]
fn a_window_without_the_focus_has_no_keys() {
    let viewer = open(PASS);
    viewer.display.xdotool(&["keydown", "a"]);
    viewer.until_screen("red, while A is down", is(255, 0, 0));
    viewer.take_focus_away();
    viewer.until_screen("black without the focus", is(0, 0, 0));
    viewer.display.xdotool(&["keyup", "a"]);
    viewer.give_focus();
    viewer.quit();
}

/// A file of Shadertoy: its channel, and the date of today.
#[test]
fn a_toy_reads_the_keyboard_and_the_date() {
    let tree = Tree::new();
    let toy = tree.beside("toy.glsl");
    let text = "#iChannel0 \"keyboard\"\nvoid mainImage(out vec4 c, in vec2 p) {\n    \
        float down = texelFetch(iChannel0, ivec2(39, 0), 0).x;\n    c = vec4(down, iDate.x > 2020.5, 0.0, 1.0);\n}\n";
    std::fs::write(&toy, text).unwrap();
    let path = toy.to_str().unwrap().to_owned();
    let mut viewer = Viewer::open(tree, &["--shaders", &path]);
    viewer.running.event("ready");
    viewer.until_screen("green", is(0, 255, 0));
    viewer.display.xdotool(&["keydown", "Right"]);
    viewer.until_screen("yellow", is(255, 255, 0));
    viewer.display.xdotool(&["keyup", "Right"]);
    viewer.until_screen("green again", is(0, 255, 0));
    viewer.quit();
}
