//! `specula mcp`: a server for agents, with the official client.

use std::path::Path;
use std::process::Command;

use image::RgbaImage;
use serde_json::json;

use super::python::{interpreter, run_script, run_script_with};
use crate::support::window::Viewer;
use crate::support::{Tree, open_image};

#[test]
fn an_agent_sees_edits_and_measures() {
    run_script("agent.py", tempfile::tempdir().unwrap().path());
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
