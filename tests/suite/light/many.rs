//! Many lights: the grid leaves out only lights that do not reach a point, whatever the camera, the size, the mode and the hooks are.

use glam::Vec3;
use specula::interface::{FEW_LIGHTS, MAX_LIGHTS};
use specula::render::Capture;
use specula::scene::{Light, LightKind, Model};

use crate::support::{
    Session, assert_differ, assert_same, assert_validated, differing, model, ready, render, renderer, settings,
};

/// The light of many lights alone.
const BARE: [&str; 5] = [
    "lights.source=model",
    "environment.name=none",
    "lights.ambient_strength=0",
    "view.background=none",
    "view.msaa=1",
];

/// The corner of a room with this many lights in it: points and cones, some without a range, one directional.
fn room(count: usize) -> Model {
    let room = model("many-lights");
    let size = room.bounds.max - room.bounds.min;
    let step = Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let light = |index: usize| {
        let aim = Vec3::new((index as f32).sin(), -0.5, (index as f32).cos()).normalize();
        let kind = match index % 5 {
            0 => LightKind::Spot { inner: 0.2, outer: 0.5 },
            1 => LightKind::Spot { inner: 0.5, outer: 1.2 },
            _ => LightKind::Point,
        };
        Light {
            name: "".into(),
            kind: if index == 37 { LightKind::Directional } else { kind },
            position: room.bounds.min + size * (Vec3::splat(0.5) + step * index as f32).fract(),
            direction: aim,
            intensity: Vec3::new(1.0, 0.5 + 0.5 * aim.x.abs(), 0.4) * size.x * size.x * 0.02,
            range: (index % 50 != 3).then_some(size.x * (0.06 + 0.02 * (index % 7) as f32)),
        }
    };
    Model { lights: (0..count).map(light).collect(), ..room }
}

/// Sums of channels of two pictures, pixel by pixel.
fn sum(a: &Capture, b: &Capture) -> Vec<f32> {
    a.raw.iter().flatten().zip(b.raw.iter().flatten()).map(|(a, b)| a + b).collect()
}

/// Fails unless light differs by rounding alone: half floats have 11 bits, and the order of a sum is another.
#[track_caller]
fn assert_near(a: &Capture, b: &Capture, why: &str) {
    assert!(differing(a, b) * 200 <= a.raw.len(), "{why}: {} pixels differ as displayed", differing(a, b));
    for (a, b) in a.raw.iter().flatten().zip(b.raw.iter().flatten()) {
        assert!((a - b).abs() <= 1e-3 * b.abs() + 1e-6, "{why}: {a}, not {b}");
    }
}

/// With a `user_light` that stores to the range of a light, every light counts for every point: the plain loop. Its picture is the same
/// up to rounding.
#[test]
fn the_grid_shows_the_picture_of_a_loop_over_all_lights() {
    let mut session = Session::new(room(300), settings(&BARE));
    let outside = ["camera.azimuth=60", "camera.elevation=40"];
    let inside = ["camera.eye=[0, 2, 0]", "camera.target=[-4, 1, -4]"];
    let parallel = ["camera.height=6"];
    let all: [(&[&str], &str, (u32, u32)); 7] = [
        (&[], "final", (96, 64)),
        (&outside, "final", (48, 32)),
        (&inside, "final", (53, 71)),
        (&parallel, "final", (53, 71)),
        (&["SHADOWS=Hard", "passes.ground=true"], "final", (96, 64)),
        (&["lights.chosen=120"], "direct-diffuse", (96, 64)),
        (&[], "diffuse-lobe", (96, 64)),
    ];
    let draw = |session: &mut Session| -> Vec<Capture> {
        let frame = |(more, mode, size): &(&[&str], &str, (u32, u32))| {
            *session.headless.settings_mut() = settings(&[&BARE[..], more].concat());
            session.headless.set_size(*size).unwrap();
            session.mode(mode)
        };
        all.iter().map(frame).collect()
    };
    let by_grid = draw(&mut session);
    ready(&session.edit(
        "user.glsl",
        "vec3 position_ws) {\n}",
        "vec3 position_ws) {\n    light.inverse_range *= 1.0;\n}",
    ));
    let by_loop = draw(&mut session);
    for (index, (grid, plain)) in by_grid.iter().zip(&by_loop).enumerate() {
        assert_near(grid, plain, &format!("{:?}", all[index]));
    }
    assert_differ(&by_grid[2], &by_grid[3], "another camera");
    assert_differ(&by_grid[0], &by_grid[4], "shadows");
    // A hook that moves lights is followed beyond the cells in which they were.
    let up = room(300).lights.into_iter().map(|light| Light { position: light.position + Vec3::Y * 0.5, ..light });
    let moved = Model { lights: up.collect(), ..room(300) };
    ready(&session.edit(
        "user.glsl",
        "light.inverse_range *= 1.0;",
        "light.position_ws.y += 0.5 * light.position_ws.w;",
    ));
    let hooked = session.render();
    let mut renderer = renderer(moved, session.headless.settings_mut().clone(), (96, 64));
    let slug = renderer.settings_mut().mode.clone();
    let expected = render(&mut renderer, &slug);
    assert!(differing(&hooked, &expected) < 20, "{} pixels differ", differing(&hooked, &expected));
}

