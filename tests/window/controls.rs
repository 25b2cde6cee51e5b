//! Finds controls of the right panel on the screen by their colors and sizes, so that rows may be added above them.

use image::{Rgba, RgbaImage};

use crate::support::window::Viewer;

/// Behind the panels, as `src/app/panels/mod.rs` has it.
pub(super) const PANEL: [u8; 3] = [24, 25, 28];
/// Text and frames of errors.
pub(super) const ERROR: [u8; 3] = [255, 110, 100];
/// Text and frames of warnings.
pub(super) const WARNING: [u8; 3] = [255, 196, 92];

/// Behind what is chosen in a list.
const SELECTED: [u8; 3] = [35, 86, 134];

/// Controls begin this far right of the panel's left edge: a margin, and 120 points for the name with a gap.
const CONTROL: u32 = 134;
/// The entries of the environment's list are this far apart, the first one a little farther from its button.
const ENTRY: u32 = 22;

/// Whether a pixel has about this color. Text and thin lines are blended with what is behind them.
pub(super) fn is_about(pixel: &Rgba<u8>, color: [u8; 3]) -> bool {
    pixel.0.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 24)
}

/// How many pixels in columns `x` and rows `y` have about this color.
pub(super) fn count(screen: &RgbaImage, x: std::ops::Range<u32>, y: std::ops::Range<u32>, color: [u8; 3]) -> usize {
    x.flat_map(|x| y.clone().map(move |y| (x, y))).filter(|(x, y)| is_about(screen.get_pixel(*x, *y), color)).count()
}

/// Chooses an entry of the list of environments: 0 to 2 are built in, 3 is `none`. `left` is the panel's left edge, which is the
/// picture's width.
#[track_caller]
pub(super) fn choose_environment(viewer: &Viewer, left: u32, entry: u32) {
    // The list's button is the only control of 150 points. Its upper edge is free of text.
    let x = left + CONTROL;
    let is_button = |screen: &RgbaImage, y: u32| {
        let first = screen.get_pixel(x + 4, y);
        first.0[..3] != PANEL && (x + 4..x + 146).all(|x| screen.get_pixel(x, y) == first)
    };
    // A list may still be closing, and its entries are no buttons.
    let row = |screen: &RgbaImage| (100..screen.height()).find(|y| is_button(screen, *y));
    let screen = viewer.until_screen("the list of environments", |screen| row(screen).is_some());
    let y = row(&screen).unwrap() + ENTRY / 2;
    viewer.click((x + 20, y));
    // An open list marks its chosen entry over its whole width. Nothing else so close to the button has that color.
    let is_open = |screen: &RgbaImage| count(screen, x..x + 146, y + ENTRY / 2..y + 4 * ENTRY, SELECTED) > 1000;
    viewer.until_screen("the open list of environments", is_open);
    viewer.click((x + 20, y + ENTRY + 3 + ENTRY * entry));
    // Over a control or a name, the mouse would change its color or open a tooltip.
    viewer.display.park_mouse();
    viewer.until_screen("the closed list of environments", |screen| !is_open(screen));
}

/// Drags the slider in row `y` of the panel with the left edge `left` to `value`: 0 and 1 are its ends.
pub(super) fn drag_slider(viewer: &mut Viewer, left: u32, y: u32, value: f32) {
    let rail = |value: f32| (left + CONTROL + (value * 100.0).round() as u32, y);
    viewer.drag(rail(0.5), rail(value));
}
