//! Functions of the BRDF at 24 pixels of four models, computed again by the CPU, and the color of a trace in other modes.

use specula::headless::{Headless, TraceRequest};
use specula::shader::Mode;
use specula::shader::trace::{Act, LineOfTrace, Trace};

use super::formulas::*;
use crate::support::{is_long, line_of, model, renderer, settings};

const SIZE: (u32, u32) = (96, 64);

/// The values of the first times that a statement ran.
fn values(lines: &[LineOfTrace], (file, line): (&str, u32), act: Act, name: &str) -> Vec<Vec<f64>> {
    let here = lines.iter().filter(|of| of.file == file && of.line == line).flat_map(|of| &of.done);
    let done = here.filter(|done| done.act == act && done.name == name);
    done.flat_map(|done| done.first.iter().filter_map(|once| Some(once.value?.numbers().collect()))).collect()
}

/// The values of a place of a formula.
fn values_at(lines: &[LineOfTrace], formula: &Formula, text: &str, Place(part, name): &Place) -> Vec<Vec<f64>> {
    let is_argument = part.is_empty();
    let line = line_of(text, if is_argument { formula.header } else { part });
    let act = match (is_argument, name.is_empty()) {
        (true, _) => Act::Argument,
        (false, true) => Act::Return,
        (false, false) => Act::Store,
    };
    values(lines, (formula.file, line), act, name)
}

/// Compares all calls of a function in a trace with the CPU. Returns how many there were.
fn check(lines: &[LineOfTrace], formula: &Formula, what: &str) -> usize {
    let what = format!("{what}: {}", formula.header);
    let text = std::fs::read_to_string(format!("{}/shaders/{}", env!("CARGO_MANIFEST_DIR"), formula.file)).unwrap();
    let inputs: Vec<Vec<Vec<f64>>> =
        formula.inputs.iter().map(|place| values_at(lines, formula, &text, place)).collect();
    let results = values_at(lines, formula, &text, &formula.output);
    assert!(inputs.iter().all(|of| of.len() == results.len()), "{what}: {inputs:?} {results:?}");
    for (call, result) in results.iter().enumerate() {
        let of_call: Vec<Vec<f64>> = inputs.iter().map(|of| of[call].clone()).collect();
        let expected = (formula.cpu)(&of_call);
        assert_eq!(result.len(), expected.len(), "{what}");
        for (found, expected) in result.iter().zip(expected) {
            let size = expected.abs().max(formula.floor).max(f64::from(f32::MIN_POSITIVE));
            let steps = (found - expected).abs() / size / f64::from(f32::EPSILON);
            assert!(steps <= formula.steps, "{what}{of_call:?} = {found}, not {expected}: {steps} steps");
        }
    }
    results.len()
}

