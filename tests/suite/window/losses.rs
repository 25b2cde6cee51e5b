//! A lost device, a hung device or a crash of the driver ends the process that draws the window. Another one goes on with the
//! session: the picture, the camera, the mode and the place on the desktop.

use std::os::unix::process::ExitStatusExt as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde_json::json;

use super::NDF;
use super::controls::{ERROR, count};
use crate::support::Tree;
use crate::support::process::{finish, send_signal};
use crate::support::window::{Display, Viewer};

const USER: &str = "user.glsl";
const HOOK: &str = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
const FAULT: &str = "by-name:1";

/// `user.glsl` that scales the roughness by a function with a name that the fault knows.
fn edited(original: &str, function: &str, scale: f32) -> String {
    let declaration = format!("float {function}(float x) {{ return {scale:?} * x; }}");
    let text = original.replace(HOOK, &format!("{declaration}\n{HOOK}\n    s.roughness = {function}(s.roughness);"));
    assert_ne!(text, original);
    text
}

fn open(tree: Tree) -> Viewer {
    let mut viewer = Viewer::with_fault(tree, &["sphere-grid"], FAULT);
    viewer.running.event("ready");
    viewer
}

/// How many pixels of the picture have the color of errors.
fn errors(screen: &image::RgbaImage, (width, height): (u32, u32)) -> usize {
    count(screen, 0..width, 0..height, ERROR)
}

#[test]
fn a_loss_costs_nothing_but_the_text_that_caused_it() {
    for (function, cause) in [("lose_the_device", "device was lost"), ("crash_the_driver", "crashed (SIGABRT)")] {
        let mut viewer = open(Tree::new());
        let original = viewer.tree.read(USER);
        let fresh = viewer.screenshot();
        viewer.move_window((40, 30));
        // A good edit, a mode and a camera, so that the session is not as it was at its start.
        viewer.tree.write(USER, &edited(&original, "good", 0.5));
        let reload = viewer.running.reload(true);
        viewer.running.settled(&reload);
        viewer.key("u");
        viewer.drag((60, 200), (120, 160));
        viewer.display.park_mouse();
        // The mode has no colors, and the picture before it has.
        let is_gray = |shot: &image::RgbaImage| shot.pixels().all(|pixel| pixel[0].abs_diff(pixel[2]) < 16);
        viewer.until("roughness, halved and turned", |shot| *shot != fresh && is_gray(shot));
        let (before, geometry) = (viewer.screenshot(), viewer.geometry());

        viewer.tree.write(USER, &edited(&original, function, 0.25));
        let event = viewer.restarted();
        assert!(event["cause"].as_str().unwrap().contains(cause), "{event}");
        assert_eq!((&event["losses"], &event["refused"]), (&1.into(), &serde_json::json!([USER])), "{event}");
        let diagnostic = viewer.running.event("diagnostic");
        assert!(diagnostic["file"].as_str().unwrap().ends_with(USER), "{diagnostic}");
        let message = diagnostic["message"].as_str().unwrap();
        assert!(message.contains(cause) && message.contains("until it changes"), "{diagnostic}");
        viewer.running.event("ready");
        viewer.shows(&before, &format!("{function}: the picture before did not come back"));
        assert_eq!(viewer.geometry(), geometry, "{function}");

        // Other files are edited as ever. The refused text is not used even if everything is compiled again.
        viewer.key("F5");
        let ndf = viewer.tree.edited(NDF, "float a2 = alpha * alpha;", "float a2 = alpha;");
        viewer.tree.write(NDF, &ndf);
        viewer.running.reload(true);
        viewer.shows(&before, &format!("{function}: the roughness does not depend on the distribution"));
        let size = before.dimensions();
        viewer.until_screen("the diagnostic", |screen| errors(screen, size) > 100);

        // The repair is another text, or the last good one again.
        let is_undone = function == "crash_the_driver";
        viewer.tree.write(USER, &if is_undone { edited(&original, "good", 0.5) } else { original });
        viewer.running.reload(true);
        assert_eq!(viewer.screenshot() == before, is_undone, "{function}: the repaired shader");
        viewer.until_screen("no diagnostic", |screen| errors(screen, size) == 0);
        viewer.quit();
    }
}

#[test]
fn a_setting_that_loses_the_device_is_set_back() {
    let tree = Tree::new();
    // Only the pipelines of this mode have the function.
    let file = "debug/surface.glsl";
    let use_it = "if (MODE == MODE_BASE_COLOR) value = lose_the_device(s.base_color)";
    tree.write(file, &tree.edited(file, "if (MODE == MODE_BASE_COLOR) value = s.base_color", use_it));
    let signature = "bool debug_surface(";
    tree.write(
        file,
        &tree.edited(file, signature, &format!("vec3 lose_the_device(vec3 x) {{ return x; }}\n{signature}")),
    );
    let mut viewer = open(tree);
    let before = viewer.screenshot();
    // A text that does not compile has nothing to do with it.
    viewer.tree.write(NDF, &viewer.tree.edited(NDF, "alpha * alpha;", "alpha * alfa;"));
    viewer.running.reload(false);
    viewer.key("b");
    let event = viewer.restarted();
    assert_eq!((&event["refused"], &event["reset"]), (&serde_json::json!([]), &serde_json::json!(["mode"])), "{event}");
    // The text on disk is an error as before. The picture and the modes are those of the last good texts.
    let diagnostic = viewer.running.event("diagnostic");
    assert!(diagnostic["message"].as_str().unwrap().contains("alfa"), "{diagnostic}");
    viewer.running.reload(false);
    viewer.shows(&before, "the mode before did not come back");
    viewer.key("n");
    viewer.until("shading normals", |shot| *shot != before);
    viewer.quit();
}

