//! The arrangement of the panels: tiles around the picture that the user docks, resizes and closes. It is kept between runs.

mod behavior;
mod preset;
mod store;

use egui::{Rect, Ui, Vec2};
use egui_tiles::{Container, LinearDir, SimplificationOptions, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

use behavior::Dock;
pub(super) use preset::Preset;

/// Width of the window in points below which the panels left of the picture are hidden.
const NARROW: f32 = 760.0;
/// The picture keeps at least this many points in each direction.
const MIN_PICTURE: f32 = 120.0;
/// Width of a column of panels that has none to take it from.
const COLUMN: f32 = 318.0;

/// What a tile shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Panel {
    Viewport,
    Modes,
    Model,
    Shaders,
    Timing,
    Parameters,
    Passes,
    Environment,
    Lights,
    Output,
    Camera,
}

impl Panel {
    /// All panels that can be closed, in groups that share a tile at first.
    pub(super) const GROUPS: [&[Self]; 4] = [
        &[Self::Modes, Self::Model],
        &[Self::Shaders, Self::Timing],
        &[Self::Parameters, Self::Passes],
        &[Self::Environment, Self::Lights, Self::Output, Self::Camera],
    ];

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Viewport => "Viewport",
            Self::Modes => "Modes",
            Self::Model => "Model",
            Self::Shaders => "Shaders",
            Self::Timing => "GPU time",
            Self::Parameters => "Parameters",
            Self::Passes => "Passes",
            Self::Environment => "Environment",
            Self::Lights => "Lights",
            Self::Output => "Output",
            Self::Camera => "Camera",
        }
    }
}

/// The arrangement of the panels.
pub(super) struct Layout {
    tree: Tree<Panel>,
    /// The size for which the tiles were last measured.
    fitted: Option<Vec2>,
    /// Whether the arrangement differs from the stored one.
    is_changed: bool,
    /// Whether the tiles have been laid out since the last change.
    is_settled: bool,
}

impl Default for Layout {
    /// No panels.
    fn default() -> Self {
        Self::of_tree(Tree::empty("layout"))
    }
}

impl Layout {
    /// The arrangement of the last run, or the first preset.
    pub(super) fn restored() -> Self {
        store::load().map_or_else(|| Self::of(Preset::Debug), Self::of_tree)
    }

    /// The arrangement of a preset.
    pub(super) fn of(preset: Preset) -> Self {
        Self { is_changed: true, ..Self::of_tree(preset.tree()) }
    }

    fn of_tree(tree: Tree<Panel>) -> Self {
        Self { tree, fitted: None, is_changed: false, is_settled: false }
    }

    pub(super) fn is_open(&self, panel: Panel) -> bool {
        self.tree.tiles.find_pane(&panel).is_some()
    }

