//! Cameras of a model's file: their place, roll and projection, their names on the command line, and looks that name parts which another
//! model lacks.

use crate::support::process::run;
use crate::support::{Renderer, SIZE, Tree, assert_same, glb, load, render, renderer, settings};
use serde_json::{Value, json};
use specula::render::Capture;

const PLAIN: [&str; 4] = ["environment.name=none", "lights.source=none", "view.msaa=1", "view.background=none"];

/// Cubes with an edge of 1 m at the left in the plane z = 0 and at the right 4 m farther away, and a bar below them.
fn file() -> Vec<u8> {
    let material = |name: &str| json!({ "name": name, "pbrMetallicRoughness": { "metallicFactor": 0.0 } });
    let bytes = glb::scene(&[
        (glb::cuboid([-1.5, -0.5, -1.0], [-0.5, 0.5, 0.0], true), material("Near")),
        (glb::cuboid([0.5, -0.5, -5.0], [1.5, 0.5, -4.0], true), material("Far")),
    ]);
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut json: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let bin = &bytes[20 + length + 8..];
    json["cameras"] = json!([
        { "name": "Plan", "type": "orthographic", "orthographic": { "xmag": 3, "ymag": 2, "znear": 0.1, "zfar": 100 } },
        { "name": "Rolled", "type": "perspective", "perspective": { "yfov": 0.6, "znear": 0.1 } },
    ]);
    let half = 0.5_f64.sqrt();
    let nodes = json["nodes"].as_array_mut().unwrap();
    nodes.push(json!({ "camera": 0, "translation": [0, 0, 6] }));
    // Turned by 90 degrees about its view direction: +X is up in the picture.
    nodes.push(json!({ "camera": 1, "translation": [0, 0, 10], "rotation": [0, 0, -half, half] }));
    json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    glb::container(&json, bin)
}

fn seen(more: &[&str]) -> Renderer {
    renderer(load(&file()), settings(&[&PLAIN, more].concat()), SIZE)
}

/// The covered pixels of a picture as columns and rows.
fn covered(capture: &Capture) -> Vec<(usize, usize)> {
    let width = capture.width as usize;
    let is_covered = |at: &usize| capture.raw[*at][3] > 0.0;
    (0..capture.raw.len()).filter(is_covered).map(|at| (at % width, at / width)).collect()
}

#[test]
fn an_orthographic_camera_shows_equal_sizes_at_all_depths() {
    // 64 rows are 4 m, so a cube covers 16 x 16 pixels.
    let sizes = |capture: &Capture| {
        let (left, right): (Vec<_>, Vec<_>) = covered(capture).into_iter().partition(|(x, _)| *x < 48);
        [left.len(), right.len()]
    };
    let of_file = render(&mut seen(&["camera.name=Plan"]), "final");
    let places = covered(&of_file);
    assert!(sizes(&of_file).iter().all(|size| size.abs_diff(256) <= 16), "{:?}", sizes(&of_file));
    assert!(places.iter().all(|(x, y)| (24..=40).contains(y) && ((23..=41).contains(x) || (55..=73).contains(x))));
    let of_settings = ["camera.eye=[0, 0, 6]", "camera.target=[0, 0, 0]", "camera.height=4"];
    assert!(sizes(&render(&mut seen(&of_settings), "final")).iter().all(|size| size.abs_diff(256) <= 16));
    let [near, far] = sizes(&render(&mut seen(&of_settings[..2]), "final"));
    assert!(near > far + 50, "the perspective: {near} and {far}");
}

#[test]
fn a_camera_keeps_its_roll() {
    let rows = |more: &[&str]| {
        let places = covered(&render(&mut seen(more), "final"));
        let extent = |of: fn(&(usize, usize)) -> usize| {
            places.iter().map(of).max().unwrap() - places.iter().map(of).min().unwrap()
        };
        (extent(|place| place.0), extent(|place| place.1))
    };
    let (width, height) = rows(&["camera.name=Rolled"]);
    assert!(height > 2 * width, "{width}x{height}: the left and the right cube are one above the other");
    let up = ["camera.eye=[0, 0, 10]", "camera.target=[0, 0, 0]", "camera.up=[1, 0, 0]", "camera.fovy=34.377"];
    assert_eq!(rows(&up), (width, height));
    let (width, height) = rows(&[&up[..2], &up[3..]].concat());
    assert!(width > 2 * height, "{width}x{height}");
}

