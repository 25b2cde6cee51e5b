//! Skins, morph targets and animations against references in doubles.

use glam::{DMat4, DQuat, DVec3, Mat4, Vec3};

use super::*;
use crate::frame::Scene;
use crate::scene::Places;
use crate::scene::motion::Playing;
use crate::settings::Settings;

/// A square with normals whose lower two vertices follow the node 1 and whose upper two follow half the node 2. The node 2 stands on node 1.
fn skinned() -> Builder {
    let mut builder = Builder::square();
    let joints = builder.accessor("VEC4", U8, 4, &[0, 9, 9, 9, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 9, 9]);
    builder.primitive()["attributes"]["JOINTS_0"] = json!(joints);
    // Weights that add up to 1 only when they are divided by their sum.
    let weights = builder.accessor("VEC4", U8, 4, &[255, 0, 0, 0, 200, 0, 0, 0, 127, 127, 0, 0, 100, 100, 0, 0]);
    builder.json["accessors"][weights]["normalized"] = json!(true);
    builder.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
    let bind = [Mat4::from_translation(Vec3::new(0.25, 0.0, 0.0)), Mat4::from_translation(Vec3::new(0.0, -0.5, 0.0))];
    let bytes: Vec<u8> = bind.iter().flat_map(|matrix| bytemuck::bytes_of(matrix).to_vec()).collect();
    let bind = builder.accessor("MAT4", F32, 2, &bytes);
    builder.json["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": bind }]);
    builder.json["nodes"] = json!([
        // The node of a skinned mesh does not move it.
        { "mesh": 0, "skin": 0, "translation": [100, 0, 0] },
        { "children": [2], "translation": [0, 1, 0], "scale": [1, 2, 0.5] },
        { "translation": [0, 0.5, 0.25], "rotation": [0, 0, 0.6, 0.8] },
    ]);
    builder
}

/// The joints of [`skinned`] in doubles, given the rotation of node 2.
fn joints(rotation: DQuat) -> [DMat4; 2] {
    let first = DMat4::from_translation(DVec3::Y) * DMat4::from_scale(DVec3::new(1.0, 2.0, 0.5));
    let second = first * DMat4::from_rotation_translation(rotation, DVec3::new(0.0, 0.5, 0.25));
    let bind = [DVec3::new(0.25, 0.0, 0.0), DVec3::new(0.0, -0.5, 0.0)].map(DMat4::from_translation);
    [first * bind[0], second * bind[1]]
}

/// Positions of [`skinned`] in doubles.
fn skinned_positions(rotation: DQuat) -> [DVec3; 4] {
    let [first, second] = joints(rotation);
    let half = (first + second) * 0.5;
    [(first, DVec3::ZERO), (first, DVec3::X), (half, DVec3::new(1.0, 1.0, 0.0)), (half, DVec3::Y)]
        .map(|(matrix, position)| matrix.transform_point3(position))
}

#[track_caller]
fn near(found: &[DVec3], expected: &[DVec3], most: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.distance(*expected) < most, "{found}, expected {expected}");
    }
}

/// World positions of the vertices of an instance.
fn positions(model: &Model, instance: usize) -> Vec<DVec3> {
    let instance = &model.instances[instance];
    let place = |position: [f32; 3]| instance.world_from_object.transform_point3(position.into()).as_dvec3();
    model.vertices(instance).iter().map(|vertex| place(vertex.position)).collect()
}

/// The model while its first clip plays.
pub(super) fn at(model: &Model, time_s: f64) -> Model {
    model.at(&[Playing { clip: 0, weight: 1.0, time_s }], &[], &Places::default())
}

/// Adds an animation with a channel for each target, all with these times.
pub(super) fn animate(builder: &mut Builder, times: &[f32], channels: &[(Value, &str, &str, &[f32])]) {
    let input = builder.accessor("SCALAR", F32, times.len(), bytemuck::cast_slice(times));
    let mut animation = json!({ "name": "clip", "samplers": [], "channels": [] });
    for (number, (target, interpolation, kind, values)) in channels.iter().enumerate() {
        let width = if *kind == "SCALAR" { 1 } else { usize::from(kind.as_bytes()[3] - b'0') };
        let output = builder.accessor(kind, F32, values.len() / width, bytemuck::cast_slice(values));
        let sampler = json!({ "input": input, "output": output, "interpolation": interpolation });
        animation["samplers"].as_array_mut().unwrap().push(sampler);
        animation["channels"].as_array_mut().unwrap().push(json!({ "sampler": number, "target": target }));
    }
    builder.push("animations", animation);
}

