//! The memory that commands take at most, on the software device, whose images are memory of the process.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use crate::support::process::specula;

/// Bytes of all pixels of a picture with four samples while it is drawn: four samples of full floats, the depth of each, and the display.
const DRAWN: u64 = 4 * 16 + 4 * 4 + 4;

/// MiB of the largest resident set of a `render` of this size.
fn peak_mib(directory: &Path, size: &str) -> f64 {
    let mut command = specula(directory);
    command.args(["render", "sphere-grid", "--env", "none", "--lights", "orbit", "--out", "out.png", "--size", size]);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let mut most = 0;
    let status = loop {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        most = most.max(peak.map_or(0, |text| text.trim().trim_end_matches(" kB").parse::<u64>().unwrap()));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        std::thread::yield_now();
    };
    assert!(status.success(), "{status}");
    assert!(most > 0);
    most as f64 / 1024.0
}

/// The resolved color takes the memory of the depth, and the picture is read back when only its color is left.
#[test]
fn a_picture_takes_the_memory_of_its_samples_alone() {
    let directory = tempfile::tempdir().unwrap();
    // The first run fills the caches.
    let [_, small, large] = ["64x36", "64x36", "1920x1080"].map(|size| peak_mib(directory.path(), size));
    let drawn = (1920 * 1080 * DRAWN) as f64 / f64::from(1 << 20);
    // The color alone would be 32 MiB more, and a readback as much again.
    assert!((drawn - 16.0..drawn + 16.0).contains(&(large - small)), "{large} MiB, {small} when small: {drawn} drawn");
}
