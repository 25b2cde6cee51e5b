//! Stages other than that of the surfaces: vertices, passes, compute stages, files of Shadertoy.

use serde_json::{Value, json};

use super::{AT, EYE, done, near, trace, vector, write_sphere};
use crate::support::{Tree, line_of};

/// The values of a variable at a line of a file, of its first times.
fn values(found: &Value, file: &str, line: u32, name: &str) -> Vec<Value> {
    let all = done(found, file, line);
    let named = all.iter().find(|(act, of, _)| of == name || (act == name && of.is_empty()));
    named.unwrap_or_else(|| panic!("{file}:{line} has no {name}, but {all:?} in {found}")).2.clone()
}

/// The corners of the triangle at the pixel, whose places on the screen are around it.
#[test]
fn vertices_and_the_tone_map_of_a_picture_are_traced() {
    let directory = tempfile::tempdir().unwrap();
    write_sphere(directory.path());
    let place = [&["ball.glb"][..], &AT, &EYE].concat();
    let vertices = ["--stage", "pbr.vert", "--json"];
    let found = trace(directory.path(), &[&place[..], &vertices].concat()).expect(0, &[]).json();
    assert_eq!((&found["stage"], &found["proof"]["equal"]), (&json!("pbr.vert"), &json!(true)), "{}", found["proof"]);
    let corners = found["fragments"].as_array().unwrap();
    let mut numbers: Vec<u64> = corners.iter().map(|corner| corner["vertex"].as_u64().unwrap()).collect();
    numbers.dedup();
    assert_eq!((corners.len(), numbers.len()), (3, 3), "{found}");
    let on_screen = |corner: &Value| {
        let clip: Vec<f64> = corner["position"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        [(clip[0] / clip[3] + 1.0) * 48.0 - 50.5, (clip[1] / clip[3] + 1.0) * 32.0 - 30.5]
    };
    let around: Vec<[f64; 2]> = corners.iter().map(on_screen).collect();
    let side = |a: [f64; 2], b: [f64; 2]| (a[0] * b[1] - a[1] * b[0]).signum();
    let sides = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| side(around[a], around[b]));
    assert!(sides == [1.0; 3] || sides == [-1.0; 3], "the pixel is outside of {around:?}");
    // Vertices of a unit sphere.
    let position = done(&found, "pbr.vert", line_of(&Tree::new().read("pbr.vert"), "fragment.to_eye_ws ="));
    let (.., to_eye) = position.iter().find(|(_, name, _)| name == "fragment.to_eye_ws").unwrap();
    let to_eye = vector(&to_eye[0]);
    let radius = (to_eye[0].powi(2) + to_eye[1].powi(2) + (4.0 - to_eye[2]).powi(2)).sqrt();
    assert!(near(radius, 1.0, 1e-5), "{radius}");

    // A file of the tone map finds its stage.
    let file = ["--file", "common/tonemap.glsl", "--json"];
    let found = trace(directory.path(), &[&place[..], &file].concat()).expect(0, &[]).json();
    assert_eq!((&found["stage"], &found["proof"]["with"]), (&json!("tonemap.frag"), &json!("the display")));
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    let text = trace(directory.path(), &[&place[..], &["--stage", "tonemap.frag", "--file", "tonemap.frag"]].concat());
    text.expect(0, &[]);
    assert!(
        text.stdout.contains("tonemap.frag, fragment 0 of 1: equal to the display, in 8 bits\n"),
        "{}",
        text.stdout
    );

    trace(directory.path(), &[&place[..], &["--stage", "pbr.geom"]].concat())
        .expect(2, &["no stage pbr.geom that can be traced; it has pbr.frag, pbr.vert", "tonemap.frag"]);
    trace(directory.path(), &[&place[..], &["--invocation", "1,2"]].concat()).expect(2, &["no compute stage"]);
    // The reason, for stages and files that no picture traces.
    let baked = &["--stage", "ibl/irradiance.comp"];
    trace(directory.path(), &[&place[..], baked].concat()).expect(2, &["those that bake light"]);
    trace(directory.path(), &[&place[..], &["--shaders", "examples:displacement", "--file", "pbr.tese"]].concat())
        .expect(2, &["pbr.tese is not traced", "those of tessellation"]);
    let beside = ["ball.glb", "--at", "1,1", "--stage", "pbr.vert"];
    trace(directory.path(), &[&beside[..], &EYE].concat()).expect(2, &["no triangle of the model is at the pixel 1,1"]);
}

