//! Environments: the bake matches the file or name, a bad file keeps the last good one, and the cache is reliable.

mod of_model;
mod suns;

use std::fs;
use std::path::Path;

use crate::support::process::{Finished, Running, run, specula};
use crate::support::{
    Renderer, Session, Tree, assert_differ, assert_same, assert_validated, failed, glb, hdr, load, model, open_image,
    ready, render, renderer, settings,
};
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, SpecificChannels, WritableImage as _};
use serde_json::Value;
use specula::headless::Headless;
use specula::render::Capture;
use tempfile::TempDir;

const SMALL: [&str; 6] = ["--size", "48x32", "--set", "view.msaa=1", "--lights", "none"];

/// A folder with a model of a small white sphere.
fn folder() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    let white = serde_json::json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0 } });
    fs::write(directory.path().join("ball.glb"), glb::model(&glb::sphere(16, 32), &white)).unwrap();
    directory
}

/// Runs `render` of the sphere in an environment, with validation layers.
fn lit_by(directory: &Path, environment: &str, more: &[&str]) -> Finished {
    let args = ["render", "ball.glb", "--env", environment, "--validate", "--out", "out.exr"];
    run(directory, &[&args[..], &SMALL, more].concat())
}

/// A gray EXR of 4x2 pixels with one other pixel.
fn exr_with(odd: (f32, f32, f32)) -> Vec<u8> {
    let channels = SpecificChannels::rgb(
        move |at: exr::prelude::Vec2<usize>| {
            if (at.x(), at.y()) == (2, 1) { odd } else { (0.5, 0.5, 0.5) }
        },
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_channels((4, 2), channels).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// An EXR with a luminance channel only.
fn exr_of_luminance() -> Vec<u8> {
    let channels = AnyChannels::sort([AnyChannel::new("Y", FlatSamples::F32(vec![1.0; 8]))].into_iter().collect());
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_channels((4, 2), channels).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn a_bad_file_is_named_with_the_reason() {
    let directory = folder();
    let whole = hdr::red_and_blue();
    for (name, bytes, parts) in [
        ("short.hdr", whole[..whole.len() - 20].to_vec(), ["does not decode as Radiance HDR", "cut short"]),
        ("nan.exr", exr_with((0.5, f32::NAN, 0.5)), ["NaN in green at x = 2, y = 1", "expected finite"]),
    ] {
        fs::write(directory.path().join(name), bytes).unwrap();
        lit_by(directory.path(), name, &[]).expect(1, &[&[name], &parts[..]].concat());
    }
    lit_by(directory.path(), "nowhere.hdr", &[]).expect(1, &["nowhere.hdr", "studio, furnace, sky"]);
    lit_by(directory.path(), "none", &["--background", "env"]).expect(2, &["view.background", "environment.name"]);
    assert!(!directory.path().join("out.exr").exists(), "a picture in a refused environment");
}

#[test]
fn negative_texels_are_told_and_luminance_is_gray() {
    let directory = folder();
    let picture = || fs::read(directory.path().join("out.exr")).unwrap();
    fs::write(directory.path().join("negative.exr"), exr_with((-1.0, 0.5, 0.5))).unwrap();
    lit_by(directory.path(), "negative.exr", &[]).expect(0, &["negative, down to -1: 0 is used"]);
    let clamped = picture();
    fs::write(directory.path().join("zero.exr"), exr_with((0.0, 0.5, 0.5))).unwrap();
    lit_by(directory.path(), "zero.exr", &[]).expect(0, &[]);
    assert!(clamped == picture(), "a negative value counts as 0");
    fs::write(directory.path().join("luminance.exr"), exr_of_luminance()).unwrap();
    lit_by(directory.path(), "luminance.exr", &[]).expect(0, &[]);
}

/// Renders with a cache of its own. Returns the `bake` event and the picture.
fn baked(directory: &Path) -> (Value, Vec<u8>) {
    let mut command = specula(directory);
    command.env("SPECULA_CACHE", directory.join("cache"));
    command.args(["render", "ball.glb", "--env", "sky.hdr", "--validate", "--out", "out.exr", "--events", "json"]);
    let finished = crate::support::process::finish(command.args(SMALL));
    finished.expect(0, &[]);
    let events = finished.stdout.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let bake = events.into_iter().find(|event| event["event"] == "bake").expect("a bake event");
    (bake, fs::read(directory.join("out.exr")).unwrap())
}

#[test]
fn a_bake_is_told_and_kept_and_a_damaged_entry_is_baked_anew() {
    let directory = folder();
    fs::write(directory.path().join("sky.hdr"), hdr::red_and_blue()).unwrap();
    let (first, picture) = baked(directory.path());
    assert_eq!((&first["environment"], &first["cached"]), (&"sky".into(), &false.into()), "{first}");
    for time in ["decode_ms", "cube_ms", "irradiance_ms", "prefilter_ms", "sheen_ms", "total_ms"] {
        assert!(first[time].as_f64() > Some(0.0), "{time} in {first}");
    }
    let (second, same) = baked(directory.path());
    assert_eq!(second["cached"], true, "{second}");
    assert!(picture == same, "what came from the cache looks different");

    // Truncate every entry; then corrupt one byte of it.
    let damages: [fn(&mut Vec<u8>); 2] = [|bytes| bytes.truncate(bytes.len() / 2), |bytes| bytes[1000] ^= 4];
    for damage in damages {
        let entries: Vec<_> = fs::read_dir(directory.path().join("cache/baked")).unwrap().collect();
        assert!(!entries.is_empty());
        for entry in entries {
            let path = entry.unwrap().path();
            let mut bytes = fs::read(&path).unwrap();
            damage(&mut bytes);
            fs::write(&path, bytes).unwrap();
        }
        let (again, same) = baked(directory.path());
        assert_eq!(again["cached"], false, "{again}");
        assert!(picture == same, "what was baked again looks different");
    }
}

#[test]
fn a_bad_file_keeps_the_last_good_picture_and_a_good_one_shows() {
    let tree = Tree::new();
    let sky = tree.beside("sky.hdr");
    fs::write(tree.beside("ball.glb"), glb::model(&glb::sphere(16, 32), &glb::gray())).unwrap();
    fs::write(&sky, hdr::uniform([128, 0, 0, 129])).unwrap();
    let mut command = specula(&tree.beside(""));
    command.args(["render", "ball.glb", "--shaders", "shaders", "--env", "sky.hdr", "--background", "env"]);
    command.args(["--watch", "--events", "json", "--validate", "--tonemap", "none", "--ev", "0", "--out", "out.png"]);
    let mut running = Running::start(command.args(SMALL));
    running.event("bake");
    running.event("ready");
    let pixel = |x, y| open_image(&tree.beside("out.png")).into_rgb8().get_pixel(x, y).0;
    // Radiance 1 exposed by 1 / 1.2, sRGB-encoded.
    assert_eq!(pixel(0, 0), [235, 0, 0], "the sky behind the model");
    assert!(pixel(24, 16)[0] > 100 && pixel(24, 16)[1] == 0, "the model in a red sky: {:?}", pixel(24, 16));

    fs::write(&sky, b"#?RADIANCE\n").unwrap();
    // A shader edit after that is drawn with the last good environment.
    let user = tree.edited("user.glsl", "    return radiance;", "    return radiance + vec3(0.0, 1.0, 0.0);");
    tree.write("user.glsl", &user);
    running.reload(true);
    assert_eq!(pixel(0, 0), [235, 0, 0], "the sky after its file was damaged");
    assert_eq!(pixel(24, 16)[1], 235, "the edit shows");

    // Restore the file.
    let new = tree.beside("new.hdr");
    fs::write(&new, hdr::uniform([0, 0, 128, 129])).unwrap();
    fs::rename(&new, &sky).unwrap();
    running.event("bake");
    // The picture is written after its event, but before the next reload.
    tree.write("user.glsl", &user.replace("vec3(0.0, 1.0, 0.0)", "vec3(1.0, 0.0, 0.0)"));
    running.reload(true);
    assert_eq!(pixel(0, 0), [0, 0, 235], "the new sky");
    assert_eq!(pixel(24, 16)[0], 235, "the edit after it");
    let stderr = running.stderr();
    assert!(stderr.contains("sky.hdr") && stderr.contains("the last good environment stays"), "{stderr}");
}

/// A ball that leaves most of the picture to the background. Left is -X.
fn before_the_sky(environment: &str) -> Renderer {
    let settings = settings(&[
        &format!("environment.name={environment}"),
        "view.background=env",
        "view.msaa=1",
        "lights.source=none",
        "camera.eye=[0, 0, 8]",
        "camera.target=[0, 0, 0]",
    ]);
    renderer(load(&glb::model(&glb::sphere(8, 16), &glb::gray())), settings, (48, 32))
}

/// The raw values behind the model, left and right.
fn sides(capture: &Capture) -> [[f32; 3]; 2] {
    [4, 43].map(|x| capture.raw_at(x, 16).unwrap()).map(|[r, g, b, _]| [r, g, b])
}

#[test]
fn the_sky_behind_the_model_is_the_files_and_turns() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("sky.hdr");
    fs::write(&path, hdr::red_and_blue()).unwrap();
    let mut headless = before_the_sky(path.to_str().unwrap());
    let mut with = |assignment: &str| {
        headless.settings_mut().assign(assignment).unwrap();
        render(&mut headless, "final")
    };
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for (assignment, expected) in [
        ("environment.rotation=180", [blue, red]),
        // The direction ahead is now left, and the right one is ahead.
        ("environment.rotation=90", [blue, blue]),
        ("environment.rotation=-90", [red, red]),
        ("environment.rotation=0", [red, blue]),
        ("environment.intensity=2", [red.map(|c| 2.0 * c), blue.map(|c| 2.0 * c)]),
        ("environment.intensity=1", [red, blue]),
    ] {
        let found = sides(&with(assignment));
        let near =
            found.as_flattened().iter().zip(expected.as_flattened()).all(|(a, b): (&f32, _)| (a - b).abs() < 1e-3);
        assert!(near, "{assignment}: {found:?}, not {expected:?}");
    }
    let [left, right] = sides(&with("environment.blur=1"));
    assert!(left[0] > left[2] && left[2] > 0.05 && right[2] > right[0] && right[0] > 0.05, "{left:?} {right:?}");
    with("environment.blur=0");
    // A mode that does not show light has a plain background.
    let behind = render(&mut headless, "metallic");
    assert_eq!(behind.rgba8[4 * (16 * 48 + 4)..][..4], [0x1b, 0x1d, 0x21, 255]);
    // Without a background the pixels behind the model are empty, and the lighting does not change.
    let lit = render(&mut headless, "final").raw_at(24, 16).unwrap();
    headless.settings_mut().view.background = "none".into();
    let alone = render(&mut headless, "final");
    assert_eq!((alone.raw_at(4, 16), alone.raw_at(24, 16)), (Some([0.0; 4]), Some(lit)));
}

/// The raw values of the model, all channels, where it is seen at less than 78 degrees.
fn on_model(capture: &Capture, n_dot_v: &Capture) -> Vec<f32> {
    let seen = capture.raw.iter().zip(&n_dot_v.raw).filter(|(value, cosine)| value[3] == 1.0 && cosine[0] > 0.2);
    seen.flat_map(|(value, _)| [value[0], value[1], value[2]]).collect()
}

/// Largest difference from 1, and the root mean square difference.
fn off_one(values: &[f32]) -> (f32, f32) {
    let squares = values.iter().map(|value| (value - 1.0).powi(2)).sum::<f32>() / values.len() as f32;
    (values.iter().map(|value| (value - 1.0).abs()).fold(0.0, f32::max), squares.sqrt())
}

#[test]
fn a_white_metal_cannot_be_seen_in_a_furnace() {
    let chosen = settings(&[
        "environment.name=furnace",
        "view.msaa=1",
        "view.background=none",
        "lights.source=none",
        "material.enabled=true",
        "material.metallic=1",
        "material.roughness=0.8",
        "material.base_color=[1, 1, 1]",
    ]);
    let mut headless = renderer(load(&glb::model(&glb::sphere(16, 32), &glb::gray())), chosen, (48, 32));
    let n_dot_v = render(&mut headless, "n-dot-v");
    let split_sum = off_one(&on_model(&render(&mut headless, "final"), &n_dot_v));
    assert!(split_sum.0 < 0.005, "split sum: off 1 by up to {}", split_sum.0);
    headless.settings_mut().assign("REFLECTION_SAMPLES=Sampled64").unwrap();
    let sampled = off_one(&on_model(&render(&mut headless, "final"), &n_dot_v));
    assert!(sampled.0 < 0.02 && sampled.1 < 0.005, "sampled: off 1 by up to {}, r.m.s. {}", sampled.0, sampled.1);
    headless.settings_mut().assign("REFLECTION_SAMPLES=Prefiltered").unwrap();
    headless.settings_mut().assign("MULTI_SCATTER=None").unwrap();
    let single = off_one(&on_model(&render(&mut headless, "final"), &n_dot_v));
    assert!(single.1 > 0.1, "without multiple scattering: off 1 by {} (r.m.s.) only", single.1);
    headless.settings_mut().assign("MULTI_SCATTER=KullaConty").unwrap();
    // Monte Carlo converges: 64 frames are closer to 1 than one.
    headless.settings_mut().view.frames = 1;
    let noisy = off_one(&on_model(&render(&mut headless, "monte-carlo"), &n_dot_v));
    headless.settings_mut().view.frames = 64;
    let mean = off_one(&on_model(&render(&mut headless, "monte-carlo"), &n_dot_v));
    assert!(mean.1 < 0.02, "of 64 frames: off 1 by {} (r.m.s.)", mean.1);
    assert!(noisy.1 > 3.0 * mean.1, "of one frame: off 1 by {}, of 64 by {}", noisy.1, mean.1);
}

/// The picture against Monte Carlo, relative to the mean of Monte Carlo: the mean difference, and the mean absolute
/// difference.
fn split_sum_error(headless: &mut Headless, frames: u32) -> (f32, f32) {
    headless.settings_mut().view.frames = frames;
    let n_dot_v = render(headless, "n-dot-v");
    let truth = on_model(&render(headless, "monte-carlo"), &n_dot_v);
    let split_sum = on_model(&render(headless, "final"), &n_dot_v);
    assert!(truth.len() > 1000, "{} values", truth.len());
    let differences = || split_sum.iter().zip(&truth).map(|(a, b)| a - b);
    let total = truth.iter().sum::<f32>();
    (differences().sum::<f32>() / total, differences().map(f32::abs).sum::<f32>() / total)
}

#[test]
fn stretched_highlights_are_those_of_random_paths() {
    let chosen = ["environment.name=studio", "view.msaa=1", "view.background=none", "lights.source=none"];
    let mut headless = renderer(model("anisotropy"), settings(&chosen), (96, 54));
    let (bias, off) = split_sum_error(&mut headless, 32);
    assert!(bias.abs() < 0.02 && off < 0.13, "off by {off}, all in all by {bias}");
}

/// The mean error of a pixel against random paths, relative to the mean light; it includes the noise of the paths. The error
/// left is that of light from below the horizon, so it grows with roughness.
#[test]
fn sampled_reflections_are_those_of_random_paths() {
    let chosen = [
        "view.msaa=1",
        "view.background=none",
        "lights.source=none",
        "REFLECTION_SAMPLES=Sampled64",
        "material.enabled=true",
        "material.metallic=1",
    ];
    let mut headless = renderer(model("shader-ball"), settings(&chosen), (72, 48));
    for (environment, roughness, most_bias, most_off) in [
        ("studio", 0.2, 0.02, 0.06),
        ("studio", 0.5, 0.02, 0.06),
        ("studio", 1.0, 0.03, 0.06),
        ("sky", 0.2, 0.02, 0.06),
        ("sky", 0.5, 0.02, 0.06),
        ("sky", 1.0, 0.03, 0.06),
    ] {
        headless.settings_mut().assign(&format!("environment.name={environment}")).unwrap();
        headless.settings_mut().assign(&format!("material.roughness={roughness}")).unwrap();
        let (bias, off) = split_sum_error(&mut headless, 32);
        println!("{environment}, roughness {roughness}: off by {off}, all in all by {bias}");
        assert!(
            bias.abs() < most_bias && off < most_off,
            "{environment}, {roughness}: off by {off}, all in all by {bias}"
        );
    }
}

/// The same for a coat and for a stretched highlight.
#[test]
fn sampled_coats_and_stretched_highlights_are_those_of_random_paths() {
    let fixed = ["view.msaa=1", "view.background=none", "lights.source=none", "environment.name=studio"];
    for name in ["clearcoat", "anisotropy"] {
        let chosen = [&fixed[..], &["REFLECTION_SAMPLES=Sampled64"]].concat();
        let mut headless = renderer(model(name), settings(&chosen), (96, 54));
        let (bias, off) = split_sum_error(&mut headless, 32);
        println!("{name}: off by {off}, all in all by {bias}");
        assert!(bias.abs() < 0.02 && off < 0.08, "{name}: off by {off}, all in all by {bias}");
    }
}

/// Where the base's bumps face away, the coat above them does not. Split sum and Monte Carlo must both light it.
#[test]
fn coats_over_bumps_are_lit_by_random_paths() {
    let chosen = ["environment.name=furnace", "view.msaa=1", "view.background=none", "lights.source=none"];
    let mut headless = renderer(model("clearcoat"), settings(&chosen), (96, 54));
    let (bias, off) = split_sum_error(&mut headless, 32);
    // In a few pixels the coat's own bumps face away from the eye, where it has no reflection. And bumps hide a part of the sky from
    // random paths that the diffuse light of the split sum keeps.
    assert!(bias.abs() < 0.02 && off < 0.03, "off by {off}, all in all by {bias}");
}

/// The sun covers 5e-6 of the sky and provides most of the light, so paths that do not sample it would miss it.
#[test]
fn random_paths_find_the_sun() {
    let chosen = settings(&[
        "environment.name=sky",
        "environment.rotation=70",
        "view.msaa=1",
        "view.background=none",
        "lights.source=none",
        "material.enabled=true",
        "material.metallic=0",
        "material.roughness=0.8",
    ]);
    let mut headless = renderer(load(&glb::model(&glb::sphere(24, 48), &glb::gray())), chosen, (48, 32));
    let (bias, off) = split_sum_error(&mut headless, 16);
    assert!(bias.abs() < 0.02 && off < 0.3, "off by {off}, all in all by {bias}");
}

/// Baked radiance is packed on the device, three mantissas of 9 bits with one exponent (ibl/maps/shared_exponent.glsl).
#[test]
fn packed_radiance_is_within_a_511th_of_its_largest_channel() {
    let chosen = settings(&["environment.name=furnace", "lights.source=none", "view.msaa=1"]);
    let mut session = Session::new(load(&glb::model(&glb::sphere(12, 24), &glb::gray())), chosen);
    let mut stored = "store_texel(texel, IRRADIANCE_SIDE, radiance)".to_owned();
    for (radiance, expected) in [
        ("vec3(1.0)", [1.0; 3]),
        ("vec3(0.999, 0.5, 0.1)", [0.999, 0.5, 0.1]),
        ("vec3(2e4, 2.0, 1e3)", [2e4, 2.0, 1e3]),
        ("vec3(1e-3, 3e-5, 0.0)", [1e-3, 3e-5, 0.0]),
        // Values that cannot be radiance become black. A GPU keeps the sign of zero, which a software device drops.
        ("vec3(-0.0)", [0.0; 3]),
        ("vec3(-1.0, sqrt(-1.0 - n.x * n.x), -0.0)", [0.0; 3]),
    ] {
        let next = format!("store_texel(texel, IRRADIANCE_SIDE, {radiance})");
        ready(&session.edit("ibl/irradiance.comp", &stored, &next));
        stored = next;
        let capture = session.mode("irradiance");
        let found = capture.raw.iter().find(|pixel| pixel[3] == 1.0).expect("a pixel of the sphere");
        let largest = expected.into_iter().fold(0.0, f32::max);
        for (found, expected) in found.iter().zip(expected) {
            // The mode shows pi times the texel, as half floats.
            let error = (found / std::f32::consts::PI - expected).abs();
            assert!(error <= largest * (1.0 / 511.0 + 1.0 / 1024.0), "{radiance}: {found}");
        }
    }
    assert_validated();
}

#[test]
fn an_edit_of_a_baking_stage_bakes_again() {
    let file = "ibl/irradiance.comp";
    let chosen = settings(&["environment.name=furnace", "lights.source=none", "view.msaa=1"]);
    let mut session = Session::new(load(&glb::model(&glb::sphere(16, 32), &glb::gray())), chosen);
    let whole = session.mode("ibl-diffuse");
    let original = session.tree.read(file);
    ready(&session.edit(file, "sum.rgb / sum.w", "0.5 * sum.rgb / sum.w"));
    let half = session.render();
    assert_differ(&whole, &half, "half of the irradiance");
    for (whole, half) in whole.raw.iter().zip(&half.raw).filter(|(value, _)| value[3] == 1.0) {
        assert!((whole[0] - 2.0 * half[0]).abs() < 2e-3 * whole[0], "{whole:?} {half:?}");
    }
    // If a stage does not compile, the baked maps remain.
    assert!(!failed(&session.edit(file, "sum.rgb / sum.w", "sum / sum.w.x.y")).is_empty());
    assert_same(&half, &session.render(), "after a broken edit");
    ready(&session.save(file, &original));
    assert_same(&whole, &session.render(), "back at the first text");
    assert!(session.headless.bake_report().cached, "the first bake is kept");
    // An edit that no bake stage depends on does not bake again.
    let user = session.tree.edited("user.glsl", "    return radiance;", "    return radiance * 2.0;");
    let before = session.headless.bake_report().total_ms;
    ready(&session.save("user.glsl", &user));
    session.render();
    assert_eq!(session.headless.bake_report().total_ms, before, "baked again for an edit of user.glsl");
}
