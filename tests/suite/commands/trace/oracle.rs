//! Functions of the BRDF at 24 pixels of four models, computed again by the CPU, and the color of a trace in other modes.

use specula::headless::{Headless, TraceRequest};
use specula::shader::Mode;
use specula::shader::trace::{Act, LineOfTrace, Trace};

use crate::support::{is_long, line_of, model, renderer, settings};

const FILES: [&str; 3] = ["brdf/ndf.glsl", "brdf/visibility.glsl", "brdf/fresnel.glsl"];
const SIZE: (u32, u32) = (96, 64);

/// A function of the tree with its formula: the file, a part of its header, its parameters, a part of the line that returns, and the CPU's result.
struct Formula {
    file: &'static str,
    header: &'static str,
    parameters: &'static [&'static str],
    returns: &'static str,
    cpu: fn(&[f64]) -> f64,
}

/// Scalar functions, from the papers that the shaders name: Walter et al. 2007, Heitz 2014.
const FORMULAS: [Formula; 3] = [
    Formula {
        file: FILES[0],
        header: "float d_ggx(float n_dot_h",
        parameters: &["n_dot_h", "sin2_h", "alpha"],
        returns: "return a2 / (PI * spread * spread)",
        cpu: |a| {
            let a2 = a[2] * a[2];
            a2 / (std::f64::consts::PI * (a[0] * a[0] * a2 + a[1]).powi(2))
        },
    },
    Formula {
        file: FILES[1],
        header: "float smith_root_ggx(",
        parameters: &["c", "a2"],
        returns: "float smith_root_ggx(",
        cpu: |a| (a[0] * a[0] * (1.0 - a[1]) + a[1]).sqrt(),
    },
    Formula {
        file: FILES[1],
        header: "float v_height_correlated(",
        parameters: &["n_dot_l", "n_dot_v", "a2_l", "a2_v"],
        returns: "return 0.5 / (n_dot_v * smith_root",
        cpu: |a| {
            let root = |c: f64, a2: f64| (c * c * (1.0 - a2) + a2).sqrt();
            0.5 / (a[1] * root(a[0], a[2]) + a[0] * root(a[1], a[3]))
        },
    },
];

/// The values of the first times that a statement ran.
fn values(lines: &[LineOfTrace], (file, line): (&str, u32), act: Act, name: &str) -> Vec<Vec<f64>> {
    let here = lines.iter().filter(|of| of.file == file && of.line == line).flat_map(|of| &of.done);
    let done = here.filter(|done| done.act == act && done.name == name);
    done.flat_map(|done| done.first.iter().filter_map(|once| Some(once.value?.numbers().collect()))).collect()
}

/// Compares all calls of the functions in a trace with the CPU. Returns how many there were of each.
fn check(trace: &Trace, what: &str) -> [usize; 3] {
    let fragment = trace.visible().unwrap_or_else(|| panic!("{what}: nothing is seen"));
    assert!(trace.is_proven(fragment), "{what}: {}", trace.proof_text(fragment));
    let lines = trace.lines(fragment);
    FORMULAS.each_ref().map(|formula| {
        let text = std::fs::read_to_string(format!("{}/shaders/{}", env!("CARGO_MANIFEST_DIR"), formula.file)).unwrap();
        let (header, returns) = (line_of(&text, formula.header), line_of(&text, formula.returns));
        let argument = |name: &&str| values(&lines, (formula.file, header), Act::Argument, name);
        let arguments: Vec<Vec<Vec<f64>>> = formula.parameters.iter().map(argument).collect();
        let results = values(&lines, (formula.file, returns), Act::Return, "");
        assert!(
            arguments.iter().all(|of| of.len() == results.len()),
            "{what}: {}: {arguments:?} {results:?}",
            formula.header
        );
        for (call, result) in results.iter().enumerate() {
            let of_call: Vec<f64> = arguments.iter().map(|of| of[call][0]).collect();
            let expected = (formula.cpu)(&of_call);
            // A few steps of floats for each operation of the formula.
            let error = (result[0] - expected).abs() / expected.abs().max(f64::from(f32::MIN_POSITIVE));
            assert!(
                error <= 16.0 * f64::from(f32::EPSILON),
                "{what}: {}{of_call:?} = {}, not {expected}: {error:e}",
                formula.header,
                result[0]
            );
        }
        results.len()
    })
}

