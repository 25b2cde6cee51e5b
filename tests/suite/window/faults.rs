//! A failure outside the shaders costs the user neither the picture nor the session: memory, threads, a model that takes forever.

use super::NDF;
use super::controls::{WARNING, choose, count};
use crate::support::window::Viewer;
use crate::support::{Tree, glb, hdr};

#[test]
fn closing_does_not_wait_for_a_model() {
    // Ten minutes: the test has no patience for that.
    let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], "load-delay-ms:600000");
    viewer.running.reload(true);
    viewer.quit();
}

#[test]
fn closing_does_not_wait_for_an_environment() {
    let tree = Tree::new();
    // No other test has this color, and no bake of it ends, so it is never read from the disk cache.
    std::fs::write(tree.beside("sky.hdr"), hdr::uniform([77, 91, 13, 129])).unwrap();
    let mut viewer = Viewer::with_fault(tree, &["sphere-grid", "--env", "sky.hdr"], "decode-delay-ms:600000");
    viewer.running.event("ready");
    viewer.quit();
}

#[test]
fn a_window_that_was_closed_stays_closed_whatever_fails_then() {
    for (fault, warning) in [
        ("closing-panic:1", "Specula failed while the window closed"),
        // Ten minutes: the test has no patience for that.
        ("closing-delay-ms:600000,closing-limit-ms:1000", "a thread did not end with the session"),
    ] {
        let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], fault);
        viewer.running.event("ready");
        let stderr = viewer.quit();
        assert!(stderr.contains(warning), "{fault}: {stderr}");
    }
}

#[test]
fn a_panic_of_a_canceled_bake_leaves_the_new_one() {
    let size = ["sphere-grid", "--size", "640x640", "--env", "studio"];
    let mut viewer = Viewer::with_fault(Tree::new(), &size, "bake-delay-ms:4000,bake-panic:1");
    viewer.running.event("ready");
    choose(&viewer, "environment furnace");
    viewer.running.until("furnace", |event| event["event"] == "bake" && event["environment"] == "furnace");
    // A thread that panics prints a backtrace first, which may take longer than the bake.
    viewer.running.until_stderr("baker thread failed");
    let stderr = viewer.quit();
    assert_eq!(stderr.matches("baker thread failed").count(), 1, "{stderr}");
}

/// Memory runs out once, in one part of a frame: the window says so and draws the frame again.
#[test]
fn a_frame_for_which_memory_is_short_is_drawn_again() {
    let mut sound = Viewer::open(Tree::new(), &["sphere-grid"]);
    sound.running.event("ready");
    let picture = sound.screenshot();
    // A few pixels of the golden spheres have nearly the color of warnings.
    let warnings = |screen: &image::RgbaImage| count(screen, 0..picture.width(), 0..picture.height(), WARNING);
    let of_spheres = warnings(&sound.screen());
    sound.quit();
    for fault in ["swapchain:1", "frame-set:1", "frame-submit:3", "ui-textures:1", "ui-draw:3"] {
        let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], fault);
        viewer.running.event("ready");
        assert!(viewer.screenshot() == picture, "{fault}: another picture");
        viewer.until_screen("a picture without a message", |screen| warnings(screen) == of_spheres);
        let stderr = viewer.quit();
        assert_eq!(stderr.matches("out of graphics memory").count(), 1, "{fault}: {stderr}");
    }
}

#[test]
fn a_screenshot_for_which_memory_is_short_costs_nothing() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    // The readback has 8 bytes a pixel: 1.3 MB beside the panels, 2.5 MB without them.
    let mut viewer = Viewer::with_fault(tree, &["model.glb"], "buffer-bytes:2000000");
    viewer.running.event("ready");
    let first = viewer.screenshot();
    // Both in one frame, so that the screenshot is the first to draw to the larger targets.
    viewer.display.xdotool(&["key", "--delay", "0", "h", "F12"]);
    viewer.running.until_stderr("no screenshot: out of graphics memory");
    viewer.key("h");
    assert!(viewer.screenshot() == first, "the picture beside the panels has changed");
    viewer.quit();
}

#[test]
fn a_window_too_large_for_the_memory_keeps_the_session() {
    // The picture has 8 bytes a pixel: 2.5 MB at 640x480, 5.6 MB at 1000x700.
    let mut viewer =
        Viewer::with_fault(Tree::new(), &["sphere-grid", "--set", "passes.ground=false"], "image-bytes:4000000");
    viewer.running.event("ready");
    // Without panels the picture is as large as the window.
    viewer.key("h");
    viewer.until("the whole window", |shot| shot.dimensions() == (640, 480));
    let first = viewer.screenshot();
    let warnings = |screen: &image::RgbaImage| count(screen, 0..screen.width(), 0..screen.height(), WARNING);
    let before = warnings(&viewer.screen());
    viewer.resize(1000, 700);
    let failure = viewer.running.event("failure");
    assert!(failure["message"].as_str().is_some_and(|text| text.contains("out of graphics memory")), "{failure}");
    viewer.until_screen("a message over the picture", |screen| warnings(screen) > before + 100);
    assert!(viewer.screenshot() == first, "the picture before did not stay");
    viewer.resize(640, 480);
    assert!(viewer.screenshot() == first, "the first size no longer shows the first picture");
    viewer.until_screen("a picture without a message", |screen| warnings(screen) == before);
    viewer.quit();
}

#[test]
fn a_panic_of_the_worker_costs_nothing() {
    let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], "worker-panic:2");
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let edited = viewer.tree.edited(NDF, "float a2 = alpha * alpha;", "float a2 = alpha;");
    let original = viewer.tree.read(NDF);
    // The worker fails at this edit, starts again and compiles all files as they are.
    viewer.tree.write(NDF, &edited);
    viewer.running.until_stderr("worker thread failed");
    viewer.running.reload(true);
    assert!(viewer.screenshot() != first, "the edit does not show");
    // The new worker sees saves as the old one did.
    viewer.tree.write(NDF, &original);
    let reload = viewer.running.reload(true);
    assert!(reload["changed"][0].as_str().is_some_and(|file| file.ends_with(NDF)), "{reload}");
    viewer.running.settled(&reload);
    assert!(viewer.screenshot() == first, "the first text no longer shows the first picture");
    let stderr = viewer.quit();
    assert_eq!(stderr.matches("thread failed").count(), 1, "{stderr}");
}
