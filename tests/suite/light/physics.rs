//! Physics at the seams: values that only an edit gives, normals that normal textures tilt, points and lines, light from behind.

use crate::support::{SIZE, Session, glb, load, ready, render, renderer, settings};
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::render::Capture;

/// One sample a pixel, on nothing, with the flat ambient light of strength 1 and no lamp.
const FLAT: [&str; 6] = [
    "view.msaa=1",
    "view.background=none",
    "environment.name=none",
    "lights.source=none",
    "lights.ambient_strength=1",
    "lights.ambient_color=[1, 1, 1]",
];
/// Head-on, from 3 m.
const HEAD_ON: [&str; 3] = ["camera.eye=[0, 0, 3]", "camera.target=[0, 0, 0]", "camera.fovy=30"];
/// The lamps of the model alone.
const LAMPS: [&str; 2] = ["lights.source=model", "lights.ambient_strength=0"];

fn material(color: f64, metallic: f64, roughness: f64) -> Value {
    json!({ "doubleSided": true, "pbrMetallicRoughness": { "baseColorFactor": [color, color, color, 1.0],
        "metallicFactor": metallic, "roughnessFactor": roughness } })
}

fn session(bytes: &[u8], more: &[&str]) -> Session {
    Session::new(load(bytes), settings(&[&FLAT[..], &HEAD_ON, more].concat()))
}

/// Changes the surface that the material gives, before anything reads it.
#[track_caller]
fn change_surface(session: &mut Session, code: &str) {
    let end = "    return s;\n}\n\n#endif";
    ready(&session.edit("material/material.glsl", end, &format!("    {code}\n{end}")));
}

/// The shading normal leans by this angle towards +X; the mesh faces +Z.
fn tilt(session: &mut Session, degrees: f32) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    change_surface(session, &format!("s.n = s.clearcoat_n = vec3({sin:?}, 0.0, {cos:?});"));
}

/// Green of the pixel in the middle.
fn middle(capture: &Capture) -> f32 {
    capture.raw_at(capture.width / 2, capture.height / 2).unwrap()[1]
}

/// Green along the middle row, where the model is.
fn row(capture: &Capture) -> Vec<f32> {
    let values = (0..capture.width).map(|x| capture.raw_at(x, capture.height / 2).unwrap());
    values.filter(|value| value[3] == 1.0).map(|value| value[1]).collect()
}

/// A directional light of 1 lux from the plane of X and Z, at this angle from +Z towards +X.
fn square_under_a_lamp(mesh: &glb::Mesh, material: &Value, degrees: f64) -> Vec<u8> {
    let (sin, cos) = (0.5 * degrees).to_radians().sin_cos();
    let light = json!({ "type": "directional", "intensity": 10.0 });
    glb::model_with_light(mesh, material, &light, &json!({ "rotation": [0.0, sin, 0.0, cos] }))
}

/// Fdez-Aguera's and Kulla & Conty's series had a pole where F (1 - E) = 1: a white metal of roughness 1 was 7 times too bright at a base
/// color of 1.5, and black at 2. Oren & Nayar's has one at 6.
#[test]
fn base_colors_above_1_have_no_pole() {
    for (metallic, models) in [
        (1.0, ["MULTI_SCATTER=KullaConty", "MULTI_SCATTER=FdezAguera"]),
        (0.0, ["DIFFUSE=OrenNayar", "DIFFUSE=Lambert"]),
    ] {
        let bytes = square_under_a_lamp(&glb::quad(1.0), &material(1.0, metallic, 1.0), 30.0);
        let mut session = session(&bytes, &[]);
        // From 0 at the left edge to 10 at the right.
        change_surface(&mut session, "s.base_color *= 5.0 * (s.position_ws.x + 1.0);");
        for (model, lamps) in models.iter().flat_map(|model| [(model, false), (model, true)]) {
            session.set(model);
            session.set(if lamps { "lights.source=model" } else { "lights.source=none" });
            session.set(if lamps { "lights.ambient_strength=0" } else { "lights.ambient_strength=1" });
            let values = row(&session.mode("final"));
            assert!(values.len() > 30, "{}", values.len());
            for (i, pair) in values.windows(2).enumerate() {
                assert!(pair[1] > pair[0], "{model} lamps {lamps}: falls at {i}: {values:?}");
            }
            // Beyond 1 the light grows no faster than the base color. Fdez-Aguera's form keeps all of the light up to a color of 1, less 2 %.
            let color = |i: usize| 10.0 * (i as f32 + 0.5) / values.len() as f32;
            let parts: Vec<f32> = (0..values.len()).filter(|i| color(*i) > 1.0).map(|i| values[i] / color(i)).collect();
            assert!(parts.windows(2).all(|pair| pair[1] < 1.003 * pair[0]), "{model} lamps {lamps}: {parts:?}");
        }
    }
}