#[test]
fn cameras_are_named_on_the_command_line_and_lacking_ones_are_told() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("m.glb"), file()).unwrap();
    let render = |model: &str, more: &[&str]| {
        let first = ["render", model, "--env", "none", "--size", "48x32", "--out"];
        run(directory.path(), &[&first, more].concat())
    };
    render("m.glb", &["name.png", "--camera", "Plan"]).expect(0, &[]);
    render("m.glb", &["number.png", "--camera", "#0"]).expect(0, &[]);
    render("m.glb", &["set.png", "--set", "camera.name=Plan"]).expect(0, &[]);
    let pixels = |name: &str| image::open(directory.path().join(name)).unwrap().into_rgba8();
    assert!(pixels("name.png") == pixels("number.png") && pixels("name.png") == pixels("set.png"));
    render("m.glb", &["a.png", "--camera", "Plann"])
        .expect(2, &["the model has no camera 'Plann'. Did you mean", "It has Plan, Rolled"]);
    render("m.glb", &["a.png", "--camera", "Plan", "--fovy", "30"]).expect(2, &["--fovy"]);
    render("sphere-grid", &["a.png", "--camera", "#0"]).expect(2, &["no camera '#0'", "It has none"]);
}

/// A look that was made with one model shows another one in the same light, and says what is left out.
#[test]
fn a_look_fits_another_model() {
    let directory = tempfile::tempdir().unwrap();
    let look = "variant = \"Night\"\n[camera]\nname = \"Shot\"\neye = [0.0, 0.0, 900.0]\ntarget = [0.0, 0.0, 890.0]\n\
                [scene]\nhidden = [\"Visor\"]\nisolated = [\"Hose\"]\n[materials.Rubber]\nroughness = 0.5\n\
                [view]\ntonemap = \"agx\"\n";
    std::fs::write(directory.path().join("look.toml"), look).unwrap();
    let render = |more: &[&str]| {
        let first = ["render", "sphere-grid", "--env", "none", "--size", "48x32", "--background", "none", "--out"];
        run(directory.path(), &[&first, more].concat())
    };
    let told = ["no variant 'Night'", "no camera 'Shot'", "no node and no primitive 'Visor'", "no material 'Rubber'"];
    let parts = [&told[..], &["This part of the look is left out"]].concat();
    render(&["far.png", "--look", "look.toml"]).expect(0, &parts);
    render(&["framed.png", "--look", "look.toml", "--frame-model"])
        .expect(0, &["no variant 'Night'", "no material 'Rubber'"]);
    render(&["plain.png", "--set", "camera.azimuth=0", "--set", "camera.elevation=0", "--tonemap", "agx"])
        .expect(0, &[]);
    let pixels = |name: &str| image::open(directory.path().join(name)).unwrap().into_rgba8();
    let count = |name: &str| pixels(name).pixels().filter(|pixel| pixel.0[3] > 0).count();
    assert!(count("far.png") < 20 && count("framed.png") > 300, "{} {}", count("far.png"), count("framed.png"));
    assert!(pixels("framed.png") == pixels("plain.png"), "framed from the side that the look has");
    // What the command line itself names must be there.
    render(&["a.png", "--look", "look.toml", "--set", "scene.hidden=Visors"]).expect(2, &["'Visors'"]);
    render(&["a.png", "--look", "look.toml", "--set", "variant=Day"]).expect(2, &["no variant 'Day'"]);
}

#[test]
fn a_model_at_the_end_of_the_world_looks_like_one_at_the_origin() {
    let at = |translation: Value| {
        let (mut json, bin) = glb::document(&glb::sphere(24, 48), &glb::gray());
        json["nodes"][0]["translation"] = translation;
        renderer(load(&glb::container(&json, &bin)), settings(&PLAIN), SIZE)
    };
    let near = render(&mut at(json!([0, 0, 0])), "shading-normal");
    let far = render(&mut at(json!([1e6, 1e6, 1e6])), "shading-normal");
    assert_same(&near, &far, "the same pixels");
}

#[test]
fn a_picture_without_the_model_says_why() {
    let tree = Tree::new();
    let here = tree.beside("");
    let before = |background: &str, more: &[&str]| {
        let first =
            ["render", "sphere-grid", "--env", "none", "--size", "48x32", "--background", background, "--out", "a.png"];
        run(&here, &[&first, more].concat())
    };
    let render = |more: &[&str]| before("none", more);
    let note = "nothing of the model is in the picture";
    assert!(!render(&[]).expect(0, &[]).stderr.contains(note));
    render(&["--eye", "0,0,9", "--target", "0,0,99"]).expect(0, &[note, "the camera looks past it"]);
    render(&["--set", "scene.isolated=#0", "--set", "scene.hidden=#0"])
        .expect(0, &[note, "all of its parts are hidden"]);
    let hook = "void user_vertex(inout Vertex vertex) {";
    let lost = format!("{hook}\n    vertex.position *= sqrt(-1.0 - abs(vertex.position.x));");
    tree.write("user/vertex.glsl", &tree.edited("user/vertex.glsl", hook, &lost));
    render(&[]).expect(0, &[note, "make them NaN (`user_vertex`)"]);
    // Also before a color.
    before("#1b1d21", &[]).expect(0, &[note, "make them NaN (`user_vertex`)"]);
}
