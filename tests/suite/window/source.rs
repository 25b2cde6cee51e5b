//! The panel Source: values beside the code are those of `specula trace`, and a save shows old and new ones.

use serde_json::{Value, json};

use super::NDF;
use crate::support::process::run;
use crate::support::window::Viewer;
use crate::support::{Tree, line_of};

#[test]
fn values_beside_the_code_are_those_of_trace_and_follow_a_save() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "900x700", "shader-ball"]);
    viewer.running.event("ready");
    let ask = |more: Value| {
        let mut command = json!({ "command": "source", "file": NDF });
        more.as_object().unwrap().iter().for_each(|(field, value)| command[field] = value.clone());
        command
    };
    let refused = viewer.running.refused(ask(json!({})));
    assert!(refused.contains("no pixel is pinned; name one with `at`"), "{refused}");
    let refused = viewer.running.refused(json!({ "command": "source", "file": "brdf/ndff.glsl" }));
    assert!(refused.contains("Did you mean `brdf/ndf.glsl`?"), "{refused}");
    // The panel is open, so the picture has its size.
    let picture = viewer.screenshot();
    let (width, height) = picture.dimensions();
    let refused = viewer.running.refused(ask(json!({ "at": [width, 0] })));
    assert!(refused.contains("outside of the picture"), "{refused}");

    let (x, y) = (width / 2, height / 2);
    let found = viewer.running.done(ask(json!({ "at": [x, y] })));
    assert_eq!((&found["proof"]["equal"], &found["pixel"]), (&true.into(), &json!([x, y])), "{found}");
    assert_eq!((&found["stage"], &found["changed"]), (&"pbr.frag".into(), &json!([])), "{found}");
    assert!(found["files"].as_array().unwrap().contains(&NDF.into()), "{found}");
    // The same pixel of the same picture on the command line, bit by bit.
    let (at, size) = (format!("{x},{y}"), format!("{width}x{height}"));
    let args = [
        "trace",
        "shader-ball",
        "--json",
        "--at",
        &at,
        "--size",
        &size,
        "--env",
        "none",
        "--file",
        NDF,
        "--set",
        "view.msaa=1",
    ];
    let traced = run(&viewer.tree.beside(""), &[&args[..], &["--shaders", "shaders"]].concat()).expect(0, &[]).json();
    for part in ["lines", "not_reached", "proof"] {
        assert_eq!(found[part], traced[part], "{part}");
    }
    // A window on a software device does not list those that the depth test left out.
    let [fragments, all] = [&found, &traced].map(|of| of["fragments"].as_array().unwrap());
    assert_eq!(fragments[0], all[0]);
    assert!(fragments.iter().all(|fragment| all.contains(fragment)), "{fragments:?}\n{all:?}");
    assert!(viewer.screenshot() == picture, "the trace changes the picture");

    // One call of several.
    let call = found["calls"].as_array().unwrap().last().unwrap().clone();
    let line = |of: &Value, line: u32| of["lines"].as_array().unwrap().iter().find(|of| of["line"] == line).cloned();
    let original = viewer.tree.read(NDF);
    let place = line_of(&original, "float a2 = alpha * alpha;");
    assert!(line(&found, place).is_some_and(|line| line["done"][0]["name"] == "a2"), "{found}");
    assert!(call.as_str().unwrap().contains(" > "), "{call}");

    // A save: old and new values, also of lines that moved.
    let edit = original.replace("float a2 = alpha * alpha;", "\n    float a2 = 4.0 * alpha * alpha;");
    viewer.tree.write(NDF, &edit);
    viewer.running.reload(true);
    let is_edit = |event: &Value| event["event"] == "traced" && event["generation"] == 2;
    let traced = viewer.running.until("the trace of the edit", is_edit);
    assert_eq!((&traced["equal"], &traced["file"]), (&true.into(), &NDF.into()), "{traced}");
    let edited = viewer.running.done(ask(json!({})));
    let changed = edited["changed"].as_array().unwrap();
    let a2 = changed.iter().find(|change| change["name"] == "a2").unwrap_or_else(|| panic!("{changed:?}"));
    assert_eq!((&a2["line"], &a2["first"]), (&(place + 1).into(), &true.into()), "{changed:?}");
    let number = |text: &Value| text.as_str().unwrap().split([' ', ',']).next().unwrap().parse::<f64>().unwrap();
    let factor = number(&a2["now"]) / number(&a2["before"]);
    assert!((factor - 4.0).abs() < 1e-3, "{a2}");

    // A value over the model is another mode; the values are still those of the picture.
    let expression = json!({ "expression.at": format!("{NDF}:{}:a2", place + 1), "mode": "expression" });
    viewer.running.done(json!({ "command": "set", "values": expression }));
    let watched = viewer.running.done(ask(json!({})));
    assert_eq!((&watched["mode"], &watched["proof"]), (&"final".into(), &edited["proof"]), "{watched}");
    assert_eq!(watched["changed"], edited["changed"]);
    viewer.running.done(json!({ "command": "set", "values": { "expression.at": "", "mode": "final" } }));

    // An edit that does not compile leaves the values.
    viewer.tree.write(NDF, &edit.replace("4.0 * alpha", "4.0 * alfa"));
    viewer.running.reload(false);
    let kept = viewer.running.done(ask(json!({})));
    assert_eq!((&kept["lines"], &kept["proof"]), (&edited["lines"], &edited["proof"]), "{kept}");
    viewer.tree.write(NDF, &edit);
    viewer.running.reload(true);

    // Another stage of the same picture, by its name and by a file that only it has.
    for place in [json!({ "stage": "tonemap.frag" }), json!({ "file": "common/tonemap.glsl" })] {
        let mut command = json!({ "command": "source" });
        place.as_object().unwrap().iter().for_each(|(field, value)| command[field] = value.clone());
        let of_display = viewer.running.done(command);
        assert_eq!(of_display["stage"], "tonemap.frag", "{of_display}");
        assert_eq!(of_display["proof"]["equal"], true, "{}", of_display["proof"]);
    }
    let refused = viewer.running.refused(json!({ "command": "source", "stage": "tonemap.frg" }));
    assert!(refused.contains("Did you mean `tonemap.frag`?"), "{refused}");

    // In a picture of another size, the pin is on the same surface: the framing camera has moved, and the pixel with it.
    let place = |viewer: &mut Viewer, at: &Value| {
        let values = viewer.running.done(json!({ "command": "probe", "at": at, "modes": ["position"] }));
        let position = values["modes"]["position"].as_array().unwrap_or_else(|| panic!("{values}")).clone();
        position.iter().map(|number| number.as_f64().unwrap()).collect::<Vec<_>>()
    };
    let at = json!([x + width / 20, y - height / 10]);
    viewer.running.done(ask(json!({ "at": at })));
    let before = place(&mut viewer, &at);
    viewer.resize(760, 620);
    let smaller = viewer.screenshot().dimensions();
    assert!(smaller.0 < width && smaller.1 < height, "{smaller:?} {width} {height}");
    let pinned = viewer.running.done(json!({ "command": "pinned" }))["pixel"].clone();
    assert_ne!(pinned, at);
    let after = place(&mut viewer, &pinned);
    let apart = before.iter().zip(&after).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    assert!(apart < 0.03, "{before:?} at {at}, {after:?} at {pinned}");
    let found = viewer.running.done(ask(json!({})));
    assert_eq!((&found["pixel"], &found["proof"]["equal"]), (&pinned, &true.into()), "{found}");
    viewer.quit();
}

