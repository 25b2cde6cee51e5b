//! An edit of the BRDF reaches light from all directions as it reaches lamps: the tables and the prefilter come from the same
//! functions. Random paths, which call them directly, say by how much the picture must change.

mod support;

use specula::render::Capture;
use support::process::run;
use support::{Session, Tree, assert_validated, failed, glb, load, ready, settings};

/// A function of the BRDF and an edit of it.
struct Edit {
    file: &'static str,
    from: &'static str,
    to: &'static str,
    /// Metallic and roughness of a surface that shows it.
    surface: (f64, f64),
}

const EDITS: [Edit; 5] = [
    Edit {
        file: "brdf/ndf.glsl",
        from: "return a2 / (PI * spread * spread);",
        to: "return 0.5 * a2 / (PI * spread * spread);",
        surface: (1.0, 0.4),
    },
    Edit {
        file: "brdf/visibility.glsl",
        from: "return 0.5 / (n_dot_v * smith_root(n_dot_l, a2_l)",
        to: "return 0.25 / (n_dot_v * smith_root(n_dot_l, a2_l)",
        surface: (1.0, 0.8),
    },
    Edit {
        file: "brdf/fresnel.glsl",
        from: "return f0 + (f90 - f0) * pow5(1.0 - c); }",
        to: "return 0.5 * (f0 + (f90 - f0) * pow5(1.0 - c)); }",
        surface: (1.0, 0.3),
    },
    Edit {
        file: "brdf/fresnel.glsl",
        from: "return f0 + (f90 - f0) * pow5(1.0 - c); }",
        to: "return f0 + (f90 - f0) * (1.0 - c); }",
        surface: (0.0, 0.3),
    },
    Edit {
        file: "brdf/diffuse.glsl",
        from: "return albedo / PI; }",
        to: "return 0.5 * albedo / PI; }",
        surface: (0.0, 0.5),
    },
];

/// A sphere that the environment alone lights.
fn session(environment: &str, more: &[&str]) -> Session {
    let name = format!("environment.name={environment}");
    let fixed = ["lights.source=none", "view.msaa=1", "view.background=none", "view.frames=24", &name];
    let model = load(&glb::model(&glb::sphere(32, 64), &glb::gray()));
    Session::new(model, settings(&[&fixed[..], more].concat()))
}

fn material((metallic, roughness): (f64, f64)) -> [String; 3] {
    let [m, r] = [format!("material.metallic={metallic}"), format!("material.roughness={roughness}")];
    ["material.enabled=true".to_owned(), m, r]
}

