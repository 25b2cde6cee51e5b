//! Hierarchy, lights, cameras.

use glam::{Vec3, Vec4};

use super::super::super::model::{Lens, LightKind};
use super::*;

#[test]
fn transforms_multiply_down_the_hierarchy() {
    let mut builder = Builder::triangle();
    let half = 0.5_f32.sqrt();
    builder.json["nodes"] = json!([
        { "children": [1, 2], "translation": [10, 0, 0], "scale": [2, 2, 2] },
        { "mesh": 0, "name": "turned", "rotation": [0, half, 0, half] },
        { "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1] },
    ]);
    let model = builder.model();
    assert_eq!((model.primitives.len(), model.instances.len()), (1, 2));
    let [turned, mirrored] = [0, 1].map(|index| &model.instances[index]);
    assert_eq!((turned.node, &*turned.node_name, mirrored.node), (1, "turned", 2));
    // A quarter turn around +Y takes +X to -Z.
    assert!(turned.world_from_object.transform_point3(Vec3::X).distance(Vec3::new(10.0, 0.0, -2.0)) < 1e-5);
    assert!(mirrored.world_from_object.determinant() < 0.0);
    assert_eq!(mirrored.world_from_object.w_axis, Vec4::new(12.0, 4.0, 6.0, 1.0));
    assert!((model.bounds.min.z + 2.0).abs() < 1e-5 && model.bounds.max.distance(Vec3::new(12.0, 6.0, 6.0)) < 1e-5);
}

#[test]
fn scene_is_the_default_or_first_or_all() {
    let mut builder = Builder::triangle();
    builder.json["nodes"] = json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b" }]);
    builder.json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1] }, {}]);
    let drawn =
        |builder: &Builder| builder.model().instances.iter().map(|i| i.node_name.to_string()).collect::<String>();
    builder.json["scene"] = json!(1);
    assert_eq!(drawn(&builder), "b");
    builder.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(drawn(&builder), "a");
    builder.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(drawn(&builder), "ab");
}

