//! Loops of which the log keeps the first and the last rounds.

use serde_json::{Value, json};

use super::{not_reached, trace, tree};
use crate::support::line_of;

const LIBRARY: &str = "float grow(float x) { return x + 1.0; }\nfloat twice(float x) { return x * 2.0; }";
const BODY: &str = "    float zero = min(s.roughness, 0.0), sum = zero;\n\
    \x20   for (int i = 0; i < 40; ++i) { sum += float(i) + zero; }\n\
    \x20   for (int k = 0; k < 9000; ++k)\n\
    \x20       sum = grow(sum);\n\
    \x20   float behind = twice(sum);\n\
    \x20   if (behind < 0.0)\n\
    \x20       s.roughness = behind;";

#[test]
fn a_long_loop_keeps_its_ends_and_its_count_and_hides_nothing_behind_it() {
    let directory = tempfile::tempdir().unwrap();
    let text = tree(directory.path(), LIBRARY, BODY);
    let place = ["--shaders", "tree", "--at", "50,30", "--file", "user.glsl"];
    let found = trace(directory.path(), &[&place[..], &["--json"]].concat()).expect(0, &[]).json();
    let line = |part: &str| line_of(&text, part);
    let of = |part: &str, act: &str, name: &str| {
        let lines = found["lines"].as_array().unwrap().iter().filter(|of| of["line"] == line(part));
        let mut done = lines.flat_map(|of| of["done"].as_array().unwrap());
        let is_it = |done: &&Value| done["name"] == name && done["act"] == act;
        done.find(is_it).unwrap_or_else(|| panic!("no {act} {name} at {part}")).clone()
    };
    let short = of("for (int i = 0; i < 40", "store", "i");
    let each = |list: &Value, key: &str| -> Vec<i64> {
        let number = |once: &Value| once[key].as_f64().unwrap() as i64;
        list.as_array().unwrap().iter().map(number).collect()
    };
    let counts = |done: &Value| ["count", "left_out", "not_logged"].map(|key| done[key].as_u64().unwrap());
    assert_eq!(counts(&short), [41, 9, 0]);
    assert_eq!(each(&short["first"], "value"), (0..16).collect::<Vec<_>>());
    assert_eq!(each(&short["last"], "value"), (25..41).collect::<Vec<_>>());

    let long = of("        sum = grow", "store", "sum");
    let [count, left_out, not_logged] = counts(&long);
    assert_eq!([count, left_out], [9000, 9000 - 32]);
    assert!(not_logged > 0 && not_logged <= left_out, "{not_logged}");
    // The sum of 0 to 39, and a step for each round.
    assert_eq!(each(&long["first"], "value"), (781..797).collect::<Vec<_>>());
    assert_eq!(each(&long["last"], "value"), (9765..9781).collect::<Vec<_>>());
    assert_eq!(each(&long["last"], "time"), (8985..9001).collect::<Vec<_>>());
    let said = format!("sum = 781, 782, …, 9780 ×9000 ({not_logged} of them not logged)");
    assert_eq!(long["text"], json!(said));
    assert!(found["fragments"][0]["not_logged"].as_u64().unwrap() > not_logged, "{}", found["fragments"]);

    // Each value belongs to its call. Calls in the middle are not kept, so those of `grow` behind them have their number among all calls.
    let grown = of("float grow(", "return", "");
    let calls = |once: &Value| once["calls"].as_str().unwrap().to_owned();
    let second = calls(&grown["first"][1]);
    assert!(second.ends_with(" > grow [2]") && !second.contains('…'), "{second}");
    let caller = second.strip_suffix("grow [2]").unwrap();
    let last = calls(&grown["last"][15]);
    assert!(last.starts_with(&format!("{caller}grow [call 9")), "{last}");
    let doubled = of("float twice(", "return", "");
    assert_eq!(
        (each(&doubled["first"], "value"), calls(&doubled["first"][0])),
        (vec![19560], format!("{caller}twice"))
    );

    // The statements behind the loop have their values.
    let behind = of("float behind = twice", "store", "behind");
    assert_eq!((each(&behind["first"], "value"), counts(&behind)), (vec![19560], [1, 0, 0]));
    assert!(not_reached(&found, "user.glsl").contains(&u64::from(line("s.roughness = behind"))));
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);

    let check = |assertion: String| trace(directory.path(), &[&place[..], &["--assert", &assertion]].concat());
    let passed = check(format!("user.glsl:{} behind == 19560", line("float behind")));
    passed.expect(0, &[]);
    let lines = [" i = 0, 1, …, 40 ×41", &said, "behind = 19560"];
    assert!(lines.iter().all(|text| passed.stdout.contains(text)), "{}", passed.stdout);
    // All 41 values are checked, but not those that were not logged.
    check(format!("user.glsl:{} i <= 40", line("for (int i = 0; i < 40"))).expect(0, &[]);
    let unsure = format!("the first and the last of 9000 values, but {not_logged} between them were not logged");
    check(format!("user.glsl:{} sum > 0", line("        sum = grow"))).expect(1, &[&unsure]);
}
