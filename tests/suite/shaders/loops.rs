//! A loop that does not end costs neither the device nor the session: it is cut short, named, and gone after the next save.

use std::time::{Duration, Instant};

use serde_json::json;

use crate::support::process::{Running, finish, run, specula};
use crate::support::window::Viewer;
use crate::support::{Session, Tree, assert_same, assert_validated, glb, line_of, lines, load, ready, settings};

const USER: &str = "user.glsl";
const PARAMS: &str = "user/params.glsl";
const HOOK: &str = "void user_surface(inout Surface s, Fragment f, vec3 v) {";

fn sphere() -> Session {
    Session::new(load(&glb::model(&glb::sphere(16, 32), &glb::gray())), settings(&["environment.name=none"]))
}

/// `user.glsl` with this code at the start of `user_surface`.
fn edited(tree: &Tree, code: &str) -> String {
    tree.edited(USER, HOOK, &format!("{HOOK}\n{code}"))
}

/// The message that a session gives instead of a picture.
#[track_caller]
fn refused(session: &mut Session) -> Vec<String> {
    let error = session.headless.render().map(|_| ()).expect_err("an error");
    assert_validated();
    match error {
        specula::headless::HeadlessError::Shaders(diagnostics) => lines(&diagnostics),
        other => panic!("{other}"),
    }
}

/// Fails unless the only message names this line of a file.
#[track_caller]
fn assert_names(session: &mut Session, file: &str, what: &str) {
    let text = session.tree.read(file);
    let place =
        format!("{}:{}: error: this loop did not end (", session.tree.path(file).display(), line_of(&text, what));
    let found = refused(session);
    assert!(matches!(found.as_slice(), [line] if line.starts_with(&place)), "expected {place}\nfound {found:#?}");
}

const ENDLESS: [(&str, &str); 6] = [
    ("float x = s.roughness;\n    while (x < 2.0) x *= 0.5;\n    s.roughness = x;", "while (x"),
    ("float x = s.roughness;\n    for (;;) { x *= 0.5; if (x > 2.0) break; }\n    s.roughness = x;", "for (;;"),
    ("float x = s.roughness;\n    do x *= 0.5; while (x < 2.0);\n    s.roughness = x;", "do x"),
    (
        "float x = s.roughness;\n    for (uint i = 8u; i >= 0u; --i) x = cos(x);\n    s.roughness = x;",
        "for (uint i = 8u",
    ),
    // The inner loop ends, the outer one does not; and the other way round.
    (
        "float x = s.roughness;\n    while (x < 2.0) {\n        float y = x;\n        while (y > 0.01) y *= 0.5;\n        x = y;\n    }\n    s.roughness = x;",
        "while (x",
    ),
    (
        "float x = s.roughness;\n    while (x < 2.0) {\n        x += 0.1;\n        while (x < 3.0) x *= 0.5;\n    }\n    s.roughness = x;",
        "while (x < 3.0)",
    ),
];

#[test]
fn an_endless_loop_is_named_and_gone_after_the_next_save() {
    let mut session = sphere();
    let original = session.tree.read(USER);
    let before = session.render();
    for (code, line) in ENDLESS {
        let text = edited(&session.tree, code);
        ready(&session.save(USER, &text));
        let start = Instant::now();
        assert_names(&mut session, USER, line);
        assert!(start.elapsed() < Duration::from_secs(10), "{:?}: {code}", start.elapsed());
        ready(&session.save(USER, &original));
        assert_same(&before, &session.render(), code);
    }
}

#[test]
fn nested_endless_loops_end() {
    let mut session = sphere();
    let code = "float x = s.roughness;\n    while (x < 2.0) {\n        while (x < 2.0) {\n            while (x < 2.0) x *= 0.5;\n        }\n    }\n    s.roughness = x;";
    let text = edited(&session.tree, code);
    ready(&session.save(USER, &text));
    assert_names(&mut session, USER, "while (x < 2.0) x *=");
    // A loop with a known end around an endless one.
    let code = "float x = s.roughness;\n    for (int i = 0; i < 10000; ++i) {\n        while (x < 2.0) x *= 0.5;\n    }\n    s.roughness = x;";
    let text = session.tree.read(USER).replace(
        "    while (x < 2.0) {\n        while (x < 2.0) {\n            while (x < 2.0) x *= 0.5;\n        }\n    }",
        "",
    );
    let text = text.replace("float x = s.roughness;\n\n    s.roughness = x;", code);
    ready(&session.save(USER, &text));
    assert_names(&mut session, USER, "while (x < 2.0) x *=");
}

