//! Vertices that joints and morph targets move on the device: against the same in f64, edits of the stage, velocity, shadows.

use crate::support::{
    SIZE, Session, assert_differ, assert_same, assert_validated, failed, glb, lines, load, ready, settings,
};
use glam::{DMat3, DMat4, DQuat, DVec3};
use serde_json::{Value, json};
use specula::headless::Sequence;
use specula::render::Capture;
use specula::scene::Model;

/// A picture of 6 m by 4 m, lit from the camera.
const PLAIN: [&str; 6] = [
    "view.msaa=1",
    "view.background=none",
    "environment.name=none",
    "camera.eye=[0, 0, 8]",
    "camera.target=[0, 0, 0]",
    "camera.height=4",
];
const WEIGHTS: [f64; 2] = [0.3, 0.7];
/// Shows how far the surface has moved.
const SHOW: &str = "//@pass show to=picture\n#version 460\n#include \"pass.glsl\"\nuniform sampler2D velocity;\n\
    void main() { color = vec4(texture(velocity, uv).rg, 0.0, 1.0); }\n";

/// A document with accessors of a test.
struct Document {
    json: Value,
    bin: Vec<u8>,
}

impl Document {
    fn new(mesh: &glb::Mesh) -> Self {
        let (json, bin) = glb::document(mesh, &glb::gray());
        Self { json, bin }
    }

    /// Adds an accessor of floats. Returns its index.
    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let components = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => panic!("{kind}"),
        };
        self.accessor(kind, 5126, values.len() / components, &bytes)
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = json!({ "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len() });
        self.bin.extend(bytes);
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(view);
        let view = views.len() - 1;
        let all = self.json["accessors"].as_array_mut().unwrap();
        all.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        all.len() - 1
    }

    /// Adds morph targets, of which the first is twice the second.
    fn morph(&mut self, mesh: &glb::Mesh) {
        let targets: Vec<Value> = [2.0, 1.0]
            .map(|factor| {
                let moved = mesh.positions.iter().map(|p| displacement(*p).map(|d| d.map(|d| (factor * d) as f32)));
                let (positions, normals): (Vec<_>, Vec<_>) = moved.map(|[p, n]| (p, n)).unzip();
                let position = self.floats("VEC3", positions.as_flattened());
                json!({ "POSITION": position, "NORMAL": self.floats("VEC3", normals.as_flattened()) })
            })
            .into();
        self.json["meshes"][0]["primitives"][0]["targets"] = json!(targets);
        self.json["meshes"][0]["weights"] = json!(WEIGHTS);
    }

    /// Adds a skin of three joints.
    fn skin(&mut self, mesh: &glb::Mesh) {
        let indices: Vec<u8> = mesh.positions.iter().flat_map(|_| [0, 1, 2, 0]).collect();
        let weights: Vec<f32> = mesh.positions.iter().flat_map(|p| weights(*p)).map(|w| w as f32).collect();
        let joints = self.accessor("VEC4", 5121, mesh.positions.len(), &indices);
        let weights = self.floats("VEC4", &weights);
        let attributes = &mut self.json["meshes"][0]["primitives"][0]["attributes"];
        (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
        self.json["skins"] = json!([{ "joints": [1, 2, 3] }]);
        self.json["nodes"][0]["skin"] = json!(0);
        for (scale, rotation, translation) in joints_at_rest() {
            let node = json!({ "scale": scale.to_array(), "rotation": rotation.to_array(),
                "translation": translation.to_array() });
            self.json["nodes"].as_array_mut().unwrap().push(node);
        }
        self.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    }

    /// Adds a clip of 10 s with these channels: node, property, type, values at both ends.
    fn clip(&mut self, channels: &[(usize, &str, &str, Vec<f32>)]) {
        let input = self.floats("SCALAR", &[0.0, 10.0]);
        let outputs: Vec<usize> = channels.iter().map(|(_, _, kind, values)| self.floats(kind, values)).collect();
        let samplers = outputs.iter().map(|output| json!({ "input": input, "output": output }));
        let targets = channels
            .iter()
            .enumerate()
            .map(|(index, (node, path, ..))| json!({ "sampler": index, "target": { "node": node, "path": path } }));
        self.json["animations"] =
            json!([{ "samplers": samplers.collect::<Vec<_>>(), "channels": targets.collect::<Vec<_>>() }]);
    }

    fn load(mut self) -> Model {
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        load(&glb::container(&self.json, &self.bin))
    }
}

/// What the second target adds to a position and to its normal.
fn displacement([x, y, z]: [f32; 3]) -> [[f64; 3]; 2] {
    let [x, y, z] = [x, y, z].map(f64::from);
    [[0.1 * y, 0.05 * x * x, -0.15 * z], [0.05 * x, 0.1, 0.0]]
}

fn weights([_, y, _]: [f32; 3]) -> [f64; 4] {
    let up = 0.5 + 0.5 * f64::from(y);
    [1.0 - up, 0.5 * up, 0.5 * up, 0.0]
}

fn joints_at_rest() -> [(DVec3, DQuat, DVec3); 3] {
    [
        (DVec3::ONE, DQuat::IDENTITY, DVec3::new(0.1, -0.2, 0.0)),
        (DVec3::new(1.0, 1.4, 0.7), DQuat::from_rotation_z(0.6), DVec3::new(0.0, 0.2, 0.1)),
        (DVec3::ONE, DQuat::from_rotation_y(0.3), DVec3::ZERO),
    ]
}

/// A still mesh in the place of one with morph targets, a skin, or both.
fn expected(mesh: &glb::Mesh, morphs: bool, skins: bool) -> Model {
    let place = |(position, normal): (&[f32; 3], &[f32; 3])| {
        let [d, e] = displacement(*position).map(DVec3::from);
        let weight = if morphs { 2.0 * WEIGHTS[0] + WEIGHTS[1] } else { 0.0 };
        let [p, n] = [position, normal].map(|v| DVec3::from(v.map(f64::from)));
        let (p, n) = (p + weight * d, n + weight * e);
        let joints = joints_at_rest().map(|(s, r, t)| DMat4::from_scale_rotation_translation(s, r, t));
        let sum = joints.iter().zip(weights(*position)).fold(DMat4::ZERO, |sum, (joint, weight)| sum + *joint * weight);
        let sum = if skins { sum } else { DMat4::IDENTITY };
        let normal = (DMat3::from_mat4(sum).inverse().transpose() * n).normalize();
        (sum.transform_point3(p).as_vec3().to_array(), normal.as_vec3().to_array())
    };
    let (positions, normals) = mesh.positions.iter().zip(&mesh.normals).map(place).unzip();
    Document::new(&glb::Mesh { positions, normals, indices: mesh.indices.clone() }).load()
}

/// Fails unless both pictures show the same surface up to the rounding of floats. At its edge, a pixel may fall to the other side.
#[track_caller]
fn assert_near(found: &Capture, expected: &Capture, what: &str) {
    let apart = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-4 * (1.0 + b.abs()));
    let far = found.raw.iter().zip(&expected.raw).filter(|pair| apart(*pair)).count();
    let covered = expected.raw.iter().filter(|pixel| pixel[3] > 0.0).count();
    assert!(far <= 4 && covered > 800, "{what}: {far} of {covered} pixels differ");
}

