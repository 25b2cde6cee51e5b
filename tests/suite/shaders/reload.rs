//! A reload is a transaction: a good edit changes the picture, and a bad edit reports why and changes no pixel.

use std::collections::BTreeSet;
use std::fs;

use crate::support::{
    Session, assert_differ, assert_same, assert_validated, failed, glb, line_of, lines, load, model, ready, settings,
    stages,
};
use specula::headless::HeadlessError;
use specula::pipeline::Outcome;
use specula::settings::ShaderValue;
use specula::shader::{Change, Severity};

/// A lit sphere with a single kind of material, so that a reload builds one pipeline.
fn sphere() -> Session {
    Session::new(load(&glb::model(&glb::sphere(16, 32), &glb::gray())), settings(&["environment.name=none"]))
}

const NDF: &str = "brdf/ndf.glsl";
const USER: &str = "user.glsl";
const PARAMS: &str = "user/params.glsl";
/// Stages that sample the environment.
const SKY: &[&str] = &["debug.frag", "paths.frag", "pbr.frag", "sky.frag"];
/// Stages that evaluate D: the picture, random paths, and the tables and reflections of light from all directions.
const SPECULAR: &[&str] =
    &["debug.frag", "ibl/dfg.comp", "ibl/lobe.comp", "ibl/prefilter.comp", "paths.frag", "pbr.frag", "sky.frag"];
/// Stages that round to half floats.
const ROUNDING: &[&str] = &[
    "ibl/cube.comp",
    "ibl/dfg.comp",
    "ibl/diffuse_albedo.comp",
    "ibl/downsample.comp",
    "ibl/prefilter_sheen.comp",
    "ibl/sheen_albedo.comp",
];
const VERTEX_HOOK: &str = "void user_vertex(inout Vertex vertex) {";
const SQUARED: &str = "float a2 = alpha * alpha;";

#[test]
fn a_b_a_by_pixels() {
    let mut session = Session::new(model("shader-ball"), settings(&["environment.name=none"]));
    let original = session.tree.read(NDF);
    let a = session.render();
    ready(&session.edit(NDF, SQUARED, "float a2 = alpha;"));
    let b = session.render();
    assert_differ(&a, &b, "another NDF");
    ready(&session.save(NDF, &original));
    assert_same(&a, &session.render(), "back at A");
}

#[test]
fn a_broken_edit_changes_no_pixel_and_says_where() {
    let mut session = sphere();
    let before = session.render();
    let reload = session.edit(NDF, SQUARED, "float a2 = alpha * alfa;");
    let text = session.tree.read(NDF);
    let error = &failed(&reload)[0];
    let line = line_of(&text, "alfa");
    let source = text.lines().nth(line as usize - 1).unwrap();
    assert_eq!(error.file, session.tree.path(NDF).display().to_string(), "{error}");
    assert_eq!((error.line, error.severity), (Some(line), Severity::Error), "{error}");
    assert_eq!(error.column, Some(source.find("alfa").unwrap() as u32 + 1), "{error}");
    assert_eq!((error.length, error.excerpt.as_deref()), (4, Some(source)), "{error}");
    assert!(error.message.contains("alfa") && error.render().contains("^^^^"), "{}", error.render());
    assert_same(&before, &session.render(), "after a broken edit");

    // Undoing the edit restores the text on screen, so nothing is compiled and the message goes.
    let reload = session.edit(NDF, "alpha * alfa", "alpha * alpha");
    assert!(matches!(reload.outcome, Outcome::Unchanged { cleared: true }), "{:?}", stages(&reload));
    assert!(stages(&reload).is_empty(), "{:?}", stages(&reload));
    assert_same(&before, &session.render(), "after the edit was taken back");
}