/// Light of a lamp 10 degrees below the plane of the mesh reached a shading normal that leaned towards it, in the picture and in random paths.
#[test]
fn no_lamp_shines_through_the_mesh() {
    let lit = |degrees: f64, more: &[&str], mode: &str| {
        let bytes = square_under_a_lamp(&glb::quad(1.0), &material(0.5, 0.0, 0.5), degrees);
        let mut session = session(&bytes, &[&LAMPS[..], &["view.frames=4", "view.bounces=0"], more].concat());
        tilt(&mut session, 60.0);
        middle(&session.mode(mode))
    };
    for mode in ["final", "path-traced", "dielectric"] {
        let [before, grazing, below] = [60.0, 89.0, 100.0].map(|degrees| lit(degrees, &[], mode));
        assert!(before > 0.5 && below == 0.0, "{mode}: {before}, below the mesh {below}");
        assert!(grazing < 0.3 * before, "{mode}: the light fades towards the horizon: {before} {grazing}");
    }
    let square = |azimuth: i32| {
        let azimuth = format!("lights.rect.azimuth={azimuth}");
        let lamp = ["lights.rect.enabled=true", "lights.rect.polar=90", "lights.rect.distance=2", &azimuth];
        let bytes = glb::model(&glb::quad(1.0), &material(0.5, 0.0, 0.5));
        let mut session = session(&bytes, &[&LAMPS[..], &lamp].concat());
        tilt(&mut session, 60.0);
        middle(&session.mode("final"))
    };
    let (above, below) = (square(60), square(130));
    assert!(above > 0.1 && below == 0.0, "a rectangle: {above}, below the mesh {below}");
}

/// A mirror whose normal leans by 60 degrees reflects what lies 30 degrees below the mesh. That fades as (1 - sin 30)^2 = 1/4.
#[test]
fn reflections_below_the_mesh_fade() {
    let mut session = session(&glb::model(&glb::quad(1.0), &material(1.0, 1.0, 0.0)), &[]);
    let flat = middle(&session.mode("ambient"));
    tilt(&mut session, 60.0);
    let below = middle(&session.mode("ambient"));
    assert!((flat - 1.0).abs() < 0.01 && (below - 0.25).abs() < 0.01, "{flat} {below}");
}

/// Random paths started on the far side of an open plane where a shading normal, or a vertex normal, led them there, and saw the light
/// of that side.
#[test]
fn random_paths_do_not_pass_through_an_opaque_plane() {
    let lean = 45_f32.to_radians();
    let leaning = glb::Mesh { normals: vec![[lean.sin(), 0.0, lean.cos()]; 4], ..glb::quad(1.0) };
    for (mesh, degrees, what) in [(glb::quad(1.0), 45.0, "shading normals"), (leaning, 0.0, "vertex normals")] {
        let bytes = square_under_a_lamp(&mesh, &material(0.5, 0.0, 1.0), 100.0);
        let more = [&LAMPS[..], &["view.frames=16", "view.bounces=0"]].concat();
        let mut session = session(&bytes, &more);
        if degrees > 0.0 {
            tilt(&mut session, degrees);
        }
        let lamp = middle(&session.mode("path-traced"));
        assert_eq!(lamp, 0.0, "{what}: a lamp behind the plane");
        // Of a lobe around the leaning normal, (1 - cos 45 degrees) / 2 = 15 % lie below the plane. The shading normal's own
        // horizon is known to `monte-carlo` too, which traces nothing.
        session.set("environment.name=furnace");
        session.set("lights.source=none");
        session.set("view.frames=32");
        let mut mean = |mode: &str| row(&session.mode(mode)).iter().sum::<f32>();
        let (open, traced) = (mean("monte-carlo"), mean("path-traced"));
        let lost = 1.0 - traced / open;
        let expected = if degrees > 0.0 { 0.0 } else { 0.15 };
        assert!((lost - expected).abs() < 0.03, "{what}: {lost} of the light is hidden by the plane");
    }
}

