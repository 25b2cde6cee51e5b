//! The gallery of modes: its thumbnails follow edits, stay through errors, and let the window rest.

use image::RgbaImage;

use crate::support::Tree;
use crate::support::window::Viewer;

/// Pixels of the window's upper left, where the first thumbnails are: that of the final picture and that of clay.
fn first_row(screen: &RgbaImage) -> Vec<[u8; 4]> {
    (4..216).flat_map(|x| (100..200).map(move |y| screen.get_pixel(x, y).0)).collect()
}

#[test]
fn thumbnails_follow_edits_stay_through_errors_and_let_the_window_rest() {
    let mut viewer = Viewer::open(Tree::new(), &["--size", "1000x700", "sphere-grid"]);
    viewer.running.event("ready");
    let drawn = viewer.running.event("thumbnails");
    assert!(drawn["drawn"].as_u64().is_some_and(|drawn| drawn > 0), "{drawn}");
    let picture = viewer.screenshot();
    let before = first_row(&viewer.screen());

    // An edit of clay reaches the debug modes alone.
    let light = viewer.tree.read("debug/light.glsl");
    let edited = |color: &str| light.replace("s.base_color = vec3(0.5);", &format!("s.base_color = {color};"));
    viewer.tree.write("debug/light.glsl", &edited("vec3(0.0, 0.5, 0.0)"));
    viewer.running.event("thumbnails");
    let green = first_row(&viewer.until_screen("the edited thumbnail", |screen| first_row(screen) != before));
    assert!(viewer.screenshot() == picture, "the picture shows no clay");

    // An error of the debug modes leaves the thumbnails.
    viewer.tree.write("debug/light.glsl", &edited("nothing"));
    viewer.running.event("diagnostic");
    assert!(viewer.screenshot() == picture, "the error costs the picture");
    assert!(first_row(&viewer.screen()) == green, "the error costs thumbnails");

    viewer.tree.write("debug/light.glsl", &light);
    viewer.until_screen("the first thumbnails", |screen| first_row(screen) == before);

    viewer.running.rests();
    viewer.quit();
}
