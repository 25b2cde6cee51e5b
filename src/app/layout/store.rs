//! The arrangement of the panels on disk: `layout.json` in `specula` of the user's folder for state. It holds the tiles as
//! `egui_tiles` writes them. A file that cannot be read, for example of another version, counts as absent.

use egui_tiles::{Tile, Tree};
use serde::{Deserialize, Serialize};

use crate::app::state::arrangement::{Panel, Preset};
use crate::state_folder;

const FILE: &str = "layout.json";

/// The content of the file.
#[derive(Serialize, Deserialize)]
pub(super) struct Stored {
    /// The arrangement on screen.
    pub(super) tree: Tree<Panel>,
    /// Whether the user has changed it.
    pub(super) is_own: bool,
    /// The arrangement that the user made before a preset was chosen.
    pub(super) own: Option<Tree<Panel>>,
    /// Whether the light theme is shown.
    #[serde(default)]
    pub(super) is_light: bool,
    /// The preset that was chosen last.
    #[serde(default)]
    pub(super) preset: Preset,
    /// The user's own arrangement for single files.
    #[serde(default)]
    pub(super) of_file: Option<Tree<Panel>>,
}

/// The stored arrangement.
pub(super) fn load() -> Option<Stored> {
    parse(&state_folder::load(FILE)?)
}

fn parse(text: &str) -> Option<Stored> {
    let mut stored: Stored = serde_json::from_str(text).ok()?;
    stored.own = stored.own.filter(is_whole);
    stored.of_file = stored.of_file.filter(is_whole);
    is_whole(&stored.tree).then_some(stored)
}

/// Whether an arrangement has the viewport, and no panel twice.
fn is_whole(tree: &Tree<Panel>) -> bool {
    let panels =
        |panel: &Panel| tree.tiles.tiles().filter(|tile| matches!(tile, Tile::Pane(other) if other == panel)).count();
    let viewport = tree.tiles.find_pane(&Panel::VIEWPORT);
    let top = std::iter::successors(viewport, |id| tree.tiles.parent_of(*id)).last();
    top.is_some()
        && top == tree.root()
        && panels(&Panel::VIEWPORT) == 1
        && Panel::groups().concat().iter().all(|panel| panels(panel) <= 1)
}

/// Stores an arrangement.
pub(super) fn save(stored: &Stored) {
    match serde_json::to_string(stored) {
        Ok(text) => state_folder::save(FILE, &text),
        Err(error) => tracing::debug!("the layout was not stored: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrangement_is_read_as_it_was_written() {
        for preset in Preset::ALL {
            let own = Some(Preset::Look.tree());
            let of_file = Some(Preset::Toy.tree());
            let stored = Stored { tree: preset.tree(), is_own: true, own, is_light: true, preset, of_file };
            let value = serde_json::to_value(&stored).unwrap();
            let read = parse(&value.to_string()).unwrap();
            assert_eq!(serde_json::to_value(read).unwrap(), value);
        }
    }

    #[test]
    fn what_is_no_arrangement_counts_as_absent() {
        let preset = Preset::Debug;
        let stored = Stored { tree: preset.tree(), is_own: false, own: None, is_light: false, preset, of_file: None };
        let whole = serde_json::to_string(&stored).unwrap();
        let broken = ["", "{}", "[1]", &whole[..whole.len() / 2]];
        assert!(broken.iter().all(|text| parse(text).is_none()));
        for (old, new) in [("Viewport", "Modes"), ("Lights", "Lamps"), ("Lights", "Output")] {
            assert!(whole.contains(old) && parse(&whole.replace(old, new)).is_none(), "{old} as {new}");
        }
    }
}
