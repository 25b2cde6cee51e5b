//! Previews of lower resolution while the picture moves, and the whole picture once it rests.

use std::time::Duration;

use image::RgbaImage;
use serde_json::{Value, json};

use super::controls::{TILES, WARNING, choose, count, is_about, on_rail};
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
    assert!(proof.starts_with("equal to the picture"), "{traced}");

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

/// Declares a parameter. Returns the place of its slider: the left edge of the panel, and its row.
fn slider_of(viewer: &mut Viewer, member: &str) -> (u32, u32) {
    let left = viewer.screenshot().width();
    // The row of the parameter is where the panel first differs. The last columns belong to the scroll bar.
    viewer.rests();
    let before = viewer.screen();
    let member = format!("    {member}\n    float roughness_scale;");
    viewer.tree.write(PARAMS, &viewer.tree.edited(PARAMS, "    float roughness_scale;", &member));
    viewer.running.reload(true);
    let differs = |screen: &RgbaImage, y: u32| (left..624).any(|x| screen.get_pixel(x, y) != before.get_pixel(x, y));
    let row = |screen: &RgbaImage| TILES.into_iter().find(|y| differs(screen, *y));
    viewer.until_screen("the row of the parameter", |screen| row(screen).is_some());
    viewer.rests();
    (left, row(&viewer.screen()).unwrap() + 8)
}

/// A parameter that D reads has its tables baked anew for each value. While its slider is held, two previews follow a new value: that with
/// the tables of before, and that with its own.
#[test]
fn a_slider_that_bakes_light_has_previews() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    let slider = slider_of(&mut viewer, "float widened;   //@ui \"Widened\" 0.2..2 = 1.0");
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

/// Makes a line the first of `user_surface`.
fn add_to_hook(tree: &Tree, line: &str) {
    let hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    tree.write("user.glsl", &tree.edited("user.glsl", hook, &format!("{hook}\n    {line}")));
}

/// Drags along places with the mouse until the whole picture follows the previews, and holds the button.
#[track_caller]
fn previews_of_drag(viewer: &mut Viewer, places: &[(u32, u32)]) {
    viewer.move_mouse(places[0]);
    viewer.rests();
    viewer.display.xdotool(&["mousedown", "1"]);
    places[1..].iter().for_each(|at| viewer.move_mouse(*at));
    let moved = viewer.running.event("previews");
    assert!(moved["shown"].as_u64() > Some(0), "{moved}");
}

#[test]
fn a_slider_has_previews() {
    let mut viewer = Viewer::driven(Tree::new(), &[&["sphere-grid"][..], &OPTIONS].concat());
    viewer.running.event("ready");
    let slider = slider_of(&mut viewer, "float faded; //@ui \"Faded\" 0..1 = 0.0");
    add_to_hook(&viewer.tree, "s.base_color *= 1.0 - faded;");
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    let still = viewer.screenshot();
    previews_of_drag(&mut viewer, &[0.2, 0.4, 0.6, 0.8].map(|value| on_rail(slider, value)));
    let value = viewer.running.done(json!({"command": "get", "path": "faded"}));
    assert!(value.as_f64() > Some(0.5), "{value}");
    let picture = viewer.screenshot();
    assert!(picture != still, "the slider changes nothing");
    viewer.display.xdotool(&["mouseup", "1"]);
    is_whole(&mut viewer, &picture);
    viewer.quit();
}

/// Where the handle of a white light is: a disk in a ring.
fn handle(screen: &RgbaImage) -> Option<(u32, u32)> {
    // The center lies between pixels.
    let is_around = |(x, y): (u32, u32), radius: u32, color: [u8; 3]| {
        let is = |x: u32, y: u32| is_about(screen.get_pixel(x, y), color);
        let radii = radius..=radius + 1;
        let along = |is: &dyn Fn(u32) -> bool| radii.clone().any(is);
        along(&|r| is(x - r, y)) && along(&|r| is(x + r, y)) && along(&|r| is(x, y - r)) && along(&|r| is(x, y + r))
    };
    let places = TILES.flat_map(|y| (12..628).map(move |x| (x, y)));
    { places }.find(|at| is_around(*at, 5, [255; 3]) && is_around(*at, 9, SELECTION))
}

/// The ring around what is selected, as `src/app/widgets/theme.rs` has it.
const SELECTION: [u8; 3] = [255, 160, 48];

#[test]
fn the_handle_of_a_light_has_previews() {
    let mut viewer = Viewer::driven(Tree::new(), &[&["sphere-grid"][..], &OPTIONS].concat());
    viewer.running.event("ready");
    choose(&viewer, "place the rectangular light");
    let (x, y) = handle(&viewer.until_screen("the handle", |screen| handle(screen).is_some())).unwrap();
    let before = viewer.running.done(json!({"command": "get", "path": "lights.rect.azimuth"}));
    let still = viewer.screenshot();
    previews_of_drag(&mut viewer, &[0, 10, 20, 30].map(|step| (x + 2 * step, y + step)));
    let after = viewer.running.done(json!({"command": "get", "path": "lights.rect.azimuth"}));
    assert_ne!(after, before, "the light has not moved");
    let picture = viewer.screenshot();
    assert!(picture != still, "the light changes nothing");
    viewer.display.xdotool(&["mouseup", "1"]);
    is_whole(&mut viewer, &picture);
    viewer.quit();
}