/// The mistake of a saved file is found from a pixel that it makes too bright: one click there names the line, and the lights.
#[test]
fn a_click_on_a_wrong_pixel_names_the_line_of_the_mistake() {
    const FILE: &str = "brdf/evaluate.glsl";
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "900x700", "sphere-grid"]);
    viewer.running.event("ready");
    // The panel is open at the file. No pixel is pinned, so it has no values.
    let ask = json!({ "command": "source", "file": FILE });
    viewer.running.refused(ask.clone());
    let before = viewer.screenshot();
    let (width, height) = before.dimensions();
    let place = place_of(&before, &viewer.screen());

    let right = "brdf.n_dot_l = saturate(cos_l);";
    let line = line_of(&viewer.tree.read(FILE), right);
    viewer.tree.write(FILE, &viewer.tree.edited(FILE, right, "brdf.n_dot_l = saturate(dot(s.n, -l));"));
    viewer.running.reload(true);
    let after = viewer.screenshot();
    let sum = |image: &image::RgbaImage, (x, y): (u32, u32)| {
        image.get_pixel(x, y).0[..3].iter().map(|channel| i32::from(*channel)).sum::<i32>()
    };
    let pixels = (0..width).flat_map(|x| (0..height).map(move |y| (x, y)));
    let at = pixels.max_by_key(|at| sum(&after, *at) - sum(&before, *at)).unwrap();
    assert!(sum(&after, at) > sum(&before, at) + 30, "no pixel is too bright");

    viewer.click((place.0 + at.0, place.1 + at.1));
    let is_it = |event: &Value| event["event"] == "traced" && event["pixel"] == json!([at.0, at.1]);
    let traced = viewer.running.until("the trace of the click", is_it);
    assert_eq!((&traced["file"], &traced["equal"]), (&FILE.into(), &true.into()), "{traced}");
    let found = viewer.running.done(ask);
    assert_eq!(found["pixel"], json!([at.0, at.1]));
    let changed = found["changed"].as_array().unwrap();
    let first = changed.iter().find(|change| change["first"] == true).unwrap_or_else(|| panic!("{changed:?}"));
    assert_eq!((&first["line"], &first["name"]), (&line.into(), &"brdf.n_dot_l".into()), "{changed:?}");
    // Each of its values has the light that it is about.
    let lines = found["lines"].as_array().unwrap();
    let done = &lines.iter().find(|of| of["line"] == line).unwrap()["done"][0];
    for once in done["first"].as_array().unwrap() {
        let calls = once["calls"].as_str().unwrap();
        assert!(calls.contains("add_light [light ") && calls.ends_with(" > evaluate_brdf"), "{calls}");
    }
    viewer.quit();
}

