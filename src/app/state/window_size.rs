//! The size of the last window, kept in `window.json`.

use serde::{Deserialize, Serialize};

use crate::state_folder;

const FILE: &str = "window.json";
/// Smallest width and height that is restored, pixels.
const SMALLEST: u32 = 320;

/// The content of the file.
#[derive(Serialize, Deserialize)]
struct Stored {
    size: (u32, u32),
}

/// Width and height of the last window, pixels.
pub fn last_size() -> Option<(u32, u32)> {
    parse(&state_folder::load(FILE)?)
}

fn parse(text: &str) -> Option<(u32, u32)> {
    let Stored { size: (width, height) } = serde_json::from_str(text).ok()?;
    let sides = SMALLEST..=16_384;
    (sides.contains(&width) && sides.contains(&height)).then_some((width, height))
}

/// Stores the size of a window that closes.
pub(in crate::app) fn remember(size: (u32, u32)) {
    if let Ok(text) = serde_json::to_string(&Stored { size }) {
        state_folder::save(FILE, &text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_is_no_window_counts_as_none() {
        assert_eq!(parse(r#"{"size": [1600, 900]}"#), Some((1600, 900)));
        for text in ["", "{}", r#"{"size": [0, 0]}"#, r#"{"size": [900, 100000]}"#, r#"{"size": [-1, 5]}"#] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
