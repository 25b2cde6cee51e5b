//! Values at a pinned pixel beside the lines.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::unix::net::UnixStream;
use std::time::Instant;

use serde_json::{Value, json};

use super::client::{Client, Opened, uri};
use crate::support::Tree;
use crate::support::process::{run, specula};
use crate::support::window::Viewer;

const NDF: &str = "brdf/ndf.glsl";

pub(super) const OPTIONS: [&str; 7] = ["--env", "none", "--size", "96x64", "--validate", "--set", "view.msaa=1"];
pub(super) const PIN: [u32; 2] = [50, 30];
const REFRESH: &str = "workspace/inlayHint/refresh";

/// The hints of the open file by their lines, from 0.
fn hints(opened: &mut Opened) -> BTreeMap<u64, String> {
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 1000, "character": 0 } });
    let params = json!({ "textDocument": { "uri": uri(&opened.path) }, "range": range });
    let all = opened.client.ask("textDocument/inlayHint", params);
    let of = |hint: &Value| (hint["position"]["line"].as_u64().unwrap(), hint["label"].as_str().unwrap().to_owned());
    all.as_array().unwrap().iter().map(of).collect()
}

/// The rows that `specula trace` prints for the lines of the file, from 0, and what its JSON says that they do.
fn traced(opened: &Opened) -> BTreeMap<u64, (String, String)> {
    let root = opened.tree.root();
    let at = format!("{},{}", PIN[0], PIN[1]);
    let more = ["--shaders", root.to_str().unwrap(), "--at", &at, "--file", "brdf/ndf.glsl"];
    let trace = |json: &[&str]| run(&root, &[&["trace"][..], &more, json, &OPTIONS].concat());
    let rows = trace(&[]).expect(0, &[]).stdout.clone();
    let done = |done: &Value| {
        let text = |key: &str| done[key].as_str().unwrap().to_owned();
        format!("{} {} {}", text("act"), text("name"), done["count"])
    };
    let line = |line: &Value| {
        let number = line["line"].as_u64().unwrap();
        let is_row = |row: &&str| row.trim_start().starts_with(&format!("{number}  "));
        let row = rows.lines().find(is_row).unwrap_or_else(|| panic!("no row {number} in {rows}"));
        let words: Vec<String> = line["done"].as_array().unwrap().iter().map(done).collect();
        (number - 1, (row.to_owned(), words.join("; ")))
    };
    trace(&["--json"]).expect(0, &[]).json()["lines"].as_array().unwrap().iter().map(line).collect()
}

/// Fails unless the hints are what `specula trace` says.
#[track_caller]
fn assert_traced(opened: &Opened, shown: &BTreeMap<u64, String>) -> BTreeMap<u64, (String, String)> {
    let trace = traced(opened);
    assert!(shown.len() > 2 && shown.keys().eq(trace.keys()), "{shown:#?} {trace:#?}");
    for (line, text) in shown {
        assert!(trace[line].0.ends_with(&format!("  {text}")), "line {line}: {text}, but {:?}", trace[line]);
    }
    trace
}