#[test]
fn an_edit_compiles_only_the_stages_that_use_it() {
    let mut session = sphere();
    for (file, from, to, expected) in [
        (NDF, SQUARED, "float a2 = alpha;", SPECULAR),
        ("common/tonemap.glsl", "x / (1.0 + x)", "x / (1.5 + x)", &["tonemap.frag"][..]),
        (
            "common/fragment.glsl",
            "vec2 uv1;",
            "vec2 uv1;\n    vec2 uv2;",
            &["debug.frag", "paths.frag", "pbr.frag", "pbr.vert"],
        ),
        ("common/color.glsl", "0.0031308", "0.0031309", &["debug.frag", "paths.frag", "pbr.frag", "tonemap.frag"]),
        ("lighting/environment_map.glsl", "textureLod(environment_cube, ", "textureLod(environment_cube, -", SKY),
        // An annotation is no code.
        ("brdf/models.glsl", "\"Normal distribution\"", "\"Distribution\"", &[]),
        ("ibl/maps/half.glsl", "65504.0", "65503.0", ROUNDING),
        (
            "user/vertex.glsl",
            VERTEX_HOOK,
            "void user_vertex(inout Vertex vertex) { vertex.position.x += 0.1;",
            &["pbr.vert"],
        ),
        ("user/display.glsl", "return light;", "return light * 0.5;", &["tonemap.frag"]),
        ("fullscreen.vert", "void main() {", "void main() {\n    float unused = 1.0;", &["fullscreen.vert"]),
    ] {
        let reload = session.edit(file, from, to);
        ready(&reload);
        // Declared passes use libraries too; `passes/declared.rs` looks at them.
        let compiled: Vec<&str> = stages(&reload).into_iter().filter(|stage| !stage.starts_with("passes/")).collect();
        assert_eq!(compiled, expected, "after {file}");
        session.render();
    }
}

/// The picture does not wait for debug modes and random paths.
#[test]
fn what_is_on_screen_compiles_first() {
    let mut session = sphere();
    let before = session.render();
    session.tree.write(NDF, &session.tree.edited(NDF, SQUARED, "float a2 = alpha;"));
    let reload = session.headless.update_first(Change::Paths(BTreeSet::from([NDF.into()])));
    ready(&reload);
    assert_eq!(stages(&reload), ["ibl/dfg.comp", "ibl/lobe.comp", "ibl/prefilter.comp", "pbr.frag"]);
    let after = session.render();
    assert_differ(&before, &after, "another NDF, of which the modes are not compiled yet");
    let rest = session.headless.finish().expect("stages are left");
    ready(&rest);
    let compiled: Vec<&str> = stages(&rest).into_iter().filter(|stage| !stage.starts_with("passes/")).collect();
    assert_eq!((compiled, rest.pipelines), (vec!["debug.frag", "paths.frag", "sky.frag"], 0));
    assert_same(&after, &session.render(), "after the rest was compiled");
    assert!(session.headless.finish().is_none());

    // In a mode, the mode comes first.
    session.mode("d");
    session.tree.write(NDF, &session.tree.edited(NDF, "float a2 = alpha;", SQUARED));
    session.headless.settings_mut().mode = "d".into();
    let reload = session.headless.update_first(Change::Paths(BTreeSet::from([NDF.into()])));
    assert_eq!(stages(&reload), ["debug.frag", "ibl/dfg.comp", "ibl/lobe.comp", "ibl/prefilter.comp"]);
    // A mode that needs what is left finishes first.
    assert_same(&before, &session.mode("final"), "the first NDF again");
}

/// An error that only debug modes have is told, but does not hold the picture back.
#[test]
fn a_broken_mode_costs_the_modes_alone() {
    const MODES: &str = "debug/modes.glsl";
    let mut session = sphere();
    let before = session.render();
    session.tree.write(NDF, &session.tree.edited(NDF, SQUARED, "float a2 = alpha;"));
    session.tree.write(MODES, &session.tree.edited(MODES, "    return false;", "    return nothing;"));
    let reload = session.headless.update_first(Change::Paths([NDF, MODES].map(Into::into).into()));
    ready(&reload);
    let after = session.render();
    assert_differ(&before, &after, "the new picture");
    let rest = session.headless.finish().expect("stages are left");
    assert!(failed(&rest)[0].file.ends_with(MODES), "{:?}", failed(&rest));
    assert_same(&after, &session.render(), "the picture stays");
    session.headless.settings_mut().mode = "d".into();
    let Err(HeadlessError::Shaders(errors)) = session.headless.render() else { panic!("the mode has no shader") };
    assert!(errors[0].file.ends_with(MODES), "{errors:?}");
    session.headless.settings_mut().mode = "final".into();

    // The picture goes on to follow edits, and the modes return with the repair.
    session.tree.write(NDF, &session.tree.edited(NDF, "float a2 = alpha;", SQUARED));
    ready(&session.headless.update_first(Change::Paths([NDF].map(Into::into).into())));
    assert_same(&before, &session.render(), "the first NDF again");
    assert!(matches!(session.headless.finish().expect("modes are still broken").outcome, Outcome::Failed(_)));
    ready(&session.edit(MODES, "    return nothing;", "    return false;"));
    assert!(session.mode("d").raw.iter().any(|value| value[0] > 0.0));
}