/// Where a picture is on the screen.
fn place_of(picture: &image::RgbaImage, screen: &image::RgbaImage) -> (u32, u32) {
    let (width, height) = picture.dimensions();
    let places = || (0..64).map(|at| (width / 4 + at * 7 % (width / 2), height / 4 + at * 13 % (height / 2)));
    let is_it = |(left, top): &(u32, u32)| {
        places().all(|(x, y)| screen.get_pixel(left + x, top + y).0[..3] == picture.get_pixel(x, y).0[..3])
    };
    let corners =
        (0..=screen.height() - height).flat_map(|top| (0..=screen.width() - width).map(move |left| (left, top)));
    corners.into_iter().find(is_it).expect("the picture is on the screen")
}

/// The color of marks.
const MARK: [u8; 3] = [255, 0, 255];

/// How many pixels of the window are marked.
fn marks(viewer: &mut Viewer) -> usize {
    let file = viewer.tree.beside("window.png");
    let _ = std::fs::remove_file(&file);
    viewer.running.done(json!({ "command": "capture", "ui": true, "file": file }));
    image::open(&file).unwrap().to_rgb8().pixels().filter(|pixel| pixel.0 == MARK).count()
}

#[test]
fn pixels_that_fail_a_check_are_marked_and_told() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "900x700", "shader-ball"]);
    viewer.running.event("ready");
    assert_eq!(viewer.running.done(json!({ "command": "checks" })), json!([]), "the tree asserts nothing");
    assert_eq!(marks(&mut viewer), 0);
    let picture = viewer.screenshot();
    let assertion =
        "void user_surface(inout Surface s, Fragment f, vec3 v) {\n    assert(s.roughness < 0.0, \"rough\");";
    let text = viewer.tree.edited("user.glsl", "void user_surface(inout Surface s, Fragment f, vec3 v) {", assertion);
    viewer.tree.write("user.glsl", &text);
    viewer.running.reload(true);
    let found = viewer.running.done(json!({ "command": "checks" }));
    let of = found.as_array().unwrap().iter().find(|of| of["stage"] == "pbr.frag").unwrap();
    assert_eq!((&of["rule"], &of["text"]), (&"assert".into(), &"rough".into()), "{found}");
    assert_eq!((&of["file"], &of["line"]), (&"user.glsl".into(), &line_of(&text, "assert(s.rough").into()), "{of}");
    let count = of["count"].as_u64().unwrap() as usize;
    assert!(count > 1000, "{of}");
    let marked = marks(&mut viewer);
    assert!(marked > count / 10, "{marked} pixels are marked, and {count} failed");
    assert!(viewer.screenshot() == picture, "the checks change the picture");
    viewer.running.done(json!({ "command": "set", "values": { "view.checks": "off" } }));
    assert_eq!(viewer.running.done(json!({ "command": "checks" })), json!([]));
    assert_eq!(marks(&mut viewer), 0);
    viewer.quit();
}

