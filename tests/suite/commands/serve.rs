//! `specula serve`: a session without a window, which a program drives by standard input.

use std::os::unix::fs::MetadataExt as _;
use std::os::unix::process::ExitStatusExt as _;
use std::process::Stdio;

use serde_json::{Value, json};

use crate::support::Tree;
use crate::support::process::{Running, finish, in_shell, run, send_signal};
use crate::support::served::{PICTURE, Served};

const NDF: &str = "brdf/ndf.glsl";
/// A line of [`NDF`], and one that shows in the picture.
const LINE: [&str; 2] = ["float a2 = alpha * alpha;", "float a2 = alpha;"];

/// A NumPy array: its kind, its shape, and its data.
fn array(bytes: &[u8]) -> (String, String, &[u8]) {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let begin = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let text = std::str::from_utf8(&bytes[10..begin]).unwrap();
    let part = |from: &str, to: &str| text.split(from).nth(1).unwrap().split(to).next().unwrap().to_owned();
    (part("'descr': '", "'"), part("'shape': (", ")"), &bytes[begin..])
}

/// What `specula render` writes to a file of this name, with [`PICTURE`] and more options.
#[track_caller]
fn rendered(tree: &Tree, file: &str, more: &[&str]) -> Vec<u8> {
    // Options that are given take the place of those of the picture.
    let picture = PICTURE.chunks(2).filter(|option| !more.contains(&option[0])).flatten().copied();
    let options: Vec<&str> =
        ["render", "sphere-grid", "--out", file].into_iter().chain(picture).chain(more.iter().copied()).collect();
    run(&tree.beside(""), &options).expect(0, &[]);
    std::fs::read(tree.beside(file)).unwrap()
}

#[track_caller]
fn rgba8(png: &[u8]) -> Vec<u8> {
    image::load_from_memory(png).unwrap().into_rgba8().into_raw()
}

