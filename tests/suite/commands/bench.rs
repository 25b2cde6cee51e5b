//! `specula bench`: what it prints.

use crate::support::process::{finish, specula};
use serde_json::Value;

#[test]
fn bench_scale_prints_the_growth_from_step_to_step() {
    let folder = tempfile::tempdir().unwrap();
    let args =
        ["bench", "scale", "--json", "--samples", "1", "--size", "16x16", "--env", "none", "--texture-mib", "64"];
    let mut command = specula(folder.path());
    let told = finish(command.args(args).env("SPECULA_FAULT", "image-bytes:20000000")).expect(0, &[]).json();
    let counts = |series: &str, of: &str| -> Vec<u64> {
        let steps: &[Value] = told[series].as_array().unwrap();
        assert!(steps.iter().all(|step| step["cpu_ms"]["min"].as_f64().is_some_and(|ms| ms > 0.0)), "{told}");
        assert!(steps[0]["growth"].is_null() && steps[1..].iter().all(|step| step["growth"].is_f64()), "{told}");
        steps.iter().filter_map(|step| step[of].as_u64()).collect()
    };
    assert_eq!(counts("primitives", "primitives"), [10, 100, 1_000, 10_000, 100_000]);
    assert_eq!(counts("materials", "materials"), [10, 100, 1_000, 10_000]);
    assert_eq!(counts("lights", "lights"), [1, 10, 100, 1_000]);
    assert_eq!(counts("joints", "joints"), [10, 100, 1_000, 10_000]);
    // The camera sees the whole grid. The other draws cover the frame.
    let primitives = counts("primitives", "primitives");
    let others: Vec<u64> = counts("primitives", "draws").iter().zip(&primitives).map(|(all, own)| all - own).collect();
    assert!(others.iter().all(|count| *count == others[0]), "{others:?}");
    // The textures of the second step are larger than what the fault lets the device have.
    let textures = told["textures"].as_array().unwrap();
    let sizes: Vec<u64> = textures.iter().filter_map(|step| step["texture_mib"].as_u64()).collect();
    assert_eq!(sizes, [16, 64]);
    let taken = textures[0]["device_mib"].as_u64().unwrap();
    assert!(textures[0]["upload_ms"].as_f64().unwrap() > 0.0 && (15..=18).contains(&taken), "{told}");
    let reason = textures[1]["skipped"].as_str().unwrap();
    assert!(reason.contains("out of graphics memory") && reason.contains("MiB"), "{reason}");
}

#[test]
fn bench_trace_tells_what_a_click_costs_with_and_without_preparation() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["bench", "trace", "shader-ball", "--samples", "1", "--size", "96x64", "--env", "none", "--file"];
    let run = |more: &[&str]| finish(specula(folder.path()).args(args).args(more));
    let told = run(&["brdf/ndf.glsl", "--json"]).expect(0, &[]).json();
    assert_eq!((&told["file"], &told["mode"]), (&"brdf/ndf.glsl".into(), &"final".into()), "{told}");
    let least = |name: &str| told[name]["min"].as_f64().unwrap_or_else(|| panic!("{told}"));
    assert!(least("cold_ms") > least("prepared_ms"), "what was prepared is compiled again: {told}");
    assert!(least("prepare_ms") > least("warm_ms") && least("warm_ms") > 0.0, "{told}");
    run(&["brdf/ndff.glsl"]).expect(2, &["no statement of brdf/ndff.glsl is in the stage"]);
}