/// The setting that checks operations, too.
#[test]
fn undefined_operations_are_marked_while_the_setting_says_so() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "900x700", "sphere-grid"]);
    viewer.running.event("ready");
    let set = |value: &str| json!({ "command": "set", "values": { "view.checks": value } });
    viewer.running.done(set("undefined"));
    assert_eq!(viewer.running.done(json!({ "command": "checks" })), json!([]), "the tree is clean");
    let hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    let divided = "    float zero = min(abs(s.metallic), 0.0);\n    s.occlusion += min(abs(1.0 / zero), 0.0);";
    let text = viewer.tree.edited("user.glsl", hook, &format!("{hook}\n{divided}"));
    viewer.tree.write("user.glsl", &text);
    viewer.running.reload(true);
    let found = viewer.running.done(json!({ "command": "checks" }));
    let line = line_of(&text, "1.0 / zero");
    for of in found.as_array().unwrap() {
        let place = (&of["rule"], &of["file"], &of["line"]);
        assert_eq!(place, (&"division-by-zero".into(), &"user.glsl".into(), &line.into()), "{of}");
        assert_eq!(of["operands"], json!([1.0, 0.0]), "{of}");
    }
    let of = found.as_array().unwrap().iter().find(|of| of["stage"] == "pbr.frag").unwrap_or_else(|| panic!("{found}"));
    let count = of["count"].as_u64().unwrap() as usize;
    let marked = marks(&mut viewer);
    assert!(count > 1000 && marked > count / 10, "{marked} pixels are marked, and {count} failed");
    viewer.running.done(set("assertions"));
    assert_eq!(viewer.running.done(json!({ "command": "checks" })), json!([]), "the shaders assert nothing");
    assert_eq!(marks(&mut viewer), 0);
    viewer.quit();
}

