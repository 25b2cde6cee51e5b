//! Geometry, tessellation and mesh stages of passes that draw the model; what each kind of stage can read.

mod access;
mod mesh;
mod sliders;

use crate::support::{
    SIZE, Session, assert_differ, assert_same, assert_validated, failed, glb, line_of, lines, load, passes_check,
    ready, settings, stages,
};
use specula::render::Capture;

const GEOM: &str = "passes/mine.geom";
const TESC: &str = "passes/mine.tesc";
const TESE: &str = "passes/mine.tese";

/// The color of a normal, to the picture.
const FRAGMENT: &str = "//@pass mine draw=model to=picture\n#version 460\n#include \"interface.glsl\"\n\
    #include \"common/fragment.glsl\"\nlayout(location = 0) in Fragment fragment;\nlayout(location = 0) out vec4 color;\n\
    void main() { color = vec4(fragment.normal_ws, 1.0); }\n";

/// A geometry stage with this code for each corner of a triangle.
fn geometry(output: &str, code: &str) -> String {
    format!(
        "#version 460\n#include \"common/model.geom.glsl\"\nlayout({output}) out;\n\
         void corner(int i) {{\n    copy_corner(i);\n    {code}\n    EmitVertex();\n}}\n\
         void main() {{\n    for (int i = 0; i < 3; ++i) corner(i);\n    EndPrimitive();\n}}\n"
    )
}

/// Stages that divide each triangle, and place its vertices with this code.
fn tessellation(level: f32, code: &str) -> (String, String) {
    let divide = format!("void main() {{ divide(vec3({level}), {level}); }}");
    let place = format!("void main() {{\n    fragment = between_corners();\n    {code}\n}}");
    let layout = "layout(triangles) in;\n";
    let stage = |kind: &str, text: &str| format!("#version 460\n#include \"common/model.{kind}.glsl\"\n{text}\n");
    (stage("tesc", &divide), stage("tese", &format!("{layout}{place}")))
}

/// One sample a pixel, on nothing.
const PLAIN: [&str; 3] = ["view.msaa=1", "view.background=none", "environment.name=none"];

fn session(rings: u32, assignments: &[&str]) -> Session {
    Session::new(
        load(&glb::model(&glb::sphere(rings, 2 * rings), &glb::gray())),
        settings(&[&PLAIN, assignments].concat()),
    )
}

/// A sphere of points.
fn points(assignments: &[&str]) -> Session {
    let (mut document, bytes) = glb::document(&glb::sphere(8, 16), &glb::gray());
    document["meshes"][0]["primitives"][0]["mode"] = 0.into();
    Session::new(load(&glb::container(&document, &bytes)), settings(&[&PLAIN, assignments].concat()))
}

/// A sphere that is drawn by the pass `mine` alone.
fn alone(rings: u32) -> Session {
    let mut session = session(rings, &["passes.model=false"]);
    ready(&session.save("passes/mine.frag", FRAGMENT));
    session
}

fn covered(capture: &Capture) -> usize {
    capture.raw.iter().filter(|pixel| pixel[3] > 0.0).count()
}

/// Fails unless two pictures are the same, but for a few pixels at edges and the last digits elsewhere.
#[track_caller]
fn assert_alike(a: &Capture, b: &Capture, why: &str) {
    let is_near =
        |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 0.01 * (1.0 + a.abs()));
    let far = a.raw.iter().zip(&b.raw).filter(|pair| !is_near(*pair)).count();
    assert!(far < 10, "{why}: {far} pixels differ");
}

fn at(capture: &Capture, x: f32, y: f32) -> [f32; 4] {
    capture.raw_at((SIZE.0 as f32 * x) as u32, (SIZE.1 as f32 * y) as u32).unwrap()
}

