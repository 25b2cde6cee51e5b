//! Suns of a map from a file: small bright sources, which light the model as lamps do.
//!
//! The reference sums over the map with a GGX of its own. Each map has a dim gradient and suns of one texel, which the sampler's
//! linear interpolation makes a tent of two texels to a side.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use exr::prelude::{Image, SpecificChannels, WritableImage as _};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::render::Capture;
use specula::scene::environment::{direction_from_uv, uv_from_direction};
use tempfile::TempDir;

use crate::support::process::{self, specula};
use crate::support::{Renderer, assert_differ, assert_same, assert_validated, glb, load, render, renderer, settings};

/// Columns and rows of the maps. A sun of one texel is about a degree wide.
const MAP: (usize, usize) = (512, 256);
const SIZE: (u32, u32) = (64, 48);
const EYE: DVec3 = DVec3::new(0.0, 0.0, 3.2);

/// Parts of a texel with a sun along each axis, which the reference sums over.
const PARTS: usize = 8;

/// A texel with another radiance than the gradient.
type Bright = ((usize, usize), f64);

/// Radiance of the gradient.
fn dim(direction: DVec3) -> f64 {
    0.1 + 0.05 * direction.y
}

fn direction(x: f64, y: f64) -> DVec3 {
    direction_from_uv((x / MAP.0 as f64) as f32, (y / MAP.1 as f64) as f32).as_dvec3()
}

/// The texel around a direction.
fn texel(d: Vec3) -> (usize, usize) {
    let uv = uv_from_direction(d);
    ((uv.x * MAP.0 as f32) as usize, (uv.y * MAP.1 as f32) as usize)
}

/// Writes a map as an EXR file of 32-bit floats.
fn write(path: &Path, bright: &[Bright]) {
    let radiance = |at: exr::prelude::Vec2<usize>| {
        let found = bright.iter().find(|(texel, _)| *texel == (at.x(), at.y()));
        let value = found.map_or_else(|| dim(direction(at.x() as f64 + 0.5, at.y() as f64 + 0.5)), |(_, value)| *value);
        (value as f32, value as f32, value as f32)
    };
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_channels(MAP, SpecificChannels::rgb(radiance)).write().to_buffered(&mut bytes).unwrap();
    fs::write(path, bytes.into_inner()).unwrap();
}

/// The map as points: directions, and radiance times solid angle.
fn points(bright: &[Bright]) -> Vec<(DVec3, f64)> {
    let mut points = Vec::new();
    let (columns, rows) = (96, 48);
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let cosine = |edge: usize| (edge as f64 / rows as f64 * PI).cos();
        let solid_angle = (cosine(row) - cosine(row + 1)) * TAU / columns as f64;
        let center = |index: usize, of: usize, count: usize| (index as f64 + 0.5) * of as f64 / count as f64;
        let d = direction(center(column, MAP.0, columns), center(row, MAP.1, rows));
        points.push((d, dim(d) * solid_angle));
    }
    for ((x, y), radiance) in bright {
        for part in 0..PARTS * PARTS {
            let [s, t] = [part % PARTS, part / PARTS].map(|i| (i as f64 + 0.5) * 2.0 / PARTS as f64 - 1.0);
            let weight = (1.0 - s.abs()) * (1.0 - t.abs()) * (2.0 / PARTS as f64).powi(2);
            let (u, v) = (*x as f64 + 0.5 + s, *y as f64 + 0.5 + t);
            let solid_angle = TAU / MAP.0 as f64 * PI / MAP.1 as f64 * (v / MAP.1 as f64 * PI).sin();
            points.push((direction(u, v), radiance * weight * solid_angle));
        }
    }
    points
}

/// D V NoL of GGX with height-correlated masking (Heitz 2014, eq. 99).
fn ggx(n: DVec3, l: DVec3, v: DVec3, roughness: f64) -> f64 {
    let a2 = roughness.powi(4);
    let h = (l + v).normalize();
    let (n_dot_l, n_dot_v, n_dot_h) = (n.dot(l), n.dot(v).max(1e-4), n.dot(h));
    if n_dot_l <= 0.0 {
        return 0.0;
    }
    let d = a2 / (PI * (n_dot_h * n_dot_h * (a2 - 1.0) + 1.0).powi(2));
    let root = |c: f64| (c * c * (1.0 - a2) + a2).sqrt();
    d * 0.5 / (n_dot_v * root(n_dot_l) + n_dot_l * root(n_dot_v)) * n_dot_l
}

