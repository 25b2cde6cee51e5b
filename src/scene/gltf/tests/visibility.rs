//! Nodes that the file hides, and that its clips show and hide (KHR_node_visibility with KHR_animation_pointer).

use std::sync::Arc;

use super::motion::animate;
use super::*;
use crate::frame::Scene;
use crate::scene::motion::{Extent, Playing};
use crate::scene::together::side_by_side;
use crate::scene::{Places, Sides};
use crate::settings::{AnimationSettings, SceneSettings, Settings};

/// A channel of a clip: the node, and the values at 0 s, 1 s and 2 s.
type Switch<'a> = (usize, &'a str, [f32; 3]);

fn hidden() -> Value {
    json!({ "KHR_node_visibility": { "visible": false } })
}

/// Triangles. At 1 s, a clip hides the node 0, above 3, and shows the node 1, above 5, which hides itself. No clip shows the node 2, above 4.
fn switching(switches: &[Switch<'_>]) -> Builder {
    let mut builder = Builder::triangle();
    let mut below_hidden = hidden();
    below_hidden["KHR_lights_punctual"] = json!({ "light": 0 });
    builder.json["nodes"] = json!([
        { "mesh": 0, "children": [3] },
        { "mesh": 0, "children": [5], "translation": [2, 0, 0], "extensions": hidden() },
        { "mesh": 0, "children": [4], "translation": [40, 0, 0], "extensions": hidden() },
        { "mesh": 0, "translation": [0, 2, 0], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "mesh": 0, "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "mesh": 0, "extensions": below_hidden },
    ]);
    builder.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    builder.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{ "type": "point" }]);
    let channels = switches.iter().map(|(node, interpolation, values)| {
        let pointer = format!("/nodes/{node}/extensions/KHR_node_visibility/visible");
        let target = json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } });
        (target, *interpolation, "SCALAR", &values[..])
    });
    animate(&mut builder, &[0.0, 1.0, 2.0], &channels.collect::<Vec<_>>());
    builder
}