#[test]
fn deep_hierarchies_do_not_overflow_the_stack() {
    let mut builder = Builder::triangle();
    let depth = 50_000;
    let mut nodes: Vec<Value> = (1..depth).map(|child| json!({ "children": [child] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    builder.json["nodes"] = Value::Array(nodes);
    assert_eq!(builder.model().instances[0].node, depth - 1);
}

#[test]
fn hierarchy_mistakes_are_named() {
    let cases = [
        (json!([{ "mesh": 0, "children": [1] }, { "children": [0] }]), "cycles"),
        (json!([{ "mesh": 0 }, { "children": [1] }]), "cycles"),
        (json!([{ "children": [7] }]), "nodes[0]: expected an index into nodes of 0 to 0, found 7"),
        (json!([{ "mesh": 3 }]), "an index into meshes of 0 to 0, found 3"),
        (json!([{ "mesh": 0, "scale": [1e39, 1, 1] }]), "finite"),
        (json!([{ "mesh": 0, "rotation": [1e39, 0, 0, 1] }]), "finite"),
        (json!([{ "mesh": 0, "matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }]), "last row"),
        (json!([{ "scale": [1e30, 1, 1], "children": [1] }, { "scale": [1e30, 1, 1], "mesh": 0 }]), "overflows"),
        (json!([{ "mesh": 0, "scale": [1e30, 1, 1] }]), "world space"),
        (json!([{}]), "nothing to draw"),
        (json!([]), "an index into nodes"),
    ];
    for (nodes, word) in cases {
        let mut builder = Builder::triangle();
        builder.json["nodes"] = nodes.clone();
        let error = builder.error();
        assert!(
            error.contains(word) || (word == "an index into nodes" && error.contains("no use of nodes")),
            "{nodes}: {error}"
        );
    }
    let beside = |part: Value| {
        let mut builder = Builder::triangle();
        builder.json["nodes"] = json!([{ "mesh": 0, "children": [1] }, part]);
        assert_eq!(builder.model().instances.len(), 1);
        builder.told()
    };
    assert!(beside(json!({ "mesh": 3 })).contains("an index into meshes of 0 to 0, found 3; the mesh is left out"));
    assert!(beside(json!({ "camera": 0 })).contains("no use of cameras"));
    let light = json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    assert!(beside(light).contains("no use of KHR_lights_punctual.lights"));
    let mut builder = Builder::triangle();
    builder.json["scenes"][0]["nodes"] = json!([5]);
    assert!(builder.error().contains("found 5"));
    builder.json["scene"] = json!(4);
    assert!(builder.error().contains("index into scenes"));
}

#[test]
fn a_node_that_is_listed_more_than_once_is_shown_with_a_warning() {
    let cases = [
        // UniGLTF lists all nodes as roots.
        (json!([{ "children": [1] }, { "mesh": 0 }]), json!([0, 1]), 1, "lists a node that it already has"),
        (json!([{ "children": [1] }, { "mesh": 0 }]), json!([1, 0]), 1, "lists a node that it already has"),
        (json!([{ "children": [1] }, { "children": [2] }, { "mesh": 0 }]), json!([0, 1, 2]), 1, "lists 2 nodes"),
        (json!([{ "mesh": 0 }]), json!([0, 0]), 1, "lists a node"),
        (json!([{ "children": [1, 1] }, { "mesh": 0 }]), json!([0]), 1, "nodes[0] lists the child nodes[1] twice"),
        (
            json!([{ "children": [2] }, { "children": [2], "translation": [1, 0, 0] }, { "mesh": 0 }]),
            json!([0, 1]),
            2,
            "nodes[2] has 2 parents: it is shown below each",
        ),
    ];
    for (nodes, roots, shown, warning) in cases {
        let mut builder = Builder::triangle();
        (builder.json["nodes"], builder.json["scenes"][0]["nodes"]) = (nodes.clone(), roots.clone());
        let model = builder.model();
        assert_eq!(model.instances.len(), shown, "{nodes} {roots}");
        assert!(model.warnings.len() == 1 && model.warnings[0].contains(warning), "{:?}", model.warnings);
        assert!(shown == 1 || model.instances[0].world_from_object != model.instances[1].world_from_object);
    }
    // A scene may begin below a node of another scene.
    let mut builder = Builder::triangle();
    builder.json["nodes"] = json!([{ "children": [1], "translation": [5, 0, 0] }, { "mesh": 0 }]);
    builder.json["scenes"][0]["nodes"] = json!([1]);
    let model = builder.model();
    assert_eq!((model.instances[0].world_from_object, model.warnings.len()), (glam::Mat4::IDENTITY, 0));
    // Each level doubles what is below it.
    let level = |number: usize| match number {
        99 => json!({ "mesh": 0 }),
        even if even % 3 == 0 => json!({ "children": [even + 1, even + 2] }),
        other => json!({ "children": [other.next_multiple_of(3)] }),
    };
    builder.json["nodes"] = (0..100).map(level).collect();
    builder.json["scenes"][0]["nodes"] = json!([0]);
    assert!(builder.error().contains("shown at most 65536 times more"), "{}", builder.error());
}

#[test]
fn an_animation_without_a_target_node_changes_nothing() {
    let mut builder = Builder::triangle();
    builder.json["animations"] = json!([{
        "samplers": [{ "input": 0, "output": 0 }],
        "channels": [{ "sampler": 0, "target": { "path": "translation" } }, { "sampler": 0, "target": { "path": "pointer" } }],
    }]);
    assert_eq!(builder.model().instances.len(), 1);
    // Other mistakes of the file are still reported.
    builder.json["meshes"][0]["primitives"][0]["attributes"] = json!(7);
    let error = builder.error();
    assert!(error.contains("does not parse") && !error.contains("`node`"), "{error}");
}

#[test]
fn far_nodes_are_moved_to_the_origin_without_loss() {
    let mut builder = Builder::triangle();
    builder.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }]);
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{ "type": "point" }]);
    builder.json["nodes"] = json!([
        { "translation": [1e6, 2e6, -3e6], "children": [1, 2, 3] },
        { "mesh": 0, "translation": [0.125, 0, 0] },
        { "camera": 0, "translation": [0, 0, 4] },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [0, 2, 0] },
    ]);
    let model = builder.model();
    let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-6, "{a}, expected {b}");
    let moved = model.instances[0].world_from_object.w_axis.truncate();
    assert!(model.bounds.center().length() < 0.2 && model.bounds.radius() < 1.0, "{:?}", model.bounds);
    near(model.cameras[0].eye - moved, Vec3::new(-0.125, 0.0, 4.0));
    near(model.lights[0].position - moved, Vec3::new(-0.125, 2.0, 0.0));
    assert!(
        model.warnings.len() == 1 && model.warnings[0].contains("it is shown at the origin"),
        "{:?}",
        model.warnings
    );
    // Nodes that cancel out lose nothing either, and nothing is moved.
    builder.json["nodes"][0]["children"] = json!([4]);
    builder.push("nodes", json!({ "translation": [-1e6, -2e6, 3e6], "children": [1] }));
    let model = builder.model();
    assert_eq!((model.instances[0].world_from_object.w_axis.truncate(), model.warnings.len()), (Vec3::X * 0.125, 0));
}