/// The driver compiles only what does something else with the constants of a pipeline.
#[test]
fn an_edit_of_what_is_not_selected_builds_no_pipeline() {
    let mut session = Session::new(model("clearcoat"), settings(&["environment.name=none"]));
    let before = session.render();
    let all = session.headless.update(Change::All).pipelines;
    assert_eq!(all, 0, "nothing has changed");
    let beckmann = session.edit(NDF, "vec2 slope = h_ts.xy / alpha;", "vec2 slope = h_ts.xy / (alpha * 7.0);");
    ready(&beckmann);
    assert_eq!(beckmann.pipelines, 0, "the NDF is GGX");
    assert_same(&before, &session.render(), "after an edit of Beckmann's D");
    let coat = session.edit("brdf/evaluate.glsl", "float weight = s.clearcoat *", "float weight = 0.5 * s.clearcoat *");
    ready(&coat);
    assert_differ(&before, &session.render(), "half a coat");
    let everything = session.edit(NDF, SQUARED, "float a2 = alpha;");
    ready(&everything);
    assert!(0 < coat.pipelines && coat.pipelines < everything.pipelines, "{} {}", coat.pipelines, everything.pipelines);
}

#[test]
fn a_save_that_changes_nothing_compiles_nothing() {
    let mut session = sphere();
    let text = session.tree.read(NDF);
    let reload = session.save(NDF, &text);
    assert!(matches!(reload.outcome, Outcome::Unchanged { cleared: false }));
    assert!(stages(&reload).is_empty(), "{:?}", stages(&reload));
    let reload = session.headless.update(Change::All);
    assert!(stages(&reload).is_empty(), "{:?}", stages(&reload));
    // A file that no stage includes.
    let reload = session.save("notes.glsl", "not even GLSL\n");
    assert!(matches!(reload.outcome, Outcome::Unchanged { cleared: false }), "{:?}", stages(&reload));
}

#[test]
fn includes_may_come_late_move_and_go() {
    let mut session = sphere();
    let before = session.render();
    let original = session.tree.read(USER);
    let with_include = |file: &str| {
        let include = format!("#include \"common/color.glsl\"\n#include \"{file}\"");
        let text = original.replace("#include \"common/color.glsl\"", &include);
        text.replace("    return radiance;", "    return radiance * mine();")
    };

    // An include of a missing file: the message names both paths that were searched.
    let reload = session.save(USER, &with_include("lib/mine.glsl"));
    let found = lines(failed(&reload));
    let line = line_of(&session.tree.read(USER), "lib/mine.glsl");
    let place = format!("{}:{line}", session.tree.path(USER).display());
    assert!(found[0].starts_with(&place) && found[0].contains("lib/mine.glsl"), "{found:#?}");
    assert_same(&before, &session.render(), "with an include missing");

    // The file is created later, in a new folder.
    fs::create_dir(session.tree.path("lib")).unwrap();
    ready(&session.save("lib/mine.glsl", "vec3 mine() { return vec3(0.2, 1.0, 0.2); }\n"));
    let green = session.render();
    assert_differ(&before, &green, "the include is there");

    // The file and its include are renamed.
    fs::rename(session.tree.path("lib/mine.glsl"), session.tree.path("lib/yours.glsl")).unwrap();
    let reload = session.changed(&["lib/mine.glsl", "lib/yours.glsl"]);
    assert!(lines(failed(&reload))[0].contains("lib/mine.glsl"), "{:#?}", lines(failed(&reload)));
    assert_same(&green, &session.render(), "while the include is gone");
    let reload = session.save(USER, &with_include("lib/yours.glsl"));
    assert!(!matches!(reload.outcome, Outcome::Failed(_)), "{:#?}", lines(failed(&reload)));
    assert_same(&green, &session.render(), "under its new name");

    // The file is deleted, and then its include.
    fs::remove_file(session.tree.path("lib/yours.glsl")).unwrap();
    assert!(lines(failed(&session.changed(&["lib/yours.glsl"])))[0].contains("lib/yours.glsl"));
    assert_same(&green, &session.render(), "after the include was deleted");
    ready(&session.save(USER, &original));
    assert_same(&before, &session.render(), "without the include");
}

