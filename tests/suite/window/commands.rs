//! A program at the wheel: commands on standard input and on a local socket.

use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::net::UnixStream;
use std::path::Path;

use image::RgbaImage;
use serde_json::{Value, json};

use super::NDF;
use super::controls::choose;
use crate::support::video::Video;
use crate::support::window::Viewer;
use crate::support::{Tree, open_image};

/// A client of the socket.
struct Client {
    line: UnixStream,
    lines: BufReader<UnixStream>,
}

impl Client {
    fn connect(path: &Path) -> Self {
        let line = UnixStream::connect(path).unwrap();
        line.set_read_timeout(Some(crate::support::process::PATIENCE)).unwrap();
        let lines = BufReader::new(line.try_clone().unwrap());
        Self { line, lines }
    }

    fn say(&mut self, line: &str) {
        writeln!(self.line, "{line}").unwrap();
    }

    /// The next event that `is` accepts.
    fn until(&mut self, is: impl Fn(&Value) -> bool) -> Value {
        loop {
            let mut line = String::new();
            assert!(self.lines.read_line(&mut line).unwrap() > 0, "the window hung up");
            let event: Value = serde_json::from_str(&line).unwrap();
            if is(&event) {
                return event;
            }
        }
    }

    fn ask(&mut self, id: &str, mut command: Value) -> Value {
        command["id"] = json!(id);
        self.say(&command.to_string());
        self.until(|event| event["id"] == id && event["event"] != "progress")
    }
}

/// Captures the picture on screen.
fn capture(viewer: &mut Viewer, file: &str) -> RgbaImage {
    let result = viewer.running.done(json!({"command": "capture", "file": file}));
    let path = viewer.tree.beside(file);
    assert_eq!(result["file"].as_str(), path.to_str());
    open_image(&path).into_rgba8()
}