#[test]
fn a_model_that_cannot_be_seen_says_why() {
    let reason = |change: fn(&mut Builder)| {
        let mut builder = Builder::triangle();
        change(&mut builder);
        let warnings = builder.model().warnings;
        warnings.iter().find(|warning| warning.contains("Nothing of the model can be seen")).cloned()
    };
    let says = |change, words: &str| {
        let reason = reason(change);
        assert!(reason.as_ref().is_some_and(|reason| reason.contains(words)), "{reason:?}, expected {words}");
    };
    says(|builder| builder.json["nodes"][0]["scale"] = json!([0, 0, 0]), "the nodes have a scale of 0");
    says(|builder| builder.json["nodes"][0]["scale"] = json!([1, 0, 0]), "the nodes have a scale of 0");
    says(|builder| *builder = Builder::positions(&[1.0; 9]), "all vertices of a mesh are in one point or line");
    let clear = json!([{ "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0] } }]);
    let faint = json!([{ "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.2] } }]);
    for materials in [clear, faint] {
        let mut builder = Builder::triangle();
        (builder.json["materials"], builder.primitive()["material"]) = (materials, json!(0));
        assert!(builder.model().warnings.iter().any(|warning| warning.contains("the alpha of all materials is 0")));
    }
    // One scale of 0 leaves a plane, and a model may be tiny.
    assert_eq!(reason(|builder| builder.json["nodes"][0]["scale"] = json!([1, 1, 0])), None);
    assert_eq!(reason(|builder| builder.json["nodes"][0]["scale"] = json!([1e-25, 1e-25, 1e-25])), None);
    assert_eq!(
        reason(|builder| *builder = Builder::positions(&[0.0, 0.0, 0.0, 1e-30, 0.0, 0.0, 0.0, 1e-30, 0.0])),
        None
    );
}

#[test]
fn a_rotation_of_length_zero_is_none() {
    let mut builder = Builder::triangle();
    builder.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]);
    let model = builder.model();
    assert_eq!(model.instances[0].world_from_object, glam::Mat4::IDENTITY);
    assert_eq!(model.warnings.len(), 1);
}

#[test]
fn punctual_lights() {
    let mut builder = Builder::triangle();
    builder.json["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([
        { "type": "spot", "name": "lamp", "color": [1, 0.5, 0], "intensity": 10, "range": 3,
          "spot": { "innerConeAngle": 0.1 } },
        { "type": "directional" },
        { "type": "point", "range": -1, "extras": { "note": 1 } },
    ]);
    let light = |index: usize| json!({ "KHR_lights_punctual": { "light": index } });
    let half = 0.5_f32.sqrt();
    builder.json["nodes"] = json!([
        { "mesh": 0, "children": [1, 2, 3] },
        // Turned to look along -X.
        { "extensions": light(0), "translation": [1, 2, 3], "rotation": [0, half, 0, half], "scale": [5, 5, 5] },
        { "extensions": light(1) }, { "extensions": light(2) },
    ]);
    let model = builder.model();
    let [spot, sun, point] = [0, 1, 2].map(|index| &model.lights[index]);
    assert_eq!((&*spot.name, spot.position, spot.range), ("lamp", Vec3::new(1.0, 2.0, 3.0), Some(3.0)));
    assert!(spot.direction.distance(Vec3::NEG_X) < 1e-6);
    assert_eq!(spot.intensity, Vec3::new(10.0, 5.0, 0.0));
    assert_eq!(spot.kind, LightKind::Spot { inner: 0.1, outer: std::f32::consts::FRAC_PI_4 });
    assert_eq!((sun.kind, sun.direction, sun.intensity), (LightKind::Directional, Vec3::NEG_Z, Vec3::ONE));
    assert_eq!((point.kind, point.range, model.warnings.len()), (LightKind::Point, None, 1));
    for bad in [
        json!({ "type": "lamp" }),
        json!({ "type": "spot", "spot": { "innerConeAngle": 1, "outerConeAngle": 0.5 } }),
        json!({ "type": "spot", "spot": { "outerConeAngle": 3 } }),
        json!({ "type": "point", "intensity": 1e38, "color": [1e3, 1, 1] }),
    ] {
        builder.json["extensions"]["KHR_lights_punctual"]["lights"][0] = bad;
        let told = builder.told();
        assert!(told.contains("KHR_lights_punctual.lights[0]") && told.contains("the light is left out"), "{told}");
        assert_eq!(builder.model().lights.len(), 2);
    }
    for (key, bad, found) in [
        ("intensity", json!(-1), "at least 0, found -1"),
        ("intensity", json!(1e39), "found inf"),
        ("color", json!([1e39, 1, 1]), "found [inf, 1, 1]"),
        ("color", json!([0, -1, 0]), "found [0, -1, 0]"),
    ] {
        // Two negative numbers do not make up for one another.
        let mut light = json!({ "type": "point", "intensity": 1, "color": [-1, 1, 1] });
        if key == "color" {
            light["intensity"] = json!(1);
        }
        light[key] = bad;
        builder.json["extensions"]["KHR_lights_punctual"]["lights"][0] = light;
        let (told, place) = (builder.told(), format!("KHR_lights_punctual.lights[0].{key}"));
        assert!(told.contains(&place) && told.contains(found), "{told}");
    }
}

#[test]
fn cameras() {
    let mut builder = Builder::triangle();
    builder.json["cameras"] = json!([
        { "type": "perspective", "name": "eye", "perspective": { "yfov": 0.7, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 2, "znear": 0, "zfar": 9 } },
    ]);
    builder.json["nodes"] = json!([
        { "mesh": 0, "children": [1, 2] },
        { "camera": 0, "translation": [0, 0, 4] },
        { "name": "plan", "camera": 1, "translation": [0.5, 0.5, 2] },
    ]);
    let model = builder.model();
    let [perspective, orthographic] = [0, 1].map(|index| &model.cameras[index]);
    assert_eq!((&*perspective.name, perspective.eye), ("eye", Vec3::Z * 4.0));
    assert_eq!((perspective.forward, perspective.up), (Vec3::NEG_Z, Vec3::Y));
    assert_eq!(perspective.lens, Lens::Perspective { fovy: 0.7 });
    assert_eq!((&*orthographic.name, orthographic.lens), ("plan", Lens::Orthographic { height: 4.0 }));
    for bad in
        [json!({ "type": "perspective" }), json!({ "type": "perspective", "perspective": { "yfov": 0, "znear": 1 } })]
    {
        builder.json["cameras"][0] = bad;
        assert!(builder.told().contains("cameras[0]") && builder.told().contains("the camera is left out"));
        assert_eq!(builder.model().cameras.len(), 1);
    }
}
