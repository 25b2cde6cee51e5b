//! Keeps an arrangement usable after the user has dropped a tile: the picture is never hidden behind a tab, each panel has a tab
//! by which it can be dragged and closed, and each new tile has a size.

use egui_tiles::{Container, LinearDir, Tile, TileId, Tree};

use super::fit::path_to_picture;
use crate::app::state::arrangement::Panel;

/// Width of a column of panels that no other column determines.
pub(super) const COLUMN: f32 = 318.0;

/// Repairs the tree.
pub(super) fn repair(tree: &mut Tree<Panel>) {
    free_picture(tree);
    give_tabs(tree);
    give_shares(tree);
}

/// Moves the tabs that hold the picture beside it.
fn free_picture(tree: &mut Tree<Panel>) {
    let in_tabs = |tree: &Tree<Panel>| {
        let is_tabs = |id: TileId| matches!(tree.tiles.get_container(id), Some(Container::Tabs(_)));
        path_to_picture(&tree.tiles).into_iter().find(|[parent, _]| is_tabs(*parent))
    };
    while let Some([tabs, picture]) = in_tabs(tree) {
        let parent = tree.tiles.parent_of(tabs);
        if let Some(Tile::Container(container)) = tree.tiles.get_mut(tabs) {
            container.remove_child(picture);
        }
        let is_empty = tree.tiles.get_container(tabs).is_none_or(|container| container.num_children() == 0);
        let in_place = if is_empty {
            tree.tiles.remove(tabs);
            picture
        } else {
            tree.tiles.insert_horizontal_tile(vec![picture, tabs])
        };
        if let Some(Tile::Container(Container::Linear(linear))) = tree.tiles.get_mut(in_place)
            && !is_empty
        {
            linear.shares.set_share(tabs, COLUMN);
            linear.shares.set_share(picture, 2.0 * COLUMN);
        }
        match parent {
            Some(parent) => replace(tree, parent, tabs, in_place),
            None => tree.root = Some(in_place),
        }
    }
}

/// Replaces a child of a container, which keeps its share.
pub(super) fn replace(tree: &mut Tree<Panel>, parent: TileId, old: TileId, new: TileId) {
    if let Some(Tile::Container(container)) = tree.tiles.get_mut(parent) {
        if let Container::Linear(linear) = container {
            linear.shares.replace_with(old, new);
        }
        let _ = container.replace_child(old, new);
    }
}

/// Gives each panel that was dragged out of its tabs a tab of its own.
fn give_tabs(tree: &mut Tree<Panel>) {
    let tiles = &tree.tiles;
    let is_bare = |id: &TileId| {
        let parent = tiles.parent_of(*id).and_then(|parent| tiles.get_container(parent));
        matches!(tiles.get(*id), Some(Tile::Pane(panel)) if *panel != Panel::VIEWPORT)
            && parent.is_none_or(|parent| !matches!(parent, Container::Tabs(_)))
    };
    let bare: Vec<TileId> = tiles.tile_ids().filter(is_bare).collect();
    for pane in bare {
        let Some(parent) = tree.tiles.parent_of(pane) else { continue };
        let tabs = tree.tiles.insert_tab_tile(vec![pane]);
        replace(tree, parent, pane, tabs);
    }
}

/// Gives a tile that was dropped beside others their average size. Without a share it would be a point wide.
fn give_shares(tree: &mut Tree<Panel>) {
    for tile in tree.tiles.tiles_mut() {
        let Tile::Container(Container::Linear(linear)) = tile else { continue };
        let share = |child: &TileId| linear.shares.iter().find(|(id, _)| *id == child).map(|(_, share)| *share);
        let known: Vec<f32> = linear.children.iter().filter_map(share).collect();
        let new: Vec<TileId> = linear.children.iter().copied().filter(|child| share(child).is_none()).collect();
        let mean = known.iter().sum::<f32>() / known.len().max(1) as f32;
        let is_row = linear.dir == LinearDir::Horizontal;
        let size = match known.is_empty() {
            true => 1.0,
            false if is_row => mean.min(COLUMN),
            false => mean,
        };
        new.into_iter().for_each(|child| linear.shares.set_share(child, size));
    }
}
