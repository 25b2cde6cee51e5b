//! The picture beside an earlier one.

use image::RgbaImage;

use super::NDF;
use super::controls::{TILES, WARNING, choose, count};
use crate::support::Tree;
use crate::support::window::Viewer;

const D: &str = "float a2 = alpha * alpha;";

/// Whether two pictures are equal in these columns.
fn same(a: &RgbaImage, b: &RgbaImage, columns: std::ops::Range<u32>) -> bool {
    a.dimensions() == b.dimensions()
        && columns
            .flat_map(|x| (0..a.height()).map(move |y| (x, y)))
            .all(|(x, y)| a.get_pixel(x, y) == b.get_pixel(x, y))
}

/// Opens a window with spheres and returns it with its first picture.
fn open() -> (Viewer, RgbaImage) {
    open_with(&[])
}

fn open_with(more: &[&str]) -> (Viewer, RgbaImage) {
    let mut viewer = Viewer::open(Tree::new(), &[&["sphere-grid"], more].concat());
    viewer.running.event("ready");
    let first = viewer.screenshot();
    (viewer, first)
}

/// Edits D and returns the settled picture.
fn edit(viewer: &mut Viewer, new: &str) -> RgbaImage {
    let text = viewer.tree.read(NDF).replace(D, new);
    viewer.tree.write(NDF, &text);
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    viewer.screenshot()
}

/// Drags as a hand does: with frames before and after the motion.
fn drag(viewer: &mut Viewer, from: (u32, u32), to: (u32, u32)) {
    viewer.move_mouse(from);
    viewer.screenshot();
    viewer.display.xdotool(&["mousedown", "1"]);
    viewer.screenshot();
    viewer.move_mouse(to);
    viewer.screenshot();
    viewer.display.xdotool(&["mouseup", "1"]);
}

#[test]
fn a_kept_picture_stays_left_of_the_border() {
    let (mut viewer, first) = open();
    let (width, height) = first.dimensions();
    let original = viewer.tree.read(NDF);
    let edited = edit(&mut viewer, "float a2 = alpha;");
    assert!(edited != first, "the edit does not show");
    viewer.key("ctrl+k");
    viewer.tree.write(NDF, &original);
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    let middle = width / 2;
    let is_both = |shot: &RgbaImage| same(shot, &edited, 0..middle - 1) && same(shot, &first, middle + 1..width);
    viewer.until("both pictures", is_both);
    // Another mode, so that they are measured once more.
    viewer.key("n");
    let differs = |event: &serde_json::Value| event["event"] == "compared" && event["flip"].as_f64() > Some(0.0);
    let compared = viewer.running.until("a difference", differs);
    assert!(compared["largest"].as_f64() > Some(0.1), "{compared}");
    viewer.key("n");

    // Near an edge of the picture, the border shows little but one of them.
    let bar = 30;
    let at = |x: u32| (x, bar + height / 2);
    let edge = 40;
    drag(&mut viewer, at(middle), at(width - edge));
    viewer.until("the kept picture", |shot| same(shot, &edited, 0..width - edge - 1));
    drag(&mut viewer, at(width - edge), at(edge));
    viewer.until("the picture of now", |shot| same(shot, &first, edge + 1..width));
    viewer.display.xdotool(&["keydown", "space"]);
    viewer.until("the kept picture while Space is held", |shot| *shot == edited);
    viewer.display.xdotool(&["keyup", "space"]);
    viewer.key("ctrl+k");
    viewer.until("the picture alone", |shot| *shot == first);
    viewer.quit();
}

/// A kept picture keeps its mode, and the camera of now.
#[test]
fn a_kept_picture_has_the_mode_that_it_had() {
    let (mut viewer, first) = open();
    let width = first.width();
    viewer.key("ctrl+k");
    viewer.key("n");
    viewer.until("another mode on the right", |shot| {
        same(shot, &first, 0..width / 2 - 1) && !same(shot, &first, width / 2 + 1..width)
    });
    viewer.quit();
}