#[test]
fn a_program_drives_the_window_by_standard_input() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    let first = capture(&mut viewer, "first.png");
    assert!(first.pixels().any(|pixel| pixel != first.get_pixel(0, 0)), "an empty picture");
    let running = &mut viewer.running;

    // A setting is done when the picture shows it.
    running.done(json!({"command": "set", "values": {"view.ev": 2, "lights.orbit.0.strength": 1.0}}));
    assert_eq!(running.done(json!({"command": "get", "path": "view.ev"})), json!(2.0));
    let dark = capture(&mut viewer, "dark.png");
    assert!(dark != first && dark.dimensions() == first.dimensions());
    let running = &mut viewer.running;
    running.done(json!({"command": "undo"}));
    assert_eq!(running.done(json!({"command": "get", "path": "view.ev"})), json!(0.7));
    assert!(capture(&mut viewer, "undone.png") == first, "undo brings the picture back");

    // Another mode, size and format, drawn beside the window.
    let running = &mut viewer.running;
    let file = json!({"command": "capture", "file": "n.exr", "mode": "shading-normal", "size": [96, 64]});
    let result = running.done(file);
    assert_eq!((&result["width"], &result["height"]), (&json!(96), &json!(64)));
    let normals = open_image(&viewer.tree.beside("n.exr")).into_rgba32f();
    let length = |pixel: &image::Rgba<f32>| pixel.0[..3].iter().map(|c| c * c).sum::<f32>();
    assert!(normals.pixels().any(|pixel| (length(pixel) - 1.0).abs() < 1e-3), "no unit normals");
    assert!(capture(&mut viewer, "same.png") == first, "the window's picture is as it was");

    // The window with its panels.
    let result = viewer.running.done(json!({"command": "capture", "file": "window.png", "ui": true}));
    assert_eq!((&result["width"], &result["height"]), (&json!(640), &json!(480)));
    let window = open_image(&viewer.tree.beside("window.png")).into_rgba8();
    let colors: std::collections::BTreeSet<[u8; 4]> = window.pixels().map(|pixel| pixel.0).collect();
    assert!(window.pixels().all(|pixel| pixel[3] == 255) && colors.len() > 200, "{} colors", colors.len());

    // Values of a pixel.
    let running = &mut viewer.running;
    let camera = running.done(json!({"command": "camera", "view": "front", "fovy": 30}));
    assert!((camera["fovy"].as_f64().unwrap() - 30.0).abs() < 1e-4, "{camera}");
    let (x, y) = (first.width() / 2, first.height() / 2);
    let probe = json!({"command": "probe", "at": [x, y], "modes": ["roughness", "base-color"]});
    let probed = running.done(probe);
    assert_eq!(probed["pixel"], json!([x, y]));
    assert_eq!(probed["modes"].as_object().unwrap().len(), 2, "{probed}");

    // What is wrong is told, and changes nothing.
    for (command, part) in [
        (json!({"command": "sett"}), "Did you mean `set`?"),
        (json!({"command": "set", "values": "view.exposure=1"}), "Did you mean `view.ev`?"),
        (json!({"command": "set", "values": ["view.ev=1", "view.ev=99"]}), "view.ev is 99"),
        (json!({"command": "set", "values": {"no_such_name": 1}}), "no_such_name"),
        (json!({"command": "mode", "name": "rougness"}), "Did you mean `roughness`?"),
        (json!({"command": "probe", "at": [9999, 0]}), "is outside of the picture"),
        (json!({"command": "capture", "file": "a.jpg"}), "a.jpg"),
        (json!({"command": "capture", "size": [1, 1000000]}), "pixels a side"),
        (json!({"command": "open", "model": "no-such-file.glb"}), "no-such-file.glb"),
        (json!({"command": "open", "environment": "no-such-file.hdr"}), "no-such-file.hdr"),
        (json!({"command": "pass", "name": "blom", "on": true}), "no pass is named `blom`"),
        (json!({"command": "run", "entry": "Reload all shader"}), "Did you mean `Reload all shaders`?"),
        (json!({"command": "turntable", "file": "a.webm"}), "ffmpeg"),
    ] {
        let message = running.refused(command.clone());
        assert!(message.contains(part), "{command}: {message}");
    }
    // Neither do files that cannot be read, and an error is that of its own command.
    let environment = running.done(json!({"command": "get", "path": "environment.name"}));
    for file in ["no.hdr", "nor.hdr", "neither.hdr"] {
        let message = running.refused(json!({"command": "set", "values": {"environment.name": file}}));
        assert!(message.starts_with(file), "{message}");
        let message = running.refused(json!({"command": "open", "environment": format!("open-{file}")}));
        assert!(message.starts_with("open-"), "{message}");
    }
    assert_eq!(running.done(json!({"command": "get", "path": "environment.name"})), environment);
    running.say("{\"command\"");
    running.until("the answer to no JSON", |event| event["event"] == "error" && event["id"].is_null());
    running.say(&"x".repeat(3 << 20));
    running.until("the answer to a long line", |event| event["event"] == "error" && event["id"].is_null());
    assert_eq!(running.done(json!({"command": "get", "path": "view.ev"})), json!(0.7));
    running.done(json!({"command": "set", "values": "environment.name=none"}));

    // Lists, from which a client learns what there is.
    for list in ["modes", "settings", "commands", "entries", "versions"] {
        let result = running.done(json!({"command": list}));
        assert!(!result.as_array().unwrap().is_empty(), "{list}");
    }
    let entries = running.done(json!({"command": "entries"}));
    let in_force: Vec<&Value> = entries.as_array().unwrap().iter().filter(|entry| entry["now"] == true).collect();
    let is_in_force = |entry: &str| in_force.iter().any(|listed| listed["entry"] == entry);
    assert!(is_in_force("Environment: none") && !is_in_force("Environment: studio"), "{in_force:?}");
    running.done(json!({"command": "run", "entry": "Exposure", "value": 1.5}));
    assert_eq!(running.done(json!({"command": "get", "path": "view.ev"})), json!(-1.5), "brighter");

    // A broken shader, and its repair.
    let original = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &original.replace("alpha * alpha;", "alpha * alfa;"));
    viewer.running.reload(false);
    let answer = viewer.running.ask(json!({"command": "reload"}));
    assert_eq!(answer["event"], "error");
    assert!(answer["diagnostics"][0]["file"].as_str().unwrap().ends_with("ndf.glsl"), "{answer}");
    viewer.tree.write(NDF, &original);
    viewer.running.reload(true);
    viewer.running.done(json!({"command": "reload"}));
    viewer.running.until_stderr("the shaders compile again");

    // The end of the input ends nothing else.
    viewer.running.end_input();
    viewer.quit();
}