    /// Shows a panel: in front of the tabs in its tile, beside panels of its group or any other, or in a column of its own.
    pub(super) fn open(&mut self, panel: Panel) {
        self.is_changed = true;
        if !self.is_open(panel) {
            self.insert(panel);
        }
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(other) if *other == panel));
    }

    pub(super) fn close(&mut self, panel: Panel) {
        if let Some(id) = self.tree.tiles.find_pane(&panel) {
            self.tree.remove_recursively(id);
            self.tree.simplify(&SIMPLIFY);
            (self.is_changed, self.fitted) = (true, None);
        }
    }

    fn insert(&mut self, panel: Panel) {
        let group = Panel::GROUPS.into_iter().find(|group| group.contains(&panel)).unwrap_or_default();
        let (root, tiles) = (self.tree.root(), &mut self.tree.tiles);
        let with = |other: &Panel| tiles.parent_of(tiles.find_pane(other)?);
        let all = Panel::GROUPS.concat();
        let beside = group.iter().find_map(with).or_else(|| all.iter().rev().find_map(with));
        let pane = tiles.insert_pane(panel);
        if let Some(Tile::Container(Container::Tabs(tabs))) = beside.and_then(|id| tiles.get_mut(id)) {
            tabs.add_child(pane);
            return;
        }
        let column = tiles.insert_tab_tile(vec![pane]);
        self.fitted = None;
        match root.and_then(|id| tiles.get_mut(id)) {
            Some(Tile::Container(Container::Linear(linear))) if linear.dir == LinearDir::Horizontal => {
                linear.add_child(column);
                linear.shares.set_share(column, COLUMN);
            }
            _ => {
                let children: Vec<TileId> = root.into_iter().chain([column]).collect();
                let whole = tiles.insert_horizontal_tile(children);
                if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(whole) {
                    linear.shares.set_share(column, COLUMN);
                }
                self.tree.root = Some(whole);
            }
        }
    }

    /// Shows the tiles in `ui`. `panels` shows what is in them. Returns the rectangle of the picture in points, which is empty
    /// behind another tab.
    pub(super) fn show(&mut self, ui: &mut Ui, panels: &mut dyn FnMut(&mut Ui, Panel)) -> Rect {
        let area = ui.available_rect_before_wrap();
        self.fit(area.size());
        let mut dock = Dock { panels, picture: None, is_edited: false, closed: None };
        // What the tiles leave uncovered, apart from the picture, is painted behind them.
        let background = ui.painter().add(egui::Shape::Noop);
        self.tree.ui(&mut dock, ui);
        let Dock { picture, is_edited, closed, .. } = dock;
        let picture = picture.unwrap_or(Rect::from_min_size(area.min, Vec2::ZERO));
        ui.painter().set(background, around(picture, area, ui.visuals().extreme_bg_color));
        if is_edited {
            self.give_tabs();
            self.give_shares();
            self.is_changed = true;
        }
        if let Some(panel) = closed {
            self.close(panel);
        }
        self.store(ui);
        picture
    }

    /// Stores a changed arrangement, once its tiles have their sizes. A drag changes them in each frame, and only its end is worth
    /// a file.
    fn store(&mut self, ui: &Ui) {
        if !self.is_changed || ui.input(|input| input.pointer.any_down()) {
            self.is_settled = false;
        } else if std::mem::replace(&mut self.is_settled, true) {
            (self.is_changed, self.is_settled) = (false, false);
            self.measure();
            store::save(&self.tree);
        } else {
            ui.ctx().request_repaint();
        }
    }

    /// Replaces the shares of all tiles by their sizes in points, which is what [`Self::fit`] takes shares for.
    fn measure(&mut self) {
        let tiles = &mut self.tree.tiles;
        let ids: Vec<TileId> = tiles.tile_ids().collect();
        for id in ids {
            let Some(Container::Linear(linear)) = tiles.get_container(id) else { continue };
            let is_row = linear.dir == LinearDir::Horizontal;
            let size_of =
                |child: &TileId| tiles.rect(*child).map(|rect| if is_row { rect.width() } else { rect.height() });
            let sizes: Vec<_> = linear.children.iter().filter_map(|child| Some((*child, size_of(child)?))).collect();
            if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(id) {
                sizes.into_iter().for_each(|(child, points)| linear.shares.set_share(child, points));
            }
        }
    }

    /// Gives the picture what a new size of the window adds or takes, so that the panels keep theirs.
    fn fit(&mut self, size: Vec2) {
        let tiles = &mut self.tree.tiles;
        let Some(viewport) = tiles.find_pane(&Panel::Viewport).filter(|_| self.fitted != Some(size)) else { return };
        self.fitted = Some(size);
        let mut path = vec![viewport];
        while let Some(parent) = path.last().and_then(|child| tiles.parent_of(*child)) {
            path.push(parent);
        }
        path.reverse();
        let mut left = size;
        for step in path.windows(2) {
            let [parent, on_path] = [step[0], step[1]];
            let Some(Container::Linear(linear)) = tiles.get_container(parent) else { continue };
            let is_row = linear.dir == LinearDir::Horizontal;
            let length = |size: Vec2| if is_row { size.x } else { size.y };
            let (mut children, mut is_before) = (Vec::new(), true);
            for child in linear.children.clone() {
                is_before &= child != on_path;
                let share = linear_share(tiles, parent, child);
                children.push((
                    child,
                    tiles.rect(child).map_or(share, |rect| length(rect.size())),
                    is_row && is_before,
                ));
            }
            for (child, _, is_left) in &children {
                tiles.set_visible(*child, !is_left || size.x >= NARROW);
            }
            children.retain(|(child, ..)| *child != on_path && tiles.is_visible(*child));
            let panels: f32 = children.iter().map(|(_, points, _)| points).sum();
            let most = (length(left) - MIN_PICTURE).max(0.0);
            let scale = if panels > most { most / panels } else { 1.0 };
            let gaps = behavior::GAP * children.len() as f32;
            let rest = (length(left) - panels * scale - gaps).max(1.0);
            if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(parent) {
                children.iter().for_each(|(child, points, _)| linear.shares.set_share(*child, points * scale));
                linear.shares.set_share(on_path, rest);
            }
            left = if is_row { Vec2::new(rest, left.y) } else { Vec2::new(left.x, rest) };
        }
    }

    /// Gives what was dropped beside other tiles the mean of their sizes. Without a share it would be a point wide.
    fn give_shares(&mut self) {
        let containers = self.tree.tiles.tiles_mut().filter_map(|tile| match tile {
            Tile::Container(Container::Linear(linear)) => Some(linear),
            _ => None,
        });
        for linear in containers {
            let share = |child: &TileId| linear.shares.iter().find(|(id, _)| *id == child).map(|(_, share)| *share);
            let known: Vec<f32> = linear.children.iter().filter_map(share).collect();
            let new: Vec<TileId> = linear.children.iter().copied().filter(|child| share(child).is_none()).collect();
            let mean = known.iter().sum::<f32>() / known.len().max(1) as f32;
            let size = if known.is_empty() { 1.0 } else { mean.min(COLUMN) };
            new.into_iter().for_each(|child| linear.shares.set_share(child, size));
        }
    }

    /// Gives each panel that was dragged out of its tabs a tab of its own, by which it can be dragged and closed again.
    fn give_tabs(&mut self) {
        let tiles = &mut self.tree.tiles;
        let is_bare = |id: &TileId| {
            let parent = tiles.parent_of(*id).and_then(|parent| tiles.get_container(parent));
            matches!(tiles.get(*id), Some(Tile::Pane(panel)) if *panel != Panel::Viewport)
                && parent.is_some_and(|parent| !matches!(parent, Container::Tabs(_)))
        };
        let bare: Vec<TileId> = tiles.tile_ids().filter(is_bare).collect();
        for pane in bare {
            let Some(parent) = tiles.parent_of(pane) else { continue };
            let tabs = tiles.insert_tab_tile(vec![pane]);
            if let Some(Tile::Container(container)) = tiles.get_mut(parent) {
                if let Container::Linear(linear) = container {
                    linear.shares.replace_with(pane, tabs);
                }
                let _ = container.replace_child(pane, tabs);
            }
        }
    }
}

