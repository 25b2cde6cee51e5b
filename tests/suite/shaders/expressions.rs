//! Expressions of the shaders are shown over the model without a change of the source, and values are written back into it.

use std::collections::{BTreeMap, BTreeSet};

use crate::support::process::{Finished, run};
use crate::support::{Tree, compiler, line_of, settings};
use serde_json::{Value, json};
use specula::settings::ShaderValue;
use specula::shader::rewrite::defaults;
use specula::shader::{Change, Library, Source, TreePath, Update};
use specula::write_back;

const NDF: &str = "brdf/ndf.glsl";
const A2: &str = "float a2 = alpha * alpha;";
/// A pixel of the shader ball in the light of the lamps.
const AT: [&str; 2] = ["--at", "48,30"];
const VIEW: [&str; 11] = [
    "--size",
    "96x64",
    "--env",
    "none",
    "--validate",
    "--set",
    "material.enabled=true",
    "--set",
    "material.roughness=0.5",
    "--shaders",
    "shaders",
];

/// The tree with a loop and a branch in the user's file.
fn tree() -> Tree {
    let tree = Tree::new();
    let code = "float looped(float x) {\n    float sum = 0.0;\n    for (int i = 0; i < 5; ++i) sum += 0.1;\n    \
        if (x < -1.0) {\n        sum = 2.0;\n    }\n    return sum + x;\n}\n\nvoid user_surface(";
    let user = tree.read("user.glsl");
    assert!(user.contains("void user_surface(inout Surface s, Fragment f, vec3 v) {"), "{user}");
    let user = user.replacen("void user_surface(", code, 1);
    let call = "void user_surface(inout Surface s, Fragment f, vec3 v) {\n    s.occlusion *= looped(0.5);";
    tree.write("user.glsl", &user.replacen("void user_surface(inout Surface s, Fragment f, vec3 v) {", call, 1));
    tree
}

fn probe(tree: &Tree, expression: &str, more: &[&str]) -> Finished {
    let directory = tree.root();
    let directory = directory.parent().expect("the folder beside the tree");
    let shaders = tree.root().display().to_string();
    let view: Vec<&str> = VIEW.iter().map(|word| if *word == "shaders" { shaders.as_str() } else { word }).collect();
    run(directory, &[&["probe", "--json", "--watch-expr", expression], more, &AT, &view].concat())
}

/// The value of an expression at the pixel; null without data.
fn value(tree: &Tree, expression: &str, more: &[&str]) -> Value {
    probe(tree, expression, more).expect(0, &[]).json()["modes"]["expression"].clone()
}