#[test]
fn an_older_version_is_shown_in_place_of_the_newest() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    let first = capture(&mut viewer, "first.png");
    let original = viewer.tree.read(NDF);
    let edit = |factor: &str| original.replace("alpha * alpha;", &format!("alpha * alpha * {factor};"));
    for factor in ["0.5", "6.0"] {
        viewer.tree.write(NDF, &edit(factor));
        viewer.running.reload(true);
    }
    let newest = capture(&mut viewer, "newest.png");
    assert!(newest != first);
    let versions = viewer.running.done(json!({"command": "versions"}));
    let numbers: Vec<u64> = versions.as_array().unwrap().iter().filter_map(|row| row["number"].as_u64()).collect();
    assert_eq!(numbers.len(), 3, "{versions}");
    let oldest = *numbers.iter().min().unwrap();

    viewer.running.done(json!({"command": "versions", "show": oldest}));
    assert!(capture(&mut viewer, "shown.png") == first, "not the first version");
    assert_eq!(viewer.tree.read(NDF), edit("6.0"), "the file was changed");
    viewer.running.done(json!({"command": "versions", "show": "newest"}));
    assert!(capture(&mut viewer, "back.png") == newest, "not the newest version");
    let after = viewer.running.done(json!({"command": "versions"}));
    let numbers_after: Vec<u64> = after.as_array().unwrap().iter().filter_map(|row| row["number"].as_u64()).collect();
    assert_eq!(numbers_after, numbers, "showing an older version makes none");

    // A save ends it.
    viewer.running.done(json!({"command": "versions", "show": oldest}));
    assert!(capture(&mut viewer, "again.png") == first, "not the first version again");
    viewer.tree.write(NDF, &edit("6.1"));
    let is_like = |shot: &RgbaImage| difference(shot, &newest) < 0.1 * difference(shot, &first);
    viewer.until("the saved text", is_like);
    viewer.running.end_input();
    viewer.quit();
}

#[test]
fn a_look_whose_shaders_are_gone_keeps_the_shaders_and_their_versions() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    viewer.tree.write(NDF, &viewer.tree.edited(NDF, "alpha * alpha;", "0.5 * alpha * alpha;"));
    let reload = viewer.running.reload(true);
    viewer.running.settled(&reload);
    let versions = viewer.running.done(json!({"command": "versions"}));
    let mut look = png::Encoder::new(std::fs::File::create(viewer.tree.beside("look.png")).unwrap(), 1, 1);
    look.add_itxt_chunk("specula".to_owned(), "[view]\nev = 2.0\n".to_owned()).unwrap();
    look.add_itxt_chunk("specula-files".to_owned(), "shaders = \"gone\"\n".to_owned()).unwrap();
    look.write_header().unwrap().write_image_data(&[0]).unwrap();
    viewer.running.done(json!({"command": "open", "look": "look.png"}));
    assert_eq!(viewer.running.done(json!({"command": "get", "path": "view.ev"})), json!(2.0));
    assert_eq!(viewer.running.done(json!({"command": "versions"})), versions);
    viewer.running.end_input();
    let stderr = viewer.quit();
    assert!(stderr.contains("gone: there is no such file or folder"), "{stderr}");
}

#[test]
fn a_look_is_saved_and_opened() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    viewer.running.done(json!({"command": "set", "values": {"view.ev": 2.5}}));
    let look = viewer.tree.beside("mine.toml");
    assert_eq!(viewer.running.done(json!({"command": "save-look", "file": look}))["file"].as_str(), look.to_str());
    choose(&viewer, "save the look");
    viewer.running.until_stderr("specula-look-1.toml");
    viewer.running.done(json!({"command": "set", "values": {"view.ev": 0}}));
    viewer.running.done(json!({"command": "open", "look": look}));
    assert_eq!(viewer.running.done(json!({"command": "get", "path": "view.ev"})), 2.5);
    let text = std::fs::read_to_string(viewer.tree.beside("specula-look-1.toml")).unwrap();
    assert_eq!(text, std::fs::read_to_string(&look).unwrap());
    let refused = viewer.running.refused(json!({"command": "save-look", "file": "look.png"}));
    assert!(refused.contains("ends in .toml"), "{refused}");
    viewer.running.end_input();
    viewer.quit();
}

