//! A long session: memory, threads and file descriptors stay as they are. `SPECULA_LONG=1` runs twenty times as many
//! steps.

use std::time::Instant;

use image::RgbaImage;

use super::controls::{TILES, choose, drag_slider};
use crate::support::process::PATIENCE;
use crate::support::window::Viewer;
use crate::support::{Tree, glb, is_long};

const TONEMAP: &str = "tonemap.frag";
/// The window's width, pixels.
const WIDTH: u32 = 640;
/// Memory may grow by this much, in KiB: allocators keep some of what is freed.
const SLACK_KIB: u64 = 16 * 1024;

/// Repeats `step` so many times, or twenty times as often in a long run, and compares what the program holds after two fifths of them with
/// what it holds in the end. Until then the allocator's arenas grow: that of the compiler's thread by 13 MiB from the 10th to the 20th reload,
/// by 5 MiB to the 50th, and by 4 MiB in the next 900.
fn repeat(viewer: &mut Viewer, what: &str, steps: usize, mut step: impl FnMut(&mut Viewer, usize)) {
    let steps = if is_long() { 20 * steps } else { steps };
    let first = steps * 2 / 5;
    (0..first).for_each(|number| step(viewer, number));
    let early = viewer.running.usage();
    (first..steps).for_each(|number| step(viewer, number));
    let mut late = viewer.running.usage();
    // A thread that has sent its result may still be ending, and a file may be written at the moment.
    let deadline = Instant::now() + PATIENCE;
    while (late.threads > early.threads || late.files > early.files) && Instant::now() < deadline {
        viewer.screenshot();
        late = viewer.running.usage();
    }
    println!("{what}: {early:?} after {first}, {late:?} after {steps}");
    assert!(late.memory_kib < early.memory_kib + SLACK_KIB, "{what}: memory grows from {early:?} to {late:?}");
    assert!(late.threads <= early.threads, "{what}: threads grow from {early:?} to {late:?}");
    assert!(late.files <= early.files, "{what}: file descriptors grow from {early:?} to {late:?}");
}

fn open(tree: Tree, more: &[&str]) -> Viewer {
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::sphere(8, 16), &glb::gray())).unwrap();
    Viewer::open(tree, &[&["model.glb"], more].concat())
}

#[test]
fn a_thousand_reloads_keep_nothing() {
    let mut viewer = open(Tree::new(), &[]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let original = viewer.tree.read(TONEMAP);
    let texts = [viewer.tree.edited(TONEMAP, "value *= frame.exposure", "value *= 0.5 * frame.exposure"), original];
    repeat(&mut viewer, "reloads", 50, |viewer, number| {
        viewer.tree.write(TONEMAP, &texts[number % 2]);
        viewer.running.reload(true);
    });
    assert!(viewer.screenshot() == first, "the first text no longer shows the first picture");
    viewer.quit();
}

#[test]
fn two_hundred_drags_of_a_constant_keep_nothing() {
    let mut viewer = open(Tree::new(), &[]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let left = first.width();
    // Panels move until they have their sizes.
    viewer.rests();
    let before = viewer.screen();
    let text = viewer.tree.read(TONEMAP).replace(
        "void main() {",
        "layout(constant_id = USER_CONSTANTS + 16) const float LEVEL = 1.0;   //@ui \"Level\" 0..1\n\nvoid main() {",
    );
    viewer.tree.write(TONEMAP, &text.replace("vec4 scene = texelFetch(", "vec4 scene = LEVEL * texelFetch("));
    viewer.running.reload(true);
    // The new row is where the panel first differs, and all rows below it move. The last columns belong to the scroll bar.
    let differs =
        |screen: &RgbaImage, y: u32| (left..WIDTH - 16).any(|x| screen.get_pixel(x, y) != before.get_pixel(x, y));
    let row = |screen: &RgbaImage| TILES.into_iter().find(|y| differs(screen, *y));
    viewer.until_screen("the constant's row", |screen| row(screen).is_some());
    viewer.rests();
    let y = row(&viewer.screen()).unwrap() + 8;
    // The background alone is left.
    let is_plain = |shot: &RgbaImage| shot.pixels().all(|pixel| pixel == shot.get_pixel(0, 0));
    assert!(!is_plain(&first), "the model is not to be seen");
    repeat(&mut viewer, "drags", 50, |viewer, number| {
        drag_slider(viewer, left, y, (number % 7) as f32 / 7.0);
        viewer.screenshot();
    });
    drag_slider(&viewer, left, y, 0.0);
    viewer.until("the constant at 0", is_plain);
    drag_slider(&viewer, left, y, 1.0);
    viewer.until("the constant's first value", |shot| *shot == first);
    viewer.quit();
}

#[test]
fn twenty_environments_keep_nothing() {
    let mut viewer = open(Tree::new(), &["--size", "640x640", "--env", "studio"]);
    viewer.ready_and_baked();
    repeat(&mut viewer, "environments", 20, |viewer, number| {
        let name = ["furnace", "studio"][number % 2];
        choose(viewer, &format!("environment {name}"));
        viewer.running.until(name, |event| event["event"] == "bake" && event["environment"] == name);
    });
    viewer.quit();
}
