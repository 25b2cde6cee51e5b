//! What settings do to the parts of a model: hide and isolate, factors of single materials, channels of all, another place.

use crate::support::process::run;
use crate::support::{
    Renderer, SIZE, assert_differ, assert_same, differing, glb, load, model, render, renderer, settings,
};
use serde_json::json;
use specula::headless::Headless;
use specula::render::Capture;

const DIRECT: [&str; 3] = ["environment.name=none", "view.msaa=1", "view.background=none"];

/// A red box at the left, a green one at the right, seen from the front.
fn boxes(more: &[&str]) -> Renderer {
    let material = |name: &str, color: [f32; 4]| json!({ "name": name, "pbrMetallicRoughness": { "baseColorFactor": color, "metallicFactor": 0.0 } });
    let bytes = glb::scene(&[
        (glb::cuboid([-2.0, -1.0, -1.0], [-0.5, 1.0, 1.0], true), material("Red", [1.0, 0.0, 0.0, 1.0])),
        (glb::cuboid([0.5, -1.0, -1.0], [2.0, 1.0, 1.0], true), material("Green paint", [0.0, 1.0, 0.0, 1.0])),
    ]);
    let camera = ["camera.eye=[0, 0, 8]", "camera.target=[0, 0, 0]"];
    renderer(load(&bytes), settings(&[&DIRECT, &camera[..], more].concat()), SIZE)
}

fn set(headless: &mut Headless, assignment: &str) {
    headless.settings_mut().assign(assignment).unwrap();
}

/// Which pixels are covered in the left and in the right half.
fn covered(capture: &Capture) -> [usize; 2] {
    let is_covered = |at: usize| capture.raw[at][3] > 0.0;
    let width = capture.width as usize;
    let count =
        |left: bool| (0..capture.raw.len()).filter(|at| (at % width < width / 2) == left && is_covered(*at)).count();
    [count(true), count(false)]
}

#[test]
fn hidden_parts_are_not_drawn_and_isolated_ones_alone_are() {
    let mut headless = boxes(&[]);
    let whole = render(&mut headless, "final");
    let [left, right] = covered(&whole);
    assert!(left > 100 && right > 100, "{left} {right}");
    for (assignment, expected) in [
        ("scene.hidden=#0", [0, right]),
        ("scene.hidden=#0,#1", [0, 0]),
        ("scene.hidden=[]", [left, right]),
        ("scene.isolated=#0", [left, 0]),
        ("scene.hidden=#0", [0, 0]),
    ] {
        set(&mut headless, assignment);
        assert_eq!(covered(&render(&mut headless, "final")), expected, "{assignment}");
    }
    // The framing stays, and everything comes back.
    set(&mut headless, "scene.hidden=[]");
    set(&mut headless, "scene.isolated=[]");
    assert_same(&whole, &render(&mut headless, "final"), "everything is shown again");
}

#[test]
fn a_factor_of_one_material_changes_its_pixels_alone() {
    let mut headless = boxes(&[]);
    let (before, colors) = (render(&mut headless, "final"), render(&mut headless, "base-color"));
    set(&mut headless, "materials.Green paint.base_color=0, 0, 1");
    let after = render(&mut headless, "final");
    assert_differ(&before, &after, "the green box is blue");
    for (at, (a, b)) in before.raw.iter().zip(&after.raw).enumerate() {
        assert!(a == b || colors.raw[at][1] == 1.0, "pixel {at} of another material changes");
    }
    set(&mut headless, "materials.Green paint.roughness=0.1");
    let rough = render(&mut headless, "roughness");
    let of_green = rough.raw.iter().zip(&colors.raw).filter(|(_, color)| color[1] == 1.0);
    assert!(of_green.clone().count() > 100 && of_green.clone().all(|(value, _)| (value[0] - 0.1).abs() < 1e-5));
    headless.settings_mut().materials.clear();
    assert_same(&before, &render(&mut headless, "final"), "reset");
}