#[test]
fn clicks_grids_defaults_and_looks_are_commands() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let first = capture(&mut viewer, "first.png");
    let running = &mut viewer.running;

    // Modes side by side.
    let shown = running.done(json!({"command": "grid", "modes": ["d", "f", "d"]}));
    assert_eq!(shown["modes"], json!(["d", "f"]));
    assert_eq!(running.done(json!({"command": "get", "path": "mode"})), "d");
    let message = running.refused(json!({"command": "grid", "modes": ["rougness", "d"]}));
    assert!(message.contains("Did you mean `roughness`?"), "{message}");
    assert_eq!(running.done(json!({"command": "grid", "modes": []}))["modes"], json!([]));
    running.done(json!({"command": "mode", "name": "final"}));

    // A click on a sphere, and beside all.
    let (x, y) = (first.width() / 2, first.height() / 2);
    let center = running.done(json!({"command": "pick", "at": [x, y]}));
    assert!(center["primitive"].is_string(), "{center}");
    assert_eq!(running.done(json!({"command": "pick"}))["primitive"], Value::Null);
    assert!(running.refused(json!({"command": "pick", "at": [9999, 0]})).contains("is outside of the picture"));

    // Another model, and back by the picture.
    running.done(json!({"command": "open", "model": "clearcoat"}));
    assert!(capture(&mut viewer, "other.png") != first);
    viewer.running.done(json!({"command": "open", "look": "first.png"}));
    assert!(capture(&mut viewer, "again.png") == first, "the look does not restore its picture");

    // A value becomes the default in the file, and nothing else in it changes.
    let file = "user/params.glsl";
    let before = viewer.tree.read(file);
    let running = &mut viewer.running;
    running.done(json!({"command": "set", "values": "rim_strength=0.5"}));
    let written = running.done(json!({"command": "write-defaults", "names": ["rim_strength"]}));
    assert_eq!(written["edits"][0]["name"], "rim_strength", "{written}");
    let after = viewer.tree.read(file);
    let changed: Vec<(&str, &str)> = before.lines().zip(after.lines()).filter(|(a, b)| a != b).collect();
    assert!(changed.len() == 1 && changed[0].1.contains("0.5"), "{changed:?}");
    let running = &mut viewer.running;
    running.reload(true);
    assert!(running.refused(json!({"command": "write-defaults"})).contains("have these values already"));
    let unknown = running.refused(json!({"command": "write-defaults", "names": ["rim_strenght"]}));
    assert_eq!(unknown, "there is no parameter `rim_strenght`. Did you mean `rim_strength`?");
    viewer.running.end_input();
    viewer.quit();
}

/// Another change of the file ends the dragging, and the lost number is told. The versions count on without a gap.
#[test]
fn a_dragged_number_that_a_save_ends_is_told() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid", "--env", "none"]);
    viewer.running.event("ready");
    let original = viewer.tree.read(NDF);
    let text = original.replace("alpha * alpha;", "1.0 * alpha * alpha;");
    viewer.tree.write(NDF, &text);
    viewer.running.reload(true);
    viewer.running.done(json!({"command": "reload"}));
    let row = 1 + text.lines().position(|line| line.contains("1.0 * alpha * alpha;")).unwrap();
    for value in [7.0, 9.0] {
        viewer.running.done(json!({"command": "numbers", "at": format!("ndf.glsl:{row}"), "values": [value]}));
    }
    let dragged = viewer.screenshot();
    viewer.tree.write(NDF, &format!("{text}// another change\n"));
    viewer.running.until_stderr("ndf.glsl was saved with other changes; the dragged 9.0 was not in it");
    viewer.until("the number of the file", |shot| *shot != dragged);
    viewer.running.done(json!({"command": "reload"}));
    let versions = viewer.running.done(json!({"command": "versions"}));
    let numbers: Vec<u64> = versions.as_array().unwrap().iter().filter_map(|row| row["number"].as_u64()).collect();
    assert_eq!(numbers, [1, 2, 3], "{versions}");
    viewer.running.end_input();
    viewer.quit();
}

