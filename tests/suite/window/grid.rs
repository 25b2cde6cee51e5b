//! Several modes side by side: a Ctrl+click in the gallery adds one, an edit reaches it, and a click in the picture keeps it.

use image::RgbaImage;

use super::controls::count;
use crate::support::Tree;
use crate::support::window::Viewer;

/// The middle of the thumbnail of clay, the second.
const CLAY: (u32, u32) = (165, 140);
/// Columns and rows of the right half of the picture.
const RIGHT: (std::ops::Range<u32>, std::ops::Range<u32>) = (470..660, 200..500);

fn right(screen: &RgbaImage) -> Vec<[u8; 4]> {
    RIGHT.0.flat_map(|x| RIGHT.1.map(move |y| screen.get_pixel(x, y).0)).collect()
}

#[test]
fn modes_lie_side_by_side_and_one_is_kept() {
    let mut viewer = Viewer::open(Tree::new(), &["--size", "1000x700", "sphere-grid"]);
    viewer.running.event("ready");
    viewer.running.event("thumbnails");
    viewer.key("c");
    viewer.key("c");
    let alone = viewer.screenshot();
    let before = right(&viewer.screen());
    viewer.display.xdotool(&["keydown", "ctrl"]);
    viewer.click(CLAY);
    viewer.display.xdotool(&["keyup", "ctrl"]);
    // The mouse on clay previews it, so what is gray is no sign yet.
    viewer.until("the final picture in half of the room", |shot| shot.width() < alone.width() * 6 / 10);
    let grays = |screen: &RgbaImage| {
        right(screen).iter().filter(|[r, g, b, _]| r.abs_diff(*b) < 60 && r.abs_diff(*g) < 60 && *g > 90).count()
    };
    let beside =
        viewer.until_screen("clay beside the final picture", |screen| right(screen) != before && grays(screen) > 1000);

    // An edit of clay reaches the right half.
    let light = viewer.tree.read("debug/light.glsl");
    viewer
        .tree
        .write("debug/light.glsl", &light.replace("s.base_color = vec3(0.5);", "s.base_color = vec3(0.0, 0.5, 0.0);"));
    viewer.running.reload(true);
    viewer.until_screen("green clay", |screen| right(screen) != right(&beside) && grays(screen) < 200);
    viewer.tree.write("debug/light.glsl", &light);
    viewer.until_screen("gray clay", |screen| right(screen) == right(&beside));

    viewer.click((RIGHT.0.start + 60, 300));
    viewer.until_screen("clay alone", |screen| right(screen) != right(&beside));
    let clay = viewer.screenshot();
    assert!(clay.dimensions() == alone.dimensions() && clay != alone);
    // The legend has the name of the mode in a card.
    let card = [21, 23, 26];
    viewer.until_screen("the legend", |screen| count(screen, 240..400, 34..110, card) > 500);
    viewer.quit();
}