/// A white metal ball under the map of a file, without multiple scattering.
fn ball(path: &Path) -> Renderer {
    let chosen = settings(&[
        &format!("environment.name={}", path.display()),
        "view.msaa=1",
        "view.background=none",
        "lights.source=none",
        "camera.eye=[0, 0, 3.2]",
        "camera.target=[0, 0, 0]",
        "material.enabled=true",
        "material.metallic=1",
        "material.base_color=[1, 1, 1]",
        "MULTI_SCATTER=None",
    ]);
    renderer(load(&glb::model(&glb::sphere(48, 96), &glb::gray())), chosen, SIZE)
}

/// Normals and directions to the eye of some pixels, by their indices.
fn pixels(headless: &mut Headless) -> Vec<(usize, DVec3, DVec3)> {
    let [normals, positions] = ["shading-normal", "position"].map(|mode| render(headless, mode));
    let vector = |v: &[f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
    let covered = (0..normals.raw.len()).filter(|i| normals.raw[*i][3] == 1.0 && positions.raw[*i][3] == 1.0);
    let all = covered.map(|i| (i, vector(&normals.raw[i]).normalize(), (EYE - vector(&positions.raw[i])).normalize()));
    all.filter(|(_, n, v)| n.dot(*v) > 0.1).collect()
}

/// The mean difference and the mean absolute one of the pixels' red channel from the expected values, relative to their mean.
fn error(picture: &Capture, expected: &[(usize, f64)]) -> [f64; 2] {
    let mean: f64 = expected.iter().map(|(_, value)| value).sum();
    let off = expected.iter().map(|(i, value)| f64::from(picture.raw[*i][0]) - value);
    let (sum, size) = off.fold((0.0, 0.0), |(sum, size), off: f64| (sum + off, size + off.abs()));
    [sum / mean, size / mean]
}

fn set(headless: &mut Headless, assignment: &str) {
    headless.settings_mut().assign(assignment).unwrap();
}

/// A sun on the far side, whose highlight is at a grazing angle, and a weaker one on the near side.
fn two_suns() -> [Bright; 2] {
    [(texel(Vec3::new(0.7, 0.5, -0.4)), 1.2e4), (texel(Vec3::new(-0.7, -0.2, 0.5)), 3e3)]
}

fn folder(bright: &[Bright]) -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    write(&directory.path().join("map.exr"), bright);
    directory
}

#[test]
fn a_metal_ball_under_suns_of_a_file_is_as_bright_as_a_sum_over_the_map() {
    let suns = two_suns();
    for bright in [&suns[..1], &suns[..]] {
        let directory = folder(bright);
        let mut headless = ball(&directory.path().join("map.exr"));
        let (shown, points) = (pixels(&mut headless), points(bright));
        assert!(shown.len() > 400, "{} pixels", shown.len());
        let sums = |weight: &dyn Fn(DVec3, DVec3, DVec3) -> f64| -> Vec<(usize, f64)> {
            let sum = |n: DVec3, v: DVec3| points.iter().map(|(l, light)| light * weight(n, *l, v)).sum::<f64>();
            shown.iter().map(|(i, n, v)| (*i, sum(*n, *v))).collect()
        };
        for roughness in [0.2, 0.5, 0.8, 1.0] {
            set(&mut headless, &format!("material.roughness={roughness}"));
            let expected = sums(&|n, l, v| ggx(n, l, v, roughness));
            let [bias, off] = error(&render(&mut headless, "final"), &expected);
            println!("{} suns, roughness {roughness}: {:.1} %, L1 {:.1} %", bright.len(), 100.0 * bias, 100.0 * off);
            assert!(bias.abs() < 0.03 && off < 0.15, "roughness {roughness}: off by {off}, all in all by {bias}");
        }
        let expected = sums(&|n, l, _| n.dot(l).max(0.0));
        for on in [true, false] {
            set(&mut headless, &format!("environment.suns={on}"));
            let [bias, off] = error(&render(&mut headless, "irradiance"), &expected);
            assert!(bias.abs() < 0.01 && off < 0.01, "irradiance, suns {on}: off by {off}, all in all by {bias}");
        }
        set(&mut headless, "material.roughness=0.5");
        let [_, off] = error(&render(&mut headless, "final"), &sums(&|n, l, v| ggx(n, l, v, 0.5)));
        assert!(off > 0.2, "the split sum of a sun is off by {off} only: the map tests nothing");
    }
    assert_validated();
}

