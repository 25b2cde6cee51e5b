//! Nodes that a clip shows and hides: pictures are those of files in which they are there or not.

use std::fs;
use std::path::Path;

use crate::support::process::{finish, run, specula};
use crate::support::{Session, assert_differ, assert_same, glb, load, settings};
use serde_json::{Value, json};
use specula::scene::Model;

/// The left and the right half of a picture of a wall, seen from the front.
const PLAIN: [&str; 6] = [
    "view.msaa=1",
    "environment.name=none",
    "camera.eye=[0, 0, 8]",
    "camera.target=[0, 0, 0]",
    "camera.height=4",
    "SHADOWS=Hard",
];

/// Squares before a wall: left with a small one above, which is below it in the hierarchy, and right with a light.
fn document() -> (Value, Vec<u8>) {
    let (mut json, bin) = glb::document(&glb::quad(0.5), &glb::gray());
    json["nodes"] = json!([
        { "mesh": 0, "translation": [-1, 0, 0], "children": [2] },
        { "mesh": 0, "translation": [1, 0, 0], "children": [4] },
        { "mesh": 0, "translation": [0, 1, 0], "scale": [0.5, 0.5, 1] },
        { "mesh": 0, "translation": [0, 0, -1], "scale": [8, 8, 1] },
        { "translation": [0, 0, 2], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
    ]);
    json["scenes"][0]["nodes"] = json!([0, 1, 3]);
    json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{ "type": "point", "intensity": 30 }]);
    (json, bin)
}

/// The file with a clip that, at 1 s, hides the left square and shows the right one, which is hidden by default.
fn switching() -> Vec<u8> {
    let (mut json, mut bin) = document();
    json["nodes"][1]["extensions"] = json!({ "KHR_node_visibility": { "visible": false } });
    let mut accessor = |component: u32, count: usize, bytes: &[u8]| {
        bin.resize(bin.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() });
        bin.extend(bytes);
        let views = json["bufferViews"].as_array_mut().unwrap();
        views.push(view);
        let view = views.len() - 1;
        let all = json["accessors"].as_array_mut().unwrap();
        all.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": "SCALAR" }));
        all.len() - 1
    };
    let times: Vec<u8> = [0.0_f32, 1.0, 2.0].iter().flat_map(|time| time.to_le_bytes()).collect();
    let (input, left, right) =
        (accessor(5126, 3, &times), accessor(5121, 3, &[1, 0, 0]), accessor(5121, 3, &[0, 1, 1]));
    let channel = |node: usize| {
        let pointer = format!("/nodes/{node}/extensions/KHR_node_visibility/visible");
        let target = json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } });
        json!({ "sampler": node, "target": target })
    };
    let sampler = |output: usize| json!({ "input": input, "output": output, "interpolation": "STEP" });
    json["animations"] = json!([{
        "name": "switch", "channels": [channel(0), channel(1)], "samplers": [sampler(left), sampler(right)],
    }]);
    json["extensionsUsed"] = json!(["KHR_animation_pointer", "KHR_node_visibility", "KHR_lights_punctual"]);
    json["buffers"][0]["byteLength"] = json!(bin.len());
    glb::container(&json, &bin)
}

/// The file without the meshes and lights of these nodes.
fn without(nodes: &[usize]) -> Vec<u8> {
    let (mut json, bin) = document();
    for node in nodes {
        let node = json["nodes"][*node].as_object_mut().unwrap();
        node.remove("mesh");
        node.remove("extensions");
    }
    glb::container(&json, &bin)
}

const LEFT: [usize; 2] = [0, 2];
const RIGHT: [usize; 2] = [1, 4];

fn session(model: Model, more: &[&str]) -> Session {
    Session::new(model, settings(&[&PLAIN, more].concat()))
}

#[test]
fn a_clip_shows_and_hides_nodes() {
    let mut moving = session(load(&switching()), &["view.frames=1"]);
    let mut still = session(load(&without(&RIGHT)), &["view.frames=1"]);
    let mut pictures = Vec::new();
    for (time, hidden) in [("0.5", RIGHT), ("1.5", LEFT), ("0", RIGHT)] {
        moving.set(&format!("animation.time={time}"));
        still.headless.set_model(load(&without(&hidden))).unwrap();
        for mode in ["final", "node-id", "depth", "path-traced"] {
            let picture = moving.mode(mode);
            assert_same(&still.mode(mode), &picture, &format!("{mode} at {time} s"));
            pictures.push(picture);
        }
    }
    assert_differ(&pictures[1], &pictures[4 + 1], "both times");
    // What the settings hide stays hidden.
    moving.set("animation.time=1.5");
    moving.set("scene.hidden=[\"#1\"]");
    let hidden = moving.mode("node-id");
    assert_differ(&pictures[4 + 1], &hidden, "hidden by the settings");
    still.headless.set_model(load(&without(&LEFT))).unwrap();
    still.set("scene.hidden=[\"#1\"]");
    assert_same(&still.mode("node-id"), &hidden, "hidden by the settings");
}

#[test]
fn a_light_shines_while_its_node_is_shown() {
    let source = ["lights.source=model"];
    let mut moving = session(load(&switching()), &source);
    let mut still = session(load(&without(&LEFT)), &source);
    moving.set("animation.time=1.5");
    let lit = moving.render();
    assert_same(&still.render(), &lit, "the light is shown");
    moving.set("animation.time=0.5");
    let dark = moving.render();
    assert_differ(&lit, &dark, "the light is hidden");
    still.headless.set_model(load(&without(&RIGHT))).unwrap();
    assert_same(&still.render(), &dark, "a hidden light is as none");
}

/// A picture that the program makes of a file, drawn as `fault` chooses.
fn drawn(folder: &Path, file: &str, time: &str, fault: &str) -> Vec<u8> {
    let mut command = specula(folder);
    command.args(["render", file, "--out", "a.exr", "--size", "96x72", "--env", "none", "--time", time]);
    command.args(["--eye", "0,0,8", "--target", "0,0,0", "--validate"]).env("SPECULA_FAULT", fault);
    finish(&mut command).expect(0, &[]);
    fs::read(folder.join("a.exr")).unwrap()
}

#[test]
fn draws_by_index_leave_out_what_a_clip_hides_and_info_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("switching.glb", &switching());
    write("left.glb", &without(&RIGHT));
    write("right.glb", &without(&LEFT));
    for fault in ["draws-by-index:100000", "draws-by-index:1"] {
        let [left, right] = ["left.glb", "right.glb"].map(|file| drawn(folder.path(), file, "0", fault));
        assert!(left != right);
        let [before, after] = ["0.5", "1.5"].map(|time| drawn(folder.path(), "switching.glb", time, fault));
        assert!(before == left, "{fault}: before it switches");
        assert!(after == right, "{fault}: after it has switched");
    }
    let info = run(folder.path(), &["info", "switching.glb"]);
    info.expect(0, &[]);
    for line in
        ["nodes       5, 1 hidden until an animation shows it", "switch: 2.000 s, 2 channels, shows and hides 2 nodes"]
    {
        assert!(info.stdout.contains(line), "no {line}: {}", info.stdout);
    }
    let json = run(folder.path(), &["info", "switching.glb", "--json"]).expect(0, &[]).json();
    assert_eq!(json["model"]["hidden_nodes"], json!({ "switched": 1, "left_out": 0 }));
    assert_eq!(json["model"]["motion"]["clips"][0]["switched_nodes"], 2);
}