/// The picture before the last edit follows the mode of now, as soon as its pipelines are built.
/// Compared pictures have one range, so an automatic one would not be that of the older picture alone.
#[test]
fn an_older_version_follows_the_mode() {
    let stored = ["--set", "view.range=mode"];
    let (viewer, d) = open_with(&[&stored[..], &["--mode", "d"]].concat());
    viewer.quit();

    let (mut viewer, _) = open_with(&stored);
    let edited = edit(&mut viewer, "float a2 = alpha;");
    viewer.key("d");
    viewer.until("D after the edit", |shot| *shot != edited);
    viewer.display.xdotool(&["keydown", "space"]);
    viewer.until("D before the edit", |shot| *shot == d);
    viewer.display.xdotool(&["keyup", "space"]);
    viewer.quit();
}

/// Only after a question, and only where a version differs.
#[test]
fn an_older_version_is_written_to_the_files() {
    let (mut viewer, first) = open();
    let original = viewer.tree.read(NDF);
    // Bytes that the compiler does not see stay.
    let mark = "\u{feff}";
    edit(&mut viewer, "float a2 = alpha;");
    let text = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &format!("{mark}{text}"));
    choose(&viewer, "write version 1");
    let row = |screen: &RgbaImage| TILES.rev().find(|y| count(screen, 0..230, *y..y + 1, WARNING) > 0);
    viewer.until_screen("the question", |screen| row(screen).is_some());
    assert!(viewer.tree.read(NDF).contains("float a2 = alpha;"), "written without an answer");
    // The answers are below the question, "Write" on the left. They move until the panel has its width.
    let written = format!("{mark}{original}");
    for _ in 0..20 {
        if let Some(last) = row(&viewer.screen()) {
            viewer.click((22, last + 16));
        }
        viewer.screenshot();
        if viewer.tree.read(NDF) == written {
            break;
        }
    }
    assert_eq!(viewer.tree.read(NDF), written);
    // A narrow window shows one side of the picture: now the other one again.
    choose(&viewer, "panel parameters");
    viewer.until("the first picture", |shot| *shot == first);
    viewer.quit();
}

/// The numeric keypad looks from the sides.
#[test]
fn the_keypad_sees_the_model_from_its_sides() {
    let mut viewer =
        Viewer::open(Tree::new(), &["sphere-grid", "--set", "camera.azimuth=0", "--set", "camera.elevation=0"]);
    viewer.running.event("ready");
    let front = viewer.screenshot();
    viewer.key("KP_3");
    viewer.until("the right side", |shot| *shot != front);
    viewer.key("KP_1");
    viewer.until("the front", |shot| *shot == front);
    viewer.quit();
}

/// A loop that does not end is not shown again.
#[test]
fn space_passes_over_a_loop_that_does_not_end() {
    let (mut viewer, first) = open();
    let original = viewer.tree.read(NDF);
    let endless = format!("float x = alpha;\n    while (x < 2.0) x *= 0.5;\n    {D}");
    viewer.tree.write(NDF, &original.replace(D, &endless));
    viewer.running.event("diagnostic");
    viewer.tree.write(NDF, &original);
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    let edited = edit(&mut viewer, "float a2 = alpha;");
    assert!(edited != first, "the edit does not show");
    viewer.display.xdotool(&["keydown", "space"]);
    viewer.until("the picture before the edit", |shot| *shot == first);
    viewer.display.xdotool(&["keyup", "space"]);
    viewer.until("the edit", |shot| *shot == edited);

    // The version before the edit is the loop's, so the picture before that is shown.
    viewer.tree.write(NDF, &original.replace(D, &endless));
    viewer.running.event("diagnostic");
    let repaired = original.replace(D, "float a2 = 0.5 * alpha;");
    viewer.tree.write(NDF, &repaired);
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    viewer.display.xdotool(&["keydown", "space"]);
    viewer.until("the picture before the loop", |shot| *shot == edited);
    viewer.display.xdotool(&["keyup", "space"]);
    viewer.quit();
}
