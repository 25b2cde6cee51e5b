//! The sizes of the tiles. Panels keep the lengths that the user gave them, and the picture takes the rest of the window.

use std::collections::HashMap;

use egui::{Rect, Vec2};
use egui_tiles::{Container, LinearDir, Tile, TileId, Tiles, Tree};

use super::behavior::{GAP, TAB_BAR};
use crate::app::state::arrangement::Panel;

/// Width of the window in points below which the panels on one side of the picture are hidden.
const NARROW: f32 = 760.0;
/// The picture keeps at least this many points in each direction.
const MIN_PICTURE: f32 = 120.0;

/// A side of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PictureSide {
    #[default]
    Left,
    Right,
}

/// The lengths of the tiles beside the picture.
#[derive(Default)]
pub(super) struct Fit {
    /// Length of a tile along its container in points, as the user left it. A small window gives it less.
    lengths: HashMap<TileId, f32>,
    /// The lengths in the current window.
    given: HashMap<TileId, f32>,
    /// The window size for which they were computed.
    size: Option<Vec2>,
    /// The side that a narrow window hides.
    hidden: PictureSide,
}

impl Fit {
    /// Makes the next [`Fit::apply`] compute all lengths again.
    pub(super) fn invalidate(&mut self) {
        self.size = None;
    }

    /// The side of the picture whose panels a narrow window hides; `None` if there are none.
    pub(super) fn hidden_side(&self, tree: &Tree<Panel>) -> Option<&'static str> {
        let is_hidden = |id: &TileId| !tree.tiles.is_visible_in_layout(*id);
        let name = if self.hidden == PictureSide::Left { "left" } else { "right" };
        let is_narrow = self.size.is_some_and(|size| size.x < NARROW);
        (is_narrow && tree.tiles.tile_ids().any(|id| is_hidden(&id))).then_some(name)
    }

    /// Shows the other side of the picture in a narrow window.
    pub(super) fn swap_sides(&mut self) {
        self.hidden = if self.hidden == PictureSide::Left { PictureSide::Right } else { PictureSide::Left };
        self.invalidate();
    }

    /// Gives the picture all points that a new window size adds or takes, so that the panels keep their sizes.
    pub(super) fn apply(&mut self, tree: &mut Tree<Panel>, size: Vec2) {
        if self.size == Some(size) {
            return;
        }
        self.size = Some(size);
        self.given.clear();
        let tiles = &mut tree.tiles;
        let mut rest = size;
        for [parent, on_path] in path_to_picture(tiles) {
            let linear = match tiles.get_container(parent) {
                Some(Container::Linear(linear)) => linear,
                Some(Container::Tabs(_)) => {
                    rest.y -= TAB_BAR;
                    continue;
                }
                _ => continue,
            };
            let (children, dir) = (linear.children.clone(), linear.dir);
            let is_row = dir == LinearDir::Horizontal;
            let place = children.iter().position(|child| *child == on_path).unwrap_or(0);
            for (index, child) in children.iter().enumerate().filter(|(_, child)| **child != on_path) {
                let side = if index < place { PictureSide::Left } else { PictureSide::Right };
                tiles.set_visible(*child, !(is_row && size.x < NARROW && side == self.hidden));
            }
            let beside: Vec<(TileId, f32)> = children
                .into_iter()
                .filter(|child| *child != on_path && tiles.is_visible_in_layout(*child))
                .map(|child| (child, self.length(tiles, parent, child)))
                .collect();
            let total: f32 = beside.iter().map(|(_, points)| points).sum();
            let available = along(dir, rest) - GAP * beside.len() as f32;
            let scale = ((available - MIN_PICTURE).max(0.0) / total.max(1.0)).min(1.0);
            let picture = (available - total * scale).max(1.0);
            if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(parent) {
                for (child, points) in beside {
                    linear.shares.set_share(child, points * scale);
                    self.given.insert(child, points * scale);
                }
                linear.shares.set_share(on_path, picture);
            }
            rest = if is_row { Vec2::new(picture, rest.y) } else { Vec2::new(rest.x, picture) };
        }
    }

    /// Length of a child of a linear container in points.
    fn length(&mut self, tiles: &Tiles<Panel>, parent: TileId, child: TileId) -> f32 {
        *self.lengths.entry(child).or_insert_with(|| match tiles.get_container(parent) {
            Some(Container::Linear(linear)) => {
                tiles.rect(child).map_or(linear.shares[child], |rect| along(linear.dir, rect.size()))
            }
            _ => 1.0,
        })
    }

    /// Remembers the lengths of the tiles that the user has resized or dropped since [`Fit::apply`].
    pub(super) fn remember(&mut self, tree: &Tree<Panel>) {
        let tiles = &tree.tiles;
        for [parent, on_path] in path_to_picture(tiles) {
            let Some(Container::Linear(linear)) = tiles.get_container(parent) else { continue };
            for child in linear.children.iter().filter(|child| **child != on_path) {
                let Some(points) = tiles.rect(*child).map(|rect| along(linear.dir, rect.size())) else { continue };
                if self.given.get(child).is_none_or(|given| (given - points).abs() > 1.0) {
                    self.lengths.insert(*child, points);
                    self.given.insert(*child, points);
                }
            }
        }
        self.lengths.retain(|child, _| tiles.get(*child).is_some());
    }

    /// The tree with lengths in points instead of shares, as [`Fit::apply`] expects for a tree that has not been laid out.
    pub(super) fn measured(&self, tree: &Tree<Panel>) -> Tree<Panel> {
        let mut measured = tree.clone();
        for (id, tile) in tree.tiles.iter() {
            let Tile::Container(Container::Linear(linear)) = tile else { continue };
            let length = |child: &TileId| {
                let given = self.lengths.get(child).copied();
                given.or_else(|| tree.tiles.rect(*child).map(|rect| along(linear.dir, rect.size())))
            };
            let lengths: Vec<_> = linear.children.iter().filter_map(|child| Some((*child, length(child)?))).collect();
            if let Some(Tile::Container(Container::Linear(linear))) = measured.tiles.get_mut(*id) {
                lengths.into_iter().for_each(|(child, points)| linear.shares.set_share(child, points));
            }
        }
        measured
    }
}

/// The part of a picture's rectangle that no handle between it and a panel covers. `area`: the tiles. `grab`: half the width of
/// a handle. The edges of `area` have no handles.
pub(super) fn without_handles(picture: Rect, area: Rect, grab: f32) -> Rect {
    let inner = |at_edge: bool| if at_edge { 0.0 } else { grab };
    Rect::from_min_max(
        picture.min + Vec2::new(inner(picture.min.x <= area.min.x), inner(picture.min.y <= area.min.y)),
        picture.max - Vec2::new(inner(picture.max.x >= area.max.x), inner(picture.max.y >= area.max.y)),
    )
}

/// Each container that holds the picture with its child that does, the root first.
pub(super) fn path_to_picture(tiles: &Tiles<Panel>) -> Vec<[TileId; 2]> {
    let mut steps = Vec::new();
    let mut child = tiles.find_pane(&Panel::VIEWPORT);
    while let Some((parent, of)) = child.and_then(|child| Some((tiles.parent_of(child)?, child))) {
        steps.push([parent, of]);
        child = Some(parent);
    }
    steps.reverse();
    steps
}

fn along(dir: LinearDir, size: Vec2) -> f32 {
    if dir == LinearDir::Horizontal { size.x } else { size.y }
}