/// Mean radiance of the pixels on the model.
fn mean(capture: &Capture) -> f64 {
    let on = capture.raw.iter().filter(|pixel| pixel[3] == 1.0);
    let values: Vec<f64> = on.map(|pixel| pixel[..3].iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn every_edit_reaches_light_from_the_environment() {
    for edit in &EDITS {
        let surface = material(edit.surface);
        let mut session = session("studio", &surface.each_ref().map(String::as_str));
        let before = [mean(&session.mode("final")), mean(&session.mode("monte-carlo"))];
        ready(&session.edit(edit.file, edit.from, edit.to));
        let after = [mean(&session.mode("final")), mean(&session.mode("monte-carlo"))];
        let [picture, paths] = [after[0] - before[0], after[1] - before[1]];
        let what = format!("{} -> {}: the picture changes by {picture:.4}, paths by {paths:.4}", edit.file, edit.to);
        // The split sum itself is off by some percent of the light.
        assert!(paths.abs() > 0.02 * before[1], "{what}: too little to tell");
        assert!((picture - paths).abs() < 0.15 * paths.abs(), "{what}");
    }
    assert_validated();
}

#[test]
fn every_choice_of_models_reaches_the_environment() {
    for (choice, surface) in [
        ("NDF=Beckmann", (1.0, 0.5)),
        ("MASKING_SHADOWING=Separable", (1.0, 0.8)),
        ("MASKING_SHADOWING=Schlick", (1.0, 0.8)),
        ("FRESNEL_METAL=Conductor", (1.0, 0.4)),
        ("FRESNEL_METAL=F82", (1.0, 0.4)),
        ("FRESNEL_DIELECTRIC=Exact", (0.0, 0.3)),
        ("DIFFUSE=Burley", (0.0, 1.0)),
        ("DIFFUSE=RenormalizedBurley", (0.0, 1.0)),
        ("DIFFUSE=OrenNayar", (0.0, 1.0)),
        ("DIFFUSE=CallOfDuty", (0.0, 1.0)),
    ] {
        let surface = material(surface);
        let mut session = session("studio", &[&surface.each_ref().map(String::as_str)[..], &[choice]].concat());
        let [picture, paths] = [mean(&session.mode("final")), mean(&session.mode("monte-carlo"))];
        assert!((picture / paths - 1.0).abs() < 0.04, "{choice}: picture {picture:.4}, paths {paths:.4}");
    }
    assert_validated();
}

#[test]
fn the_selected_ndf_shapes_reflections() {
    let surface = material((1.0, 0.5));
    let mut session = session("studio", &surface.each_ref().map(String::as_str));
    let ggx = session.mode("prefiltered");
    session.set("NDF=Beckmann");
    let beckmann = session.mode("prefiltered");
    let difference = |(a, b): (&[f32; 4], &[f32; 4])| f64::from((a[0] - b[0]).abs());
    let sum: f64 = ggx.raw.iter().zip(&beckmann.raw).map(difference).sum();
    assert!(sum / ggx.raw.len() as f64 > 0.01, "the prefiltered radiance does not depend on the NDF");
    assert_validated();
}

#[test]
fn an_edit_bakes_only_what_depends_on_it() {
    let mut session = session("studio", &["NDF=GGX"]);
    session.render();
    let first = session.headless.bake_report().clone();
    for (file, from, to) in [
        // A comment.
        ("brdf/ndf.glsl", "// GGX, a rediscovery", "// This is GGX, a rediscovery"),
        // Lamps alone.
        ("lighting/punctual.glsl", "return ramp * ramp;", "return ramp;"),
        // The diffuse lobe has a table, but no reflections.
        ("brdf/diffuse.glsl", "return albedo / PI; }", "return 0.5 * albedo / PI; }"),
    ] {
        session.edit(file, from, to);
        session.render();
        assert_eq!(session.headless.bake_report().total_ms, first.total_ms, "{file} baked the environment again");
    }
    ready(&session.edit(
        "brdf/ndf.glsl",
        "return a2 / (PI * spread * spread);",
        "return a2 / (3.0 * spread * spread);",
    ));
    session.render();
    let again = session.headless.bake_report();
    // Computed, or from the disk cache if the same edit was baked before.
    assert_ne!(again.total_ms, first.total_ms, "an edit of D does not bake the reflections");
    assert_eq!((again.cube_ms, again.irradiance_ms, again.sheen_ms), (0.0, 0.0, 0.0), "an edit of D bakes more");
    assert_validated();
}

#[test]
fn values_that_are_no_numbers_are_named_and_stay_out_of_the_tables() {
    for (file, from, to) in [
        ("brdf/ndf.glsl", "return a2 / (PI * spread * spread);", "return sqrt(-1.0 - n_dot_h);"),
        ("brdf/ndf.glsl", "return a2 / (PI * spread * spread);", "return -1.0;"),
        ("brdf/visibility.glsl", "return 0.5 / (n_dot_v", "return 1.0 / max(n_dot_v - 2.0, 0.0) + 0.0 / (n_dot_v"),
        ("brdf/fresnel.glsl", "return f0 + (f90 - f0) * pow5(1.0 - c); }", "return f0 / 0.0 + log(vec3(c - 2.0)); }"),
        ("brdf/diffuse.glsl", "return albedo / PI; }", "return albedo * 1e30; }"),
    ] {
        let mut session = session("studio", &[]);
        ready(&session.edit(file, from, to));
        // The tables alone: the lobe itself is as wrong as the edit made it.
        let dfg = session.mode("dfg");
        assert!(dfg.raw.iter().flatten().all(|value| value.is_finite()), "{file}: the table is not finite");
        let warnings = session.headless.bake_warnings();
        assert!(warnings.iter().any(|warning| warning.contains(file)), "{file} -> {to}: {warnings:?}");
    }
    assert_validated();
}

/// Flat ambient light is a furnace: the same albedo of every lobe, without occlusion.
#[test]
fn ambient_light_is_that_of_a_furnace() {
    for surface in [(0.0, 0.3), (1.0, 1.0)] {
        let surface = material(surface);
        let more: Vec<&str> = surface.iter().map(String::as_str).collect();
        let furnace = mean(&session("furnace", &more).render());
        let flat = ["lights.ambient_strength=1", "lights.ambient_color=[1, 1, 1]"];
        let ambient = mean(&session("none", &[&more[..], &flat].concat()).render());
        assert!((ambient / furnace - 1.0).abs() < 0.005, "ambient {ambient}, furnace {furnace}");
    }
    assert_validated();
}

#[test]
fn a_command_warns_of_wrong_values() {
    let tree = Tree::new();
    let edited = tree.edited("brdf/ndf.glsl", "return a2 / (PI * spread * spread);", "return sqrt(-1.0 - n_dot_h);");
    tree.write("brdf/ndf.glsl", &edited);
    let more = ["--size", "32x24", "--out", "out.png"];
    let finished = run(&tree.root(), &[&["render", "shader-ball", "--shaders", "."], &more[..]].concat());
    finished.expect(0, &["warning", "D in brdf/ndf.glsl", "NaN"]);
}

#[test]
fn a_tree_without_a_bake_stage_is_refused() {
    let mut session = session("studio", &[]);
    let broken = session.edit("ibl/lobe.comp", "void main()", "void mian()");
    assert!(!failed(&broken).is_empty());
}
