//! `specula probe` prints the same values of a pixel that `render` draws.

mod not_finite;
mod texels;

use std::path::Path;

use crate::support::process::{Finished, run};
use crate::support::{glb, open_image};
use serde_json::{Value, json};

const VIEW: [&str; 9] =
    ["--size", "96x64", "--env", "none", "--validate", "--set", "view.frames=4", "--set", "lights.rect.enabled=true"];

fn probe(directory: &Path, args: &[&str]) -> Finished {
    run(directory, &[&["probe"], args, &VIEW].concat())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("no array: {value}")).iter().map(|n| n.as_f64().unwrap()).collect()
}

#[test]
fn values_are_those_of_the_raw_picture() {
    let directory = tempfile::tempdir().unwrap();
    // Light, data, derivatives that use neighboring pixels, a mean of frames, edges, layers.
    let modes = ["final", "position", "facet-normal", "mip-level", "d", "energy", "wireframe", "overdraw"];
    let args: Vec<&str> = modes.iter().flat_map(|mode| ["--mode", mode]).collect();
    let found = probe(directory.path(), &[&["--at", "50,30", "--json"], args.as_slice()].concat());
    let found = found.expect(0, &[]).json();
    assert_eq!((&found["pixel"], &found["hit"]), (&serde_json::json!([50, 30]), &true.into()));
    assert_eq!(found["modes"].as_object().unwrap().len(), modes.len());
    for mode in modes {
        let out = format!("{mode}.exr");
        let render = ["render", "--mode", mode, "--out", &out, "--set", "view.msaa=1"];
        run(directory.path(), &[&render[..], &VIEW].concat()).expect(0, &[]);
        let pixel = open_image(&directory.path().join(&out)).into_rgba32f().get_pixel(50, 30).0.map(f64::from);
        let value = numbers(&found["modes"][mode]);
        let same = value.iter().zip(pixel).all(|(a, b)| (a - b).abs() <= 1e-6 * b.abs().max(1.0));
        assert!(value.len() == 4 && same, "{mode}: probe {value:?}, render {pixel:?}");
    }
    let absent = probe(directory.path(), &["--at", "50,30", "--json", "--mode", "clearcoat"]).expect(0, &[]).json();
    assert!(absent["modes"]["clearcoat"].is_null(), "no coat, but {absent}");
    // The values are not all zero.
    assert!(numbers(&found["modes"]["final"])[0] > 0.01 && numbers(&found["modes"]["d"])[0] > 0.0, "{found}");
}

/// JSON has no NaN, and null means no data.
#[test]
fn nan_and_missing_data_are_told_apart() {
    let directory = tempfile::tempdir().unwrap();
    let tree = directory.path().join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    let user = std::fs::read_to_string(tree.join("user.glsl")).unwrap();
    let nan = user.replace("radiance += rim_color", "radiance += sqrt(-1.0 - rim_strength) * rim_color");
    assert_ne!(user, nan);
    std::fs::write(tree.join("user.glsl"), nan).unwrap();
    let modes = ["final", "luminance", "clearcoat", "depth", "d", "uv0", "nan"];
    let args: Vec<&str> = modes.iter().flat_map(|mode| ["--mode", mode]).chain(["--at", "50,30"]).collect();
    let args = [&["--shaders", "tree"], args.as_slice()].concat();
    let found = probe(directory.path(), &[args.as_slice(), &["--json"]].concat()).expect(0, &[]).json();
    let modes = &found["modes"];
    assert_eq!((&modes["final"], &modes["clearcoat"], &modes["nan"]), (&json!("NaN"), &Value::Null, &json!("NaN")));
    let depth = numbers(&modes["depth"])[0];
    // The table has one number for a scalar, followed by the unit.
    let table = probe(directory.path(), &args).expect(0, &[]).stdout.clone();
    let row = |slug: &str| {
        let row = table.lines().find(|line| line.trim_start().starts_with(&format!("{slug} ")));
        row.unwrap_or_else(|| panic!("no {slug} in {table}")).split_whitespace().skip(1).collect::<Vec<_>>().join(" ")
    };
    assert_eq!([row("final"), row("luminance"), row("clearcoat"), row("nan")], ["NaN", "NaN", "no data", "NaN"]);
    assert!(row("depth").ends_with(" m") && row("d").ends_with(" 1/sr"), "{table}");
    assert!((row("depth").split(' ').next().unwrap().parse::<f64>().unwrap() - depth).abs() < 1e-4, "{table}");
    assert_eq!([row("depth"), row("uv0")].map(|row| row.split(' ').count()), [2, 2], "{table}");
    let good = probe(directory.path(), &["--at", "50,30", "--mode", "final"]).expect(0, &[]).stdout.clone();
    assert!(good.contains(" cd/m^2 before exposure"), "{good}");
}