/// A skinned model with one clip, in which a joint turns.
pub(super) fn swinging() -> Model {
    let mut builder = skinned();
    let turns: [f32; 8] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let target = json!({ "node": 2, "path": "rotation" });
    animate(&mut builder, &[0.0, 1.0], &[(target, "LINEAR", "VEC4", &turns)]);
    builder.model()
}

#[test]
fn joints_move_vertices_by_their_weights() {
    let builder = skinned();
    let expected = skinned_positions(DQuat::from_xyzw(0.0, 0.0, 0.6, 0.8));
    let model = builder.model();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    near(&positions(&model, 0), &expected, 1e-5);
    for point in expected {
        let bounds = model.bounds;
        assert!(point.as_vec3().cmpge(bounds.min - 1e-5).all() && point.as_vec3().cmple(bounds.max + 1e-5).all());
    }
    // Joints outside of the scene, a placed model, and several sets of influences.
    let mut outside = builder.clone();
    outside.json["scenes"][0]["nodes"] = json!([0]);
    near(&positions(&outside.model(), 0), &expected, 1e-5);
    let place = Mat4::from_scale_rotation_translation(Vec3::splat(2.0), glam::Quat::from_rotation_y(0.5), Vec3::ONE);
    let placed = expected.map(|point| place.as_dmat4().transform_point3(point));
    near(&positions(&model.placed(place), 0), &placed, 2e-5);
    let mut more = builder.clone();
    let attributes = &mut more.json["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_1"], attributes["WEIGHTS_1"]) =
        (attributes["JOINTS_0"].clone(), attributes["WEIGHTS_0"].clone());
    let more = more.model();
    assert_eq!(more.primitives[0].deformation.as_ref().unwrap().influences_per_vertex, 8);
    near(&positions(&more, 0), &expected, 1e-5);
}

#[test]
fn joints_that_mirror_reverse_the_winding() {
    let mut builder = skinned();
    let determinant = |builder: &Builder| builder.model().instances[0].world_from_object.determinant();
    assert_eq!(determinant(&builder), 1.0);
    let before = positions(&builder.model(), 0);
    builder.json["nodes"][1]["scale"] = json!([-1, 2, 0.5]);
    assert_eq!(determinant(&builder), -1.0);
    let model = builder.model();
    // The first two vertices follow the node 1 alone.
    let mirrored: Vec<DVec3> = before[..2].iter().map(|point| *point * DVec3::new(-1.0, 1.0, 1.0)).collect();
    near(&positions(&model, 0)[..2], &mirrored, 1e-5);
}

#[test]
fn a_skin_that_does_not_fit_costs_itself_alone() {
    let told = |change: &dyn Fn(&mut Builder), words: &str| {
        let mut wrong = skinned();
        change(&mut wrong);
        let told = wrong.told();
        assert!(told.contains(words) && told.contains("the skin is left out: the mesh stands where"), "{told}");
        near(&positions(&wrong.model(), 0)[..2], &[DVec3::X * 100.0, DVec3::X * 101.0], 1e-5);
    };
    let joints = |of: Value| move |builder: &mut Builder| builder.json["skins"][0]["joints"] = of.clone();
    told(&joints(json!([1])), "JOINTS at vertex 2: expected a joint of 0 to 0, found 1");
    told(&joints(json!([1, 7])), "an index into nodes of 0 to 2");
    told(&joints(json!([1, 2, 0])), "a matrix for each of the 3 joints");
    told(&|wrong: &mut Builder| wrong.json["nodes"][0]["skin"] = json!(3), "an index into skins of 0 to 0, found 3");
    let alone = |wrong: &mut Builder| {
        wrong.primitive()["attributes"].as_object_mut().unwrap().remove("WEIGHTS_0");
    };
    told(&alone, "WEIGHTS_0");
    // A mesh that no skin moves stands where its node is, whatever its influences.
    let mut plain = skinned();
    plain.json["nodes"][0].as_object_mut().unwrap().remove("skin");
    near(&positions(&plain.model(), 0)[..1], &[DVec3::X * 100.0], 1e-5);
}