#[test]
fn a_map_without_suns_gives_the_same_picture_with_and_without_the_setting() {
    // A window is no sun.
    let window: Vec<Bright> = (0..24 * 24).map(|i| ((300 + i % 24, 60 + i / 24), 40.0)).collect();
    for (what, bright, most) in [("a gradient", Vec::new(), 0.0), ("a window", window, 1e-3)] {
        let directory = folder(&bright);
        let mut headless = ball(&directory.path().join("map.exr"));
        set(&mut headless, "material.roughness=0.5");
        let on = render(&mut headless, "final");
        set(&mut headless, "environment.suns=false");
        let off = render(&mut headless, "final");
        let difference =
            on.raw.as_flattened().iter().zip(off.raw.as_flattened()).map(|(a, b)| (a - b).abs() / b.max(1e-3));
        let difference = difference.fold(0.0, f32::max);
        assert!(difference <= most, "{what}: {difference}");
    }
    assert_validated();
}

/// Half floats end long before a sun in cd/m^2 does.
#[test]
fn a_sun_beyond_half_floats_keeps_its_light() {
    let bright = [(texel(Vec3::new(0.5, 0.5, 0.7)), 1e9)];
    let directory = folder(&bright);
    let mut headless = ball(&directory.path().join("map.exr"));
    set(&mut headless, "environment.intensity=1e-4");
    let (shown, points) = (pixels(&mut headless), points(&bright));
    let irradiance = |n: DVec3| points.iter().map(|(l, light)| 1e-4 * light * n.dot(*l).max(0.0)).sum::<f64>();
    let expected: Vec<(usize, f64)> = shown.iter().map(|(i, n, _)| (*i, irradiance(*n))).collect();
    let [bias, off] = error(&render(&mut headless, "irradiance"), &expected);
    assert!(bias.abs() < 0.01 && off < 0.01, "off by {off}, all in all by {bias}");
}

/// A ball over a slab: shadows as those of random paths, which do not change with the setting.
#[test]
fn suns_of_a_file_throw_shadows() {
    let directory = folder(&[(texel(Vec3::new(0.4, 0.8, 0.3)), 1.2e5)]);
    let matte = json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.3, 0.3, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}});
    let slab = glb::cuboid([-2.0, -1.4, -2.0], [2.0, -1.1, 2.0], true);
    let model = load(&glb::scene(&[(glb::sphere(24, 48), matte.clone()), (slab, matte)]));
    let chosen = settings(&[
        &format!("environment.name={}", directory.path().join("map.exr").display()),
        "view.msaa=1",
        "view.background=none",
        "view.frames=256",
        "view.bounces=0",
        "lights.source=none",
    ]);
    let mut headless = renderer(model, chosen, SIZE);
    let truth = render(&mut headless, "path-traced");
    let open = render(&mut headless, "final");
    set(&mut headless, "SHADOWS=Hard");
    let hard = render(&mut headless, "final");
    set(&mut headless, "SHADOWS=Soft");
    let soft = render(&mut headless, "final");
    let off = |picture: &Capture| {
        let pixels = picture.raw.iter().zip(&truth.raw).filter(|(pixel, _)| pixel[3] == 1.0);
        pixels.map(|(a, b)| f64::from(a[1] - b[1]).powi(2)).sum::<f64>().sqrt()
    };
    let [open, hard, soft] = [&open, &hard, &soft].map(off);
    println!("without shadows {open:.4}, hard {hard:.4}, soft {soft:.4}");
    assert!(hard < 0.35 * open && soft < 0.35 * open, "{hard} and {soft} of {open}");

    // An orbiting light has the first tile of the map, the sun the next.
    set(&mut headless, "lights.source=orbit");
    set(&mut headless, "lights.orbit.0.strength=0");
    set(&mut headless, "lights.orbit.1.strength=0");
    set(&mut headless, "lights.orbit.2.strength=0");
    let beside = render(&mut headless, "final");
    assert!(off(&beside) < 0.35 * open, "{} of {open}", off(&beside));
    set(&mut headless, "lights.source=none");
    set(&mut headless, "SHADOWS=Off");
    set(&mut headless, "view.frames=4");
    let paths = render(&mut headless, "path-traced");
    set(&mut headless, "environment.suns=false");
    assert_same(&paths, &render(&mut headless, "path-traced"), "random paths sample the map, whose suns it still has");
    assert_validated();
}

