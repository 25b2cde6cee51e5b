//! Code actions: fixes, sliders, expressions over the model.

use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::net::UnixStream;

use serde_json::{Value, json};

use super::client::{Client, Opened, place, uri};
use crate::support::process::{run, specula};
use crate::support::window::{Display, Viewer};
use crate::support::{Tree, glb};

/// The actions at a place, by their titles.
#[track_caller]
fn actions(opened: &mut Opened, what: &str, plus: usize) -> Vec<Value> {
    let at = place(&opened.text, what, plus);
    let params = json!({ "textDocument": { "uri": uri(&opened.path) }, "range": { "start": at, "end": at }, "context": { "diagnostics": [] } });
    opened.client.ask("textDocument/codeAction", params).as_array().unwrap().clone()
}

fn titled<'a>(actions: &'a [Value], title: &str) -> &'a Value {
    let found = actions.iter().find(|action| action["title"].as_str().unwrap().starts_with(title));
    found.unwrap_or_else(|| panic!("no `{title}` in {actions:#?}"))
}

#[test]
fn a_misspelled_name_is_mended_by_its_fix() {
    let mut opened = Opened::new("brdf/ndf.glsl");
    let path = opened.path.clone();
    opened.edit("float a2 = alpha * alpha;", "float a2 = /* 𝄞 */ alpah * alpha;");
    opened.client.diagnostics(&path, |all| !all.is_empty());
    let found = actions(&mut opened, "alpah", 2);
    let fix = titled(&found, "Change to `alpha`");
    let edit = &fix["edit"]["changes"][uri(&path)][0];
    assert_eq!(
        (&fix["kind"], &fix["isPreferred"], &edit["newText"]),
        (&json!("quickfix"), &json!(true), &json!("alpha"))
    );
    assert_eq!(edit["range"]["start"], place(&opened.text, "alpah", 0));
    // A fix of a text that has changed since would be wrong.
    let wrong = opened.text.replace("alpah * alpha", "alpah * 2.0");
    opened.client.change(&path, &wrong);
    let mended = opened.client.diagnostics(&path, |all| !all.is_empty());
    assert_eq!(mended.len(), 1);
    opened.edit("alpah * alpha;", "alpha * alpha\n");
    opened.client.forget();
    opened
        .client
        .diagnostics(&path, |all| all.iter().any(|one| one["message"].as_str().unwrap().contains("does not end with")));
    let line = opened.line("float spread = n_dot_h");
    let found = actions(&mut opened, "float spread = n_dot_h", 1);
    let fix = titled(&found, "End line");
    let at = &fix["edit"]["changes"][uri(&path)][0]["range"]["start"];
    assert_eq!(at["line"].as_u64().map(|at| at as u32), Some(line - 2), "{fix:#}");
    opened.client.quit();
}

#[test]
fn a_number_becomes_a_slider_and_the_tree_compiles() {
    let mut opened = Opened::new("brdf/ndf.glsl");
    assert!(actions(&mut opened, "float a2 = alpha", 6).is_empty());
    let found = actions(&mut opened, "max(h_ts.z * h_ts.z, 1e-6)", 22);
    let slider = titled(&found, "Make a slider of this number: cos2_amount");
    let changes = slider["edit"]["changes"].as_object().unwrap();
    let params = opened.tree.path("user/params.glsl");
    assert_eq!(changes[&uri(&params)][0]["newText"], "    float cos2_amount; //@ui \"Cos2 amount\" 0..1 = 0.000001\n");
    for (uri, edits) in changes {
        let path = std::path::Path::new(uri.strip_prefix("file://").unwrap());
        let text = std::fs::read_to_string(path).unwrap();
        let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
        let mut edits = edits.as_array().unwrap().clone();
        edits.sort_by_key(|edit| edit["range"]["start"]["line"].as_u64());
        for edit in edits.iter().rev() {
            let number = |end: &str, part: &str| edit["range"][end][part].as_u64().unwrap() as usize;
            let columns = number("start", "character")..number("end", "character");
            lines[number("start", "line")].replace_range(columns, edit["newText"].as_str().unwrap());
        }
        std::fs::write(path, lines.join("\n")).unwrap();
    }
    assert!(opened.tree.read("brdf/ndf.glsl").contains("max(h_ts.z * h_ts.z, cos2_amount)"));
    let root = opened.tree.root();
    run(root.parent().unwrap(), &["modes", "--shaders", root.to_str().unwrap()]).expect(0, &[]);
    opened.client.quit();
}