/// A stage that passes everything on changes no pixel.
#[test]
fn a_geometry_stage_is_a_file_beside_the_pass() {
    let mut session = alone(16);
    let plain = session.render();
    let text = geometry("triangle_strip, max_vertices = 3", "");
    let reload = session.save(GEOM, &text);
    ready(&reload);
    assert_eq!(stages(&reload), [GEOM]);
    assert_alike(&plain, &session.render(), "passed on");
    passes_check(&session);
    // An edit of a function compiles the stage alone, and does what compiling everything does.
    let swollen = text.replace("    \n", "    move_to(1.5 * fragment.position_ws);\n");
    let reload = session.save(GEOM, &swollen);
    ready(&reload);
    assert_eq!(stages(&reload), [GEOM]);
    let large = session.render();
    assert!(covered(&large) > covered(&plain) * 3 / 2, "{} to {}", covered(&plain), covered(&large));
    session.headless.update(specula::shader::Change::All);
    assert_same(&large, &session.render(), "compiled as a whole");
    // A broken stage costs nothing, and names its line.
    let broken = swollen.replace("1.5 *", "1.5 + nothing *");
    let told = lines(failed(&session.save(GEOM, &broken))).join("\n");
    let line = line_of(&broken, "nothing");
    assert!(told.contains(&format!("mine.geom:{line}:")) && told.contains("'nothing'"), "{told}");
    assert_same(&large, &session.render(), "broken");
    session.save(GEOM, "");
    assert_same(&large, &session.render(), "empty");
    ready(&session.save(GEOM, &text));
    assert_alike(&plain, &session.render(), "repaired");
    ready(&session.save(GEOM, &swollen));
    ready(&session.delete(&[GEOM]));
    assert_same(&plain, &session.render(), "deleted");
    // Without its pass, the stage goes, too.
    session.save(GEOM, &swollen);
    let reload = session.delete(&["passes/mine.frag"]);
    ready(&reload);
    assert_eq!(covered(&session.render()), 0);
    assert_validated();
}

#[test]
fn triangles_become_lines_and_points() {
    let mut session = alone(3);
    let whole = session.render();
    ready(&session.save(GEOM, &geometry("line_strip, max_vertices = 3", "")));
    let wires = session.render();
    assert!(covered(&wires) * 3 < covered(&whole) * 2 && covered(&wires) > 100, "{} pixels", covered(&wires));
    ready(&session.save(GEOM, &geometry("points, max_vertices = 3", "gl_PointSize = 3.0;")));
    let points = session.render();
    assert!(covered(&points) < covered(&whole) && covered(&points) > 100, "{} pixels", covered(&points));
    let told = lines(failed(&session.save(GEOM, &geometry("points, max_vertices = 3", "")))).join("\n");
    assert!(told.contains("mine.geom:9:6: error: the stage gives points of no size"), "{told}");
    // Lines beside the model, which the model hides behind itself; multisampled, and to an image.
    let normals = geometry("line_strip, max_vertices = 6", "").replace(
        "corner(i);\n    End",
        "{ corner(i); copy_corner(i); move_to(1.4 * fragment.position_ws); EmitVertex(); EndPrimitive(); }\n    End",
    );
    ready(&session.save(GEOM, &normals));
    session.headless.settings_mut().passes.clear();
    let with_model = session.render();
    assert!(at(&with_model, 0.5, 0.5)[3] > 0.0 && covered(&with_model) > covered(&whole) + 50);
    session.set("view.msaa=4");
    assert!(covered(&session.render()) > covered(&whole) + 50);
    ready(&session.save("passes/mine.frag", &FRAGMENT.replace(" to=picture", "")));
    assert!(session.mode("pass:mine").raw.iter().filter(|pixel| pixel[0] != 0.0).count() > 100, "an image");
    assert_validated();
}

/// What a stage reads by name, its sliders and its constants.
#[test]
fn a_geometry_stage_reads_by_name() {
    let mut session = alone(16);
    let plain = session.render();
    let height = "//@pass height size=1x1 format=r32f\n#version 460\n#include \"pass.glsl\"\n\
        void main() { color = vec4(0.5); }\n";
    ready(&session.save("passes/height.frag", height));
    let declared = "uniform sampler2D height;\nreadonly buffer Shared { float shared_value; };\n\
        uniform Mine { float grown; };   //@ui \"Grown\" 0..2 = 1.0\n\
        layout(constant_id = USER_CONSTANTS + 20) const bool GROWS = false;   //@ui \"Grows\"\nlayout(tri";
    let code =
        "if (GROWS) move_to((texture(height, vec2(0.5)).r + 0.5 * grown + shared_value) * fragment.position_ws);";
    let text = geometry("triangle_strip, max_vertices = 3", code).replace("layout(tri", declared);
    ready(&session.save(GEOM, &text));
    assert_alike(&plain, &session.render(), "switched off by the constant");
    session.set("GROWS=true");
    let same = session.render();
    assert_alike(&plain, &same, "once as large");
    session.set("grown=2.0");
    assert!(covered(&session.render()) > covered(&same) * 3 / 2, "half as large again");
    passes_check(&session);
    let told = lines(failed(&session.save(GEOM, &text.replace("height", "hieght")))).join("\n");
    assert!(told.contains("mine.geom:3:") && told.contains("Did you mean `height`?"), "{told}");
    assert_validated();
}