/// A pass with an image of half the size, and a compute pass.
#[test]
fn passes_are_traced_at_the_pixel_of_their_image() {
    let tree = Tree::new();
    let half = "//@pass half \"Half\" size=1/2\n#version 460\n#include \"interface.glsl\"\n#include \"pass.glsl\"\n\
        uniform sampler2D picture;\nvoid main() {\n    vec2 at = gl_FragCoord.xy;\n    color = vec4(at / 3.0, 0.0, 1.0);\n    \
        color += min(texelFetch(picture, ivec2(0), 0), vec4(0.0));\n}\n";
    let cells = "//@pass cells \"Cells\" size=1/2\n#version 460\n#include \"interface.glsl\"\n\
        layout(local_size_x = 8, local_size_y = 8) in;\nlayout(rgba16f) uniform writeonly image2D cells;\nuniform sampler2D picture;\n\
        void main() {\n    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);\n    \
        imageStore(cells, cell, vec4(cell, textureSize(picture, 0)));\n}\n";
    tree.write("passes/half.frag", half);
    tree.write("passes/cells.comp", cells);
    let root = tree.root();
    let common = ["sphere-grid", "--at", "50,31", "--json", "--shaders", root.to_str().unwrap()];
    let run = |more: &[&str]| trace(&root, &[&common[..], more].concat());
    let mode = ["--mode", "pass:half"];
    let found = run(&mode).expect(0, &[]).json();
    assert_eq!((&found["stage"], &found["proof"]["with"]), (&json!("passes/half.frag"), &json!("the image half")));
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    let line = line_of(half, "vec2 at =");
    assert_eq!(values(&found, "passes/half.frag", line, "at"), [json!([25.5, 15.5])]);
    let mode = ["--mode", "pass:cells"];
    let found = run(&mode).expect(0, &[]).json();
    assert_eq!((&found["stage"], &found["proof"]["equal"]), (&json!("passes/cells.comp"), &json!(true)));
    let line = line_of(cells, "ivec2 cell =");
    assert_eq!(values(&found, "passes/cells.comp", line, "cell"), [json!([25, 15])]);
    let found = run(&[&mode[..], &["--invocation", "3,4"]].concat()).expect(0, &[]).json();
    assert_eq!(values(&found, "passes/cells.comp", line, "cell"), [json!([3, 4])]);
    run(&[&mode[..], &["--invocation", "9999,4"]].concat()).expect(2, &["has no invocation 9999,4,0"]);
}