#[test]
fn hints_are_those_of_the_trace_and_follow_edits() {
    let mut opened = Opened::with("brdf/ndf.glsl", &OPTIONS);
    assert!(hints(&mut opened).is_empty(), "no pixel is pinned");
    let pinned =
        opened.client.ask("workspace/executeCommand", json!({ "command": "specula.pinPixel", "arguments": PIN }));
    assert_eq!(
        (&pinned["pixel"], &pinned["files"], &pinned["proof"]),
        (&json!(PIN), &json!(["brdf/ndf.glsl"]), &json!("equal to the picture"))
    );
    opened.client.until("a refresh of hints", |message| message["method"] == REFRESH);
    let shown = hints(&mut opened);
    let trace = assert_traced(&opened, &shown);
    let squared = u64::from(opened.line("float a2 = alpha"));
    assert_eq!(trace[&squared].1, "store a2 2");
    assert!(shown[&squared].starts_with("a2 = 0.") && shown[&squared].ends_with(" ×2"), "{shown:#?}");

    // Two lines above move all; the changed one has none.
    opened.edit("// D: the normal", "// More.\n// Lines.\n// D: the normal");
    opened.edit("float a2 = alpha * alpha;", "float a2 = alpha * alpha * 0.5;");
    let moved = hints(&mut opened);
    let expected: BTreeMap<u64, String> =
        shown.iter().filter(|(line, _)| **line != squared).map(|(line, text)| (line + 2, text.clone())).collect();
    assert_eq!(moved, expected);
    let hover = opened.ask("hover", "float spread = n_dot_h", 7);
    assert!(hover["contents"]["value"].as_str().unwrap().contains("At the pinned pixel: `spread = "), "{hover:#}");

    // A save is traced again.
    let text = opened.text.clone();
    opened.tree.write("brdf/ndf.glsl", &text);
    opened.client.until("a refresh of hints", |message| message["method"] == REFRESH);
    let saved = hints(&mut opened);
    assert!(saved.contains_key(&(squared + 2)) && saved[&(squared + 2)] != shown[&squared], "{saved:#?}");
    assert_traced(&opened, &saved);

    opened.client.ask("workspace/executeCommand", json!({ "command": "specula.unpinPixel" }));
    assert!(hints(&mut opened).is_empty());
    opened.client.quit();
}

/// A window of the same tree, in which a pixel is clicked.
#[test]
fn hints_follow_the_pixel_that_is_pinned_in_a_window() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid", "--socket", "followed"]);
    viewer.running.event("ready");
    let socket = viewer.tree.beside("runtime/specula/followed.sock");
    let mut window = BufReader::new(UnixStream::connect(&socket).unwrap());
    let mut id = 0;
    let mut command = |mut command: Value| {
        id += 1;
        command["id"] = id.into();
        writeln!(window.get_mut(), "{command}").unwrap();
        let mut line = String::new();
        loop {
            line.clear();
            window.read_line(&mut line).unwrap();
            let answer: Value = serde_json::from_str(&line).unwrap();
            if answer["id"] == id && answer["event"] != "progress" {
                assert_eq!(answer["event"], "done", "{command}: {answer}");
                return answer["result"].clone();
            }
        }
    };
    let (path, text) = (viewer.tree.path(NDF), viewer.tree.read(NDF));
    let client = Client::start(&viewer.tree.root(), &["--socket", socket.to_str().unwrap()]);
    let mut opened = Opened { tree: Tree::new(), client, path: path.clone(), text: text.clone() };
    opened.client.open(&path, &text);
    assert!(hints(&mut opened).is_empty(), "no pixel is pinned in the window");
    let refreshed = |message: &Value| message["method"] == REFRESH;
    let center = command(json!({ "command": "capture" }));
    let at = [center["width"].as_u64().unwrap() / 2, center["height"].as_u64().unwrap() / 2];
    command(json!({ "command": "pick", "at": at }));
    opened.client.until("hints of the window", refreshed);
    let shown = hints(&mut opened);
    let of_window = command(json!({ "command": "trace", "file": NDF }));
    assert_eq!(of_window["proof"]["equal"], true, "{}", of_window["proof"]);
    let lines = of_window["lines"].as_array().unwrap().iter();
    let expected = lines.map(|line| (line["line"].as_u64().unwrap() - 1, line["text"].as_str().unwrap().to_owned()));
    assert_eq!(shown, expected.collect::<BTreeMap<_, _>>());
    assert!(shown.len() > 2, "{shown:?}");

    // A save that changes the values.
    let squared = u64::from(opened.line("float a2 = alpha"));
    viewer.tree.write(NDF, &text.replace("float a2 = alpha * alpha;", "float a2 = alpha * alpha * 0.5;"));
    opened.edit("float a2 = alpha * alpha;", "float a2 = alpha * alpha * 0.5;");
    opened.client.until("hints after a save", refreshed);
    let saved = hints(&mut opened);
    assert!(saved.contains_key(&squared) && saved[&squared] != shown[&squared], "{saved:?}");

    command(json!({ "command": "pick" }));
    opened.client.until("no hints", refreshed);
    assert!(hints(&mut opened).is_empty());
    opened.client.quit();
    viewer.quit();
}