/// A color of the picture says nothing to a reader: its number does.
#[test]
fn numbers_that_the_picture_shows_as_colors_are_told_by_their_meaning() {
    let directory = tempfile::tempdir().unwrap();
    let modes = ["nan", "negative", "tangent-sign", "face-orientation", "material-id", "overdraw", "f0-range"];
    let args: Vec<&str> = modes.iter().flat_map(|mode| ["--mode", mode]).chain(["--at", "50,30"]).collect();
    let found = probe(directory.path(), &[args.as_slice(), &["--json"]].concat()).expect(0, &[]).json();
    let of = |slug: &str| &found["modes"][slug];
    assert_eq!([of("nan"), of("negative"), of("face-orientation")], ["finite", "none", "front"]);
    assert!(of("tangent-sign") == &json!(1) || of("tangent-sign") == &json!(-1), "{found}");
    assert!(of("material-id").is_u64() && of("f0-range").is_string(), "{found}");
    let layers = numbers(of("overdraw"))[0];
    assert!(layers >= 2.0 && layers.fract() == 0.0, "the ball has a back: {found}");
    let table = probe(directory.path(), &args).expect(0, &[]).stdout.clone();
    let row = |slug: &str| {
        let row = table.lines().find_map(|line| line.trim_start().strip_prefix(&format!("{slug} ")));
        row.unwrap_or_else(|| panic!("no {slug} in {table}")).trim().to_owned()
    };
    assert_eq!([row("nan"), row("face-orientation")], ["finite", "front"]);
    assert!(["+1", "-1"].contains(&row("tangent-sign").as_str()), "{table}");
    assert_eq!([row("material-id"), row("overdraw")], [of("material-id").to_string(), format!("{layers} layers")]);
    // The two triangles of a quad.
    std::fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let front = ["--eye", "0,0,3", "--target", "0,0,0", "--json", "--mode", "triangle-id"];
    let ids = ["40,20", "56,44", "56,20", "40,44"].map(|at| {
        let found = probe(directory.path(), &[&["quad.glb", "--at", at], &front[..]].concat()).expect(0, &[]).json();
        found["modes"]["triangle-id"].as_u64().unwrap()
    });
    assert!(ids.contains(&0) && ids.contains(&1) && ids.iter().all(|id| *id < 2), "{ids:?}");
}

/// They take seconds each.
#[test]
fn modes_of_random_paths_are_printed_only_when_asked_for() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let of = |more: &[&str]| {
        let args = [&["quad.glb", "--at", "48,32", "--json", "--set", "lights.source=none"], more].concat();
        probe(directory.path(), &args)
    };
    let told = "modes of random paths; add --paths, or name them with --mode";
    let plain = of(&[]);
    let modes = plain.expect(0, &["left out", told]).json()["modes"].as_object().unwrap().clone();
    assert!(modes.contains_key("roughness") && !modes.contains_key("energy") && !modes.contains_key("monte-carlo"));
    let named = of(&["--mode", "energy"]);
    assert!(!named.expect(0, &[]).stderr.contains(told) && named.json()["modes"]["energy"].is_array(), "{named:#?}");
    let both = of(&["--mode", "all", "--mode", "energy"]);
    let modes = both.expect(0, &["left out"]).json()["modes"].as_object().unwrap().clone();
    assert!(modes.contains_key("roughness") && modes.contains_key("energy") && !modes.contains_key("monte-carlo"));
    let all = of(&["--paths", "--set", "view.frames=1"]);
    assert!(!all.expect(0, &[]).stderr.contains(told), "{all:#?}");
    assert!(all.json()["modes"].as_object().unwrap().contains_key("path-traced"), "{all:#?}");
    of(&["--paths", "--mode", "d"]).expect(2, &["--paths"]);
    // Nothing is left out where nothing is printed.
    let corner = probe(directory.path(), &["--at", "0,0"]);
    assert!(!corner.expect(0, &[]).stderr.contains(told), "{corner:#?}");
}

