//! Fragments that are blended, covered by others, or seen through them.

use serde_json::{Value, json};

use super::trace;
use crate::support::glb;

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
