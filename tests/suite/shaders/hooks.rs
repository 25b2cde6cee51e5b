//! The hooks of user.glsl and user/: each changes what its comment says, and nothing as it ships.

mod everywhere;
mod surface;

use crate::support::{Session, assert_differ, assert_same, glb, load, passes_check, ready, settings, srgb};
use specula::render::Capture;

const USER: &str = "user.glsl";
const PARAMS: &str = "user/params.glsl";
const VERTEX: &str = "user/vertex.glsl";
const BACKGROUND: &str = "user/background.glsl";
const DISPLAY: &str = "user/display.glsl";

/// A gray sphere, one sample a pixel, on nothing.
fn sphere(rings: u32, more: &[&str]) -> Session {
    let plain = ["view.msaa=1", "view.background=none", "environment.name=none"];
    let model = load(&glb::model(&glb::sphere(rings, 128), &glb::gray()));
    Session::new(model, settings(&[&plain[..], more].concat()))
}

/// Writes `code` as the body of the hook that starts with `head`.
fn fill(session: &mut Session, file: &str, head: &str, code: &str) {
    ready(&session.edit(file, head, &format!("{head}\n    {code}")));
}

fn add_parameter(session: &mut Session, declaration: &str) {
    let first = "    float roughness_scale;";
    ready(&session.edit(PARAMS, first, &format!("    {declaration}\n{first}")));
}

/// The raw values on the model, each with its index.
fn covered(capture: &Capture) -> Vec<(usize, [f32; 3])> {
    let values = capture.raw.iter().enumerate().filter(|(_, v)| v[3] == 1.0);
    values.map(|(i, v)| (i, [v[0], v[1], v[2]])).collect()
}

