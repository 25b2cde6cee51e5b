//! The arrangement of the panels on disk: `layout.json` in `specula` of the user's folder for state. It holds the tiles as
//! `egui_tiles` writes them. A file that cannot be read, for example of another version, counts as absent.

use egui_tiles::{Tile, Tree};

use super::Panel;
use crate::app::state;

const FILE: &str = "layout.json";

/// The stored arrangement.
pub(super) fn load() -> Option<Tree<Panel>> {
    parse(&state::load(FILE)?)
}

/// An arrangement with the viewport, and with no panel twice.
fn parse(text: &str) -> Option<Tree<Panel>> {
    let tree: Tree<Panel> = serde_json::from_str(text).ok()?;
    let root = tree.root()?;
    tree.tiles.get(root)?;
    let panels =
        |panel: &Panel| tree.tiles.tiles().filter(|tile| matches!(tile, Tile::Pane(other) if other == panel)).count();
    let is_whole = panels(&Panel::Viewport) == 1 && Panel::GROUPS.concat().iter().all(|panel| panels(panel) <= 1);
    is_whole.then_some(tree)
}

/// Stores an arrangement.
pub(super) fn save(tree: &Tree<Panel>) {
    match serde_json::to_string(tree) {
        Ok(text) => state::save(FILE, &text),
        Err(error) => tracing::debug!("the layout was not stored: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Preset;
    use super::*;

    #[test]
    fn an_arrangement_is_read_as_it_was_written() {
        for preset in Preset::ALL {
            let tree = serde_json::to_value(preset.tree()).unwrap();
            let read = parse(&tree.to_string()).unwrap();
            assert_eq!(serde_json::to_value(read).unwrap(), tree);
        }
    }

    #[test]
    fn what_is_no_arrangement_counts_as_absent() {
        let whole = serde_json::to_string(&Preset::Debug.tree()).unwrap();
        let broken = ["", "{}", "[1]", &whole[..whole.len() / 2]];
        assert!(broken.iter().all(|text| parse(text).is_none()));
        for (old, new) in [("Viewport", "Modes"), ("Lights", "Lamps"), ("Lights", "Output")] {
            assert!(whole.contains(old) && parse(&whole.replace(old, new)).is_none(), "{old} as {new}");
        }
    }
}
