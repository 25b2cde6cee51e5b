//! An edit of the BRDF reaches light from all directions as it reaches lamps: the tables and the prefilter come from the same
//! functions. What an edit bakes, and what becomes of values that no such function may have. `matrix.rs` has the amounts.

use crate::support::process::{finish, specula};
use crate::support::{Session, Tree, assert_validated, failed, glb, is_long, load, ready, settings};
use specula::render::Capture;

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

/// To specialize a module and hash it takes milliseconds, which the window's thread does not have.
#[test]
fn a_picture_as_a_value_hashes_no_module() {
    let mut session = session("studio", &["NDF=GGX"]);
    session.render();
    session.set("NDF=Beckmann");
    let (state, shaders) = (session.headless.frame_state().unwrap(), session.headless.shaders());
    let stage = &shaders.stages["ibl/dfg.comp"];
    let declares = |id: u32| stage.reflection.constants.iter().any(|constant| constant.id == id);
    let constants: Vec<_> = state.pipelines.constants.iter().copied().filter(|(id, _)| declares(*id)).collect();
    assert_eq!(stage.known_hash(&constants), None);
    session.render();
    assert!(stage.known_hash(&constants).is_some(), "the bake has hashed it");
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

/// A function of the BRDF: its file, the start of its body, and a `%` where a bad value is returned instead, from `x`.
struct Function {
    file: &'static str,
    body: &'static str,
    bad: &'static str,
    /// Parts of a bake that do not depend on it: of the cube map, specular and sheen levels, and three tables.
    kept: usize,
}

const FUNCTIONS: [Function; 4] = [
    Function {
        file: "brdf/ndf.glsl",
        body: "    float a2 = alpha * alpha;\n    float spread =",
        bad: "    float x = n_dot_h;\n    return %;\n",
        kept: 4,
    },
    Function {
        file: "brdf/visibility.glsl",
        body: "    return 0.5 / (n_dot_v * smith_root(n_dot_l, a2_l)",
        bad: "    float x = n_dot_v;\n    return %;\n",
        kept: 4,
    },
    Function {
        file: "brdf/fresnel.glsl",
        body: " return f0 + (f90 - f0) * pow5(1.0 - c); }",
        bad: " float x = c; return vec3(%);",
        kept: 5,
    },
    Function {
        file: "brdf/diffuse.glsl",
        body: " return albedo / PI; }",
        bad: " float x = albedo.x; return vec3(%);",
        kept: 5,
    },
];

/// NaN, infinite, negative and huge for any `x` of 0..1 that the compiler does not know.
const BAD: [&str; 4] = ["sqrt(-1.0 - x)", "exp(1000.0 + x)", "-1.0 - x", "1e30 * (1.0 + x)"];

impl Function {
    fn returning(&self, value: &str) -> String {
        self.bad.replace('%', value) + self.body
    }
}

#[test]
fn values_that_are_no_numbers_are_named_and_stay_out_of_the_tables() {
    let mut session = session("studio", &["material.enabled=true", "material.metallic=0.5", "material.roughness=0.5"]);
    session.set("view.frames=2");
    for (number, function) in FUNCTIONS.iter().enumerate() {
        let good = session.tree.read(function.file);
        // Every value for two functions, all of them in a long run.
        let values = (0..BAD.len()).filter(|at| is_long() || (at + number) % BAD.len() < 2).map(|at| BAD[at]);
        for value in values {
            let what = format!("{} returns {value}", function.file);
            assert!(good.contains(function.body), "{what}");
            ready(&session.save(function.file, &good.replacen(function.body, &function.returning(value), 1)));
            // The tables alone: the lobe itself is as wrong as the edit made it.
            let dfg = session.mode("dfg");
            assert!(dfg.raw.iter().flatten().all(|value| value.is_finite()), "{what}: the table is not finite");
            let warnings = session.headless.bake_warnings();
            assert!(warnings.iter().any(|warning| warning.contains(function.file)), "{what}: {warnings:?}");
            let marked = session.mode("monte-carlo").not_finite.iter().filter(|is_bad| **is_bad).count();
            assert!(marked > 500, "{what}: {marked} pixels are marked");
        }
        ready(&session.save(function.file, &good));
        let marked = session.mode("monte-carlo").not_finite.contains(&true);
        assert!(!marked && session.headless.bake_warnings().is_empty(), "{} as it ships", function.file);
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
fn a_command_warns_of_wrong_values_and_keeps_none() {
    for (function, value) in FUNCTIONS.iter().zip(BAD) {
        let tree = Tree::new();
        tree.write(function.file, &tree.edited(function.file, function.body, &function.returning(value)));
        let mut command = specula(&tree.root());
        command.env("SPECULA_CACHE", tree.beside("cache"));
        command.args(["render", "shader-ball", "--shaders", ".", "--size", "32x24", "--out", "out.png"]);
        finish(&mut command).expect(0, &["warning", function.file, "NaN"]);
        // Every part has a file of its own.
        let kept = std::fs::read_dir(tree.beside("cache/baked")).unwrap().count();
        assert_eq!(kept, function.kept, "parts of the bake in the cache, {} returns {value}", function.file);
    }
}

#[test]
fn a_tree_without_a_bake_stage_is_refused() {
    let mut session = session("studio", &[]);
    let broken = session.edit("ibl/lobe.comp", "void main()", "void mian()");
    assert!(!failed(&broken).is_empty());
}