/// Soft shadows took the plane of the shading normal for that of the mesh, which then hid itself.
#[test]
fn a_leaning_normal_casts_no_shadow_on_itself() {
    for degrees in [0.0, 30.0, 60.0] {
        let lamp =
            ["lights.rect.enabled=true", "lights.rect.polar=90", "lights.rect.azimuth=70", "lights.rect.distance=2"];
        let bytes = glb::model(&glb::quad(1.0), &material(0.5, 0.0, 0.5));
        let mut session = session(&bytes, &[&LAMPS[..], &lamp].concat());
        tilt(&mut session, degrees);
        let open = row(&session.mode("final"));
        for shadows in ["Hard", "Soft"] {
            session.set(&format!("SHADOWS={shadows}"));
            let shadowed = row(&session.mode("final"));
            let least =
                open.iter().zip(&shadowed).map(|(open, shadowed)| shadowed / open).fold(f32::INFINITY, f32::min);
            assert!(least > 0.99, "{shadows}, leaning by {degrees} degrees: {least} of the light is left");
        }
    }
}

/// glTF 2.0, section 3.9: without normals they are drawn without lighting, as the sum of base color and emission.
#[test]
fn points_and_lines_without_normals_are_unlit() {
    let picture = |mode: u32, mesh: &glb::Mesh, more: &[&str]| {
        let mut look = material(0.5, 0.0, 0.5);
        look["emissiveFactor"] = json!([0.0, 0.25, 0.0]);
        let (mut json, bin) = glb::document(mesh, &look);
        json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        let settings = settings(&[&FLAT[..], &HEAD_ON, &["lights.ambient_strength=0"], more].concat());
        render(&mut renderer(load(&glb::container(&json, &bin)), settings, SIZE), "final")
    };
    let covered =
        |capture: &Capture| -> Vec<[f32; 4]> { capture.raw.iter().copied().filter(|value| value[3] == 1.0).collect() };
    let bare = glb::Mesh { normals: Vec::new(), ..glb::quad(0.7) };
    for mode in [0, 1, 2, 3] {
        for side in ["camera.eye=[0, 0, 3]", "camera.eye=[0, 0, -3]"] {
            let found = covered(&picture(mode, &bare, &[side]));
            assert!(!found.is_empty(), "mode {mode}");
            for value in found {
                let near = (value[0] - 0.5).abs() < 1e-3 && (value[1] - 0.75).abs() < 1e-3;
                assert!(near, "mode {mode} from {side}: {value:?}");
            }
        }
        let lit = covered(&picture(mode, &glb::quad(0.7), &[]));
        assert!(lit.iter().all(|value| value[0] == 0.0), "with normals, mode {mode} is lit: {lit:?}");
    }
    let faces = covered(&picture(4, &bare, &[]));
    assert!(faces.iter().all(|value| value[0] == 0.0), "triangles without normals are lit by flat ones");
}

