//! The gallery of modes: its thumbnails follow edits, stay through errors, and let the window rest.

use std::time::{Duration, Instant};

use image::RgbaImage;

use crate::support::Tree;
use crate::support::process::PATIENCE;
use crate::support::window::Viewer;

/// The panels beside the picture, with the gallery among them.
fn panels(screen: &RgbaImage, picture: &RgbaImage) -> Vec<u8> {
    let columns = picture.width() + 8..640;
    columns.flat_map(|x| (60..450).flat_map(move |y| screen.get_pixel(x, y).0)).collect()
}

#[test]
fn thumbnails_follow_edits_stay_through_errors_and_let_the_window_rest() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let drawn = viewer.running.event("thumbnails");
    assert!(drawn["drawn"].as_u64().is_some_and(|drawn| drawn > 0), "{drawn}");
    let picture = viewer.screenshot();
    let before = panels(&viewer.screen(), &picture);

    // Clay is in the first row. Its edit reaches no other stage than that of the debug modes.
    let light = viewer.tree.read("debug/light.glsl");
    viewer
        .tree
        .write("debug/light.glsl", &light.replace("s.base_color = vec3(0.5);", "s.base_color = vec3(0.0, 0.5, 0.0);"));
    viewer.running.event("thumbnails");
    let edited = viewer.until_screen("the edited thumbnail", |screen| panels(screen, &picture) != before);
    let edited = panels(&edited, &picture);
    assert!(viewer.screenshot() == picture, "the picture has no clay");

    // An error that the picture does not have leaves the thumbnails.
    viewer.tree.write("debug/light.glsl", &light.replace("s.base_color = vec3(0.5);", "s.base_color = nothing;"));
    viewer.running.event("diagnostic");
    let failed = viewer.screenshot();
    assert!(failed == picture, "the error costs the picture");
    assert_eq!(panels(&viewer.screen(), &picture).len(), edited.len());
    viewer.tree.write("debug/light.glsl", &light);
    viewer.until_screen("the first thumbnails", |screen| panels(screen, &picture) == before);

    let deadline = Instant::now() + PATIENCE;
    loop {
        let before = viewer.running.ticks();
        std::thread::sleep(Duration::from_secs(1));
        if viewer.running.ticks() - before < 10 {
            break;
        }
        assert!(Instant::now() < deadline, "it never rests. {}", viewer.running.story());
    }
    viewer.quit();
}
