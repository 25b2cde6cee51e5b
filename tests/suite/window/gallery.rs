//! The gallery of modes: its thumbnails follow edits, stay through errors, and let the window rest.

use std::collections::HashSet;

use image::RgbaImage;
use serde_json::json;

use super::NDF;
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

    viewer.rests();
    viewer.quit();
}

/// How many colors the newest and the second thumbnail of the timeline have, in a window of 1000 x 700 pixels with the panels of Compare.
fn colors_of_versions(screen: &RgbaImage) -> [usize; 2] {
    let colors = |left: u32| {
        let pixels = (left..left + 110).flat_map(|x| (550..610).map(move |y| screen.get_pixel(x, y).0));
        pixels.collect::<HashSet<_>>().len()
    };
    [colors(16), colors(208)]
}

/// The device may finish a thumbnail while a frame is drawn, and nothing may follow that frame.
#[test]
fn the_thumbnail_of_an_edit_appears_though_nothing_moves() {
    let mut viewer = Viewer::driven(Tree::new(), &["--size", "1000x700", "sphere-grid"]);
    viewer.running.event("ready");
    viewer.running.done(json!({"command": "run", "entry": "Layout: Compare"}));
    viewer.until_screen("the first thumbnail", |screen| colors_of_versions(screen)[0] > 100);

    let original = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &original.replace("alpha * alpha;", "alpha;"));
    viewer.until_screen("the second thumbnail", |screen| colors_of_versions(screen).iter().all(|count| *count > 100));
    viewer.rests();
    viewer.running.end_input();
    viewer.quit();
}