fn linear_share(tiles: &Tiles<Panel>, parent: TileId, child: TileId) -> f32 {
    match tiles.get_container(parent) {
        Some(Container::Linear(linear)) => linear.shares[child],
        _ => 1.0,
    }
}

/// How tiles become simpler after a change. A tile with one tab keeps it.
const SIMPLIFY: SimplificationOptions = SimplificationOptions {
    prune_empty_tabs: true,
    prune_empty_containers: true,
    prune_single_child_tabs: false,
    prune_single_child_containers: true,
    all_panes_must_have_tabs: false,
    join_nested_linear_containers: true,
    flatten_tabs_in_tabs: true,
};

/// `area` without `picture`, filled.
fn around(picture: Rect, area: Rect, color: egui::Color32) -> egui::Shape {
    let sides = [
        area.with_max_y(picture.min.y),
        area.with_min_y(picture.max.y),
        area.with_max_x(picture.min.x),
        area.with_min_x(picture.max.x),
    ];
    let filled = sides.into_iter().filter(|side| side.is_positive());
    egui::Shape::Vec(filled.map(|side| egui::Shape::rect_filled(side, 0.0, color)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lays the tiles out in a window of this size, and returns the picture.
    fn shown(layout: &mut Layout, egui: &egui::Context, size: Vec2) -> Rect {
        let input =
            egui::RawInput { screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size)), ..Default::default() };
        let mut picture = Rect::NOTHING;
        let _ = egui.run_ui(input, |ui| picture = layout.show(ui, &mut |_, _| {}));
        picture
    }

    /// A layout that is not stored.
    fn unstored(preset: Preset) -> Layout {
        Layout::of_tree(preset.tree())
    }

    #[test]
    fn panels_keep_their_width_and_the_picture_takes_the_rest() {
        let (egui, mut layout) = (egui::Context::default(), unstored(Preset::Debug));
        let widths = [1280.0, 2560.0, 900.0, 1280.0].map(|width| {
            let picture = shown(&mut layout, &egui, Vec2::new(width, 720.0));
            (picture.min.x, width - picture.max.x)
        });
        for (left, right) in widths {
            assert!((left - widths[0].0).abs() < 1.5 && (right - widths[0].1).abs() < 1.5, "{widths:?}");
        }
        assert!(widths[0].0 > 150.0 && widths[0].1 > 250.0, "{widths:?}");
        // A narrow window hides what is left of the picture, which comes back with its width.
        let narrow = shown(&mut layout, &egui, Vec2::new(640.0, 480.0));
        assert!(narrow.min.x == 0.0 && narrow.width() > 250.0, "{narrow:?}");
        let wide = shown(&mut layout, &egui, Vec2::new(1280.0, 720.0));
        assert!((wide.min.x - widths[0].0).abs() < 1.5, "{wide:?}, {widths:?}");
        // Even in a tiny one there is a picture.
        assert!(shown(&mut layout, &egui, Vec2::new(300.0, 200.0)).width() > 100.0);
    }

    #[test]
    fn every_panel_closes_and_opens_again() {
        for preset in Preset::ALL {
            let (egui, mut layout) = (egui::Context::default(), unstored(preset));
            let size = Vec2::new(1280.0, 720.0);
            let first = shown(&mut layout, &egui, size);
            layout.is_changed = false;
            for panel in Panel::GROUPS.concat() {
                layout.close(panel);
                layout.is_changed = false;
                shown(&mut layout, &egui, size);
                assert!(!layout.is_open(panel));
            }
            assert!(shown(&mut layout, &egui, size).width() > 1270.0, "a column without panels is left");
            for panel in Panel::GROUPS.concat() {
                layout.open(panel);
                layout.is_changed = false;
                shown(&mut layout, &egui, size);
                assert!(layout.is_open(panel), "{panel:?}");
                let mut seen = false;
                let input = egui::RawInput {
                    screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size)),
                    ..Default::default()
                };
                let _ = egui.run_ui(input, |ui| {
                    layout.show(ui, &mut |_, shown| seen |= shown == panel);
                });
                assert!(seen, "{panel:?} is open behind another tab");
            }
            assert!(shown(&mut layout, &egui, size).width() > 0.5 * first.width());
        }
    }
}