/// Drivers have failed at such code, so the specialized module must be valid.
#[test]
fn loops_and_choices_of_any_kind_draw() {
    let mut session = Session::new(model("shader-ball"), settings(&["view.msaa=1", "FRESNEL_DIELECTRIC=Exact"]));
    session.render();
    let loops = "    do { if (radiance.x > 1e9) break; radiance *= 1.0; } while (false);
    while (ALPHA_MODE == 77u) radiance *= 0.5;
    for (uint i = 0u; i < 3u; ++i) { if (MODE == 12345u) break; radiance += 0.0; }
    if (material.alpha_cutoff > 2.0 && frame.near < 0.0) return vec3(0.0);
    switch (ALPHA_MODE) { case ALPHA_OPAQUE: radiance += 0.0; default: radiance *= 1.0; }
    switch (ALPHA_MODE) { case 7u: radiance += 1.0; case ALPHA_OPAQUE: radiance *= 1.0; break; default: radiance += 2.0; }
    return radiance;";
    let plain = session.render();
    ready(&session.edit("user.glsl", "    return radiance;", loops));
    assert_same(&plain, &session.render(), "loops that do nothing");
    assert_validated();
}

#[test]
fn an_include_cycle_is_named() {
    let mut session = sphere();
    let before = session.render();
    session.tree.write("ring.glsl", "#include \"user.glsl\"\n");
    let reload = session.edit(USER, "#include \"common/color.glsl\"", "#include \"ring.glsl\"");
    let found = lines(failed(&reload)).join("\n");
    for part in ["cycle", "user.glsl -> ring.glsl -> user.glsl"] {
        assert!(found.contains(part), "no `{part}` in:\n{found}");
    }
    assert_same(&before, &session.render(), "with a cycle");
}

#[test]
fn a_shader_that_contradicts_the_contract_is_refused_with_both_sides_named() {
    let mut session = sphere();
    let before = session.render();
    let original = session.tree.read(USER);
    let declared = |declaration: &str, value: &str| {
        let text = original.replace("// The surface before", &format!("{declaration}\n\n// The surface before"));
        text.replace("    return radiance;", &format!("    return radiance + {value};"))
    };
    let wrong_kind = declared(
        "layout(set = SET_MATERIAL, binding = BINDING_NORMAL_TEXTURE) uniform samplerCube wrong;",
        "texture(wrong, v).rgb",
    );
    let unknown =
        declared("layout(set = SET_MATERIAL, binding = 31) uniform sampler2D wrong;", "texture(wrong, v.xy).rgb");
    let taken_id = declared("layout(constant_id = 15) const float wrong = 1.0;", "vec3(wrong)");
    for (text, parts) in [
        (wrong_kind, ["samplerCube `wrong`", "Specula says BINDING_NORMAL_TEXTURE is sampler2D"]),
        (unknown, ["set 1, binding 31 is sampler2D `wrong`", "Specula has nothing there"]),
        (taken_id, ["constant_id 15 is `wrong`", "Specula keeps the ids below 32"]),
    ] {
        let reload = session.save(USER, &text);
        let error = &failed(&reload)[0];
        for part in parts {
            assert!(error.message.contains(part), "no `{part}` in {error}");
        }
        assert_eq!(error.file, session.tree.path(USER).display().to_string(), "{error}");
        assert_eq!(error.line, Some(line_of(&text, " wrong")), "{error}");
        assert_same(&before, &session.render(), "refused");
    }
}