fn first(value: &Value) -> f64 {
    value[0].as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[test]
fn an_expression_has_the_value_that_the_picture_is_made_of() {
    let tree = tree();
    let before = tree.read(NDF);
    let at = |what: &str| format!("{NDF}:{}", line_of(&before, what));
    // alpha = roughness^2, a2 = alpha^2
    let a2 = value(&tree, &format!("{}:a2", at(A2)), &[]);
    assert!((first(&a2) - 0.0625).abs() < 1e-6, "{a2}");
    let product = value(&tree, &format!("{}:alpha * 4.0", at(A2)), &[]);
    assert!((first(&product) - 1.0).abs() < 1e-6, "{product}");
    // What the function returns is D, which the mode shows too, of one light.
    let light = ["--set", "lights.chosen=1"];
    let d = first(&value(&tree, &format!("{}:return", at("return a2 / (PI")), &light));
    let mode = probe(&tree, "user.glsl:1:0.0", &[&light[..], &["--mode", "d"]].concat()).expect(0, &[]).json();
    let expected = mode["modes"]["d"][0].as_f64().expect("D");
    assert!((d - expected).abs() < 1e-4 * expected.max(1.0), "{d}, not {expected}");
    assert_eq!(tree.read(NDF), before, "the source has changed");
}

#[test]
fn loops_lights_and_lines_that_are_not_reached() {
    let tree = tree();
    let user = tree.read("user.glsl");
    let at = |what: &str, name: &str| format!("user.glsl:{}:{name}", line_of(&user, what));
    let looped = |name: &str, more: &[&str]| value(&tree, &at("sum += 0.1", name), more);
    assert_eq!(first(&looped("i", &[])), 4.0, "the last evaluation counts");
    assert_eq!(first(&looped("i", &["--set", "expression.evaluation=2"])), 1.0);
    assert!(looped("i", &["--set", "expression.evaluation=9"]).is_null());
    assert!((first(&looped("sum", &[])) - 0.5).abs() < 1e-6);
    assert!((first(&value(&tree, &at("return sum + x", "return"), &[])) - 1.0).abs() < 1e-6);
    assert_eq!(value(&tree, &at("sum = 2.0", "sum"), &[]), Value::Null, "a line that is not reached");

    // A function that runs once for each light: the last light counts, or the chosen one.
    let shade = tree.read("lighting/shade.glsl");
    let light = format!("lighting/shade.glsl:{}:i", line_of(&shade, "Light light = light_at(i, s.position_ws);"));
    assert_eq!(first(&value(&tree, &light, &[])), 2.0);
    assert_eq!(first(&value(&tree, &light, &["--set", "lights.chosen=2"])), 1.0);
    // What is declared outside of every function.
    let params = tree.read("user/params.glsl");
    let color = format!("user/params.glsl:{}:rim_color", line_of(&params, "vec3 rim_color"));
    let color = value(&tree, &color, &[]);
    assert!((color[1].as_f64().expect("green") - 0.8).abs() < 1e-6, "{color}");
}

#[test]
fn values_of_passes_and_of_the_tone_map_are_shown() {
    let tree = Tree::new();
    let at = |file: &str, what: &str, name: &str| format!("{file}:{}:{name}", line_of(&tree.read(file), what));
    let is = |value: &Value, expected: [f64; 3]| {
        let found: Vec<f64> = (0..3).map(|index| value[index].as_f64().unwrap_or(f64::NAN)).collect();
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-6 * b.abs().max(1.0);
        assert!(found.iter().zip(&expected).all(is_near), "{found:?}, not {expected:?}");
    };
    // The centers of pixels, in 96 x 64.
    let center = [48.5 / 96.0, 30.5 / 64.0];
    // A pass that reads the displayed picture: its values are no colors of the display.
    let outline =
        |name: &str| value(&tree, &at("passes/outline.frag", "vec4 scene = texture(picture, uv);", name), &[]);
    is(&outline("vec3(-3.5, 0.25, 1000.0)"), [-3.5, 0.25, 1000.0]);
    is(&outline("vec3(uv, 0.0)"), [center[0], center[1], 0.0]);
    let displayed = outline("scene.rgb");
    assert!((0..3).all(|index| (0.0..=1.0).contains(&displayed[index].as_f64().unwrap())), "{displayed}");
    // The tone map, with the functions that only it calls.
    is(&value(&tree, &at("tonemap.frag", "vec2 uv = (gl_FragCoord.xy", "uv"), &[]), [center[0], center[1], 0.0]);
    let mapped = value(&tree, &at("tonemap.frag", "if (TONEMAP != TONEMAP_OFF) value = tonemap(", "value"), &[]);
    assert!(mapped[0].as_f64().is_some_and(|red| red > 0.0 && red <= 1.0), "{mapped}");
    // A pass with an image of a quarter of the size that a constant switches on, and a library of another one.
    let bloom = at("passes/bloom/bloom_light.frag", "sum += weight * light;", "i");
    is(&value(&tree, &bloom, &["--set", "expression.evaluation=2"]), [1.0, 1.0, 1.0]);
    is(
        &value(&tree, &at("passes/depth_of_field/dof_circle.frag", "vec2 half_pixel", "half_pixel"), &[]),
        [0.5 / 96.0, 0.5 / 64.0, 0.0],
    );
}

#[test]
fn values_of_vertices_are_shown_between_them() {
    let tree = Tree::new();
    let hook = "void user_vertex(inout Vertex vertex) {";
    let code = format!(
        "float twice(float x) {{\n    float y = 2.0 * x;\n    return y;\n}}\n\n{hook}\n    float quarter = 0.25;\n    \
         float half_of_it = twice(quarter);\n    if (half_of_it < 0.0) {{\n        quarter = 9.0;\n    }}"
    );
    tree.write("user/vertex.glsl", &tree.edited("user/vertex.glsl", hook, &code));
    let at = |file: &str, what: &str, name: &str| format!("{file}:{}:{name}", line_of(&tree.read(file), what));
    let of_hook = |what: &str, name: &str| value(&tree, &at("user/vertex.glsl", what, name), &[]);
    assert_eq!(first(&of_hook("float quarter", "quarter")), 0.25);
    assert_eq!(first(&of_hook("float y", "y")), 0.5);
    assert_eq!(first(&of_hook("return y", "y")), 0.5);
    assert_eq!(of_hook("quarter = 9.0", "quarter"), Value::Null, "a line that no vertex reaches");
    // Between the vertices as the fragment stage gets it.
    let moved = value(&tree, &at("pbr.vert", "fragment = fragment_of(vertex);", "fragment.position_ws"), &[]);
    let seen = value(&tree, &at("pbr.frag", "vec3 v = safe_normalize(", "fragment.position_ws"), &[]);
    assert!(
        (0..3).all(|axis| (moved[axis].as_f64().unwrap() - seen[axis].as_f64().unwrap()).abs() < 1e-5),
        "{moved} {seen}"
    );
    // A pass with a vertex stage of its own, in both of its stages.
    let ground = ["--set", "passes.ground=true"];
    let ground_blockers = |file: &str, what: &str, name: &str| {
        let file = format!("passes/ground/{file}");
        value(&tree, &at(&file, what, name), &ground)
    };
    let height = ground_blockers("ground_blockers.vert", "float height", "vec2(3.5, height)");
    assert_eq!(first(&height), 3.5, "{height}");
    let color = ground_blockers("ground_blockers.frag", "color = vec4(1.0", "color");
    assert_eq!(first(&color), 1.0, "{color}");
}

#[test]
fn a_value_that_is_not_finite_has_a_color_of_its_own() {
    let tree = tree();
    let line = line_of(&tree.read("user.glsl"), "return sum + x");
    let shot = |expression: &str, color: [u8; 3]| {
        let folder = tree.root().parent().expect("the folder beside the tree").to_owned();
        let out = folder.join("shot.png");
        let shaders = tree.root().display().to_string();
        let at = format!("user.glsl:{line}:{expression}");
        let args = ["render", "--watch-expr", &at, "--out", "shot.png", "--size", "32x32", "--env", "none"];
        run(&folder, &[&args[..], &["--shaders", &shaders]].concat()).expect(0, &[]);
        let image = image::open(out).unwrap().to_rgba8();
        assert_eq!(image.get_pixel(16, 16).0[..3], color, "{expression}");
        let pass = format!("passes/outline.frag:{}:{expression}", line_of(&tree.read("passes/outline.frag"), "far"));
        let pass = pass.replace("(x", "(uv.x");
        let args = ["render", "--watch-expr", &pass, "--out", "shot.png", "--size", "32x32", "--env", "none"];
        run(&folder, &[&args[..], &["--shaders", &shaders]].concat()).expect(0, &[]);
        let image = image::open(folder.join("shot.png")).unwrap().to_rgba8();
        assert_eq!(image.get_pixel(16, 16).0[..3], color, "{pass}");
    };
    shot("sqrt(-1.0 - abs(x))", [255, 0, 255]);
    shot("1.0 / (x * 0.0)", [255, 255, 0]);
}

#[test]
fn values_of_a_toy_and_of_its_buffers_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "toy.glsl",
        "float lifted(float x) {\n    float y = 2.0 * x;\n    return y - 300.0;\n}\n\
         void mainImage(out vec4 c, in vec2 p) {\n    vec2 q = p;\n    \
         c = vec4(lifted(q.x), texture(iChannel0, q / iResolution.xy).xy, 1.0);\n}\n",
    );
    write("buffer_a.glsl", "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(p, 0.0, 300.0);\n}\n");
    let value = |expression: &str| {
        let args = ["probe", "--json", "--shaders", "toy.glsl", "--size", "96x64", "--at", "48,30"];
        let found = run(folder.path(), &[&args[..], &["--watch-expr", expression]].concat());
        found.expect(0, &[]).json()["modes"]["expression"].clone()
    };
    // Rows count from below there.
    let q = value("toy.glsl:6:q");
    assert_eq!((q[0].as_f64(), q[1].as_f64()), (Some(48.5), Some(33.5)));
    assert_eq!(value("toy.glsl:2:y")[0].as_f64(), Some(97.0));
    assert_eq!(value("toy.glsl:3:return")[0].as_f64(), Some(-203.0));
    // The image of a buffer is shown with its rows as those of the picture.
    let p = value("buffer_a.glsl:2:p");
    assert_eq!((p[0].as_f64(), p[1].as_f64()), (Some(48.5), Some(33.5)));
    let image = run(folder.path(), &["probe", "--json", "--shaders", "toy.glsl", "--size", "96x64", "--at", "48,30"]);
    let modes = image.expect(0, &[]).json()["modes"].clone();
    // Alpha of a pass is a number as the others.
    assert_eq!(modes["pass:buffer_a"], json!([48.5, 33.5, 0.0, 300.0]), "{modes}");
    assert!(modes["pass:image"][2].as_f64().is_some_and(|blue| blue > 0.0), "{modes}");
}