/// While the clock runs there is a preview of each time, and once it stands the whole picture.
#[test]
fn an_animation_has_previews() {
    let tree = Tree::new();
    add_to_hook(&tree, "s.base_color *= 0.5 + 0.5 * sin(9.0 * frame.time_s);");
    let mut viewer = Viewer::driven(tree, &[&["sphere-grid"][..], &OPTIONS].concat());
    viewer.running.event("ready");
    let model = |screen: &RgbaImage| (200..280).map(|y| *screen.get_pixel(150, y)).collect::<Vec<_>>();
    for _ in 0..3 {
        let before = model(&viewer.screen());
        viewer.until_screen("another time", |screen| model(screen) != before);
    }
    viewer.running.say(r#"{"id": "pause", "command": "playback", "paused": true}"#);
    let (mut shown, mut is_paused) = (0, false);
    viewer.running.until("the previews, and the answer", |event| {
        shown += event["shown"].as_u64().filter(|_| event["event"] == "previews").unwrap_or(0);
        is_paused |= event["id"] == "pause" && event["event"] == "done";
        is_paused && shown >= 3
    });
    let picture = viewer.screenshot();
    is_whole(&mut viewer, &picture);
    viewer.quit();
}

/// Whether the mark of a preview is shown, in the lower right of the picture with this width.
fn has_mark(screen: &RgbaImage, width: u32) -> bool {
    count(screen, width - 180..width, TILES.end - 60..TILES.end, WARNING) > 20
}

/// Fails if a whole picture was drawn before the program answers: it answers while the picture is under way.
#[track_caller]
fn answers_before_whole(viewer: &mut Viewer) {
    viewer.running.say(r#"{"id": "now", "command": "get", "path": "mode"}"#);
    let mut is_whole = false;
    let answer = viewer.running.until("the answer", |event| {
        is_whole |= event["event"] == "previews" || event["id"] == "traced";
        event["id"] == "now"
    });
    assert!(answer["result"] == "path-traced" && !is_whole, "it answers once the picture is whole: {answer}");
}

/// A frame of path tracing takes seconds. Meanwhile the window shows previews, which follow the mouse, and answers.
#[test]
fn a_window_never_waits_for_path_tracing() {
    let mut viewer =
        Viewer::driven(Tree::new(), &["shader-ball", "--set", "view.adaptive=on", "--set", "view.bounces=8"]);
    viewer.running.event("ready");
    let width = viewer.screenshot().width();
    assert!(!has_mark(&viewer.screen(), width));
    viewer.running.say(r#"{"id": "traced", "command": "set", "values": {"mode": "path-traced"}}"#);
    viewer.until_screen("a preview", |screen| has_mark(screen, width));
    answers_before_whole(&mut viewer);
    let model = |screen: &RgbaImage| (150..330).map(|y| *screen.get_pixel(150, y)).collect::<Vec<_>>();
    viewer.move_mouse((100, 200));
    viewer.display.xdotool(&["mousedown", "1"]);
    for x in [140, 180, 220] {
        let before = model(&viewer.screen());
        viewer.move_mouse((x, 200));
        viewer.until_screen("a turned preview", |screen| model(screen) != before && has_mark(screen, width));
        answers_before_whole(&mut viewer);
    }
    viewer.display.xdotool(&["mouseup", "1"]);
    let moved = viewer.running.event("previews");
    assert!(moved["shown"].as_u64() >= Some(3), "{moved}");
    viewer.until_screen("the whole picture", |screen| !has_mark(screen, width));
    viewer.quit();
}

/// Values of a pinned pixel and thumbnails are those of whole pictures: none of them is drawn while the mouse moves.
#[test]
fn values_and_thumbnails_wait_for_the_whole_picture() {
    let options = ["--size", "1000x700", "sphere-grid"];
    let mut viewer = Viewer::driven(Tree::new(), &[&options[..], &OPTIONS].concat());
    viewer.running.event("ready");
    viewer.running.event("thumbnails");
    choose(&viewer, "panel inspector");
    viewer.screenshot();
    viewer.click((420, 330));
    let before = viewer.running.event("inspected");
    viewer.rests();
    viewer.move_mouse((400, 300));
    // Events before this answer are those of the picture before.
    viewer.running.done(json!({"command": "get", "path": "mode"}));
    viewer.display.xdotool(&["mousedown", "1"]);
    let mut early: Vec<Value> = Vec::new();
    for x in [410, 420, 430, 440] {
        viewer.move_mouse((x, 310));
    }
    let moved = viewer.running.until("previews", |event| {
        early.extend(["inspected", "thumbnails"].iter().any(|kind| event["event"] == *kind).then(|| event.clone()));
        event["event"] == "previews"
    });
    assert!(early.is_empty() && moved["shown"].as_u64() > Some(0), "{early:?} before {moved}");
    let (mut values, mut has_thumbnails) = (None, false);
    viewer.running.until("values and thumbnails of the whole picture", |event| {
        values = Some(event.clone()).filter(|event| event["event"] == "inspected").or(values.take());
        has_thumbnails |= event["event"] == "thumbnails";
        values.is_some() && has_thumbnails
    });
    let (values, at) = (values.unwrap(), &before["pixel"]);
    assert_eq!(values["pixel"], *at, "{values}");
    let modes = ["position", "n-dot-v", "roughness"];
    assert_ne!(values["modes"]["position"], before["modes"]["position"], "the drag has not turned the camera");
    let probed = viewer.running.done(json!({"command": "probe", "at": at, "modes": modes}));
    let numbers = |value: &Value| value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>();
    for mode in modes {
        let (value, probed) = (numbers(&values["modes"][mode]), numbers(&probed["modes"][mode]));
        let is_close = value.iter().zip(&probed).all(|(a, b)| (a - b).abs() <= 1e-5 * b.abs().max(1.0));
        assert!(is_close && value.len() == probed.len(), "{mode}: {value:?}, and {probed:?} by probe");
    }
    viewer.display.xdotool(&["mouseup", "1"]);
    viewer.quit();
}