/// A coarse sphere becomes round. Divided triangles face where whole ones do.
#[test]
fn tessellation_divides_triangles() {
    let mut session = alone(4);
    ready(&session.save("passes/mine.frag", &FRAGMENT.replace("draw=model", "draw=model cull=back")));
    let coarse = session.render();
    let (control, evaluation) = tessellation(1.0, "move_to(fragment.position_ws);");
    session.save(TESC, &control);
    ready(&session.save(TESE, &evaluation));
    assert_alike(&coarse, &session.render(), "divided once");
    passes_check(&session);
    let (control, evaluation) = tessellation(12.0, "move_to(frame.scene_radius * normalize(fragment.position_ws));");
    session.save(TESC, &control);
    ready(&session.save(TESE, &evaluation));
    let round = session.render();
    assert!(covered(&round) > covered(&coarse), "{} to {}", covered(&coarse), covered(&round));
    // From here a geometry stage gets what the tessellation gives.
    ready(&session.save(GEOM, &geometry("line_strip, max_vertices = 3", "")));
    assert_differ(&round, &session.render(), "the wires of the divided sphere");
    let lower = session.tree.read(TESC).replace("vec3(12), 12", "vec3(2), 2");
    let many = covered(&session.render());
    ready(&session.save(TESC, &lower));
    assert!(covered(&session.render()) * 3 < many * 2, "fewer wires");
    // Isolines and points are no triangles.
    let isolines = evaluation.replace("layout(triangles)", "layout(isolines)");
    let told = lines(failed(&session.save(TESE, &isolines))).join("\n");
    assert!(told.contains("the geometry stage takes triangles, but passes/mine.tese gives lines"), "{told}");
    ready(&session.delete(&[GEOM]));
    session.render();
    session.save(TESE, &evaluation);
    std::fs::remove_file(session.tree.path(TESC)).unwrap();
    let told = lines(failed(&session.changed(&[TESC]))).join("\n");
    let expected = "mine.tese:4:6: error: the tessellation evaluation stage needs a tessellation control stage beside it, passes/mine.tesc";
    assert!(told.contains(expected), "{told}");
    ready(&session.delete(&[TESE]));
    assert_same(&coarse, &session.render(), "without tessellation");
    assert_validated();
}

/// The picture's own stages, which passes without stages of their own share, in all modes.
#[test]
fn the_picture_has_such_stages_too() {
    let mut session = session(16, &[]);
    let plain = session.render();
    let ids = session.mode("triangle-id");
    let lit = geometry("triangle_strip, max_vertices = 3", "");
    ready(&session.save("pbr.geom", &lit));
    assert_alike(&ids, &session.mode("triangle-id"), "numbers of triangles");
    assert_alike(&plain, &session.mode("final"), "passed on");
    // A pass with a vertex stage of its own has none of them, one without has all.
    let large = lit.replace("    \n", "    move_to(1.5 * fragment.position_ws);\n");
    ready(&session.save("pbr.geom", &large));
    let grown = covered(&session.render());
    assert!(grown > covered(&plain) * 3 / 2);
    session.set("passes.model=false");
    ready(&session.save("passes/mine.frag", FRAGMENT));
    assert_eq!(covered(&session.render()), grown);
    let text = session.tree.read("pbr.vert");
    ready(&session.save("passes/mine.vert", &text));
    assert_eq!(covered(&session.render()), covered(&plain));
    passes_check(&session);
    // The triangle's number is what the debug modes read.
    let told =
        lines(failed(&session.save("pbr.geom", &large.replace("copy_corner(i)", "fragment = corners[i]")))).join("\n");
    assert!(
        told.contains("pbr.geom:9:6: error: debug.frag reads gl_PrimitiveID, which this stage does not write"),
        "{told}"
    );
    assert_validated();
}

