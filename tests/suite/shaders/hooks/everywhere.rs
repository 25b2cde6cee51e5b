//! Each kind of hook in each place that draws or traces the model: shadows, ambient occlusion, the ground, random paths.

use serde_json::{Value, json};
use specula::render::Capture;
use specula::scene::Model;

use super::{LIGHT_HOOK, USER, VERTEX, VERTEX_HOOK, fill};
use crate::support::{SIZE, Session, assert_differ, assert_same, failed, glb, lines, load, ready, settings};

pub const SURFACE_HOOK: &str = "void user_surface(inout Surface s, Fragment f, vec3 v) {";

/// A floor, and a lid above one of its sides that juts out.
fn under(lid: Value) -> Model {
    let floor = glb::cuboid([-1.0, -0.1, -1.0], [0.3, 0.0, 1.0], true);
    let above = glb::cuboid([-0.4, 0.2, -0.6], [0.9, 0.3, 0.6], true);
    load(&glb::scene(&[(floor, glb::gray()), (above, lid)]))
}

fn lid(alpha_mode: &str, alpha: f64) -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, alpha], "metallicFactor": 0.0 },
        "alphaMode": alpha_mode })
}

fn session(model: Model) -> Session {
    let plain = ["view.msaa=1", "view.background=none", "environment.name=none", "lights.ambient_strength=2"];
    Session::new(model, settings(&[&plain[..], &["view.frames=4", "view.bounces=2"]].concat()))
}

/// What switches each place on and off.
const PLACES: [(&str, [&[&str]; 2]); 4] = [
    ("shadows", [&["SHADOWS=Hard"], &["SHADOWS=Off"]]),
    ("occlusion", [&["AMBIENT_OCCLUSION=true"], &["AMBIENT_OCCLUSION=false"]]),
    ("the ground", [&["SHADOWS=Hard", "mode=pass:ground_light"], &["SHADOWS=Off", "mode=final"]]),
    ("random paths", [&["mode=path-traced"], &["mode=final"]]),
];

/// A picture of each place.
fn pictures(session: &mut Session) -> Vec<(&'static str, Capture)> {
    let mut of = |(place, [on, off]): (&'static str, [&[&str]; 2])| {
        on.iter().for_each(|setting| session.set(setting));
        let picture = session.render();
        off.iter().for_each(|setting| session.set(setting));
        (place, picture)
    };
    PLACES.map(&mut of).into()
}

#[track_caller]
fn assert_alike(found: &[(&str, Capture)], expected: &[(&str, Capture)], what: &str) {
    for ((place, found), (_, expected)) in found.iter().zip(expected) {
        assert_same(found, expected, &format!("{what} in {place}"));
    }
}

/// A masked lid that the material cuts away is the same as one that the hook cuts away, or discards.
#[test]
fn a_surface_that_the_hook_dissolves_takes_its_shadow_with_it() {
    let without = pictures(&mut session(under(lid("MASK", 0.0))));
    let mut masked = session(under(lid("MASK", 1.0)));
    for ((place, solid), (_, hole)) in pictures(&mut masked).iter().zip(&without) {
        assert_differ(solid, hole, place);
    }
    fill(&mut masked, USER, SURFACE_HOOK, "s.coverage = 0.0;");
    assert_alike(&pictures(&mut masked), &without, "no coverage");

    let mut opaque = session(under(lid("OPAQUE", 1.0)));
    let solid = pictures(&mut opaque);
    fill(&mut opaque, USER, SURFACE_HOOK, "s.coverage = 0.0;");
    assert_alike(&pictures(&mut opaque), &solid, "opaque surfaces ignore coverage");
    fill(&mut opaque, USER, SURFACE_HOOK, "if (s.position_ws.y > 0.1) discard;");
    assert_alike(&pictures(&mut opaque), &without, "a discard");
}

/// The ground's image of what lies over it has the holes of a masked material.
#[test]
fn the_ground_is_lit_through_holes() {
    let lone = |alpha: f64| {
        let model = load(&glb::model(&glb::cuboid([-1.0, 0.0, -1.0], [1.0, 0.1, 1.0], true), &lid("MASK", alpha)));
        let blockers = session(model).mode("pass:ground_blockers");
        // Red is 1 under a surface.
        blockers.raw.iter().map(|value| value[0]).sum::<f32>()
    };
    assert!(lone(1.0) > 100.0);
    assert_eq!(lone(0.0), 0.0);
}