#[test]
fn one_channel_of_all_materials_is_replaced_and_the_others_stay() {
    let mut headless = renderer(model("shader-ball"), settings(&DIRECT), SIZE);
    let metallic = render(&mut headless, "metallic");
    let normals = render(&mut headless, "shading-normal");
    let values = |capture: &Capture| -> Vec<f32> {
        capture.raw.iter().filter(|value| value[3] == 1.0).map(|value| value[0]).collect()
    };
    let spread = |values: &[f32]| values.iter().any(|value| (value - values[0]).abs() > 0.05);
    assert!(spread(&values(&metallic)) && spread(&values(&render(&mut headless, "roughness"))), "nothing to replace");
    set(&mut headless, "material.override=roughness");
    set(&mut headless, "material.roughness=0.25");
    let rough = values(&render(&mut headless, "roughness"));
    assert!(rough.len() > 300 && rough.iter().all(|value| (value - 0.25).abs() < 1e-5), "{rough:?}");
    assert_same(&metallic, &render(&mut headless, "metallic"), "metallic stays");
    assert_same(&normals, &render(&mut headless, "shading-normal"), "normals stay");
    // An old look file replaces all.
    set(&mut headless, "material.enabled=true");
    let all = values(&render(&mut headless, "metallic"));
    assert!(all.iter().all(|value| *value == 0.0));
}

/// A box whose node the file moves, or the settings.
fn moved(node: serde_json::Value, more: &[&str]) -> Renderer {
    let gray = glb::gray();
    let (mut json, bin) = glb::document(&glb::cuboid([-1.0, -0.5, -0.25], [1.0, 0.5, 0.25], true), &gray);
    json["nodes"][0] = node;
    json["nodes"][0]["mesh"] = json!(0);
    let ground = ["passes.ground=true", "SHADOWS=Hard", "lights.rect.enabled=true"];
    renderer(load(&glb::container(&json, &bin)), settings(&[&DIRECT, &ground[..], more].concat()), SIZE)
}

#[test]
fn a_transform_is_the_same_as_a_moved_model() {
    let camera = ["camera.eye=[3, 5, 12]", "camera.target=[1, 2, 3]"];
    let mut of_file = moved(json!({ "translation": [1.0, 2.0, 3.0], "scale": [2.0, 2.0, 2.0] }), &camera);
    let mut of_settings = moved(json!({}), &camera);
    let as_it_was = render(&mut of_settings, "final");
    set(&mut of_settings, "model.translation=[1, 2, 3]");
    set(&mut of_settings, "model.scale=2");
    let (a, b) = (render(&mut of_file, "final"), render(&mut of_settings, "final"));
    assert_same(&a, &b, "moved and scaled");
    assert_differ(&a, &as_it_was, "the model has not moved");

    // Framed by itself; the rotation is computed in another way.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mut of_file = moved(json!({ "rotation": [0.0, half, 0.0, half] }), &[]);
    let mut of_settings = moved(json!({}), &["model.rotation=[0, 90, 0]"]);
    let (a, b) = (render(&mut of_file, "final"), render(&mut of_settings, "final"));
    let count = differing(&a, &b);
    assert!(count < 60, "{count} pixels differ");
    assert_differ(&a, &render(&mut moved(json!({}), &[]), "final"), "the model has not turned");
}

#[test]
fn unknown_parts_and_materials_are_told_with_those_that_exist() {
    let directory = tempfile::tempdir().unwrap();
    let render = |set: &str| {
        let args = ["render", "shader-ball", "--env", "none", "--size", "48x32", "--set", set, "--out", "out.png"];
        run(directory.path(), &args)
    };
    render("scene.hidden=Nothing at all").expect(2, &["scene.hidden", "no node and no primitive 'Nothing at all'"]);
    render("materials.Nickel.roughness=0.5").expect(2, &["no material 'Nickel'", "It has "]);
    render("materials.Nickel.roughness=2").expect(2, &["it can be 0 to 1"]);
    assert!(!directory.path().join("out.png").exists());
}