#[test]
fn interface_glsl_is_held_against_this_program() {
    let mut session = sphere();
    let before = session.render();
    let original = session.tree.read("interface.glsl");
    let file = session.tree.path("interface.glsl").display().to_string();

    // A tree of another version: the message names the version and says what to do.
    let version = format!("INTERFACE_VERSION = {}u", specula::interface::VERSION);
    let reload = session.edit("interface.glsl", &version, "INTERFACE_VERSION = 77u");
    let error = failed(&reload).iter().find(|d| d.file == file && d.message.contains("77")).expect("a diagnostic");
    assert_eq!(error.line, Some(line_of(&original, "INTERFACE_VERSION")), "{error}");
    assert!(error.help.as_ref().is_some_and(|help| help.contains("specula new")), "{error:?}");

    // A moved member, and push constants that do not fit.
    for (from, to, parts) in [
        ("    vec3 eye_ws;", "    float nearer; vec3 eye_ws;", ["Frame.nearer", "Specula has `eye_ws`"]),
        ("    uint node_id;", "    uint node_id; mat4 more[2];", ["push constants `Draw`", "at most 128"]),
    ] {
        session.tree.write("interface.glsl", &original);
        let reload = session.edit("interface.glsl", from, to);
        let found = lines(failed(&reload)).join("\n");
        assert!(parts.iter().all(|part| found.contains(part)), "no {parts:?} in:\n{found}");
        assert_same(&before, &session.render(), "refused");
    }

    // A changed file of the same version is used, with a warning.
    session.tree.write("interface.glsl", &original);
    let reload = session.edit("interface.glsl", "// Printed by", "// Once printed by");
    assert!(!matches!(reload.outcome, Outcome::Failed(_)), "{:#?}", lines(failed(&reload)));
    let warnings = lines(&session.headless.shaders().warnings);
    assert!(warnings.iter().any(|line| line.starts_with(&file) && line.contains("differs")), "{warnings:#?}");
}

/// After an open conditional, glslang skips files and reports errors in them. The user sees only the cause.
#[test]
fn an_unbalanced_conditional_is_one_error_at_its_line() {
    let mut session = sphere();
    let before = session.render();
    let original = session.tree.read(NDF);
    let (body, end) = original.rsplit_once("#endif").unwrap();
    let inside = |text: &str| original.replacen("float d_ggx", &format!("{text}\nfloat d_ggx"), 1);
    let cases = [
        (format!("{body}{end}"), "#ifndef BRDF_NDF_GLSL", "has no `#endif`"),
        (inside("#ifdef NEVER"), "#ifdef NEVER", "has no `#endif`"),
        (inside("#if 1 == 2"), "#if 1 == 2", "has no `#endif`"),
        (inside("#endif // extra"), "#endif // extra", "has no `#if`"),
        (format!("{original}#else // extra\n"), "#else // extra", "has no `#if`"),
    ];
    for (text, at, message) in cases {
        assert_ne!(text, original, "{at}");
        let reload = session.save(NDF, &text);
        let errors = failed(&reload);
        assert_eq!(errors.len(), 1, "{at}: {:#?}", lines(errors));
        assert_eq!(errors[0].file, session.tree.path(NDF).display().to_string(), "{}", errors[0]);
        assert_eq!(errors[0].line, Some(line_of(&text, at)), "{}", errors[0]);
        assert!(errors[0].message.contains(message) && errors[0].help.is_some(), "{:?}", errors[0]);
        assert_same(&before, &session.render(), "refused");
    }
    let reload = session.save(NDF, &original);
    assert!(matches!(reload.outcome, Outcome::Unchanged { cleared: true }), "{:?}", stages(&reload));
}

#[test]
fn an_annotation_that_does_not_parse_is_a_diagnostic_with_its_line() {
    let mut session = sphere();
    let before = session.render();
    for (file, from, to, part) in [
        (PARAMS, "//@ui \"Rim\" 0..1 ", "//@ui \"Rim\" 0..one ", "one"),
        (USER, "Off=0 Two=2", "Off=0 Two", "Two"),
        (
            "debug/modes.glsl",
            "//@mode clay \"Clay\" group=\"Picture\" encode=color",
            "//@mode clay \"Clay\" group=\"Picture\" encode=colour",
            "colour",
        ),
        ("debug/modes.glsl", "//@mode depth ", "//@mode position ", "position"),
    ] {
        let original = session.tree.read(file);
        let reload = session.edit(file, from, to);
        let error = &failed(&reload)[0];
        assert_eq!(error.file, session.tree.path(file).display().to_string(), "{error}");
        let text = session.tree.read(file);
        // Of two modes with the same name, the error is at the second.
        let (at, _) = text.lines().enumerate().filter(|(_, line)| line.contains(to)).last().unwrap();
        assert_eq!(error.line, Some(at as u32 + 1), "{error}");
        assert!(error.full().contains(part), "{}", error.full());
        assert_same(&before, &session.render(), "after a wrong annotation");
        session.save(file, &original);
    }
}