/// A lamp that the hook turns about the model is the same as one that the settings turn.
#[test]
fn the_shadow_of_a_light_that_the_hook_moves_follows_it() {
    let dark = ["lights.orbit.1.strength=0", "lights.orbit.2.strength=0", "lights.ambient_strength=0"];
    let mut session = session(under(lid("OPAQUE", 1.0)));
    dark.iter().for_each(|set| session.set(set));
    let before = pictures(&mut session);
    session.set("lights.orbit.0.azimuth=90");
    let expected = pictures(&mut session);
    session.set("lights.orbit.0.azimuth=0");
    // The lamp is at +Z of the center at 0 degrees, and at +X at 90.
    let turn = "vec3 from = light.position_ws.xyz - frame.scene_center_ws;\n    \
        if (index == 0u) light.position_ws.xyz = frame.scene_center_ws + vec3(from.z, from.y, -from.x);";
    fill(&mut session, USER, LIGHT_HOOK, turn);
    for (((place, found), (_, expected)), (_, before)) in pictures(&mut session).iter().zip(&expected).zip(&before) {
        assert_differ(found, before, place);
        let far = |(a, b): (&[f32; 4], &[f32; 4])| (0..3).any(|c| (a[c] - b[c]).abs() > 0.02 * (0.1 + a[c].max(b[c])));
        let count = found.raw.iter().zip(&expected.raw).filter(|pair| far(*pair)).count();
        // Borders of shadows may fall into other texels.
        assert!(count < 20, "{place}: {count} pixels differ from those of the lamp that the settings moved");
    }
}

/// A lid that the vertex hook folds into a point is gone everywhere but in random paths, which say so.
#[test]
fn vertices_that_the_hook_moves_are_seen_or_said() {
    let without = pictures(&mut session(under(lid("MASK", 0.0))));
    let mut session = session(under(lid("MASK", 1.0)));
    session.set("mode=path-traced");
    let limit = |session: &Session| session.headless.frame_state().unwrap().pipelines.limit();
    assert_eq!(limit(&session), None);
    session.set("mode=final");
    fill(&mut session, VERTEX, VERTEX_HOOK, "if (draw.primitive_id == 1u) vertex.position = vec3(0.0);");
    let found = pictures(&mut session);
    assert_alike(&found[..3], &without[..3], "folded");
    assert_eq!(limit(&session), None, "the picture shows it");
    session.set("mode=path-traced");
    assert!(limit(&session).is_some_and(|text| text.contains("as it was loaded")), "{:?}", limit(&session));
}

/// What the hook makes transparent casts no shadow, as a material that transmits does.
#[test]
fn features_of_the_hook_count_everywhere() {
    let glass = json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1.0 } } });
    let glass = pictures(&mut session(under(glass)));
    let mut session = session(under(lid("OPAQUE", 1.0)));
    let solid = pictures(&mut session);
    fill(&mut session, USER, SURFACE_HOOK, "s.transmission = s.position_ws.y > 0.1 ? 1.0 : 0.0;");
    for (((place, found), (_, solid)), (_, glass)) in pictures(&mut session).iter().zip(&solid).zip(&glass) {
        assert_differ(found, solid, place);
        // The left of the picture shows the floor alone. Paths draw other directions for a floor that might transmit, so they agree in
        // the mean.
        let of = |capture: &Capture| {
            let left = capture.raw.iter().enumerate().filter(|(i, _)| i % SIZE.0 as usize <= SIZE.0 as usize / 3);
            left.map(|(_, value)| f64::from(value[1])).sum::<f64>()
        };
        let ratio = of(found) / of(glass);
        let tolerance = if *place == "random paths" { 0.1 } else { 0.02 };
        assert!((ratio - 1.0).abs() < tolerance, "{place}: {ratio} of the light under glass");
    }
}

/// The occlusion is made of an image whose pass calls the hook as well. A color that depends on the occlusion leaves that image alone;
/// holes that depend on it are a circle.
#[test]
fn the_hook_may_color_by_the_occlusion() {
    let mut session = session(under(lid("OPAQUE", 1.0)));
    session.set("AMBIENT_OCCLUSION=true");
    let before = session.render();
    let include = "#include \"user/params.glsl\"\n";
    let text =
        session.tree.edited(USER, include, &format!("{include}#include \"lighting/shadows/ambient_occlusion.glsl\"\n"));
    let color = "    s.base_color *= screen_visibility(1.0 / gl_FragCoord.w);\n";
    let text = text.replace(SURFACE_HOOK, &format!("{SURFACE_HOOK}\n{color}"));
    ready(&session.save(USER, &text));
    assert_differ(&before, &session.render(), "dirt in the corners");
    let holes = text.replace("s.base_color *= screen", "s.coverage *= screen");
    let told = lines(failed(&session.save(USER, &holes))).join("\n");
    assert!(told.contains("geometry -> occlusion -> occlusion_raw -> geometry"), "{told}");
}
