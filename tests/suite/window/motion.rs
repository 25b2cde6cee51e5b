//! Models that move in a window, and edits of shaders while they do.

use image::RgbaImage;
use serde_json::json;

use crate::support::window::Viewer;
use crate::support::{Tree, glb};

const HOOK: &str = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
const RED: &str = "s.base_color = vec3(1.0, 0.0, 0.0);";
const GREEN: &str = "s.base_color = vec3(0.0, 1.0, 0.0);";

/// Where the square of this color is in a picture of 4 m from top to bottom, meters to the right of the center.
fn place(picture: &RgbaImage, color: [u8; 3]) -> Option<f64> {
    let is = |pixel: &image::Rgba<u8>| pixel.0.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 8);
    let columns: Vec<u32> =
        picture.enumerate_pixels().filter(|(.., pixel)| is(pixel)).map(|(column, ..)| column).collect();
    let meters = 4.0 / f64::from(picture.height());
    let is_square = columns.len() as f64 * meters * meters > 0.9;
    let mean = columns.iter().map(|column| f64::from(*column) + 0.5).sum::<f64>() / columns.len() as f64;
    is_square.then(|| (mean - f64::from(picture.width()) / 2.0) * meters)
}

/// Takes pictures until a square of this color has been at three places more.
#[track_caller]
fn goes_on(viewer: &mut Viewer, color: [u8; 3]) {
    let mut places: Vec<f64> = Vec::new();
    viewer.until("three places of the square", |picture| {
        if let Some(at) = place(picture, color).filter(|at| places.iter().all(|known| (known - at).abs() > 0.05)) {
            places.push(at);
        }
        places.len() == 3
    });
}

/// Neither an edit nor a broken one stops the clock or sets it back, and the picture follows both the shaders and the pose.
#[test]
fn an_edit_keeps_an_animation_playing() {
    let (red, green) = ([255, 0, 0], [0, 255, 0]);
    let tree = Tree::new();
    std::fs::write(tree.beside("moving.glb"), glb::moving_quad()).unwrap();
    tree.write("user.glsl", &tree.edited("user.glsl", HOOK, &format!("{HOOK}\n    {RED}")));
    let options =
        "--mode base-color --background #000000 --lights none --set camera.height=4 --eye 0,0,9 --target 0,0,0";
    let options: Vec<&str> = ["moving.glb"].into_iter().chain(options.split(' ')).collect();
    let mut viewer = Viewer::driven(tree, &options);
    viewer.running.event("ready");
    let time = |viewer: &mut Viewer| {
        let clock = viewer.running.done(json!({ "command": "playback" }));
        assert!(clock["is_animated"] == true && clock["paused"] == false, "{clock}");
        clock["time"].as_f64().unwrap()
    };
    goes_on(&mut viewer, red);
    let before = time(&mut viewer);
    viewer.tree.write("user.glsl", &viewer.tree.edited("user.glsl", RED, GREEN));
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    let edited = time(&mut viewer);
    assert!(edited > before, "the clock went from {before} s to {edited} s");
    goes_on(&mut viewer, green);

    viewer.tree.write("user.glsl", &viewer.tree.edited("user.glsl", GREEN, "s.base_color = wrong;"));
    viewer.running.reload(false);
    goes_on(&mut viewer, green);
    let broken = time(&mut viewer);
    assert!(broken > edited, "the clock went from {edited} s to {broken} s");
    viewer.tree.write("user.glsl", &viewer.tree.edited("user.glsl", "s.base_color = wrong;", RED));
    viewer.running.reload(true);
    goes_on(&mut viewer, red);

    for (time, expected) in [(7.25, -0.5), (8.75, 0.5)] {
        viewer.running.done(json!({ "command": "playback", "paused": true, "time": time }));
        let at = place(&viewer.screenshot(), red).unwrap_or(f64::NAN);
        assert!(
            (at - expected).abs() < 0.02,
            "the square is {at} m right of the center at {time} s, expected {expected}"
        );
    }
    // A look that names no clips, as one of a model that stands still, leaves the chosen ones.
    viewer.running.done(json!({ "command": "set", "values": { "animation.clips": "jump" } }));
    let look = viewer.tree.beside("still.toml");
    std::fs::write(&look, "[view]\nev = 1.0\n").unwrap();
    viewer.running.done(json!({ "command": "open", "look": look }));
    let get = |path: &str| json!({ "command": "get", "path": path });
    assert_eq!(viewer.running.done(get("view.ev")), json!(1.0));
    assert_eq!(viewer.running.done(get("animation.clips")), json!(["jump"]));
    viewer.quit();
}
