//! `specula info --stages`.

use serde_json::Value;

use super::directory;
use crate::support::process::run;

#[test]
fn info_tells_of_the_stages_of_the_picture() {
    let directory = directory();
    let args = ["info", "sphere-grid", "--env", "none", "--validate", "--stages"];
    let json = run(directory.path(), &[&args[..], &["--json"]].concat()).expect(0, &[]).json();
    let picture = &json["picture"];
    let stage = |name: &str| -> &Value {
        picture["stages"].as_array().unwrap().iter().find(|stage| stage["stage"] == name).unwrap()
    };
    let shown = stage("pbr.frag");
    assert_eq!(shown["on_screen"], true);
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} in {shown}"));
    let largest = &shown["largest"];
    let words = [&shown["compiled_words"], &largest["words_before"], &largest["words"]].map(number);
    assert!(words[0] > words[1] && words[1] > words[2] && words[2] > 1000.0, "{shown}");
    assert!(number(&shown["compile_ms"]) > 0.0 && number(&largest["pipeline_ms"]) > 0.0, "{shown}");
    let statistics = largest["executables"].as_array().map_or(0, Vec::len);
    assert_eq!(statistics > 0, picture["driver_tells"] == true, "{picture}");
    let other = stage("debug.frag");
    assert!(other["on_screen"] == false && other["largest"].is_null() && number(&other["compiled_words"]) > 1000.0);

    let text = run(directory.path(), &args);
    text.expect(0, &[]);
    let line = text.stdout.lines().find(|line| line.trim_start().starts_with("pbr.frag")).unwrap();
    assert!(line.contains(" words") && line.contains("compiled in"), "{line}");
}
