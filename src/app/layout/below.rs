//! Opens a panel below the picture.

use egui_tiles::{Container, LinearDir, Tile, Tree};

use super::repair::replace;
use crate::app::state::arrangement::Panel;

/// Height of the panels below the picture, points.
const BELOW: f32 = 300.0;

/// Puts a panel below the picture, beside those that are there. Returns whether there is a picture.
pub(super) fn insert(tree: &mut Tree<Panel>, panel: Panel) -> bool {
    let Some(picture) = tree.tiles.find_pane(&Panel::VIEWPORT) else { return false };
    let parent = tree.tiles.parent_of(picture);
    let pane = tree.tiles.insert_pane(panel);
    if let Some(Container::Linear(linear)) = parent.and_then(|parent| tree.tiles.get_container(parent))
        && linear.dir == LinearDir::Vertical
    {
        let is_tabs = |id: &&egui_tiles::TileId| matches!(tree.tiles.get_container(**id), Some(Container::Tabs(_)));
        if let Some(tabs) = linear.children.iter().rev().find(is_tabs).copied()
            && let Some(Tile::Container(Container::Tabs(tabs))) = tree.tiles.get_mut(tabs)
        {
            tabs.add_child(pane);
            return true;
        }
    }
    let tabs = tree.tiles.insert_tab_tile(vec![pane]);
    let column = tree.tiles.insert_vertical_tile(vec![picture, tabs]);
    if let Some(Tile::Container(Container::Linear(linear))) = tree.tiles.get_mut(column) {
        linear.shares.set_share(picture, 1.0);
        linear.shares.set_share(tabs, BELOW);
    }
    match parent {
        Some(parent) => replace(tree, parent, picture, column),
        None => tree.root = Some(column),
    }
    true
}