/// Without `--socket`, the server looks for windows of its tree where they listen.
#[test]
fn hints_follow_a_window_that_nobody_has_named() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid", "--socket", "unnamed"]);
    viewer.running.event("ready");
    let (path, text) = (viewer.tree.path(NDF), viewer.tree.read(NDF));
    let mut command = specula(&viewer.tree.root());
    command.env("XDG_RUNTIME_DIR", viewer.tree.beside("runtime"));
    let client = Client::start_as(command, &viewer.tree.root(), &[]);
    let mut opened = Opened { tree: Tree::new(), client, path: path.clone(), text: text.clone() };
    opened.client.open(&path, &text);
    assert!(hints(&mut opened).is_empty(), "no pixel is pinned in the window");
    let center = viewer.running.done(json!({ "command": "capture" }));
    let at = [&center["width"], &center["height"]].map(|side| side.as_u64().unwrap() / 2);
    viewer.running.done(json!({ "command": "pick", "at": at }));
    opened.client.until("hints of the window", |message| message["method"] == REFRESH);
    let shown = hints(&mut opened);
    let of_window = viewer.running.done(json!({ "command": "trace", "file": NDF }));
    let lines: Vec<u64> =
        of_window["lines"].as_array().unwrap().iter().map(|line| line["line"].as_u64().unwrap() - 1).collect();
    assert!(shown.len() > 2 && shown.keys().copied().eq(lines), "{shown:?} {of_window}");
    opened.client.quit();
    viewer.quit();
}

/// At most five refreshes a second, and one after the last change.
#[test]
fn hints_that_change_often_are_refreshed_five_times_a_second() {
    let mut opened = Opened::with(NDF, &OPTIONS);
    let unpin = json!({ "command": "specula.unpinPixel" });
    let asked = (0..100).map(|_| opened.client.request("workspace/executeCommand", unpin.clone()));
    let (ids, requests): (Vec<i64>, Vec<Value>) = asked.unzip();
    let begin = Instant::now();
    opened.client.send_all(&requests);
    ids.iter().for_each(|id| drop(opened.client.answer(*id)));
    // Between the first and the last of them is a fifth of a second each.
    let most = 1 + begin.elapsed().as_millis() / 200;
    let count = opened.client.count(REFRESH);
    assert!(count >= 1 && count as u128 <= most, "{count} refreshes, but at most {most}");
    opened.client.forget();
    opened.client.until("the refresh after the last change", |message| message["method"] == REFRESH);

    // The newest values come in the end.
    opened.client.ask("workspace/executeCommand", json!({ "command": "specula.pinPixel", "arguments": PIN }));
    opened.client.forget();
    opened.client.until("the refresh after the trace", |message| message["method"] == REFRESH);
    assert!(hints(&mut opened).len() > 2);
    opened.client.quit();
}

#[test]
fn a_pixel_that_cannot_be_traced_says_why() {
    let mut opened = Opened::with("brdf/ndf.glsl", &OPTIONS);
    let mut pin = |arguments: Value| {
        opened
            .client
            .refused("workspace/executeCommand", json!({ "command": "specula.pinPixel", "arguments": arguments }))
    };
    assert!(pin(json!([96, 0])).contains("outside of the picture (96x64)"));
    assert!(pin(json!(["a"])).contains("expected a pixel"));
    assert!(pin(json!([0, 0])).contains("the model does not cover the pixel 0,0"));
    opened.client.quit();
}
