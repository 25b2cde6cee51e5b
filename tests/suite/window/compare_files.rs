//! The picture beside one from a file, and beside that of a second shader tree.

use std::path::{Path, PathBuf};

use image::{Rgba, Rgba32FImage, RgbaImage};
use serde_json::{Value, json};

use super::NDF;
use super::controls::{choose, count};
use crate::support::window::Viewer;
use crate::support::xdnd::drop_file;
use crate::support::{Tree, open_image};

const RED: Rgba<u8> = Rgba([255, 0, 0, 255]);
const D: &str = "float a2 = alpha * alpha;";

/// Opens a window that takes commands, and writes its picture to `own.png`.
fn open(tree: Tree, more: &[&str]) -> (Viewer, RgbaImage) {
    let mut viewer = Viewer::driven(tree, &[&["sphere-grid"], more].concat());
    viewer.running.event("ready");
    viewer.running.done(json!({"command": "capture", "file": "own.png"}));
    let own = open_image(&viewer.tree.beside("own.png")).into_rgba8();
    (viewer, own)
}

/// The picture on screen, both sides of it.
fn shot(viewer: &mut Viewer) -> RgbaImage {
    viewer.running.done(json!({"command": "capture", "file": "shot.png"}));
    open_image(&viewer.tree.beside("shot.png")).into_rgba8()
}

/// The difference of the next measurement.
fn compared(viewer: &mut Viewer) -> (f64, f64) {
    let event = viewer.running.event("compared");
    (event["flip"].as_f64().unwrap(), event["largest"].as_f64().unwrap())
}

fn same(a: &RgbaImage, b: &RgbaImage, columns: std::ops::Range<u32>) -> bool {
    a.dimensions() == b.dimensions()
        && columns
            .flat_map(|x| (0..a.height()).map(move |y| (x, y)))
            .all(|(x, y)| a.get_pixel(x, y) == b.get_pixel(x, y))
}

/// A picture with a red rectangle around its middle.
fn marked(own: &RgbaImage) -> RgbaImage {
    let mut marked = own.clone();
    let (width, height) = own.dimensions();
    for (x, y) in (width / 4..width * 3 / 4).flat_map(|x| (height / 4..height / 2).map(move |y| (x, y))) {
        marked.put_pixel(x, y, RED);
    }
    marked
}

#[test]
fn a_picture_from_a_file_takes_its_side_and_follows_the_file() {
    let (mut viewer, own) = open(Tree::new(), &[]);
    let (width, _) = own.dimensions();
    let file = viewer.tree.beside("marked.png");
    marked(&own).save(&file).unwrap();

    // Itself: no difference at all.
    let result = viewer.running.done(json!({"command": "compare", "file": "own.png"}));
    assert_eq!(result["file"].as_str(), viewer.tree.beside("own.png").to_str());
    assert_eq!((&result["is_on"], &result["note"]), (&json!(true), &Value::Null), "{result}");
    assert_eq!(compared(&mut viewer), (0.0, 0.0));

    // Another picture, and the border that moves.
    viewer.running.done(json!({"command": "compare", "file": "marked.png", "wipe": 0.5}));
    let (flip, largest) = compared(&mut viewer);
    assert!(flip > 0.01 && largest > 0.3, "{flip} {largest}");
    let both = shot(&mut viewer);
    let middle = width / 2;
    assert!(same(&both, &marked(&own), 0..middle) && same(&both, &own, middle + 1..width));
    viewer.running.done(json!({"command": "compare", "wipe": 1.0}));
    assert!(shot(&mut viewer) == marked(&own), "the file alone");

    // Neither a missing nor a damaged file costs the comparison.
    let message = viewer.running.refused(json!({"command": "compare", "file": "missing.png"}));
    assert!(message.contains("missing.png"), "{message}");
    assert!(shot(&mut viewer) == marked(&own), "a missing file changed the picture");
    std::fs::write(&file, b"\x89PNG\r\n").unwrap();
    viewer.running.until("why it is not shown", |event| {
        event["event"] == "message" && event["message"].as_str().is_some_and(|text| text.contains("marked.png"))
    });
    assert!(shot(&mut viewer) == marked(&own), "a damaged file changed the picture");

    // The file is watched.
    own.save(&file).unwrap();
    assert_eq!(compared(&mut viewer), (0.0, 0.0));
    assert!(shot(&mut viewer) == own, "the new file");
    viewer.running.done(json!({"command": "compare", "with": "nothing"}));
    viewer.quit();
}

