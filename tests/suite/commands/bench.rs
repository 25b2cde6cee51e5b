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
    // The textures of the second step are larger than what the fault lets the device have.
    let textures = told["textures"].as_array().unwrap();
    let sizes: Vec<u64> = textures.iter().filter_map(|step| step["texture_mib"].as_u64()).collect();
    assert_eq!(sizes, [16, 64]);
    let taken = textures[0]["device_mib"].as_u64().unwrap();
    assert!(textures[0]["upload_ms"].as_f64().unwrap() > 0.0 && (15..=18).contains(&taken), "{told}");
    let reason = textures[1]["skipped"].as_str().unwrap();
    assert!(reason.contains("out of graphics memory") && reason.contains("MiB"), "{reason}");
}
