//! Random paths: they trace the model itself, agree with what is known in closed form, and split the picture's error into
//! parts that add up.

use crate::support::{Renderer, Session, assert_validated, glb, load, ready, render, renderer, settings};
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::render::Capture;
use specula::scene::Model;

const SIZE: (u32, u32) = (48, 32);

/// One sample per pixel, no light and no background but what a test adds.
fn bare(model: Model, more: &[&str]) -> Renderer {
    let bare = ["view.msaa=1", "view.background=none", "environment.name=none", "lights.ambient_strength=0"];
    let dark = ["lights.orbit.0.strength=0", "lights.orbit.1.strength=0", "lights.orbit.2.strength=0"];
    renderer(model, settings(&[&bare[..], &dark, more].concat()), SIZE)
}

fn set(headless: &mut Headless, assignment: &str) {
    headless.settings_mut().assign(assignment).unwrap();
}

/// Mean of the pixels of a rectangle that the model covers, x and y from the upper left.
fn mean(capture: &Capture, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> [f32; 3] {
    let pixels = y.flat_map(|y| x.clone().map(move |x| (x, y)));
    let raw = pixels.filter_map(|(x, y)| capture.raw_at(x, y)).filter(|value| value[3] == 1.0);
    let values: Vec<[f32; 4]> = raw.collect();
    assert!(!values.is_empty(), "no pixel there is covered");
    [0, 1, 2].map(|c| values.iter().map(|value| value[c]).sum::<f32>() / values.len() as f32)
}

fn whole(capture: &Capture) -> [f32; 3] {
    mean(capture, 0..SIZE.0, 0..SIZE.1)
}

#[track_caller]
fn assert_near(found: [f32; 3], expected: [f32; 3], tolerance: f32, what: &str) {
    let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(near, "{what}: {found:?}, not {expected:?} within {tolerance}");
}

fn matte(albedo: f64) -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": [albedo, albedo, albedo, 1.0], "metallicFactor": 0.0,
        "roughnessFactor": 1.0 } })
}

fn white_metal(roughness: f64) -> Value {
    json!({ "pbrMetallicRoughness": { "metallicFactor": 1.0, "roughnessFactor": roughness }, "doubleSided": true })
}