/// The option, the palette, and a picture of another shape.
#[test]
fn a_picture_of_another_size_is_scaled() {
    let tree = Tree::new();
    let wide = RgbaImage::from_pixel(400, 100, RED);
    wide.save(tree.beside("wide.png")).unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid", "--compare", "wide.png"]);
    viewer.running.event("ready");
    let (flip, _) = compared(&mut viewer);
    assert!(flip > 0.1, "{flip}");
    let result = viewer.running.done(json!({"command": "compare", "wipe": 1.0}));
    let note = result["note"].as_str().unwrap();
    assert!(note.contains("400 x 100 pixels, scaled to"), "{note}");
    let shot = shot(&mut viewer);
    let (width, height) = shot.dimensions();
    let red = |x: u32, y: u32| *shot.get_pixel(x, y) == RED;
    assert!(red(0, height / 2) && red(width - 1, height / 2), "as wide as the picture");
    let rows = (0..height).filter(|y| red(width / 2, *y)).count();
    assert!(rows.abs_diff(width as usize / 4) <= 1, "{rows} rows of {width} columns");
    assert_eq!(shot.get_pixel(0, 0), &Rgba([0, 0, 0, 255]), "nothing is there");
    choose(&viewer, "stop comparing");
    viewer.until("the picture alone", |shot| shot.pixels().all(|pixel| *pixel != RED));
    viewer.quit();
}

/// The raw values of a picture give the picture again: they go through its exposure and tone map.
#[test]
fn light_from_a_file_is_tone_mapped_as_the_picture() {
    let (mut viewer, own) = open(Tree::new(), &["--set", "view.dither=false"]);
    let (width, height) = own.dimensions();
    let size = [width, height];
    viewer.running.done(json!({"command": "capture", "file": "own.exr", "size": size}));
    viewer.running.done(json!({"command": "compare", "file": "own.exr", "wipe": 1.0}));
    let (flip, largest) = compared(&mut viewer);
    // The window's own floats are half as long.
    assert!(flip < 0.01 && largest < 0.02, "{flip} {largest}");
    assert!(!same(&shot(&mut viewer), &RgbaImage::new(width, height), 0..width));
    viewer.running.done(json!({"command": "set", "values": {"view.ev": 3}}));
    let (flip, largest) = compared(&mut viewer);
    assert!(flip < 0.01 && largest < 0.02, "darker: {flip} {largest}");

    // Twice the light is brighter than the picture.
    let path = viewer.tree.beside("own.exr");
    let mut light: Rgba32FImage = open_image(&path).into_rgba32f();
    light.pixels_mut().for_each(|pixel| (0..3).for_each(|c| pixel[c] *= 2.0));
    light.save(&path).unwrap();
    let (flip, largest) = compared(&mut viewer);
    assert!(flip > 0.01 && largest > 0.05, "{flip} {largest}");
    viewer.quit();
}

/// A picture that is dropped takes part, while pictures are compared.
#[test]
fn a_dropped_picture_is_compared_with() {
    let (mut viewer, own) = open(Tree::new(), &[]);
    let file = viewer.tree.beside("dropped.png");
    RgbaImage::from_pixel(own.width(), own.height(), RED).save(&file).unwrap();
    viewer.running.done(json!({"command": "compare", "with": "picture", "wipe": 1.0}));
    let (display, window) = (viewer.display.name().to_owned(), viewer.window());
    drop_file(&display, window, (300, 200), &file);
    viewer.until("the dropped picture", |shot| shot.pixels().all(|pixel| *pixel == RED));
    // The name of the file stands below its side.
    let is_named = |screen: &RgbaImage| count(screen, 250..640, 400..460, [220, 220, 220]) > 20;
    viewer.until_screen("the name of the file", is_named);
    viewer.quit();
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &target),
            false => _ = std::fs::copy(entry.path(), target).unwrap(),
        }
    }
}