/// The setting is an input of the bake, in memory and on disk.
#[test]
fn a_bake_with_suns_is_another_than_one_without() {
    let directory = folder(&two_suns());
    let white = json!({ "pbrMetallicRoughness": { "roughnessFactor": 0.5 } });
    fs::write(directory.path().join("ball.glb"), glb::model(&glb::sphere(16, 32), &white)).unwrap();
    let baked = |suns: bool| {
        let mut command = specula(directory.path());
        command.env("SPECULA_CACHE", directory.path().join("cache"));
        command.args(["render", "ball.glb", "--env", "map.exr", "--out", "out.exr", "--events", "json"]);
        command.args(["--size", "48x32", "--lights", "none", "--set", "view.msaa=1"]);
        command.args(["--set", &format!("environment.suns={suns}")]);
        let finished = process::finish(&mut command);
        finished.expect(0, &[]);
        let events = finished.stdout.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        let bake = events.into_iter().find(|event| event["event"] == "bake").expect("a bake event");
        (bake["cached"].as_bool().unwrap(), fs::read(directory.path().join("out.exr")).unwrap())
    };
    let (first, without, again, without_again) = (baked(true), baked(false), baked(true), baked(false));
    assert_eq!([first.0, without.0, again.0, without_again.0], [false, false, true, true]);
    assert!(first.1 == again.1 && without.1 == without_again.1, "what came from the cache looks different");
    assert!(first.1 != without.1, "the setting changes nothing");

    // The same renderer takes no part of one bake for the other.
    let mut headless = ball(&directory.path().join("map.exr"));
    let with = render(&mut headless, "final");
    set(&mut headless, "environment.suns=false");
    assert_differ(&with, &render(&mut headless, "final"), "suns");
    set(&mut headless, "environment.suns=true");
    assert_same(&with, &render(&mut headless, "final"), "suns again");
}

/// The levels that a blurred background reads do not have the sun.
#[test]
fn a_blurred_background_has_its_sun() {
    // From above the model towards the zenith.
    let up = ["camera.eye=[0, 5, 0]", "camera.target=[0, 10, 0.1]", "camera.fovy=100"];
    let sky = ["environment.name=sky", "environment.blur=0.6", "view.background=env", "view.msaa=1"];
    let model = load(&glb::model(&glb::quad(0.1), &glb::gray()));
    let mut headless = renderer(model, settings(&[&up[..], &sky[..]].concat()), SIZE);
    let mut light = |on: bool| -> Vec<f64> {
        set(&mut headless, &format!("environment.suns={on}"));
        render(&mut headless, "final").raw.iter().map(|value| f64::from(value[1])).collect()
    };
    let (with, without) = (light(true), light(false));
    let mean = |light: &[f64]| light.iter().sum::<f64>() / light.len() as f64;
    assert!((mean(&with) / mean(&without) - 1.0).abs() < 0.03, "{} and {}", mean(&with), mean(&without));
    let peak = |light: &[f64]| light.iter().copied().fold(0.0, f64::max);
    assert!(peak(&without) > 1.5 * mean(&without), "no sun is seen");
    assert!((peak(&with) / peak(&without) - 1.0).abs() < 0.1, "{} and {}", peak(&with), peak(&without));
    assert_validated();
}

/// A sun that is no longer separated leaves no dark one behind, which would have no shadow map.
#[test]
fn a_sky_without_its_sun_is_finite_behind_glass() {
    let mut glass = glb::gray();
    glass["extensions"] = json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 } });
    let model = load(&glb::model(&glb::sphere(16, 32), &glass));
    let mut headless = renderer(model, settings(&["environment.name=sky", "shader.SHADOWS=Hard"]), SIZE);
    for on in [true, false, true] {
        set(&mut headless, &format!("environment.suns={on}"));
        let capture = render(&mut headless, "final");
        assert!(!capture.not_finite.contains(&true), "suns {on}");
    }
    assert_validated();
}