const SWITCHES: [Switch<'_>; 2] = [(0, "STEP", [1.0, 0.0, 0.0]), (1, "STEP", [0.0, 1.0, 1.0])];

fn playing(clip: usize, weight: f32, time_s: f64) -> Playing {
    Playing { clip, weight, time_s }
}

/// The nodes of the file whose meshes are visible.
fn visible(model: &Model, playing: &[Playing]) -> Vec<usize> {
    let hidden = model.pose_at(playing, &Places::default()).hidden;
    let instances = model.instances.iter().enumerate().filter(|(index, _)| !hidden.instance(*index));
    instances.map(|(_, instance)| instance.node).collect()
}

#[test]
fn a_clip_shows_and_hides_nodes_with_all_below_them() {
    let model = switching(&SWITCHES).model();
    let told = "KHR_node_visibility hides 2 nodes with all below them";
    assert!(model.warnings.len() == 1 && model.warnings[0].contains(told), "{:?}", model.warnings);
    let left_out = model.nodes.iter().filter(|node| node.is_hidden).map(|node| node.index);
    assert_eq!((model.nodes.len(), left_out.collect::<Vec<_>>()), (6, vec![5, 2, 4]));
    assert_eq!(visible(&model, &[]), [0, 3]);
    for (time_s, expected) in [(0.0, vec![0, 3]), (0.99, vec![0, 3]), (1.0, vec![1]), (2.0, vec![1])] {
        assert_eq!(visible(&model, &[playing(0, 1.0, time_s)]), expected, "{time_s} s");
    }
    // The light of a node that no clip shows is left out; its camera is not.
    assert_eq!((model.lights.len(), model.cameras.len()), (1, 1));
    let is_dark = |time_s| model.pose_at(&[playing(0, 1.0, time_s)], &Places::default()).hidden.light(0);
    assert_eq!([0.5, 1.5].map(is_dark), [false, true]);
    // A node within a hidden one that a clip shows, too.
    let model = switching(&[SWITCHES[0], SWITCHES[1], (5, "STEP", [0.0, 0.0, 1.0])]).model();
    let at = |time_s| visible(&model, &[playing(0, 1.0, time_s)]);
    assert_eq!([at(0.5), at(1.5), at(2.0)], [vec![0, 3], vec![1], vec![1, 5]]);
    let model = switching(&[(5, "STEP", [1.0, 1.0, 1.0])]).model();
    assert_eq!(visible(&model, &[playing(0, 1.0, 0.0)]), [0, 3], "a visible node below a hidden one");
}

#[test]
fn clips_that_are_mixed_switch_from_half_their_weight_on() {
    let model = switching(&SWITCHES).model();
    let at = |weight| visible(&model, &[playing(0, weight, 1.5)]);
    assert_eq!([at(0.0), at(0.49), at(0.5), at(1.0)], [vec![0, 3], vec![0, 3], vec![1], vec![1]]);
}

#[test]
fn the_bounds_hold_what_is_shown_at_some_time() {
    let model = switching(&SWITCHES).model();
    let right = |extent: &Extent| extent.bounds.max.x;
    let during = |playing: &[Playing]| model.extent(playing, &[], &Places::default());
    assert_eq!(right(&during(&[])), 1.0, "without its clip, the model is what the file shows");
    assert_eq!(right(&during(&[playing(0, 1.0, 0.0)])), 3.0);
    assert_eq!(right(&during(&[playing(0, 0.4, 0.0)])), 1.0);
    assert_eq!(model.placed(glam::Mat4::from_scale(glam::Vec3::splat(2.0))).bounds.max.x, 2.0);
    let never = switching(&[(0, "STEP", [0.0; 3])]).model();
    assert_eq!(right(&never.extent(&[playing(0, 1.0, 0.0)], &[], &Places::default())), 1.0, "nothing is visible");
}

#[test]
fn the_settings_hide_what_the_clip_shows() {
    let model = Arc::new(switching(&SWITCHES).model());
    let scene = |time: f32, hidden: &[&str]| {
        let animation = AnimationSettings { time, ..AnimationSettings::default() };
        let hidden = hidden.iter().map(|name| (*name).to_owned()).collect();
        let scene = SceneSettings { hidden, ..SceneSettings::default() };
        Scene::new(&model, &Settings { animation, scene, ..Settings::default() })
    };
    let drawn = |scene: &Scene| -> Vec<usize> {
        let all = 0..model.instances.len();
        assert!(all.clone().all(|index| scene.is_visible(index) == (scene.sides(index) != Sides::None)));
        all.filter(|index| scene.is_visible(*index)).map(|index| model.instances[index].node).collect()
    };
    assert_eq!([drawn(&scene(0.5, &[])), drawn(&scene(1.5, &[]))], [vec![0, 3], vec![1]]);
    assert_eq!([drawn(&scene(0.5, &["#3"])), drawn(&scene(1.5, &["#3"]))], [vec![0], vec![1]]);
    assert_eq!(drawn(&scene(1.5, &["#1"])), [0; 0]);
    // The device keeps its draws and pipelines while the clip plays.
    assert!(scene(0.5, &[]).has_same_draws(&scene(1.5, &[])) && scene(0.5, &[]) != scene(1.5, &[]));
}

#[test]
fn a_visibility_between_two_keys_is_told() {
    let model = switching(&[SWITCHES[0], (1, "LINEAR", [0.0, 1.0, 1.0])]).model();
    assert!(model.warnings.iter().any(|warning| warning.contains("STEP")), "{:?}", model.warnings);
    assert_eq!(visible(&model, &[playing(0, 1.0, 1.5)]), [0; 0]);
}

#[test]
fn models_side_by_side_switch_by_clips_of_their_own() {
    let model = || switching(&SWITCHES).model();
    let both = side_by_side(vec![(String::new(), model()), ("1.glb".to_owned(), model())]);
    let count = |playing: &[Playing]| visible(&both, playing).len();
    assert_eq!(both.instances.len(), 6);
    assert_eq!(count(&[]), 4);
    assert_eq!([0, 1].map(|clip| count(&[playing(clip, 1.0, 1.5)])), [3, 3]);
    assert_eq!(count(&[playing(0, 1.0, 1.5), playing(1, 1.0, 1.5)]), 2);
}

#[test]
fn a_file_whose_meshes_are_all_hidden_says_what_hides_them() {
    let mut builder = Builder::triangle();
    builder.json["nodes"][0]["extensions"] = hidden();
    let error = builder.error();
    assert!(error.contains("nothing to draw") && error.contains("KHR_node_visibility hides 1 nodes"), "{error}");
}