/// Sum of the green channel of the pixels that something covers.
fn sum(capture: &Capture) -> f64 {
    covered(capture).iter().map(|(_, v)| f64::from(v[1])).sum()
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

const VERTEX_HOOK: &str = "void user_vertex(inout Vertex vertex) {";
const LIGHT_HOOK: &str = "void user_light(inout Light light, uint index, vec3 position_ws) {";
const BACKGROUND_HOOK: &str = "vec3 user_background(vec3 direction_ws, vec3 radiance) {";
const DISPLAY_HOOK: &str = "vec3 user_display(vec3 light, vec2 uv) {";

#[test]
fn as_they_ship_the_hooks_change_nothing() {
    let studio = ["environment.name=studio", "view.background=env"];
    let mut session = Session::new(crate::support::model("shader-ball"), settings(&studio));
    let before = session.render();
    assert!(!session.headless.is_animated().unwrap());
    for (file, call, without) in [
        ("pbr.vert", "    user_vertex(vertex);\n", ""),
        (
            "sky.frag",
            "user_background(normalize(direction), background_radiance(direction))",
            "background_radiance(direction)",
        ),
        ("tonemap.frag", "user_display(value, uv)", "value"),
        ("lighting/punctual.glsl", "    user_light(light, i, position_ws);\n", ""),
    ] {
        ready(&session.edit(file, call, without));
        assert_same(&before, &session.render(), file);
    }
}

#[test]
fn the_vertex_hook_moves_the_silhouette() {
    let mut session = sphere(64, &[]);
    let whole = covered(&session.render()).len();
    fill(&mut session, VERTEX, VERTEX_HOOK, "vertex.position *= gl_VertexIndex >= 0 ? 0.5 : 1.0;");
    // Half the radius is a quarter of the area, seen from three radii away or more.
    let shrunk = covered(&session.render()).len() as f64 / whole as f64;
    assert!((0.18..0.27).contains(&shrunk), "{shrunk} of the area is left");
    passes_check(&session);
}

/// The example in the hook's comment.
fn documented_wave(session: &Session) -> Vec<String> {
    let text = session.tree.read(VERTEX);
    let code: Vec<String> = text.lines().filter_map(|line| line.strip_prefix("//     ")).map(str::to_owned).collect();
    assert_eq!(code.len(), 5, "{code:#?}");
    code
}

/// The mean angle between the normals that are shaded and those of the triangles, radians.
fn mean_angle(session: &mut Session) -> f32 {
    let shading = covered(&session.mode("shading-normal"));
    let facets = covered(&session.mode("facet-normal"));
    let angles: Vec<f32> = shading.iter().zip(&facets).map(|(a, b)| dot(a.1, b.1).min(1.0).acos()).collect();
    angles.iter().sum::<f32>() / angles.len() as f32
}

#[test]
fn the_normals_of_the_documented_wave_are_those_of_the_moved_surface() {
    let mut session = sphere(512, &[]);
    let code = documented_wave(&session);
    let (normal, without) = code.split_last().unwrap();
    assert!(normal.starts_with("vertex.normal ="), "{normal}");
    fill(&mut session, VERTEX, VERTEX_HOOK, &without.join("\n    "));
    assert!(session.headless.is_animated().unwrap(), "the wave reads the time");
    let kept = mean_angle(&mut session);
    let last = without.last().unwrap().clone();
    ready(&session.edit(
        VERTEX,
        &format!("{VERTEX_HOOK}\n    {}", without.join("\n    ")),
        &format!("{VERTEX_HOOK}\n    {}", code.join("\n    ")),
    ));
    let tilted = mean_angle(&mut session);
    assert!(last.starts_with("vertex.position +=") && kept > 0.08, "{last}: {kept} rad with the mesh's normals");
    assert!(tilted < 0.2 * kept, "{tilted} rad with tilted normals, {kept} without");
}

#[test]
fn the_light_hook_changes_one_light_at_one_point() {
    let mut session = sphere(64, &["lights.rect.enabled=true"]);
    let (first, rectangle) = (session.mode("light-1"), session.mode("area-light"));
    let (positions, ambient) = (covered(&session.mode("position")), session.mode("ambient"));
    // The three orbiting lights come first, then the rectangle.
    fill(&mut session, USER, LIGHT_HOOK, "if (index != 0u) light.intensity = vec3(0.0);");
    let only_first = session.mode("final");
    for (((i, light), (_, ambient)), (_, found)) in
        covered(&first).into_iter().zip(covered(&ambient)).zip(covered(&only_first))
    {
        let expected: [f32; 3] = std::array::from_fn(|c| light[c] + ambient[c]);
        let near = (0..3).all(|c| (expected[c] - found[c]).abs() <= 1e-5 * expected[c].abs().max(1.0));
        assert!(near, "pixel {i}: {found:?}, light 1 and the ambient light are {expected:?}");
    }
    assert!(covered(&rectangle).iter().any(|(_, v)| v[0] > 0.0), "the rectangle shone");
    assert!(covered(&session.mode("area-light")).iter().all(|(_, v)| *v == [0.0; 3]), "the rectangle is off");

    ready(&session.edit(USER, "if (index != 0u)", "if (position_ws.x > 0.0)"));
    let lambert = session.mode("lambert");
    let lit = |right: bool| {
        let side = positions.iter().filter(move |(_, p)| (p[0] > 0.0) == right);
        side.filter(|(i, _)| lambert.raw[*i][0] > 0.0).count()
    };
    assert_eq!(lit(true), 0);
    assert!(lit(false) > 300);
    passes_check(&session);
}

/// Without shadows, which a sphere does not cast on its lit side, random paths see the lamps that the picture sees.
#[test]
fn the_light_hook_reaches_random_paths() {
    let more = ["lights.rect.enabled=true", "view.frames=24", "view.bounces=0", "lights.ambient_strength=0"];
    let mut session = sphere(64, &more);
    let all = sum(&session.mode("path-traced"));
    fill(&mut session, USER, LIGHT_HOOK, "if (index != 0u) light.intensity = vec3(0.0);");
    let [picture, paths] = ["final", "path-traced"].map(|mode| sum(&session.mode(mode)));
    assert!(paths < 0.8 * all, "the first light alone: {paths} of {all}");
    assert!((paths / picture - 1.0).abs() < 0.05, "paths {paths}, the picture {picture}");
    // Where the hook depends on the place, so do the paths.
    ready(&session.edit(USER, "if (index != 0u)", "if (position_ws.x > 0.0)"));
    let positions = covered(&session.mode("position"));
    let values = session.mode("path-traced");
    for (i, p) in positions.iter().filter(|(_, p)| p[0].abs() > 0.05) {
        assert!(p[0] < 0.0 || values.raw[*i][1] == 0.0, "pixel {i} at {p:?}: {:?}", values.raw[*i]);
    }
    assert!(sum(&values) > 0.0, "the left side is lit");
}

#[test]
fn the_background_hook_changes_what_is_behind_the_model() {
    let mut session = sphere(64, &["environment.name=furnace"]);
    session.set("view.background=env");
    let before = session.render();
    add_parameter(&mut session, "float gain;                //@ui \"Gain\" 0..4 = 1.0");
    fill(&mut session, BACKGROUND, BACKGROUND_HOOK, "radiance *= abs(direction_ws) * gain;");
    session.set("gain=2.0");
    let after = session.render();
    let mut behind = 0;
    let model = session.mode("alpha");
    for ((before, after), model) in before.raw.iter().zip(&after.raw).zip(&model.raw) {
        if model[3] > 0.0 {
            assert_eq!(before, after, "the model is lit as before");
            continue;
        }
        // The furnace is 1 everywhere, and the direction has length 1.
        let length = after[..3].iter().map(|c| c * c).sum::<f32>().sqrt();
        assert!((length - 2.0).abs() < 1e-3, "{after:?}");
        behind += 1;
    }
    assert!(behind > 1000, "{behind} pixels show the background");
    passes_check(&session);
}

#[test]
fn the_display_hook_grades_light_before_the_tone_map() {
    let mut session = sphere(64, &["view.tonemap=none", "view.ev=1"]);
    let data = session.mode("n-dot-v");
    add_parameter(&mut session, "vec3 tint;                 //@ui \"Tint\" color = 1 1 1");
    let constant =
        "layout(constant_id = USER_CONSTANTS + 17) const uint GRADE = 0u;   //@ui \"Grade\" choice Off=0 Tint=1";
    ready(&session.edit(DISPLAY, "// Exposed light", &format!("{constant}\n\n// Exposed light")));
    fill(&mut session, DISPLAY, DISPLAY_HOOK, "if (GRADE == 1u && uv.x < 0.5) light *= tint;");
    let plain = session.mode("final");
    session.set("tint=[0.5, 0.25, 0.125]");
    assert_same(&plain, &session.render(), "the list says Off");
    session.set("GRADE=Tint");
    let graded = session.render();
    let exposure = 1.0 / (1.2 * 2.0);
    for (i, value) in covered(&graded) {
        let tint = if (i as u32 % graded.width) < graded.width / 2 { [0.5, 0.25, 0.125] } else { [1.0; 3] };
        for c in 0..3 {
            let expected = srgb(f64::from(value[c]) * exposure * tint[c]) * 255.0;
            let found = f64::from(graded.rgba8[4 * i + c]);
            assert!((found - expected).abs() <= 1.0, "pixel {i}: {found}, expected {expected}");
        }
    }
    assert_same(&data, &session.mode("n-dot-v"), "data does not pass through the hook");
    passes_check(&session);
}

#[test]
fn parameters_and_constants_reach_the_tone_maps() {
    let mut session = sphere(64, &["view.tonemap=reinhard"]);
    let plain = session.render();
    add_parameter(&mut session, "float knee;                //@ui \"Knee\" 0.1..4 = 1.0");
    let tonemap = session.tree.edited("common/tonemap.glsl", "#include \"common/math.glsl\"\n", "#include \"common/math.glsl\"\n#include \"user/params.glsl\"\nlayout(constant_id = USER_CONSTANTS + 18) const bool SQUARED = false;   //@ui \"Squared\"\n");
    let own = "vec3 tonemap_reinhard(vec3 x) { return (SQUARED ? x * x : x) / (knee + x); }";
    ready(
        &session.save(
            "common/tonemap.glsl",
            &tonemap.replace("vec3 tonemap_reinhard(vec3 x) { return x / (1.0 + x); }", own),
        ),
    );
    assert_same(&plain, &session.render(), "the defaults");
    session.set("knee=2.0");
    let knee = session.render();
    assert_differ(&plain, &knee, "a parameter");
    session.set("SQUARED=true");
    assert_differ(&knee, &session.render(), "a constant");
    passes_check(&session);
}