#[test]
fn joints_and_morph_targets_move_vertices() {
    let mesh = glb::sphere(24, 48);
    for (morphs, skins) in [(true, false), (false, true), (true, true)] {
        let mut still = Session::new(expected(&mesh, morphs, skins), settings(&PLAIN));
        let mut document = Document::new(&mesh);
        if morphs {
            document.morph(&mesh);
        }
        if skins {
            document.skin(&mesh);
        }
        let mut moved = Session::new(document.load(), settings(&PLAIN));
        for mode in ["final", "geometric-normal", "depth"] {
            assert_near(&moved.mode(mode), &still.mode(mode), &format!("{mode}, {morphs}, {skins}"));
        }
        for session in [&mut moved, &mut still] {
            session.set("SHADOWS=Hard");
        }
        assert_near(&moved.mode("final"), &still.mode("final"), "shadows");
    }
}

#[test]
fn an_edit_of_the_stage_moves_vertices_and_a_broken_one_keeps_them() {
    let mesh = glb::sphere(24, 48);
    let mut document = Document::new(&mesh);
    document.skin(&mesh);
    let mut session = Session::new(document.load(), settings(&PLAIN));
    let before = session.render();
    let (from, to) = ("of.moved.at[index] = vertex;", "vertex.position.x += 0.4;\n    of.moved.at[index] = vertex;");
    ready(&session.edit("deform.comp", from, to));
    let edited = session.render();
    assert_differ(&before, &edited, "vertices are elsewhere");
    let told = lines(failed(&session.edit("deform.comp", "vertex.position.x", "vertex.nowhere"))).join("\n");
    assert!(told.contains("deform.comp:") && told.contains("nowhere"), "{told}");
    assert_same(&edited, &session.render(), "a broken edit");
    ready(&session.edit("deform.comp", "vertex.nowhere += 0.4;", ""));
    assert_same(&before, &session.render(), "the edit is taken back");
}

