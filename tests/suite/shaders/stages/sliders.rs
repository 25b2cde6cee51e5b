//! A slider in a function of `brdf/`: at its default the picture is the shipped one bit by bit, and at any other value it is the picture
//! of an edit that writes the number, under lamps, environment and random paths.

use std::collections::BTreeMap;

use specula::render::Capture;

use crate::support::{Session, assert_same, differing, is_long, model, ready, settings};

/// A function of the BRDF: the file in `brdf/`, a part of its text, and the replacement, in which `GAIN` is a number.
const FUNCTIONS: &str = "\
ndf | return a2 / (PI | return GAIN * a2 / (PI
ndf | return exp(-dot(slope | return GAIN * exp(-dot(slope
ndf | return 1.0 / (PI * alpha.x | return GAIN / (PI * alpha.x
visibility | return 0.5 / (n_dot_v | return GAIN * 0.5 / (n_dot_v
visibility | return 1.0 / ((n_dot_l | return GAIN / ((n_dot_l
visibility | return 0.25 / ((n_dot_l | return GAIN * 0.25 / ((n_dot_l
fresnel | return f0 + (f90 - f0) * pow5(1.0 - c); | return GAIN * (f0 + (f90 - f0) * pow5(1.0 - c));
fresnel | return saturate(0.5 * f_s | return GAIN * saturate(0.5 * f_s
fresnel | return saturate(f_schlick(f0 | return GAIN * saturate(f_schlick(f0
fresnel | return 0.5 * root_s | return GAIN * 0.5 * root_s
diffuse | return albedo / PI; } | return GAIN * albedo / PI; }
diffuse | return (1.0 + rise * pow5 | return GAIN * (1.0 + rise * pow5
diffuse | return scale * (1.0 + rise | return GAIN * scale * (1.0 + rise
diffuse | return (single + multi) / PI; | return GAIN * (single + multi) / PI;
diffuse | return (lobe + bump) / PI; | return GAIN * (lobe + bump) / PI;
layers/sheen | return (2.0 + 1.0 / alpha) * pow | return GAIN * (2.0 + 1.0 / alpha) * pow
layers/sheen | return 1.0 / (4.0 * shadowed | return GAIN / (4.0 * shadowed
layers/sheen | return zeltner_albedo(n_dot_v, r) * density | return GAIN * zeltner_albedo(n_dot_v, r) * density
layers/iridescence | return saturate(fresnel); | return GAIN * saturate(fresnel);
layers/transmission | return s.base_color * ((1.0 | return GAIN * s.base_color * ((1.0";

/// Built-in models, each with the choices that are tried on it. Together they run every function of the list.
const MODELS: [(&str, &[&[&str]]); 6] = [
    (
        "ior",
        &[
            &[],
            &["NDF=Beckmann", "MASKING_SHADOWING=Separable", "FRESNEL_DIELECTRIC=Exact", "DIFFUSE=Burley"],
            &["MASKING_SHADOWING=Schlick", "DIFFUSE=RenormalizedBurley"],
            &["DIFFUSE=OrenNayar"],
            &["DIFFUSE=CallOfDuty"],
        ],
    ),
    ("metal-grid", &[&["FRESNEL_METAL=Conductor"], &["FRESNEL_METAL=F82"]]),
    ("anisotropy", &[&[]]),
    ("sheen", &[&[], &["SHEEN=ZeltnerLTC"]]),
    ("iridescence", &[&[]]),
    ("transmission", &[&[]]),
];

/// Lamps and an environment, few pixels, few paths.
const PLAIN: [&str; 4] = ["environment.name=studio", "view.msaa=1", "view.frames=1", "view.bounces=1"];

const MODES: [&str; 2] = ["final", "path-traced"];

/// The files of the functions, with this text in place of `GAIN`, or in its `*` the number of the function.
fn edited(session: &Session, gain: &str) -> BTreeMap<String, String> {
    let mut texts = BTreeMap::new();
    for (at, line) in FUNCTIONS.lines().enumerate() {
        let [file, from, to] = line.split(" | ").collect::<Vec<_>>()[..] else { panic!("three cells, not `{line}`") };
        let file = format!("brdf/{file}.glsl");
        let text = texts.remove(&file).unwrap_or_else(|| session.tree.read(&file));
        assert!(text.contains(from), "{file} has no `{from}`");
        texts.insert(file, text.replace(from, &to.replace("GAIN", &gain.replace('*', &at.to_string()))));
    }
    texts
}

fn save(session: &mut Session, texts: &BTreeMap<String, String>) {
    texts.iter().for_each(|(file, text)| session.tree.write(file, text));
    ready(&session.changed(&texts.keys().map(String::as_str).collect::<Vec<_>>()));
}

/// The pictures of each of these combinations of choices. Random paths are those of glTF's core material, with the first two combinations
/// of it: they call the functions as the picture does. In a long run they have all combinations.
fn of_choices(session: &mut Session, choices: &[&[&str]], name: &str) -> Vec<Vec<Capture>> {
    let mut pictures = Vec::new();
    for (number, choices) in choices.iter().enumerate() {
        let modes = if name == "ior" && (number < 2 || is_long()) { &MODES[..] } else { &MODES[..1] };
        let before = session.headless.settings_mut().shader.clone();
        choices.iter().for_each(|choice| session.set(choice));
        pictures.push(modes.iter().map(|mode| session.mode(mode)).collect());
        session.headless.settings_mut().shader = before;
    }
    pictures
}

/// The pictures of every model. Light that no model changes is baked once for all.
fn of_models(session: &mut Session) -> Vec<Vec<Vec<Capture>>> {
    let of_model = |(name, choices): &(&str, &[&[&str]])| {
        session.headless.set_model(model(name)).unwrap();
        of_choices(session, choices, name)
    };
    MODELS.iter().map(of_model).collect()
}

#[test]
fn a_slider_in_any_function_of_the_brdf_reaches_all_light() {
    let mut session = Session::new(model(MODELS[0].0), settings(&PLAIN));
    let shipped = of_models(&mut session);
    let with_numbers = edited(&session, "0.5");
    let mut with_sliders = edited(&session, "gain_*");
    for text in with_sliders.values_mut() {
        // Behind the guard.
        let at = text.find("#define").map(|at| at + text[at..].find('\n').unwrap() + 1).unwrap();
        text.insert_str(at, "#include \"user/params.glsl\"\n");
    }
    let count = FUNCTIONS.lines().count();
    let declared: String = (0..count).map(|at| format!("    float gain_{at}; //@ui 0..2 = 1.0\n")).collect();
    let first = "    float roughness_scale;";
    let params = session.tree.edited("user/params.glsl", first, &format!("{declared}{first}"));
    with_sliders.insert("user/params.glsl".into(), params);
    save(&mut session, &with_sliders);
    let at_default = of_models(&mut session);
    (0..count).for_each(|at| session.set(&format!("gain_{at}=0.5")));
    let at_half = of_models(&mut session);
    session.headless.settings_mut().shader.clear();
    save(&mut session, &with_numbers);
    let halved = of_models(&mut session);
    for (model, (name, choices)) in MODELS.iter().enumerate() {
        for (a, b) in shipped[model].iter().flatten().zip(at_default[model].iter().flatten()) {
            // A driver may add up the terms of F82 in another order when one of them has a factor of 1.
            assert_eq!(differing(a, b), 0, "{name}: sliders at their defaults");
            assert!(distance(a, b) < 1e-6, "{name}: sliders at their defaults");
        }
        for (at, choices) in choices.iter().enumerate() {
            for (i, mode) in MODES.iter().enumerate().take(halved[model][at].len()) {
                let error = distance(&at_half[model][at][i], &halved[model][at][i]);
                assert!(error < 1e-3, "{name}, {choices:?}, {mode}: {error} between sliders and numbers");
                let change = distance(&shipped[model][at][i], &halved[model][at][i]);
                assert!(change > 0.1, "{name}, {choices:?}, {mode}: half of all changes the picture by {change}");
            }
        }
    }
}

/// The mean difference of two pictures on the model, as a part of the mean of the first.
fn distance(a: &Capture, b: &Capture) -> f64 {
    let covered = || a.raw.iter().zip(&b.raw).filter(|(a, _)| a[3] == 1.0);
    let sum: f64 = covered().flat_map(|(a, _)| &a[..3]).map(|x| f64::from(*x)).sum();
    let difference = covered().map(|(a, b)| (0..3).map(|c| f64::from((a[c] - b[c]).abs())).sum::<f64>());
    difference.sum::<f64>() / sum
}

/// A slider and a constant that only a bake reads: the light is baked again for their values.
#[test]
fn a_slider_and_a_constant_of_a_bake_bake_again() {
    let mut session = Session::new(model("ior"), settings(&PLAIN));
    let shipped = session.mode("final");
    let declared = session.tree.edited(
        "user/params.glsl",
        "    float roughness_scale;",
        "    float sky_gain; //@ui 0..2 = 1.0\n    float roughness_scale;",
    );
    session.tree.write("user/params.glsl", &declared);
    let read = "return textureLod(source, uv, 0.0).rgb;";
    let text = session.tree.edited("ibl/cube.comp", read, "return sky_gain * SKY * textureLod(source, uv, 0.0).rgb;");
    let head = "#include \"interface.glsl\"\n";
    let constant = "layout(constant_id = USER_CONSTANTS + 40) const float SKY = 1.0; //@ui \"Sky\" 0..2\n";
    session
        .tree
        .write("ibl/cube.comp", &text.replace(head, &format!("{head}#include \"user/params.glsl\"\n{constant}")));
    ready(&session.changed(&["user/params.glsl", "ibl/cube.comp"]));
    assert_same(&shipped, &session.mode("final"), "at the default");
    session.set("sky_gain=0.25");
    let dark = session.mode("final");
    assert!(distance(&shipped, &dark) > 0.2, "a quarter of the sky");
    session.set("sky_gain=1");
    assert_same(&shipped, &session.mode("final"), "the sky again");
    session.set("SKY=0.25");
    assert_same(&dark, &session.mode("final"), "the constant does what the slider does");
}