#[test]
fn a_picture_is_that_of_a_command_with_the_same_settings() {
    let mut served = Served::start(Tree::new(), &["sphere-grid"]);
    served.running.done(json!({"command": "set", "values": {"view.ev": 1.5, "NDF": "Beckmann"}}));
    let set = ["--set", "view.ev=1.5", "--set", "NDF=Beckmann"];
    let more = |options: &[&'static str]| [&set[..], options].concat();

    // In the session's size and mode.
    let png = rendered(&served.tree, "r.png", &set);
    assert!(rgba8(&served.picture("a.png", &json!({}))) == rgba8(&png), "the colors of the PNG differ");
    let bytes = served.picture("a.npy", &json!({}));
    let (kind, shape, data) = array(&bytes);
    assert_eq!((kind.as_str(), shape.as_str()), ("|u1", "64, 96, 4"));
    assert!(data == rgba8(&png), "the bytes of the array differ");
    // Linear light, with and without several samples.
    let npy = rendered(&served.tree, "r.npy", &set);
    assert_eq!(array(&npy).0, "<f4");
    assert!(served.picture("a.npy", &json!({"raw": true})) == npy, "the floats of the array differ");
    let exr = rendered(&served.tree, "r.exr", &set);
    assert!(served.picture("a.exr", &json!({})) == exr, "the EXR differs");
    served.running.done(json!({"command": "set", "values": "view.msaa=1"}));
    let single = rendered(&served.tree, "s.npy", &more(&["--set", "view.msaa=1"]));
    assert!(single != npy && served.picture("a.npy", &json!({"raw": true})) == single, "one sample differs");
    served.running.done(json!({"command": "set", "values": "view.msaa=4"}));

    // In others; the session keeps its own.
    let other = rendered(&served.tree, "o.png", &more(&["--mode", "d", "--size", "40x30"]));
    let picture = served.picture("o2.png", &json!({"mode": "d", "size": [40, 30]}));
    assert!(rgba8(&picture) == rgba8(&other), "another mode and size differ");
    assert!(served.picture("a.npy", &json!({})) == bytes, "the session's picture has changed");

    // A mode of random paths, which takes many frames.
    served.running.done(json!({"command": "set", "values": {"view.frames": 3}}));
    let paths = served.running.done(json!({"command": "modes"}));
    let is_paths = |mode: &&Value| mode["accumulate"] == true;
    let slug = paths.as_array().unwrap().iter().find(is_paths).expect("a mode of random paths")["slug"].clone();
    served.running.done(json!({"command": "mode", "name": slug}));
    let slug = slug.as_str().unwrap().to_owned();
    let options = [&set[..], &["--set", "view.frames=3", "--mode", &slug]].concat();
    let paths = rendered(&served.tree, "p.png", &options);
    assert!(rgba8(&served.picture("p2.png", &json!({}))) == rgba8(&paths), "random paths differ");
    for (command, part) in [
        (json!({"command": "picture", "file": "a.jpg"}), ".exr or .npy"),
        (json!({"command": "picture", "file": "nowhere/a.npy"}), "there is no folder nowhere"),
        (json!({"command": "picture", "file": "a.png", "raw": true}), "a PNG holds no raw values"),
        (json!({"command": "picture", "file": "a", "format": "tiff"}), "it can be npy, png or exr"),
        (json!({"command": "picture", "file": "a.npy", "mode": "dd"}), "there is no mode"),
        (json!({"command": "picture", "file": "a.npy", "size": [0, 4]}), "draws 1 to"),
        (json!({"command": "picture", "path": "a.npy"}), "`picture` needs \"file\""),
    ] {
        let message = served.running.refused(command.clone());
        assert!(message.contains(part), "{command}: {message}");
    }
    served.quit();
}

#[test]
fn a_picture_is_written_into_an_open_file_in_its_place() {
    let tree = Tree::new();
    std::fs::write(tree.beside("open"), [7; 200_000]).unwrap();
    let command = Served::command(&tree, &[&PICTURE[..], &["sphere-grid"]].concat());
    let mut shell = in_shell(&command, r#"exec 9<>open; exec "$0" "$@""#);
    shell.current_dir(tree.beside("")).stdin(Stdio::piped());
    let mut served = Served { running: Running::start(&mut shell), tree };
    let before = std::fs::metadata(served.tree.beside("open")).unwrap().ino();
    served.running.done(json!({"command": "picture", "file": "/proc/self/fd/9", "format": "npy"}));
    let bytes = std::fs::read(served.tree.beside("open")).unwrap();
    let (kind, shape, data) = array(&bytes);
    assert_eq!((kind.as_str(), shape.as_str(), data.len()), ("|u1", "64, 96, 4", 96 * 64 * 4));
    assert_eq!(std::fs::metadata(served.tree.beside("open")).unwrap().ino(), before, "it was replaced");
    served.quit();
}

#[test]
fn edits_show_at_once_and_mistakes_keep_the_picture() {
    let mut served = Served::start(Tree::new(), &["sphere-grid"]);
    let picture = served.picture("a.npy", &json!({}));
    let text = served.tree.read(NDF);

    // On disk, as by an editor.
    served.tree.write(NDF, &served.tree.edited(NDF, LINE[0], LINE[1]));
    served.running.reload(true);
    let edited = served.picture("a.npy", &json!({}));
    assert!(edited != picture, "the edit changes nothing");

    // By the program.
    let read = served.running.done(json!({"command": "file", "file": NDF}));
    assert_eq!(read, json!({"file": NDF, "text": served.tree.read(NDF)}));
    let answer = served.running.done(json!({"command": "edit", "file": NDF, "text": text}));
    assert!(answer["generation"].as_u64().unwrap() > 1, "{answer}");
    assert_eq!(served.tree.read(NDF), text);
    assert!(served.picture("a.npy", &json!({})) == picture, "the first picture comes back");

    // A mistake has its line and caret, and the file has the text.
    let wrong = text.replace(LINE[0], "float a2 = alpha * beta;");
    let answer = served.running.ask(json!({"command": "edit", "file": NDF, "text": wrong}));
    let found = &answer["diagnostics"][0];
    assert_eq!((&answer["event"], &found["severity"]), (&json!("error"), &json!("error")), "{answer}");
    let line = text.lines().position(|line| line.contains(LINE[0])).unwrap() + 1;
    assert_eq!(found["line"], json!(line), "{answer}");
    let excerpt = found["excerpt"].as_str().unwrap();
    let column = found["column"].as_u64().unwrap() as usize;
    assert!(excerpt[column - 1..].starts_with("beta") && found["length"] == 4, "{answer}");
    assert!(found["message"].as_str().unwrap().contains("beta"), "{answer}");
    assert!(found["file"].as_str().unwrap().ends_with(NDF), "{answer}");
    assert_eq!(served.tree.read(NDF), wrong);
    assert!(served.picture("a.npy", &json!({})) == picture, "the last good picture is lost");
    let all = served.running.done(json!({"command": "check"}));
    assert!(all.as_array().unwrap().iter().any(|one| one["line"] == json!(line)), "{all}");

    // Undone, as in the window.
    served.running.done(json!({"command": "undo"}));
    assert_eq!(served.tree.read(NDF), text);
    assert!(served.running.refused(json!({"command": "pass", "name": "no-such-pass"})).contains("no-such-pass"));
    // A command that follows an edit at once has it, and of two the last one stays.
    let [first, second] = [LINE[1], LINE[0]].map(|line| text.replace(LINE[0], line));
    served.running.say(&json!({"command": "edit", "file": NDF, "text": first}).to_string());
    assert!(served.picture("a.npy", &json!({})) == edited, "the picture is from before the edit");
    for text in [&first, &second, &first, &second] {
        served.running.say(&json!({"command": "edit", "file": NDF, "text": text}).to_string());
    }
    assert!(served.picture("a.npy", &json!({})) == picture, "another edit than the last one is drawn");
    assert_eq!(served.tree.read(NDF), text);
    assert_eq!(served.running.done(json!({"command": "check"})), json!([]));

    // A new file, and a text that is there already.
    served.running.done(json!({"command": "edit", "file": "user/mine.glsl", "text": "float mine() { return 1.0; }\n"}));
    assert_eq!(served.tree.read("user/mine.glsl"), "float mine() { return 1.0; }\n");
    served.running.done(json!({"command": "undo"}));
    assert!(!served.tree.path("user/mine.glsl").exists(), "an undo leaves a file");
    served.running.done(json!({"command": "redo"}));
    assert!(served.tree.path("user/mine.glsl").exists());
    served.running.done(json!({"command": "edit", "file": NDF, "text": text}));

    // A save of an editor since the text was read stays. Where both have changed a line, nothing is written.
    served.tree.write(NDF, &format!("// theirs\n{text}"));
    served.running.done(json!({"command": "edit", "file": NDF, "text": format!("{text}// mine\n"), "base": text}));
    assert_eq!(served.tree.read(NDF), format!("// theirs\n{text}// mine\n"));
    served.tree.write(NDF, &first);
    let mine = text.replace(LINE[0], "float a2 = 1.0;");
    let message = served.running.refused(json!({"command": "edit", "file": NDF, "text": mine, "base": text}));
    assert!(message.contains("changed by another program in the same place"), "{message}");
    assert_eq!(served.tree.read(NDF), first);
    let files = served.running.done(json!({"command": "files"}));
    assert_eq!(files["tree"].as_str(), served.tree.root().to_str());
    assert!(files["files"].as_array().unwrap().contains(&json!("user/mine.glsl")), "{files}");

    // Nothing else is written.
    for (file, part) in [
        ("../outside.glsl", "not in the shader tree"),
        ("/tmp/outside.glsl", "not in the shader tree"),
        (".git/hooks/a.glsl", "no file of shader code"),
        ("README.md", "no file of shader code"),
    ] {
        let message = served.running.refused(json!({"command": "edit", "file": file, "text": "x"}));
        assert!(message.contains(part), "{file}: {message}");
    }
    assert!(served.running.refused(json!({"command": "edit", "file": NDF})).contains("`edit` needs"));
    assert!(served.running.refused(json!({"command": "file", "file": "brdf/nd.glsl"})).contains(NDF));
    served.quit();
}

#[test]
fn the_built_in_shaders_are_edited_in_memory() {
    let tree = Tree::new();
    let folder = tree.beside("elsewhere");
    std::fs::create_dir(&folder).unwrap();
    let mut command = Served::command(&tree, &["--env", "none", "--size", "96x64", "sphere-grid"]);
    let mut served = Served { running: Running::start(command.current_dir(&folder)), tree };
    let absolute = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let picture = |served: &mut Served| {
        served.running.done(json!({"command": "picture", "file": absolute("a.npy")}));
        std::fs::read(absolute("a.npy")).unwrap()
    };
    let first = picture(&mut served);
    let files = served.running.done(json!({"command": "files"}));
    assert_eq!(files["tree"], Value::Null);
    let text = served.running.done(json!({"command": "file", "file": NDF}))["text"].as_str().unwrap().to_owned();
    let edited = text.replace(LINE[0], LINE[1]);
    served.running.done(json!({"command": "edit", "file": NDF, "text": edited}));
    assert!(picture(&mut served) != first, "the edit changes nothing");
    let fresnel = served.running.done(json!({"command": "file", "file": "brdf/fresnel.glsl"}))["text"].clone();
    served.running.done(json!({"command": "edit", "file": "brdf/fresnel.glsl", "text": fresnel}));
    assert_eq!(served.running.done(json!({"command": "file", "file": NDF}))["text"], json!(edited));
    // Also when a text follows another at once, and in the process that follows a crash.
    let edit = |file: &str, text: &str| json!({"command": "edit", "file": file, "text": text}).to_string();
    served.running.say(&edit("user/a.glsl", "// a\n"));
    served.running.say(&edit("user/b.glsl", "// b\n"));
    let shown = picture(&mut served);
    assert!(shown != first, "the edit is lost");
    send_signal(served.running.worker(), "KILL");
    served.running.event("restarted");
    assert!(picture(&mut served) == shown, "a crash takes the edit back");
    assert_eq!(served.running.done(json!({"command": "file", "file": NDF}))["text"], json!(edited));
    served.running.done(json!({"command": "edit", "file": NDF, "text": null}));
    assert!(picture(&mut served) == first, "the built-in text does not come back");
    served.quit();
}

#[test]
fn measurements_are_those_of_the_command_line() {
    let mut served = Served::start(Tree::new(), &["sphere-grid"]);
    let folder = served.tree.beside("");
    served.running.done(json!({"command": "set", "values": {"MULTI_SCATTER": "None"}}));
    let options =
        ["brdf", "furnace", "--shaders", "shaders", "--set", "MULTI_SCATTER=None", "--json", "--metallic", "0.5"];
    let furnace = served.running.done(json!({"command": "furnace", "metallic": 0.5}));
    assert_eq!(furnace, run(&folder, &options).json());
    assert!(served.running.refused(json!({"command": "furnace", "metallic": 2})).contains("0 to 1"));

    rendered(&served.tree, "a.png", &[]);
    rendered(&served.tree, "b.png", &["--set", "view.ev=1"]);
    let diff = json!({"command": "diff", "a": "a.png", "b": "b.png", "max_channel": 0.5, "out": "map.png"});
    let options = ["diff", "a.png", "b.png", "--max-channel", "0.5", "--json"];
    assert_eq!(served.running.done(diff), run(&folder, &options).json());
    assert!(served.tree.beside("map.png").exists());
    assert!(served.running.refused(json!({"command": "diff", "a": "a.png", "b": "c.png"})).contains("c.png"));
    served.quit();
}

#[test]
fn every_command_is_answered() {
    let mut served = Served::start(Tree::new(), &["sphere-grid"]);
    let picture = served.picture("a.npy", &json!({}));
    let commands = served.running.done(json!({"command": "commands"}));
    for command in commands.as_array().unwrap() {
        let name = command["command"].as_str().unwrap();
        if name == "quit" {
            continue;
        }
        // All functions of a stage take a minute on a software device; `commands::cost` measures them.
        let answer = match name {
            "cost" => served.running.ask(json!({"command": name, "stage": "nothing.frag"})),
            name => served.running.ask(json!({"command": name})),
        };
        if command["needs_window"] == true {
            let told = format!("`{name}` is about the window, and this session has none");
            assert_eq!(answer["message"], json!(told), "{answer}");
        } else if answer["event"] == "error" {
            assert!(answer["message"].as_str().unwrap().len() > 10, "{answer}");
        }
    }
    for name in ["palette", "layout", "panel", "screenshot", "keys"] {
        let message = served.running.refused(json!({"command": name}));
        assert!(message.contains("is about the window, and this session has none"), "{name}: {message}");
    }
    let entries = served.running.done(json!({"command": "entries"}));
    let is_of_window = |entry: &Value| ["Layout", "Panel", "Learn"].contains(&entry["group"].as_str().unwrap());
    assert!(!entries.as_array().unwrap().iter().any(is_of_window), "{entries}");
    assert!(served.running.refused(json!({"command": "capture", "file": "a.png", "ui": true})).contains("window"));
    assert!(served.picture("a.npy", &json!({})) == picture, "a command without fields has changed the picture");
    std::fs::remove_file(served.tree.beside("specula-1.png")).expect("the picture of `capture`");
    served.quit();
}

#[test]
fn a_command_is_canceled_by_its_id() {
    // Before the shaders are there, too, whose names the others wait for.
    let mut served = Served::with_fault(Tree::new(), &["sphere-grid"], "compile-delay-ms:1000");
    served.running.say(r#"{"id": "early", "command": "picture", "file": "a.npy"}"#);
    served.running.say(r#"{"id": "late", "command": "set", "values": {"no_such_name": 1}}"#);
    served.running.done(json!({"command": "cancel", "of": "early"}));
    let late = served.running.until("the answer", |event| event["id"] == "late");
    assert!(late["message"].as_str().unwrap().contains("no_such_name"), "{late}");
    served.running.say(r#"{"id": "slow", "command": "turntable", "file": "a.gif", "frames": 5000}"#);
    served.running.until("progress", |event| event["event"] == "progress" && event["done"] != 0);
    served.running.done(json!({"command": "cancel", "of": "slow"}));
    let answer = served.running.until("its end", |event| event["id"] == "slow" && event["event"] != "progress");
    assert_eq!((&answer["event"], &answer["message"]), (&json!("error"), &json!("canceled")), "{answer}");
    let message = served.running.refused(json!({"command": "cancel", "of": "slow"}));
    assert!(message.contains("no command with the id \"slow\""), "{message}");
    assert!(!served.tree.beside("a.gif").exists());
    served.quit();
}

#[test]
fn the_end_of_the_input_answers_what_came_before() {
    let tree = Tree::new();
    let mut served = Served::start(tree, &["sphere-grid"]);
    for file in ["a.npy", "b.npy"] {
        served
            .running
            .say(&json!({"id": file, "command": "picture", "file": file, "raw": file == "b.npy"}).to_string());
    }
    served.running.end_input();
    for file in ["a.npy", "b.npy"] {
        let answer = served.running.until(file, |event| event["id"] == file && event["event"] != "progress");
        assert_eq!(answer["event"], "done", "{answer}");
        assert!(served.tree.beside(file).exists());
    }
    assert_eq!(served.running.end().code(), Some(0), "{}", served.running.story());
    assert_eq!(served.left(), [] as [std::path::PathBuf; 0]);
}

#[test]
fn signals_and_the_end_of_the_parent_leave_nothing() {
    // Its end comes while a bake and a picture are under way, which take longer than the test waits.
    for signal in ["TERM", "INT", "HUP", "KILL"] {
        let options = ["sphere-grid", "--env", "studio", "--socket", "session"];
        let mut served = Served::with_fault(Tree::new(), &options, "bake-delay-ms:600000");
        served.running.event("listening");
        served.running.say(r#"{"id": 1, "command": "picture", "file": "a.npy"}"#);
        served.running.done(json!({"command": "get", "path": "view.ev"}));
        assert!(served.left().iter().any(|path| path.ends_with("session.sock")), "{:?}", served.left());
        served.running.signal(signal);
        // All processes that have its output have ended.
        let status = served.running.end();
        assert_eq!(status.signal(), Some(number_of(signal)), "{signal}: {}", served.running.story());
        assert_eq!(served.left(), [] as [std::path::PathBuf; 0], "{signal}");
        assert!(!served.tree.beside("a.npy").exists());
    }
}

fn number_of(signal: &str) -> i32 {
    let numbers = [("HUP", 1), ("INT", 2), ("KILL", 9), ("TERM", 15)];
    numbers.iter().find(|(name, _)| *name == signal).unwrap().1
}

#[test]
fn a_reader_that_has_gone_ends_the_session() {
    let tree = Tree::new();
    let command =
        Served::command(&tree, &["sphere-grid", "--shaders", "shaders", "--env", "studio", "--size", "96x64"]);
    // The reader ends after the first line; the picture would wait for the bake.
    let lines = r#"{"command": "get", "path": "view.ev"}\n{"command": "picture", "file": "a.npy"}\n"#;
    let script = format!("printf '{lines}' | SPECULA_FAULT=bake-delay-ms:600000 \"$0\" \"$@\" | head -n 1");
    let finished = finish(in_shell(&command, &script).current_dir(tree.beside("")));
    assert!(finished.json()["event"].is_string(), "{finished:#?}");
    let left: Vec<_> = std::fs::read_dir(tree.beside("runtime")).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn a_loss_costs_the_open_commands_alone() {
    let mut served = Served::with_fault(Tree::new(), &["sphere-grid"], "by-name:1");
    served.running.done(json!({"command": "set", "values": {"view.ev": 2}}));
    let picture = served.picture("a.npy", &json!({}));

    // Somebody kills the process that draws.
    send_signal(served.running.worker(), "KILL");
    let event = served.running.event("restarted");
    assert!(event["cause"].as_str().unwrap().contains("killed"), "{event}");
    assert!(served.picture("a.npy", &json!({})) == picture, "the picture did not come back");

    // A text that loses the device.
    let text = served.tree.read("user.glsl");
    let hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    let deadly = "float lose_the_device(float x) { return 0.5 * x; }";
    let edited = text.replace(hook, &format!("{deadly}\n{hook}\n    s.roughness = lose_the_device(s.roughness);"));
    assert_ne!(edited, text);
    served.running.say(&json!({"id": "edit", "command": "edit", "file": "user.glsl", "text": edited}).to_string());
    let event = served.running.event("restarted");
    assert_eq!(event["refused"], json!(["user.glsl"]), "{event}");
    assert!(served.picture("a.npy", &json!({})) == picture, "the refused text is drawn");
    served.running.done(json!({"command": "edit", "file": "user.glsl", "text": text}));
    assert!(served.picture("a.npy", &json!({})) == picture, "the repaired text is not drawn");
    served.quit();
}

#[test]
fn nothing_is_drawn_for_nobody() {
    let mut served = Served::start(Tree::new(), &["sphere-grid", "--set", "lights.spin=30"]);
    let picture = served.picture("a.npy", &json!({}));
    served.rests();
    assert!(served.picture("a.npy", &json!({})) == picture, "lights orbit");

    // A shader that reads the time stands still, until the clock is started or moved.
    let time = served.tree.edited(
        "user.glsl",
        "void user_surface(inout Surface s, Fragment f, vec3 v) {",
        "void user_surface(inout Surface s, Fragment f, vec3 v) {\n    s.base_color *= fract(0.25 + 0.1 * frame.time_s);",
    );
    served.running.done(json!({"command": "edit", "file": "user.glsl", "text": time}));
    let first = served.picture("a.npy", &json!({}));
    assert!(first != picture && served.picture("a.npy", &json!({})) == first, "the time runs");
    served.running.done(json!({"command": "playback", "time": 2.5}));
    let later = served.picture("a.npy", &json!({}));
    assert!(later != first, "the clock was not moved");
    served.running.done(json!({"command": "playback", "paused": false}));
    served.rests();
    assert!(served.picture("a.npy", &json!({})) != later, "the clock does not run");
    served.quit();
}

#[test]
fn a_wrong_start_is_told() {
    let tree = Tree::new();
    let start = |options: &[&str]| finish(Served::command(&tree, options).stdin(Stdio::null()));
    start(&["--size", "96x64", "--mode", "final", "--set", "view.evv=1"]).expect(2, &["view.evv"]);
    start(&["nothing.glb"]).expect(1, &["nothing.glb"]);
    start(&["--size", "100000x64"]).expect(2, &["--size 100000x64", "draws 1 to"]);
    start(&["--device", "abacus"]).expect(3, &["abacus"]);
}

#[test]
fn there_is_no_picture_without_the_model_that_was_asked_for() {
    let tree = Tree::new();
    std::fs::write(tree.beside("bad.glb"), "glTF").unwrap();
    let mut served = Served::start(tree, &["bad.glb"]);
    let why = served.running.refused(json!({"command": "picture", "file": "a.npy"}));
    assert!(why.contains("bad.glb"), "{why}");
    served.running.done(json!({"command": "open", "model": "sphere-grid"}));
    served.picture("a.npy", &json!({}));
    served.quit();
}

/// A file of another playground is compiled with some words changed; a program reads and writes it as its author wrote it.
#[test]
fn a_single_file_is_read_and_written_as_its_author_wrote_it() {
    const WAVE: &str = "uniform vec2 u_resolution;\nvoid main() {\n    float sum;\n    for (int i = 0; i < 4; i++) sum += 0.1;\n    gl_FragColor = vec4(sum, 0.5, 0.0, 1.0);\n}\n";
    let tree = Tree::new();
    std::fs::write(tree.beside("wave.frag"), WAVE).unwrap();
    let mut served = Served::start(tree, &["--shaders", "wave.frag"]);
    let files = served.running.done(json!({"command": "files"}));
    assert_eq!(files["files"][0], "opened/wave.frag", "{files}");
    let read = served.running.done(json!({"command": "file", "file": "opened/wave.frag"}));
    assert_eq!(read["text"], WAVE);
    let picture = served.picture("a.npy", &json!({}));
    let text = WAVE.replace("sum += 0.1", "sum += 0.2");
    served.running.done(json!({"command": "edit", "file": "opened/wave.frag", "text": text, "base": WAVE}));
    assert_eq!(std::fs::read_to_string(served.tree.beside("wave.frag")).unwrap(), text);
    assert!(served.picture("a.npy", &json!({})) != picture, "the edit changes nothing");
    served.running.done(json!({"command": "undo"}));
    assert_eq!(std::fs::read_to_string(served.tree.beside("wave.frag")).unwrap(), WAVE);
    assert!(served.picture("a.npy", &json!({})) == picture);
    let around = served.running.refused(json!({"command": "edit", "file": "toy.glsl", "text": "float x;\n"}));
    assert!(around.contains("single file, opened/wave.frag"), "{around}");
    served.quit();
}