/// A floor with 4 m edges at y = 0.
fn floor() -> glb::Mesh {
    glb::Mesh {
        positions: vec![[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// Looks down at the floor; up in the picture is -Z.
const FROM_ABOVE: [&str; 3] = ["camera.eye=[0, 6, 0.001]", "camera.target=[0, 0, 0]", "camera.fovy=40"];
/// The middle of the floor in that picture.
const MIDDLE: (std::ops::Range<u32>, std::ops::Range<u32>) = (22..26, 14..18);
/// A strip of the floor near its left edge.
const LEFT: (std::ops::Range<u32>, std::ops::Range<u32>) = (12..15, 12..20);

/// A floor, and above its middle a thin lid that the camera looks through, since it faces down.
fn under_a_lid(lid: &Value) -> Vec<u8> {
    let corners = |y: f32| vec![[-0.5, y, -0.5], [0.5, y, -0.5], [0.5, y, 0.5], [-0.5, y, 0.5]];
    let mesh =
        glb::Mesh { positions: corners(0.5), normals: vec![[0.0, -1.0, 0.0]; 4], indices: vec![0, 1, 2, 0, 2, 3] };
    glb::scene(&[(floor(), matte(0.5)), (mesh, lid.clone())])
}

const SUN_ABOVE: [&str; 3] = ["lights.orbit.0.strength=10", "lights.orbit.0.polar=0", "lights.orbit.0.distance=10"];

#[test]
fn a_lamp_casts_a_shadow_in_traced_paths_only() {
    let mut headless = bare(
        load(&under_a_lid(&matte(0.0))),
        &[&FROM_ABOVE[..], &SUN_ABOVE, &["view.frames=8", "view.bounces=0"]].concat(),
    );
    let of = |capture: &Capture| [mean(capture, MIDDLE.0, MIDDLE.1)[0], mean(capture, LEFT.0, LEFT.1)[0]];
    let picture = of(&render(&mut headless, "final"));
    let traced = of(&render(&mut headless, "path-traced"));
    let shadow = of(&render(&mut headless, "shadow-error"));
    assert!(picture[0] > 0.5 * picture[1], "the picture has a shadow: {picture:?}");
    assert!(
        traced[0] == 0.0 && (traced[1] - picture[1]).abs() < 0.15 * picture[1],
        "{traced:?}, the picture {picture:?}"
    );
    assert!((shadow[0] + picture[0]).abs() < 1e-3 * picture[0], "{shadow:?}, the picture {picture:?}");
}

/// Radiance of the floor under a lid and a square lamp, along the middle of the picture from left to right.
fn profile(headless: &mut Headless, mode: &str) -> Vec<f32> {
    let capture = render(headless, mode);
    (11..37).map(|x| mean(&capture, x..x + 1, 13..19)[0]).collect()
}

/// Mean distance of two profiles, in parts of the mean of the second.
fn distance(a: &[f32], b: &[f32]) -> f32 {
    let differences: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
    differences / b.iter().sum::<f32>()
}

/// Soft shadows follow the size of the lamp, as random paths do, which meet the model itself.
#[test]
fn soft_shadows_are_those_of_random_paths() {
    let lamp = ["lights.rect.enabled=true", "lights.rect.polar=0", "lights.rect.distance=1", "view.bounces=0"];
    for (width, limit) in [(0.15, 0.05), (0.6, 0.08)] {
        let size = [format!("lights.rect.width={width}"), format!("lights.rect.height={width}")];
        let size: Vec<&str> = size.iter().map(String::as_str).collect();
        let chosen = [&FROM_ABOVE[..], &lamp, &size, &["view.frames=64"]].concat();
        let mut headless = bare(load(&under_a_lid(&matte(0.0))), &chosen);
        let traced = profile(&mut headless, "path-traced");
        let mut of = |shadows: &str| {
            set(&mut headless, &format!("SHADOWS={shadows}"));
            distance(&profile(&mut headless, "final"), &traced)
        };
        let [none, hard, soft] = ["Off", "Hard", "Soft"].map(&mut of);
        assert!(soft < limit && soft < 0.8 * hard && hard < none, "{width}: none {none}, hard {hard}, soft {soft}");
    }
}

/// A surface that nothing hides has no shadow, however large the lamp is and from where it shines.
#[test]
fn soft_shadows_spare_the_surface_itself() {
    let ball = glb::model(&glb::sphere(48, 96), &matte(0.5));
    for bytes in [ball, glb::model(&floor(), &matte(0.5))] {
        for polar in [20, 70] {
            let lamp =
                ["lights.rect.enabled=true", "lights.rect.distance=2", "lights.rect.width=3", "lights.rect.height=3"];
            let mut headless = bare(load(&bytes), &[&lamp[..], &["camera.elevation=40"]].concat());
            set(&mut headless, &format!("lights.rect.polar={polar}"));
            let open = whole(&render(&mut headless, "final"))[0];
            set(&mut headless, "SHADOWS=Soft");
            let shadowed = whole(&render(&mut headless, "final"))[0];
            assert!((shadowed / open - 1.0).abs() < 0.01, "{polar}: {shadowed}, not {open}");
        }
    }
}

#[test]
fn holes_of_a_mask_and_partial_coverage_let_light_through() {
    let lid = |mode: &str, alpha: f64| {
        let mut material = matte(0.0);
        material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.0, 0.0, 0.0, alpha]);
        material["alphaMode"] = json!(mode);
        under_a_lid(&material)
    };
    let middle = |bytes: &[u8]| {
        let mut headless =
            bare(load(bytes), &[&FROM_ABOVE[..], &SUN_ABOVE, &["view.frames=64", "view.bounces=0"]].concat());
        mean(&render(&mut headless, "path-traced"), MIDDLE.0, MIDDLE.1)[0]
    };
    let open = middle(&lid("MASK", 0.4));
    assert!(open > 0.01, "{open}");
    assert_eq!(middle(&lid("MASK", 0.6)), 0.0, "above the cutoff");
    let quarter = middle(&lid("BLEND", 0.75)) / open;
    assert!((quarter - 0.25).abs() < 0.04, "a quarter of the light passes, not {quarter}");
}

/// Inside a closed box that emits 1 and reflects everything, each bounce adds 1: L = 1 + 1 + bounces.
#[test]
fn a_closed_white_box_keeps_all_light() {
    let mut walls = white_metal(1.0);
    walls["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
    let inside = load(&glb::model(&glb::cuboid([-1.0; 3], [1.0; 3], false), &walls));
    let camera = ["camera.eye=[0.3, 0.2, 0.4]", "camera.target=[0, 0, -1]", "camera.fovy=60", "view.frames=48"];
    let mut headless = bare(inside, &[&camera[..], &["MULTI_SCATTER=KullaConty"]].concat());
    for bounces in [0, 3] {
        set(&mut headless, &format!("view.bounces={bounces}"));
        let expected = 2.0 + bounces as f32;
        assert_near(whole(&render(&mut headless, "path-traced")), [expected; 3], 0.01 * expected, "in the box");
        assert_near(whole(&render(&mut headless, "bounce-error")), [expected - 1.0; 3], 0.01 * expected, "bounces");
    }
}

#[test]
fn a_white_ball_cannot_be_seen_in_a_furnace() {
    let ball = load(&glb::model(&glb::sphere(16, 32), &white_metal(0.8)));
    let mut headless = bare(ball, &["environment.name=furnace", "view.frames=64", "MULTI_SCATTER=KullaConty"]);
    let middle = (16..32, 8..24);
    for mode in ["path-traced", "monte-carlo"] {
        let found = mean(&render(&mut headless, mode), middle.0.clone(), middle.1.clone());
        assert_near(found, [1.0; 3], 0.01, mode);
    }
    // The same light without an environment: ambient light is a sky too.
    set(&mut headless, "environment.name=none");
    set(&mut headless, "lights.ambient_strength=1");
    set(&mut headless, "lights.ambient_color=[1, 1, 1]");
    assert_near(mean(&render(&mut headless, "path-traced"), middle.0, middle.1), [1.0; 3], 0.01, "ambient");
}

/// Beside a red wall that shines, the floor is red although no lamp is lit.
#[test]
fn light_bounces_from_wall_to_floor() {
    let wall = glb::cuboid([-2.2, 0.0, -2.0], [-2.0, 2.0, 2.0], true);
    let mut shining = matte(0.0);
    shining["emissiveFactor"] = json!([1.0, 0.0, 0.0]);
    let model = load(&glb::scene(&[(floor(), matte(0.8)), (wall, shining)]));
    let mut headless = bare(model, &[&FROM_ABOVE[..], &["view.frames=32"]].concat());
    let capture = render(&mut headless, "bounce-error");
    let (near, far) = (mean(&capture, LEFT.0, LEFT.1), mean(&capture, 34..37, 12..20));
    assert!(near[0] > 2.0 * far[0] && far[0] > 0.0 && near[1] == 0.0 && near[2] == 0.0, "{near:?} {far:?}");
    assert_eq!(whole(&render(&mut headless, "final"))[1], 0.0);
    let picture = render(&mut headless, "final");
    assert_eq!(mean(&picture, LEFT.0, LEFT.1), [0.0; 3], "the picture has no such light");
}

/// The rectangle right above the floor is sampled on purpose and hit by chance; both ways together must agree with transformed
/// cosines. Those take the floor's albedo as a mean over the hemisphere, which is off by 4 % for light from right above.
#[test]
fn a_rectangle_lights_as_transformed_cosines_say() {
    let rect = [
        "lights.rect.enabled=true",
        "lights.rect.polar=0",
        "lights.rect.distance=1",
        "lights.rect.strength=1",
        "DIFFUSE_COUPLING=GltfSample",
    ];
    let mut headless =
        bare(load(&glb::model(&floor(), &matte(0.5))), &[&FROM_ABOVE[..], &rect, &["view.frames=64"]].concat());
    let picture = mean(&render(&mut headless, "final"), MIDDLE.0, MIDDLE.1);
    let traced = mean(&render(&mut headless, "path-traced"), MIDDLE.0, MIDDLE.1);
    assert!(picture[0] > 0.01, "{picture:?}");
    assert_near(traced, picture, 0.05 * picture[0], "a rectangle");
}

/// The estimate must not depend on how directions are drawn.
#[test]
fn light_sampling_and_lobes_alone_agree() {
    let ball = || load(&glb::model(&glb::sphere(16, 32), &glb::gray()));
    let chosen =
        ["environment.name=studio", "view.msaa=1", "view.background=none", "lights.source=none", "view.frames=96"];
    let mut session = Session::new(ball(), settings(&chosen));
    let all = |session: &mut Session, mode: &str| mean(&session.mode(mode), 0..96, 0..64);
    for mode in ["monte-carlo", "path-traced"] {
        let both = all(&mut session, mode);
        ready(&session.edit("paths/environment_sampling.glsl", "&& cells_a_side > 0u; }", "&& false; }"));
        let lobes = all(&mut session, mode);
        ready(&session.edit("paths/environment_sampling.glsl", "&& false; }", "&& cells_a_side > 0u; }"));
        assert_near(lobes, both, 0.02 * both[1], mode);
    }
}

#[test]
fn the_parts_of_the_error_add_up() {
    let block = glb::cuboid([-0.6, 0.0, -0.6], [0.6, 1.0, 0.6], true);
    let shiny = json!({ "pbrMetallicRoughness": { "metallicFactor": 1.0, "roughnessFactor": 0.4 } });
    let model = load(&glb::scene(&[(floor(), matte(0.7)), (block, shiny)]));
    let chosen = ["environment.name=studio", "lights.orbit.0.strength=2", "view.frames=48", "camera.elevation=40"];
    let mut headless = bare(model, &chosen);
    let mut of = |mode: &str| whole(&render(&mut headless, mode));
    let split = ["prefilter-error", "split-sum-error", "occlusion-error", "shadow-error", "bounce-error"].map(&mut of);
    let sum: [f32; 3] = std::array::from_fn(|c| split.iter().map(|part| part[c]).sum());
    let (error, image_based, picture, traced) = (of("path-error"), of("ibl-error"), of("final"), of("path-traced"));
    let size = split.iter().map(|part| part[1].abs()).sum::<f32>();
    assert!(split[1..].iter().all(|part| part[1].abs() > 1e-4), "{split:?}");
    assert_near(sum, error, 0.04 * size, "the sum of the parts");
    assert_near([0, 1, 2].map(|c| traced[c] - picture[c]), error, 0.04 * size, "path traced minus picture");
    assert_near([0, 1, 2].map(|c| split[0][c] + split[1][c]), image_based, 0.02 * size, "the first two parts");
}

/// Wrong values of the baked map belong to `prefilter-error` alone.
#[test]
fn the_prefilter_is_told_apart_from_the_split_sum() {
    let chosen =
        ["environment.name=studio", "view.msaa=1", "view.background=none", "lights.source=none", "view.frames=48"];
    let metal = json!({ "pbrMetallicRoughness": { "metallicFactor": 1.0, "roughnessFactor": 0.5 } });
    let mut session = Session::new(load(&glb::model(&glb::sphere(16, 32), &metal)), settings(&chosen));
    let all = |session: &mut Session, mode: &str| mean(&session.mode(mode), 0..96, 0..64)[1];
    let [prefilter, split_sum] = ["prefilter-error", "split-sum-error"].map(|mode| all(&mut session, mode));
    let light = all(&mut session, "ibl-specular");
    let from = "return frame.environment_intensity * sky;";
    let to = "return 1.2 * frame.environment_intensity * sky;";
    ready(&session.edit("lighting/environment.glsl", from, to));
    let [wrong, unchanged] = ["prefilter-error", "split-sum-error"].map(|mode| all(&mut session, mode));
    assert!((wrong - prefilter + 0.2 * light).abs() < 0.002 * light, "{prefilter} {wrong}, of {light}");
    assert!((unchanged - split_sum).abs() < 0.002 * light, "{split_sum} {unchanged}, of {light}");
    assert!(prefilter.abs() < 0.03 * light, "{prefilter} of {light}");
}

#[test]
fn models_without_triangles_normals_or_coordinates_work() {
    // Points instead of triangles: nothing to hit.
    let (mut json, bin) = glb::document(&glb::quad(1.0), &glb::gray());
    json["meshes"][0]["primitives"][0]["mode"] = json!(0);
    let mut headless = bare(load(&glb::container(&json, &bin)), &["environment.name=studio", "view.frames=2"]);
    assert!(!render(&mut headless, "path-traced").not_finite.contains(&true));
    // Neither indices nor normals nor texture coordinates.
    let (mut json, bin) = glb::document(&glb::Mesh { normals: Vec::new(), ..glb::quad(1.0) }, &glb::gray());
    json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    json["accessors"][0]["count"] = json!(3);
    let chosen = ["environment.name=furnace", "view.frames=4", "camera.azimuth=0", "camera.elevation=0"];
    let mut headless = bare(load(&glb::container(&json, &bin)), &chosen);
    let found = whole(&render(&mut headless, "path-traced"));
    assert!(found[0] > 0.3 && found[0] < 1.0, "{found:?}");
    // No model at all.
    let mut headless = bare(Model::default(), &["view.frames=2"]);
    render(&mut headless, "path-traced");
    assert_validated();
}

/// An edit that divides by zero in some directions marks the pixels that see it, and leaves no trace once it is corrected.
#[test]
fn a_broken_formula_is_marked_and_does_not_stay() {
    let chosen =
        ["environment.name=studio", "view.msaa=1", "view.background=none", "lights.source=none", "view.frames=4"];
    let ball = load(&glb::model(&glb::sphere(16, 32), &glb::gray()));
    let mut session = Session::new(ball, settings(&chosen));
    let good = session.mode("path-traced");
    assert!(!good.not_finite.contains(&true));
    let unedited = "    brdf.sheen *= above;\n";
    let with = |line: &str| format!("{unedited}    if (l.x > 0.5) {line}\n");
    let (nan, huge) = (with("brdf.diffuse = vec3(sqrt(-1.0 - brdf.n_dot_v));"), with("brdf.diffuse *= 1e20;"));
    ready(&session.edit("brdf/evaluate.glsl", unedited, &nan));
    for (next, why) in [(&huge, "not a number"), (&unedited.to_owned(), "too large")] {
        let capture = session.render();
        let marked = capture.not_finite.iter().filter(|is_bad| **is_bad).count();
        assert!(marked > 50, "{why}: {marked} pixels are marked");
        assert!(capture.raw.iter().flatten().all(|x| x.abs() < 1e4), "{why}: the mean is swamped");
        let before = if why == "too large" { &huge } else { &nan };
        ready(&session.edit("brdf/evaluate.glsl", before, next));
    }
    crate::support::assert_same(&good, &session.render(), "after the correction");
}
