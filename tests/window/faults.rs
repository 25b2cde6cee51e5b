//! A failure outside the shaders costs the user neither the picture nor the session: memory, threads, a model that takes forever.

use super::controls::{WARNING, count};
use crate::NDF;
use crate::support::Tree;
use crate::support::window::Viewer;

#[test]
fn closing_does_not_wait_for_a_model() {
    // Ten minutes: the test has no patience for that.
    let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], "load-delay-ms:600000");
    viewer.running.reload(true);
    viewer.quit();
}

#[test]
fn a_window_too_large_for_the_memory_keeps_the_session() {
    // The picture has 8 bytes a pixel: 2.5 MB at 640x480, 5.6 MB at 1000x700.
    let mut viewer = Viewer::with_fault(Tree::new(), &["sphere-grid"], "image-bytes:4000000");
    viewer.running.event("ready");
    // Without panels the picture is as large as the window.
    viewer.key("h");
    viewer.until("the whole window", |shot| shot.dimensions() == (640, 480));
    let first = viewer.screenshot();
    let warnings = |screen: &image::RgbaImage| count(screen, 0..screen.width(), 0..screen.height(), WARNING);
    let before = warnings(&viewer.screen());
    viewer.resize(1000, 700);
    viewer.until_screen("a message over the picture", |screen| warnings(screen) > before + 100);
    assert!(viewer.screenshot() == first, "the picture before did not stay");
    viewer.resize(640, 480);
    assert!(viewer.screenshot() == first, "the first size no longer shows the first picture");
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
    assert!(viewer.screenshot() == first, "the first text no longer shows the first picture");
    let stderr = viewer.quit();
    assert_eq!(stderr.matches("thread failed").count(), 1, "{stderr}");
}
