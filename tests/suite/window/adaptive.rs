//! Previews of lower resolution while the picture moves, and the whole picture once it rests.

use std::time::Duration;

use image::RgbaImage;
use serde_json::json;

use super::controls::{TILES, on_rail};
use crate::support::Tree;
use crate::support::window::Viewer;

/// No shadow on the ground: what is not the background is the model.
const OPTIONS: [&str; 6] = ["--set", "view.adaptive=on", "--set", "view.msaa=4", "--set", "passes.ground=false"];
const NDF: &str = "brdf/ndf.glsl";
const PARAMS: &str = "user/params.glsl";

/// Fails unless a window without previews draws the same picture, bit by bit. Another mode and back, so that all of it is drawn again.
#[track_caller]
fn is_whole(viewer: &mut Viewer, picture: &RgbaImage) {
    for values in [json!({"view.adaptive": "off", "mode": "shading-normal"}), json!({"mode": "final"})] {
        viewer.running.done(json!({"command": "set", "values": values}));
    }
    viewer.shows(picture, "the picture without previews");
    viewer.running.done(json!({"command": "set", "values": {"view.adaptive": "on"}}));
}

/// A previewed movement ends in the picture that a window without previews draws, bit by bit, and captures in between are whole.
#[test]
fn previews_while_dragging_end_in_the_whole_picture() {
    let mut viewer = Viewer::driven(Tree::new(), &[&["sphere-grid"][..], &OPTIONS].concat());
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
    is_whole(&mut viewer, &in_parts);

    // A capture and a command during a movement see the whole picture.
    viewer.move_mouse((390, 240));
    let captured = viewer.screenshot();
    assert!(captured.dimensions() == (640, 480) && captured != in_parts);
    viewer.move_mouse((400, 250));
    let value = viewer.running.done(json!({"command": "probe", "at": [320, 240], "modes": ["final"]}));
    assert_eq!(value["size"], json!([640, 480]));
    let is_model = |x: u32, y: u32| captured.get_pixel(x, y) != captured.get_pixel(0, 0);
    let is_inside = |[x, y]: [u32; 2]| (x - 6..=x + 6).all(|x| (y - 6..=y + 6).all(|y| is_model(x, y)));
    let pixel = (100..380).flat_map(|y| (100..540).map(move |x| [x, y])).find(|at| is_inside(*at)).unwrap();
    viewer.move_mouse((401, 250));
    let traced = viewer.running.done(json!({"command": "trace", "at": pixel, "file": "pbr.frag"}));
    let proof = traced["proof"]["text"].as_str().unwrap();
    assert!(proof.ends_with("equal to the picture"), "{traced}");

    viewer.running.done(json!({"command": "set", "values": {"view.adaptive": "off"}}));
    places.iter().for_each(|at| viewer.move_mouse(*at));
    viewer.display.xdotool(&["mouseup", "1"]);
    viewer.running.never("previews", Duration::from_millis(300));
    viewer.quit();
}

/// A text that is saved while the mouse drags the camera is drawn whole, whichever parts of the picture before were under way.
#[test]
fn an_edit_interrupts_previews() {
    let mut viewer = Viewer::driven(Tree::new(), &[&["sphere-grid"][..], &OPTIONS].concat());
    viewer.running.event("ready");
    viewer.key("h");
    let still = viewer.screenshot();
    viewer.move_mouse((300, 200));
    viewer.display.xdotool(&["mousedown", "1"]);
    let text = viewer.tree.read(NDF);
    let mut shown = vec![still];
    for (step, new) in
        ["float a2 = alpha;", "float a2 = alpha * alpha * alpha;", "float a2 = alpha * alpha;"].iter().enumerate()
    {
        viewer.move_mouse((320 + 20 * step as u32, 210));
        viewer.tree.write(NDF, &text.replace("float a2 = alpha * alpha;", new));
        viewer.move_mouse((330 + 20 * step as u32, 220));
        let reload = viewer.running.reload(true);
        viewer.running.settled(&reload);
        let picture = viewer.screenshot();
        assert!(!shown.contains(&picture), "step {step} is not shown");
        shown.push(picture);
    }
    let last = shown.pop().unwrap();
    is_whole(&mut viewer, &last);
    viewer.display.xdotool(&["mouseup", "1"]);
    viewer.quit();
}

/// A parameter that D reads has its tables baked anew for each value. While its slider is held, two previews follow a new value: that with
/// the tables of before, and that with its own.
#[test]
fn a_slider_that_bakes_light_has_previews() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    // The row of the parameter is where the panel first differs. The last columns belong to the scroll bar.
    viewer.rests();
    let (before, left) = (viewer.screen(), first.width());
    let member = "    float widened;   //@ui \"Widened\" 0.2..2 = 1.0\n    float roughness_scale;";
    viewer.tree.write(PARAMS, &viewer.tree.edited(PARAMS, "    float roughness_scale;", member));
    viewer.running.reload(true);
    let differs = |screen: &RgbaImage, y: u32| (left..624).any(|x| screen.get_pixel(x, y) != before.get_pixel(x, y));
    let row = |screen: &RgbaImage| TILES.into_iter().find(|y| differs(screen, *y));
    viewer.until_screen("the row of the parameter", |screen| row(screen).is_some());
    viewer.rests();
    let slider = (left, row(&viewer.screen()).unwrap() + 8);
    let include = "#include \"common/math.glsl\"\n#include \"user/params.glsl\"";
    let text = viewer.tree.edited(NDF, "float a2 = alpha * alpha;", "float a2 = alpha * alpha * widened;");
    viewer.tree.write(NDF, &text.replace("#include \"common/math.glsl\"", include));
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    viewer.shows(&first, "the parameter is 1");

    viewer.running.done(json!({"command": "set", "values": {"view.adaptive": "on"}}));
    // A press is one step, once the slider knows of the mouse.
    viewer.move_mouse(on_rail(slider, 0.7));
    viewer.rests();
    viewer.display.xdotool(&["mousedown", "1"]);
    let mut shown = 0;
    viewer.running.until("two previews", |event| {
        shown += event["shown"].as_u64().filter(|_| event["event"] == "previews").unwrap_or(0);
        shown >= 2
    });
    viewer.display.xdotool(&["mouseup", "1"]);
    let value = viewer.running.done(json!({"command": "get", "path": "widened"}));
    assert!(value.as_f64() > Some(1.5), "{value}");
    // The answer comes once the light is baked.
    viewer.running.done(json!({"command": "set", "values": {"view.adaptive": "on"}}));
    let picture = viewer.screenshot();
    assert!(picture != first, "the slider changes nothing");
    is_whole(&mut viewer, &picture);
    viewer.quit();
}
