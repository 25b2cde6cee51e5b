//! Fragments that are blended, covered by others, or seen through them.

use serde_json::{Value, json};

use super::trace;
use crate::support::glb;

/// The nearer of two opaque boxes is drawn first, so the depth test hides the other one.
#[test]
fn fragments_behind_an_opaque_one_are_listed_with_their_values() {
    let directory = tempfile::tempdir().unwrap();
    let at = |depth: f32| glb::cuboid([-1.0, -1.0, depth - 0.1], [1.0, 1.0, depth], true);
    let (mut both, farther) = (at(0.0), at(-1.0));
    let first = both.positions.len() as u32;
    both.indices.extend(farther.indices.iter().map(|index| first + index));
    both.positions.extend(farther.positions);
    both.normals.extend(farther.normals);
    let material = json!({ "pbrMetallicRoughness": { "baseColorFactor": [1.0, 0.0, 0.0, 1.0] } });
    std::fs::write(directory.path().join("two.glb"), glb::scene(&[(both, material)])).unwrap();
    let view = ["two.glb", "--at", "48,32", "--eye", "0,0,6", "--target", "0,0,0", "--file", "pbr.frag", "--json"];
    let found = trace(directory.path(), &view).expect(0, &[]).json();
    let all = found["fragments"].as_array().unwrap();
    let states: Vec<(&Value, &Value)> = all.iter().map(|of| (&of["state"], &of["covered_by"])).collect();
    let expected = [(json!("seen"), Value::Null), (json!("covered"), json!(0))];
    assert_eq!(states, expected.each_ref().map(|(state, by)| (state, by)), "{found}");
    assert_eq!((&found["fragment"], &found["proof"]["equal"]), (&json!(0), &json!(true)), "{found}");
    let depths: Vec<f64> = all.iter().map(|of| of["depth"].as_f64().unwrap()).collect();
    // Reversed depth: the near plane divided by the distance.
    assert!((depths[0] / depths[1] - 7.0 / 6.0).abs() < 1e-3, "{depths:?}");
    let hidden = trace(directory.path(), &[&view[..], &["--fragment", "1"]].concat()).expect(0, &[]).json();
    assert!(hidden["lines"].as_array().is_some_and(|lines| lines.len() > 3), "{hidden}");
    let text = trace(directory.path(), &[&view[..view.len() - 1], &["--fragment", "1"]].concat());
    text.expect(0, &[]);
    assert!(text.stdout.contains("fragment 1 of 2: covered by fragment 0"), "{}", text.stdout);
}

/// A blended surface in front of two opaque ones.
#[test]
fn a_fragment_that_is_blended_over_is_told_from_one_that_is_covered() {
    let directory = tempfile::tempdir().unwrap();
    let material = |name: &str, color: [f32; 4], mode: &str| json!({ "name": name, "alphaMode": mode, "pbrMetallicRoughness": { "baseColorFactor": color } });
    let at = |depth: f32| glb::cuboid([-1.0, -1.0, depth - 0.1], [1.0, 1.0, depth], true);
    // The farther box is drawn first, since both are one mesh. Otherwise the depth test would leave it out.
    let (mut opaque, nearer) = (at(-1.0), at(0.0));
    let first = opaque.positions.len() as u32;
    opaque.indices.extend(nearer.indices.iter().map(|index| first + index));
    opaque.positions.extend(nearer.positions);
    opaque.normals.extend(nearer.normals);
    let scene = glb::scene(&[
        (opaque, material("back", [1.0, 0.0, 0.0, 1.0], "OPAQUE")),
        (at(1.0), material("front", [0.0, 1.0, 0.0, 0.25], "BLEND")),
    ]);
    std::fs::write(directory.path().join("three.glb"), scene).unwrap();
    let view = ["three.glb", "--at", "48,32", "--eye", "0,0,6", "--target", "0,0,0", "--file", "pbr.frag"];
    let found = trace(directory.path(), &[&view[..], &["--json"]].concat()).expect(0, &[]).json();
    let all = found["fragments"].as_array().unwrap();
    let states: Vec<(&Value, &Value)> = all.iter().map(|of| (&of["state"], &of["covered_by"])).collect();
    let expected =
        [(json!("blended"), Value::Null), (json!("blended-over"), Value::Null), (json!("covered"), json!(1))];
    assert_eq!(states, expected.each_ref().map(|(state, by)| (state, by)), "{found}");
    assert_eq!((&found["fragment"], &all[0]["visible"]), (&json!(0), &json!(true)));
    // Alone, its color is not the picture's. Over the one behind it, it is.
    assert!(found["proof"]["ulp"].as_u64().unwrap() > 1000, "{}", found["proof"]);
    assert!(found["proof"]["blended_ulp"].as_u64().unwrap() <= 4, "{}", found["proof"]);
    for (fragment, told) in [
        ("0", "the picture, blended with what is behind it"),
        ("1", "the picture, blended over"),
        ("2", "covered by fragment 1"),
    ] {
        let text = trace(directory.path(), &[&view[..], &["--fragment", fragment]].concat());
        text.expect(0, &[]);
        let is_proof = |line: &&str| line.contains(&format!("fragment {fragment} of 3: "));
        let proof = text.stdout.lines().find(is_proof).unwrap_or_else(|| panic!("{}", text.stdout));
        assert!(proof.contains(told), "{proof}");
    }
}
