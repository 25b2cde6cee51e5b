//! Statements and pictures that a rewriting of the source text would get wrong.

use serde_json::{Value, json};

use super::{EYE, done, near, proven, trace, tree, vector};
use crate::support::process::run;
use crate::support::{glb, line_of};

const LIBRARY: &str = "#define WITH 2\nvoid both(inout float a, inout float b) { a += 1.0; b += 10.0; }";

const BODY: &str = "    float zero = min(s.roughness, 0.0), total = zero;\n\
    \x20   for (int i = 0, j = 10; i < 3 && j > 0; ++i, j -= 2) total += float(j);\n\
    \x20   int k, n;\n\
    \x20   for (k = 0, n = 8; k < n; k++, n /= 2) total += 0.0;\n\
    \x20   vec3 c = vec3(zero);\n\
    \x20   c.zx = vec2(1.0, 2.0);\n\
    \x20   c.yz += vec2(zero + 3.0);\n\
    \x20   c.rg = c.gr;\n\
    \x20   mat3 m = mat3(zero);\n\
    \x20   m[1].zy = vec2(5.0, 6.0);\n\
    \x20   m[int(zero) + 2].xy = vec2(7.0, 8.0);\n\
    \x20   m[k - 1] = vec3(zero);\n\
    \x20   vec4 rows[3];\n\
    \x20   for (int r = 0; r < 3; ++r) rows[r] = vec4(zero);\n\
    \x20   rows[n + k - 3][k - 1] = 4.0;\n\
    \x20   float few[4], many[9];\n\
    \x20   for (int r = 0; r < 3; ++r) few[r + 1] = float(r);\n\
    \x20   for (int r = 0; r < 9; ++r) many[r] = float(r);\n\
    \x20   bvec3 under = lessThan(vec3(zero), vec3(1.0, -1.0, 2.0));\n\
    \x20   bvec2 flipped = not(under.xy);\n\
    \x20   under.y = any(flipped);\n\
    \x20   if (all(under)) total += 1.0;\n\
    \x20   float twice = zero + 1.0;\n\
    \x20   both(twice, twice);\n\
    #if defined(ABSENT)\n\
    \x20   float chosen = 1.0 + zero;\n\
    #else\n\
    \x20   float chosen = 2.0 + zero;\n\
    #endif\n\
    #if 0\n\
    \x20   total = 1.0;\n\
    #elif WITH > 1\n\
    \x20   total += 100.0;\n\
    #endif\n\
    \x20   if (c.x + m[1].y + total + twice + chosen + float(k) + m[2].x + rows[k].y + few[k] + many[k] < 0.0) s.roughness = 1.0;";

