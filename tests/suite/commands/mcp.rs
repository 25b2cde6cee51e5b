//! `specula mcp`: a server for agents, with the official client.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;

use image::RgbaImage;
use serde_json::{Value, json};

use super::python::{interpreter, run_script, run_script_with};
use crate::support::process::{PATIENCE, specula};
use crate::support::window::Viewer;
use crate::support::{Tree, open_image};

#[test]
fn an_agent_sees_edits_and_measures() {
    run_script("agent.py", tempfile::tempdir().unwrap().path());
}

/// A message that is too long is answered with its own number, wherever that stands, and the next one is read.
#[test]
fn long_messages_and_clients_that_vanish_hold_up_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut server = specula(folder.path());
    let mut server = server.arg("mcp").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let (mut input, output) = (server.stdin.take().unwrap(), server.stdout.take().unwrap());
    let mut lines = BufReader::new(output).lines();
    let text = "x".repeat(17 << 20);
    for line in [
        format!(r#"{{"jsonrpc":"2.0","id":1,"method":"ping","params":{{"text":"{text}"}}}}"#),
        format!(r#"{{"params":{{"id":7,"text":"{text}"}},"method":"ping","id":"two"}}"#),
        format!(r#"{{"params":"{text}"#),
    ] {
        writeln!(input, "{line}").unwrap();
    }
    writeln!(input, r#"{{"jsonrpc":"2.0","id":4,"method":"ping"}}"#).unwrap();
    let mut answer = || -> Value { serde_json::from_str(&lines.next().unwrap().unwrap()).unwrap() };
    for id in [json!(1), json!("two"), json!(null)] {
        let answer = answer();
        assert_eq!(answer["id"], id);
        assert!(answer["error"]["message"].as_str().unwrap().contains("longer than"), "{answer}");
    }
    assert_eq!(answer(), json!({"jsonrpc": "2.0", "id": 4, "result": {}}));
    // Nobody reads the answer to a call that takes longer than this test waits.
    let paths = json!({"name": "render", "arguments": {"mode": "path-traced", "size": [1280, 720]}});
    writeln!(input, "{}", json!({"jsonrpc": "2.0", "id": 5, "method": "tools/call", "params": paths})).unwrap();
    drop(lines);
    let (sender, ended) = channel();
    std::thread::spawn(move || sender.send(server.wait()));
    let status = ended.recv_timeout(PATIENCE).expect("the server goes on without a client").unwrap();
    assert_eq!(status.code(), Some(0));
}

/// Whether two pictures differ by no more than the dither of a window.
fn is_alike(a: &RgbaImage, b: &RgbaImage) -> bool {
    a.dimensions() == b.dimensions() && a.as_raw().iter().zip(b.as_raw()).all(|(a, b)| a.abs_diff(*b) <= 2)
}

/// Runs an agent beside the window's folders.
fn run_agent(folder: &Path, socket: &str, is_allowed: bool) {
    let allowed = if is_allowed { "allowed" } else { "refused" };
    run_script_with(Command::new(interpreter()), ("agent_window.py", &[socket, allowed]), folder);
}

#[test]
fn an_agent_works_in_a_window_that_listens() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid", "--socket", "agent"]);
    viewer.running.event("ready");
    let before = viewer.screenshot();
    let folder = viewer.tree.beside("");
    run_agent(&folder, "agent", true);
    let seen = |name: &str| open_image(&folder.join(name)).into_rgba8();
    let [first, brighter, kept, edited] = ["first.png", "brighter.png", "kept.png", "edited.png"].map(seen);
    assert!(is_alike(&first, &before), "the agent sees another picture than the window shows");
    assert!(!is_alike(&brighter, &first) && brighter == kept && !is_alike(&edited, &brighter));
    // The user sees what the agent has changed, and can go on.
    assert!(is_alike(&viewer.screenshot(), &edited), "the window shows another picture than the agent has made");
    assert_eq!(viewer.running.done(json!({"command": "get", "path": "view.ev"})), json!(2.0));
    assert!(viewer.tree.read("brdf/ndf.glsl").contains("float a2 = alpha;"));
    // Another name is another window, which there is not.
    run_agent(&folder, "other", false);
    viewer.quit();
}

#[test]
fn an_agent_is_refused_by_a_window_that_does_not_listen() {
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let (before, text) = (viewer.screenshot(), viewer.tree.read("brdf/ndf.glsl"));
    run_agent(&viewer.tree.beside(""), "agent", false);
    viewer.shows(&before, "the window has changed");
    assert_eq!(viewer.tree.read("brdf/ndf.glsl"), text);
    viewer.quit();
}