#[test]
fn camera_and_lights_are_told_in_world_space() {
    let directory = tempfile::tempdir().unwrap();
    let place =
        ["--at", "48,32", "--json", "--mode", "position", "--mode", "depth", "--eye", "0,0.5,4", "--target", "0,0,0"];
    let found = probe(directory.path(), &[&place[..], &["--fovy", "30"]].concat()).expect(0, &[]).json();
    assert_eq!(numbers(&found["camera"]["eye"]), [0.0, 0.5, 4.0]);
    assert_eq!(numbers(&found["camera"]["target"]), [0.0; 3]);
    assert!((found["camera"]["fovy"].as_f64().unwrap() - 30.0).abs() < 1e-4);
    let lights = found["lights"].as_array().unwrap();
    assert_eq!(
        lights.iter().map(|light| light["kind"].as_str().unwrap()).collect::<Vec<_>>(),
        ["point", "point", "point", "rect"]
    );
    for light in lights {
        assert!([&light["position"], &light["direction"], &light["intensity"]].iter().all(|v| numbers(v).len() == 3));
        let direction = numbers(&light["direction"]);
        assert!((direction.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-5);
    }
    assert!(numbers(&lights[3]["half_x"]).len() == 3 && numbers(&lights[3]["half_y"]).len() == 3);
    assert!(lights[0].get("half_x").is_none());
    // The pixel's position is at its depth in front of the camera, close to the center of the picture.
    let position = numbers(&found["modes"]["position"]);
    let depth = numbers(&found["modes"]["depth"])[0];
    let forward = [0.0, -0.5 / 16.25_f64.sqrt(), -4.0 / 16.25_f64.sqrt()];
    let along: f64 = position.iter().zip([0.0, 0.5, 4.0]).zip(forward).map(|((p, e), f)| (p - e) * f).sum();
    assert!((along - depth).abs() < 1e-4, "{along} {depth}");
}

/// A directional light prints no position, and a spot light prints its falloff.
#[test]
fn each_kind_of_light_tells_what_it_needs() {
    let directory = tempfile::tempdir().unwrap();
    let spot = json!({ "type": "spot", "intensity": 4.0, "range": 8.0,
        "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.3 } });
    for (light, kind) in [(spot, "spot"), (json!({ "type": "directional", "intensity": 4.0 }), "directional")] {
        let node = json!({ "translation": [0.0, 0.0, 5.0] });
        let bytes = glb::model_with_light(&glb::quad(1.0), &glb::gray(), &light, &node);
        std::fs::write(directory.path().join("lit.glb"), bytes).unwrap();
        let args = ["lit.glb", "--at", "48,32", "--json", "--mode", "final", "--lights", "model"];
        let found = probe(directory.path(), &args).expect(0, &[]).json();
        let light = &found["lights"][0];
        assert_eq!((&light["kind"], numbers(&light["direction"])), (&json!(kind), vec![0.0, 0.0, -1.0]));
        if kind == "directional" {
            assert!(light["position"].is_null() && light.get("range").is_none(), "{light}");
            continue;
        }
        assert_eq!((numbers(&light["position"]), &light["range"]), (vec![0.0, 0.0, 5.0], &json!(8.0)));
        let ramp =
            |angle: f64| angle.cos() * light["angle_scale"].as_f64().unwrap() + light["angle_offset"].as_f64().unwrap();
        assert!(ramp(0.3).abs() < 1e-4 && (ramp(0.1) - 1.0).abs() < 1e-4, "{light}");
    }
}

#[test]
fn nothing_is_at_a_corner() {
    let directory = tempfile::tempdir().unwrap();
    for background in ["none", "#336699"] {
        let found =
            probe(directory.path(), &["--at", "0,0", "--json", "--background", background]).expect(0, &[]).json();
        assert_eq!((&found["hit"], &found["modes"]), (&false.into(), &serde_json::json!({})));
        assert!(found["camera"].is_object() && found["lights"].is_array());
    }
}

#[test]
fn a_pixel_outside_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    probe(directory.path(), &["--at", "96,10"]).expect(2, &["96,10", "96x64", "95,63"]);
    probe(directory.path(), &["--at", "here"]).expect(2, &["--at", "X,Y"]);
    probe(directory.path(), &["--at", "1,1", "--mode", "dd"]).expect(2, &["dd", "specula modes"]);
}