#[test]
fn a_tree_that_loses_the_device_at_once_can_be_opened() {
    let mut sound = open(Tree::new());
    let built_in = sound.screenshot();
    sound.quit();

    let tree = Tree::new();
    tree.write(USER, &edited(&tree.read(USER), "crash_the_driver", 0.5));
    let mut viewer = Viewer::launch(tree, &["sphere-grid"], FAULT);
    let event = viewer.restarted();
    assert_eq!(event["refused"], serde_json::json!([USER]), "{event}");
    viewer.running.event("ready");
    viewer.shows(&built_in, "the built-in text is not used instead");
    viewer.quit();
}

/// The text is in no file and has never reached the device, so no cause of a loss takes it away.
#[test]
fn text_that_was_typed_and_not_saved_survives_a_loss_and_a_crash() {
    let mut viewer = Viewer::driven_with_fault(Tree::new(), &["--size", "900x700", "sphere-grid"], FAULT);
    viewer.running.event("ready");
    let original = viewer.tree.read(NDF);
    let mut saved = original.clone();
    // The second time, the panel shows the file as it is typed already.
    for (typed, loses, clicks) in [("first", true, "2"), ("second", false, "1")] {
        let open = json!({ "command": "source", "file": NDF, "at": [200, 150] });
        viewer.running.ask(open.clone());
        viewer.screenshot();
        // A double click on a line of the panel, which is below the picture, begins to type there; a click puts the cursor there.
        viewer.move_mouse((420, 640));
        viewer.display.xdotool(&["click", "--repeat", clicks, "--delay", "60", "1"]);
        let text = format!("/* {typed} */");
        viewer.screenshot();
        viewer.display.xdotool(&["type", &text]);
        let deadline = Instant::now() + Duration::from_secs(120);
        while !recorded(&viewer.tree).contains(&text) {
            assert!(Instant::now() < deadline, "{text} is not recorded, but {:?}", recorded(&viewer.tree));
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(viewer.tree.read(NDF), saved, "it is not saved");
        if loses {
            viewer.tree.write(USER, &edited(&viewer.tree.read(USER), "lose_the_device", 0.25));
        } else {
            send_signal(viewer.running.worker(), "ABRT");
        }
        viewer.restarted();
        viewer.running.event("ready");
        assert_eq!(viewer.tree.read(NDF), saved, "{typed}: nothing is written by itself");
        // The next frames could lose the device, too.
        let refused = viewer.running.refused(open);
        assert!(refused.contains("nothing is traced until an edit has been drawn"), "{refused}");
        viewer.screenshot();
        viewer.key("ctrl+s");
        let saved_it = format!("Saved {NDF}");
        viewer.running.until("the save", |event| event["message"] == *saved_it);
        let now = viewer.tree.read(NDF);
        assert!(now.contains(&text) && now.replacen(&text, "", 1) == saved, "{typed}: {now}");
        saved = now;
    }
    viewer.quit();
}

/// What is recorded of typed texts.
fn recorded(tree: &Tree) -> String {
    let sessions = std::fs::read_dir(tree.beside("runtime")).unwrap().flatten();
    let files = sessions.map(|session| session.path().join("typed.json"));
    files.filter_map(|file: PathBuf| std::fs::read_to_string(file).ok()).collect()
}

#[test]
fn three_losses_in_a_row_end_the_session() {
    let mut viewer = open(Tree::new());
    let original = viewer.tree.read(USER);
    for loss in 1..=3 {
        viewer.tree.write(USER, &edited(&original, "lose_the_device", 1.0 / loss as f32));
        if loss < 3 {
            assert_eq!(viewer.restarted()["losses"], loss);
            viewer.running.event("ready");
        }
    }
    let status = viewer.running.end();
    let stderr = viewer.running.stderr();
    assert_eq!(status.code(), Some(3), "{stderr}");
    assert!(stderr.contains("the third time in a row") && stderr.contains(USER), "{stderr}");
    assert_eq!(records(&viewer.tree), 0);
}

#[test]
fn a_device_that_hangs_from_the_start_ends_the_session() {
    let (tree, display) = (Tree::new(), Display::new());
    let mut command = display.view(&tree);
    command.args(["--timeout", "1", "--env", "none"]).env("SPECULA_FAULT", "frame-hang-ms:60000");
    finish(&mut command).expect(3, &["within 1 s", "did not answer, the third time in a row"]);
}

/// The watchdog does not take a window that rests for one whose device hangs.
#[test]
fn a_window_that_rests_is_not_taken_for_hung() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid", "--timeout", "6"]);
    viewer.running.event("ready");
    let before = viewer.screenshot();
    // Longer than the device may take.
    viewer.running.never("restarted", std::time::Duration::from_secs(8));
    assert!(viewer.screenshot() == before);
    assert!(!viewer.quit().contains("within 6 s"), "the window was taken for hung");
}

#[test]
fn the_window_goes_with_the_program() {
    for signal in ["KILL", "TERM"] {
        let mut viewer = open(Tree::new());
        assert_eq!(records(&viewer.tree), 1);
        viewer.running.signal(signal);
        // The window's process has the same output, so the output ends with it.
        let status = viewer.running.end();
        assert_eq!(status.signal(), Some(if signal == "KILL" { 9 } else { 15 }));
        assert_eq!(records(&viewer.tree), 0, "SIG{signal}");
    }
}

/// The number of sessions that have records.
fn records(tree: &Tree) -> usize {
    std::fs::read_dir(tree.beside("runtime")).unwrap().count()
}