#[test]
fn without_a_window_nothing_is_offered_to_show() {
    let mut opened = Opened::with("brdf/ndf.glsl", &["--socket", "/nowhere/none.sock"]);
    let found = actions(&mut opened, "a2 / (PI", 1);
    assert!(found.is_empty(), "{found:#?}");
    let path = opened.path.clone();
    let why = opened.client.refused(
        "workspace/executeCommand",
        json!({ "command": "specula.showOverModel", "arguments": [uri(&path), 22, "a2"] }),
    );
    assert!(why.contains("no window listens"), "{why}");
    opened.client.quit();
}

/// The answer of a window to a command on its socket.
fn asked(socket: &std::path::Path, command: &Value) -> Value {
    let mut stream = UnixStream::connect(socket).unwrap();
    writeln!(stream, "{command}").unwrap();
    let lines = BufReader::new(stream).lines().map(|line| serde_json::from_str::<Value>(&line.unwrap()).unwrap());
    lines.into_iter().find(|answer| answer["id"] == command["id"]).expect("an answer")
}

#[test]
fn a_running_window_shows_the_value_at_the_cursor() {
    let tree = Tree::new();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let mut viewer = Viewer::open(tree, &["model.glb", "--socket", "edited"]);
    viewer.running.event("ready");
    let socket = viewer.tree.beside("runtime/specula/edited.sock");
    let path = viewer.tree.path("user.glsl");
    let text = viewer.tree.read("user.glsl");
    let client = Client::start(&viewer.tree.root(), &["--socket", socket.to_str().unwrap()]);
    let mut opened = Opened { tree: Tree::new(), client, path, text };
    let (path, text) = (opened.path.clone(), opened.text.clone());
    opened.client.open(&path, &text);
    let found = actions(&mut opened, "saturate(s.roughness", 12);
    let show = titled(&found, "Show `s.roughness` over the model");
    let line = opened.line("saturate(s.roughness") + 1;
    assert_eq!(show["command"]["arguments"], json!([uri(&path), line, "s.roughness"]));
    let (command, arguments) = (show["command"]["command"].clone(), show["command"]["arguments"].clone());
    opened.client.ask("workspace/executeCommand", json!({ "command": command, "arguments": arguments }));
    let settings = asked(&socket, &json!({ "id": 1, "command": "get" }))["result"].clone();
    assert_eq!(settings["mode"], "expression");
    assert_eq!(settings["expression"]["at"], format!("{}:{line}:s.roughness", path.display()));
    viewer.until("the roughness of the model", |shot| {
        // The same gray as in the mode of the roughness.
        let pixel = shot.get_pixel(shot.width() / 2, shot.height() / 2);
        pixel.0[0] == pixel.0[1] && pixel.0[1] == pixel.0[2]
    });
    opened.client.quit();
    viewer.quit();
}

#[test]
fn a_window_on_the_tree_is_opened_from_the_editor() {
    let (display, tree) = (Display::new(), Tree::new());
    let runtime = tree.beside("runtime");
    std::fs::create_dir_all(&runtime).unwrap();
    std::fs::write(tree.beside("model.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let command = || {
        let mut command = specula(&tree.beside(""));
        command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").env("XDG_STATE_HOME", tree.beside("state"));
        command.env("DISPLAY", display.name()).env("XDG_RUNTIME_DIR", &runtime);
        command
    };
    let path = tree.path("user.glsl");
    let open = json!({ "command": "specula.openWindow", "arguments": [uri(&path)] });
    let mut client = Client::start_as(command(), &tree.root(), &["model.glb", "--socket", "opened"]);
    let of_none = json!({ "command": "specula.openWindow", "arguments": [] });
    assert!(client.refused("workspace/executeCommand", of_none).contains("no file of a shader tree"));
    client.open(&path, &tree.read("user.glsl"));
    client.ask("workspace/executeCommand", open.clone());
    let socket = runtime.join("specula/opened.sock");
    assert_eq!(asked(&socket, &json!({ "id": 1, "command": "pinned" }))["result"]["tree"], json!(tree.root()));
    asked(&socket, &json!({ "id": 2, "command": "quit" }));
    client.quit();
    // Without a display, the reason is told.
    let mut without = command();
    without.env("DISPLAY", ":nothing");
    let mut client = Client::start_as(without, &tree.root(), &["model.glb", "--socket", "other"]);
    client.open(&path, &tree.read("user.glsl"));
    let why = client.refused("workspace/executeCommand", open);
    assert!(why.contains("no display"), "{why}");
    client.quit();
}