/// A buffer that counts frames is empty when the trace draws it, so nothing is claimed of the picture on screen.
#[test]
fn a_trace_of_passes_with_earlier_frames_says_that_it_begins_anew() {
    let tree = Tree::new();
    let image = "#iChannel0 \"buffer.glsl\"\nvoid mainImage(out vec4 color, in vec2 at) {\n    \
        float count = texelFetch(iChannel0, ivec2(0), 0).x;\n    color = vec4(0.001 * count);\n}\n";
    let buffer = "#iChannel0 \"self\"\nvoid mainImage(out vec4 color, in vec2 at) {\n    \
        float before = texelFetch(iChannel0, ivec2(at), 0).x;\n    color = vec4(before + 1.0);\n}\n";
    std::fs::write(tree.beside("toy.glsl"), image).unwrap();
    std::fs::write(tree.beside("buffer.glsl"), buffer).unwrap();
    let mut viewer = Viewer::driven(tree, &["--size", "700x600", "sphere-grid"]);
    viewer.running.event("ready");
    viewer.running.done(json!({ "command": "open", "tree": viewer.tree.beside("toy.glsl") }));
    let ask = |place: Value| {
        let mut command = json!({ "command": "source", "at": [40, 40] });
        place.as_object().unwrap().iter().for_each(|(field, value)| command[field] = value.clone());
        command
    };
    // The panel opens, and frames go by.
    viewer.running.done(ask(json!({})));
    let found = viewer.running.done(ask(json!({ "at": [50, 40] })));
    assert_eq!((&found["proof"]["begins_anew"], &found["proof"]["equal"]), (&true.into(), &false.into()), "{found}");
    let line = found["lines"].as_array().unwrap().iter().find(|line| line["line"] == 3).cloned().unwrap();
    assert_eq!(line["done"][0]["first"][0]["value"], 1.0, "{line}");
    viewer.quit();
}

/// While a picture plays, each click has the values of its own moment. What was chosen in one tree is not asked of another.
#[test]
fn a_click_traces_the_moment_of_the_picture() {
    let tree = Tree::new();
    let text = "uniform float u_time;\nvoid main() {\n    float now = u_time;\n    gl_FragColor = vec4(fract(now), 0.0, 0.0, 1.0);\n}\n";
    std::fs::write(tree.beside("clock.frag"), text).unwrap();
    let mut viewer = Viewer::driven(tree, &["--size", "900x700", "sphere-grid"]);
    viewer.running.event("ready");
    // Whether the model covers the pixel does not matter.
    viewer.running.ask(json!({ "command": "source", "file": NDF, "at": [171, 150] }));
    let open = |path: &std::path::Path| json!({ "command": "open", "tree": path });
    viewer.running.done(open(&viewer.tree.beside("clock.frag")));
    let mut now = |at: u32| {
        let found = viewer.running.done(json!({ "command": "source", "at": [at, 100] }));
        assert_eq!((&found["file"], &found["proof"]["equal"]), (&"opened/clock.frag".into(), &true.into()), "{found}");
        let line = found["lines"].as_array().unwrap().iter().find(|line| line["line"] == 3).cloned().unwrap();
        line["done"][0]["first"][0]["value"].as_f64().unwrap_or_else(|| panic!("{line}"))
    };
    let (first, second) = (now(100), now(200));
    assert!(second > first, "{first} s, and {second} s after another click");
    viewer.running.done(open(&viewer.tree.beside("shaders")));
    let found = viewer.running.ask(json!({ "command": "source", "at": [171, 150] })).to_string();
    assert!(!found.contains("opened/"), "{found}");
    viewer.quit();
}