#[test]
fn loops_of_other_stages_are_named_too() {
    for (file, hook, code) in [
        (
            "user/vertex.glsl",
            "void user_vertex(inout Vertex vertex) {",
            "float x = abs(vertex.uv0.x);\n    while (x < 2.0) x *= 0.5;\n    vertex.uv0.x += x;",
        ),
        (
            "user/display.glsl",
            "vec3 user_display(vec3 light, vec2 uv) {",
            "float x = abs(light.x);\n    while (x < 2.0e9) x *= 0.5;\n    light.x += x;",
        ),
    ] {
        let mut session = sphere();
        let before = session.render();
        let original = session.tree.read(file);
        let text = session.tree.edited(file, hook, &format!("{hook}\n    {code}"));
        ready(&session.save(file, &text));
        assert_names(&mut session, file, "while (x");
        ready(&session.save(file, &original));
        assert_same(&before, &session.render(), file);
    }
}

#[test]
fn a_bake_whose_loop_does_not_end_is_named() {
    let mut session = Session::new(load(&glb::model(&glb::sphere(16, 32), &glb::gray())), settings(&[]));
    let before = session.render();
    let file = "brdf/diffuse.glsl";
    let original = session.tree.read(file);
    let hook = "vec3 f_diffuse(";
    let text = original.replacen(
        hook,
        &format!("float endless(float x) {{\n    while (x < 2.0) x *= 0.5;\n    return x;\n}}\n\n{hook}"),
        1,
    );
    let (head, body) = text.split_once(hook).unwrap();
    let (arguments, rest) = body.split_once("{\n").unwrap();
    let text = format!("{head}{hook}{arguments}{{\n    if (endless(roughness) > 3.0) return vec3(0.0);\n{rest}");
    ready(&session.save(file, &text));
    assert_names(&mut session, file, "while (x");
    ready(&session.save(file, &original));
    assert_same(&before, &session.render(), "baked again");
}

#[test]
fn a_parameter_can_make_a_loop_endless() {
    let mut session = sphere();
    let member = "    float roughness_scale;";
    let with_rate =
        session.tree.edited(PARAMS, member, &format!("    float rate;    //@ui \"Rate\" 0..1 = 0.5\n{member}"));
    session.tree.write(PARAMS, &with_rate);
    let text = edited(&session.tree, "float x = 0.1;\n    while (x < 2.0) x += rate;\n    s.roughness = min(x, 0.4);");
    session.tree.write(USER, &text);
    ready(&session.changed(&[PARAMS, USER]));
    let good = session.render();
    session.set("rate=0.0");
    assert_names(&mut session, USER, "while (x");
    session.set("rate=0.5");
    assert_same(&good, &session.render(), "the parameter back at its value");
}

#[test]
fn loops_that_end_change_no_pixel() {
    let mut session = sphere();
    let rounds = |loops: &str| format!("float x = 0.0;\n    {loops}\n    s.roughness = clamp(x / 4000.0, 0.1, 0.9);");
    let plain = edited(&session.tree, &rounds("x = 2000.0;"));
    let original = session.tree.read(USER);
    ready(&session.save(USER, &plain));
    let expected = session.render();
    for loops in [
        "for (int i = 0; i < 2000; ++i) x += 1.0;",
        "while (x < 2000.0) x += 1.0;",
        "for (int i = 0; i < int(rim_power * 0.0) + 2000; ++i) x += 1.0;",
        "for (int j = 0; j < int(rim_power * 0.0) + 20; ++j) while (x < 100.0 * float(j + 1)) x += 1.0;",
    ] {
        session.tree.write(USER, &original);
        let text = edited(&session.tree, &rounds(loops));
        ready(&session.save(USER, &text));
        assert_same(&expected, &session.render(), loops);
    }
}

#[test]
fn commands_fail_with_the_line() {
    let tree = Tree::new();
    let text = edited(&tree, ENDLESS[0].0);
    tree.write(USER, &text);
    let place = format!("user.glsl:{}: error: this loop did not end (", line_of(&text, "while (x"));
    let folder = tree.beside("");
    let common = ["--shaders", "shaders", "--env", "none", "--size", "320x240"];
    for command in [
        &["render", "sphere-grid", "--out", "a.png"][..],
        &["probe", "sphere-grid", "--at", "160,120", "--mode", "final"],
        &["bench", "frame", "sphere-grid", "--samples", "1", "--mode", "final"],
    ] {
        let start = Instant::now();
        run(&folder, &[command, &common].concat()).expect(1, &[&place]);
        assert!(start.elapsed() < Duration::from_secs(30), "{command:?}: {:?}", start.elapsed());
    }
    assert!(!tree.beside("a.png").exists(), "a picture that was cut short");
}

