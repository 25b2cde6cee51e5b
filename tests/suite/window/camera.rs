//! The camera follows the mouse, however many movements come before a frame.

use glam::Vec3;
use serde_json::json;

use crate::support::Tree;
use crate::support::window::Viewer;

/// Eye and target after `act`, from the view that frames the model. All of `act` comes before one frame.
fn camera_after(viewer: &mut Viewer, act: impl FnOnce(&Viewer)) -> [Vec3; 2] {
    viewer.running.done(json!({"command": "camera", "frame": true}));
    viewer.move_mouse((200, 240));
    viewer.screenshot();
    viewer.paused(|| act(viewer));
    // A release waits for a frame, and what follows it, too.
    viewer.screenshot();
    viewer.screenshot();
    let camera = viewer.running.done(json!({"command": "camera"}));
    ["eye", "target"].map(|name| {
        let vector: [f32; 3] = serde_json::from_value(camera[name].clone()).unwrap();
        Vec3::from(vector)
    })
}

/// Drags by 180 pixels with a button, in steps.
fn drag(viewer: &Viewer, button: &str, steps: u32) {
    viewer.display.xdotool(&["mousedown", button]);
    (1..=steps).for_each(|step| viewer.move_mouse((200 + 180 * step / steps, 240)));
    viewer.display.xdotool(&["mouseup", button]);
}

#[test]
fn every_movement_of_the_mouse_between_two_frames_counts() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    viewer.key("h");
    let still = camera_after(&mut viewer, |_| {});
    for (button, does) in [("1", "orbits"), ("3", "looks around")] {
        let [once, often] = [1, 30].map(|steps| camera_after(&mut viewer, |viewer| drag(viewer, button, steps)));
        assert!(once != still, "a drag with button {button} {does}");
        for (once, often) in once.into_iter().zip(often) {
            assert!(once.distance(often) < 1e-3 * once.length(), "button {button}: {once} {often}");
        }
    }
    let scrolled = |steps: usize| move |viewer: &Viewer| drop(viewer.display.xdotool(&["click", "4"].repeat(steps)));
    let [one, four] = [1, 4].map(|steps| camera_after(&mut viewer, scrolled(steps)));
    let distance = |[eye, target]: [Vec3; 2]| eye.distance(target);
    let nearer = distance(one) / distance(still);
    assert!((distance(four) / distance(still) - nearer.powi(4)).abs() < 1e-3, "{nearer}, {four:?}");
    viewer.quit();
}