/// A loop that does not end costs neither the device nor the session.
#[test]
fn endless_loops_have_their_line() {
    let mut session = session(4, &[]);
    let before = session.render();
    let (tesc, tese) = tessellation(1.0, "move_to(fragment.position_ws);");
    let geom = geometry("triangle_strip, max_vertices = 3", "");
    let endless = "float x = abs(frame.eye_ws.x);\n    while (x < 1e9) x *= 0.5;\n    gl_Position";
    let good = [("passes/mine.frag", FRAGMENT), (TESC, &*tesc), (TESE, &*tese), (GEOM, &*geom)];
    good.iter().for_each(|(file, text)| session.tree.write(file, text));
    ready(&session.changed(&good.map(|(file, _)| file)));
    let drawn = session.render();
    assert_differ(&before, &drawn, "the pass");
    for (file, text, hook) in [
        (TESC, &tesc, "divide(vec3(1), 1);"),
        (TESE, &tese, "move_to(fragment.position_ws);"),
        (GEOM, &geom, "copy_corner(i);"),
    ] {
        let endless = endless.replace("gl_Position", hook).replace("divide(vec3(1), 1)", "divide(vec3(1.0 + x), 1.0)");
        let endless = endless
            .replace("move_to(", "move_to(x * ")
            .replace("copy_corner(i);", "copy_corner(i); fragment.color.x += x;");
        let text = text.replacen(hook, &endless, 1);
        let (_, repaired) = good.iter().find(|(known, _)| *known == file).unwrap();
        session.ends_loop(file, (&text, repaired), &drawn);
    }
    assert_validated();
}

#[test]
fn models_of_points_and_lines_are_left_out() {
    let mut session = points(&[]);
    let plain = session.render();
    ready(&session.save("passes/mine.frag", FRAGMENT));
    ready(&session.save(GEOM, &geometry("triangle_strip, max_vertices = 3", "")));
    assert_same(&plain, &session.render(), "the stage takes triangles");
    assert_validated();
}

#[test]
fn errors_have_their_line() {
    let mut session = session(8, &[]);
    let before = session.render();
    let full_screen = "//@pass mine to=picture\n#version 460\n#include \"pass.glsl\"\nuniform sampler2D picture;\n\
        void main() { color = texture(picture, uv); }\n";
    let compute = "//@pass mine size=8x8 format=r32f\n#version 460\nlayout(local_size_x = 8) in;\n\
        layout(r32f) uniform writeonly image2D mine;\nvoid main() { imageStore(mine, ivec2(0), vec4(0)); }\n";
    let geom = geometry("triangle_strip, max_vertices = 3", "");
    let (tesc, tese) = tessellation(1.0, "move_to(fragment.position_ws);");
    let cases: [(&[(&str, &str)], &str); 6] = [
        (
            &[("passes/mine.frag", full_screen), (GEOM, &geom)],
            "mine.geom:9:6: error: the pass `mine` draws no model, so it has no geometry stage",
        ),
        (
            &[("passes/mine.comp", compute), (GEOM, &geom)],
            "mine.geom:9:6: error: the pass `mine` draws no model, so it has no geometry stage",
        ),
        (
            &[("passes/mine.frag", full_screen), (TESC, &tesc), (TESE, &tese)],
            "mine.tesc:3:6: error: the pass `mine` draws no model, so it has no tessellation control stage",
        ),
        (
            &[
                ("passes/mine.frag", FRAGMENT),
                (
                    GEOM,
                    "#version 460\nlayout(triangles_adjacency) in;\nlayout(points, max_vertices = 1) out;\nvoid main() {\n    gl_PointSize = 1.0;\n}\n",
                ),
            ],
            "mine.geom:2:29: error: the model is drawn without the neighbors of its primitives",
        ),
        (
            &[
                ("passes/mine.frag", FRAGMENT),
                (
                    GEOM,
                    &geom
                        .replace("layout(tri", "layout(location = 20) in vec2 more[];\nlayout(tri")
                        .replace("copy_corner(i);", "copy_corner(i); fragment.uv0 = more[i];"),
                ),
            ],
            "mine.geom reads `vec2 more` at location 20, ",
        ),
        (
            &[
                ("passes/mine.frag", FRAGMENT),
                (
                    GEOM,
                    "#version 460\nlayout(triangles) in;\nlayout(line_strip, max_vertices = 1) out;\nvoid main() { gl_Position = gl_in[0].gl_Position; EmitVertex(); }\n",
                ),
            ],
            "mine.frag reads `vec3 Fragment.position_ws` at location 0, ",
        ),
    ];
    session.refuses(&before, &cases);
    // A stage that nothing draws with is a warning.
    session.save(GEOM, &geom);
    let told = lines(&session.headless.shaders().warnings).join("\n");
    assert!(
        told.contains("mine.geom: warning: nothing draws with this file: passes/mine.frag declares no pass"),
        "{told}"
    );
    ready(&session.save("passes/mine.frag", FRAGMENT));
    assert_eq!(lines(&session.headless.shaders().warnings), [""; 0]);
    assert_validated();
}