#[test]
fn a_mode_added_to_modes_glsl_works_at_the_next_save() {
    let mut session = sphere();
    let modes = session.tree.edited(
        "debug/modes.glsl",
        "    return false;",
        "    if (MODE == MODE_FACING) { value = vec3(dot(s.n, v) * dot(s.n, v), 0.25, 2.0); return true; }\n    return false;",
    );
    let mode = "//@mode facing \"Facing\" group=\"Mine\" encode=data doc=\"N dot V, squared.\"\n\
                const uint MODE_FACING = 1000u;\nbool your_mode(";
    ready(&session.save("debug/modes.glsl", &modes.replacen("bool your_mode(", mode, 1)));

    let mode = session.headless.shaders().modes.iter().find(|mode| mode.slug == "facing").cloned();
    let mode = mode.expect("the new mode is listed");
    assert_eq!((mode.id, mode.name.as_str(), mode.group.as_str()), (1000, "Facing", "Mine"));
    let n_dot_v = session.mode("n-dot-v");
    let facing = session.mode("facing");
    let (x, y) = (facing.width / 2, facing.height / 2);
    let (expected, found) = (n_dot_v.raw_at(x, y).unwrap()[0].powi(2), facing.raw_at(x, y).unwrap());
    assert!((found[0] - expected).abs() < 1e-4 && found[1..3] == [0.25, 2.0], "{found:?}, {expected}");
    let at = 4 * (y * facing.width + x) as usize;
    assert_eq!(facing.rgba8[at + 1..at + 3], [64, 255], "data is stored as it is, and clipped");
}

/// A mode that is declared, but of which no code returns a value, shows the picture and not memory that nobody wrote.
#[test]
fn a_mode_without_a_value_shows_the_picture() {
    let mut session = sphere();
    let picture = session.render();
    let mode = "//@mode later \"Later\" group=\"Mine\" encode=color tonemap doc=\"Not written yet.\"\n\
                const uint MODE_LATER = 1001u;\nbool your_mode(";
    ready(&session.edit("debug/modes.glsl", "bool your_mode(", mode));
    assert_same(&picture, &session.mode("later"), "a mode without a value");
}

#[test]
fn a_parameter_added_appears_and_values_survive_by_name() {
    let mut session = sphere();
    let plain = session.render();
    session.set("rim_strength=1.0");
    session.set("rim_color=[0.0, 1.0, 0.0]");
    let rim = session.render();
    assert_differ(&plain, &rim, "a rim");

    // A new first member moves every offset, but values keep their names.
    let first = "    float roughness_scale;";
    ready(&session.edit(PARAMS, first, &format!("    float glow;                //@ui \"Glow\" 0..1 = 0.0\n{first}")));
    let names: Vec<String> =
        session.headless.shaders().parameters.iter().map(|parameter| parameter.name.clone()).collect();
    assert_eq!(names[0], "glow", "{names:?}");
    assert_same(&rim, &session.render(), "values go by name");

    ready(&session.edit(USER, "    return radiance;", "    return radiance + glow;"));
    assert_same(&rim, &session.render(), "the default of the new parameter");
    let generation = session.headless.shaders().generation;
    session.set("glow=0.5");
    assert_differ(&rim, &session.render(), "the new parameter");
    assert_eq!(session.headless.shaders().generation, generation, "a parameter compiles nothing");
}

#[test]
fn a_specialization_constant_changes_the_picture_without_a_compile() {
    let mut session = sphere();
    let smooth = session.render();
    let generation = session.headless.shaders().generation;
    session.set("TOON_BANDS=Three");
    let toon = session.render();
    assert_differ(&smooth, &toon, "bands");
    session.headless.settings_mut().shader.insert("TOON_BANDS".into(), ShaderValue::Int(0));
    assert_same(&smooth, &session.render(), "bands off");
    assert_eq!(session.headless.shaders().generation, generation);
    session.set("TOON_BANDS=Seven");
    let error = session.headless.render().unwrap_err().to_string();
    assert!(["TOON_BANDS", "Seven", "Three"].iter().all(|part| error.contains(part)), "{error}");
}