fn traced(headless: &mut Headless, mode: &Mode, at: (u32, u32), files: &[&str]) -> Trace {
    let request = TraceRequest { at, mode, stage: None, invocation: None, files, is_interactive: false };
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

/// Models, pixels of each, and settings with which these formulas are used.
type Case<'a> = (&'a [&'a str], usize, &'a [&'a str], &'a [Formula]);

/// Checks the formulas of a case in the stage that draws the pixels, or in another one. Each is called at every pixel at least once, on average.
fn check_case((models, pixels, set, formulas): Case<'_>, stage: Option<&str>) {
    let mut calls = vec![0; formulas.len()];
    let mut files: Vec<&str> = formulas.iter().map(|formula| formula.file).collect();
    files.dedup();
    for name in models {
        let assigned = [&["environment.name=none", "view.msaa=1"], set].concat();
        let mut headless = renderer(model(name), settings(&assigned), SIZE);
        let mode = headless.shaders().modes.iter().find(|mode| mode.slug == "final").cloned().unwrap();
        let pixels = covered(&mut headless, pixels);
        // A module with several files would take a software device long to compile.
        for (file, at) in files.iter().flat_map(|file| pixels.iter().map(move |at| (*file, *at))) {
            let what = format!("{name} {at:?} {set:?}");
            let request =
                TraceRequest { at, mode: &mode, stage, invocation: None, files: &[file], is_interactive: false };
            let trace = headless.trace(&request).unwrap_or_else(|error| panic!("{what}: {error}"));
            let fragment = trace.visible().unwrap_or_else(|| panic!("{what}: nothing is seen"));
            assert!(trace.is_proven(fragment), "{what}: {}", trace.proof_text(fragment));
            let lines = trace.lines(fragment);
            let of_file = calls.iter_mut().zip(formulas).filter(|(_, formula)| formula.file == file);
            of_file.for_each(|(all, formula)| *all += check(&lines, formula, &what));
        }
    }
    for (calls, formula) in calls.iter().zip(formulas) {
        assert!(*calls >= pixels * models.len(), "{}: {calls} calls", formula.header);
    }
}

const FOUR: [&str; 4] = ["shader-ball", "sphere-grid", "clearcoat", "many-lights"];

#[test]
fn functions_of_the_brdf_are_those_of_the_cpu_at_24_pixels_of_four_models() {
    let formulas = [D_GGX, ROOT_GGX, V_HEIGHT_CORRELATED, F_SCHLICK, F_LAMBERT, F_KULLA_CONTY];
    check_case((&FOUR, 6, &[], &formulas), None);
}

#[test]
fn the_tone_map_is_that_of_the_cpu_at_24_pixels_of_four_models() {
    check_case((&FOUR, 6, &["view.tonemap=aces"], &[TONEMAP]), Some("tonemap.frag"));
    let curves = ["agx", "neutral", "aces-hill", "reinhard", "reinhard-luminance", "uncharted2", "none"];
    for curve in curves.into_iter().take(if is_long() { 7 } else { 2 }) {
        let curve = format!("view.tonemap={curve}");
        check_case((&FOUR[..1], 2, &[&curve], &[TONEMAP]), Some("tonemap.frag"));
    }
}

/// Lobes above the base, and the sum of a surface without a coat.
#[test]
fn layers_of_the_brdf_are_those_of_the_cpu() {
    check_case((&["clearcoat"], 6, &[], &[CLEARCOAT]), None);
    check_case((&["sphere-grid"], 6, &[], &[VALUE]), None);
    check_case((&["sheen"], 6, &[], &[D_CHARLIE, V_CHARLIE]), None);
    // Its module takes a software device as long to compile as all others together.
    if is_long() {
        check_case((&["iridescence"], 6, &[], &[F_FILM]), None);
    }
    check_case((&["anisotropy"], 6, &[], &[D_GGX_ANISOTROPIC]), None);
}

/// The other models that the tree offers: one of each kind, and all with SPECULA_LONG.
#[test]
fn choices_of_the_brdf_are_those_of_the_cpu() {
    let cases: [(&[&str], &[Formula]); 4] = [
        (&["NDF=Beckmann", "MASKING_SHADOWING=Separable", "DIFFUSE=Burley"], &[D_BECKMANN, V_SEPARABLE, F_BURLEY]),
        (
            &["MASKING_SHADOWING=Schlick", "DIFFUSE=OrenNayar", "FRESNEL_METAL=Conductor"],
            &[V_SCHLICK, F_OREN_NAYAR, F_CONDUCTOR],
        ),
        (&["DIFFUSE=RenormalizedBurley", "FRESNEL_METAL=F82"], &[F_RENORMALIZED_BURLEY, F_82]),
        // A software device compiles the module of a pixel with this Fresnel term for half a minute.
        (&["DIFFUSE=CallOfDuty", "FRESNEL_DIELECTRIC=Exact"], &[F_CALL_OF_DUTY, F_DIELECTRIC]),
    ];
    for (set, formulas) in cases.into_iter().take(if is_long() { 4 } else { 1 }) {
        check_case((&["sphere-grid"], 6, set, formulas), None);
    }
}

/// The value of a trace is that of the inspector, bit by bit: in a few modes, and in all of them with SPECULA_LONG.
#[test]
fn a_trace_has_the_value_of_the_inspector_in_every_mode() {
    let few = ["final", "d", "f", "v", "roughness", "shading-normal", "direct-specular"];
    for name in FOUR.into_iter().take(if is_long() { 4 } else { 1 }) {
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