#[test]
fn what_cannot_be_watched_is_said_at_its_place() {
    let tree = tree();
    let ndf = tree.read(NDF);
    let line = line_of(&ndf, A2);
    let error = |expression: &str| probe(&tree, expression, &[]).expect(1, &[]).stderr.clone();
    let unknown = error(&format!("{NDF}:{line}:a3"));
    assert!(unknown.contains(&format!("{NDF}:{line}:")) && unknown.contains("cannot watch `a3`"), "{unknown}");
    assert!(unknown.contains("a2"), "the nearest name: {unknown}");
    assert!(error("deform.comp:10:x").contains("not in other stages"));
    assert!(error("brdf/nfd.glsl:10:x").contains("brdf/ndf.glsl"));
    let shade = tree.read("lighting/shade.glsl");
    let whole = line_of(&shade, "Light light = light_at(i, s.position_ws);");
    let members = error(&format!("lighting/shade.glsl:{whole}:light"));
    assert!(members.contains("its members:") && members.contains("light.intensity"), "{members}");
    let usage = probe(&tree, "brdf/ndf.glsl:x:a2", &[]).expect(2, &[]).stderr.clone();
    assert!(usage.contains("--watch-expr"), "{usage}");
    // The picture has no part in it.
    let args = ["--mode", "depth"];
    let finished = probe(&tree, &format!("{NDF}:{line}:a3"), &args);
    let told = |line: &str| line.starts_with("specula: ") && !line.contains("error");
    assert!(finished.stderr.contains("cannot watch `a3`") || finished.stderr.lines().all(told), "{}", finished.stderr);
}