#[test]
fn numbers_of_a_line_are_commands() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid", "--env", "none"]);
    viewer.running.event("ready");
    let original = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &original.replace("alpha * alpha;", "1.0 * alpha * alpha;"));
    viewer.running.reload(true);
    viewer.running.done(json!({"command": "reload"}));
    let (text, first) = (viewer.tree.read(NDF), viewer.screenshot());
    let row = 1 + text.lines().position(|line| line.contains("1.0 * alpha * alpha;")).unwrap();
    let at = format!("ndf.glsl:{row}");
    let running = &mut viewer.running;
    let listed = running.done(json!({"command": "numbers", "at": at}));
    assert_eq!(listed["numbers"], json!([{ "text": "1.0", "value": 1.0 }]));

    // Shown, and taken back, without a change of the file.
    running.done(json!({"command": "numbers", "at": at, "values": [9.0]}));
    assert!(viewer.screenshot() != first, "the other number does not show");
    assert_eq!(viewer.tree.read(NDF), text);
    let running = &mut viewer.running;
    assert_eq!(running.done(json!({"command": "numbers", "at": at}))["numbers"], listed["numbers"]);
    running.done(json!({"command": "numbers"}));
    assert!(viewer.screenshot() == first, "the number of the file does not show");

    // Written.
    let running = &mut viewer.running;
    running.done(json!({"command": "numbers", "at": at, "values": [9.0]}));
    let written = running.done(json!({"command": "numbers", "write": true}));
    assert_eq!(written["edits"][0]["line"], row);
    let edited = text.replace("1.0 * alpha * alpha;", "9.0 * alpha * alpha;");
    assert_eq!(viewer.tree.read(NDF), edited);
    // Undo takes back what was written, and redo writes it again.
    for (command, expected) in [("undo", &text), ("redo", &edited)] {
        viewer.running.done(json!({"command": command}));
        assert_eq!(viewer.tree.read(NDF), *expected, "{command}");
    }
    let running = &mut viewer.running;
    for (command, part) in [
        (json!({"command": "numbers", "at": "ndf.glsl:9999"}), "no line ndf.glsl:9999"),
        (json!({"command": "numbers", "at": at, "values": [1, 2]}), "has 2 numbers, and the line has 1"),
        (json!({"command": "numbers", "write": true}), "no other numbers are shown"),
    ] {
        let message = running.refused(command.clone());
        assert!(message.contains(part), "{command}: {message}");
    }
    viewer.running.end_input();
    viewer.quit();
}

/// A capture right behind the answer has all stages and all light, so it is equal to one later, and to one that is drawn anew but for the
/// rounding of another format.
#[test]
fn a_capture_behind_an_answer_is_final() {
    let tree = Tree::new();
    let original = tree.read(NDF).replace("alpha * alpha;", "1.0 * alpha * alpha;");
    tree.write(NDF, &original);
    let row = 1 + original.lines().position(|line| line.contains("1.0 * alpha * alpha;")).unwrap();
    let mut viewer = Viewer::driven(tree, &["sphere-grid", "--env", "furnace"]);
    let first = capture(&mut viewer, "first.png");
    let (width, height) = first.dimensions();
    let other = Tree::new();
    other.write(NDF, &original.replace("1.0 * alpha * alpha;", "3.0 * alpha * alpha;"));
    let check = |viewer: &mut Viewer, command: Value| {
        viewer.running.done(command.clone());
        let at_once = capture(viewer, "at-once.png");
        let anew = json!({"command": "capture", "file": "anew.png", "size": [width, height]});
        viewer.running.done(anew);
        let anew = open_image(&viewer.tree.beside("anew.png")).into_rgba8();
        let largest = anew.as_raw().iter().zip(at_once.as_raw()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(2), "{command} is not final: it is off by {largest:?}");
        assert!(capture(viewer, "later.png") == at_once, "{command} shows something else later");
        at_once
    };
    for command in [
        json!({"command": "set", "values": {"NDF": "Beckmann"}}),
        json!({"command": "undo"}),
        json!({"command": "run", "entry": "Normal distribution: Beckmann"}),
        json!({"command": "set", "values": {"NDF": "GGX"}}),
        json!({"command": "mode", "name": "d"}),
        json!({"command": "mode", "name": "final"}),
        json!({"command": "camera", "view": "top"}),
        json!({"command": "set", "values": {"environment.name": "studio"}}),
        json!({"command": "open", "environment": "furnace"}),
        json!({"command": "open", "model": "clearcoat"}),
    ] {
        check(&mut viewer, command);
    }
    let restored = check(&mut viewer, json!({"command": "open", "look": "first.png"}));
    assert!(restored == first, "the look does not restore its picture");

    // Edits whose light is baked by stages that the picture does not draw.
    let line = format!("ndf.glsl:{row}");
    check(&mut viewer, json!({"command": "numbers", "at": line, "values": [0.2]}));
    assert!(check(&mut viewer, json!({"command": "numbers"})) == first);
    viewer.tree.write(NDF, &original.replace("1.0 * alpha * alpha;", "5.0 * alpha * alpha;"));
    let after = check(&mut viewer, json!({"command": "reload"}));
    assert!(after != first);
    let versions = viewer.running.done(json!({"command": "versions"}));
    let oldest = versions.as_array().unwrap().iter().filter_map(|row| row["number"].as_u64()).min().unwrap();
    assert!(check(&mut viewer, json!({"command": "versions", "show": oldest})) == first);
    assert!(check(&mut viewer, json!({"command": "versions", "show": "newest"})) == after);
    check(&mut viewer, json!({"command": "open", "tree": other.beside("shaders")}));
    viewer.running.end_input();
    viewer.quit();
}