/// How far the surface in the middle of the picture has moved.
fn velocity(capture: &Capture) -> [f32; 2] {
    let [x, y, ..] = capture.raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
    [x, y]
}

#[test]
fn velocity_follows_matrices_joints_and_morph_targets() {
    let mesh = glb::quad(1.0);
    let along_x = |from: f32, to: f32| vec![from, 0.0, 0.0, to, 0.0, 0.0];
    let rigid = |document: &mut Document| document.clip(&[(0, "translation", "VEC3", along_x(-1.0, 1.0))]);
    let of_joints = |document: &mut Document| {
        document.skin(&mesh);
        document.clip(&[1, 2, 3].map(|node| (node, "translation", "VEC3", along_x(-1.0, 1.0))));
        for node in 1..4 {
            document.json["nodes"][node] = json!({});
        }
    };
    let of_targets = |document: &mut Document| {
        let all = vec![[1.0_f32, 0.0, 0.0]; mesh.positions.len()];
        let target = document.floats("VEC3", all.as_flattened());
        document.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
        document.clip(&[(0, "weights", "SCALAR", vec![-1.0, 1.0])]);
    };
    type Bend<'a> = &'a dyn Fn(&mut Document);
    let all: [(&str, Bend<'_>); 3] = [("a node", &rigid), ("joints", &of_joints), ("a morph target", &of_targets)];
    for (what, bend) in all {
        let mut document = Document::new(&mesh);
        bend(&mut document);
        let mut session = Session::new(document.load(), settings(&PLAIN));
        ready(&session.save("passes/show.frag", SHOW));
        session.headless.set_sequence(Sequence { frames: 40, fps: 10.0, ..Sequence::default() });
        // 0.2 m in a second are 0.02 m in a frame, of a picture of 6 m.
        let [x, y] = velocity(&session.render());
        assert!((x - 0.02 / 6.0).abs() < 2e-5 && y.abs() < 1e-6, "{what} moves by {x}, {y}");
        let [x, _] = velocity(&session.headless.render_next().unwrap());
        assert!((x - 0.02 / 6.0).abs() < 2e-5, "{what} moves on by {x}");
        // At rest nothing moves, once the frame before rests, too.
        session.set("animation.clips=[\"none\"]");
        session.headless.render_next().unwrap();
        assert_eq!(velocity(&session.headless.render_next().unwrap()), [0.0, 0.0], "{what} rests");
    }
    assert_validated();
}

#[test]
fn moved_surfaces_are_left_out_beyond_the_frame_alone() {
    let mesh = glb::sphere(24, 48);
    let mut document = Document::new(&mesh);
    document.morph(&mesh);
    document.skin(&mesh);
    document.clip(&[(2, "translation", "VEC3", vec![0.0, 0.2, 0.1, 9.0, 0.2, 0.1])]);
    let mut session = Session::new(document.load(), settings(&PLAIN));
    let look = |session: &mut Session| {
        let mut seen = Vec::new();
        for start_s in [0.0, 4.0, 9.0] {
            session.headless.set_sequence(Sequence { frames: 1, start_s, ..Sequence::default() });
            for x in [-7.0, -4.5, 0.0, 3.0, 6.0, 9.0, 14.0] {
                session.set(&format!("camera.eye=[{x}, 0, 8]"));
                session.set(&format!("camera.target=[{x}, 0, 0]"));
                let picture = session.render();
                seen.push((picture, session.headless.draw_counts().draws));
            }
        }
        seen
    };
    let seen = look(&mut session);
    // Nothing is known about the vertices of a stage that was edited.
    ready(&session.edit("deform.comp", "if (weight == 0.0) continue;", ""));
    let whole = look(&mut session);
    let most = whole.iter().map(|(_, draws)| *draws).max().unwrap();
    for ((picture, draws), (all, of)) in seen.iter().zip(&whole) {
        assert_same(picture, all, &format!("{draws} of {of} draws"));
        let is_empty = all.raw.iter().all(|pixel| pixel[3] == 0.0);
        assert!(*of == most && (is_empty || *draws == most), "{draws} of {of} draws");
    }
    let left_out = seen.iter().filter(|(_, draws)| *draws < most).count();
    assert!((6..=14).contains(&left_out), "{left_out} of {} pictures", seen.len());
    assert_validated();
}