/// A pass that draws the model to an image of its own, and one that blends quads over the picture.
#[test]
fn passes_of_the_model_and_of_quads_are_traced() {
    let tree = Tree::new();
    let root = tree.root();
    write_sphere(&root);
    let normals = "//@pass normals \"Normals\" draw=model size=1/2 format=rgba32f\n#version 460\n#include \"interface.glsl\"\n\
        #include \"common/fragment.glsl\"\nlayout(location = 0) in Fragment fragment;\nlayout(location = 0) out vec4 color;\n\
        void main() {\n    vec3 n = normalize(fragment.normal_ws);\n    color = vec4(n, 1.0);\n}\n";
    // Two quads over the left half, the second one behind the first.
    let quads = "//@pass quads \"Quads\" draw=quads instances=2 to=picture blend\n#version 460\n#include \"interface.glsl\"\n\
        layout(location = 0) in flat int number;\nlayout(location = 0) out vec4 color;\n\
        void main() {\n    float part = 0.25 * float(number + 1);\n    color = vec4(0.0, part, 0.0, part);\n}\n";
    let corners_text = "#version 460\n#include \"interface.glsl\"\nlayout(location = 0) out flat int number;\n\
        const vec2 CORNERS[6] = vec2[](vec2(-1, -1), vec2(0, -1), vec2(0, 1), vec2(-1, -1), vec2(0, 1), vec2(-1, 1));\n\
        void main() {\n    number = gl_InstanceIndex;\n    gl_Position = vec4(CORNERS[gl_VertexIndex], 0.8 - 0.2 * float(number), 1.0);\n}\n";
    // The model's own stage, with one more statement.
    let of_model_vertices = std::fs::read_to_string(root.join("pbr.vert")).unwrap();
    let of_model_vertices = of_model_vertices.replacen(
        "void main() {\n",
        "void main() {\n    vec4 shifted = vec4(float(gl_VertexIndex));\n",
        1,
    );
    assert!(of_model_vertices.contains("shifted"));
    for (file, text) in [
        ("normals.frag", normals),
        ("quads.frag", quads),
        ("quads.vert", corners_text),
        ("normals.vert", &of_model_vertices),
    ] {
        tree.write(&format!("passes/{file}"), text);
    }
    let common = [&["ball.glb", "--json", "--shaders", root.to_str().unwrap()][..], &EYE].concat();
    let run = |more: &[&str]| trace(&root, &[&common[..], more].concat());

    let of_model = ["--at", "40,24", "--mode", "pass:normals"];
    let found = run(&of_model).expect(0, &[]).json();
    assert_eq!(
        (&found["stage"], &found["proof"]["with"]),
        (&json!("passes/normals.frag"), &json!("the image normals"))
    );
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    let n = vector(&values(&found, "passes/normals.frag", line_of(normals, "vec3 n ="), "n")[0]);
    // To the left and above the center of a sphere.
    assert!(n[0] < -0.1 && n[1] > 0.1 && n[2] > 0.5, "{n:?}");
    run(&["--at", "90,60", "--stage", "passes/normals.frag", "--mode", "pass:normals"])
        .expect(2, &["passes/normals.frag draws nothing at the pixel 45,30 of its image"]);

    let of_quads = |at: &str| run(&["--at", at, "--stage", "passes/quads.frag"]);
    let found = of_quads("20,20").expect(0, &[]).json();
    let fragments = found["fragments"].as_array().unwrap();
    let depths: Vec<f64> = fragments.iter().map(|of| of["depth"].as_f64().unwrap()).collect();
    assert!(depths.len() == 2 && near(depths[0], 0.8, 1e-6) && near(depths[1], 0.6, 1e-6), "{found}");
    let line = line_of(quads, "float part");
    for (fragment, part) in [("0", 0.25), ("1", 0.5)] {
        let chosen = run(&["--at", "20,20", "--stage", "passes/quads.frag", "--fragment", fragment]);
        let part_of = values(&chosen.expect(0, &[]).json(), "passes/quads.frag", line, "part");
        assert_eq!(part_of, [json!(part)], "fragment {fragment}");
    }
    // Blended with what is behind it.
    assert_eq!((&found["proof"]["equal"], &found["proof"]["blended_ulp"]), (&json!(true), &json!(0)), "{found}");
    assert_eq!(found["proof"]["picture"], json!([0.0, 0.625, 0.0, 0.625]), "{}", found["proof"]);
    of_quads("70,20").expect(2, &["passes/quads.frag draws nothing at the pixel 70,20"]);
    // The corners of a quad by its number, and those of the triangle at the pixel.
    for (more, number, depth) in [(&[][..], 0, 0.8), (&["--invocation", "1"], 1, 0.6)] {
        let found = run(&[&["--at", "20,20", "--stage", "passes/quads.vert"], more].concat()).expect(0, &[]).json();
        let corners = found["fragments"].as_array().unwrap();
        let vertices: Vec<&Value> = corners.iter().map(|of| &of["vertex"]).collect();
        assert_eq!(vertices, [0, 1, 2, 3, 4, 5].map(Value::from).each_ref(), "{found}");
        let position = corners[2]["position"].as_array().unwrap();
        let depth_of = position[2].as_f64().unwrap();
        assert!(position[0] == 0.0 && position[1] == 1.0 && near(depth_of, depth, 1e-6), "{found}");
        let line = line_of(corners_text, "number =");
        assert_eq!(values(&found, "passes/quads.vert", line, "number"), [json!(number)]);
        assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
    }
    run(&["--at", "20,20", "--stage", "passes/quads.vert", "--invocation", "2"]).expect(2, &["places no quad 2"]);
    let of_vertices = ["--at", "40,24", "--mode", "pass:normals", "--stage", "passes/normals.vert"];
    let found = run(&of_vertices).expect(0, &[]).json();
    assert_eq!(found["fragments"].as_array().map(Vec::len), Some(3), "{found}");
    let of_picture = run(&["--at", "40,24", "--stage", "pbr.vert"]).expect(0, &[]).json();
    let vertices = |of: &Value| -> Vec<Value> {
        of["fragments"].as_array().unwrap().iter().map(|corner| corner["vertex"].clone()).collect()
    };
    assert_eq!(vertices(&found), vertices(&of_picture));
    let line = line_of(&of_model_vertices, "vec4 shifted");
    assert_eq!(values(&found, "passes/normals.vert", line, "shifted").len(), 1, "{found}");
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
}

