//! Models of many draws: one command for many of them looks as one command for each, and what the camera does not see is left out, never
//! what it sees.

use std::fs;
use std::path::Path;

use crate::support::process::{finish, specula};
use crate::support::{Session, assert_differ, assert_same, glb, load, ready, settings};
use serde_json::{Value, json};
use specula::scene::Model;

/// Number of nodes along each axis of a grid of many draws.
const SIDE: usize = 7;

/// A grid of quads and boxes with opaque, masked, blended, double-sided and transmissive materials; every third node mirrors its mesh.
fn grid(side: usize) -> Vec<u8> {
    let material = |color: [f64; 4], more: Value| {
        let mut material = json!({ "pbrMetallicRoughness": { "baseColorFactor": color, "roughnessFactor": 0.4 } });
        more.as_object().into_iter().flatten().for_each(|(key, value)| material[key] = value.clone());
        material
    };
    let transmission = json!({ "KHR_materials_transmission": { "transmissionFactor": 0.8 },
        "KHR_materials_volume": { "thicknessFactor": 0.5, "attenuationDistance": 1.0, "attenuationColor": [0.5, 1, 1] } });
    let materials = [
        material([0.8, 0.2, 0.1, 1.0], json!({})),
        material([0.1, 0.3, 0.8, 1.0], json!({ "alphaMode": "MASK" })),
        material([0.2, 0.8, 0.1, 0.5], json!({ "alphaMode": "BLEND", "doubleSided": true })),
        material([0.9, 0.8, 0.1, 0.4], json!({ "alphaMode": "BLEND" })),
        material([1.0, 1.0, 1.0, 1.0], json!({ "extensions": transmission })),
        material([0.5, 0.5, 0.5, 1.0], json!({ "doubleSided": true })),
    ];
    let meshes = materials.map(|material| (glb::cuboid([-0.2; 3], [0.2, 0.3, 0.1], true), material));
    let (mut json, bin) = glb::parts(&glb::scene(&meshes));
    let node = |index: usize| {
        let at = [index % side, index / side % side, index / side / side].map(|cell| cell as f64 - (side / 2) as f64);
        let mirror = if index.is_multiple_of(3) { -1.0 } else { 1.0 };
        let turn = (index as f64 * 0.1).sin_cos();
        json!({ "mesh": index * 5 % meshes.len(), "translation": at, "scale": [mirror, 0.7, 1.3], "rotation": [0.0, turn.0, 0.0, turn.1] })
    };
    let nodes: Vec<Value> = (0..side.pow(3)).map(node).collect();
    json["scenes"] = json!([{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }]);
    json["nodes"] = json!(nodes);
    json["extensionsUsed"] = json!(["KHR_materials_transmission", "KHR_materials_volume"]);
    glb::container(&json, &bin)
}

/// Renders modes of a model as files, with faults that choose how it is drawn. Returns the files.
fn files(folder: &Path, model: &str, fault: &str) -> Vec<Vec<u8>> {
    let modes = "final,node-id,geometric-normal";
    let mut command = specula(folder);
    command.args(["render", model, "--mode", modes, "--out", "a.exr", "--size", "96x72", "--env", "studio"]);
    command.args(["--set", "environment.intensity=1", "--set", "view.blend_layers=3"]);
    command.arg("--validate").env("SPECULA_FAULT", fault);
    finish(&mut command).expect(0, &[]);
    modes.split(',').map(|mode| fs::read(folder.join(format!("a.{mode}.exr"))).unwrap()).collect()
}

#[test]
fn draws_by_index_look_as_draws_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("grid.glb"), grid(SIDE)).unwrap();
    let single = files(folder.path(), "grid.glb", "draws-by-index:100000");
    for fault in ["draws-by-index:1", "draws-by-index:1,single-draws:1"] {
        let by_index = files(folder.path(), "grid.glb", fault);
        assert!(by_index == single, "{fault}");
    }
}

/// A session that is looking at a model from `eye`.
fn looking(model: Model, eye: &str, target: &str, more: &[&str]) -> Session {
    let (eye, target) = (format!("camera.eye={eye}"), format!("camera.target={target}"));
    let plain = ["view.msaa=1", "environment.name=none", "view.background=none", &eye, &target];
    Session::new(model, settings(&[&plain, more].concat()))
}

#[test]
fn what_the_camera_sees_is_never_left_out() {
    let models = [SIDE, 3].map(|side| load(&grid(side)));
    let mut session = looking(models[0].clone(), "[0.4, 0.2, 0.3]", "[3, 0.5, 1]", &[]);
    // Into the grid, past its corner, past its side from afar, and without perspective.
    let views = [
        ["camera.eye=[0.4, 0.2, 0.3]", "camera.target=[3, 0.5, 1]", "camera.height=0"],
        ["camera.eye=[-3.4, -3.1, -3.2]", "camera.target=[-9, -7, -4]", "camera.height=0"],
        ["camera.eye=[0, 2, 9]", "camera.target=[5, 2, 0]", "camera.height=0"],
        ["camera.eye=[0.5, 0.5, 2.5]", "camera.target=[0.5, 0.5, -5]", "camera.height=1.5"],
    ];
    let look = |session: &mut Session| {
        let mut pictures = Vec::new();
        for model in &models {
            session.headless.set_model(model.clone()).unwrap();
            for view in &views {
                view.iter().for_each(|assignment| session.set(assignment));
                let picture = session.render();
                pictures.push((picture, session.headless.draw_counts().draws));
            }
        }
        pictures
    };
    let seen = look(&mut session);
    assert_differ(&seen[0].0, &seen[3].0, "the views");
    // Specula cannot know where another vertex stage moves the vertices, so nothing is left out.
    ready(&session.edit("pbr.vert", "gl_PointSize = 4.0", "gl_PointSize = 5.0"));
    for ((picture, draws), (whole, all)) in seen.iter().zip(&look(&mut session)) {
        assert_same(picture, whole, &format!("{draws} of {all} draws"));
        assert!(draws < all, "{draws} of {all} draws");
    }
}

#[test]
fn vertices_that_a_hook_moves_into_the_frame_are_drawn() {
    let quad = load(&glb::model(&glb::quad(0.5), &glb::gray()));
    let mut session = looking(quad, "[3, 0, 3]", "[3, 0, 0]", &[]);
    let empty = session.render();
    // Farther away as well, since the near plane lies before the model as it was loaded.
    let hook = "void user_vertex(inout Vertex vertex) {\n";
    ready(&session.edit("user/vertex.glsl", hook, &format!("{hook}    vertex.position += vec3(3.0, 0.0, -1.0);\n")));
    assert_differ(&empty, &session.render(), "the moved quad");
}