/// Few lights come from a uniform block and are looped over, many from a buffer and the grid. Light adds up across that border.
#[test]
fn few_lights_and_many_add_up() {
    let all = room(2 * FEW_LIGHTS);
    let part = |first: usize| Model { lights: all.lights[first..first + FEW_LIGHTS].to_vec(), ..all.clone() };
    let mut renderer = renderer(part(0), settings(&BARE), (96, 64));
    let first = render(&mut renderer, "final");
    renderer.set_model(part(FEW_LIGHTS)).unwrap();
    let last = render(&mut renderer, "final");
    renderer.set_model(all.clone()).unwrap();
    let whole = render(&mut renderer, "final");
    let again = render(&mut renderer, "final");
    assert_same(&whole, &again, "two runs");
    let brightest = whole.raw.iter().flatten().copied().fold(0.0, f32::max);
    for ((index, sum), whole) in sum(&first, &last).iter().enumerate().zip(whole.raw.iter().flatten()) {
        // Alpha is coverage. Half floats have 11 bits.
        let is_near = (sum - whole).abs() <= 2e-3 * sum.abs() + 1e-4 * brightest;
        assert!(index % 4 == 3 || is_near, "{index}: {sum}, not {whole}");
    }
}

/// Random paths draw one of the many lights at each point, and their mean is the picture without shadows: on a floor that hides nothing.
#[test]
fn random_paths_draw_many_lights_without_bias() {
    use crate::support::{glb, load};
    let floor = glb::Mesh {
        positions: vec![[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
    };
    let matte = serde_json::json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 1.0 } });
    let mut model = load(&glb::scene(&[(floor, matte)]));
    let step = Vec3::new(0.754_877_7, 0.569_840_3, 0.438_447_2);
    let light = |index: usize| {
        let at = (step * (index + 1) as f32).fract();
        Light {
            name: "".into(),
            kind: LightKind::Point,
            position: Vec3::new(4.0 * at.x - 2.0, 0.2 + 0.4 * at.z, 4.0 * at.y - 2.0),
            direction: Vec3::NEG_Y,
            intensity: Vec3::splat(if index.is_multiple_of(25) { 1.0 } else { 0.05 }),
            // Every point has some 40 lights without a range, and as many with one.
            range: (!index.is_multiple_of(25)).then_some(0.7),
        }
    };
    model.lights = (0..1000).map(light).collect();
    let view = ["camera.eye=[0, 6, 0.001]", "camera.target=[0, 0, 0]", "camera.fovy=30", "view.bounces=0"];
    let rectangle = ["lights.rect.enabled=true", "lights.rect.polar=20"];
    let columns = |lights: &[Light], mode: &str, more: &[&str]| {
        let settings = settings(&[&BARE[..], &view, &["view.frames=64"], more].concat());
        let mut renderer = renderer(Model { lights: lights.to_vec(), ..model.clone() }, settings, (48, 32));
        let capture = render(&mut renderer, mode);
        [0, 1, 2, 3].map(|column| -> f64 {
            let pixels = capture.raw.iter().enumerate().filter(|(at, _)| at % 48 / 12 == column);
            pixels.map(|(_, pixel)| f64::from(pixel[0] + pixel[1])).sum()
        })
    };
    let picture = columns(&model.lights, "final", &[]);
    let traced = columns(&model.lights, "path-traced", &[]);
    // Light adds up, whichever way its lights are drawn. (The picture's own rectangle is an approximation.)
    let of_rectangle = columns(&[], "path-traced", &rectangle);
    let of_both = columns(&model.lights, "path-traced", &rectangle);
    for column in 0..4 {
        let (sum, both) = (traced[column] + of_rectangle[column], of_both[column]);
        assert!((traced[column] / picture[column] - 1.0).abs() < 0.03, "{traced:?}, the picture {picture:?}");
        assert!(
            of_rectangle[column] > 0.0 && (both / sum - 1.0).abs() < 0.03,
            "{of_both:?}, {traced:?}, {of_rectangle:?}"
        );
    }
    assert_validated();
}

/// A model may have more lights than a frame: the first shine, and it says so.
#[test]
fn more_lights_than_a_frame_has_are_told_once() {
    use crate::support::{glb, load};
    let (mut json, bin) = glb::document(&glb::quad(1.0), &serde_json::json!({}));
    json["extensionsUsed"] = serde_json::json!(["KHR_lights_punctual"]);
    json["extensions"] = serde_json::json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
    let lamp = serde_json::json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    json["nodes"].as_array_mut().unwrap().extend(vec![lamp; MAX_LIGHTS + 1]);
    json["scenes"][0]["nodes"] = (0..MAX_LIGHTS + 2).collect();
    let model = load(&glb::container(&json, &bin));
    let told: Vec<&String> = model.warnings.iter().filter(|warning| warning.contains("lights")).collect();
    assert_eq!(told, [&format!("it has {} lights: the first {MAX_LIGHTS} shine.", MAX_LIGHTS + 1)]);
}