/// `for` headers with commas, swizzled targets, computed indices, vectors of bools, an argument that is two `inout` parameters, `#if`.
#[test]
fn statements_of_odd_forms_have_their_values() {
    let directory = tempfile::tempdir().unwrap();
    let (text, found) = proven(directory.path(), LIBRARY, BODY);
    let of =
        |act: &str, name: &str, values: Value| (act.to_owned(), name.to_owned(), values.as_array().unwrap().clone());
    let store = |name: &str, values: Value| of("store", name, values);
    for (part, expected) in [
        (
            "for (int i = 0, j",
            vec![
                store("i", json!([0, 1, 2, 3])),
                store("j", json!([10, 8, 6, 4])),
                of("condition", "", json!([true, true, true, false])),
                store("total", json!([10.0, 18.0, 24.0])),
            ],
        ),
        (
            "for (k = 0, n",
            vec![
                store("k", json!([0, 1, 2])),
                store("n", json!([8, 4, 2])),
                of("condition", "", json!([true, true, false])),
                store("total", json!([24.0, 24.0])),
            ],
        ),
        ("c.zx = ", vec![store("c.z", json!([1.0])), store("c.x", json!([2.0]))]),
        ("c.yz += ", vec![store("c.y", json!([3.0])), store("c.z", json!([4.0]))]),
        ("c.rg = ", vec![store("c.x", json!([3.0])), store("c.y", json!([2.0]))]),
        ("m[1].zy = ", vec![store("m[1].z", json!([5.0])), store("m[1].y", json!([6.0]))]),
        ("m[int(zero) + 2].xy", vec![store("m[2].x", json!([7.0])), store("m[2].y", json!([8.0]))]),
        ("m[k - 1] = ", vec![store("m[1]", json!([[0.0, 0.0, 0.0]]))]),
        ("rows[n + k - 3][k - 1] = ", vec![store("rows[1][1]", json!([4.0]))]),
        (
            "few[r + 1] = ",
            vec![
                store("r", json!([0, 1, 2, 3])),
                of("condition", "", json!([true, true, true, false])),
                store("few[1]", json!([0.0])),
                store("few[2]", json!([1.0])),
                store("few[3]", json!([2.0])),
            ],
        ),
        ("bvec3 under = ", vec![store("under", json!([[true, false, true]]))]),
        ("bvec2 flipped = ", vec![store("flipped", json!([[false, true]]))]),
        ("under.y = ", vec![store("under.y", json!([true]))]),
        ("if (all(under)) ", vec![of("condition", "", json!([true])), store("total", json!([25.0]))]),
        // Copied in, changed apart, and copied back from left to right.
        ("both(twice, twice)", vec![store("twice", json!([2.0, 11.0]))]),
        ("float chosen = 1.0", vec![]),
        ("float chosen = 2.0", vec![store("chosen", json!([2.0]))]),
        ("    total = 1.0;", vec![]),
        ("    total += 100.0;", vec![store("total", json!([125.0]))]),
    ] {
        assert_eq!(done(&found, "user.glsl", line_of(&text, part)), expected, "{part}");
    }
    // A loop over an array has one name for all of its elements.
    let many = done(&found, "user.glsl", line_of(&text, "many[r] = "));
    assert_eq!(many.last().unwrap(), &store("many[ ]", json!([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0])));
    let both = done(&found, "user.glsl", line_of(&text, "void both("));
    let expected = ["a", "b"].map(|name| of("argument", name, json!([1.0])));
    assert_eq!(both[..2], expected, "{both:?}");
    assert_eq!(both[2..], [store("a", json!([2.0])), store("b", json!([11.0]))]);
    // Lines that the preprocessor leaves out are not missed.
    let missed = super::not_reached(&found, "user.glsl");
    assert!(!missed.contains(&u64::from(line_of(&text, "float chosen = 1.0"))), "{missed:?}");
}