/// What a click needs is compiled before it: after the panel has opened, after a save, and for another file. A pinned pixel is traced at once.
#[test]
fn a_click_finds_what_was_compiled_before_a_pixel_was_pinned() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "900x700", "shader-ball"]);
    viewer.running.event("ready");
    let ask = |file: &str| json!({ "command": "source", "file": file });
    viewer.running.refused(ask(NDF));
    let prepared = viewer.running.event("prepared");
    assert_eq!((&prepared["stage"], &prepared["file"]), (&"pbr.frag".into(), &NDF.into()), "{prepared}");
    assert!(prepared["error"].is_null() && prepared["built"].as_u64().unwrap() > 0, "{prepared}");
    let edit = viewer.tree.edited(NDF, "float a2 = alpha * alpha;", "float a2 = 0.5 * alpha * alpha;");
    viewer.tree.write(NDF, &edit);
    viewer.running.reload(true);
    let is_edit = |event: &Value| event["event"] == "prepared" && event["generation"] == 2;
    let prepared = viewer.running.until("the preparation of the edit", is_edit);
    assert!(prepared["built"].as_u64().unwrap() > 0, "{prepared}");

    let (width, height) = viewer.screenshot().dimensions();
    viewer.running.say(&json!({ "command": "source", "at": [width / 2, height / 2] }).to_string());
    let traced = viewer.running.event("traced");
    assert_eq!((&traced["generation"], &traced["equal"]), (&2.into(), &true.into()), "{traced}");
    assert_eq!(traced["built"], 0, "the click compiles what was prepared: {traced}");
    // Another file is compiled for the pinned pixel.
    viewer.running.say(&ask("brdf/visibility.glsl").to_string());
    let traced = viewer.running.event("traced");
    assert_eq!((&traced["file"], &traced["equal"]), (&"brdf/visibility.glsl".into(), &true.into()), "{traced}");
    assert!(traced["built"].as_u64().unwrap() > 0, "{traced}");
    viewer.quit();
}

/// While the panel is closed, a pinned pixel and saves compile and draw nothing for traces.
#[test]
fn a_closed_panel_compiles_and_traces_nothing() {
    let mut viewer = Viewer::driven_with_log(Tree::new(), &["--size", "900x700", "shader-ball"]);
    viewer.running.event("ready");
    let (width, height) = viewer.screenshot().dimensions();
    viewer.running.done(json!({ "command": "pick", "at": [width / 2, height / 2] }));
    assert_eq!(viewer.running.done(json!({ "command": "pinned" }))["pixel"], json!([width / 2, height / 2]));
    let mut edits = 0..;
    let mut save = |viewer: &mut Viewer| {
        let factor = 1.0 + 0.5 * f64::from(edits.next().unwrap_or_default());
        let ndf = viewer.tree.read(NDF).replacen("float a2 = ", &format!("float a2 = {factor:?} * "), 1);
        viewer.tree.write(NDF, &ndf);
        let reload = viewer.running.reload(true);
        viewer.running.settled(&reload);
    };
    save(&mut viewer);
    save(&mut viewer);
    viewer.rests();
    let with_log = |viewer: &Viewer| viewer.running.stderr().matches("compiled with a log").count();
    assert_eq!(with_log(&viewer), 0, "a closed panel compiles");
    // The same edit with the panel open: the line is one that is told.
    viewer.running.done(json!({ "command": "source", "file": NDF }));
    let open = with_log(&viewer);
    assert!(open > 0);
    // Closed again, saves cost nothing once more.
    viewer.key("h");
    viewer.rests();
    let closed = with_log(&viewer);
    save(&mut viewer);
    viewer.rests();
    assert_eq!(with_log(&viewer), closed, "a panel that was closed compiles");
    viewer.quit();
}

