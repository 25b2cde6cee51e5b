//! The hook into the material: what it gets, what follows what it sets, and what it may call.

use serde_json::{Value, json};
use specula::render::Capture;

use super::everywhere::SURFACE_HOOK;
use super::{USER, covered, dot, fill, sphere, sum};
use crate::support::{Session, assert_differ, assert_same, failed, glb, line_of, lines, load, passes_check, settings};

fn of_material(material: &Value) -> Session {
    let plain = ["view.msaa=1", "view.background=none", "environment.name=studio"];
    Session::new(load(&glb::model(&glb::sphere(32, 64), material)), settings(&plain))
}

fn with_extensions(extensions: Value) -> Value {
    let mut material = glb::gray();
    material["extensions"] = extensions;
    material
}

/// The hook gets what the modes of texture coordinates, vertex color and position show.
#[test]
fn the_hook_gets_the_fragment_and_the_view_direction() {
    let mut session = sphere(32, &[]);
    let [positions, facing] = ["position", "n-dot-v"].map(|mode| session.mode(mode));
    fill(&mut session, USER, SURFACE_HOOK, "s.base_color = vec3(dot(s.n, v), f.uv0.x + f.uv1.y, f.color.g);");
    let found = session.mode("base-color");
    for (i, value) in covered(&found) {
        let expected = [facing.raw[i][0], 0.0, 1.0];
        assert!((0..3).all(|c| (value[c] - expected[c]).abs() < 2e-3), "pixel {i}: {value:?}, not {expected:?}");
    }
    fill(&mut session, USER, SURFACE_HOOK, "s.base_color = 0.5 * f.position_ws + 0.5; return;");
    let found = session.mode("base-color");
    for (i, value) in covered(&found) {
        assert!((0..3).all(|c| (value[c] - 0.5 - 0.5 * positions.raw[i][c]).abs() < 2e-3), "pixel {i}: {value:?}");
    }
    passes_check(&session);
}

/// The hook of an older tree is refused at its line, with what to write.
#[test]
fn a_hook_with_other_parameters_is_refused_at_its_line() {
    let mut session = sphere(16, &[]);
    let before = session.render();
    let text = session.tree.edited(USER, SURFACE_HOOK, "void user_surface(inout Surface s) {");
    let told = lines(failed(&session.save(USER, &text))).join("\n");
    let expected =
        format!("user.glsl:{}:6: error: `user_surface` has other parameters", line_of(&text, "void user_surface("));
    assert!(told.contains(&expected), "{told}\nis not\n{expected}");
    assert!(told.lines().count() == 1, "{told}");
    assert_same(&before, &session.render(), "the picture stays");
}

/// What an extension of the material does, the hook does by setting the same member.
#[test]
fn a_member_that_the_hook_sets_needs_no_extension() {
    let mut session = of_material(&glb::gray());
    let plain = session.render();
    for (extensions, code) in [
        (json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 } }), "s.clearcoat = 1.0;"),
        (
            json!({ "KHR_materials_sheen": { "sheenColorFactor": [1.0, 0.5, 0.2], "sheenRoughnessFactor": 0.4 } }),
            "s.sheen_color = vec3(1.0, 0.5, 0.2); s.sheen_roughness = 0.4;",
        ),
        (json!({ "KHR_materials_iridescence": { "iridescenceFactor": 1.0 } }), "s.iridescence = 1.0;"),
        (json!({ "KHR_materials_anisotropy": { "anisotropyStrength": 0.8 } }), "s.anisotropy = 0.8;"),
        (json!({ "KHR_materials_transmission": { "transmissionFactor": 0.7 } }), "s.transmission = 0.7;"),
        (
            json!({ "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 0.5 } }),
            "s.diffuse_transmission = 0.5;",
        ),
    ] {
        let expected = of_material(&with_extensions(extensions)).render();
        assert_differ(&plain, &expected, code);
        fill(&mut session, USER, SURFACE_HOOK, &format!("{code} return;"));
        let found = session.render();
        for (i, (a, b)) in found.raw.iter().zip(&expected.raw).enumerate() {
            assert!(
                (0..3).all(|c| (a[c] - b[c]).abs() <= 2e-3 * b[c].abs().max(1.0)),
                "{code} pixel {i}: {a:?}, not {b:?}"
            );
        }
    }
    passes_check(&session);
}

/// F0 follows the index of refraction, unless the hook sets both.
#[test]
fn f0_follows_the_index_of_refraction() {
    let mut session = of_material(&glb::gray());
    let expected = of_material(&with_extensions(json!({ "KHR_materials_ior": { "ior": 2.4 } }))).render();
    fill(&mut session, USER, SURFACE_HOOK, "s.ior = 2.4; return;");
    let found = session.render();
    for (i, (a, b)) in found.raw.iter().zip(&expected.raw).enumerate() {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() <= 2e-3 * b[c].abs().max(0.1)), "pixel {i}: {a:?}, not {b:?}");
    }
    fill(&mut session, USER, SURFACE_HOOK, "s.ior = 2.4; s.f0 = vec3(0.04); return;");
    assert_differ(&found, &session.render(), "the author's own F0");
}

/// Normals that the hook tilts are unit, and the frame of an anisotropic lobe stays perpendicular to them.
#[test]
fn the_frame_follows_a_normal_that_the_hook_tilts() {
    let mut session = of_material(&with_extensions(json!({ "KHR_materials_anisotropy": { "anisotropyStrength": 0.8 },
        "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 } })));
    fill(&mut session, USER, SURFACE_HOOK, "s.n += vec3(0.5, 0.2, 0.0); return;");
    let show = "vec3 user_radiance(Surface s, vec3 v, vec3 radiance) {";
    let code =
        "return vec3(length(s.n), dot(s.n, s.t), distance(s.b, cross(s.n, s.t)) + distance(s.n, s.clearcoat_n));";
    fill(&mut session, USER, show, code);
    for (i, value) in covered(&session.render()) {
        let expected = [1.0, 0.0, 0.0];
        assert!(dot([value[0] - expected[0], value[1], value[2]], [1.0; 3]).abs() < 2e-3, "pixel {i}: {value:?}");
    }
}

/// Where random paths hit, a discard takes the surface from the ray, and not the pixel from the picture; derivatives are 0.
#[test]
fn paths_call_the_hook_without_neighbors() {
    let floor = glb::cuboid([-1.0, -0.1, -1.0], [1.0, 0.0, 1.0], true);
    let above = glb::cuboid([-0.5, 0.2, -0.5], [0.5, 0.3, 0.5], true);
    let model = load(&glb::scene(&[(floor, glb::gray()), (above, glb::gray())]));
    let plain =
        ["view.msaa=1", "view.background=none", "environment.name=none", "view.frames=8", "lights.ambient_strength=2"];
    let mut session = Session::new(model, settings(&plain));
    let code = "s.emissive = vec3(fwidth(f.position_ws.x) == 0.0 ? 20.0 : 0.0);\n    \
        if (s.position_ws.y > 0.05 && fract(20.0 * s.position_ws.x) < 0.5) discard;";
    let dark = session.mode("path-traced");
    fill(&mut session, USER, SURFACE_HOOK, code);
    let (picture, paths) = (session.mode("final"), session.mode("path-traced"));
    let seen = |capture: &Capture| covered(capture).iter().map(|(i, _)| *i).collect::<Vec<_>>();
    assert_eq!(seen(&picture), seen(&paths), "a hit discards no pixel");
    assert!(sum(&paths) > 1.2 * sum(&dark), "hits have derivatives of 0, so they glow: {} {}", sum(&paths), sum(&dark));
    passes_check(&session);
}
