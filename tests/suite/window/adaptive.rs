//! Previews of lower resolution while the picture moves, and the whole picture once it rests.

use std::time::Duration;

use serde_json::json;

use crate::support::Tree;
use crate::support::window::Viewer;

/// A previewed movement ends in the picture that a window without previews draws, bit by bit, and captures in between are whole.
#[test]
fn previews_while_dragging_end_in_the_whole_picture() {
    let options = ["--size", "640x480", "--set", "view.adaptive=on", "--set", "view.msaa=4"];
    let mut viewer = Viewer::driven(Tree::new(), &[&["sphere-grid"][..], &options].concat());
    viewer.running.event("ready");
    viewer.key("h");
    let still = viewer.screenshot();
    let places = [(300, 200), (330, 210), (350, 230), (370, 220)];
    viewer.move_mouse(places[0]);
    viewer.display.xdotool(&["mousedown", "1"]);
    places[1..].iter().for_each(|at| viewer.move_mouse(*at));
    // The mouse rests, with its button down.
    let moved = viewer.running.event("previews");
    assert!(moved["shown"].as_u64() > Some(0) && moved["whole_ms"].as_f64() > Some(0.0), "{moved}");
    let (width, height) = (moved["size"][0].as_u64(), moved["size"][1].as_u64());
    assert!(width < Some(640) && height < Some(480), "{moved}");
    let in_parts = viewer.screenshot();
    assert!(in_parts.dimensions() == (640, 480) && in_parts != still, "the drag has not turned the camera");
    // Another mode and back, so that all is drawn again.
    for values in [json!({"view.adaptive": "off", "mode": "shading-normal"}), json!({"mode": "final"})] {
        viewer.running.done(json!({"command": "set", "values": values}));
    }
    viewer.shows(&in_parts, "the picture without previews");
    viewer.running.done(json!({"command": "set", "values": {"view.adaptive": "on"}}));

    // A capture and a command during a movement see the whole picture.
    viewer.move_mouse((390, 240));
    let captured = viewer.screenshot();
    assert!(captured.dimensions() == (640, 480) && captured != in_parts);
    viewer.move_mouse((400, 250));
    let value = viewer.running.done(json!({"command": "probe", "at": [320, 240], "modes": ["final"]}));
    assert_eq!(value["size"], json!([640, 480]));

    viewer.running.done(json!({"command": "set", "values": {"view.adaptive": "off"}}));
    places.iter().for_each(|at| viewer.move_mouse(*at));
    viewer.display.xdotool(&["mouseup", "1"]);
    viewer.running.never("previews", Duration::from_millis(300));
    viewer.quit();
}