/// A copy of the tree with another D. Returns its folder and the texts of D before and after.
fn second(tree: &Tree) -> (PathBuf, String, String) {
    let folder = tree.beside("second");
    copy(&tree.root(), &folder);
    let original = tree.read(NDF);
    assert!(original.contains(D));
    let edited = original.replace(D, "float a2 = alpha;");
    std::fs::write(folder.join(NDF), &edited).unwrap();
    (folder, original, edited)
}

#[test]
fn a_second_tree_draws_its_side_and_is_reloaded() {
    let (mut viewer, own) = open(Tree::new(), &["--env", "furnace"]);
    let width = own.width();
    let (folder, original, edited) = second(&viewer.tree);
    let broken = edited.replace("float a2 = alpha;", "float a2 = alfa;");

    // A tree with errors is compared with once it compiles.
    std::fs::write(folder.join(NDF), &broken).unwrap();
    let message = viewer.running.refused(json!({"command": "compare", "tree": "second"}));
    assert!(message.contains("second has errors") && message.contains("alfa"), "{message}");
    assert!(shot(&mut viewer) == own, "a broken tree changed the picture");
    std::fs::write(folder.join(NDF), &edited).unwrap();
    let (flip, _) = compared(&mut viewer);
    let result = viewer.running.done(json!({"command": "compare", "wipe": 0.5}));
    assert_eq!(result["tree"], "second", "{result}");
    assert!(flip > 0.001, "{flip}");
    let both = shot(&mut viewer);
    let middle = width / 2;
    assert!(same(&both, &own, middle + 1..width), "the first tree's side changed");
    assert!(!same(&both, &own, 0..middle), "the second tree's side has no edit");
    viewer.running.done(json!({"command": "compare", "wipe": 1.0}));
    let other = shot(&mut viewer);

    // An edit with an error is told, and the side stays.
    std::fs::write(folder.join(NDF), &broken).unwrap();
    viewer.running.until("the error", |event| {
        let message = event["message"].as_str().unwrap_or_default();
        event["event"] == "message" && message.contains("second") && message.contains("alfa")
    });
    assert!(shot(&mut viewer) == other, "a broken edit changed the picture");

    // An edit is reloaded: now both trees are the same. So are their pictures.
    std::fs::write(folder.join(NDF), &original).unwrap();
    viewer.running.until("no difference", |event| event["event"] == "compared" && event["largest"] == json!(0.0));
    assert!(shot(&mut viewer) == own, "the same shaders draw another picture");

    // It follows the settings.
    std::fs::write(folder.join(NDF), &edited).unwrap();
    viewer.until("the first edit again", |shot| *shot == other);
    viewer.running.done(json!({"command": "mode", "name": "d"}));
    viewer.until("D of the second tree", |shot| *shot != other && *shot != own);
    let message = viewer.running.refused(json!({"command": "compare", "tree": "nowhere"}));
    assert!(message.contains("nowhere: there is no such file or folder"), "{message}");
    viewer.quit();
}

/// What the second tree bakes differs, so the thread bakes it.
#[test]
fn a_second_tree_has_its_own_light() {
    let tree = Tree::new();
    let (_, original, edited) = second(&tree);
    tree.write(NDF, &edited);
    let (viewer, expected) = open(tree, &["--env", "studio", "--lights", "none"]);
    viewer.quit();

    let tree = Tree::new();
    second(&tree);
    assert_eq!(tree.read(NDF), original);
    let (mut viewer, own) = open(tree, &["--env", "studio", "--lights", "none", "--compare-tree", "second"]);
    viewer.running.event("compared");
    viewer.running.done(json!({"command": "compare", "wipe": 1.0}));
    let other = shot(&mut viewer);
    assert!(other != own, "the light of the second tree is that of the first");
    assert!(other == expected, "the second tree looks otherwise than alone");
    viewer.quit();
}

/// A version that is put back into its files is told once they are written.
#[test]
fn a_version_is_answered_when_it_is_written() {
    let (mut viewer, _) = open(Tree::new(), &[]);
    let original = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &original.replace(D, "float a2 = alpha;"));
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    let edited = viewer.tree.read(NDF);
    viewer.running.done(json!({"command": "versions", "write": 1}));
    assert_eq!(viewer.tree.read(NDF), original);
    // It is a step, as what Source and the sliders write.
    viewer.running.done(json!({"command": "undo"}));
    assert_eq!(viewer.tree.read(NDF), edited);
    viewer.quit();
}