/// A surface seen from behind, and one that is left out there.
#[test]
fn back_faces_are_traced() {
    let directory = tempfile::tempdir().unwrap();
    let file = "material/material.glsl";
    let behind = ["quad.glb", "--eye", "0,0,-4", "--target", "0,0,0", "--at", "48,32", "--file", file, "--json"];
    let write = |is_double_sided: bool| {
        let mut material = glb::gray();
        material["doubleSided"] = json!(is_double_sided);
        std::fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &material)).unwrap();
    };
    write(true);
    let found = trace(directory.path(), &behind).expect(0, &[]).json();
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    let shipped = std::fs::read_to_string(format!("{}/shaders/{file}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let line = line_of(&shipped, "vec3 towards_viewer(");
    let of_line = done(&found, file, line);
    let values = |act: &str, name: &str| {
        let is_it = |of: &&(String, String, Vec<Value>)| (of.0.as_str(), of.1.as_str()) == (act, name);
        of_line.iter().find(is_it).unwrap_or_else(|| panic!("no {act} {name}: {of_line:?}")).2.clone()
    };
    assert!(values("condition", "").iter().all(|is_front| *is_front == json!(false)), "{of_line:?}");
    for (direction, result) in values("argument", "direction_ws").iter().zip(values("return", "")) {
        let (direction, result) = (vector(direction), vector(&result));
        assert!((0..3).all(|at| direction[at] == -result[at]) && near(result[2], -1.0, 1e-6), "{of_line:?}");
    }
    write(false);
    trace(directory.path(), &behind).expect(2, &["the model does not cover the pixel 48,32"]);
}

/// The fragments of a model whose triangles the tree divides.
#[test]
fn a_tessellated_model_is_traced() {
    let directory = tempfile::tempdir().unwrap();
    let view = ["--shaders", "examples:displacement", "--at", "50,30"];
    let place = [&["sphere-grid", "--file", "pbr.frag", "--json"], &view[..]].concat();
    let found = trace(directory.path(), &place).expect(0, &[]).json();
    assert_eq!((&found["proof"]["equal"], &found["proof"]["ulp"]), (&json!(true), &json!(0)), "{}", found["proof"]);
    let shipped = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/pbr.frag")).unwrap();
    let v = done(&found, "pbr.frag", line_of(&shipped, "vec3 v = safe_normalize"));
    let probe = [&["probe", "sphere-grid", "--json", "--mode", "position"], &view[..], &super::VIEW].concat();
    let probe = run(directory.path(), &probe).expect(0, &[]).json();
    let (position, eye) = (vector(&probe["modes"]["position"]), vector(&probe["camera"]["eye"]));
    let expected = super::unit(std::array::from_fn(|at| eye[at] - position[at]));
    let traced = vector(&v.last().unwrap().2[0]);
    assert!((0..3).all(|at| near(traced[at], expected[at], 1e-4)), "{v:?} {expected:?}");
}

/// The first rounds are there, and the line of the loop.
#[test]
fn a_loop_that_a_budget_ends_is_traced_and_told() {
    let directory = tempfile::tempdir().unwrap();
    let endless = "    float x = s.roughness;\n    while (x < 2.0)\n        x *= 0.5;\n    s.roughness = x;";
    let text = tree(directory.path(), "", endless);
    std::fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(9.0), &glb::gray())).unwrap();
    let place = [&["quad.glb", "--shaders", "tree", "--at", "48,32", "--file", "user.glsl"][..], &EYE].concat();
    let line = line_of(&text, "while (x < 2.0)");
    let told = format!("user.glsl:{line}: error: this loop did not end (");
    let printed = trace(directory.path(), &place);
    printed.expect(1, &[&told]);
    assert!(printed.stdout.contains("a loop was cut short, so the picture is magenta there\n"), "{}", printed.stdout);
    let found = trace(directory.path(), &[&place[..], &["--json"]].concat()).expect(1, &[&told]).json();
    // The mark of such pixels, which the display shows as magenta.
    assert_eq!(found["proof"]["picture"], json!([60000.0, -60000.0, 60000.0, 1.0]), "{}", found["proof"]);
    let halves = done(&found, "user.glsl", line + 1);
    let first = halves[0].2.iter().map(|value| value.as_f64().unwrap()).collect::<Vec<_>>();
    assert!(halves[0].1 == "x" && first.len() == 16, "{halves:?}");
    assert!(first.is_sorted_by(|a, b| near(0.5 * a, *b, 1e-6)), "{first:?}");

    // One that ends, but later than the device lets it.
    let long = endless.replace("while (x < 2.0)", "for (int i = 0; i < 1000000; ++i)");
    let user = text.replace(endless, &long);
    assert_ne!(user, text);
    std::fs::write(directory.path().join("tree/user.glsl"), user).unwrap();
    let told = format!("user.glsl:{line}: warning: this loop takes more than ");
    trace(directory.path(), &place).expect(0, &[&told]);
}

/// Assertions alone end with an exit code.
#[test]
fn printed_values_do_not_fail_a_trace() {
    let directory = tempfile::tempdir().unwrap();
    tree(directory.path(), "", "    print(\"is rough\", s.roughness > 5.0);");
    let place = ["sphere-grid", "--shaders", "tree", "--at", "50,30", "--file", "user.glsl"];
    let traced = trace(directory.path(), &[&place[..], &["--json"]].concat());
    traced.expect(0, &["warning: is rough = false first at the pixel"]);
    let checks = traced.json()["checks"].clone();
    assert!(checks[0]["rule"] == "print" && checks.as_array().unwrap().len() == 1, "{checks}");
    // The tree asserts nothing.
    let plain = ["sphere-grid", "--at", "50,30", "--file", "user.glsl", "--json"];
    assert!(trace(directory.path(), &plain).expect(0, &[]).json()["checks"].is_null());
}
