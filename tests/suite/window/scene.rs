//! Selecting by a click, and hiding what is selected.

use super::controls::count;
use crate::support::Tree;
use crate::support::window::Viewer;

/// The outline, as `src/app/widgets/theme.rs` has it.
const SELECTION: [u8; 3] = [255, 160, 48];

#[test]
fn a_click_selects_and_keys_hide_and_show_again() {
    let mut viewer = Viewer::open(Tree::new(), &["shader-ball"]);
    viewer.running.event("ready");
    // Without panels, the picture fills the window.
    viewer.key("h");
    viewer.until("the whole window", |shot| shot.dimensions() == (640, 480));
    let first = viewer.screenshot();
    viewer.click((320, 240));
    let selected = viewer.running.event("selected");
    let has = |name: &str| selected[name].as_str().is_some_and(|name| !name.is_empty());
    assert!(has("node") && has("primitive") && has("material") && selected["instance"].is_u64(), "{selected}");
    viewer.until_screen("the outline", |screen| count(screen, 0..640, 0..480, SELECTION) > 100);
    assert!(viewer.screenshot() == first, "a screenshot has the outline");

    viewer.key("ctrl+h");
    let nothing = viewer.running.event("selected");
    assert!(nothing["instance"].is_null() && nothing["material"].is_null(), "{nothing}");
    viewer.until("the rest of the model", |shot| *shot != first);
    viewer.key("alt+h");
    viewer.until("the whole model", |shot| *shot == first);

    // A drag is no click, and Esc selects nothing.
    viewer.click((320, 240));
    assert_eq!(viewer.running.event("selected")["instance"], selected["instance"]);
    viewer.key("slash");
    viewer.until("the isolated part", |shot| *shot != first);
    viewer.key("Escape");
    assert!(viewer.running.event("selected")["instance"].is_null());
    viewer.quit();
}

#[test]
fn two_clicks_around_a_key_are_no_double_click() {
    let mut viewer = Viewer::open(Tree::new(), &["shader-ball"]);
    viewer.running.event("ready");
    viewer.key("h");
    viewer.until("the whole window", |shot| shot.dimensions() == (640, 480));
    let first = viewer.screenshot();
    // All of them come at once.
    viewer.paused(|| {
        viewer.click((320, 240));
        viewer.key("Escape");
        viewer.click((320, 240));
    });
    let instances = [(); 3].map(|()| viewer.running.event("selected")["instance"].clone());
    assert!(instances[0].is_u64() && instances[1].is_null() && instances[2] == instances[0], "{instances:?}");
    assert!(viewer.screenshot() == first, "the camera moved");
    viewer.quit();
}