/// The trace of the text before takes longer than the save: its values never stand beside the new one. Functions that nothing calls have none.
#[test]
fn a_save_during_a_trace_shows_the_values_of_the_new_text() {
    let args = ["--size", "900x700", "shader-ball"];
    let mut viewer = Viewer::driven_with_fault(Tree::new(), &args, "trace-delay-ms:4000");
    viewer.running.event("ready");
    viewer.running.refused(json!({ "command": "source", "file": NDF }));
    let (width, height) = viewer.screenshot().dimensions();
    viewer.running.say(&json!({ "command": "source", "file": NDF, "at": [width / 2, height / 2] }).to_string());
    let uncalled = "float never_called(float x) {\n    float y = 3.0 * x;\n    return y;\n}\n";
    let edit = viewer.tree.edited(NDF, "float a2 = alpha * alpha;", "float a2 = 4.0 * alpha * alpha;");
    let begin = line_of(&edit, "float d_ggx(");
    let edit = edit.replacen("float d_ggx(", &format!("{uncalled}float d_ggx("), 1);
    viewer.tree.write(NDF, &edit);
    viewer.running.reload(true);
    // Whatever comes after the picture is of its text.
    let traced = viewer.running.event("traced");
    assert_eq!((&traced["generation"], &traced["equal"]), (&2.into(), &true.into()), "{traced}");
    let found = viewer.running.done(json!({ "command": "source" }));
    let lines = found["lines"].as_array().unwrap();
    let place = line_of(&edit, "float a2 = 4.0 * alpha * alpha;");
    let line = lines.iter().find(|line| line["line"] == place).unwrap_or_else(|| panic!("{found}"));
    assert_eq!(line["done"][0]["name"], "a2", "{found}");
    let is_uncalled = |line: &Value| (begin..begin + 4).any(|number| *line == number);
    assert!(!lines.iter().any(|line| is_uncalled(&line["line"])), "{found}");
    let not_reached = found["not_reached"].as_object().unwrap().values().flat_map(|of| of.as_array().unwrap());
    assert!(!not_reached.into_iter().any(is_uncalled), "nothing says that it could be reached: {found}");
    let changed = found["changed"].as_array().unwrap();
    assert!(changed.iter().any(|change| change["line"] == place && change["name"] == "a2"), "{changed:?}");
    viewer.quit();
}

/// The next process shows the picture again, and traces nothing before an edit.
#[test]
fn a_device_that_is_lost_in_a_trace_is_lost_once() {
    let args = ["--size", "900x700", "shader-ball"];
    let mut viewer = Viewer::driven_with_fault(Tree::new(), &args, "trace-loss:1");
    viewer.running.event("ready");
    let before = viewer.screenshot();
    let (width, height) = before.dimensions();
    viewer.running.say(&json!({ "command": "source", "file": NDF, "at": [width / 4, height / 2] }).to_string());
    let event = viewer.restarted();
    assert!(event["cause"].as_str().unwrap().contains("device was lost"), "{event}");
    viewer.running.event("ready");
    let refused = viewer.running.refused(json!({ "command": "source", "file": NDF }));
    assert!(refused.contains("after a lost device, nothing is traced until an edit has been drawn"), "{refused}");
    let after = viewer.screenshot();
    assert!(after.pixels().any(|pixel| *pixel != *after.get_pixel(0, 0)), "there is no picture");
    viewer.quit();
}

/// The camera is the user's, so a narrower picture does not show the pinned surface any more.
#[test]
fn a_pin_that_is_outside_after_a_resize_is_taken_away() {
    let view = ["--size", "1000x700", "sphere-grid", "--eye", "0,0,2.5", "--target", "0,0,0"];
    let mut viewer = Viewer::driven(Tree::new(), &view);
    viewer.running.event("ready");
    viewer.running.refused(json!({ "command": "source", "file": NDF }));
    let (width, height) = viewer.screenshot().dimensions();
    let columns = (0..width).rev().step_by(4);
    let at = columns.flat_map(|x| (0..height).step_by(20).map(move |y| [x, y])).find(|at| {
        let values = viewer.running.done(json!({ "command": "probe", "at": at, "modes": ["position"] }));
        values["modes"]["position"].as_array().is_some_and(|position| position[0].as_f64().is_some_and(|x| x != 0.0))
    });
    let at = at.expect("a surface at the right edge");
    viewer.running.done(json!({ "command": "source", "at": at }));
    viewer.resize(620, 700);
    viewer.running.until_stderr("The picture no longer shows the pinned place, so it was unpinned");
    assert_eq!(viewer.running.done(json!({ "command": "pinned" }))["pixel"], Value::Null);
    let refused = viewer.running.refused(json!({ "command": "source" }));
    assert!(refused.contains("no pixel is pinned"), "{refused}");
    viewer.quit();
}
