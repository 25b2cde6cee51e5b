//! Commands that take long say how far they are.

use super::directory;
use crate::support::process::run;

#[test]
fn many_samples_show_progress_on_stderr() {
    let directory = directory();
    // Hours on a software device; it is ended at its first line.
    let long = [
        "render",
        "metal-grid",
        "--size",
        "320x200",
        "--mode",
        "path-traced",
        "--set",
        "view.frames=4096",
        "--timeout",
        "60",
    ];
    let mut child = crate::support::process::specula(directory.path());
    let child = child.args(long).stderr(std::process::Stdio::piped()).spawn().unwrap();
    let line = first_line(child, "paths per pixel, about ");
    assert!(line.starts_with("specula: path-traced, ") && line.contains(" of "), "{line}");
    // Short pictures show none.
    let short = ["render", "metal-grid", "--size", "16x16", "--mode", "path-traced", "--set", "view.frames=1"];
    let stderr = run(directory.path(), &short).expect(0, &[]).stderr.clone();
    assert!(!stderr.contains(" left"), "{stderr}");
}

/// The first line of stderr that has `part`; ends the program then.
fn first_line(mut child: std::process::Child, part: &str) -> String {
    use std::io::BufRead as _;
    let lines = std::io::BufReader::new(child.stderr.take().unwrap()).lines();
    let found = lines.map_while(Result::ok).find(|line| line.contains(part));
    let _ = child.kill();
    let _ = child.wait();
    found.unwrap_or_else(|| panic!("no line with `{part}`"))
}