/// A square with two morph targets: one sparse without a buffer view, one with all attributes.
fn morphed() -> Builder {
    let mut builder = Builder::square();
    builder.attribute_f32("COLOR_0", "VEC4", &[0.5; 16]);
    let indices = builder.view(&[2, 0]);
    let values = builder.view(bytemuck::cast_slice(&[0.0_f32, 0.0, 2.0]));
    let sparse = json!({ "count": 1, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } });
    let first =
        builder.push("accessors", json!({ "componentType": F32, "count": 4, "type": "VEC3", "sparse": sparse }));
    let position = builder.accessor("VEC3", F32, 4, bytemuck::cast_slice(&[0.25_f32, -0.5, 0.125].repeat(4)));
    let normal = builder.accessor("VEC3", F32, 4, bytemuck::cast_slice(&[1.0_f32, 0.0, 0.0].repeat(4)));
    let uv = builder.accessor("VEC2", F32, 4, bytemuck::cast_slice(&[0.5_f32; 8]));
    let color = builder.accessor("VEC3", F32, 4, bytemuck::cast_slice(&[0.25_f32, -2.0, 0.0].repeat(4)));
    builder.primitive()["targets"] = json!([
        { "POSITION": first },
        { "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv, "COLOR_0": color },
    ]);
    builder.json["meshes"][0]["weights"] = json!([0.5, 1]);
    builder.json["meshes"][0]["extras"] = json!({ "targetNames": ["peak", "shift"] });
    builder
}

#[test]
fn morph_targets_add_to_every_attribute() {
    let model = morphed().model();
    assert_eq!(model.motion.target_names, ["peak", "shift"]);
    let shift = DVec3::new(0.25, -0.5, 0.125);
    let expected = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 1.0), DVec3::Y].map(|point| point + shift);
    near(&positions(&model, 0), &expected, 1e-5);
    let vertices = model.vertices(&model.instances[0]);
    let normal = Vec3::new(1.0, 0.0, 1.0).normalize();
    assert!(vertices.iter().all(|vertex| Vec3::from(vertex.normal).distance(normal) < 1e-6));
    assert_eq!((vertices[0].uv0, vertices[0].uv1, vertices[0].color), ([0.5, 1.5], [0.5, 1.5], [0.75, 0.0, 0.5, 0.5]));
    assert!(model.bounds.max.z > 1.1, "{:?}", model.bounds);
    // The weights of a node come first.
    let mut of_node = morphed();
    of_node.json["nodes"][0]["weights"] = json!([0, 0]);
    near(&positions(&of_node.model(), 0), &[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y], 1e-6);
    let mut short = morphed();
    let target = short.primitive()["targets"][1]["NORMAL"].as_u64().unwrap() as usize;
    short.json["accessors"][target]["count"] = json!(3);
    let told = short.told();
    assert!(told.contains("as many elements as POSITION") && told.contains("the morph target is left out"), "{told}");
    // The other target keeps its weight.
    let expected = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 1.0), DVec3::Y];
    near(&positions(&short.model(), 0), &expected, 1e-6);
}

#[test]
fn weights_that_the_settings_hold_replace_those_of_the_file() {
    let mut builder = morphed();
    builder.json["meshes"][0]["extras"] = json!({ "targetNames": ["smile"] });
    let model = std::sync::Arc::new(builder.model());
    assert_eq!(model.target_keys(), ["smile", "1"]);
    let mut settings = Settings::default();
    let scene = |settings: &Settings| Scene::new(&model, settings).model().clone();
    let rest = scene(&settings);
    assert_eq!(rest.pose.weights, model.pose.weights);
    settings.assign("animation.weights=smile:0.25, 1:2").unwrap();
    let held = scene(&settings);
    assert_eq!(
        (held.pose.weights.as_slice(), held.weight_of("smile"), held.weight_of("1")),
        (&[0.25, 2.0][..], 0.25, 2.0)
    );
    let points = positions(&held, 0);
    let (low, high) = (held.bounds.min.as_dvec3() - 1e-4, held.bounds.max.as_dvec3() + 1e-4);
    assert!(points.iter().all(|p| p.cmpge(low).all() && p.cmple(high).all()), "{points:?} {:?}", held.bounds);
    for (weights, told) in
        [("smlie:1", "has no morph target 'smlie'"), ("smile", "is no morph weight"), ("smile:x", "NAME:WEIGHT")]
    {
        settings.assign(&format!("animation.weights={weights}")).unwrap();
        let problem = model.unknown_target(&settings.animation).unwrap();
        assert!(problem.contains(told), "{problem}");
        assert_eq!(scene(&settings).pose.weights, model.pose.weights);
    }
}

