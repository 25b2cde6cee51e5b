//! A mistake that makes a pixel too bright is found from the pixel.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{EYE, VIEW, trace, vector, write_sphere};
use crate::support::process::run;
use crate::support::{Tree, line_of};

const FILE: &str = "brdf/evaluate.glsl";
const AT: [&str; 2] = ["--at", "64,26"];

/// The values of all statements of the file: by line, name and calls.
fn values(trace: &Value) -> BTreeMap<(u64, String, String), Value> {
    let lines = trace["lines"].as_array().unwrap().iter().filter(|line| line["file"] == FILE);
    let done = lines.flat_map(|line| line["done"].as_array().unwrap().iter().map(move |done| (line, done)));
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let each = |(line, done): (&Value, &Value)| {
        let (line, name) = (line["line"].as_u64().unwrap(), format!("{} {}", text(&done["act"]), text(&done["name"])));
        let once = |once: &Value| ((line, name.clone(), text(&once["calls"])), once["value"].clone());
        done["first"].as_array().unwrap().iter().map(once).collect::<Vec<_>>()
    };
    done.flat_map(each).collect()
}

/// With the wrong sign of l, n . l is 0 where light arrives, and the masking term too large.
#[test]
fn a_wrong_n_dot_l_is_found_at_its_line_with_its_lights() {
    let tree = Tree::new();
    let root = tree.root();
    write_sphere(&root);
    let text = tree.read(FILE);
    let line = line_of(&text, "brdf.n_dot_l = saturate(cos_l);");
    let place = [&["ball.glb", "--json", "--shaders", root.to_str().unwrap()][..], &AT, &EYE].concat();
    let probe = || run(&root, &[&["probe", "--mode", "final"], &place[..], &VIEW].concat()).expect(0, &[]).json();
    let traced = |more: &[&str]| trace(&root, &[&place[..], more].concat());
    let assertion = format!("{FILE}:{line} brdf.n_dot_l > 0");
    let check = ["--assert", assertion.as_str()];
    let right = (probe(), traced(&check).expect(0, &[]).json());

    tree.write(FILE, &tree.edited(FILE, "brdf.n_dot_l = saturate(cos_l);", "brdf.n_dot_l = saturate(dot(s.n, -l));"));
    let wrong = (probe(), traced(&check).expect(1, &["brdf.n_dot_l > 0", "failed for "]).json());
    let luminance = |probe: &Value| vector(&probe["modes"]["final"]).iter().sum::<f64>();
    let (before, after) = (luminance(&right.0), luminance(&wrong.0));
    assert!(after > 1.05 * before, "the pixel is not too bright: {before} {after}");
    assert!(wrong.1["proof"]["equal"] == true, "{}", wrong.1["proof"]);

    // Both traces are the same in this function until the line of the mistake.
    let (before, after) = (values(&right.1), values(&wrong.1));
    let begin = u64::from(line_of(&text, "Brdf evaluate_brdf("));
    let changed = after.iter().filter(|(place, value)| place.0 >= begin && before.get(place) != Some(value));
    let changed: Vec<_> =
        changed.map(|((line, name, calls), value)| (*line, name.as_str(), calls.as_str(), value)).collect();
    let first: Vec<_> = changed.iter().filter(|(of, ..)| *of == changed[0].0).collect();
    assert_eq!((first[0].0, first[0].1), (u64::from(line), "store brdf.n_dot_l"), "{changed:?}");
    // Its calls name the lights that reach the point, and its neighbors have the cosine that it should be.
    for (_, name, calls, value) in &first {
        assert!(calls.contains("shade > add_light [light ") && calls.ends_with(" > evaluate_brdf"), "{calls}");
        let cosine =
            &after[&(u64::from(line_of(&text, "float cos_l =")), "store cos_l".to_owned(), (*calls).to_owned())];
        assert!(
            cosine.as_f64().unwrap() > 0.0 && value.as_f64().unwrap() == 0.0,
            "{name} of {calls}: {cosine} {value}"
        );
    }
    assert!(first.len() >= 2, "{first:?}");
}