/// The occlusion texture is that of the side that the eye sees.
#[test]
fn occlusion_in_front_spares_light_from_behind() {
    let mut leaf = material(0.5, 0.0, 1.0);
    leaf["extensions"] = json!({ "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 0.5 } });
    let mut session = session(&glb::model(&glb::quad(1.0), &leaf), &[]);
    let open = ["transmitted-light", "ibl-diffuse", "ambient"].map(|mode| middle(&session.mode(mode)));
    change_surface(&mut session, "s.occlusion = 0.25;");
    let hidden = ["transmitted-light", "ibl-diffuse", "ambient"].map(|mode| middle(&session.mode(mode)));
    assert!(open[0] > 0.2 && hidden[0] == open[0], "transmitted: {} {}", hidden[0], open[0]);
    let reflected = [open, hidden].map(|[transmitted, _, all]| all - transmitted);
    assert!(reflected[1] < 0.4 * reflected[0], "reflected: {reflected:?}");
}

/// Ambient occlusion knows the opaque surfaces alone. A pane before the corner of a room took the corner's.
#[test]
fn what_lies_behind_a_blended_surface_does_not_hide_the_sky_from_it() {
    // Its front wall faces away from the camera, and is not drawn.
    let room = glb::cuboid([-1.0, -1.0, -2.0], [1.0, 1.0, 0.0], false);
    let mut wall = material(0.5, 0.0, 1.0);
    wall["doubleSided"] = json!(false);
    let mut pane = material(0.5, 0.0, 1.0);
    pane["alphaMode"] = json!("BLEND");
    let pane_mesh =
        glb::Mesh { positions: glb::quad(1.0).positions.iter().map(|p| [p[0], p[1], 0.5]).collect(), ..glb::quad(1.0) };
    let view = |with_pane: bool| {
        let mut parts = vec![(room.clone(), wall.clone())];
        parts.extend(with_pane.then(|| (pane_mesh.clone(), pane.clone())));
        let settings = settings(&[&FLAT[..], &HEAD_ON].concat());
        let mut headless = renderer(load(&glb::scene(&parts)), settings, SIZE);
        occluded(&mut headless)
    };
    let (corner, pane) = (view(false), view(true));
    assert!(corner < 0.95, "{corner} of the light reaches the room");
    assert!(pane > 0.999, "{pane} of the light reaches the pane");
}

/// The least part of ambient light that ambient occlusion leaves at a pixel.
fn occluded(headless: &mut Headless) -> f32 {
    let mut light = |on: bool| {
        headless.settings_mut().assign(&format!("AMBIENT_OCCLUSION={on}")).unwrap();
        row(&render(headless, "final"))
    };
    let (open, hidden) = (light(false), light(true));
    open.iter().zip(&hidden).map(|(open, hidden)| hidden / open).fold(f32::INFINITY, f32::min)
}

/// Values that no material has are marked in the modes that look for wrong values, although the picture hides them.
#[test]
fn the_truth_views_mark_surfaces_that_no_material_has() {
    let bytes = glb::model(&glb::quad(1.0), &material(0.5, 0.0, 0.5));
    let mut session = session(&bytes, &["environment.name=studio"]);
    let of = |session: &mut Session, mode: &str| session.mode(mode).raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
    let is_gray = |value: [f32; 4]| value[0] == value[1] && value[1] == value[2];
    let modes = ["nan", "albedo-range", "f0-range"];
    assert!(modes.into_iter().all(|mode| is_gray(of(&mut session, mode))), "a plain material is marked");
    let mut before = "    return s;\n}\n\n#endif".to_owned();
    for (code, marking) in [
        ("s.base_color *= 2.5;", &modes[..2]),
        ("s.base_color.g = -0.1;", &modes[..2]),
        ("s.metallic = 1.0; s.base_color = vec3(1.5);", &modes[..]),
        ("s.metallic = 1.2;", &modes[..1]),
        ("s.f90 = 2.0;", &modes[..1]),
        ("s.f0 = vec3(1.5);", &["nan", "f0-range"]),
        ("s.ior = 0.5;", &modes[..1]),
        ("s.n *= 2.0;", &modes[..1]),
        ("s.transmission = 2.0;", &modes[..1]),
    ] {
        let after = format!("    {code}\n    return s;\n}}\n\n#endif");
        ready(&session.edit("material/material.glsl", &before, &after));
        before = after;
        for mode in marking {
            let value = of(&mut session, mode);
            assert!(!is_gray(value), "{mode} does not mark `{code}`: {value:?}");
        }
    }
}

/// A shining ball before a dark wall: at their border a plain mean of the samples displays as white, however little of the pixel the
/// ball covers. Files of linear light have the plain mean.
#[test]
fn samples_of_bright_light_do_not_outshine_their_pixel() {
    let shining = |light: f64| {
        let mut black = material(0.0, 0.0, 1.0);
        black["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
        black["extensions"] = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": light } });
        black
    };
    let (bright, dark) = (20.0, 0.05);
    let mut ball = glb::sphere(32, 64);
    ball.positions.iter_mut().flatten().for_each(|x| *x *= 0.4);
    let wall = glb::Mesh {
        positions: glb::quad(2.0).positions.iter().map(|p| [p[0], p[1], -1.0]).collect(),
        ..glb::quad(1.0)
    };
    let bytes = glb::scene(&[(ball, shining(bright)), (wall, shining(dark))]);
    let chosen = ["lights.ambient_strength=0", "view.msaa=4"];
    let settings = settings(&[&FLAT[..], &HEAD_ON, &chosen].concat());
    let mut headless = renderer(load(&bytes), settings, SIZE);
    let capture = render(&mut headless, "final");
    headless.set_linear(true);
    let linear = render(&mut headless, "final");
    // Quarters of a pixel that the ball covers.
    let quarters = |value: f32| 4.0 * (f64::from(value) - dark) / (bright - dark);
    let mut shown = [Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new()];
    for (raw, display) in linear.raw.iter().zip(capture.rgba8.chunks_exact(4)) {
        let covered = quarters(raw[1]);
        assert!((covered - covered.round()).abs() < 0.02, "{raw:?} is no mean of four samples");
        shown[covered.round() as usize].push(f64::from(display[1]));
    }
    let mean = shown.map(|values| values.iter().sum::<f64>() / values.len() as f64);
    assert!(mean.windows(2).all(|pair| pair[1] > pair[0] + 4.0), "each quarter is brighter: {mean:?}");
    assert!(mean[1] < 0.85 * mean[4], "a quarter of a pixel is not white: {mean:?}");
}