/// The mean difference of two pictures' channels, 0 to 255.
fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.as_raw().len() as f64
}

#[test]
fn clients_of_a_socket_drive_the_window() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid", "--socket", "test"]);
    let path = viewer.tree.beside("runtime/specula/test.sock");
    let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
    assert_eq!((mode(&path), mode(path.parent().unwrap())), (0o600, 0o700));
    let (mut first, mut second) = (Client::connect(&path), Client::connect(&path));
    viewer.running.event("ready");

    // Each gets its own answers, and both get the events.
    let set = first.ask("a", json!({"command": "set", "values": {"view.ev": 3}}));
    assert_eq!(set["event"], "done", "{set}");
    assert_eq!(second.ask("b", json!({"command": "get", "path": "view.ev"}))["result"], json!(3.0));
    viewer.tree.write(NDF, &viewer.tree.edited(NDF, "alpha * alpha;", "alpha * alfa;"));
    for client in [&mut first, &mut second] {
        let diagnostic = client.until(|event| event["event"] == "diagnostic");
        assert!(diagnostic["file"].as_str().unwrap().ends_with("ndf.glsl"), "{diagnostic}");
    }
    viewer.running.event("diagnostic");

    // A client that goes away in the middle of a line harms nobody.
    first.line.write_all(b"{\"command\":").unwrap();
    drop(first);
    let sheet = json!({"command": "sheet", "file": "sheet.png", "modes": ["metallic", "roughness"], "size": [64, 48]});
    let sheet = second.ask("c", sheet);
    assert_eq!(sheet["event"], "done", "{sheet}");
    assert!(open_image(&viewer.tree.beside("sheet.png")).width() > 64);
    let turn = json!({"command": "turntable", "file": "spin.gif", "frames": 3, "size": [64, 48]});
    assert_eq!(second.ask("d", turn)["event"], "done");
    assert!(viewer.tree.beside("spin.gif").exists());

    let turn = json!({"command": "turntable", "file": "spin.mp4", "frames": 3, "size": [64, 48]});
    assert_eq!(second.ask("video", turn)["event"], "done");
    assert_eq!(Video::read(&std::fs::read(viewer.tree.beside("spin.mp4")).unwrap()).frames.len(), 3);

    // Long work is canceled by who likes, and leaves no part of a file.
    for file in ["long.gif", "long.mp4"] {
        second.say(&json!({"id": file, "command": "turntable", "file": file, "frames": 5000}).to_string());
        second.until(|event| event["event"] == "progress" && event["id"] == file && event["done"].as_u64() > Some(1));
        second.say(&json!({"id": "cancel", "command": "cancel"}).to_string());
        let answer = second.until(|event| event["id"] == file && event["event"] == "error");
        assert_eq!(answer["message"], "canceled", "{answer}");
        let folder = viewer.tree.beside(file);
        let names = std::fs::read_dir(folder.parent().unwrap()).unwrap().map(|entry| entry.unwrap().file_name());
        let left: Vec<_> = names.filter(|name| name.to_string_lossy().contains("long")).collect();
        assert!(left.is_empty(), "{left:?}");
    }

    assert_eq!(second.ask("e", json!({"command": "quit"}))["event"], "done");
    let status = viewer.running.end();
    assert!(status.success(), "it ended with {status}. {}", viewer.running.story());
    assert!(!path.exists(), "the file of the socket is left");
}

#[test]
fn a_window_that_gets_no_image_of_its_swapchain_answers_and_closes() {
    let more = ["sphere-grid", "--socket", "test"];
    let mut viewer = Viewer::launch(Tree::new(), &more, "window-hidden:1");
    let path = viewer.running.event("listening")["socket"].as_str().unwrap().to_owned();
    let mut client = Client::connect(Path::new(&path));
    assert_eq!(client.ask("a", json!({"command": "get"}))["event"], "done");
    assert_eq!(client.ask("b", json!({"command": "quit"}))["event"], "done");
    assert!(viewer.running.end().success());
}

#[test]
fn a_socket_that_others_could_reach_is_refused() {
    let tree = Tree::new();
    let folder = tree.beside("open");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o755)).unwrap();
    let display = crate::support::window::Display::new();
    let mut command = display.view(&tree);
    command.args(["--socket", "./open/s.sock"]);
    crate::support::process::finish(&mut command).expect(1, &["others can enter the folder", "chmod 700"]);
}
