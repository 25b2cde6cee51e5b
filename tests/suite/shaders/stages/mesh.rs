//! Task and mesh stages. Drawing needs a device with VK_EXT_mesh_shader; refusals and errors need none.

use super::{FRAGMENT, GEOM, alone, assert_alike, covered, geometry, passes_check, points, session};
use crate::support::{Session, assert_same, assert_validated, failed, gpu, line_of, lines, ready, stages};

const MESH: &str = "passes/mine.mesh";
const TASK: &str = "passes/mine.task";
const LACKS: &str = "this device lacks VK_EXT_mesh_shader, which this";

/// Whether the device draws with mesh stages. Says so if not.
fn draws_meshes(test: &str) -> bool {
    let has = gpu().optional_stages().mesh.is_some();
    if !has {
        println!("{test} is skipped: the device lacks VK_EXT_mesh_shader");
    }
    has
}

/// A mesh stage with this code for each corner `f` of a triangle, behind these lines.
fn mesh(head: &str, code: &str) -> String {
    format!(
        "#version 460\n{head}#include \"common/model.mesh.glsl\"\nvoid main() {{\n    begin_group();\n    \
         if (!has_triangle()) return;\n    for (int i = 0; i < 3; ++i) {{\n        Fragment f = load_corner(i);\n        \
         {code}\n        set_corner(i, f);\n    }}\n    set_triangle();\n}}\n"
    )
}

/// A task stage that keeps the groups for which this holds.
fn task(condition: &str) -> String {
    format!(
        "#version 460\n#include \"common/model.task.glsl\"\nvoid main() {{\n    uint count = list_groups({condition});\n    \
         EmitMeshTasksEXT(count, 1u, 1u);\n}}\n"
    )
}