#[test]
fn faces_without_normals_turn_with_the_targets() {
    let mut builder = Builder::positions(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    builder.indices(U8, &[0, 1, 2, 0, 2, 3]);
    let moved = [0.0_f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let position = builder.accessor("VEC3", F32, 4, bytemuck::cast_slice(&moved));
    builder.primitive()["targets"] = json!([{ "POSITION": position }]);
    builder.json["meshes"][0]["weights"] = json!([1]);
    let model = builder.model();
    let vertices = model.vertices(&model.instances[0]);
    for triangle in model.primitives[0].indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(vertices[triangle[corner] as usize].position));
        let normal = (b - a).cross(c - a).normalize();
        for index in triangle {
            assert!(Vec3::from(vertices[*index as usize].normal).distance(normal) < 1e-6, "{vertices:?}");
        }
    }
}

#[test]
fn clips_move_nodes_joints_and_weights() {
    let mut builder = skinned();
    let (sin, cos) = std::f32::consts::FRAC_PI_4.sin_cos();
    animate(
        &mut builder,
        &[0.5, 2.5],
        &[(json!({ "node": 2, "path": "rotation" }), "LINEAR", "VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -sin, -cos])],
    );
    let model = builder.model();
    assert_eq!((model.motion.clips[0].name.as_str(), model.motion.clips[0].duration_s), ("clip", 2.5));
    for (time_s, angle) in [(0.0, 0.0), (0.5, 0.0), (1.0, 0.25), (2.0, 0.75), (9.0, 1.0)] {
        let rotation = DQuat::from_rotation_z(angle * std::f64::consts::FRAC_PI_2);
        near(&positions(&at(&model, time_s), 0), &skinned_positions(rotation), 1e-5);
    }
    // Half of the weight is half of the way from the file's own pose.
    let half = model.pose_at(&[Playing { clip: 0, weight: 0.5, time_s: 0.0 }], &Places::default());
    let angle = 2.0 * 0.6_f64.asin() * 0.5;
    let posed = model.posed(&half.into(), &model.extent(&[], &[], &Places::default()));
    near(&positions(&posed, 0), &skinned_positions(DQuat::from_rotation_z(angle)), 1e-5);
    // The camera stands still, since the bounds hold for the whole clip.
    assert_eq!(at(&model, 0.7).bounds, at(&model, 1.9).bounds);
    for point in positions(&at(&model, 1.5), 0) {
        let bounds = at(&model, 0.0).bounds;
        assert!(point.as_vec3().cmpge(bounds.min - 1e-3).all() && point.as_vec3().cmple(bounds.max + 1e-3).all());
    }

    let mut builder = morphed();
    builder.json["nodes"] = json!([{ "mesh": 0, "children": [1] }, { "camera": 0, "translation": [0, 0, 3] }]);
    builder.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }]);
    animate(
        &mut builder,
        &[0.0, 1.0],
        &[
            (json!({ "node": 0, "path": "weights" }), "STEP", "SCALAR", &[0.0, 1.0, 1.0, 0.0]),
            (json!({ "node": 0, "path": "translation" }), "LINEAR", "VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]),
        ],
    );
    let model = builder.model();
    let expected = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let shift = DVec3::new(2.25, -0.5, 0.125);
    near(&positions(&at(&model, 0.5), 0), &expected.map(|point| point + shift), 1e-5);
    assert!(at(&model, 0.5).cameras[0].eye.distance(Vec3::new(2.0, 0.0, 3.0)) < 1e-6);
    let end = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 2.0), DVec3::Y].map(|point| point + DVec3::X * 4.0);
    near(&positions(&at(&model, 1.0), 0), &end, 1e-5);
}

