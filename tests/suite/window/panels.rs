//! Reads panels and messages from the screen. The mouse rests and no key is pressed, so nothing but the program
//! itself asks for another frame.

use image::RgbaImage;
use serde_json::json;

use super::NDF;
use super::controls::{ERROR, STATUS, STATUS_COLUMNS, TILES, WARNING, count};
use crate::support::window::Viewer;
use crate::support::{Tree, glb};

/// Pixels of a color in the lower bar.
fn in_status(screen: &RgbaImage, color: [u8; 3]) -> usize {
    count(screen, STATUS_COLUMNS, STATUS, color)
}

/// The position of an error opens in the editor at its line.
#[cfg(unix)]
#[test]
fn a_click_on_an_error_opens_the_editor() {
    use std::os::unix::fs::PermissionsExt as _;

    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let (editor, opened) = (tree.beside("editor"), tree.beside("opened.txt"));
    std::fs::write(&editor, "#!/bin/sh\nprintf '%s ' \"$@\" > opened.new && mv opened.new opened.txt\n").unwrap();
    std::fs::set_permissions(&editor, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut viewer = Viewer::with_editor(tree, &["model.glb"], "./editor {line} {column} {file}");
    viewer.running.event("ready");
    let left = viewer.screenshot().width();
    let text = viewer.tree.read(NDF).replace("alpha * alpha;", "alpha * alfa;");
    viewer.tree.write(NDF, &text);
    let error = viewer.running.event("diagnostic");
    viewer.running.reload(false);
    // The card has an edge of the same color over its whole width. The position is its second line.
    let edge = |screen: &RgbaImage| TILES.into_iter().find(|y| count(screen, 0..left, *y..*y + 1, ERROR) > 100);
    let screen = viewer.until_screen("the card with the error", |screen| edge(screen).is_some());
    viewer.click((40, edge(&screen).unwrap() + 40));
    viewer.until("the editor", |_| opened.exists());
    let told = std::fs::read_to_string(&opened).unwrap();
    let file = viewer.tree.beside(error["file"].as_str().unwrap());
    assert_eq!(told.trim(), format!("{} {} {}", error["line"], error["column"], file.display()));
    viewer.quit();
}

/// Without an editor, the file is shown in the panel Source, and the reason is told.
#[test]
fn without_an_editor_a_click_on_an_error_shows_its_file() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::without_editor(tree, &["model.glb"]);
    viewer.running.event("ready");
    let left = viewer.screenshot().width();
    let text = viewer.tree.read(NDF).replace("alpha * alpha;", "alpha * alfa;");
    viewer.tree.write(NDF, &text);
    viewer.running.reload(false);
    let edge = |screen: &RgbaImage| TILES.into_iter().find(|y| count(screen, 0..left, *y..*y + 1, ERROR) > 100);
    let screen = viewer.until_screen("the card with the error", |screen| edge(screen).is_some());
    viewer.click((40, edge(&screen).unwrap() + 40));
    viewer.running.until_stderr("The panel Source shows the file: found no editor with a window of its own");
    let layout = viewer.tree.beside("state/specula/layout.json");
    viewer.until("the panel", |_| std::fs::read_to_string(&layout).is_ok_and(|text| text.contains("\"Source\"")));
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
    let errors = |screen: &RgbaImage| count(screen, 0..left, TILES, ERROR);
    let hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
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
    viewer.until_screen("the loop's name over the picture and an error in the lower bar", |screen| {
        errors(screen) > 100 && in_status(screen, ERROR) > 20
    });
    viewer.tree.write("user.glsl", &original);
    viewer.running.reload(true);
    viewer.until_screen("the repair", |screen| errors(screen) == 0 && in_status(screen, ERROR) == 0);
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
    let warnings = |screen: &RgbaImage| count(screen, 0..left, TILES, WARNING);
    assert_eq!(warnings(&viewer.screen()), 0, "a warning about a sound model");
    std::fs::write(&path, damaged).unwrap();
    viewer.until_screen("a card with the warning", |screen| warnings(screen) > 100);
    viewer.quit();
}