/// The image of a toy, and a buffer that counts frames.
#[test]
fn toys_are_traced_with_the_frames_before() {
    let directory = tempfile::tempdir().unwrap();
    let image = "#iChannel0 \"buffer.glsl\"\nvoid mainImage(out vec4 color, in vec2 at) {\n    vec2 uv = at / iResolution.xy;\n    \
        float count = texelFetch(iChannel0, ivec2(0), 0).x;\n    color = vec4(uv, 0.1 * count, 1.0);\n}\n";
    let buffer = "#iChannel0 \"self\"\nvoid mainImage(out vec4 color, in vec2 at) {\n    \
        float before = texelFetch(iChannel0, ivec2(at), 0).x;\n    color = vec4(before + 1.0);\n}\n";
    std::fs::write(directory.path().join("toy.glsl"), image).unwrap();
    std::fs::write(directory.path().join("buffer.glsl"), buffer).unwrap();
    let found =
        trace(directory.path(), &["toy.glsl", "--at", "24,15", "--json", "--frames", "4"]).expect(0, &[]).json();
    assert_eq!((&found["proof"]["equal"], &found["proof"]["with"]), (&json!(true), &json!("the display")), "{found}");
    let file = "opened/toy.glsl";
    let uv = vector(&json!([values(&found, file, 3, "uv")[0][0], values(&found, file, 3, "uv")[0][1], 0]));
    assert!(near(uv[0], 24.5 / 96.0, 1e-6) && near(uv[1], (64.0 - 15.5) / 64.0, 1e-6), "{uv:?}");
    assert_eq!(values(&found, file, 4, "count"), [json!(4.0)]);
    // The code is the author's, without what is compiled beside it.
    for line in found["lines"].as_array().unwrap() {
        let own = image.lines().nth(line["line"].as_u64().unwrap() as usize - 1).unwrap();
        assert_eq!(line["code"].as_str(), Some(own.trim()), "{line}");
    }
    // Of the stage around it, nothing. An assertion needs no path.
    assert!(found["lines"].as_array().unwrap().iter().all(|line| line["file"] == file), "{found}");
    // Texts name the author's files; the name of one names its stage.
    let told = trace(directory.path(), &["toy.glsl", "--at", "24,15", "--stage", "buffer.glsl"]);
    let all = told.stdout.lines().collect::<Vec<_>>();
    assert!(
        all[0].starts_with("pixel 24 15, buffer.glsl, fragment 0 of 1: equal to the image buffer.glsl"),
        "{told:?}"
    );
    assert!(all[2] == "buffer.glsl" && all[3].starts_with("  2  void mainImage("), "{told:?}");
    let told = trace(directory.path(), &["toy.glsl", "--at", "24,15", "--stage", "bufer.glsl"]);
    told.expect(2, &["no stage bufer.glsl that can be traced; it has toy.glsl, buffer.glsl, tonemap.frag"]);
    let asserted = ["toy.glsl", "--at", "24,15", "--frames", "4", "--assert", "toy.glsl:4 count > 3"];
    trace(directory.path(), &asserted).expect(0, &[]);
    let stage = ["toy.glsl", "--at", "24,15", "--json", "--frames", "4", "--file", "opened/buffer.glsl"];
    let found = trace(directory.path(), &stage).expect(0, &[]).json();
    assert_eq!(values(&found, "opened/buffer.glsl", 3, "before"), [json!(3.0)], "{found}");
    assert_eq!(found["proof"]["equal"], json!(true), "{}", found["proof"]);
}