fn traced(headless: &mut Headless, mode: &Mode, at: (u32, u32), files: &[&str]) -> Trace {
    let request = TraceRequest { at, mode, stage: None, invocation: None, files };
    headless.trace(&request).unwrap_or_else(|error| panic!("{at:?}: {error}"))
}

/// Pixels of the model, spread over the picture.
fn covered(headless: &mut Headless, count: usize) -> Vec<(u32, u32)> {
    let mode = headless.shaders().modes.iter().find(|mode| mode.slug == "n-dot-v").cloned().unwrap();
    let mut found = Vec::new();
    for step in 0..400_u32 {
        // The golden ratio spreads them evenly.
        let at = (step * 59 % SIZE.0, step * 37 % SIZE.1);
        let values = headless.pixel(at, std::slice::from_ref(&mode)).unwrap();
        if values.first().is_some_and(|value| value.value[0] > 0.1) && !found.contains(&at) {
            found.push(at);
        }
        if found.len() == count {
            return found;
        }
    }
    panic!("the model covers {} pixels of the {count}", found.len());
}

#[test]
fn functions_of_the_brdf_are_those_of_the_cpu_at_24_pixels_of_four_models() {
    let mut calls = [0; 3];
    for name in ["shader-ball", "sphere-grid", "clearcoat", "many-lights"] {
        let mut headless = renderer(model(name), settings(&["environment.name=none", "view.msaa=1"]), SIZE);
        let mode = headless.shaders().modes.iter().find(|mode| mode.slug == "final").cloned().unwrap();
        for at in covered(&mut headless, 6) {
            let of_pixel = check(&traced(&mut headless, &mode, at, &FILES), &format!("{name} {at:?}"));
            calls.iter_mut().zip(of_pixel).for_each(|(all, of)| *all += of);
        }
    }
    assert!(calls.iter().all(|count| *count >= 24), "{calls:?}");
}

/// The value of a trace is that of the inspector, bit by bit: in a few modes, and in all of them with SPECULA_LONG.
#[test]
fn a_trace_has_the_value_of_the_inspector_in_every_mode() {
    let few = ["final", "d", "f", "v", "roughness", "shading-normal", "direct-specular"];
    for name in
        ["shader-ball", "sphere-grid", "clearcoat", "many-lights"].into_iter().take(if is_long() { 4 } else { 1 })
    {
        let mut headless = renderer(model(name), settings(&["environment.name=none", "view.msaa=1"]), SIZE);
        let at = covered(&mut headless, 1)[0];
        let modes: Vec<Mode> = headless.shaders().modes.clone();
        let wanted = |mode: &&Mode| {
            // Layers are the sum of all fragments, so none of them has the value of the picture.
            let is_traced = !mode.follows_paths() && !mode.slug.starts_with("pass:") && mode.slug != "overdraw";
            is_traced && (is_long() || few.contains(&mode.slug.as_str()))
        };
        for mode in modes.iter().filter(wanted) {
            let shown = headless.pixel(at, std::slice::from_ref(mode)).unwrap()[0].value.map(f32::to_bits);
            let trace = traced(&mut headless, mode, at, &["common/pixel.glsl"]);
            let fragment = trace.visible().unwrap_or_else(|| panic!("{name} {}", mode.slug));
            assert_eq!(
                (trace.picture, trace.is_proven(fragment)),
                (shown, true),
                "{name} {}: {}",
                mode.slug,
                trace.proof_text(fragment)
            );
        }
    }
}