/// The wait for the device hangs, as it does on a hung GPU.
#[test]
fn a_device_that_hangs_ends_a_command() {
    let tree = Tree::new();
    for (args, fault) in [
        (&["render", "sphere-grid"][..], "frame-hang-ms:60000"),
        (&["probe", "sphere-grid", "--at", "10,10"], "frame-hang-ms:60000"),
        (&["bench", "frame"], "frame-hang-ms:60000"),
        (&["check"], "pipeline-hang-ms:60000"),
    ] {
        let mut command = specula(&tree.beside(""));
        command.args(args).args(["--timeout", "2", "--env", "none", "--size", "64x64"]);
        let start = Instant::now();
        finish(command.env("SPECULA_FAULT", fault)).expect(3, &["within 2 s", "--timeout"]);
        assert!(start.elapsed() < Duration::from_secs(20), "{args:?}: {:?}", start.elapsed());
    }
    run(&tree.beside(""), &["render", "--timeout", "0"]).expect(2, &["--timeout"]);
}

#[test]
fn a_lost_device_ends_a_command() {
    let tree = Tree::new();
    let text = edited(&tree, "s.roughness = lose_the_device(s.roughness);");
    tree.write(USER, &text.replacen(HOOK, &format!("float lose_the_device(float x) {{ return x; }}\n{HOOK}"), 1));
    for args in [
        &["render", "sphere-grid"][..],
        &["render", "sphere-grid", "--watch"],
        &["probe", "sphere-grid", "--at", "32,32", "--mode", "final"],
        &["bench", "frame", "sphere-grid", "--samples", "1", "--mode", "final"],
    ] {
        let mut command = specula(&tree.beside(""));
        command.args(args).args(["--shaders", "shaders", "--env", "none", "--size", "64x64"]);
        finish(command.env("SPECULA_FAULT", "by-name:1")).expect(3, &["the graphics device was lost while"]);
    }
    assert!(!tree.beside("specula.png").exists(), "a picture of a lost device");
}

#[test]
fn watching_goes_on_after_an_endless_loop() {
    let tree = Tree::new();
    let original = tree.read(USER);
    let mut command = specula(&tree.beside(""));
    command.args(["render", "sphere-grid", "--watch", "--events", "json", "--validate", "--shaders", "shaders"]);
    let mut running = Running::start(command.args(["--env", "none", "--size", "64x48", "--out", "a.png"]));
    running.event("ready");
    let picture = || std::fs::read(tree.beside("a.png")).unwrap();
    let good = picture();
    let text = edited(&tree, ENDLESS[0].0);
    tree.write(USER, &text);
    let diagnostic = running.event("diagnostic");
    assert_eq!(diagnostic["line"], line_of(&text, "while (x"), "{diagnostic}");
    running.event("reload");
    assert!(picture() == good, "a picture that was cut short");
    tree.write(USER, &original.replacen(HOOK, &format!("{HOOK}\n    s.roughness *= 0.5;"), 1));
    running.reload(true);
    assert!(picture() != good, "the repair does not show");
}

#[test]
fn the_window_names_the_loop_and_goes_on() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let good = viewer.screenshot();
    let original = viewer.tree.read(USER);
    for _ in 0..2 {
        let text = edited(&viewer.tree, ENDLESS[0].0);
        viewer.tree.write(USER, &text);
        let diagnostic = viewer.running.event("diagnostic");
        assert_eq!(diagnostic["line"], line_of(&text, "while (x"), "{diagnostic}");
        assert!(diagnostic["message"].as_str().unwrap().starts_with("this loop did not end ("), "{diagnostic}");
        let marked = viewer.screenshot();
        assert!(marked.pixels().any(|pixel| pixel.0 == [255, 0, 255, 255]), "no pixel is marked");
        viewer.tree.write(USER, &original);
        viewer.running.reload(true);
        assert!(viewer.screenshot() == good, "the repair brings the picture back");
    }
    viewer.quit();
}

#[test]
fn a_cut_loop_is_magenta_in_every_tone_map_at_every_exposure() {
    const CURVES: [&str; 8] =
        ["none", "reinhard", "reinhard-luminance", "uncharted2", "aces", "aces-hill", "agx", "neutral"];
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid", "--size", "160x120"]);
    viewer.running.event("ready");
    let text = edited(&viewer.tree, ENDLESS[0].0);
    viewer.tree.write(USER, &text);
    viewer.running.event("diagnostic");
    for curve in CURVES {
        for ev in [-30.0, 0.7, 30.0] {
            let values = json!({"view.tonemap": curve, "view.ev": ev});
            viewer.running.done(json!({"command": "set", "values": values}));
            let marked = viewer.screenshot().pixels().filter(|pixel| pixel.0 == [255, 0, 255, 255]).count();
            assert!(marked > 1000, "{curve} at EV100 {ev}: {marked} pixels are marked");
        }
    }
    viewer.quit();
}
