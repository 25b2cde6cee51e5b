//! The arrangement of the panels on disk: `layout.json` in `specula` of the user's folder for state. It holds the tiles as
//! `egui_tiles` writes them. A file that cannot be read, for example of another version, counts as absent.

use std::path::PathBuf;

use egui_tiles::{Tile, Tree};

use super::Panel;

/// `$XDG_STATE_HOME/specula/layout.json`, or the same in `~/.local/state`. `None` without a home folder.
fn file() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = set("XDG_STATE_HOME").or_else(|| set("HOME").map(|home| home.join(".local/state")))?;
    Some(base.join("specula/layout.json"))
}

/// The stored arrangement.
pub(super) fn load() -> Option<Tree<Panel>> {
    parse(&std::fs::read_to_string(file()?).ok()?)
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

/// Stores an arrangement. A failure costs only the arrangement, so it is traced and not reported.
pub(super) fn save(tree: &Tree<Panel>) {
    let Some(path) = file() else { return };
    let written = || -> std::io::Result<()> {
        let text = serde_json::to_string(tree)?;
        std::fs::create_dir_all(path.parent().unwrap_or(&path))?;
        // Another window may read the file.
        let new = path.with_extension(format!("{}.new", std::process::id()));
        std::fs::write(&new, text)?;
        std::fs::rename(&new, &path)
    };
    if let Err(error) = written() {
        tracing::debug!("{}: the layout was not stored: {error}", path.display());
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