#[test]
fn a_watched_line_is_found_after_an_edit_and_costs_no_other_stage() {
    let tree = Tree::new();
    let mut library = Library::new(Source::disk(tree.root()), compiler().clone(), &["fullscreen.vert"]);
    let ready = |update: Update| match update {
        Update::Ready(set, report) => (set, report),
        other => panic!("{other:?}"),
    };
    let (plain, _) = ready(library.update(&Change::All));
    let ndf = tree.read(NDF);
    let line = line_of(&ndf, A2);
    let expression = specula::shader::Expression::parse(&format!("{NDF}:{line}:a2"), 0).unwrap();
    let change = library.watch(Some(expression.clone())).unwrap();
    let (watching, report) = ready(library.update(&change));
    assert_eq!(report.stages.len(), 1, "{:?}", report.stages);
    let is_same = plain.stages.iter().all(|(path, stage)| std::sync::Arc::ptr_eq(stage, &watching.stages[path]));
    assert!(is_same && watching.stages.len() == plain.stages.len() + 1);
    let mode = watching.modes.iter().find(|mode| mode.slug == "expression").expect("the mode");
    assert_eq!(mode.components, 1);
    assert_eq!(plain.texts, watching.texts, "the texts of the tree are those on disk");

    tree.write(NDF, &ndf.replace("// D: the", "// One more line.\n\n// D: the"));
    let paths = Change::Paths(BTreeSet::from([TreePath::from(NDF)]));
    let (moved, _) = ready(library.update(&paths));
    assert_eq!((moved.watched.as_ref().map(|watched| watched.line), moved.pending.len()), (Some(line + 2), 0));
    assert!(moved.warnings.is_empty(), "{:?}", moved.warnings);

    // Without the variable, the picture goes on without the mode. The error is none of the tree.
    tree.write(NDF, &ndf.replace("a2", "squared"));
    let (broken, _) = ready(library.update(&paths));
    assert!(broken.is_complete() && broken.warnings.is_empty(), "{:?}", broken.warnings);
    assert!(broken.modes.iter().all(|mode| mode.slug != "expression"));
    let error = broken.expression_error().expect("the error of the expression");
    assert!(error.message.contains("cannot watch `a2`"), "{error:?}");
    tree.write(NDF, &ndf);
    let (repaired, _) = ready(library.update(&paths));
    assert!(repaired.expression_error().is_none() && repaired.modes.iter().any(|mode| mode.slug == "expression"));
    // The stage of the model, which the copy does not include.
    let host = tree.read("pbr.frag");
    tree.write("pbr.frag", &host.replace("hdr_pixel(radiance, coverage", "hdr_pixel(2.0 * radiance, coverage"));
    let of_host = Change::Paths(BTreeSet::from([TreePath::from("pbr.frag")]));
    let (_, report) = ready(library.update(&of_host));
    let compiled: Vec<&str> = report.stages.iter().map(|(stage, _)| stage.as_str()).collect();
    assert!(compiled.contains(&".expression.frag"), "{compiled:?}");
    // A line of a vertex stage needs a stage more, which goes with it.
    let vertex = specula::shader::Expression::parse("pbr.vert:20:gl_Position", 0).unwrap();
    let change = library.watch(Some(vertex)).unwrap();
    let (vertices, report) = ready(library.update(&change));
    assert_eq!(vertices.expression_error(), None);
    assert_eq!(report.stages.len(), 2, "{:?}", report.stages);
    assert_eq!(vertices.modes.iter().find(|mode| mode.slug == "expression").map(|mode| mode.components), Some(3));
    let wrong = specula::shader::Expression::parse("pbr.vert:20:nothing", 0).unwrap();
    let change = library.watch(Some(wrong)).unwrap();
    let (wrong, _) = ready(library.update(&change));
    assert!(wrong.expression_error().is_some_and(|error| error.file.ends_with("pbr.vert")), "{wrong:?}");
    assert!(wrong.modes.iter().all(|mode| mode.slug != "expression"));
    let change = library.watch(None).unwrap();
    let (without, _) = ready(library.update(&change));
    assert!(
        without.stages.len() == plain.stages.len()
            && without.modes.iter().all(|mode| mode.slug != "expression")
            && without.pending.is_empty()
    );
    assert!(without.warnings.is_empty(), "{:?}", without.warnings);
}

