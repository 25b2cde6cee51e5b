//! Finds what the window shows by its colors, and chooses by the command palette.

use image::{Rgba, RgbaImage};

use crate::support::window::Viewer;

/// Text and frames of errors, as `src/app/widgets/theme.rs` has them.
pub(super) const ERROR: [u8; 3] = [255, 110, 100];
/// Links and marked letters.
pub(super) const ACCENT: [u8; 3] = [240, 166, 60];
/// Text and frames of warnings.
pub(super) const WARNING: [u8; 3] = [255, 196, 92];

/// Rows between the bars of a window of 480.
pub(super) const TILES: std::ops::Range<u32> = 32..456;
/// Rows of the lower bar.
pub(super) const STATUS: std::ops::Range<u32> = 458..480;
/// The end of the lower bar has the time of the last frame, which changes.
pub(super) const STATUS_COLUMNS: std::ops::Range<u32> = 0..500;

/// Controls begin this far right of the panel's left edge: a margin, and 120 points for the name with a gap.
const CONTROL: u32 = 134;

/// Whether a pixel has about this color. Text and thin lines are blended with what is behind them.
pub(super) fn is_about(pixel: &Rgba<u8>, color: [u8; 3]) -> bool {
    pixel.0.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 24)
}

/// How many pixels in columns `x` and rows `y` have about this color.
pub(super) fn count(screen: &RgbaImage, x: std::ops::Range<u32>, y: std::ops::Range<u32>, color: [u8; 3]) -> usize {
    x.flat_map(|x| y.clone().map(move |y| (x, y))).filter(|(x, y)| is_about(screen.get_pixel(*x, *y), color)).count()
}

/// Finds words in the command palette and chooses the first entry that has them.
#[track_caller]
pub(super) fn choose(viewer: &Viewer, words: &str) {
    viewer.key("ctrl+p");
    viewer.display.xdotool(&["type", words]);
    viewer.key("Return");
}

/// The place of `value` on the slider in row `y` of the panel with the left edge `left`: 0 and 1 are its ends.
pub(super) fn on_rail((left, y): (u32, u32), value: f32) -> (u32, u32) {
    (left + CONTROL + (value * 100.0).round() as u32, y)
}

/// Drags the slider in row `y` of the panel with the left edge `left` to `value`: 0 and 1 are its ends.
pub(super) fn drag_slider(viewer: &Viewer, left: u32, y: u32, value: f32) {
    viewer.drag(on_rail((left, y), 0.5), on_rail((left, y), value));
}