/// Task and mesh stages that belong together.
fn both(condition: &str) -> [(&'static str, String); 2] {
    [(TASK, task(condition)), (MESH, mesh("#define AFTER_TASK\n", ""))]
}

#[test]
fn mesh_stages_are_refused_by_devices_without_them() {
    if gpu().optional_stages().mesh.is_some() {
        println!("the refusal of mesh stages is skipped: the device has VK_EXT_mesh_shader");
        return;
    }
    let mut session = alone(16);
    let plain = session.render();
    let text = mesh("", "");
    let reload = session.save(MESH, &text);
    let told = lines(failed(&reload)).join("\n");
    assert_eq!(told, format!("{}:3:6: error: {LACKS} mesh stage needs", shown(&session, MESH)));
    let full: String = failed(&reload).iter().map(|diagnostic| diagnostic.render()).collect();
    assert!(full.contains("the pass works with passes/mine.vert"), "{full}");
    assert_same(&plain, &session.render(), "the pass as it was");
    // Without the file, edits of the pass go on.
    session.delete(&[MESH]);
    ready(&session.save("passes/mine.frag", &FRAGMENT.replace("fragment.normal_ws", "-fragment.normal_ws")));
    ready(&session.save("passes/mine.frag", FRAGMENT));
    assert_same(&plain, &session.render(), "repaired");
    for (file, text) in both("true") {
        session.tree.write(file, &text);
    }
    let told = lines(failed(&session.changed(&[TASK, MESH]))).join("\n");
    assert!(told.contains(&format!("{LACKS} task stage")) && told.contains(&format!("{LACKS} mesh stage")), "{told}");
    // One that its own fragment stage alone could take is refused as well.
    session.delete(&[TASK, MESH]);
    let extension = FRAGMENT.replace("460\n", "460\n#extension GL_EXT_mesh_shader : require\n");
    let reads = extension.replace(
        "layout(location = 0) out",
        "layout(location = 9) perprimitiveEXT in vec3 tint;\nlayout(location = 0) out",
    );
    let reads = reads.replace("fragment.normal_ws,", "tint,");
    let told = lines(failed(&session.save("passes/mine.frag", &reads))).join("\n");
    assert!(told.contains("reads `perprimitiveEXT vec3 tint` at location 9, "), "{told}");
    assert_same(&plain, &session.render(), "the fragment stage as it was");
    assert_validated();
}

/// The file as diagnostics name it.
fn shown(session: &Session, file: &str) -> String {
    session.tree.path(file).display().to_string()
}

#[test]
fn mesh_stages_are_compiled_and_checked_without_a_device() {
    let session = alone(4);
    let (tint, reads) = (
        "layout(location = 9) perprimitiveEXT out vec3 tint[];\n",
        "layout(location = 9) perprimitiveEXT in vec3 tint;\nlayout(location = 0) out",
    );
    session.tree.write(MESH, &mesh("", ""));
    passes_check(&session);
    for (file, text) in both("group_number() % 2u == 0u") {
        session.tree.write(file, &text);
    }
    passes_check(&session);
    // What a triangle has for all of its pixels.
    let extension = FRAGMENT.replace("460\n", "460\n#extension GL_EXT_mesh_shader : require\n");
    session.tree.write(
        "passes/mine.frag",
        &extension.replace("layout(location = 0) out", reads).replace("fragment.normal_ws,", "tint,"),
    );
    let text = mesh("#define AFTER_TASK\n", "").replace("void main", &format!("{tint}void main"));
    session
        .tree
        .write(MESH, &text.replace("set_triangle", "tint[gl_LocalInvocationIndex] = vec3(1.0);\n    set_triangle"));
    passes_check(&session);
}

#[test]
fn errors_of_mesh_stages_have_their_line() {
    let mut session = session(8, &[]);
    let before = session.render();
    let full_screen = "//@pass mine to=picture\n#version 460\n#include \"pass.glsl\"\nuniform sampler2D picture;\n\
        void main() { color = texture(picture, uv); }\n";
    let good = mesh("", "");
    let broken = mesh("", "f.position_ws += nothing;");
    let geom = geometry("triangle_strip, max_vertices = 3", "");
    let line = line_of(&broken, "nothing");
    let unmatched = FRAGMENT
        .replace("layout(location = 0) out", "layout(location = 9) in vec2 more;\nlayout(location = 0) out")
        .replace("fragment.normal_ws,", "more, 0.0,");
    let reads_number = FRAGMENT.replace("fragment.normal_ws", "vec3(gl_PrimitiveID)");
    let no_number = "#version 460\n#extension GL_EXT_mesh_shader : require\nlayout(local_size_x = 1) in;\n\
        layout(triangles, max_vertices = 3, max_primitives = 1) out;\nvoid main() { SetMeshOutputsEXT(0, 0); }\n";
    let [(_, task), (_, after)] = both("true");
    let pass = ("passes/mine.frag", FRAGMENT);
    let cases: [(&[(&str, &str)], &str); 11] = [
        (&[pass, (MESH, &broken)], &format!("mine.mesh:{line}:")),
        (&[pass, (MESH, "")], "mine.mesh:1: error: the file is empty"),
        (
            &[pass, (MESH, "\n#version 310 es\nvoid main() {}\n")],
            "mine.mesh:2: error: a mesh stage begins with `#version 460`",
        ),
        (
            &[("passes/mine.frag", full_screen), (MESH, &good)],
            "mine.mesh:3:6: error: the pass `mine` draws no model, so it has no mesh stage",
        ),
        (&[pass, (TASK, &task)], "mine.task:3:6: error: the task stage needs a mesh stage beside it, passes/mine.mesh"),
        (&[pass, (GEOM, &geom), (MESH, &good)], "mine.geom:9:6: error: passes/mine.mesh replaces this geometry stage"),
        (&[pass, (MESH, &after)], "mine.mesh:4:6: error: the stage reads what a task stage gives, passes/mine.task"),
        (
            &[pass, (TASK, &task), (MESH, &good)],
            "mine.mesh:3:6: error: the stage does not read what passes/mine.task gives",
        ),
        (&[("passes/mine.frag", &unmatched), (MESH, &good)], "mine.frag reads `vec2 more` at location 9, "),
        (
            &[("passes/mine.frag", &reads_number), (MESH, no_number)],
            "passes/mine.frag reads gl_PrimitiveID, which this stage does not write",
        ),
        (&[pass, (MESH, no_number)], "mine.frag reads `vec3 Fragment.position_ws` at location 0, "),
    ];
    session.refuses(&before, &cases);
    session.save(MESH, &good);
    let told = lines(&session.headless.shaders().warnings).join("\n");
    assert!(
        told.contains("mine.mesh: warning: nothing draws with this file: passes/mine.frag declares no pass"),
        "{told}"
    );
    assert_validated();
}

#[test]
fn a_mesh_stage_draws_what_the_vertex_stage_draws() {
    if !draws_meshes("the comparison of mesh and vertex stages") {
        return;
    }
    let mut session = alone(16);
    let plain = session.render();
    let text = mesh("", "");
    let reload = session.save(MESH, &text);
    ready(&reload);
    assert_eq!(stages(&reload), [MESH]);
    assert_alike(&plain, &session.render(), "the same triangles");
    // An edit, a broken edit, and the file gone.
    let swollen = mesh("", "f.position_ws *= 1.5;");
    ready(&session.save(MESH, &swollen));
    let large = session.render();
    assert!(covered(&large) > covered(&plain) * 3 / 2, "{} to {}", covered(&plain), covered(&large));
    failed(&session.save(MESH, &swollen.replace("1.5", "nothing")));
    assert_same(&large, &session.render(), "broken");
    ready(&session.delete(&[MESH]));
    assert_same(&plain, &session.render(), "the vertex stage again");
    // Multisampled, to an image, without back faces, and with a slider of its own.
    let slider = "uniform Mine { float grown; };   //@ui \"Grown\" 0..2 = 1.0\n";
    let grows = mesh("", "f.position_ws *= grown;").replace("void main", &format!("{slider}void main"));
    session.set("view.msaa=4");
    ready(&session.save("passes/mine.frag", &FRAGMENT.replace("draw=model", "draw=model cull=back")));
    let plain = session.render();
    ready(&session.save(MESH, &grows));
    assert_alike(&plain, &session.render(), "multisampled");
    session.set("grown=1.5");
    assert!(covered(&session.render()) > covered(&plain) * 3 / 2, "the slider");
    session.set("grown=1.0");
    ready(&session.save("passes/mine.frag", &FRAGMENT.replace(" to=picture", "")));
    let image = session.mode("pass:mine");
    ready(&session.delete(&[MESH]));
    assert_alike(&image, &session.mode("pass:mine"), "an image");
    assert_validated();
}

/// The picture's own stages, in all modes.
#[test]
fn the_picture_can_have_a_mesh_stage() {
    if !draws_meshes("the picture with a mesh stage") {
        return;
    }
    let mut session = session(16, &[]);
    let modes = ["final", "triangle-id", "geometric-normal", "depth"];
    let plain = modes.map(|mode| session.mode(mode));
    ready(&session.save("pbr.mesh", &mesh("", "")));
    for (mode, plain) in modes.iter().zip(&plain) {
        assert_alike(plain, &session.mode(mode), mode);
    }
    session.set("view.wireframe=true");
    session.mode("final");
    assert_validated();
}

#[test]
fn instances_and_task_stages_of_mesh_stages() {
    if !draws_meshes("task stages") {
        return;
    }
    let mut session = alone(16);
    let plain = session.render();
    let write = |session: &mut Session, condition: &str| {
        let files = both(condition);
        files.iter().for_each(|(file, text)| session.tree.write(file, text));
        ready(&session.changed(&[TASK, MESH]));
        session.render()
    };
    assert_alike(&plain, &write(&mut session, "true"), "all groups");
    let half = covered(&write(&mut session, "group_number() % 2u == 0u"));
    assert!(half < covered(&plain) && half > covered(&plain) / 4, "{half} of {}", covered(&plain));
    assert_eq!(covered(&write(&mut session, "false")), 0);
    // Three copies, side by side: the same with a vertex stage, a mesh stage, and a task stage before it.
    ready(&session.save("passes/mine.frag", &FRAGMENT.replace("draw=model", "draw=model instances=3")));
    let side = "f.position_ws = 0.3 * f.position_ws + vec3(0.5 * frame.scene_radius * (float(instance_number()) - 1.0), 0.0, 0.0);";
    let after = mesh("#define AFTER_TASK\n", side);
    session.tree.write(TASK, &task("true"));
    session.tree.write(MESH, &after);
    ready(&session.changed(&[TASK, MESH]));
    let with_task = session.render();
    std::fs::remove_file(session.tree.path(TASK)).unwrap();
    session.tree.write(MESH, &mesh("", side));
    ready(&session.changed(&[TASK, MESH]));
    assert_alike(&with_task, &session.render(), "without a task stage");
    let vertex = session.tree.read("pbr.vert");
    let side = side.replace("f.position_ws", "fragment.position_ws").replace("instance_number()", "gl_InstanceIndex");
    let vertex = vertex.replace("    fragment.to_eye_ws", &format!("    {side}\n    fragment.to_eye_ws"));
    session.tree.write("passes/mine.vert", &vertex);
    std::fs::remove_file(session.tree.path(MESH)).unwrap();
    ready(&session.changed(&["passes/mine.vert", MESH]));
    assert_alike(&with_task, &session.render(), "with a vertex stage");
    assert_validated();
}

#[test]
fn endless_loops_of_mesh_stages_have_their_line() {
    if !draws_meshes("endless loops of mesh stages") {
        return;
    }
    let mut session = alone(4);
    let files = both("true");
    files.iter().for_each(|(file, text)| session.tree.write(file, text));
    ready(&session.changed(&[TASK, MESH]));
    let drawn = session.render();
    let endless = "float x = abs(frame.eye_ws.x);\n    while (x < 1e9) x *= 0.5;\n    ";
    for (file, repaired) in &files {
        let (hook, with) = match *file {
            TASK => ("uint count = list_groups(true)", "uint count = list_groups(x > -1.0)"),
            _ => ("set_corner(i, f)", "f.color.x += x; set_corner(i, f)"),
        };
        let endless = repaired.replacen(hook, &format!("{endless}{with}"), 1);
        session.ends_loop(file, (&endless, repaired), &drawn);
    }
    assert_validated();
}

#[test]
fn models_of_points_have_no_mesh_stage() {
    if !draws_meshes("points beside mesh stages") {
        return;
    }
    let mut session = points(&["passes.model=false"]);
    ready(&session.save("passes/mine.frag", FRAGMENT));
    ready(&session.save(MESH, &mesh("", "")));
    assert_eq!(covered(&session.render()), 0);
    assert_validated();
}
