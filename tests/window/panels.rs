//! Reads panels and messages from the screen. The mouse rests and no key is pressed, so nothing but the program
//! itself asks for another frame.

use image::RgbaImage;
use serde_json::json;

use super::controls::{ERROR, PANEL, WARNING, count, is_about};
use crate::NDF;
use crate::support::window::Viewer;
use crate::support::{Tree, glb};

/// The section Shaders ends above this row of the window: a heading and four lines. Its last line has the times.
const SHADERS_END: u32 = 102;
const TIMES: std::ops::Range<u32> = 82..100;
/// The last columns of the panel belong to the scroll bar, which fades in and out.
const SCROLL_BAR: u32 = 16;
const SIZE: (u32, u32) = (640, 480);

/// The width of what is written in rows `y` of the panel that begins at column `left`.
fn written(screen: &RgbaImage, left: u32, y: std::ops::Range<u32>) -> u32 {
    let columns = (left + 4..SIZE.0 - SCROLL_BAR).rev();
    let is_blank = |x: u32| y.clone().all(|y| is_about(screen.get_pixel(x, y), PANEL));
    columns.into_iter().find(|x| !is_blank(*x)).map_or(0, |right| right - left)
}

#[test]
fn an_error_moves_nothing_and_goes_with_its_repair() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let left = first.width();
    viewer.move_mouse((left + 230, SHADERS_END / 3));
    let errors = |screen: &RgbaImage, x: std::ops::Range<u32>| count(screen, x, 0..SIZE.1, ERROR);
    let times = |screen: &RgbaImage| written(screen, left, TIMES);
    // "1 ms compile + 2 ms pipeline + 3 ms frame" is longer than "failed after 4 ms".
    let good = viewer.until_screen("the times of the start", |screen| times(screen) > 160);
    assert_eq!((errors(&good, 0..left), errors(&good, left..SIZE.0)), (0, 0), "an error without an error");
    let moved = |screen: &RgbaImage| -> Vec<u32> {
        let differs = |y: u32| (left..SIZE.0 - SCROLL_BAR).any(|x| screen.get_pixel(x, y) != good.get_pixel(x, y));
        (SHADERS_END..SIZE.1).filter(|y| differs(*y)).collect()
    };

    let original = viewer.tree.read(NDF);
    for edit in ["alpha * alfa;", "alpha * ;\n}\nfloat other() { return 1.0 / beta;"] {
        viewer.tree.write(NDF, &original.replace("alpha * alpha;", edit));
        viewer.running.reload(false);
        let bad = viewer.until_screen("the error in the panel, and over the picture", |screen| {
            errors(screen, left..SIZE.0) > 20 && errors(screen, 0..left) > 100 && times(screen) < 140
        });
        assert_eq!(moved(&bad), [0; 0], "rows below the section Shaders that moved or changed");
        assert_eq!(viewer.screenshot().dimensions(), first.dimensions(), "the picture has another size");
    }

    viewer.tree.write(NDF, &original);
    viewer.running.reload(true);
    let repaired = viewer.until_screen("the repair in the panel", |screen| {
        (errors(screen, left..SIZE.0), errors(screen, 0..left)) == (0, 0) && times(screen) > 160
    });
    assert_eq!(moved(&repaired), [0; 0], "rows below the section Shaders that moved or changed");
    assert!(viewer.screenshot() == first, "the first text no longer shows the first picture");
    viewer.quit();
}

/// The stages that compile behind the picture do not take the message away.
#[test]
fn a_loop_that_does_not_end_stays_on_screen() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb"]);
    viewer.running.event("ready");
    let left = viewer.screenshot().width();
    let errors = |screen: &RgbaImage, x: std::ops::Range<u32>| count(screen, x, 0..SIZE.1, ERROR);
    let hook = "void user_surface(inout Surface s) {";
    let text = viewer.tree.edited("user.glsl", hook, &format!("{hook}\n    while (s.roughness < 2.0) {{}}"));
    let original = viewer.tree.read("user.glsl");
    viewer.tree.write("user.glsl", &text);
    let reload = viewer.running.reload(true);
    let (mut is_named, mut is_settled) = (false, false);
    viewer.running.until("the loop's name and all stages", |event| {
        is_named |= event["event"] == "diagnostic";
        is_settled |= event["event"] == "settled" && event["generation"] == reload["generation"];
        is_named && is_settled
    });
    viewer.move_mouse((left / 2, 100));
    viewer.until_screen("the loop's name over the picture and in the panel", |screen| {
        errors(screen, 0..left) > 100 && errors(screen, left..SIZE.0) > 10
    });
    viewer.tree.write("user.glsl", &original);
    viewer.running.reload(true);
    viewer.until_screen("the repair", |screen| errors(screen, 0..SIZE.0) == 0);
    viewer.quit();
}

#[test]
fn the_end_of_a_bake_moves_nothing() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let args = ["model.glb", "--env", "furnace", "--size", "640x640"];
    let mut viewer = Viewer::with_fault(tree, &args, "bake-delay-ms:3000");
    viewer.running.event("ready");
    let left = viewer.screenshot().width();
    let baking = viewer.screen();
    let changed = |screen: &RgbaImage| -> Vec<u32> {
        let differs = |y: u32| (left..SIZE.0 - SCROLL_BAR).any(|x| screen.get_pixel(x, y) != baking.get_pixel(x, y));
        (SHADERS_END..640).filter(|y| differs(*y)).collect()
    };
    viewer.running.event("bake");
    viewer.until_screen("the time of the bake", |screen| !changed(screen).is_empty());
    viewer.screenshot();
    let rows = changed(&viewer.screen());
    // The bar becomes a line of text.
    assert!(rows.last().unwrap() - rows[0] < 20, "rows that moved or changed: {rows:?}");
    viewer.quit();
}

#[test]
fn warnings_of_a_model_lie_over_the_picture() {
    let (mut json, bin) = glb::document(&glb::quad(1.0), &glb::gray());
    json["images"] = json!([{ "uri": "data:image/png;base64,aGVsbG8=" }]);
    json["textures"] = json!([{ "source": 0 }]);
    json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    let [sound, damaged] = [glb::model(&glb::quad(1.0), &glb::gray()), glb::container(&json, &bin)];
    let tree = Tree::new();
    let path = tree.beside("model.glb");
    std::fs::write(&path, sound).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb"]);
    viewer.running.event("ready");
    let left = viewer.screenshot().width();
    let warnings = |screen: &RgbaImage| count(screen, 0..left, 0..SIZE.1, WARNING);
    assert_eq!(warnings(&viewer.screen()), 0, "a warning about a sound model");
    std::fs::write(&path, damaged).unwrap();
    viewer.until_screen("a card with the warning", |screen| warnings(screen) > 100);
    viewer.quit();
}
