//! The arrangement of the panels, and the command palette.

use super::controls::choose;
use crate::support::Tree;
use crate::support::window::Viewer;

const LAYOUT: &str = "state/specula/layout.json";

fn open(layout: Option<&str>) -> Viewer {
    let tree = Tree::new();
    if let Some(text) = layout {
        std::fs::create_dir_all(tree.beside("state/specula")).unwrap();
        std::fs::write(tree.beside(LAYOUT), text).unwrap();
    }
    let mut viewer = Viewer::open(tree, &["sphere-grid", "--size", "1000x480"]);
    viewer.running.event("ready");
    viewer
}

/// The stored arrangement, once it is there and another than `before`.
fn stored(viewer: &mut Viewer, before: &str) -> String {
    let path = viewer.tree.beside(LAYOUT);
    let read = || std::fs::read_to_string(&path).unwrap_or_default();
    viewer.until("the stored arrangement", |_| !read().is_empty() && read() != before);
    read()
}

#[test]
fn the_arrangement_of_the_panels_lasts() {
    let mut viewer = open(None);
    let first = viewer.screenshot().width();
    // Between the picture and the panels on its right.
    let edge = 236 + 3 + first;
    viewer.move_mouse((edge, 200));
    viewer.display.xdotool(&["mousedown", "1"]);
    viewer.screenshot();
    viewer.move_mouse((edge - 80, 200));
    viewer.screenshot();
    viewer.display.xdotool(&["mouseup", "1"]);
    viewer.until("a narrower picture", |shot| shot.width().abs_diff(first - 80) < 6);
    let narrow = viewer.screenshot().width();
    let text = stored(&mut viewer, "");
    viewer.quit();

    let mut viewer = open(Some(&text));
    assert_eq!(viewer.screenshot().width(), narrow, "the width of the panels is forgotten");
    choose(&viewer, "layout look");
    viewer.until("a wider picture", |shot| shot.width() > first + 150);
    let wide = viewer.screenshot().width();
    let text = stored(&mut viewer, &text);
    viewer.quit();

    let mut viewer = open(Some(&text));
    assert_eq!(viewer.screenshot().width(), wide, "the arrangement is forgotten");
    // The panels keep their width in another window, and the picture takes the rest.
    viewer.resize(900, 480);
    assert_eq!(viewer.screenshot().width(), wide - 100);
    viewer.quit();

    // What is no arrangement costs nothing.
    let mut viewer = open(Some("{\"root\": 7}"));
    assert_eq!(viewer.screenshot().width(), first);
    viewer.quit();
}

#[test]
fn the_palette_reaches_modes_switches_and_commands() {
    let mut viewer = open(None);
    let picture = viewer.screenshot();
    viewer.key("n");
    viewer.until("shading normals, by their key", |shot| *shot != picture);
    let normals = viewer.screenshot();
    viewer.key("n");
    viewer.until("the picture", |shot| *shot == picture);
    // The letters are the search's, from the moment that it opens: none of them chooses a mode or hides the panels.
    choose(&viewer, "shading normal");
    viewer.until("shading normals, by their name", |shot| *shot == normals);
    choose(&viewer, "final");
    viewer.until("the picture, by its name", |shot| *shot == picture);
    choose(&viewer, "film turn on");
    viewer.until("a pass that is switched on", |shot| shot.dimensions() == picture.dimensions() && *shot != picture);
    choose(&viewer, "undo");
    viewer.until("the picture, undone", |shot| *shot == picture);
    choose(&viewer, "hide panels");
    viewer.until("the whole window", |shot| shot.dimensions() == (1000, 480));
    viewer.key("h");
    // Nothing is chosen by words that no entry has, and Escape closes the palette alone.
    choose(&viewer, "no such entry");
    viewer.key("ctrl+p");
    viewer.key("Escape");
    viewer.until("the picture, as before", |shot| *shot == picture);
    viewer.quit();
}