#[test]
fn values_of_the_shipped_tree_become_its_defaults() {
    let tree = Tree::new();
    let source = Source::disk(tree.root());
    let mut library = Library::new(source.clone(), compiler().clone(), &["fullscreen.vert"]);
    let Update::Ready(set, _) = library.update(&Change::All) else { panic!("the tree does not compile") };
    let values: BTreeMap<String, ShaderValue> =
        settings(&["NDF=Beckmann", "rim_strength=0.25", "rim_color=[0.5, 1, 0.25]", "TOON_BANDS=Three"]).shader;
    let edits = defaults(&set, &values, None, |path| source.display_path(path)).unwrap();
    assert_eq!(edits.len(), 4, "{edits:?}");
    let crlf = tree.read("user/params.glsl").replace('\n', "\r\n");
    std::fs::write(tree.path("user/params.glsl"), crlf.replacen("//", "\u{feff}//", 0)).unwrap();
    // The text has other line ends than the edits expect, but the same lines.
    write_back::write(&tree.root(), &edits).unwrap();
    let written = tree.read("user/params.glsl");
    assert_eq!(
        written,
        crlf.replace("causes it\" = 0.0", "causes it\" = 0.25").replace("= 1 0.8 0.6", "= 0.5 1 0.25"),
        "only the values"
    );
    assert!(tree.read("brdf/models.glsl").contains("const uint NDF = BECKMANN;"));
    assert!(tree.read("user.glsl").contains("const uint TOON_BANDS = 3u;"));
    let paths = edits.iter().map(|edit| edit.path.clone()).collect();
    let Update::Ready(set, _) = library.update(&Change::Paths(paths)) else { panic!("the edit does not compile") };
    assert!(defaults(&set, &values, None, |path| source.display_path(path)).unwrap().is_empty());
    // A second write finds other lines.
    assert!(write_back::write(&tree.root(), &edits).unwrap_err().contains("nothing was written"));
}