/// The equations of glTF 2.0, appendix C, in doubles.
#[test]
fn curves_follow_the_specification() {
    let times = [0.25_f32, 0.75, 2.0];
    let linear: [f32; 9] = [1.0, -2.0, 3.0, 4.0, 5.5, -6.0, 0.125, 0.0, 9.0];
    let spline: Vec<f32> = (0..27).map(|index| ((index * 37 % 23) as f32 - 11.0) * 0.21).collect();
    let step: [f32; 9] = [1.0, 2.0, 3.0, 2.0, 2.0, 2.0, 0.5, 1.0, 4.0];
    let mut builder = Builder::triangle();
    builder.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0 }, { "mesh": 0 }]);
    builder.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    animate(
        &mut builder,
        &times,
        &[
            (json!({ "node": 0, "path": "translation" }), "LINEAR", "VEC3", &linear),
            (json!({ "node": 1, "path": "translation" }), "CUBICSPLINE", "VEC3", &spline),
            (json!({ "node": 2, "path": "scale" }), "STEP", "VEC3", &step),
        ],
    );
    let model = builder.model();
    let vector = |values: &[f32], at: usize| DVec3::from_slice(&[0, 1, 2].map(|k| f64::from(values[at * 3 + k])));
    for tenth in 0..25 {
        let time_s = f64::from(tenth) * 0.1;
        let key = if time_s < 0.75 { 0 } else { 1 };
        let length_s = f64::from(times[key + 1] - times[key]);
        let t = ((time_s - f64::from(times[key])) / length_s).clamp(0.0, 1.0);
        let expected = vector(&linear, key) * (1.0 - t) + vector(&linear, key + 1) * t;
        let [v0, b0, a1, v1] = [3 * key + 1, 3 * key + 2, 3 * key + 3, 3 * key + 4].map(|part| vector(&spline, part));
        let (t2, t3) = (t * t, t * t * t);
        let curved = v0 * (2.0 * t3 - 3.0 * t2 + 1.0)
            + b0 * length_s * (t3 - 2.0 * t2 + t)
            + v1 * (3.0 * t2 - 2.0 * t3)
            + a1 * length_s * (t3 - t2);
        let pose = model.pose_at(&[Playing { clip: 0, weight: 1.0, time_s }], &Places::default());
        let place = |instance: usize| pose.instances[instance].w_axis.truncate().as_dvec3();
        near(&[place(0), place(1)], &[expected, curved], 1e-6);
        let scale = [0, 1, 2].map(|axis| f64::from(pose.instances[2].col(axis)[axis]));
        let stepped = vector(&step, if time_s >= 2.0 { 2 } else { key });
        near(&[DVec3::from(scale)], &[stepped], 1e-6);
    }
    // Normalized integers.
    let mut builder = Builder::triangle();
    let input = builder.accessor("SCALAR", F32, 2, bytemuck::cast_slice(&[0.0_f32, 1.0]));
    let output = builder.accessor("VEC4", I16, 2, bytemuck::cast_slice(&[0_i16, 0, 0, 32767, 0, 0, 32767, 0]));
    builder.json["accessors"][output]["normalized"] = json!(true);
    builder.json["animations"] = json!([{
        "samplers": [{ "input": input, "output": output }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "rotation" } }],
    }]);
    let pose = builder.model().pose_at(&[Playing { clip: 0, weight: 1.0, time_s: 0.25 }], &Places::default());
    let x = pose.instances[0].x_axis.truncate().as_dvec3();
    let angle = std::f64::consts::FRAC_PI_4;
    near(&[x], &[DVec3::new(angle.cos(), angle.sin(), 0.0)], 1e-6);
}

#[test]
fn a_channel_that_cannot_be_read_costs_itself_alone() {
    let wrong = |change: fn(&mut Value)| {
        let mut builder = Builder::triangle();
        let targets = [
            (json!({ "node": 0, "path": "translation" }), "LINEAR", "VEC3", &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0][..]),
            (json!({ "node": 0, "path": "scale" }), "LINEAR", "VEC3", &[1.0, 1.0, 1.0, 3.0, 3.0, 3.0][..]),
        ];
        animate(&mut builder, &[0.0, 1.0], &targets);
        change(&mut builder.json);
        let model = builder.model();
        assert_eq!(
            model.pose_at(&[Playing { clip: 0, weight: 1.0, time_s: 0.5 }], &Places::default()).instances[0].w_axis.x,
            1.0
        );
        model.warnings.join("\n")
    };
    for (change, words) in [
        (
            (|json| json["animations"][0]["samplers"][1]["output"] = json!(99)) as fn(&mut Value),
            "an index into accessors",
        ),
        (|json| json["animations"][0]["samplers"][1]["interpolation"] = json!("CURVE"), "LINEAR, STEP or CUBICSPLINE"),
        (|json| json["animations"][0]["channels"][1]["sampler"] = json!(2), "an index into samplers of 0 to 1"),
        (
            |json| json["animations"][0]["channels"][1]["target"]["path"] = json!("rotation"),
            "values of 4 numbers, found 3",
        ),
        (|json| json["animations"][0]["channels"][1]["target"]["path"] = json!("weights"), "values of 0 numbers"),
        (|json| json["animations"][0]["channels"][1]["target"]["node"] = json!(5), "an index into nodes"),
        (
            |json| json["animations"][0]["samplers"][1]["interpolation"] = json!("CUBICSPLINE"),
            "values of 3 numbers, found 1",
        ),
    ] {
        let warnings = wrong(change);
        assert!(warnings.contains(words) && warnings.contains("the channel is not played"), "{warnings}");
    }
}

