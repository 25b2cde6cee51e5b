//! A window in hostile surroundings: killed processes, signals, and output that nobody takes.

use std::process::Stdio;

use super::NDF;
use crate::support::Tree;
use crate::support::process::{Running, in_shell, send_signal};
use crate::support::window::{Display, Viewer};

/// The names in the folder of sockets and of the records of sessions.
fn left(tree: &Tree) -> Vec<String> {
    let mut names = Vec::new();
    for folder in ["runtime", "runtime/specula"] {
        let entries = std::fs::read_dir(tree.beside(folder)).into_iter().flatten().flatten();
        names.extend(entries.map(|entry| entry.file_name().into_string().unwrap()));
    }
    names.retain(|name| name.starts_with("specula-") || name.ends_with(".sock"));
    names
}

#[test]
fn a_killed_process_comes_back_with_its_session() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid"]);
    viewer.running.event("ready");
    let first = viewer.screenshot();
    viewer.key("n");
    viewer.until("shading normals", |shot| *shot != first);
    let before = viewer.screenshot();
    send_signal(viewer.running.worker(), "KILL");
    let event = viewer.restarted();
    assert!(event["cause"].as_str().unwrap().contains("was killed (SIGKILL)"), "{event}");
    assert_eq!((&event["refused"], &event["reset"]), (&serde_json::json!([]), &serde_json::json!([])), "{event}");
    viewer.running.event("ready");
    assert!(viewer.screenshot() == before, "the mode did not come back");
    viewer.quit();
}

#[test]
fn signals_leave_no_socket_and_no_records() {
    // A program that starts with a signal ignored, as below `nohup`, goes on ignoring it.
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap().trim();
    let ignored = u64::from_str_radix(ignored, 16).unwrap();
    for (signal, number) in [("TERM", 15), ("INT", 2), ("HUP", 1)] {
        if (ignored >> (number - 1)) & 1 == 1 {
            continue;
        }
        let mut viewer = Viewer::open(Tree::new(), &["sphere-grid", "--socket", "attacked"]);
        assert_eq!(left(&viewer.tree).len(), 2, "{:?}", left(&viewer.tree));
        viewer.running.signal(signal);
        viewer.running.end();
        assert_eq!(left(&viewer.tree), [""; 0], "{signal}");
    }
}

/// A stopped process sees nothing of the end of its supervisor.
#[test]
fn a_stopped_window_ends_with_its_supervisor() {
    let mut viewer = Viewer::open(Tree::new(), &["sphere-grid", "--socket", "attacked"]);
    viewer.running.event("ready");
    send_signal(viewer.running.worker(), "STOP");
    viewer.running.signal("KILL");
    viewer.running.end();
    assert_eq!(left(&viewer.tree), [""; 0]);
}

#[test]
fn a_broken_save_costs_nothing_when_stderr_takes_nothing() {
    for stderr in ["2>/dev/full", "2>&1 >&3 | true"] {
        let (display, tree) = (Display::new(), Tree::new());
        let mut command = display.view(&tree);
        command.args(["sphere-grid", "--env", "none", "--size", "320x240", "--shaders", "shaders"]);
        let script = format!("exec 3>&1; \"$0\" \"$@\" {stderr}");
        let mut running = Running::start(in_shell(&command, &script).current_dir(tree.beside("")).stdin(Stdio::null()));
        running.event("ready");
        let sound = tree.read(NDF);
        tree.write(NDF, &tree.edited(NDF, "alpha * alpha;", "alpha * alfa;"));
        running.reload(false);
        tree.write(NDF, &sound.replace("alpha * alpha;", "alpha;"));
        running.reload(true);
    }
}

#[test]
fn a_capture_of_many_frames_is_limited_and_ends_when_it_is_canceled() {
    use serde_json::json;
    let mut viewer = Viewer::driven(Tree::new(), &["sphere-grid", "--size", "320x240"]);
    viewer.running.event("ready");
    let many = |frames: u32| json!({ "command": "capture", "frames": frames, "size": [320, 240], "file": "many.png" });
    for frames in [0, 10_001, u32::MAX] {
        let refused = viewer.running.refused(many(frames));
        assert!(refused.contains("it can be 1 to 10000"), "{refused}");
    }
    viewer
        .running
        .say(&json!({ "command": "capture", "frames": 10_000, "size": [640, 480], "id": "long" }).to_string());
    viewer.running.until("the capture to begin", |event| event["event"] == "progress" && event["id"] == "long");
    // The work has ended when the answer comes.
    let mut has_ended = false;
    viewer.running.say(&json!({ "command": "cancel", "id": "cancel" }).to_string());
    let answer = viewer.running.until("the answer", |event| {
        has_ended |= event["id"] == "long" && event["event"] == "error";
        event["id"] == "cancel"
    });
    assert!(has_ended && answer["event"] == "done", "{answer}");
    // The next capture waits for the one before.
    viewer.running.done(json!({ "command": "capture", "frames": 2, "size": [32, 32], "file": "small.png" }));
    viewer
        .running
        .say(&json!({ "command": "capture", "frames": 10_000, "size": [640, 480], "id": "last" }).to_string());
    viewer.running.until("the capture to begin", |event| event["event"] == "progress" && event["id"] == "last");
    let mut has_ended = false;
    viewer.running.say(&json!({ "command": "quit", "id": "quit" }).to_string());
    let answer = viewer.running.until("the answer", |event| {
        has_ended |= event["id"] == "last" && event["event"] == "error";
        event["id"] == "quit"
    });
    assert!(has_ended && answer["event"] == "done", "{answer}");
    assert!(viewer.running.end().success());
}