#[test]
fn pointers_move_materials_lights_and_cameras() {
    let mut builder = Builder::square();
    builder.image("baseColorTexture", &super::materials::png(2, 2));
    builder.json["materials"][0]["emissiveFactor"] = json!([0.5, 0.25, 0]);
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] =
        json!([{ "type": "spot", "intensity": 8, "color": [1, 0.5, 0] }]);
    builder.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } }]);
    builder.json["nodes"] = json!([
        { "mesh": 0 },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "camera": 0 },
    ]);
    builder.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let to =
        |pointer: &str| json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } });
    let light = |member: &str| to(&format!("/extensions/KHR_lights_punctual/lights/0/{member}"));
    let texture = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform";
    animate(
        &mut builder,
        &[0.0, 1.0],
        &[
            (to("/nodes/0/translation"), "LINEAR", "VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]),
            (
                to("/materials/0/pbrMetallicRoughness/baseColorFactor"),
                "LINEAR",
                "VEC4",
                &[0.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.25, 0.5],
            ),
            (to("/materials/0/pbrMetallicRoughness/roughnessFactor"), "LINEAR", "SCALAR", &[0.0, 0.5]),
            (
                to("/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength"),
                "STEP",
                "SCALAR",
                &[4.0, 1.0],
            ),
            (to(&format!("{texture}/offset")), "LINEAR", "VEC2", &[0.0, 0.0, 1.0, 0.5]),
            (light("intensity"), "LINEAR", "SCALAR", &[0.0, 4.0]),
            (light("spot/outerConeAngle"), "LINEAR", "SCALAR", &[0.5, 1.0]),
            (to("/cameras/0/perspective/yfov"), "LINEAR", "SCALAR", &[0.5, 1.5]),
            (to("/materials/0/extensions/EXT_odd/factor"), "LINEAR", "SCALAR", &[0.5, 1.5]),
        ],
    );
    let model = builder.model();
    assert_eq!(model.warnings.len(), 1, "{:?}", model.warnings);
    assert!(model.warnings[0].contains("/materials/0/extensions/EXT_odd/factor"), "{:?}", model.warnings);
    let half = at(&model, 0.5);
    assert_eq!(half.instances[0].world_from_object.w_axis.x, 2.0);
    assert_eq!(half.lights[0].intensity, Vec3::new(2.0, 1.0, 0.0));
    assert_eq!(half.lights[0].kind, crate::scene::LightKind::Spot { inner: 0.0, outer: 0.75 });
    assert_eq!(half.cameras[0].lens, crate::scene::Lens::Perspective { fovy: 1.0 });
    let moved = crate::scene::moved_materials(&half.materials, &half.pose.values);
    let [(1, material)] = moved.as_slice() else { panic!("{moved:?}") };
    assert_eq!(material.numbers.base_color_factor, [0.5, 0.25, 0.125, 0.75]);
    assert_eq!(material.numbers.roughness_factor, 0.25);
    // The strength multiplies the color of the file.
    assert_eq!(material.numbers.emissive_factor, [2.0, 1.0, 0.0]);
    let transform = material.textures[0].unwrap().uv_from_mesh;
    assert_eq!(transform.translation, glam::Vec2::new(0.5, 0.25));
}

#[test]
fn bounds_hold_for_clips_that_play_together() {
    let mut builder = Builder::triangle();
    builder.json["nodes"] = json!([{ "children": [1] }, { "mesh": 0 }]);
    let values = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    animate(&mut builder, &[0.0, 1.0], &[(json!({ "node": 0, "path": "translation" }), "LINEAR", "VEC3", &values)]);
    animate(&mut builder, &[0.0, 2.0], &[(json!({ "node": 1, "path": "translation" }), "LINEAR", "VEC3", &values)]);
    let model = builder.model();
    let both = [0, 1].map(|clip| Playing { clip, weight: 1.0, time_s: 0.0 });
    assert_eq!(model.at(&both[..1], &[], &Places::default()).bounds.max.x, 5.0);
    assert!(
        (8.5..9.1).contains(&model.at(&both, &[], &Places::default()).bounds.max.x),
        "{:?}",
        model.at(&both, &[], &Places::default()).bounds
    );
    let half = [Playing { weight: 0.5, ..both[0] }];
    assert_eq!(model.at(&half, &[], &Places::default()).bounds.max.x, 3.0);
}
